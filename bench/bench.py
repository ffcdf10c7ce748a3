"""`make bench`: measure, keep every number in bench/results, write the tables and pictures of docs/performance.

Each item is a file of results. Runs that are in it are not made again, so a stopped bench goes on; `make bench` after
`rm bench/results/size.json` repeats that item. Runs of an item are made in turn, round by round.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from machine import machine
from report import report

from petves.program import OPEN_MPI
from studies.common.engine import Kept

ROOT = Path(__file__).resolve().parent.parent
PROGRAMS = Path(os.environ.get("PETVES_BENCH", str(ROOT / "build" / "bench")))
BOXES = {
    "channel": "-domain_bc_x periodic",
    "periodic": "-domain_bc_x periodic -domain_bc_y periodic",
    "walls": "",
}
#: Tank-treading: rate 1, V = 0.7, chi = 10.
SCENE = (
    "-domain_box -4,4,-4,4 -flow_type shear -vesicle_area 1 -vesicle_reduced_area 0.7 -vesicle_bending 0.03066 "
    "-time_step 0.025"
)
#: 254 vesicles of 64 markers, packed at random to three tenths of a channel.
MANY = (
    "-domain_bc_x periodic -domain_box 0,42,0,20.16 -flow_center_y 10 -fluid_inertia none -vesicle_packing .3 -vesicle_packing_gap .033716776567236789 "
    "-vesicle_markers 64 -time_step .05"
)


@dataclass
class Run:
    """One run of a program, repeated in `rounds` rounds."""

    name: str  # words that the report takes apart
    program: str  # bench_solve or bench_step
    options: str
    ranks: int = 1
    rounds: int = 1


def step(name: str, cells: int, box: str, ranks: int, options: str, warmup: int, steps: int, rounds: int) -> Run:
    """Return a run of bench_step in one of the boxes."""
    text = f"-bench_warmup {warmup} -bench_steps {steps} -domain_cells {cells},{cells} {SCENE} {BOXES[box]} {options}"
    return Run(f"{name} {cells} {box} {ranks}", "bench_step", text, ranks, rounds)


def many(ranks: int, warmup: int, steps: int, rounds: int) -> Run:
    """Return a run of the suspension."""
    text = f"-bench_warmup {warmup} -bench_steps {steps} {SCENE} {MANY} -domain_cells 1000,480"
    return Run(f"coupled 1000x480 suspension {ranks}", "bench_step", text, ranks, rounds)


def items(quick: bool) -> dict[str, list[Run]]:
    """Return the runs of every item; QUICK has smaller grids and fewer rounds, for a look."""
    middle, large = (128, 256) if quick else (512, 1024)
    warmup, steps, rounds = (5, 5, 1) if quick else (20, 8, 3)
    solve = [
        Run(f"solve {n} {ranks}", "bench_solve", f"-cells {n} -repeats {repeats} -hypre {hypre}", ranks)
        for n, ranks, repeats, hypre in (
            [(64, 1, 5, "true"), (128, 1, 5, "true"), (128, 2, 5, "false")]
            if quick
            else [(256, 1, 15, "true"), (512, 1, 7, "true"), (1024, 1, 11, "false"), (512, 2, 15, "false"), (1024, 2, 11, "false")]  # fmt: skip
        )
    ]
    schemes = {"split": "-scheme_type split", "coupled": "-scheme_type coupled"}
    share = [
        step(scheme, middle, box, ranks, schemes[scheme], warmup, steps, rounds)
        for scheme, box, ranks in product(schemes, BOXES, (1, 2))
    ]
    ranks = [
        step("coupled", large, box, ranks, schemes["coupled"], warmup, steps, 1 if quick else 2)
        for box, ranks in product(BOXES, (1, 2))
    ]
    ranks += [many(count, *((5, 2, 1) if quick else (6, 6, 2))) for count in (1, 2)]
    fewer = {2048: (20, 8, 2), 4096: (20, 8, 1)}
    size = [
        step("coupled", n, box, 1, schemes["coupled"], *fewer.get(n, (warmup, steps, rounds)))
        for n, box in product((64, 128, 256) if quick else (128, 256, 512, 1024, 2048, 4096), ("channel", "walls"))
    ]
    settled, count = (100, 50) if quick else (400, 100)
    steady = [
        step("coupled", n, box, 1, schemes["coupled"], settled, count, 1)
        for n, box in product((64,) if quick else (128, 256), BOXES)
    ]
    back_ends = {t: f"-scheme_type split -helmholtz_type {t} -poisson_type {t}" for t in ("fftw_tridiagonal", "fftw", "hypre")}  # fmt: skip
    solvers = [
        step(name, n, "channel", 1, options, 1, 5, 1)
        for n, (name, options) in product((64,) if quick else (128, 256), back_ends.items())
        if name != "hypre" or n <= 128  # at 256^2 a residual of 1e-12 is not to be had
    ]
    startup = [
        step("coupled", middle, box, 1, schemes["coupled"], warmup, steps, rounds) for box in ("channel", "walls")
    ]
    return {"solve": solve, "share": share, "ranks": ranks, "size": size, "steady": steady, "solvers": solvers, "startup": startup}  # fmt: skip


def measure(run: Run) -> list[dict[str, object]]:
    """Run a program; return the objects that it prints."""
    done = subprocess.run(
        ["mpirun", "-n", str(run.ranks), str(PROGRAMS / run.program), *run.options.split()],
        env=OPEN_MPI | os.environ,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        sys.exit(f"bench: {run.program} {run.options}\n{done.stdout}\n{done.stderr}")
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def run_item(name: str, runs: list[Run], folder: Path) -> None:
    """Make the runs of an item that are not in its file yet, in turn."""
    kept, began = Kept(folder / f"{name}.json"), time.time()
    for number in range(max(run.rounds for run in runs)):
        for run in runs:
            key = f"{run.name} #{number}"
            if number < run.rounds and key not in kept.entries:
                kept.keep(key, measure(run))
    print(f"{name}: {time.time() - began:.0f} s", flush=True)


def main() -> int:
    """Run every item, then write the report."""
    quick = os.environ.get("QUICK", "") not in ("", "0")
    folder = ROOT / "out" / "bench" if quick else ROOT / "bench"
    results = folder / "results"
    results.mkdir(parents=True, exist_ok=True)
    (results / "machine.json").write_text(json.dumps(machine(), indent=1) + "\n")
    for name, runs in items(quick).items():
        run_item(name, runs, results)
    for path in report(results, (folder if quick else ROOT / "docs") / "performance"):
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
