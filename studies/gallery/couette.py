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
    """Return the torque on the inner circle, its mean from the middle of the run on, and that on both at the end."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "couette.png", (0, 2, 5, 10), rows=2, width=9)
        torque = -series["obstacle_torque_1"]
        late = series["time"] >= series["time"][-1] / 2
        both = [series[f"obstacle_torque_{k}"][-1] for k in (1, 2)]
        return {"start": torque[1], "mean": torque[late].mean(), "end": torque[-1], "sum": both[0] + both[1]}

    return case(what, "couette", WHAT[what], measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    found = {what: results.get(couette(what)) for what in ("none", "one")}
    found["many"] = with_pictures(results, couette("many", results.path.parent), "couette.png")
    part = {"none": 0, "one": 0.003 / (np.pi * (OUTER**2 - INNER**2))}
    part["many"] = MANY * part["one"]
    rows = []
    for what, one in found.items():
        ratio = one["mean"] / EXACT
        own = f"{(ratio - 1) / part[what]:.2f}" if part[what] else ""
        rows.append(f"| {what} | {part[what]:.4f} | {one['mean']:.6f} | {ratio:.6f} | {own} | {seconds(one)} |")
    return {
        "couette_rows": "\n".join(rows),
        "couette_exact": f"{EXACT:.7f}",
        "couette_off": f"{found['none']['mean'] / EXACT - 1:.0e}",
        "couette_sum": f"{abs(found['many']['sum'] / EXACT):.0e}",
    }


SCENE = Scene("couette", fill)
