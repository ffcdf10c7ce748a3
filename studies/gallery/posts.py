"""Deterministic lateral displacement: a vesicle in an array of posts whose rows are shifted."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from petves.views.figures import new_figure, save_figure
from petves.views.plot import dress
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, seconds, with_pictures

SHIFT, GAP, REDUCED_AREA = 0.2, 0.5, 0.95
CRITICAL = 1.4 * GAP * SHIFT**0.48
"""Diameter from which on rigid spheres are displaced: Davis's fit to measurements."""
DIAMETERS = (0.15, 0.2, 0.28, 0.32, 0.36, 0.4)
SOFT, STIFF = 0.002, 0.2


def posts(diameter: float, bending: float = 0.02, pictures: Path | None = None) -> Case:
    """Return a vesicle of 2 R0 = diameter: how far aside it goes a row, from the second row on; its way."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            film(folder, pictures / "posts.gif", width=440)
        x, y = series["center_x"], series["center_y"]
        inside = y > 1.5
        way = np.interp(np.linspace(y[0], y[-1], 41), y, x)
        found = {
            "aside": (x[-1] - x[inside][0]) / (y[-1] - y[inside][0]),
            "y": [y[0], y[-1]],
            "way": np.round(way, 4).tolist(),
        }
        return found | {"rows": y[-1] - y[0]}

    area = REDUCED_AREA * np.pi * diameter**2 / 4
    step = "-time_step 0.01" if bending > 0.02 else ""  # films on posts are thin
    changes = f"-vesicle_area {area!r} -vesicle_bending {bending} {step}"
    return case(f"{diameter}_{bending}", "posts", changes, measure, may_fail=True)


def mode(found: dict) -> str:
    """Return how it goes: displaced goes SHIFT aside a row, zigzag nothing in the mean."""
    part = found["aside"] / SHIFT
    return "displaced" if part > 0.75 else "zigzag" if part < 0.25 else "between"


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    home = results.path.parent
    runs = {(d, 0.02): results.get(posts(d)) for d in DIAMETERS[:-1]}
    runs[DIAMETERS[-1], 0.02] = with_pictures(results, posts(DIAMETERS[-1], pictures=home), "posts.gif")
    runs |= {(0.32, c): results.get(posts(0.32, c)) for c in (SOFT, STIFF)}
    figure, (panel,) = new_figure(8, 5)
    for (d, c), one in runs.items():
        if c == 0.02:
            panel.plot(np.linspace(*one["y"], len(one["way"])), one["way"], lw=1.2, label=f"2 R0 = {d:g}")
    panel.plot([0.5, 7], [0.95, 0.95 + 6.5 * SHIFT], "k--", lw=0.8, label="posts")
    dress(panel, grid="both", xlabel="along the flow, rows", ylabel="aside")
    panel.legend(frameon=False, fontsize=8)
    save_figure(figure, home / "posts.png")
    rows = [f"| {d:g} | {c:g} | {one['aside']:+.3f} | {mode(one)} |" for (d, c), one in runs.items()]
    return {
        "posts_rows": "\n".join(rows),
        "posts_critical": f"{CRITICAL:.2f}",
        "posts_seconds": seconds(*runs.values()),
    }


SCENE = Scene("posts", fill, long=True)
