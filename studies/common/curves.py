"""Closed curves through markers, shape (n, 2), and how far two are apart."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

from petves import curves
from petves.run import centroid


def last_markers(folder: Path) -> np.ndarray:
    """Return the markers in a run's checkpoint, shape (n, 2)."""
    with h5py.File(folder / "checkpoint.h5") as file:
        return file["vesicle/markers"][0]


def radius(reduced_area: float) -> float:
    """Return R0 of unit area."""
    return float((1 / (np.pi * reduced_area)) ** 0.5)


def trigonometric(markers: np.ndarray, count: int = 4096) -> np.ndarray:
    """Return points of the trigonometric interpolation of markers, shape (n, 2), at equal steps of the index."""
    return curves.trigonometric(markers, count)


def at(values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return periodic values, shape (n, 2) at 0, 1/n, ..., at places in turns: trigonometric, then linear."""
    fine = trigonometric(values, 2**14)
    turns = np.arange(len(fine) + 1) / len(fine)
    return np.stack([np.interp(place % 1, turns, np.append(x, x[0])) for x in fine.T], axis=1)


def edge_lengths(points: np.ndarray) -> np.ndarray:
    """Return the lengths of the edges of a closed polygon."""
    return np.hypot(*(np.roll(points, 1, axis=0) - points).T)


def about_centroid(points: np.ndarray) -> np.ndarray:
    """Return a curve moved so that the centroid of the area inside it is 0."""
    return points - centroid(np.vstack([points, points[:1]]))


def material_distance(markers: np.ndarray, exact: np.ndarray, length: float = 1.0) -> float:
    """Return the root mean square distance of markers from a fine run's at equal material points.

    With the length of the membrane: the L2 norm along it.
    """
    apart = markers - at(exact, np.arange(len(markers)) / len(markers))
    return float(((apart**2).sum(axis=1).mean() * length) ** 0.5)


def outline_distance(markers: np.ndarray, exact: np.ndarray) -> float:
    """Return the root mean square distance of a run's outline from a fine run's, both about their centroids."""
    curve, fine = (about_centroid(trigonometric(x, n)) for x, n in ((markers, 256), (exact, 4096)))
    nearest = np.abs((curve @ [1, 1j])[:, None] - (fine @ [1, 1j])[None, :]).argmin(axis=1)
    tangent = np.roll(fine, -1, axis=0) - np.roll(fine, 1, axis=0)
    normal = (tangent / np.hypot(*tangent.T)[:, None])[nearest] @ [[0, -1], [1, 0]]
    return float((((curve - fine[nearest]) * normal).sum(axis=1) ** 2).mean() ** 0.5)


def aspect(points: np.ndarray) -> float:
    """Return the aspect, at least 1, of the second moments of the area inside a closed curve, shape (n, 2)."""
    x, y = about_centroid(points).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    c = x * y1 - x1 * y
    xy = ((2 * x * y + x * y1 + x1 * y + 2 * x1 * y1) * c).sum() / 2
    moments = [[((x * x + x * x1 + x1 * x1) * c).sum(), xy], [xy, ((y * y + y * y1 + y1 * y1) * c).sum()]]
    low, high = np.linalg.eigvalsh(moments)
    return float((high / low) ** 0.5)


def at_rest(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    """Return a Measure of a shape at rest: bending energy and what it still changes by, width, mid height, length."""
    curve = trigonometric(last_markers(folder))
    length = edge_lengths(curve).sum()
    curve = curve - curve.mean(axis=0)
    angle = series["inclination"][-1]
    along = curve @ [np.cos(angle), np.sin(angle)]
    across = curve @ [-np.sin(angle), np.cos(angle)]
    crossings = [
        across[k] - along[k] * (across[k + 1] - across[k]) / (along[k + 1] - along[k])
        for k in np.flatnonzero(np.diff(np.sign(along)))
    ]
    energy = series["energy_bending"]
    found = {"energy": energy[-1], "drift": abs(energy[-1] / energy[4 * len(energy) // 5] - 1)}
    return found | {"width": np.ptp(along), "mid_height": max(crossings) - min(crossings), "length": length}
