"""python3 -m petves sweep: what a run has left is never deleted, what is remembered, and what is not."""

import csv
import json
import os
import subprocess
from pathlib import Path

import pytest
from harness import ENVIRONMENT, PETVES, read_series, run_tool, start, wait_for
from restarts import without_wall

from petves.sweeps import _name

pytestmark = pytest.mark.xdist_group("sweep")

SHARED = "-domain_cells 16,16\n-domain_box -2,2,-2,2\n-vesicle_semi_axes 0.8,1\n-scheme_type split\n"
SHARED += "-time_step 0.02\n-time_end 0.4\n-output_every 0.02\n-checkpoint_every 2\n"


@pytest.fixture
def sweep(tmp_path):
    """A function that runs a sweep in tmp_path/grid; the status, the lines of standard error, rows of sweep.csv."""
    (tmp_path / "shared.opts").write_text(SHARED)

    def run(*vary: str, program: str = PETVES, ranks: int = 1, path: str = ""):
        words = ["sweep", tmp_path / "grid", "--options-file", tmp_path / "shared.opts", "--jobs", 2]
        words += ["--ranks", ranks, "--vary", *vary]
        done = run_tool(*words, PETVES=program, PATH=path + os.environ["PATH"])
        table = tmp_path / "grid" / "sweep.csv"
        rows = list(csv.DictReader(table.open(newline=""))) if table.is_file() else []
        return done.returncode, done.stderr.splitlines(), rows

    return run


def script(path: Path, text: str) -> str:
    path.write_text(f"#!/bin/bash\n{text}\n")
    path.chmod(0o755)
    return str(path)


SBATCH = """
echo "$*" > "$0.words"
for word in "$@"; do [[ $word = --array=1-* ]] && last=${word#--array=1-}; done
for task in $(seq "$last"); do SLURM_ARRAY_TASK_ID=$task bash -c "${@: -1}" > "$0.$task" || exit; done
echo "Submitted batch job 7"
"""


def test_job_array_runs_each_combination_once(sweep, tmp_path):
    """A false sbatch runs the tasks one after the other; the same command then writes the table and runs nothing."""
    sbatch = script(tmp_path / "sbatch", SBATCH)
    values = ("fluid_viscosity", "1", "2", "--vary", "time_end", "0.02")
    status, lines, _ = sweep(*values, "--slurm", "--time=1:00 --comment='a b'", path=f"{tmp_path}:")
    assert status == 0 and not lines
    words = (tmp_path / "sbatch.words").read_text()
    assert words.startswith("--array=1-2 --ntasks=1 --job-name=petves --time=1:00 --comment=a b --wrap ")
    status, lines, rows = sweep(*values, program=script(tmp_path / "none", "exit 1"))
    found = [(row["fluid_viscosity"], row["status"], row["step"]) for row in rows]
    assert status == 0 and found == [("1", "done", "1"), ("2", "done", "1")]
    script(Path(sbatch), "echo no such partition >&2; exit 1")
    assert sweep(*values, "--slurm", path=f"{tmp_path}:")[:2] == (1, ["petves: error: sbatch: no such partition"])


def test_full_disk_deletes_nothing_and_goes_on(sweep, tmp_path):
    """No file grows beyond a size that the runs reach after some steps: each keeps its checkpoint and its rows. The next
    call goes on from there, to the rows of runs that had room."""
    values = ("fluid_viscosity", "1", "2")
    small = script(tmp_path / "small", f"trap '' XFSZ; ulimit -f 60; exec {PETVES} \"$@\"")
    status, lines, rows = sweep(*values, program=small)
    assert status == 1 and len(lines) == 2, lines
    assert all(line.startswith("petves: error: fluid_viscosity=") and "cannot be written" in line for line in lines)
    assert [row["status"] for row in rows] == ["failed", "failed"] and int(rows[0]["step"]) > 2
    homes = [tmp_path / "grid" / row["folder"] for row in rows]
    kept = [(home / "series.csv").read_text() for home in homes]
    assert all((home / "checkpoint.h5").is_file() and not (home / "status.json").exists() for home in homes)
    assert sweep(*values, program=small)[0] == 1, "again, and still nothing is lost"
    assert all((home / "checkpoint.h5").is_file() for home in homes)
    status, lines, rows = sweep(*values)
    assert status == 0 and not lines and [row["status"] for row in rows] == ["done", "done"]
    for home, value, text in zip(homes, "12", kept):
        assert read_series(home / "series.csv")["step"].tolist() == list(range(21))
        assert (home / "series.csv").read_text().startswith("".join(text.splitlines(True)[:3])), "it went on"
        words = ["-options_file", tmp_path / "shared.opts", "-fluid_viscosity", value, "-output_dir", tmp_path / value]
        subprocess.run([PETVES, *words], env={**os.environ, **ENVIRONMENT}, check=True, stdout=subprocess.DEVNULL)
        assert without_wall(home) == without_wall(tmp_path / value)


