"""A Couette cell with no, one and many vesicles: torque on the inner circle."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

INNER, OUTER = 0.2, 0.45
EXACT = 4 * np.pi * (INNER * OUTER) ** 2 / (OUTER**2 - INNER**2)
"""Torque without vesicles, nu = rate = 1."""
MANY = 42
ONE = f"-vesicle_count 1 -vesicle_center 0.825,0.5 -vesicle_angle 90 -time_step 0.2"
WHAT = {"none": "-vesicle_shape none -allow_unused_options true -time_end 0.2", "one": ONE, "many": ""}


def couette(what: str, pictures: Path | None = None) -> Case:
    """Return the mean torque on the inner circle from the middle of the run on."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "couette.png", (0, 2, 5, 10), rows=2, width=9)
        torque = -series["obstacle_torque_1"]
        late = series["time"] >= series["time"][-1] / 2
        return {"mean": torque[late].mean()}

    return case(what, "couette", WHAT[what], measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    found = {what: results.get(couette(what)) for what in ("none", "one")}
    found["many"] = with_pictures(results, couette("many", results.path.parent), "couette.png")
    part = 0.003 / (np.pi * (OUTER**2 - INNER**2))
    added = {what: one["mean"] / EXACT - 1 for what, one in found.items()}
    return {
        "couette_off": f"{abs(added['none']):.0e}",
        "couette_fraction": f"{MANY * part:.2f}",
        "intrinsic_one": f"{added['one'] / part:.2f}",
        "intrinsic_many": f"{added['many'] / (MANY * part):.2f}",
        "seconds": seconds(*found.values()),
    }


SCENE = Scene("couette", fill)
