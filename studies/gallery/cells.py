"""Capsules of three perimeters in a channel: what they add to the pressure gradient."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

PUBLISHED = {1.0: 1.17, 1.6: 1.08, 3.0: 1.73}
"""Viscosity at 0.2 over that at 0.05, by perimeter over a circle's: Bryngelson and Freund (2016)."""
PLAIN = 2 * 25 / 10**2
"""Gradient of plain fluid: 2 nu U/H^2, H the half width."""

DRAWN = {1.6: "cells.png", 3.0: "cells_thin.png"}
"""Pictures, by perimeter, of the fraction 0.2."""
NECK, FILLET, BULB, CENTER = 0.15, 1.0, 0.36515813, 4.09753960
"""Two discs of radius BULB at +-CENTER, joined by a neck of width 2 NECK with FILLET's radius: area pi, perimeter 6 pi."""


def dog_bone(points: int = 160) -> np.ndarray:
    """Return points of equal distances on the outline of the two discs and their neck, as complex numbers."""
    lean = np.arcsin((NECK + FILLET) / (BULB + FILLET))
    bulb = CENTER + BULB * np.exp(1j * np.linspace(0, np.pi - lean, 400))
    fillet = np.exp(-1j * np.linspace(lean, np.pi / 2, 200)) * FILLET
    fillet += CENTER - (BULB + FILLET) * np.cos(lean) + 1j * (NECK + FILLET)
    half = np.concatenate([bulb, fillet, -fillet[::-1].conj(), -bulb[::-1].conj()])
    outline = np.concatenate([half, half[::-1].conj()])
    along = np.concatenate([[0], np.abs(np.diff(outline)).cumsum()])
    return np.interp(along[-1] * np.arange(points) / points, along, outline)


def dog_bones(count: int) -> str:
    """Return up to 26 thin cells along the channel, two in each of 13 rows, a little tilted, as the text of a file."""
    blocks = []
    for place in np.linspace(0, 24, count).round().astype(int):
        row, tilt = place // 2, 0.05 * (-1) ** place
        center = 20 * (0.618034 * row % 1) + 10 * (place % 2) + 1j * (1 + 1.5 * row)
        cell = center + np.exp(1j * tilt) * dog_bone()
        blocks.append("".join(f"{z.real:.6f} {z.imag:.6f}\n" for z in cell))
    return "\n".join(blocks)


def cells(perimeter: float, fraction: float, picture: Path | None = None) -> Case:
    """Return the mean of the gradient over that of plain fluid, from half the time on, and its mean deviation there."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if picture:
            moments(folder, picture, (0, 2, 16))
        with h5py.File(folder / "run.h5") as file:
            gradient = -file["fluid/pressure_gradient"][:].ravel() / PLAIN
        late = gradient[len(gradient) // 2 :]
        return {"viscosity": late.mean(), "deviation": late.std(), "its": series["coupled_its"][5:].mean()}

    name = f"{perimeter:g}_{fraction:g}"
    if perimeter < 2:
        changes = f"-vesicle_reduced_area {min(1 / perimeter**2, 0.9999)} -vesicle_packing {fraction}"
        return case(name, "cells", f"{changes} -vesicle_markers {41 if perimeter < 1.1 else 51}", measure)
    changes = "-vesicle_shape file -vesicle_markers 121 -domain_cells 128,128 -time_adapt_tol 1e-2"
    thin = case(name, "cells", f"{changes} -contact_repulsion 1000 -contact_repulsion_range 0.3", measure)
    for option in ("packing", "packing_seed", "area", "reduced_area"):
        del thin.options[f"-vesicle_{option}"]
    thin.files["-vesicle_file"] = dog_bones(round(fraction * 20**2 / np.pi))
    return thin


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    rows, runs = [], []
    for perimeter, published in PUBLISHED.items():
        few = results.get(cells(perimeter, 0.05))
        drawn = [results.path.parent / DRAWN[perimeter]] if perimeter in DRAWN else []
        many = with_pictures(results, cells(perimeter, 0.2, *drawn), *(path.name for path in drawn))
        values = [f"{one['viscosity']:.3f} +- {one['deviation']:.3f}" for one in (few, many)]
        ratio = many["viscosity"] / few["viscosity"]
        rows.append([perimeter, *values, f"{ratio:.3f}", published, f"{many['its']:.1f}"])
        runs += [few, many]
    header = ["perimeter", "fraction 0.05", "fraction 0.2", "ratio", "published", "iterations"]
    return {"red_cells": [header, *rows], "seconds": seconds(*runs)}


SCENE = Scene("cells", fill, long=True)
