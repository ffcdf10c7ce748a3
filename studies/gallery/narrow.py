"""Vesicles that nearly fill a circular tube, beside the lubrication of the film along them: python3 -m studies narrow."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
from numpy.polynomial import Legendre

from studies.common.engine import Case, Results, Series
from studies.common.scenes import words
from studies.common.tables import write_csv

VOLUME = 0.9
TUBES = {1.3: 0.015, 1.15: 0.008, 1.1: 0.005, 1.05: 0.0025, 1.03: 0.0015}
"""Radii over the least one that the vesicle fits into, and steps: a tenth of the time in which it moves by the film."""
COLUMNS = (
    "radius_over_least degree film_over_R film_over_most speed_excess speed_over_law speed_over_film pressure_drop_extra"
    " pressure_over_law film_drift"
).split()
"""Of narrow.csv: film_over_most over R - R_least, speed_over_law with the ring's curvature, speed_over_film of
speed_excess over H/R, pressure_over_law with curvature too, film_drift over the film in the last unit of time."""
QUICK = 1.1
"""The least radius of a quick call."""


def least_radius(volume: float) -> float:
    """Return the radius of the narrowest tube for a reduced volume, over R0."""
    roots = np.roots([1, 0, -3, 2 * volume]).real
    return float(roots[(roots > 0) & (roots <= 1)][0] * volume ** (-1 / 3))


def meridian(coefficients: np.ndarray, points: int = 1000) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x, the parts dx of the length and the distances from the axis, of a vesicle's coefficients [3][count]."""
    degree = int(np.sqrt(coefficients.shape[1])) - 1
    x, w = np.polynomial.legendre.leggauss(points)
    along = np.zeros((3, points))
    for n in range(degree + 1):
        P = np.sqrt((2 * n + 1) / (4 * np.pi)) * Legendre.basis(n)
        along[0] += coefficients[0, n * n + n] * P(x)
        along[1] += coefficients[0, n * n + n] * P.deriv()(x) * w
        if n:
            along[2] += coefficients[1, n * n + n + 1] * P.deriv()(x) * np.sqrt(2 * (1 - x * x) / (n * (n + 1)))
    return along[0], np.abs(along[1]), along[2]


def film_length(film: np.ndarray, dx: np.ndarray) -> float:
    """Return H = INT h^-2 dx / INT h^-3 dx of a film."""
    return float((dx / film**2).sum() / (dx / film**3).sum())


def lubrication(r: np.ndarray, dx: np.ndarray, radius: float) -> tuple[float, float]:
    """Return U/V and the extra pressure drop over 8 nu V/R of a force-free rigid body of revolution, in rings.

    With a = r/R, l = -ln a and the pressure gradient g over that of the empty tube, the flux gives
    g (1 - a^4 - (1 - a^2)^2/l) + U/V (1 - a^2)/(2 l) = 1, and the shear stress on the body is as
    (2 g (1 - a^2) - U/V)/l, of which the sum over dx is 0.
    """
    a = r / radius
    log, lower = -np.log(a), 1 - a * a
    flux, drag = 1 - a**4 - lower**2 / log, lower / (2 * log)
    speed = float((2 * lower / flux / log * dx).sum() / (((2 * lower * drag / flux + 1) / log) * dx).sum())
    return speed, float((((1 - speed * drag) / flux - 1) * dx).sum() / radius)


def _measure(series: Series, folder: Path) -> dict[str, object]:
    """Return the last row's numbers, and the coefficients that another degree goes on with."""
    film, before = series["film"], np.searchsorted(series["time"], series["time"][-1] - 1)
    with h5py.File(folder / "run.h5") as file:
        coefficients = file["vesicle/coefficients"][-1]
    found = {"speed": series["velocity_x"][-1], "film": film[-1], "drift": film[-1] / film[before] - 1}
    found |= {"pressure": series["pressure_drop_extra"][-1], "area_error": series["area_error"][-1]}
    return found | {"coefficients": coefficients.tolist()}


def _shape(coefficients: list) -> str:
    """Return the text of -vesicle_file."""
    c = np.array(coefficients)
    pairs = [(n, m) for n in range(int(np.sqrt(c.shape[1]))) for m in (0, 1, -1) if n >= abs(m)]
    return "".join(f"{n} {m} {' '.join(f'{value:.17g}' for value in c[:, n * n + n + m])}\n" for n, m in pairs)


def settled(results: Results, ratio: float, degree: int) -> dict:
    """Return what is measured of a vesicle of degree 24 that began as a capsule, or of degree 32 from there on."""
    options = words("-dim axisymmetric -vesicle_bending 1 -flow_type tube -flow_peak_velocity 2 -checkpoint_every 0")
    options |= words(f"-tube_radius {ratio * least_radius(VOLUME):.12g} -sphere_degree {degree}")
    options |= words(f"-time_step {TUBES[ratio]:g} -time_end {8 if degree == 24 else 2} -output_every 8")
    files = {}
    if degree == 24:
        options |= words(f"-vesicle_reduced_volume {VOLUME:g} -vesicle_spheroid capsule")
    else:
        files["-vesicle_file"] = _shape(settled(results, ratio, 24)["coefficients"])
    return results.get(Case(f"narrow_{ratio:g}_{degree}", options, _measure, files=files))


def row(found: dict, ratio: float, degree: int) -> list[object]:
    """Return a row of the table."""
    least = least_radius(VOLUME)
    radius, excess = ratio * least, found["speed"] - 1
    _, dx, r = meridian(np.array(found["coefficients"]))
    speed, pressure = lubrication(r, dx, radius)
    values = [found["film"] / radius, found["film"] / (radius - least), excess, excess / (speed - 1)]
    values += [excess * radius / film_length(radius - r, dx), found["pressure"]]
    values += [found["pressure"] / (8 * pressure / radius), found["drift"]]
    return [f"{ratio:g}", degree, *(f"{value:.4g}" for value in values)]


def write(folder: str | Path, quick: bool = False) -> list[Path]:
    """Run what is not there yet and write narrow.csv; quick: without the narrowest tubes."""
    results = Results(Path(folder) / "narrow.json")
    tubes = [ratio for ratio in TUBES if ratio >= QUICK or not quick]
    rows = [row(settled(results, ratio, degree), ratio, degree) for ratio in tubes for degree in (24, 32)]
    return [write_csv(Path(folder) / "narrow.csv", COLUMNS, rows)]
