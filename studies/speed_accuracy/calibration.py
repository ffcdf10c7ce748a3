"""The measurements behind ``-scheme_auto``: errors of step-size control, solver, largest step, grid, walls and box."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.tables import write_csv
from studies.common import paper
from studies.common.curves import radius
from studies.common.engine import Case, Results, Series
from studies.common.scenes import tank_treading, words
from studies.speed_accuracy import space, unseen

TOLERANCES = ("1e-1", "3e-2", "1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5")
RTOLS = ("1e-3", "1e-4", "1e-5", "1e-6", "1e-7")
FINE_TOLERANCE, FINE_RTOL = "3e-6", "1e-10"
FINEST, BESIDE_FINEST = "7e-6", "5e-7"
"""The tolerance for an error of 1e-4, and that of its references, in the scenes that are worst at 3e-5."""

GRIDS, FINE_GRID = (2, 3, 4, 6, 8), 12
"""Cells a R0."""
FEW_SPACING = 1.5
WALL_GAPS, WALL_GRIDS, FINE_WALL_GRID = (0.1, 0.2, 0.4), (3, 4, 6, 8, 12), 24
"""Gaps in R0 and cells a R0; gaps of so many cells are measured: nearer to a wall a vesicle does not stay apart from it."""
WALL_CELLS = (0.39, 3.3)
HALF_WIDTHS = (8,)
"""Of boxes, in R0."""
MAX_STEPS = (4, 2, 1, 0.5)
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
CONTRAST = unseen.Scene("box", 1, 0.7, 10, 20, 0.5, 5, 5)
PRESSED = unseen.Scene("press", 2, 0.8, 5, 90, 0.2, 4, 1)
SCENES = (
    {f"shear V={v:g} chi={chi:g}": _shear(v, chi) for v, chi in product((0.5, 0.7, 0.9), (1, 10, 100))}
    | {f"turning V=0.7 chi={chi:g}": _shear(0.7, chi, 2) for chi in (1, 10)}
    | {
        f"turning V={v:g} chi={chi:g} from {angle} ratio={ratio:g}": unseen.Scene(
            "free", 1, v, chi, angle, 0.5, 3, ratio
        ).options()
        for v, (chi, ratio), angle in product((0.55, 0.9), ((1.5, 1), (1.5, 0.2), (15, 1), (15, 5)), (35, 60))
    }
    | {"relaxing": RELAX, "channel": CHANNEL, "pair in shear": PAIR}
    | {"ratio 5": CONTRAST.options() | CONTRAST.grid(), "pair pressed together": PRESSED.options() | PRESSED.grid()}
)
WORST = [scene for scene in SCENES if "V=0.55 chi=1.5" in scene] + ["turning V=0.7 chi=1", "pair in shear"]
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
    return _measure(series, folder) | {"markers": np.round(Run.read(folder).markers[-1], 8).tolist()}


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
        for kind, values in (("adapt_tol", TOLERANCES), ("ksp_rtol", () if "from" in scene else RTOLS)):
            for value in values:
                pair = (value, FINE_RTOL) if kind == "adapt_tol" else ("1e-3", value)
                exact = fine if kind == "adapt_tol" else results.get(_case(scene, "1e-3", FINE_RTOL))
                found = results.get(_case(scene, *pair))
                row = {"table": kind, "scene": scene, "value": value, "error": _error(scene, found, exact)}
                rows.append(row | {"steps": found["steps"], "solves": found["solves"]})
        if scene in WORST:
            fine, found = (results.get(_case(scene, tolerance, FINE_RTOL)) for tolerance in (BESIDE_FINEST, FINEST))
            row = {"table": "adapt_tol", "scene": scene, "value": FINEST, "error": _error(scene, found, fine)}
            rows.append(row | {"steps": found["steps"], "solves": found["solves"]})
    return rows


GRID_SCENES = {
    f"{scene.place}, {scene.count} of V={scene.reduced_area:g} chi={scene.chi:g} ratio={scene.ratio:g} gap={scene.gap:g}": scene
    for scene in (
        unseen.Scene("box", 1, 0.5, 10, 20, 0.5, 1, 1),
        unseen.Scene("box", 1, 0.7, 10, 20, 0.5, 1, 5),
        unseen.Scene("channel", 2, 0.7, 10, 20, 0.3, 1, 1),
        unseen.Scene("channel", 2, 0.7, 10, 20, 0.1, 1, 5),
        unseen.Scene("pipe", 2, 0.6, 20, 30, 0.2, 1, 1),
        unseen.Scene("press", 2, 0.8, 5, 90, 0.2, 1, 1),
    )
}
"""All vesicles are a R0 and more from walls."""
WALL_SCENES = {
    "V=0.7 chi=10": unseen.Scene("channel", 1, 0.7, 10, 20, 0.5, 1, 1),
    "V=0.9 chi=3": unseen.Scene("channel", 1, 0.9, 3, 45, 0.5, 1, 1),
    "V=0.7 chi=10 ratio=5": unseen.Scene("channel", 1, 0.7, 10, 20, 0.5, 1, 5),
}
STEPS = words("-time_step 0.05 -coupled_ksp_rtol 1e-7")
"""The same on every grid, so that grids are all that differs."""
SLOW = 10
"""Viscosity of the slow unsteady scenes, which have a Reynolds number of 1/SLOW."""
PLAIN = {
    "no box part": "-coupling_box_part false",
    "unsteady Re=1": "-fluid_inertia unsteady",
    f"unsteady Re={1 / SLOW:g}": f"-fluid_inertia unsteady -fluid_viscosity {SLOW} -vesicle_bending {{bending}}",
}
INERTIA_SCENES = {
    "box, V=0.5 chi=10": unseen.Scene("box", 1, 0.5, 10, 20, 0.5, 1, 1),
    "channel, 2 of V=0.7 chi=10 gap=0.3": unseen.Scene("channel", 2, 0.7, 10, 20, 0.3, 1, 1),
    "pipe, 2 of V=0.6 chi=20 gap=0.2": unseen.Scene("pipe", 2, 0.6, 20, 30, 0.2, 1, 1),
}
INERTIA_GRIDS, FINE_INERTIA_GRID = (2, 3, 4, 6, 8, 12, 16, 24), 48
CONVECTIVE_GRIDS, FINE_CONVECTIVE_GRID = (2, 3, 4, 6, 8, 12), 24
CONVECTIVE = words("-fluid_inertia convective -time_step 0.0083")
"""In the channel alone; its step is one that the finest grid bears."""


def _on_grid(
    results: Results, scene: unseen.Scene, label: str, cells: int, markers: str, more: dict[str, str] | None = None
) -> dict:
    options = scene.options() | replace(scene, cells=cells).grid() | STEPS | words(markers) | (more or {})
    return results.get(Case(f"grid_{label}_{cells}_{markers.split()[-1]}", options, unseen.measure))


def _plain(scenes: dict[str, unseen.Scene], kinds: dict[str, str]) -> list[tuple[str, unseen.Scene, dict[str, str]]]:
    """Return name, scene and options where the grid's error beside walls is not taken off; inertia without contrast."""
    return [
        (f"{label} {kind}", scene, words(text.format(bending=SLOW / scene.chi)))
        for (kind, text), (label, scene) in product(kinds.items(), scenes.items())
        if scene.ratio == 1 or "inertia" not in text
    ]


