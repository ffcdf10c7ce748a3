"""The C programs test_*.c: every fact that they state holds, on several rank counts."""

import os
from pathlib import Path

import pytest
from conftest import PROGRAMS, mpirun

NAMES = sorted(path.stem for path in Path(__file__).parent.glob("test_*.c"))
CASES = [(name, ranks) for name in NAMES for ranks in (1, 2, 4)]
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
