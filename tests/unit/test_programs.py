"""The C programs test_*.c: every fact that they state holds, on one rank and on more."""

import os
from pathlib import Path

import pytest
from harness import PROGRAMS, mpirun, without_mpirun

NAMES = sorted(path.stem for path in Path(__file__).parent.glob("*/test_*.c"))
#: Ranks of those whose subject they are; all others run on 1 and 3.
RANKS = dict.fromkeys(("test_markers", "test_fast_solve", "test_stream"), (1, 2, 3, 5))
RANKS |= dict(test_layout=(1, 2, 3, 4, 5, 8), test_files=(1, 2, 3, 4), test_adjoint=(1, 3, 8))
RANKS |= dict(test_nearfield=(1, 3, 5), test_direct=(1,))
#: Functions that know no other ranks.
ALONE = "axial contacts crossing dipolefaces judge kernel motion packing pairkernel revolved symmetric tube"
RANKS |= {f"test_{name}": (1,) for name in ALONE.split()}
#: Facts of those that state fewer than 20.
FEW = dict(test_axial=4, test_near_cells=16)


@pytest.mark.parametrize(
    "name,ranks",
    sorted(((name, ranks) for name in NAMES for ranks in RANKS.get(name, (1, 3))), key=lambda run: run[1] == 1),
)
def test_facts_hold(name, ranks, tmp_path):
    alone = {} if ranks > 1 else {"OMPI_MCA_mpi_yield_when_idle": "0"}  # what MUMPS sends to itself is there at once
    done = mpirun([str(PROGRAMS / name)], ranks, PETVES_SCRATCH=str(tmp_path) + os.sep, **alone)
    facts = [line for line in done.stdout.splitlines() if line.startswith(("ok ", "not ok "))]
    wrong = [line for line in facts if line.startswith("not ok ")]
    assert not wrong, "\n".join(wrong)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    assert len(facts) >= FEW.get(name, 20), "a program that states nothing proves nothing"


def test_lines_of_mpirun_are_dropped():
    """Its report between dashes, and what its event loop says of a process that has ended."""
    events = "[warn] Epoll MOD(1) on fd 24 failed. Old events were 6; read change was 2 (del): Bad file descriptor"
    line, dashes = "petves: error: -time_step -1: out of range", "-" * 70
    assert without_mpirun("\n".join([events, line, dashes, "mpirun has exited", dashes])) == [line]
