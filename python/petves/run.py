"""The files that a run leaves in its output folder, as arrays: of runs in the plane and in three dimensions."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from petves.curves import smooth_curve, solid_outline, trigonometric
from petves.errors import RunError as RunError
from petves.files import read_file, read_summary
from petves.measures import ENERGIES
from petves.runfiles import read_frames, read_h5
from petves.runfiles import read_series as read_series

CURVE = 6  # points of a vesicle's smooth curve for each of its markers
WIDEST = 1000  # periods of the box that a curve may span
FEW = 40  # vesicles up to which series.csv has columns of each


@dataclass(kw_only=True)
class RunFolder:
    """What runs in the plane and in three dimensions have in common; `Run` says what the attributes are."""

    folder: Path
    series: dict[str, np.ndarray]
    nu: float
    time: np.ndarray
    bending: np.ndarray
    tension: np.ndarray
    summary: dict[str, Any]
    columns: ClassVar[str]

    @staticmethod
    def read(folder: str | Path) -> "Run | SurfaceRun":
        """Read a run's folder, in the plane or in three dimensions; fields of the fluid are left on disk, see `Run.fields`.

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
        frames = read_h5(folder / "run.h5", read_frames)
        kind = SurfaceRun if "triangles" in frames else Run
        series, summary = read_series(folder / "series.csv"), folder / "summary.json"
        missing = [name for name in kind.columns.split() if name not in series]
        if missing:
            raise RunError(f"{folder / 'series.csv'}: has no column {missing[0]}")
        ended = read_file(summary, read_summary) if summary.exists() else {}
        return kind(folder=folder, series=series, summary=ended, **frames)

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

    def spread_frames(self, most: int) -> np.ndarray:
        """Return the numbers of saved times, evenly spread, of all if they are no more than `most`."""
        count = len(self.time)
        return np.unique(np.linspace(0, count - 1, min(most, count)).round().astype(int))

    def tension_range(self, frames: int | Sequence[int] | np.ndarray) -> tuple[float, float]:
        """Return the least and the largest tension at the saved times `frames`, one or some; 0 and 1 without a vesicle."""
        chosen = self.tension[frames]
        return (float(chosen.min()), float(chosen.max())) if chosen.size else (0.0, 1.0)


