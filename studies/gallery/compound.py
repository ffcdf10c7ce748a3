"""A disc in a vesicle in shear, which makes it tumble where the disc is large."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

CASES = ((0.8, (0.3, 0.5, 0.55)), (0.9, (0.3, 0.5, 0.55, 0.6, 0.65, 0.7)))
"""V and the radii of the disc."""
EXACT = {(0.8, 0.3): 0.118969, (0.8, 0.5): 0.043591}
"""Steady angle over pi by V and radius, to 2e-6: a boundary integral of its own (steps to 0)."""


def compound(volume: float, radius: float, step: float, pictures: Path | None = None) -> Case:
    """Return the steady angle, or half a turn's strain, and the thinnest film."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "compound.png", (20, 23, 26, 28.5, 31.5), (-1.5, 1.5, -1.5, 1.5))
        angle = np.unwrap(2 * series["inclination"]) / 2
        upright = -np.pi * np.arange(0.5, -angle[-1] / np.pi)
        passed = np.interp(-upright, -angle, series["time"])
        half = passed[-1] - passed[-2] if angle[-1] < -2 * np.pi else None
        found = {"angle": angle[-1] / np.pi, "half": half, "gap": series["gap"].min()}
        return found | {"its": series["coupled_its"].mean()}

    changes = (
        f"-vesicle_reduced_area {volume} -vesicle_area {np.pi * volume!r} -obstacle_radius {radius} -time_step {step}"
    )
    return case(f"{volume}_{radius}_{step}", "compound", changes, measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    rows, runs = [], []
    for volume, radii in CASES:
        for radius in radii:
            drawn = (volume, radius) == (0.9, 0.6)
            one = compound(volume, radius, 0.05, results.path.parent if drawn else None)
            found = with_pictures(results, one, "compound.png") if drawn else results.get(one)
            fine = results.get(compound(volume, radius, 0.025))
            tumbles = f"half a turn in {found['half']:.2f}, {fine['half']:.2f}" if found["half"] else ""
            motion = tumbles or f"tank-treads at {found['angle']:.5f} pi"
            exact = f"{EXACT[volume, radius]:.5f} pi" if (volume, radius) in EXACT else ""
            rows.append([volume, radius, motion, exact, f"{found['gap']:.3f}", f"{found['its']:.1f}"])
            runs += [found, fine]
    header = ["V", "radius", "motion", "boundary integral", "thinnest film", "iterations"]
    return {"compounds": [header, *rows], "seconds": seconds(*runs)}


SCENE = Scene("compound", fill)
