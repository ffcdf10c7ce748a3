"""Reading what a run writes: series.csv, and HDF5 files without their fields; and what all runs have."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import h5py
import numpy as np

from petves.curves import KINDS
from petves.errors import RunError
from petves.files import read_file, read_summary
from petves.measures import ENERGIES

T = TypeVar("T")

R = TypeVar("R", bound="RunFolder")

#: A place or tension above this is no number of a run's.
HUGE = 1e100

#: Vesicles up to which series.csv has columns of each.
FEW = 40


@dataclass(kw_only=True)
class RunFolder:
    """What runs in the plane, `petves.Run`, and in three dimensions, `petves.surfaces.SurfaceRun`, have in common.

    Attributes
    ----------
    folder : Path
        The run's ``-output_dir``.
    series : dict of str to ndarray
        Columns of series.csv, one value a step (step 0 first); an empty entry is NaN.
    nu : float
        Viscosity (length^2/time).
    time : ndarray, shape (T,)
        Saved times.
    bending : ndarray, shape (vesicles,)
        Bending stiffness of each (length^5/time^2).
    tension : ndarray, shape (T, ...)
        Tension of the membranes (length^3/time^2).
    summary : dict
        summary.json; empty while the run has not ended.
    """

    folder: Path
    series: dict[str, np.ndarray]
    nu: float
    time: np.ndarray
    bending: np.ndarray
    tension: np.ndarray
    summary: dict[str, Any]
    columns: ClassVar[str]
    read_frames: ClassVar[Callable[[h5py.File], dict[str, Any]]]

    @classmethod
    def read(cls: type[R], folder: str | Path) -> R:
        """Read a run's folder; of the fluid in the plane the fields are left on disk, see `Run.fields`.

        The run may be going on, or have been killed: what its files have whole is read, series.csv to its last whole row
        and run.h5 to its last saved time.

        Raises
        ------
        RunError
            When the folder or one of its files is missing or broken, or has no row or saved time yet. Where a killed run
            has left run.h5 broken, a restart makes it anew, and `read_series` reads series.csv alone.
        """
        folder = Path(folder)
        if not folder.is_dir():
            raise RunError(f"{folder}: no such folder; give the -output_dir of a run")
        frames = read_h5(folder / "run.h5", cls.read_frames)
        series, summary = read_series(folder / "series.csv"), folder / "summary.json"
        missing = [name for name in cls.columns.split() if name not in series]
        if missing:
            raise RunError(f"{folder / 'series.csv'}: has no column {missing[0]}")
        ended = read_file(summary, read_summary) if summary.exists() else {}
        return cls(folder=folder, series=series, summary=ended, **frames)

    @property
    def vesicles(self) -> int:
        """Number of vesicles."""
        return len(self.bending)

    def each(self, name: str) -> np.ndarray:
        """Return the column `name` of every vesicle at every step ("area", "center_x"), shape (steps, vesicles).

        From the suffixed columns of series.csv, or above 40 vesicles from vesicles.h5, whose last rows may be NaN while the run
        goes on.
        """
        names = [name] if self.vesicles == 1 else [f"{name}_{v + 1}" for v in range(self.vesicles)]
        if names and names[0] in self.series:
            return np.stack([self.series[column] for column in names], axis=1)
        values = np.full((len(self.series["step"]), self.vesicles), np.nan)
        found = read_h5(self.folder / "vesicles.h5", lambda file: file[name][: len(values)] if name in file else None)
        if found is None:
            raise RunError(f"column {name}: vesicles have none of that name")
        values[: len(found)] = found
        return values

    def columns_of_each(self) -> list[str]:
        """Return the names that `each` takes from vesicles.h5; none up to 40 vesicles."""
        path = self.folder / "vesicles.h5"
        if not path.is_file() or self.vesicles <= FEW:
            return []
        return read_h5(path, lambda file: [name for name in file if name not in ("step", "time")])

    def options(self) -> dict[str, str]:
        """Return the options in force (resolved.opts), without the dash; empty when the file is missing."""
        return dict(self._in_force)

    @functools.cached_property
    def _in_force(self) -> dict[str, str]:
        path = self.folder / "resolved.opts"
        lines = read_file(path, lambda x: x.read_text(errors="replace")).splitlines() if path.exists() else []
        words = [line[1:].split(" ", maxsplit=1) for line in lines if line.startswith("-")]
        return {word[0]: word[1].strip('"') if len(word) > 1 else "" for word in words}

    def energies(self) -> dict[str, np.ndarray]:
        """Return the energies that the run has at each step (length^4/time^2, in three dimensions length^5/time^2), by name,
        such as bending.

        Those that are zero at all steps are left out: without gravity or contact, and the kinetic one of unbounded fluid,
        which is not computed.
        """
        columns = {name: self.series.get(f"energy_{name}") for name in ENERGIES}
        found = {name: values for name, values in columns.items() if values is not None and values.any()}
        return found or {"kinetic": np.zeros_like(self.series["time"])}

    def frame_at(self, time: float) -> int:
        """Return the number of the saved time nearest to a time of the run."""
        low, high = self.time[[0, -1]]
        slack = 1e-9 * max(abs(low), abs(high))
        if not low - slack <= time <= high + slack:
            raise RunError(f"time {time:g}: not in the run; allowed: {low:g} to {high:g}")
        return int(np.argmin(np.abs(self.time - time)))

    def tension_range(self, frames: int | Sequence[int] | np.ndarray) -> tuple[float, float]:
        """Return the least and the largest tension at one or some saved times; 0 and 1 without a vesicle."""
        chosen = self.tension[frames]
        return (float(chosen.min()), float(chosen.max())) if chosen.size else (0.0, 1.0)


def read_series(path: str | Path) -> dict[str, np.ndarray]:
    """Read the whole rows of series.csv into one array a column; an empty entry is NaN."""
    return read_file(Path(path), _series)


def _series(path: Path) -> dict[str, np.ndarray]:
    names, *rows = path.read_text().split("\n")[:-1] or [""]  # a last row without an end is not whole
    if rows and rows[-1].count(",") != names.count(","):
        rows.pop()
    if not rows:
        raise RunError(f"{path}: no steps in it")
    table = np.loadtxt(
        rows, delimiter=",", ndmin=2, comments=None, encoding=None, converters=lambda x: float(x or "nan")
    )
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
    """Return what a Run has of run.h5, by its names. A frame's values are written before its time, which counts it."""
    if file.attrs.get("dim", 2) == 3:
        raise RunError(f"{file.filename}: a run in three dimensions; allowed: petves.load, which reads both kinds")
    time, box = file["time"][:], np.asarray(file.attrs["box"], float)
    if not len(time):
        raise RunError(f"{file.filename}: no saved time in it")
    start = file.attrs.get("vesicle_start", file["vesicle_start"] if "vesicle_start" in file else None)
    start, h = np.atleast_1d(start).astype(int), _number(file, "h")
    _need(np.isfinite(time).all() and (np.diff(time) > 0).all(), "times do not increase")
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
        "nu": _number(file, "nu"),
        "c_b": _number(file, "c_b"),
        "time": time,
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
