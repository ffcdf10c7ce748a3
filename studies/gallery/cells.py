"""Capsules of two perimeters in a channel: what they add to the pressure gradient."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

PUBLISHED = {1.0: 1.17, 1.6: 1.08}
"""Viscosity at 0.2 over that at 0.05, by perimeter over a circle's: Bryngelson and Freund (2016)."""
PLAIN = 2 * 25 / 10**2
"""Gradient of plain fluid: 2 nu U/H^2, H the half width."""


def cells(perimeter: float, fraction: float, pictures: Path | None = None) -> Case:
    """Return the mean of the gradient over that of plain fluid, from half the time on, and its mean deviation there."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "cells.png", (0, 2, 16))
        with h5py.File(folder / "run.h5") as file:
            gradient = -file["fluid/pressure_gradient"][:].ravel() / PLAIN
        late = gradient[len(gradient) // 2 :]
        return {"viscosity": late.mean(), "deviation": late.std(), "its": series["coupled_its"][5:].mean()}

    reduced = min(1 / perimeter**2, 0.9999)
    changes = (
        f"-vesicle_reduced_area {reduced} -vesicle_packing {fraction} -vesicle_markers {41 if perimeter < 1.1 else 51}"
    )
    return case(f"{perimeter:g}_{fraction:g}", "cells", changes, measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    rows = []
    for perimeter, published in PUBLISHED.items():
        drawn = perimeter > 1
        dense = cells(perimeter, 0.2, results.path.parent if drawn else None)
        few = results.get(cells(perimeter, 0.05))
        many = with_pictures(results, dense, "cells.png") if drawn else results.get(dense)
        values = " | ".join(f"{one['viscosity']:.3f} +- {one['deviation']:.3f}" for one in (few, many))
        ratio = many["viscosity"] / few["viscosity"]
        rows.append(
            f"| {perimeter:g} | {values} | {ratio:.3f} | {published} | {many['its']:.1f} | {seconds(few, many)} |"
        )
    return {"cells_rows": "\n".join(rows)}


SCENE = Scene("cells", fill, long=True)
