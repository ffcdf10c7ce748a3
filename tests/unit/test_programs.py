"""The C programs test_*.c: every fact that they state holds, on several rank counts."""

import os
from pathlib import Path

import pytest
from harness import PROGRAMS, mpirun, without_mpirun

NAMES = sorted(path.stem for path in Path(__file__).parent.glob("*/test_*.c"))
CASES = [(name, ranks) for name in NAMES for ranks in (1, 2, 4) if ranks == 1 or name != "test_direct"]
CASES += [("test_adjoint", 8)] + [
    (name, ranks) for name in ("test_layout", "test_markers", "test_nearfield", "test_stream") for ranks in (3, 5)
]


@pytest.mark.parametrize("name,ranks", CASES)
def test_facts_hold(name, ranks, tmp_path):
    done = mpirun([str(PROGRAMS / name)], ranks, PETVES_SCRATCH=str(tmp_path) + os.sep)
    facts = [line for line in done.stdout.splitlines() if line.startswith(("ok ", "not ok "))]
    wrong = [line for line in facts if line.startswith("not ok ")]
    assert not wrong, "\n".join(wrong)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    assert len(facts) >= 20, "a program that states nothing proves nothing"


def test_lines_of_mpirun_are_dropped():
    """Its report between dashes, and what its event loop says of a process that has ended."""
    lines = [
        "[warn] Epoll MOD(1) on fd 24 failed. Old events were 6; read change was 2 (del): Bad file descriptor",
        "petves: error: -time_step -1: out of range",
        "-" * 70,
        "mpirun has exited",
        "-" * 70,
    ]
    assert without_mpirun("\n".join(lines)) == lines[1:2]
