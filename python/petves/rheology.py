"""Suspensions in a channel: stresses, profiles over its height, displacements. series.csv has viscosity and normal
stress of every step; what is here is of saved times, and of single vesicles. `run` is ``petves.load(folder, "numpy")``,
`frame` the number of a saved time, -1 the last one."""

import numpy as np

from petves.run import Run, RunError


def stresslets(run: Run, frame: int) -> np.ndarray:
    """Return SUM f X over the markers of each vesicle of `run` at `frame`, f its membrane's force, shape (vesicles, 2, 2).

    The sum of force a times place b is S_ab = -SUM ds (sigma tau_a tau_b + c_b k_a k_b), tau the tangent and k the second
    derivative along the membrane, length^4/time^2 with density 1. Where the viscosity inside is lam times that outside, nu (1
    - lam) SUM (U_a n_b + n_a U_b) ds comes on top, U the markers' velocity and n the outward normal. Divided by minus the
    area of the box it is what the vesicle adds to the stress (Batchelor 1970).
    Neither contact (-contact_repulsion) nor water that passes membranes (-membrane_permeability) is in it.
    """
    kind = run.options().get("membrane_derivative", "spectral")
    found = []
    for vesicle in range(run.vesicles):
        points = run.outline(frame, vesicle)[:-1]
        edges = _derivative(points, 1) if kind == "spectral" else points - np.roll(points, 1, axis=0)
        ds = np.mean(np.hypot(*edges.T))
        if kind == "fd":
            bend = (np.roll(points, 1, axis=0) - 2 * points + np.roll(points, -1, axis=0)) / ds**2
        else:
            arc = np.mean(np.hypot(*_derivative(points, 1).T))
            bend = _derivative(points, 2) / arc**2
        sigma = run.edge_tension(frame, vesicle)
        found.append(-(edges.T * sigma) @ edges / ds - run.c_b * ds * bend.T @ bend)
        if run.viscosity_ratio[vesicle] != 1:
            along = _derivative(points, 1)
            U = run.velocity[frame, run.start[vesicle] : run.start[vesicle + 1]]
            both = U.T @ np.column_stack([along[:, 1], -along[:, 0]])
            found[-1] += run.nu * (1 - run.viscosity_ratio[vesicle]) * (both + both.T)
    return np.array(found)


def velocity_profile(run: Run, frame: int) -> tuple[np.ndarray, np.ndarray]:
    """Return y of the rows of cells and the mean of u over x there in `run` at `frame` (length, length/time), each (ny,)."""
    return run.cell_centers()[1], run.fields(frame)[0].mean(axis=1)


def area_fraction_profile(run: Run, frame: int, layers: int = 20) -> tuple[np.ndarray, np.ndarray]:
    """Return y in the middle of `layers` of equal height, and the part of each that vesicles of `run` take up at `frame`.

    Each vesicle is the polygon of its markers, cut at the layers' bounds exactly.
    """
    bounds = np.linspace(run.box[2], run.box[3], layers + 1)
    area = sum(_below(run.outline(frame, vesicle), bounds) for vesicle in range(run.vesicles))
    return 0.5 * (bounds[1:] + bounds[:-1]), np.diff(area) / (np.diff(bounds) * (run.box[1] - run.box[0]))


def centers(run: Run) -> np.ndarray:
    """Return the centroids of all vesicles of `run` at the saved times, shape (T, vesicles, 2); seams are not folded back."""
    found = [run.centroid(frame, v) for frame in range(len(run.time)) for v in range(run.vesicles)]
    return np.reshape(found, (len(run.time), run.vesicles, 2))


def mean_square_displacement(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Return the lags (time) and the mean square displacement of centres of `run` along x and y (length^2), shape (T, 2).

    Means over the vesicles and over all pairs of saved times with that lag; saved times must be evenly spaced. In
    a sheared channel x is mostly the flow's, y is what collisions do.
    """
    steps = np.diff(run.time)
    if len(steps) and np.ptp(steps) > 1e-3 * steps.max():
        apart = f"{steps.min():g} to {steps.max():g} apart"
        raise RunError(f"{run.folder}: saved times are not even, {apart}; allowed: even ones")
    places = centers(run)
    lags = [np.mean((places[lag:] - places[: len(places) - lag]) ** 2, axis=(0, 1)) for lag in range(len(places))]
    return run.time - run.time[0], np.array(lags)


def _derivative(points: np.ndarray, power: int) -> np.ndarray:
    """Return the derivative by the marker's number of the trigonometric polynomial through closed points."""
    n = len(points)
    waves = 2j * np.pi * np.fft.fftfreq(n)
    if n % 2 == 0 and power % 2:
        waves[n // 2] = 0
    return np.fft.ifft(np.fft.fft(points, axis=0) * (waves**power)[:, None], axis=0).real


def _below(outline: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Return the area of a closed polygon below each y: the integral of x dy over its edges, cut there."""
    (x0, y0), (x1, y1) = outline[:-1].T, outline[1:].T
    top0, top1 = (np.minimum(y[:, None], bounds) for y in (y0, y1))
    slope = np.divide(x1 - x0, y1 - y0, out=np.zeros_like(x0), where=y1 != y0)[:, None]
    middle = x0[:, None] + slope * (0.5 * (top0 + top1) - y0[:, None])
    return np.sum(middle * (top1 - top0), axis=0)
