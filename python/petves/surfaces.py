"""Runs in three dimensions: the files that they leave, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from petves.errors import RunError
from petves.files import read_file, read_summary
from petves.runfiles import read_h5, read_series

if TYPE_CHECKING:
    import xarray


@dataclass
class SurfaceRun:
    """One run in three dimensions.

    Attributes
    ----------
    folder : Path
        The run's ``-output_dir``.
    series : dict of str to ndarray
        Columns of series.csv, one value a step.
    degree : int
        Degree p of the spherical harmonics.
    nu : float
        Viscosity (length^2/time).
    bending : ndarray, shape (vesicles,)
        Bending modulus of each (length^5/time^2).
    time : ndarray, shape (T,)
        Saved times.
    points, velocity : ndarray, shape (T, vesicles, n, 3)
        Points of each surface (length): p + 1 latitudes of 2p + 2 points, then both poles; the velocity there.
    tension : ndarray, shape (T, vesicles, n)
        Tension at the points (length^3/time^2).
    coefficients : ndarray, shape (T, vesicles, 3, (p + 1)^2)
        Of the real spherical harmonics of x, y and z (length).
    triangles : ndarray, shape (m, 3)
        Triangles of a surface, by the numbers of its points, counter-clockwise from outside.
    summary : dict
        summary.json; empty while the run has not ended.
    """

    folder: Path
    series: dict[str, np.ndarray]
    degree: int
    nu: float
    bending: np.ndarray
    time: np.ndarray
    points: np.ndarray
    velocity: np.ndarray
    tension: np.ndarray
    coefficients: np.ndarray
    triangles: np.ndarray
    summary: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: str | Path) -> SurfaceRun:
        """Read a run's folder, also of a run that is going on.

        Raises
        ------
        RunError
            When one of its files is missing or broken, or has no row or saved time yet.
        """
        folder = Path(folder)
        summary = folder / "summary.json"
        return cls(
            folder=folder,
            series=read_series(folder / "series.csv"),
            summary=read_file(summary, read_summary) if summary.exists() else {},
            **read_h5(folder / "run.h5", _frames),
        )

    @property
    def vesicles(self) -> int:
        """Number of vesicles."""
        return self.points.shape[1]

    def frame_at(self, time: float) -> int:
        """Return the number of the saved time nearest to `time`."""
        return int(np.argmin(np.abs(self.time - time)))

    def dataset(self) -> xarray.Dataset:
        """Return the run as an xarray.Dataset: columns over step, fields over (time, vesicle, point, xyz)."""
        import xarray

        from petves.dataset import unit

        where = ("time", "vesicle", "point")
        variables = {name: ("step", x) for name, x in self.series.items() if name not in ("step", "time")}
        variables |= {"points": ((*where, "xyz"), self.points), "velocity": ((*where, "xyz"), self.velocity)}
        variables |= {"tension": (where, self.tension)}
        variables |= {"coefficients": (("time", "vesicle", "xyz", "harmonic"), self.coefficients)}
        variables |= {"triangles": (("triangle", "corner"), self.triangles)}
        own = {
            "step": self.series["step"].astype(int),
            "step_time": ("step", self.series["time"]),
            "time": self.time,
            "xyz": ["x", "y", "z"],
            "vesicle": np.arange(1, self.vesicles + 1),
        }
        energies = {"energy_bending", *(f"energy_bending_{v + 1}" for v in range(self.vesicles))}
        about = {"folder": str(self.folder), "degree": self.degree, "nu": self.nu}
        data = xarray.Dataset(variables, own, about | {"reason": self.summary.get("reason", "")})
        for name in data.variables:
            data[name].attrs["units"] = "length^5/time^2" if name in energies else unit(str(name))
        return data


def is_space(folder: str | Path) -> bool:
    """Return whether the folder is that of a run in three dimensions."""
    path = Path(folder) / "run.h5"
    return path.exists() and read_h5(path, lambda file: file.attrs.get("dim", 2) == 3)


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
