"""python3 -m studies: every study takes the committed results as they are, and writes the same tables and pages again."""

import os
import shutil
import subprocess
import sys

import pytest
from harness import ROOT

HOMES = {name: name for name in ("accuracy", "inertia", "time", "gallery", "stability")} | {"reproduce": "reproduction"}
HOMES |= dict.fromkeys(("chart", "calibrate", "unseen"), "speed_accuracy")


#: Pictures but the first are built and not drawn: layouts take most of the time, and no picture is compared.
DRAWN_ONCE = """
from matplotlib.figure import Figure
real, drawn = Figure.savefig, []
def savefig(figure, path, **how):
    if not drawn:
        real(figure, path, **how)
    drawn.append(open(path, "ab").close())
Figure.savefig = savefig
"""


def study(name: str, folder, *words: str, program: str = "/nowhere/petves") -> subprocess.CompletedProcess:
    """Run a study; nothing can be run by it unless a program is given."""
    first = folder.parent / "first"
    first.mkdir()
    (first / "sitecustomize.py").write_text(DRAWN_ONCE)
    environment = os.environ | {"PETVES": program, "PYTHONPATH": f"{first}:{ROOT / 'python'}:{ROOT}"}
    command = [sys.executable, "-m", "studies", name, str(folder), *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)


@pytest.mark.parametrize("name", HOMES)
def test_committed_results_are_taken(name, tmp_path):
    """No run is made, and every CSV, JSON and Markdown file comes out as it is in docs/, but for tables.md, which only
    the sections of the paper keep there."""
    home = ROOT / "docs" / HOMES[name]
    shutil.copytree(home, tmp_path / home.name)
    words = []
    if name == "reproduce":  # whose page says how it was made
        words = ["--quick"] if "QUICK=1" in (ROOT / "docs" / "reproduction.md").read_text() else []
    done = study(name, tmp_path / home.name, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "running" not in done.stdout
    written = [path for path in tmp_path.rglob("*") if path.suffix in (".csv", ".json", ".md")]
    assert len(written) > 1
    kept = [path for path in written if path.name != "tables.md" or name == "reproduce"]
    for path in kept:
        assert path.read_text() == (ROOT / "docs" / path.relative_to(tmp_path)).read_text(), path.name


def test_a_missing_program_is_one_line(tmp_path):
    done = study("accuracy", tmp_path / "accuracy", "--quick")
    assert done.returncode == 1 and done.stderr.startswith("studies: error: /nowhere/petves: no such program")
    assert len(done.stderr.splitlines()) == 1


def test_results_that_cannot_be_read_are_one_line(tmp_path):
    home = tmp_path / "speed_accuracy"
    home.mkdir()
    (home / "calibration.json").write_text("{")
    done = study("calibrate", home)
    assert done.returncode == 1 and "calibration.json: " in done.stderr and "remove it to start afresh" in done.stderr
    assert len(done.stderr.splitlines()) == 1
