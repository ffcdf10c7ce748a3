"""The runs behind the study of accuracy per cell: their options and what is kept of each."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.curves import at_rest, radius, trigonometric
from studies.common.engine import Case, Series
from studies.common.scenes import cells, tank_treading, words

COMBINATIONS = {
    "default": ("cbs54", "spectral", "exact"),
    "chords": ("cbs54", "bending", "exact"),
    "ib6": ("ib6", "spectral", "exact"),
    "cbs54, none": ("cbs54", "spectral", "none"),
    "uncorrected": ("ib6", "fd", "none"),
}
"""Kernel, derivative and near field by name."""

MARKERS = (25, 35, 45)
REDUCED_AREAS, CHIS = (0.5, 0.7, 0.9), (1, 10)


def label(name: str) -> str:
    """Return a key of COMBINATIONS as part of a case's name."""
    return name.replace(", ", "_")


def combination(name: str) -> dict[str, str]:
    """Return the options of a key of COMBINATIONS."""
    kernel, derivative, near_field = COMBINATIONS[name]
    return words(
        f"-scheme_type coupled -delta_type {kernel} -membrane_derivative {derivative} "
        f"-coupling_near_field {near_field}"
    )


def markers(name: str, n: int, reduced_area: float) -> dict[str, str]:
    """Return the markers of a vesicle in n cells across 8: 45, more than 2 h apart never; without near field 1.5 h."""
    if COMBINATIONS[name][2] == "none":
        return {}
    return number(max(45, 2 * int(np.pi * radius(reduced_area) * n / 16) + 1))


def number(count: int) -> dict[str, str]:
    """Return the options of a number of markers, however near."""
    return {"-vesicle_markers": f"{count}", "-vesicle_allow_close_markers": "true"}


def _measure_shear(series: Series, folder: Path) -> dict[str, object]:
    later = series["time"] >= 1 - 1e-9
    return {
        "theta": series["inclination"][-1] / np.pi,
        "omega": series["frequency"][-1],
        "theta_one_earlier": np.interp(series["time"][-1] - 1, series["time"], series["inclination"]) / np.pi,
        "area": np.abs(series["area_error"][later]).max(),
        "length": np.abs(series["length_error"][later]).max(),
        "shift": np.abs(np.nan_to_num(series["area_shift"][later])).max(),
        "its": series["coupled_its"][-50:].mean(),
        "its_all": series["coupled_its"][3:].mean(),
        "seconds": float(np.median(series["wall"][5:])),
        "seconds_least": float(np.quantile(series["wall"][5:], 0.1)),  # what other programs on the machine leave alone
    }


def shear(name: str, box: str, n: int, reduced_area: float, chi: float) -> Case:
    """Return a steady tank-treading run; name is a key of COMBINATIONS."""
    options = combination(name) | markers(name, n, reduced_area) | tank_treading(box, n, reduced_area, chi)
    return Case(f"shear_{label(name)}_{box}_{n}_{reduced_area}_{chi}", options, _measure_shear)


def steady(box: str, n: int, reduced_area: float, chi: float, name: str = "default") -> Case:
    """Return shear(name, ...) with a smaller step, whose own part of the error is below 0.002 percent."""
    case = shear(name, box, n, reduced_area, chi)
    return replace(case, name=case.name.replace("shear", "steady"), options=case.options | {"-time_step": "0.0125"})


def fine(n: int, reduced_area: float, chi: float) -> Case:
    """Return steady("box", ...) with a solver's tolerance that leaves nothing of the grid's part in doubt."""
    case = steady("box", n, reduced_area, chi)
    return replace(case, name=case.name.replace("steady", "fine"), options=case.options | {"-coupled_ksp_rtol": "1e-9"})


def kernel_and_markers(kernel: str, count: int, n: int) -> Case:
    """Return a timed run with V = 0.7, chi = 10 in the box, all corrections on."""
    options = combination("default") | {"-delta_type": kernel} | number(count)
    options |= tank_treading("box", n, 0.7, 10) | {"-time_step": "0.025"}
    return Case(f"kernel_{kernel}_{count}_{n}", options, _measure_shear)


def cost(name: str) -> Case:
    """Return a timed run of 25 steps at 256^2."""
    options = combination(name) | markers(name, 256, 0.7) | tank_treading("box", 256, 0.7, 10, 1.25)
    return Case(f"cost_{label(name)}", options, _measure_shear)


def rest(name: str, n: int, reduced_area: float) -> Case:
    """Return a relaxation of an ellipse of unit area to rest: 4 x 4 box with walls, n^2 cells, c_b = nu = 1."""
    options = combination(name) | words("-domain_box -2,2,-2,2") | cells(n)
    options |= words(f"-vesicle_area 1 -vesicle_reduced_area {reduced_area!r} -vesicle_angle 90 -vesicle_bending 1")
    options |= words("-time_step 0.02 -time_end 5 -output_every 100 -checkpoint_every 0")
    return Case(f"rest_{label(name)}_{n}_{reduced_area}", options, at_rest)


DISTANCES, RAYS = (0.125, 0.25, 0.5), 64
"""Distances from the membrane in the 8 x 8 box, 2 h and 4 h of 64^2 and 128^2, and points on each."""


def _measure_fields(series: Series, folder: Path, reference: dict | None) -> dict[str, object]:
    """Velocity and pressure at points outside the reference's membrane (the run's own without one), and tension."""
    run = Run.read(folder)
    u, v, pressure = run.fields(-1)
    curve = np.reshape(reference["curve"], (RAYS, 2)) if reference else trigonometric(run.markers[-1], RAYS)
    x, y = run.cell_centers()
    found = {"curve": list(np.ravel(curve)), "markers": list(np.ravel(run.markers[-1]))}
    for distance in DISTANCES:
        points = _outside(curve, distance)
        place = (points - [x[0], y[0]]) / run.h
        found[f"velocity_{distance}"] = [*_cubic(u, place), *_cubic(v, place)]
        found[f"pressure_{distance}"] = list(_cubic(pressure, place))
    return found | {"tension": list(run.edge_tension(-1))}


def _outside(curve: np.ndarray, distance: float) -> np.ndarray:
    """Return the points of a counter-clockwise curve moved out along its normals."""
    n = len(curve)
    wave = np.fft.fftfreq(n, 1 / n)
    wave[n // 2] = 0
    tangent = np.fft.ifft(1j * wave * np.fft.fft(curve[:, 0] + 1j * curve[:, 1]))
    normal = -1j * tangent / np.abs(tangent)
    return curve + distance * np.stack([normal.real, normal.imag], axis=1)


def _cubic(field: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return a field of shape (ny, nx) at places x, y in cells, shape (n, 2), by cubics through 4 x 4 cells."""
    first = np.floor(place).astype(int) - 1
    t = place - first - 1
    ends = -t * (t - 1) * (t - 2) / 6, (t + 1) * t * (t - 1) / 6
    weights = ends[0], (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2, ends[1]
    values = np.zeros(len(place))
    for i, j in product(range(4), repeat=2):
        values += weights[i][:, 0] * weights[j][:, 1] * field[first[:, 1] + j, first[:, 0] + i]
    return values


def fields(name: str, n: int, reference: dict | None) -> Case:
    """Return a run whose velocity and tension are looked at: V = 0.7, chi = 10, box."""
    options = combination(name) | markers(name, n, 0.7) | tank_treading("box", n, 0.7, 10, 10)
    options |= {"-output_every": "10"}
    measure = lambda series, folder: _measure_fields(series, folder, reference)  # noqa: E731
    return Case(f"outside_{label(name)}_{n}", options, measure)
