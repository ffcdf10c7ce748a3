"""Short runs beside a program of PETSc that does nothing, in turn: what is left of them without PETSc's own start."""

from __future__ import annotations

import os
import subprocess
from dataclasses import replace
from pathlib import Path
from statistics import median

import numpy as np

from petves.program import OPEN_MPI
from studies.common.tables import table
from studies.common.engine import Case, Results, Series, cpu_seconds
from studies.common.paper import SHEAR, SHEAR_FREE
from studies.common.scenes import LAST_ONLY, option_file, tank_treading, words

ROUNDS = 15
NOTHING = Path(os.environ.get("PETVES_BENCH", "build/bench")) / "bench_start"
BOX, FREE = SHEAR["box"][0.7, 10], SHEAR_FREE[0.7, 10]


def _measure(series: Series, folder: Path) -> dict[str, object]:
    found = {"steps": len(series["time"]) - 1, "step_seconds": float(series["wall"].sum())}
    return found | {"angle": series["inclination"][-1] / np.pi}


def cases(best: dict[str, Case]) -> dict[str, Case]:
    """Return the runs: those of the claim, and tank-treading in a box and without one."""
    box = tank_treading("box", 32, 0.7, 10) | LAST_ONLY | {"-time_step": "0.2"}
    found = {kind: Case(f"start_{kind}", case.options, _measure) for kind, case in best.items()}
    found["8 x 8 box, 32^2, dt .2, no box part"] = Case("start_box", box | words("-coupling_box_part false"), _measure)
    found["8 x 8 box, 32^2, dt .2"] = Case("start_box_part", box, _measure)
    found["unbounded, runs/free.opts"] = Case("start_free", option_file("free") | LAST_ONLY, _measure)
    return found


def _nothing(results: Results, number: int) -> float:
    """Return the CPU seconds of the program that does nothing."""

    def spent() -> dict[str, object]:
        before = cpu_seconds()
        subprocess.run([NOTHING], check=True, env=OPEN_MPI | os.environ)
        return {"cpu_seconds": round(cpu_seconds() - before, 3)}

    return results.derive(f"start_nothing_{number}", {}, spent)["cpu_seconds"]


def _over(paper: float, own: float) -> str:
    """Return their quotient, if the clock shows a difference (seconds) between the program and one that does nothing."""
    return f"{paper / own:.0f}" if own > 5e-4 else "none left"


def _two(values: list[float], digits: int = 3) -> str:
    """Return the median and the least."""
    return f"{median(values):.{digits}f}, {min(values):.{digits}f}"


def starts(results: Results, best: dict[str, Case], paper: dict[str, dict], per_solve: dict[str, float]) -> list[str]:
    """Return the table. `paper`: the measures of the paper's runs; `per_solve`: their step seconds a solve."""
    runs: dict[str, list[dict]] = {name: [] for name in cases(best)}
    nothing = []
    for number in range(ROUNDS):
        nothing.append(_nothing(results, number))
        for name, case in cases(best).items():
            runs[name].append(results.get(replace(case, name=f"{case.name}_{number}")))
    rows = [["a program of PETSc that does nothing", "", _two(nothing), "", "", "", "", "", ""]]
    for name, found in runs.items():
        whole, steps = [one["cpu_seconds"] for one in found], [one["step_seconds"] for one in found]
        own = [median(whole) - median(nothing), min(whole) - min(nothing)]
        line = [name, "", _two(whole), f"{own[0]:.3f}, {own[1]:.3f}", "", "", _two(steps), "", str(found[0]["steps"])]
        if name in paper:
            cpu, step = paper[name]["cpu_seconds"], paper[name]["solves"] * per_solve[name]
            line[4] = f"{cpu / median(whole):.0f}, {cpu / min(whole):.0f}"
            line[5] = f"{_over(cpu - median(nothing), own[0])}, {_over(cpu - min(nothing), own[1])}"
            line[7] = f"{step / median(steps):.0f}, {step / min(steps):.0f}"
        else:
            exact = FREE[0] if "unbounded" in name else BOX[0]
            line[1] = f"{abs(found[0]['angle'] / exact - 1):.1e}"
        rows.append(line)
    header = [
        "run",
        "error of the angle",
        "CPU seconds",
        "less PETSc's own start",
        "the paper's over it",
        "less the starts",
    ]
    header += ["seconds of steps", "the paper's over it", "steps"]
    return [f"### Starts: medians and least of {ROUNDS} rounds in turn\n", *table(header, rows)]
