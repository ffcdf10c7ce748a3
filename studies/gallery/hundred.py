"""One hundred heavy vesicles that sink in a closed box."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, moments, seconds, with_pictures

TIMES = (0, 21, 60, 102)


def hundred(pictures: Path) -> Case:
    """Return the run: mean height at TIMES, gap, errors."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        moments(folder, pictures / "hundred.png", TIMES, width=12)
        film(folder, pictures / "hundred.gif", rate=8, width=400)
        return {
            "height": [float(np.interp(t, series["time"], series["center_y"])) for t in TIMES],
            "gap": np.nanmin(series["gap"]),
            "area": np.abs(series["area_error"]).max(),
            "length": np.abs(series["length_error"]).max(),
        }

    return case("", "hundred", "", measure)


def fill(results: Results) -> Values:
    """Make the run; return the values."""
    one = with_pictures(results, hundred(results.path.parent), "hundred.png", "hundred.gif")
    return {
        "hundred_height": ", ".join(f"{height:.2f}" for height in one["height"]),
        "hundred_gap": f"{one['gap']:.3f}",
        "hundred_errors": f"{one['area']:.0e}, {one['length']:.0e}",
        "seconds": seconds(one),
    }


SCENE = Scene("hundred", fill, long=True)
