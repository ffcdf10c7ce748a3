"""The files that a run leaves in its output folder, as arrays."""

import functools
from dataclasses import dataclass, field

import numpy as np

from petves.curves import smooth_curve, solid_outline, trigonometric
from petves.errors import RunError as RunError
from petves.runfiles import RunFolder, read_frames, read_h5
from petves.runfiles import read_series as read_series

#: Points of a vesicle's smooth curve for each of its markers.
CURVE = 6

#: Periods of the box that a curve may span.
WIDEST = 1000


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
    columns = (
        "step time energy_kinetic energy_bending area_error length_error div_max inclination frequency wall nsolve"
        " tension_its bending_its coupled_its"
    )
    read_frames = staticmethod(read_frames)

    @functools.cached_property
    def periods(self) -> tuple[float, float]:
        """The box's periods in x and y (length); 0 where it is not periodic."""
        options = self._in_force
        return tuple(
            float(self.box[2 * d + 1] - self.box[2 * d]) if options.get(f"domain_bc_{c}") == "periodic" else 0.0
            for d, c in enumerate("xy")
        )

    @property
    def walls(self) -> str:
        """The directions that walls bound: "x", "y", "xy" or ""."""
        return "".join(c for c in "xy" if self._in_force.get(f"domain_bc_{c}", "wall") == "wall")

    def images_of(
        self, outline: np.ndarray, limits: np.ndarray | None = None, origin: np.ndarray | None = None
    ) -> list[np.ndarray]:
        """Return every image of the closed `outline`, shape (n + 1, 2), that reaches into the box.

        Markers are not wrapped: a vesicle that has left a periodic box goes on outside of it. Here it is in the box, and once
        more at the other side where it lies across the seam. `limits` (4,) stand in place of the box, `origin` (2,) is taken
        off all places.
        """
        if origin is not None:
            outline = outline - origin
        box = self.box if limits is None else limits
        shifts = []
        for d, period in enumerate(self.periods):
            low, high = outline[:, d].min(), outline[:, d].max()
            if period and high - low > WIDEST * period:
                raise RunError(
                    f"{self.folder / 'run.h5'}: a curve as wide as {(high - low) / period:.3g} periods of the box"
                )
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


def centroid(outline: np.ndarray) -> np.ndarray:
    """Return the centroid of the area inside a closed polygon, shape (n + 1, 2) with the first point repeated."""
    shifted = outline - outline[0]
    x, y = shifted[:-1].T
    xn, yn = shifted[1:].T
    cross = x * yn - xn * y
    return outline[0] + np.array([np.sum(cross * (x + xn)), np.sum(cross * (y + yn))]) / (3 * np.sum(cross))