def _row(table: str, scene: str, value: float, error: float, found: dict) -> dict[str, object]:
    return {
        "table": table,
        "scene": scene,
        "value": f"{value:g}",
        "error": error,
        "steps": found["steps"],
        "solves": "",
    }


def _grids(results: Results) -> list[dict[str, object]]:
    """Errors of cells a R0: with enough markers, and with so few that they are 1.5 h apart."""
    rows = []
    for label, scene in GRID_SCENES.items():
        many = "-vesicle_allow_close_markers true -vesicle_markers 65"
        fine = _on_grid(results, scene, label, FINE_GRID, many)
        for cells in GRIDS:
            found = _on_grid(results, scene, label, cells, many)
            rows.append(_row("cells_a_radius", label, cells, unseen.error(found, fine), found))
        for cells in GRIDS[2:] if scene.count == 1 else ():
            found = _on_grid(results, scene, label, cells, f"-vesicle_spacing {FEW_SPACING}")
            rows.append(_row("cells_few_markers", label, cells, unseen.error(found, fine), found))
    return rows


def _dense(cells: int) -> str:
    """Return the option of markers 1.5 h apart, 65 at least: fluid with inertia passes between sparse ones."""
    return f"-vesicle_allow_close_markers true -vesicle_markers {max(65, int(2 * np.pi * cells / 1.5) | 1)}"


def _with_inertia(results: Results) -> list[dict[str, object]]:
    """Errors of cells a R0 in unsteady and convective flow, where they are of second order."""
    table = "cells_with_inertia"
    channel = next(label for label in INERTIA_SCENES if label.startswith("channel"))
    unsteady = {kind: text for kind, text in PLAIN.items() if "inertia" in text}
    runs = [(*run, INERTIA_GRIDS, FINE_INERTIA_GRID) for run in _plain(INERTIA_SCENES, unsteady)]
    runs.append((f"{channel} convective", INERTIA_SCENES[channel], CONVECTIVE, CONVECTIVE_GRIDS, FINE_CONVECTIVE_GRID))
    rows = []
    for label, scene, more, grids, finest in runs:
        fine = _on_grid(results, scene, label, finest, _dense(finest), more)
        for cells in grids:
            found = _on_grid(results, scene, label, cells, _dense(cells), more)
            rows.append(_row(table, label, cells, unseen.error(found, fine), found))
    return rows


