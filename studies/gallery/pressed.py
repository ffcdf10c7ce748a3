"""Two vesicles pressed together in extension: the film between them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.curves import trigonometric
from petves.run import Run
from petves.views.plot import dress, new_figure, save_figure
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, plain_ticks, seconds

TIMES = (2, 4, 8, 12, 16)
GRIDS = ((64, 101), (96, 151))
"""Cells across and markers a vesicle."""


def thickness(run: Run, frame: int) -> float:
    """Return the film's thickness on the line through both centres."""
    sides = []
    for vesicle, sign in ((0, 1), (1, -1)):
        x, y = trigonometric(run.outline(frame, vesicle)[:-1], 4096).T
        near = sign * (x - x.mean()) > 0
        order = np.argsort(y[near])
        sides.append(np.interp(y.mean(), y[near][order], x[near][order]))
    return float(sides[1] - sides[0])


def pressed(cells: int, markers: int) -> Case:
    """Return the run on cells^2: film at its centre and at its thinnest, at TIMES."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        run = Run.read(folder)
        frames = [int(np.abs(run.time - t).argmin()) for t in TIMES]
        rim = np.interp(TIMES, series["time"], series["gap"])
        return {"rim": list(rim), "centre": [thickness(run, frame) for frame in frames]}

    changes = f"-domain_cells {cells},{cells} -vesicle_markers {markers}"
    return case(f"{cells}_{markers}", "pressed", changes, measure)


def slope(value: list[float], first: int) -> float:
    """Return d ln(value)/d ln(t) from TIMES[first] to the last."""
    return float(np.log(value[-1] / value[first]) / np.log(TIMES[-1] / TIMES[first]))


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    coarse, fine = (results.get(pressed(*grid)) for grid in GRIDS)
    figure, (panel,) = new_figure(8, 5)
    for name, style in (("rim", "o-"), ("centre", "s-")):
        panel.loglog(TIMES, fine[name], style, ms=4, lw=1.2, label=name)
    times = np.array(TIMES[2:], float)
    for value, power in ((fine["rim"][-1], -0.5), (fine["centre"][-1], -0.25)):
        panel.loglog(times, 0.9 * value * (times / times[-1]) ** power, "k--", lw=0.8)
    dress(panel, grid="both", xlabel="rate times time", ylabel="film (length)")
    plain_ticks(panel, TIMES, (0.04, 0.06, 0.1, 0.2))
    panel.legend(frameon=False, fontsize=8)
    save_figure(figure, results.path.parent / "pressed.png")
    apart = max(abs(coarse["rim"][k] / fine["rim"][k] - 1) for k in range(len(TIMES)))
    return {
        "pressed_apart": f"{100 * apart:.1f}",
        "rim_late": f"{slope(fine['rim'], 2):.2f}",
        "centre_late": f"{slope(fine['centre'], 2):.2f}",
        "seconds": seconds(coarse, fine),
    }


SCENE = Scene("pressed", fill)
