"""What -scheme_auto chooses by in three dimensions: errors of degree and step-size control, of one vesicle in shear
and of one in a tube."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from studies.common.engine import Case, Results, Series
from studies.common.scenes import words

VOLUMES, CHIS = (0.99, 0.95, 0.9, 0.8, 0.7), (1, 10, 100)
DEGREES = (4, 6, 8, 10, 12, 14, 16)
TOLERANCES, FINE = ("1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5"), "1e-5"
TWICE = (0.95, 0.8)
"""Reduced volumes of the stiffest membranes that two Newton steps a time step are tried with."""
STARTS = {0: (0.99, 0.95, 0.9, 0.8, 0.7), 60: (0.9,), -20: (0.9,)}
"""Angles of the long axis at the start, in degrees, and reduced volumes; at the last the flow compresses the vesicle."""

RADII, NUMBERS = (1.1, 1.3, 2), (1, 10)
"""Of tubes over R0, and of nu V R0^2/kappa, V the mean velocity."""
TUBE_DEGREES, TUBE_TOLERANCES = (6, 8, 10, 12, 14, 16, 20), ("1e-2", "1e-3", "1e-4")


def _finest(volume: float) -> int:
    return 16 if volume > 0.75 else 18


def _measure(series: Series, folder: Path) -> dict[str, object]:
    """Return the angle at whole numbers of the scene's strain."""
    at = np.isclose(series["time"] % 1, 0, atol=1e-9) | np.isclose(series["time"] % 1, 1, atol=1e-9)
    return {"steps": len(series["time"]) - 1, "angle": series["inclination"][at][1:].tolist()}


def _run(results: Results, volume: float, chi: float, start: float, degree: int, steps: str) -> dict:
    axis = ",".join(f"{x:.6g}" for x in (np.cos(np.deg2rad(start)), np.sin(np.deg2rad(start)), 0))
    options = words(f"-dim 3 -flow_type shear -vesicle_reduced_volume {volume:g} -vesicle_bending {1 / chi:g} {steps}")
    options |= words(f"-sphere_degree {degree} -vesicle_axis {axis} -output_every 1 -checkpoint_every 0")
    name = f"space_{volume:g}_{chi:g}_{start:g}_{degree}_{'_'.join(words(steps).values())}"
    return results.get(Case(name, options, _measure, may_fail=True))


def _error(found: dict, fine: dict) -> float:
    """Return the largest error of the angle on the way, over the last angle; infinite of a run that stopped."""
    if "failed" in found:
        return np.inf
    ours, theirs = np.array(found["angle"]), np.array(fine["angle"])
    apart = (ours - theirs + np.pi / 2) % np.pi - np.pi / 2
    return float(np.abs(apart).max() / abs(theirs[-1]))


def _measure_tube(series: Series, folder: Path) -> dict[str, object]:
    """Return speed and extra pressure drop at multiples of 0.5."""
    at = np.isclose(series["time"] * 2, np.round(series["time"] * 2), atol=1e-9)
    numbers = {name: series[name][at][1:].tolist() for name in ("velocity_x", "pressure_drop_extra")}
    return {"steps": len(series["time"]) - 1} | numbers


def _run_tube(results: Results, volume: float, radius: float, number: float, degree: int, steps: str) -> dict:
    options = words(f"-dim axisymmetric -flow_type tube -flow_peak_velocity 2 -tube_radius {radius:g} {steps}")
    options |= words(f"-vesicle_reduced_volume {volume:g} -vesicle_bending {1 / number:g} -sphere_degree {degree}")
    options |= words("-output_every 0.5 -checkpoint_every 0 -time_end 2")
    name = f"tube_{volume:g}_{radius:g}_{number:g}_{degree}_{'_'.join(words(steps).values())}"
    return results.get(Case(name, options, _measure_tube, may_fail=True))


def _tube_error(found: dict, fine: dict) -> float:
    """Return the largest error of speed and pressure drop on the way, over the largest of each."""
    if "failed" in found:
        return np.inf
    pairs = [(np.array(found[name]), np.array(fine[name])) for name in ("velocity_x", "pressure_drop_extra")]
    return max(float(np.abs(ours - theirs).max() / np.abs(theirs).max()) for ours, theirs in pairs)


def _tube_rows(results: Results) -> list[dict[str, object]]:
    """Return the errors of degrees at equal steps, and those of tolerances at equal degrees, of vesicles in tubes."""
    made = []
    for volume, radius, number in product(VOLUMES, RADII, NUMBERS):
        equal, adapt = "-time_step 0.02 -bending_newton 2", "-time_step 0.05 -time_adapt error -time_adapt_max_step 0.5"
        tables = {
            "tube_degree": [(d, d, equal) for d in (*TUBE_DEGREES, 28)],
            "tube_tol": [(t, 16, f"{adapt} -time_adapt_tol {t}") for t in (*TUBE_TOLERANCES, FINE)],
        }
        for table, runs in tables.items():
            *found, fine = (_run_tube(results, volume, radius, number, degree, steps) for _, degree, steps in runs)
            for (value, *_), one in zip(runs, found):
                row = {"table": table, "scene": f"v={volume:g} R={radius:g} number={number:g}", "value": value}
                made.append(row | {"error": _tube_error(one, fine), "steps": one.get("steps", ""), "solves": ""})
    return made


def rows(results: Results) -> list[dict[str, object]]:
    """Return the errors of degrees at equal steps, and those of tolerances at equal degrees."""
    made = []

    def add(table: str, volume: float, chi: float, start: float, value: object, found: dict, fine: dict) -> None:
        scene = f"v={volume:g} chi={chi:g} from {start}"
        row = {"table": table, "scene": scene, "value": value, "error": _error(found, fine)}
        made.append(row | {"steps": found.get("steps", ""), "solves": ""})

    for volume, chi in product(VOLUMES, CHIS):
        steps = "-time_step 0.2 -time_end 4 -scheme_order 2 -bending_newton 2"
        fine = _run(results, volume, chi, 0, _finest(volume), steps)
        for degree in DEGREES:
            if degree < _finest(volume):
                found = _run(results, volume, chi, 0, degree, steps)
                add("degree", volume, chi, 0, degree, found, fine)
    for newton, (start, volumes), chi in product((1, 2), STARTS.items(), CHIS):
        for volume in volumes if newton == 1 else TWICE if (start, chi) == (0, 1) else ():
            degree = 8 if volume > 0.85 else 10

            def run(tolerance: str) -> dict:
                steps = f"-time_step 0.05 -time_end 8 -time_adapt error -bending_newton {newton}"
                return _run(results, volume, chi, start, degree, f"{steps} -time_adapt_tol {tolerance}")

            fine = run(FINE)
            for tolerance in TOLERANCES:
                add(f"space_tol_{newton}", volume, chi, start, tolerance, run(tolerance), fine)
    return made + _tube_rows(results)
