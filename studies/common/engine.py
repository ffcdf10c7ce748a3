"""Running a study's cases once each, and the cases that repeat the paper's studies."""

from __future__ import annotations

import json
import resource
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

from studies.common.paper import CELLS
from petves.program import run_program
from petves.run import RunError, read_series

MARKERS_TABLE_7 = {32: 50, 64: 98, 128: 196, 256: 392}  # 1.5 h apart
LENGTH = 2.3013  # of the ellipse (0.2, 0.5)
TIGHT = "1e-12"
NEVER = "1e-50"  # relative tolerance that only an absolute test can meet first
ILU = {"-tension_pc_type": "ilu", "-tension_pc_factor_levels": "200", "-tension_pc_factor_mat_ordering_type": "nd"}
NONE = {"-tension_pc_type": "none"}
LEFT = {"-tension_ksp_pc_side": "left"}  # PETSc's default test, which the paper's iterations are compared with
ENERGY_ROWS = 240  # rows kept of an energy curve


@dataclass
class Case:
    """One run.

    Attributes
    ----------
    name : str
        Key of its measures in the file of results; the part before the first "_" names the study.
    options : dict of str to str
        Options of petves and their values.
    measure : callable
        Takes the run's columns and its folder, returns what the study needs as JSON.
    ranks : int
        MPI ranks; 0 takes the study's.
    may_fail : bool
        A run that stops (exit status 2) is a result: its measures are {"failed": line}.
    """

    name: str
    options: dict[str, str]
    measure: Callable[[dict[str, np.ndarray], Path], dict[str, object]]
    ranks: int = 0
    may_fail: bool = False


def scene(kind: str, n: int, markers: int, dt: float) -> dict[str, str]:
    """Return the options of section 5.1 (energy), 5.2 (relax) or 5.3 (shear) with h = 1/n."""
    options = {
        "-domain_box": "-1,1,-1,1",
        "-domain_cells": f"{2 * n},{2 * n}",
        "-vesicle_semi_axes": "0.2,0.5",
        "-vesicle_bending": "0.01",
        "-vesicle_markers": str(markers),
        "-time_step": repr(dt),
        "-time_end": {"energy": "3", "relax": "1", "shear": "5"}[kind],
        "-output_every": "1000",
        "-checkpoint_every": "0",
        "-scheme_type": "split",
        "-scheme_order": "1",
    }
    if kind == "shear":
        options |= {"-flow_type": "shear", "-flow_rate": "1"}
    return options


def iterations(kind: str, n: int) -> dict[str, Case]:
    """Return the runs behind one line of Table 4 (relax) or 8 (shear): our stopping tests by name."""
    dt = (0.5 if kind == "relax" else 0.25) / n
    base = scene(kind, n, n, dt) | LEFT
    ds, h2 = LENGTH / n, 1 / n**2
    # an l2 norm over edges times sqrt(ds) is the L2 norm along the membrane; a residual r leaves the surface
    # divergence h^2 dt r/ds
    tension, residual = h2 / ds**0.5, h2 / ds**0.5 * ds / (h2 * dt)
    tests = {
        "none": NONE | {"-tension_ksp_rtol": repr(h2)},
        "ilu": ILU | {"-tension_ksp_rtol": repr(h2)},
        "tight": ILU | {"-tension_ksp_rtol": TIGHT},
        "none_absolute": NONE | {"-tension_ksp_rtol": NEVER, "-tension_ksp_atol": repr(residual)},
        "ilu_absolute": ILU | {"-tension_ksp_rtol": NEVER, "-tension_ksp_atol": repr(tension)},
    }
    return {name: Case(f"{kind}_{n}_{name}", base | options, _measure) for name, options in tests.items()}


def energy(n: int) -> dict[str, Case]:
    """Return the runs of section 5.1 by time step; markers 1.75 h apart."""
    markers = 2 * round(LENGTH * n / 3.5)
    steps = {"h": 1 / n, "h/2": 0.5 / n, "h^2": 1 / n**2}
    tight = {"-tension_ksp_rtol": TIGHT, "-bending_ksp_rtol": TIGHT}
    return {
        name: Case(f"energy_{n}_{name.replace('/', '_')}", scene("energy", n, markers, dt) | ILU | tight, decay)
        for name, dt in steps.items()
    }


