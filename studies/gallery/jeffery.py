"""Rigid ellipses that shear turns."""

from __future__ import annotations

import numpy as np

from petves.views.figures import new_figure, save_figure
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, seconds

RATIOS, ORDERS, STEPS = (1.5, 2, 3, 5), (2, 3), (100, 200)


def ellipse(ratio: float, order: int, steps: int) -> Case:
    """Return one turn of an ellipse of this ratio of semi-axes: the angles, and by how much of the period it is off."""
    period = 2 * np.pi * (ratio + 1 / ratio)

    def measure(series: Series, _) -> dict[str, object]:
        late = (series["obstacle_angle_1"][-1] + 2 * np.pi) * (1 + ratio**2)  # over the rate along the flow
        every = steps // 50
        columns = {name: series[name][::every].tolist() for name in ("time", "obstacle_angle_1")}
        return {"off": abs(late) / period} | columns

    t = 2 * np.pi * np.arange(96 * max(1, ratio // 2)) / (96 * max(1, ratio // 2))
    cells = 32 * max(2, round(ratio))
    changes = f"-domain_cells {cells},{cells} -allow_unused_options true -scheme_order {order} -time_step {period / steps!r} -time_end {period!r} -output_every {period!r}"
    one = case(f"{ratio:g}_{order}_{steps}", "jeffery", changes, measure)
    one.options["-obstacle_file"] = f"ellipse {ratio:g}"
    one.files["-obstacle_file"] = "".join(f"{np.cos(a):.12f} {np.sin(a) / ratio:.12f}\n" for a in t)
    return one


def fill(results: Results) -> Values:
    """Make the runs; draw the angles; return the values."""
    runs = {(r, o, n): results.get(ellipse(r, o, n)) for r in RATIOS for o in ORDERS for n in STEPS}
    pairs = [(o, n) for o in ORDERS for n in STEPS]
    rows = [[r, f"{2 * (r + 1 / r):.4g} pi", *(f"{runs[r, o, n]['off']:.0e}" for o, n in pairs)] for r in RATIOS]
    figure, (panel,) = new_figure(5, 3)
    for r in RATIOS:
        found, phase = runs[r, 2, 200], np.linspace(0, 2 * np.pi, 400)
        (line,) = panel.plot(
            phase * (r + 1 / r), -np.unwrap(np.arctan2(np.sin(phase) / r, np.cos(phase))) / np.pi, lw=1
        )
        panel.plot(
            found["time"][::2],
            np.array(found["obstacle_angle_1"][::2]) / np.pi,
            "o",
            ms=3,
            color=line.get_color(),
            label=f"{r:g}",
        )
    panel.set(xlabel="strain", ylabel="angle / $\\pi$")
    panel.legend(title="a/b", frameon=False)
    save_figure(figure, results.path.parent / "jeffery.png")
    header = ["a/b", "period", *(f"order {o}: {n} steps" for o, n in pairs)]
    return {"orbits": [header, *rows], "seconds": seconds(*runs.values())}


SCENE = Scene("jeffery", fill)