def test_a_grid_that_grows_runs_what_is_new(sweep, tmp_path):
    """Each pair of values once, and again one whose end is not known, from its checkpoint; the table has last rows. Other shared
    options are refused."""
    grid = ("--vary", "time_end", "0.02", "0.04")
    status, _, rows = sweep("fluid_viscosity", "1", "2", *grid)
    found = [(row["fluid_viscosity"], row["time_end"], row["status"]) for row in rows]
    assert status == 0 and found == [(v, t, "done") for v in "12" for t in ("0.02", "0.04")]
    for row in rows:
        series = read_series(tmp_path / "grid" / row["folder"] / "series.csv")
        assert float(row["energy_bending"]) == series["energy_bending"][-1]
        assert float(row["time"]) == float(row["time_end"])
    times = lambda: {path: path.stat().st_mtime_ns for path in (tmp_path / "grid").glob("*/series.csv")}
    before, interrupted = times(), tmp_path / "grid" / rows[0]["folder"]
    (interrupted / "status.json").unlink()  # as after a kill: its checkpoint is there
    rows_before = (interrupted / "series.csv").read_text()
    assert len(sweep("fluid_viscosity", "1", "2", "3", *grid)[2]) == 6
    again = {path.parent.name for path, time in times().items() if time != before.get(path)}
    assert again == {rows[0]["folder"], "fluid_viscosity=3,time_end=0.02", "fluid_viscosity=3,time_end=0.04"}
    assert (interrupted / "series.csv").read_text() == rows_before, "it went on from its checkpoint"
    (tmp_path / "shared.opts").write_text("-domain_cells 32,32\n")
    status, lines, _ = sweep("fluid_viscosity", "1")
    assert status == 1 and "holds a sweep with other shared options" in lines[0]


def test_only_bad_options_are_remembered(sweep, tmp_path):
    """No slots for the ranks, or a program that is killed, says nothing of the options; a value that is refused does."""
    (tmp_path / "bin").mkdir()
    script(tmp_path / "bin" / "mpirun", "echo 'There are not enough slots available in the system' >&2; exit 1")
    status, lines, rows = sweep("fluid_viscosity", "1", "-1", ranks=2, path=f"{tmp_path / 'bin'}:")
    assert status == 1 and len(lines) == 2 and all("not enough slots" in line for line in lines), lines
    assert [row["status"] for row in rows] == ["failed", "failed"]
    killed = script(tmp_path / "killed", "kill -9 $$")
    assert [row["status"] for row in sweep("fluid_viscosity", "1", program=killed)[2]] == ["failed"]
    status, lines, rows = sweep("fluid_viscosity", "1", "-1")
    assert status == 1 and len(lines) == 1 and "refused: -fluid_viscosity -1: out of range" in lines[0], lines
    assert [row["status"] for row in rows] == ["done", "refused"] and rows[1]["area"] == "" != rows[0]["area"]
    assert sweep("fluid_viscosity", "1", "-1", program=killed)[1] == lines, "neither is run again"


def test_runs_without_a_checkpoint_are_moved_aside(sweep, tmp_path):
    """What a run left that was killed before its first checkpoint, but never the folder of a live one."""
    home = tmp_path / "grid" / "checkpoint_every=0"
    process = start(home, f"{SHARED} -checkpoint_every 0 -time_end 1000", stdout=subprocess.DEVNULL)
    wait_for((home / "run.xmf").exists)
    status, lines, _ = sweep("checkpoint_every", "0")
    assert status == 1 and f"in use by process {process.pid}" in lines[0] and process.poll() is None, lines
    process.kill()
    process.wait()
    rows = (home / "series.csv").read_text()
    assert sweep("checkpoint_every", "0")[0] == 0
    assert (tmp_path / "grid" / "checkpoint_every=0~1" / "series.csv").read_text() == rows
    assert json.loads((home / "summary.json").read_text())["reason"] == "finished"


def test_folders_do_not_collide(sweep, tmp_path):
    """a/b and a_b are two runs, and so are values with an equals sign or of any length; the same one twice is one."""
    status, lines, rows = sweep("vesicle_file", "a/b", "a_b", "a_b")
    assert status == 1 and len(lines) == 2, "each is refused, and once"
    assert [row["vesicle_file"] for row in rows] == ["a/b", "a_b"] and rows[0]["folder"] != rows[1]["folder"]
    values = ["a/b", "a_b", "a%2Fb", "c=d", "c%3Dd", "e#f", "e", "1,p=2", f"{'x' * 300}1", f"{'x' * 300}2"]
    names = {_name(point) for point in [{"o": value} for value in values] + [{"o": "1", "p": "2"}]}
    assert len(names) == len(values) + 1
    assert all(len(name) < 255 and not set(name) & set('/#"') for name in names)


def test_a_stopped_run_is_a_line(sweep):
    status, lines, rows = sweep("limit_length_error", "0.2", "1e-12")
    assert status == 1 and len(lines) == 1 and "limit_length_error=1e-12: stopped: vesicle 1: length error" in lines[0]
    assert [row["status"] for row in rows] == ["done", "stopped"]


def test_a_full_disk_of_the_sweep_itself_is_a_line(sweep, tmp_path):
    (tmp_path / "grid" / "shared.opts").mkdir(parents=True)
    status, lines, _ = sweep("fluid_viscosity", "1")
    assert status == 1 and len(lines) == 1 and "cannot be written" in lines[0], lines