def energy_start(n: int, name: str) -> Case:
    """Return the first t = 1/8 of a run of section 5.1, dt = h or h/2."""

    def measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
        total = series["energy_kinetic"] + series["energy_bending"]
        rise = np.diff(total / total[0])
        found = {"rise": list(rise[:3]), "largest": rise.max(), "step": int(rise.argmax()) + 1}
        return found | {"peak": (total / total[0]).max(), "end": total[-1] / total[0]}

    options = energy(n)[name].options | {"-time_end": "0.125"}
    return Case(f"energy_start_{n}_{name.replace('/', '_')}", options, measure, ranks=1)


def sizes(quick: bool) -> tuple[int, ...]:
    """Return the values of 1/h."""
    return CELLS[:2] if quick else CELLS


def _measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    """Return what the tables need of one run."""
    return {
        "steps": len(series["time"]) - 1,
        "area_error": series["area_error"][-1],
        "length_error": series["length_error"][-1],
        "tension_its": series["tension_its"][1:].mean(),
        "bending_its": series["bending_its"][1:].mean(),
        "div_max": series["div_max"].max(),
        "surface_div_max": series["surface_div_max"].max(),
        "step_seconds": series["wall"].sum(),
    }


def decay(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    """Return _measure, and the energy against time."""
    total = series["energy_kinetic"] + series["energy_bending"]
    rise = np.diff(total / total[0])
    every = max(1, len(total) // ENERGY_ROWS)
    return _measure(series, folder) | {
        "rise_first_two": list(rise[:2]),
        "rise_later": rise[2:].max(),
        "time": [round(t, 6) for t in series["time"][::every]],
        "energy": [round(e, 6) for e in (total / total[0])[::every]],
    }


def _launch(case: Case, ranks: int, folder: str) -> str:
    """Run a case; return "", or the line that says why a case that may fail has stopped."""
    words = [word for pair in case.options.items() for word in pair]
    limits = [word for name in ("edge_ratio", "area_error", "length_error") for word in (f"-limit_{name}", "0")]
    status, line = run_program([*limits, *words, "-output_dir", folder], ranks)  # a study measures bad answers too
    if not status:
        return ""
    if case.may_fail and status == 2:
        return line.partition("; the last good state is in")[0]
    raise RunError(f"{case.name}: exit status {status}: {line}")


def _cpu_seconds() -> float:
    """Return the processor time of the programs run so far, all ranks, start and output included."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def study_folder(folder: str | Path) -> Path:
    """Return the folder of a study's files, made if need be."""
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunError(f"{folder}: cannot be made ({error.strerror})") from None
    return folder


class NotRun(RunError):
    """A case is not among the results, and none is to be run."""


class Results:
    """Measures of finished cases, kept in one JSON file so that an interrupted study goes on where it stopped."""

    def __init__(self, path: Path, ranks: int, run: bool = True) -> None:
        self.path = path
        self.ranks = ranks
        self.run = run
        try:
            self.cases = json.loads(path.read_text()) if path.is_file() else {}
        except json.JSONDecodeError as error:
            raise RunError(f"{path}: not JSON ({error}); remove it to start afresh") from None

    def has(self, case: Case) -> bool:
        """Return whether the measures of a case are there, for the same options and ranks."""
        known = self.cases.get(case.name)
        return bool(known) and known["options"] == case.options and known["ranks"] == (case.ranks or self.ranks)

    def get(self, case: Case) -> dict:
        """Return the measures of a case; run it first unless they are there for the same options and ranks."""
        ranks = case.ranks or self.ranks
        if self.has(case):
            return self.cases[case.name]["measures"]
        if not self.run:
            raise NotRun(case.name)
        print(f"running {case.name}", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            before = _cpu_seconds()
            failure = _launch(case, ranks, folder)
            spent = _cpu_seconds() - before
            measures = (
                {"failed": failure} if failure else case.measure(read_series(Path(folder) / "series.csv"), Path(folder))
            )
            commit = json.loads((Path(folder) / "summary.json").read_text())["git_commit"]
        measures |= {"cpu_seconds": round(spent, 3)}
        self.cases[case.name] = {"options": case.options, "ranks": ranks, "commit": commit, "measures": measures}
        self._write()
        return measures

    def derive(self, name: str, options: dict[str, str], measure: Callable[[], dict[str, object]]) -> dict:
        """Return what is computed from other cases; compute it first unless it is there for the same options."""
        if self.cases.get(name, {}).get("options") != options:
            if not self.run:
                raise NotRun(name)
            self.cases[name] = {"options": options, "ranks": 0, "measures": measure()}
            self._write()
        return self.cases[name]["measures"]

    def _write(self) -> None:
        temporary = self.path.with_suffix(".tmp")
        temporary.write_text(
            "{\n" + ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in self.cases.items()) + "\n}\n"
        )
        temporary.replace(self.path)
