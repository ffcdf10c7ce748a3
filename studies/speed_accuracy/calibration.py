"""The measurements behind ``-scheme_auto``: errors of step-size control, solver tolerance, spacing, grid and largest step."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from petves.run import Run
from petves.tables import write_csv
from studies.common import paper
from studies.common.curves import radius
from studies.common.engine import Case, Results, Series
from studies.common.scenes import NEAR_FIELD_KERNELS, tank_treading, words

TOLERANCES = ("1e-1", "3e-2", "1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5")
RTOLS = ("1e-3", "1e-4", "1e-5", "1e-6", "1e-7")
FINE_TOLERANCE, FINE_RTOL = "3e-6", "1e-10"
SPACINGS = (1.25, 1.5, 2.0)
GRIDS = (40, 48, 64, 96, 128)
KERNEL_GRIDS = (64, 96, 128, 192)
MAX_STEPS = (4, 2, 1, 0.5, 0.25, 0.125, 0.0625, 0.03125)
"""Largest step over nu R0^3/c_b."""


def _shear(reduced_area: float, chi: float, time_end: float = 12, cells: int = 64) -> dict[str, str]:
    return tank_treading("box", cells, reduced_area, chi, time_end) | {"-fluid_inertia": "none"}


COMMON = words("-fluid_inertia none -vesicle_bending 0.01 -output_every 1000 -checkpoint_every 0")
RELAX = COMMON | words(
    "-domain_box -1,1,-1,1 -domain_cells 32,32 -vesicle_semi_axes 0.2,0.5 -time_step 0.02 -time_end 0.5"
)
CHANNEL = COMMON | words(
    "-domain_box 0,12,0,6 -domain_cells 96,48 -domain_bc_x periodic -flow_type poiseuille "
    "-flow_peak_velocity 1.319456 -flow_center_y 3 -vesicle_area 1 -vesicle_reduced_area 0.7 "
    "-vesicle_center 6,3.674336 -vesicle_angle 90 -time_step 0.12 -time_end 12"
)
PAIR = COMMON | words(
    "-domain_box -6,6,-3,3 -domain_cells 96,48 -domain_bc_x periodic -flow_type shear -flow_rate 0.326116 "
    "-vesicle_count 2 -vesicle_area 1 -vesicle_reduced_area 0.7 -vesicle_center -1.5,0.4,1.5,-0.4 "
    "-vesicle_angle 25 -time_step 0.2 -time_end 12"
)
REST = COMMON | words(
    "-domain_box -1.5,1.5,-1.5,1.5 -domain_cells 48,48 -domain_bc_x periodic -domain_bc_y periodic "
    "-vesicle_area 1 -vesicle_angle 90 -time_step 2"
)
SCENES = (
    {f"shear V={v:g} chi={chi:g}": _shear(v, chi) for v, chi in product((0.5, 0.7, 0.9), (1, 10, 100))}
    | {f"turning V=0.7 chi={chi:g}": _shear(0.7, chi, 2) for chi in (1, 10)}
    | {"relaxing": RELAX, "channel": CHANNEL, "pair in shear": PAIR}
)
"""Steady: errors of angle and frequency. The others, which end on the way: of the markers and the energy."""


def _measure(series: Series, folder: Path) -> dict[str, object]:
    return {
        "steps": len(series["time"]) - 1,
        "solves": series["nsolve"].sum(),
        "theta": series["inclination"][-1],
        "omega": series["frequency"][-1],
        "energy": series["energy_bending"][-1],
        "length": series["length_error"][-1],
    }


def _measure_markers(series: Series, folder: Path) -> dict[str, object]:
    return _measure(series, folder) | {"markers": np.round(Run.read(folder).markers[-1], 10).tolist()}


def _steady(scene: str) -> bool:
    return scene.startswith("shear")


def _case(scene: str, tolerance: str, rtol: str) -> Case:
    name = f"time_{scene.replace(' ', '_')}_{tolerance}_{rtol}"
    control = {"-time_adapt": "error", "-time_adapt_tol": tolerance, "-coupled_ksp_rtol": rtol}
    return Case(name, SCENES[scene] | control, _measure if _steady(scene) else _measure_markers)


def _error(scene: str, found: dict, fine: dict) -> float:
    """Return the worst relative error: angle and frequency when steady, else markers (rms over R0) and energy."""
    names = ("theta", "omega") if _steady(scene) else ("energy",)
    errors = [abs(found[name] / fine[name] - 1) for name in names]
    if not _steady(scene):
        ours, theirs = np.array(found["markers"]), np.array(fine["markers"])
        count = 2 if scene.startswith("pair") else 1
        length = np.hypot(*np.diff(theirs[: len(theirs) // count], axis=0).T).sum()
        errors.append(np.sqrt(((ours - theirs) ** 2).sum(axis=1).mean()) / (length / (2 * np.pi)))
    return max(errors)


def _times(results: Results) -> list[dict[str, object]]:
    """Errors of step-size control and of the solver's tolerance, each with the other far finer."""
    rows = []
    for scene in SCENES:
        fine = results.get(_case(scene, FINE_TOLERANCE, FINE_RTOL))
        for kind, values in (("adapt_tol", TOLERANCES), ("ksp_rtol", RTOLS)):
            exact = fine if kind == "adapt_tol" else results.get(_case(scene, "1e-3", FINE_RTOL))
            for value in values:
                pair = (value, FINE_RTOL) if kind == "adapt_tol" else ("1e-3", value)
                found = results.get(_case(scene, *pair))
                row = {"table": kind, "scene": scene, "value": value, "error": _error(scene, found, exact)}
                rows.append(row | {"steps": found["steps"], "solves": found["solves"]})
    return rows


