"""Two vesicles passing one another in shear."""

from __future__ import annotations

from pathlib import Path

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, least, moments, seconds, with_pictures

EXACT = {"center": (5.32145, 4.28874), "gap": 0.1153}
"""First centre at t = 15 and least gap: boundary integral of docs/evidence.md (1e-5; the gap to its digits)."""
STEPS = (0.1, 0.05, 0.025)


def passing(cells: int, dt: float, pictures: Path | None = None) -> Case:
    """Return the run on cells^2."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "passing.png", (0, 8, 11, 15), (1, 7, 2.5, 5.5), rows=2)
            film(folder, pictures / "passing.gif")
        gap, time = least(series)
        return {"gap": gap, "time": time, "center": [series[f"center_{c}_1"][-1] for c in "xy"]}

    return case(f"{cells}_{dt:g}", "passing", f"-domain_cells {cells},{cells} -time_step {dt:g}", measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    runs = {(32, dt): results.get(passing(32, dt)) for dt in STEPS}
    own = passing(64, 0.025, results.path.parent)
    runs[64, 0.025] = with_pictures(results, own, "passing.png", "passing.gif")
    rows = [
        f"| {cells}^2 | {dt:g} | {one['gap']:.4f} | {one['time']:.2f} | {one['center'][0]:.5f}, {one['center'][1]:.5f} "
        f"| {one['center'][0] - EXACT['center'][0]:+.0e}, {one['center'][1] - EXACT['center'][1]:+.0e} | {seconds(one)} |"
        for (cells, dt), one in runs.items()
    ]
    return {"passing_rows": "\n".join(rows)}


SCENE = Scene("passing", fill)