@dataclass(kw_only=True)
class Run(RunFolder):
    """One run of petves in the plane.

    Attributes
    ----------
    folder : Path
        The run's ``-output_dir``.
    series : dict of str to ndarray
        Columns of series.csv, one value a step (step 0 first); an empty entry is NaN.
    box : ndarray, shape (4,)
        x_min, x_max, y_min, y_max (length).
    h, nu, c_b : float
        Cell size (length), viscosity (length^2/time), bending stiffness (the largest, where vesicles differ).
    time : ndarray, shape (T,)
        Saved times.
    pressure_gradient : ndarray, shape (T,)
        Mean gradient of the pressure along x (length/time^2), which is not in the p of `fields`.
    markers, velocity : ndarray, shape (T, M, 2)
        Markers (length) and their velocity (length/time); M = 0 without a vesicle.
    tension, stretch : ndarray, shape (T, M)
        Tension, and length over that at rest; entry k is on the edge from marker k-1 to marker k, or at marker k with spectral edges.
    start : ndarray, shape (vesicles + 1,)
        First marker of each vesicle, and the number of markers.
    viscosity_ratio : ndarray, shape (vesicles,)
        Viscosity inside over that outside.
    bending : ndarray, shape (vesicles,)
        Bending stiffness of each (length^5/time^2).
    obstacles : list of ndarray, each of shape (n, 2)
        Markers of each obstacle (length), counter-clockwise around a solid, clockwise around fluid in one; the solid is on
        the left of curves that are not closed. Where they move, those of the last saved time.
    obstacle_markers : ndarray, shape (T, W, 2)
        The same at each saved time where obstacles move; else T = 0. Not wrapped, as vesicles' are not.
    obstacle_force : ndarray, shape (T, W, 2)
        Force of the fluid on the markers of all obstacles, one obstacle after another (length^3/time^2).
    obstacle_kinds : list of str
        "closed"; "open", with both ends at a wall; or "spanning" a period of the box.
    tracers : ndarray, shape (T, n, 2)
        Places of the tracers (length), not wrapped; n = 0 without any.
    summary : dict
        summary.json; empty while the run has not ended.

    Notes
    -----
    In the methods `frame` is the number of a saved time, -1 the last one, and `vesicle` the number of a vesicle from 0.
    """

    box: np.ndarray
    h: float
    c_b: float
    pressure_gradient: np.ndarray
    markers: np.ndarray
    velocity: np.ndarray
    stretch: np.ndarray
    start: np.ndarray
    viscosity_ratio: np.ndarray
    obstacles: list[np.ndarray] = field(default_factory=list)
    obstacle_markers: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, 2)))
    obstacle_force: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, 2)))
    obstacle_kinds: list[str] = field(default_factory=list)
    tracers: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, 2)))
    columns = "step time energy_kinetic energy_bending area_error length_error div_max inclination frequency wall"
    columns += " nsolve tension_its bending_its coupled_its"

    @functools.cached_property
    def periods(self) -> tuple[float, float]:
        """The box's periods in x and y (length); 0 where it is not periodic."""
        options = self._in_force
        wrapped = np.array([options.get(f"domain_bc_{c}") == "periodic" for c in "xy"])
        return tuple(map(float, wrapped * (self.box[1::2] - self.box[::2])))

    @property
    def walls(self) -> str:
        """The directions that walls bound: "x", "y", "xy" or ""."""
        return "".join(c for c in "xy" if self._in_force.get(f"domain_bc_{c}", "wall") == "wall")

    def images_of(self, outline: np.ndarray, limits: np.ndarray | None = None) -> list[np.ndarray]:
        """Return every image of the closed `outline`, shape (n + 1, 2), that reaches into the box, or into `limits` (4,).

        Markers are not wrapped: a vesicle that has left a periodic box goes on outside of it. Here it is in the box, and once
        more at the other side where it lies across the seam.
        """
        box = self.box if limits is None else limits
        shifts = []
        for d, period in enumerate(self.periods):
            low, high = outline[:, d].min(), outline[:, d].max()
            if period and high - low > WIDEST * period:
                wide = f"a curve as wide as {(high - low) / period:.3g} periods of the box"
                raise RunError(f"{self.folder / 'run.h5'}: {wide}")
            ends = [(box[2 * d] - high) / period, (box[2 * d + 1] - low) / period] if period else [-1, 1]
            shifts.append(period * np.arange(np.floor(ends[0]) + 1, np.ceil(ends[1])))
        return [outline + (x, y) for x in shifts[0] for y in shifts[1]]

    def fields(self, frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return u, v, p at cell centres at a saved time, each of shape (ny, nx)."""
        place = range(len(self.time))[frame]  # a run that goes on may have more
        return read_h5(self.folder / "run.h5", lambda file: tuple(file["fluid"][name][place] for name in "uvp"))

    def cell_centers(self) -> tuple[np.ndarray, np.ndarray]:
        """Return x, shape (nx,), and y, shape (ny,), of the cell centres."""
        sides = np.reshape(self.box, (2, 2))
        return tuple(low + self.h * (0.5 + np.arange(round((high - low) / self.h))) for low, high in sides)

    def outline(self, frame: int, vesicle: int = 0) -> np.ndarray:
        """Return one vesicle's markers at a saved time, the first repeated at the end, shape (n + 1, 2)."""
        points = self.markers[frame, self.start[vesicle] : self.start[vesicle + 1]]
        return np.vstack([points, points[:1]])

    def curve(self, frame: int, vesicle: int = 0) -> np.ndarray:
        """Return the smooth closed curve through one vesicle's markers, by their Fourier series.

        Shape (CURVE n + 1, 2) for n markers: CURVE points a marker, the marker first; the first point is repeated at the end.
        """
        return smooth_curve(self.outline(frame, vesicle)[:-1], CURVE)

    def obstacles_at(self, frame: int) -> list[np.ndarray]:
        """Return the markers of each obstacle at a saved time (length), as `obstacles` has them."""
        if not len(self.obstacle_markers):
            return self.obstacles
        return np.split(self.obstacle_markers[frame], np.cumsum([len(points) for points in self.obstacles])[:-1])

    def obstacle_curve(self, obstacle: int, frame: int = -1) -> np.ndarray:
        """Return the smooth closed outline of the solid at an obstacle, numbered from 0, as `curve` does a vesicle's.

        A curve that is not closed goes on along its wall, or along the next one or the side of the box on its left.
        """
        return solid_outline(self.obstacles_at(frame), self.obstacle_kinds, obstacle, self.box, CURVE)

    def curve_tension(self, frame: int, vesicle: int = 0) -> np.ndarray:
        """Return the tension between the points of `curve`, shape (CURVE n,), by its Fourier series."""
        values = self.edge_tension(frame, vesicle)
        at_edges = self._in_force.get("membrane_derivative") != "spectral"  # entry k half a spacing before marker k
        return trigonometric(values, CURVE * len(values), 0.5 / CURVE + (0.5 if at_edges else 0.0))

    def centroid(self, frame: int, vesicle: int = 0) -> np.ndarray:
        """Return the centroid of the area of one vesicle at a saved time (length), shape (2,)."""
        return centroid(self.outline(frame, vesicle))

    def phase_angle(self, frame: int, vesicle: int = 0) -> np.ndarray:
        """Return the phase angle of where each tension is about the centroid of the area, in (-pi, pi]."""
        points = self.outline(frame, vesicle)[:-1]
        if self._in_force.get("membrane_derivative") != "spectral":
            points = 0.5 * (points + np.roll(points, 1, axis=0))  # the midpoints of the edges
        x, y = (points - self.centroid(frame, vesicle)).T
        return np.arctan2(y, x)

    def edge_tension(self, frame: int, vesicle: int = 0) -> np.ndarray:
        """Return the tension of one vesicle's edges at a saved time."""
        return self.tension[frame, self.start[vesicle] : self.start[vesicle + 1]]


@dataclass(kw_only=True)
class SurfaceRun(RunFolder):
    """One run in three dimensions; `Run` says what `folder`, `series`, `nu`, `time`, `bending` and `summary` are.

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


def centroid(outline: np.ndarray) -> np.ndarray:
    """Return the centroid of the area inside a closed polygon, shape (n + 1, 2) with the first point repeated."""
    shifted = outline - outline[0]
    x, y = shifted[:-1].T
    xn, yn = shifted[1:].T
    cross = x * yn - xn * y
    return outline[0] + np.array([np.sum(cross * (x + xn)), np.sum(cross * (y + yn))]) / (3 * np.sum(cross))
