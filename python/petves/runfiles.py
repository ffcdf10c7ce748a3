"""Reading what a run writes: series.csv, and HDF5 files without their fields."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np

from petves.curves import KINDS
from petves.errors import RunError
from petves.files import read_file

T = TypeVar("T")

HUGE = 1e100  # a place or tension above this is no number of a run's


def read_series(path: str | Path) -> dict[str, np.ndarray]:
    """Read the whole rows of series.csv into one array a column; an empty entry is NaN."""
    return read_file(Path(path), _series)


def _series(path: Path) -> dict[str, np.ndarray]:
    names, *rows = path.read_text().split("\n")[:-1] or [""]  # a last row without an end is not whole
    if rows and rows[-1].count(",") != names.count(","):
        rows.pop()
    if not rows:
        raise RunError(f"{path}: no steps in it")
    number = lambda entry: float(entry or "nan")
    table = np.loadtxt(rows, delimiter=",", ndmin=2, comments=None, encoding=None, converters=number)
    series = dict(zip(names.split(","), table.T, strict=True))
    _need(all(np.isfinite(series[name]).all() for name in ("step", "time") if name in series), "no step or time")
    return series


def _need(good: bool | np.bool_, what: str) -> None:
    """Refuse what no run writes."""
    if not good:
        raise ValueError(what)


def read_h5(path: Path, read: Callable[[h5py.File], T]) -> T:
    """Return what `read` makes of an HDF5 file, whose data must all be in the file itself.

    It is opened without a lock, since the run may be going on; as this process has it open already, if it has.
    """

    def inside(path: Path) -> T:
        try:
            file = h5py.File(path, "r", locking=False)
        except OSError as error:
            if "locking flag" not in str(error):
                raise
            file = h5py.File(path, "r")
        with file:
            _check_own(file)
            return read(file)

    return read_file(path, inside, "; of a killed run, -restart makes it anew")


def _check_own(file: h5py.File) -> None:
    """Refuse links, and values that HDF5 would take from other files: a folder may come from anybody."""
    found: list[Any] = []
    file.id.links.visit(lambda name, link: found.append((name, link.type == h5py.h5l.TYPE_HARD)), info=True)
    file.visititems(lambda name, x: found.append((name, isinstance(x, h5py.Group) or not (x.external or x.is_virtual))))
    for name, own in found:
        _need(own, f"{name}: not in this file")


def read_frames(file: h5py.File) -> dict[str, Any]:
    """Return what a Run has of run.h5, or in three dimensions a SurfaceRun, by its names. A frame's values are written
    before its time, which counts it."""
    time = file["time"][:]
    if not len(time):
        raise RunError(f"{file.filename}: no saved time in it")
    _need(np.isfinite(time).all() and (np.diff(time) > 0).all(), "times do not increase")
    return {"time": time, "nu": _number(file, "nu")} | (_space if file.attrs.get("dim", 2) == 3 else _plane)(file, time)


def _plane(file: h5py.File, time: np.ndarray) -> dict[str, Any]:
    box = np.asarray(file.attrs["box"], float)
    start = file.attrs.get("vesicle_start", file["vesicle_start"] if "vesicle_start" in file else None)
    start, h = np.atleast_1d(start).astype(int), _number(file, "h")
    _need(box.shape == (4,) and np.isfinite(box).all() and h > 0, "no box")
    cells = (box[1::2] - box[::2]) / h
    _need((cells > 0.5).all() and np.allclose(cells, np.round(cells)), "no whole cells")
    for name in "uvp":
        _need(file["fluid"][name].shape[1:] == tuple(np.round(cells[::-1])), f"fluid/{name}: other cells")
    _need(start[0] == 0 and (np.diff(start) > 2).all(), "vesicle_start")

    def rows(name: str, *shape: int) -> np.ndarray:
        if name.split("/")[0] not in file:
            return np.zeros((len(time), 0, *shape[1:]))
        _need(file[name].shape[1:] == shape and len(file[name]) >= len(time), f"{name}: other sizes")
        values = file[name][: len(time)]
        _need(values.dtype.kind == "f" and (np.abs(values) < HUGE).all(), f"{name}: not finite")
        return values

    count = len(start) - 1
    return {
        "box": box,
        "h": h,
        "c_b": _number(file, "c_b"),
        "pressure_gradient": rows("fluid/pressure_gradient"),
        "markers": rows("vesicle/markers", start[-1], 2),
        "velocity": rows("vesicle/velocity", start[-1], 2),
        "tension": rows("vesicle/tension", start[-1]),
        "stretch": rows("vesicle/stretch", start[-1]) if "vesicle/stretch" in file else np.ones((len(time), start[-1])),
        "start": start,
        "tracers": rows("tracers/points", file["tracers/points"].shape[1] if "tracers" in file else 0, 2),
        "viscosity_ratio": np.ones(count) * file.attrs.get("vesicle_viscosity_ratio", 1.0),
        "bending": np.ones(count) * np.ravel(file.attrs.get("vesicle_c_b", file.attrs["c_b"])),
    } | _obstacles(file, rows)


def _obstacles(file: h5py.File, rows: Callable[..., np.ndarray]) -> dict[str, Any]:
    """Return what a Run has of obstacles, if there are any."""
    if "obstacle" not in file:
        return {"obstacle_force": rows("obstacle/force", 0, 2)}
    first, places = file.attrs["obstacle_start"], file["obstacle/markers"]
    moving = rows("obstacle/markers", first[-1], 2) if places.ndim == 3 else np.zeros((0, 0, 2))
    places = moving[-1] if len(moving) else places[:]
    _need(places.shape == (first[-1], 2) and np.isfinite(places).all(), "obstacle/markers")
    return {
        "obstacles": np.split(places, first[1:-1]),
        "obstacle_markers": moving,
        "obstacle_force": rows("obstacle/force", first[-1], 2),
        "obstacle_kinds": [KINDS[kind] for kind in np.atleast_1d(file.attrs["obstacle_kind"])],
    }


def _number(file: h5py.File, name: str) -> float:
    number = float(np.ravel(file.attrs[name])[0])
    _need(np.isfinite(number), name)
    return number


def _space(file: h5py.File, time: np.ndarray) -> dict[str, Any]:
    vesicles, degree = int(file.attrs["vesicles"]), int(file.attrs["degree"])
    n = 2 * (degree + 1) ** 2 + 2

    def rows(name: str, *shape: int) -> np.ndarray:
        return file["vesicle"][name][: len(time)].reshape(len(time), vesicles, *shape)

    return {
        "degree": degree,
        "bending": np.ravel(file.attrs["vesicle_bending"]),
        "points": rows("points", n, 3),
        "velocity": rows("velocity", n, 3),
        "tension": rows("tension", n),
        "coefficients": rows("coefficients", 3, (degree + 1) ** 2),
        "triangles": file["vesicle/triangles"][: 2 * (n - 2)],
    }
