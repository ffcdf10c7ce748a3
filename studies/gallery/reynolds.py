"""Inertia: the inclination of a tank-treading vesicle against the Reynolds number."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, seconds

NUMBERS = (0.1, 1, 2, 5)


def reynolds(number: float, cells: int = 64) -> Case:
    """Return angle over pi and frequency over the rate at the end."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        return {"angle": series["inclination"][-1] / np.pi, "frequency": series["frequency"][-1]}

    inertia = f"-fluid_viscosity {1 / number:g} -vesicle_bending {0.1 / number:g}" if number else "-fluid_inertia none"
    step = f"-time_step {0.8 / cells if number else 0.1:g}"
    changes = f"{inertia} {step} -domain_cells {cells},{cells}"
    return case(f"{number:g}_{cells}", "reynolds", changes, measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    runs = {(number, 64): results.get(reynolds(number)) for number in (0, *NUMBERS)}
    runs[5, 96] = results.get(reynolds(5, 96))
    rows = [
        [number, f"{cells}^2", f"{one['angle']:.5f}", f"{one['frequency']:.4f}"]
        for (number, cells), one in runs.items()
    ]
    header = ["Re", "cells", "angle over pi", "frequency over the rate"]
    return {"reynolds": [header, *rows], "seconds": seconds(*runs.values())}


SCENE = Scene("reynolds", fill, long=True)
