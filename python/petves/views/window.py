"""What part of a periodic box is seen: the box as it is, or one that goes along with a vesicle."""

import numpy as np

from petves.quantities import stream_function_of, vorticity_of
from petves.run import Run, RunError


class Window:
    """The box at a saved time, or with `follow` its periods about a vesicle.

    Following vesicle v, along the periodic directions: places are counted from its centroid, the middle of the window, and
    velocities from the centroid's. Other directions are as they are.

    Attributes
    ----------
    limits : ndarray, shape (4,)
        x_min, x_max, y_min, y_max of what is seen (length).
    origin : ndarray, shape (2,)
        The place that 0 stands for (length).
    velocity : ndarray, shape (2,)
        What is taken off all velocities (length/time).
    """

    def __init__(self, run: Run, frame: int, follow: int | None = None) -> None:
        self.run, self.frame = run, frame
        self.limits, self.origin, self.velocity = run.box.copy(), np.zeros(2), np.zeros(2)
        self.moving = follow is not None
        self._cells = [np.arange(len(cells)) for cells in run.cell_centers()]  # that are seen, along x and y
        if follow is None:
            return
        if not 1 <= follow <= run.vesicles:
            raise RunError(f"follow {follow}: no such vesicle; allowed: 1 to {run.vesicles}")
        if not any(run.periods):
            raise RunError("follow: the box has no periodic direction to follow a vesicle in")
        center, step = run.centroid(frame, follow - 1), np.argmin(np.abs(run.series["time"] - run.time[frame]))
        for d, period in enumerate(run.periods):
            if period:
                self.origin[d] = center[d]
                self.velocity[d] = np.nan_to_num(run.each(f"velocity_{'xy'[d]}")[step, follow - 1])
                self.limits[2 * d : 2 * d + 2] = -period / 2, period / 2
                first = int(np.floor((center[d] - period / 2 - run.box[2 * d]) / run.h))
                self._cells[d] = first + np.arange(len(self._cells[d]) + 1)

    @property
    def extent(self) -> np.ndarray:
        """The cells' outer sides, x_min, x_max, y_min, y_max; up to a cell more than the limits."""
        ends = [(cells[0], cells[-1] + 1) for cells in self._cells]
        return np.ravel(self.run.box[::2, None] + self.run.h * np.array(ends) - self.origin[:, None])

    def _seen(self, field: np.ndarray) -> np.ndarray:
        x, y = (cells % n for cells, n in zip(self._cells, field.shape[::-1]))
        return field[np.ix_(y, x)]

    def fields(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return u, v and the total pressure, zero in the middle, on the cells of `extent`, each of shape (ny, nx)."""
        u, v, p = (self._seen(field) for field in self.run.fields(self.frame))
        return u - self.velocity[0], v - self.velocity[1], p + self.mean_pressure()

    def mean_pressure(self) -> np.ndarray:
        """Return what the mean gradient adds to the pressure, shape (nx,)."""
        return self.run.pressure_gradient[self.frame] * (self.cell_centers()[0] - np.mean(self.limits[:2]))

    def pressure_deviation(self) -> np.ndarray:
        """Return the pressure without its mean gradient on the cells of `extent`, shape (ny, nx)."""
        return self._seen(self.run.fields(self.frame)[2])

    def speed(self) -> np.ndarray:
        """Return the speed on the cells of `extent`, shape (ny, nx)."""
        return np.hypot(*self.fields()[:2])

    def vorticity(self) -> np.ndarray:
        """Return the vorticity on the cells of `extent`, shape (ny, nx)."""
        u, v, _ = self.run.fields(self.frame)
        return self._seen(vorticity_of(u, v, self.run.h, [period > 0 for period in self.run.periods]))

    def stream_function(self) -> np.ndarray:
        """Return the stream function of the velocity of `fields`, as far above zero as below it, shape (ny, nx)."""
        values = stream_function_of(*self.fields()[:2], self.run.h)
        return values - 0.5 * (values.min() + values.max())

    def cell_centers(self) -> tuple[np.ndarray, np.ndarray]:
        """Return x, shape (nx,), and y, shape (ny,), of the cells of `fields`."""
        return tuple(self.run.box[2 * d] + self.run.h * (0.5 + self._cells[d]) - self.origin[d] for d in range(2))

    def solids(self) -> list[np.ndarray]:
        """Return closed curves, each of shape (n + 1, 2), that are solid within by the nonzero rule.

        Obstacles with their images that are seen; where one has fluid within, a frame around the window runs the other way.
        """
        curves = [self.run.obstacle_curve(k, self.frame) for k in range(len(self.run.obstacles))]
        seen = [image for curve in curves for image in self.run.images_of(curve - self.origin, self.limits)]
        if all(np.sum(x[:-1] * np.diff(y) - y[:-1] * np.diff(x)) > 0 for x, y in ((c - c[0]).T for c in curves)):
            return seen
        x0, x1, y0, y1 = self.limits + np.tile([-1.0, 1.0], 2) * np.ptp(self.limits)
        return [np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]), *seen]

    def tracers(self) -> np.ndarray:
        """Return where the tracers are seen, shape (n, 2)."""
        points, low, periods = self.run.tracers[self.frame] - self.origin, self.limits[::2], np.array(self.run.periods)
        return np.where(periods > 0, low + (points - low) % np.where(periods > 0, periods, 1), points)

    def images(self, vesicle: int, curve: bool = True) -> list[np.ndarray]:
        """Return a vesicle's outlines that are seen, smooth or through its markers, each of shape (n + 1, 2)."""
        outline = (self.run.curve if curve else self.run.outline)(self.frame, vesicle)
        return self.run.images_of(outline - self.origin, self.limits)
