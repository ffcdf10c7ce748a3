"""One hundred heavy vesicles that sink in a closed box."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from petves.rheology import area_fraction_profile
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, film, moments, seconds, with_pictures

TIMES = (0, 21, 60, 102)


def hundred(pictures: Path) -> Case:
    """Return the run: mean height at TIMES, fraction in the lowest fifth of the box, gap, errors, energy of gravity."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        moments(folder, pictures / "hundred.png", TIMES, width=12)
        film(folder, pictures / "hundred.gif", rate=8, width=400)
        run = Run.read(folder)
        frames = [int(np.abs(run.time - t).argmin()) for t in TIMES]
        low = [area_fraction_profile(run, frame, 5)[1][0] for frame in frames]
        energy = series["energy_gravity"] + series["energy_bending"] + series["energy_contact"]
        return {
            "height": [float(np.interp(t, series["time"], series["center_y"])) for t in TIMES],
            "low": low,
            "gap": np.nanmin(series["gap"]),
            "area": np.abs(series["area_error"]).max(),
            "length": np.abs(series["length_error"]).max(),
            "rise": np.diff(energy).max() / (energy[0] - energy[-1]),
            "steps": len(series["time"]) - 1,
        }

    return case("", "hundred", "", measure)


def fill(results: Results) -> Values:
    """Make the run; return the values."""
    one = with_pictures(results, hundred(results.path.parent), "hundred.png", "hundred.gif")
    rows = [f"| {t} | {y:.2f} | {low:.2f} |" for t, y, low in zip(TIMES, one["height"], one["low"])]
    return {
        "hundred_rows": "\n".join(rows),
        "hundred_gap": f"{one['gap']:.3f}",
        "hundred_errors": f"{one['area']:.0e}, {one['length']:.0e}",
        "hundred_steps": f"{one['steps']}",
        "hundred_seconds": seconds(one),
    }


SCENE = Scene("hundred", fill, long=True)
