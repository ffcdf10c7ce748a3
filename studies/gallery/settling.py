"""Heavy vesicles that sink: one in a box, two in tandem."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.curves import aspect, trigonometric
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

TIMES = (0.5, 1, 1.5, 2)
EXACT = (-0.06962, -0.138778, -0.207621, -0.276173)
"""Height of the centre of one vesicle at TIMES over R0: spectral boundary integral, stated uncertainty 1e-5."""
RUNS = {"default": "", "first": "-scheme_order 1 -time_step 0.005"}
APART = (0, 10, 20, 40, 60)


def settling(name: str) -> Case:
    """Return one vesicle: height at TIMES, speed and aspect at the end."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        height = [series["center_y"][np.abs(series["time"] - t).argmin()] for t in TIMES]
        shape = aspect(trigonometric(Run.read(folder).markers[-1]))
        return {"height": height, "speed": series["velocity_y"][-1], "aspect": shape}

    return case(name, "settling", RUNS[name], measure)


def tandem(cells: int, pictures: Path | None = None) -> Case:
    """Return two vesicles: distance of centres at APART, speeds at t = 40."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "tandem.png", (0, 20, 40, 60), (-4, 4, -12, 7))
        apart = series["center_y_2"] - series["center_y_1"]
        row = [int(np.abs(series["time"] - t).argmin()) for t in APART]
        found = {"apart": apart[row].tolist(), "speeds": [series[f"velocity_y_{v}"][row[3]] for v in (1, 2)]}
        return found | {"gap": series["gap_1"][-1]}

    return case(f"{cells}", "tandem", f"-domain_cells {cells},{2 * cells}", measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    one = {name: results.get(settling(name)) for name in RUNS}
    off = {name: [1e5 * (y - z) for y, z in zip(found["height"], EXACT)] for name, found in one.items()}
    rows = [
        f"| {t:g} | {one['default']['height'][k]:.5f} | {EXACT[k]:.6g} | {off['default'][k]:+.1f}e-5 | {off['first'][k]:+.1f}e-5 |"
        for k, t in enumerate(TIMES)
    ]
    coarse = with_pictures(results, tandem(32, results.path.parent), "tandem.png")
    fine = results.get(tandem(64))
    pairs = [
        f"| {cells} | {', '.join(f'{value:.4f}' for value in found['apart'])} | {-found['speeds'][0]:.5f}, {-found['speeds'][1]:.5f} |"
        for cells, found in (("32 x 64", coarse), ("64 x 128", fine))
    ]
    return {
        "settling_rows": "\n".join(rows),
        "settling_speed": f"{-one['default']['speed']:.4f}",
        "settling_aspect": f"{one['default']['aspect']:.3f}",
        "tandem_rows": "\n".join(pairs),
        "settling_seconds": seconds(one["default"], coarse),
    }


SCENE = Scene("settling", fill)