def _walls(results: Results) -> list[dict[str, object]]:
    """Errors over the gap in which a vesicle begins beside a wall, by the gap's cells: with the box part, and without."""
    plain = _plain(WALL_SCENES, PLAIN)
    runs = [("cells_to_wall", label, scene, {}) for label, scene in WALL_SCENES.items()]
    rows = []
    for (table, label, scene, more), gap in product(runs + [("cells_to_wall_plain", *run) for run in plain], WALL_GAPS):
        near, name = replace(scene, gap=gap), f"{label}_{gap:g}"
        fine = _on_grid(results, near, name, FINE_WALL_GRID, "-vesicle_markers 91", more)
        for cells in WALL_GRIDS:
            if WALL_CELLS[0] <= gap * cells <= WALL_CELLS[1]:
                markers = "-vesicle_markers 91 -vesicle_allow_close_markers true"
                found = _on_grid(results, near, name, cells, markers, more)
                error = unseen.error(found, fine) / gap
                rows.append(_row(table, f"{label} gap={gap:g}", gap * cells, error, found))
    return rows


def _box_error(found: dict, free: dict) -> float:
    """Return the worst of markers, energy, angle and frequency."""
    steady = [abs(found[name] / free[name] - 1) for name in ("theta", "omega")]
    return max(unseen.error(found, free), *steady)


def _measure_place(series: Series, folder: Path) -> dict[str, object]:
    return unseen.measure(series, folder) | {"theta": series["inclination"][-1], "omega": series["frequency"][-1]}


def _boxes(results: Results) -> list[dict[str, object]]:
    """Errors of boxes against unbounded fluid, over (R0/W)^2, by their half width W over R0."""
    rows = []
    sides = {"walls": "", "channel": "-domain_bc_x periodic", "periodic": "-domain_bc_x periodic -domain_bc_y periodic"}
    for reduced_area, chi in product((0.5, 0.9), (1, 10)):
        scene = unseen.Scene("free", 1, reduced_area, chi, 20, 0.5, 3, 1)
        label = f"V={reduced_area:g} chi={chi:g}"
        free = results.get(Case(f"box_{label}_free", scene.options() | scene.grid() | STEPS, _measure_place))
        for (kind, text), width in product(sides.items(), HALF_WIDTHS):
            box = words(f"-domain_box {-width},{width},{-width},{width} -domain_cells {6 * width},{6 * width} {text}")
            options = {name: value for name, value in scene.options().items() if not name.startswith("-domain")}
            found = results.get(Case(f"box_{label}_{kind}_{width}", options | box | STEPS, _measure_place))
            rows.append(_row("half_width", f"{kind} {label}", width, _box_error(found, free) * width**2, found))
    return rows


COMPRESSED = {
    f"V={v:g} chi={chi:g} from {angle}": unseen.Scene("free", 1, v, chi, angle, 0.5, 3, 1)
    for v, chi, angle in (*product((0.55, 0.8), (1.5, 15, 60), (-20, -42)), (0.65, 100, -20))
}
SQUEEZED = 3
"""nu R0^3/c_b times the rate at which the flow shortens a vesicle, from which on it wrinkles."""


def _compressed(results: Results) -> list[dict[str, object]]:
    """Errors over the tolerance, where the flow compresses a vesicle at the start: one that turns, one that wrinkles."""
    rows = []
    for label, scene in COMPRESSED.items():
        squeeze = scene.chi * abs(np.sin(2 * np.deg2rad(scene.angle))) / 2
        table = "compressed_wrinkles" if squeeze > SQUEEZED else "compressed_turns"
        options = (
            scene.options()
            | scene.grid()
            | words("-vesicle_markers 91 -vesicle_allow_close_markers true -time_adapt error")
        )

        def run(tolerance: str) -> dict:
            extra = words(f"-time_adapt_tol {tolerance} -coupled_ksp_rtol 1e-7")
            return results.get(Case(f"compressed_{label}_{tolerance}", options | extra, unseen.measure))

        fine = run("3e-6" if table == "compressed_turns" else "3e-7")
        for tolerance in ("1e-3", "1e-4") if table == "compressed_turns" else ("1e-4", "1e-5"):
            found = run(tolerance)
            rows.append(_row(table, label, float(tolerance), unseen.error(found, fine) / float(tolerance), found))
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

    Columns: table, scene, value of what the table varies, error, steps and scalar solves (of the first three tables).
    """
    folder = Path(folder)
    results = Results(folder / "calibration.json")
    rows = _times(results) + _compressed(results) + _rest(results)
    rows += _grids(results) + _with_inertia(results) + _walls(results) + _boxes(results) + space.rows(results)
    shown = [[f"{x:.3e}" if isinstance(x, float) else x for x in row.values()] for row in rows]
    return [write_csv(folder / "calibration.csv", list(rows[0]), shown)]
