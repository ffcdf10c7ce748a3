"""Heavy vesicles that sink: one in a box, two in tandem."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

TIMES = (0.5, 1, 1.5, 2)
EXACT = (-0.06962, -0.138778, -0.207621, -0.276173)
"""Height of the centre of one vesicle at TIMES over R0: spectral boundary integral, stated uncertainty 1e-5."""
LATE = 40


def settling() -> Case:
    """Return one vesicle: height at TIMES."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        return {"height": [series["center_y"][np.abs(series["time"] - t).argmin()] for t in TIMES]}

    return case("default", "settling", "", measure)


def tandem(cells: int, pictures: Path | None = None) -> Case:
    """Return two vesicles: speeds at t = LATE."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "tandem.png", (0, 20, 40, 60), (-4, 4, -12, 7))
        row = int(np.abs(series["time"] - LATE).argmin())
        return {"speeds": [series[f"velocity_y_{v}"][row] for v in (1, 2)]}

    return case(f"{cells}", "tandem", f"-domain_cells {cells},{2 * cells}", measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    one = results.get(settling())
    coarse = with_pictures(results, tandem(32, results.path.parent), "tandem.png")
    fine = results.get(tandem(64))
    speeds = [", ".join(f"{-speed:.5f}" for speed in found["speeds"]) for found in (coarse, fine)]
    return {
        "settling_off": f"{np.abs(np.subtract(one['height'], EXACT)).max():.0e}",
        "tandem_speeds": speeds[0] + ("" if speeds[1] == speeds[0] else f" ({speeds[1]})"),
        "seconds": seconds(one, coarse, fine),
    }


SCENE = Scene("settling", fill)
