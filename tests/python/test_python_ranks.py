"""What one rank alone decides in Python, all ranks do: no run hangs. A time-out of mpirun's own ends one that does."""

import csv
from pathlib import Path

import pytest
from harness import PACKAGE, ROOT, SANITIZE, attribute, mpirun
from refusals import matches

TIMEOUT = 60
RANKS = 3
HEAD = """
import sys
import numpy as np
from petsc4py import PETSc
import petves
RANK, RANKS = PETSc.COMM_WORLD.getRank(), PETSc.COMM_WORLD.getSize()
ALONE = RANK == RANKS - 1  # the rank that does otherwise
SCENE = dict(domain_cells=(32, 32), vesicle_semi_axes=(0.35, 0.5), time_step=0.01, time_end=0.08, output_dir=sys.argv[1])
def tell(*words):
    sys.stdout.write(" ".join(map(str, (RANK, *words))) + chr(10))
def stumble(sim):
    if ALONE and sim.steps == 3:
        raise ValueError("mine")
"""


def run_script(tmp_path: Path, body: str, ranks: int = RANKS, good: bool = True):
    """Run a script on some ranks, which with `good` must end well; returns the finished process, and what each rank tells, in
    the order of the ranks."""
    command, clock = ["/usr/bin/python3", "-c", HEAD + body, str(tmp_path / "run")], ("--timeout", str(TIMEOUT))
    done = mpirun(command, ranks, 2 * TIMEOUT, clock, **PACKAGE)
    assert "Timeout" not in done.stderr and "time limit" not in done.stderr, f"it hangs\n{done.stdout}{done.stderr}"
    assert done.returncode == (0 if good else 1), done.stderr
    return done, [line.split(maxsplit=1)[1] for line in sorted(done.stdout.splitlines())]


if not SANITIZE:  # a sanitized library cannot be loaded into Python

    def test_a_callback_stops_all_ranks(tmp_path):
        """Any rank that wants to stop stops all, after the same step; the others may have no callback at all."""
        body = """
with petves.Simulation(**SCENE) as sim:
    one = sim.run(callback=lambda s: ALONE and s.steps == 2)
    two = sim.run(callback=(lambda s: s.steps == 4) if ALONE else None)
    tell(one, two, sim.steps, sim.run(), sim.steps)
"""
        _, told = run_script(tmp_path, body)
        assert told == ["callback callback 4 finished 8"] * RANKS

    def test_a_callback_that_raises_ends_all_ranks(tmp_path):
        """The exception where it was raised, petves.Error of one line elsewhere; the state of the last step is on disk."""
        body = """
with petves.Simulation(**SCENE) as sim:
    try:
        sim.run(callback=stumble)
    except (ValueError, petves.Error) as error:
        tell(type(error).__name__, error)
"""
        _, told = run_script(tmp_path, body)
        assert told == ["Error the callback raised an exception on another rank"] * (RANKS - 1) + ["ValueError mine"]
        assert attribute(tmp_path / "run" / "checkpoint.h5") == 3

    def test_an_exception_that_nobody_catches_ends_the_program(tmp_path):
        body = """
with petves.Simulation(**SCENE) as sim:
    sim.run(callback=stumble)
"""
        done, _ = run_script(tmp_path, body, 2, good=False)
        assert "ValueError: mine" in done.stderr or "another rank" in done.stderr
        assert attribute(tmp_path / "run" / "checkpoint.h5") == 3

    @pytest.mark.parametrize("mistake", ["raise ValueError('mine')", "u = np.where(x > -9, np.nan, x)"])
    def test_a_flow_that_fails_on_one_rank_fails_the_step_on_all(mistake, tmp_path):
        """The message of tests/repo/messages/flow.csv, on all ranks; the state before is on disk."""
        body = f"""
def flow(x, y, t):
    u = y.copy()
    if ALONE and t > 0.035:
        {mistake}
    return u, 0 * y
TWO = dict(vesicle_count=2, vesicle_center=(-0.5, 0, 0.5, 0), vesicle_semi_axes=(0.2, 0.3), domain_cells=(48, 48))
with petves.Simulation(flow=flow, **SCENE | TWO) as sim:
    try:
        sim.run()
    except (ValueError, petves.Error) as error:
        tell(type(error).__name__, sim.steps, error)
"""
        _, told = run_script(tmp_path, body)
        raised = "raise" in mistake
        with (ROOT / "tests" / "repo" / "messages" / "flow.csv").open(newline="") as file:
            listed = dict(list(csv.reader(file))[1:])
        (pattern,) = (text for what, text in listed.items() if what.startswith("fails" if raised else "gives"))
        assert len(told) == RANKS and (told[-1] == "ValueError 3 mine") == raised
        for line in told[: RANKS - raised]:
            kind, steps, message = line.split(maxsplit=2)
            assert (kind, steps) == ("Error", "3") and matches(pattern, message), line
        assert attribute(tmp_path / "run" / "checkpoint.h5") == 3

    @pytest.mark.parametrize("caught", ["with", "later", "C"])
    def test_an_error_of_one_rank_between_steps_ends_all(caught, tmp_path):
        """The others would wait for it in their next step: its line is said, and the program ends on all ranks."""
        fault = "raise ValueError('mine')" if caught != "C" else "sim.vec('markers').setValue(1 << 30, 0.0)"
        body = f"""
sim = petves.Simulation(**SCENE | dict(time_end=1e6))
{"with sim:" if caught == "with" else "if True:"}
    sim.step()
    if ALONE:
        {fault}
    sim.run()
"""
        done, _ = run_script(tmp_path, body, 2, good=False)
        lines = [line for line in done.stderr.splitlines() if line.startswith("petves: error: ")]
        assert len(lines) == 1
        assert "mine" in lines[0] or caught == "C"
