"""Deterministic lateral displacement: a vesicle in an array of posts whose rows are shifted."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.views.figures import new_figure, save_figure
from petves.views.plot import dress
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, seconds, with_pictures

SHIFT, GAP, REDUCED_AREA = 0.2, 0.5, 0.95
CRITICAL = 1.4 * GAP * SHIFT**0.48
"""Diameter from which on rigid spheres are displaced: Davis's fit to measurements."""
DIAMETERS = (0.15, 0.2, 0.28, 0.32, 0.36, 0.4)
BENDING, SOFT = 0.02, 0.002


def posts(diameter: float, bending: float = BENDING, pictures: Path | None = None) -> Case:
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
        return found

    area = REDUCED_AREA * np.pi * diameter**2 / 4
    changes = f"-vesicle_area {area!r} -vesicle_bending {bending}"
    return case(f"{diameter}_{bending}", "posts", changes, measure, may_fail=True)


def mode(found: dict) -> str:
    """Return how it goes: displaced goes SHIFT aside a row, zigzag nothing in the mean."""
    part = found["aside"] / SHIFT
    return "displaced" if part > 0.75 else "zigzag" if part < 0.25 else "between"


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    home = results.path.parent
    runs = {d: results.get(posts(d)) for d in DIAMETERS[:-1]}
    runs[DIAMETERS[-1]] = with_pictures(results, posts(DIAMETERS[-1], pictures=home), "posts.gif")
    soft = results.get(posts(0.32, SOFT))
    figure, (panel,) = new_figure(8, 5)
    for d, one in runs.items():
        panel.plot(np.linspace(*one["y"], len(one["way"])), one["way"], lw=1.2, label=f"2 R0 = {d:g}")
    panel.plot([0.5, 7], [0.95, 0.95 + 6.5 * SHIFT], "k--", lw=0.8, label="posts")
    dress(panel, grid="both", xlabel="along the flow, rows", ylabel="aside")
    panel.legend(frameon=False, fontsize=8)
    save_figure(figure, home / "posts.png")
    return {
        "largest_zigzag": f"{max(d for d, one in runs.items() if mode(one) == 'zigzag'):g}",
        "least_displaced": f"{min(d for d, one in runs.items() if mode(one) == 'displaced'):g}",
        "posts_critical": f"{CRITICAL:.2f}",
        "soft_mode": mode(soft),
        "seconds": seconds(*runs.values(), soft),
    }


SCENE = Scene("posts", fill, long=True)
