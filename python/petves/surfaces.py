"""Runs in three dimensions: the files that they leave, as arrays."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from petves.errors import RunError
from petves.runfiles import RunFolder, read_h5


def _frames(file: h5py.File) -> dict[str, Any]:
    """Return what a SurfaceRun has of run.h5. A frame's values are written before its time, which counts it."""
    time, vesicles, degree = file["time"][:], int(file.attrs["vesicles"]), int(file.attrs["degree"])
    if not len(time):
        raise RunError(f"{file.filename}: no saved time in it")
    n = 2 * (degree + 1) ** 2 + 2

    def rows(name: str, *shape: int) -> np.ndarray:
        return file["vesicle"][name][: len(time)].reshape(len(time), vesicles, *shape)

    return {
        "degree": degree,
        "nu": float(file.attrs["nu"]),
        "bending": np.ravel(file.attrs["vesicle_bending"]),
        "time": time,
        "points": rows("points", n, 3),
        "velocity": rows("velocity", n, 3),
        "tension": rows("tension", n),
        "coefficients": rows("coefficients", 3, (degree + 1) ** 2),
        "triangles": file["vesicle/triangles"][: 2 * (n - 2)],
    }


@dataclass(kw_only=True)
class SurfaceRun(RunFolder):
    """One run in three dimensions; see `petves.runfiles.RunFolder` for what runs in the plane have too.

    Attributes
    ----------
    degree : int
        Degree p of the spherical harmonics.
    points, velocity : ndarray, shape (T, vesicles, n, 3)
        Points of each surface (length): p + 1 latitudes of 2p + 2 points, then both poles; the velocity there.
    tension : ndarray, shape (T, vesicles, n)
        Tension at the points (length^3/time^2).
    coefficients : ndarray, shape (T, vesicles, 3, (p + 1)^2)
        Of the real spherical harmonics of x, y and z (length).
    triangles : ndarray, shape (m, 3)
        Triangles of a surface, by the numbers of its points, counter-clockwise from outside.
    """

    degree: int
    points: np.ndarray
    velocity: np.ndarray
    coefficients: np.ndarray
    triangles: np.ndarray
    columns = "step time energy_bending area_error volume_error inclination coupled_its wall"
    read_frames = staticmethod(_frames)


def is_space(folder: str | Path) -> bool:
    """Return whether the folder is that of a run in three dimensions."""
    path = Path(folder) / "run.h5"
    return path.exists() and read_h5(path, lambda file: file.attrs.get("dim", 2) == 3)
