"""Two vesicles passing one another in shear."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, least, moments, seconds, with_pictures

EXACT = {"center": (5.32145, 4.28874), "gap": 0.1153}
"""First centre at t = 15 and least gap: boundary integral of docs/evidence.md (1e-5; the gap to its digits)."""
STEPS = (0.1, 0.05, 0.025)


def passing(dt: float, pictures: Path | None = None) -> Case:
    """Return the run with this step."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "passing.png", (0, 8, 11, 15), (1, 7, 2.5, 5.5), rows=2)
            film(folder, pictures / "passing.gif")
        return {"gap": least(series)[0], "center": [series[f"center_{c}_1"][-1] for c in "xy"]}

    return case(f"32_{dt:g}", "passing", f"-domain_cells 32,32 -time_step {dt:g}", measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    runs = [results.get(passing(dt)) for dt in STEPS[:-1]]
    runs.append(with_pictures(results, passing(STEPS[-1], results.path.parent), "passing.png", "passing.gif"))
    off = [np.hypot(*np.subtract(one["center"], EXACT["center"])) for one in runs]
    return {
        "passing_off": ", ".join(f"{value:.0e}" for value in off),
        "passing_gap": f"{runs[-1]['gap']:.4f}",
        "seconds": seconds(*runs),
    }


SCENE = Scene("passing", fill)