def _against_targets(results: Results, cells: int, reduced_area: float, chi: float, **extra: str) -> dict[str, object]:
    """Return the error in angle or frequency, whichever is larger, against the boundary integral in the same box."""
    tolerance = "3e-4" if extra else "3e-5"  # the grids' own errors are smaller than what 3e-4 leaves
    options = _shear(reduced_area, chi, 12, cells) | {"-time_adapt": "error", "-time_adapt_tol": tolerance} | extra
    label = "_".join(value for value in extra.values())
    found = results.get(Case(f"grid_{cells}_{reduced_area:g}_{chi:g}_{label}", options, _measure))
    error = max(map(abs, paper.shear_errors(found["theta"] / np.pi, found["omega"], reduced_area, chi)))
    return {"error": error, "steps": found["steps"], "solves": found["solves"]}


def _grids(results: Results) -> list[dict[str, object]]:
    rows = []
    for reduced_area, chi in product((0.5, 0.7, 0.9), (1, 10)):
        scene = f"shear V={reduced_area:g} chi={chi:g}"
        for cells in GRIDS:
            row = {"table": "cells_a_radius", "scene": scene, "value": f"{radius(reduced_area) * cells / 8:.3g}"}
            rows.append(row | _against_targets(results, cells, reduced_area, chi))
        for cells in KERNEL_GRIDS:
            extra = words("-delta_type ib6 -vesicle_spacing 1.5")
            row = {"table": "ib6_cells_a_radius", "scene": scene, "value": f"{radius(reduced_area) * cells / 8:.3g}"}
            rows.append(row | _against_targets(results, cells, reduced_area, chi, **extra))
    for cells, kernel, spacing in product((64, 128), NEAR_FIELD_KERNELS, SPACINGS):
        extra = words(f"-delta_type {kernel} -vesicle_spacing {spacing:g}")
        scene = f"shear V=0.7 chi=10, {cells}^2, {kernel}"
        row = {"table": "spacing", "scene": scene, "value": f"{spacing:g}"}
        rows.append(row | _against_targets(results, cells, 0.7, 10, **extra))
    return rows


def _rest(results: Results) -> list[dict[str, object]]:
    """Energy at rest by the largest step: what the targets of area and length leave in an end state."""
    rows = []
    for reduced_area in (0.5, 0.7, 0.9):
        relaxation = radius(reduced_area) ** 3 / 0.01
        options = REST | {"-vesicle_reduced_area": f"{reduced_area:g}", "-time_end": f"{20 * relaxation:.6g}"}
        options |= {"-time_adapt": "error", "-time_adapt_tol": "1e-2"}
        for most in MAX_STEPS:
            case = options | {"-time_adapt_max_step": f"{most * relaxation:.6g}"}
            found = results.get(Case(f"rest_{reduced_area:g}_{most:g}", case, _measure))
            scaled = found["energy"] * radius(reduced_area) / 0.01
            row = {"table": "max_step", "scene": f"at rest V={reduced_area:g}", "value": f"{most:g}"}
            error = abs(scaled / paper.REST[reduced_area][0] - 1)
            rows.append(row | {"error": error, "steps": found["steps"], "solves": found["solves"]})
    return rows


def write(folder: str | Path, quick: bool = False) -> list[Path]:
    """Run what is not there yet and write calibration.csv, which src/scene/auto.c quotes; there is no quicker form.

    Columns: table, scene, value of what the table varies, error, steps and scalar solves.
    """
    folder = Path(folder)
    results = Results(folder / "calibration.json")
    rows = _times(results) + _grids(results) + _rest(results)
    shown = [[f"{x:.3e}" if isinstance(x, float) else x for x in row.values()] for row in rows]
    return [write_csv(folder / "calibration.csv", list(rows[0]), shown)]
