"""One run, one folder: double starts, files that are replaced or removed under a live run, and what else befalls a run
while it writes: a rank that is killed, a stop and a continue, a folder that is read-only, a clock that is set back."""

import json
import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import harness
import numpy as np
import pytest
from harness import PETVES, SANITIZE, attribute, mpirun, preloaded, read_series, run_petves, run_python, simulation
from harness import wait_for, without_mpirun
from refusals import refused
from restarts import without_wall

pytestmark = pytest.mark.xdist_group("one_folder")  # its tests share runs

SCENE = "-domain_cells 24,24 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.02 -output_every 0.1"


def start(folder: Path, options: str, ranks: int = 1, **how) -> subprocess.Popen:
    """A run in the background that has no end unless the options say one."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    return harness.start(folder, f"{SCENE} -time_end 1000 {options}", ranks, **quiet, **how)


def ends_with_line(process: subprocess.Popen, *needles: str) -> None:
    """Status 1 and one line that holds every needle."""
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1 and len(without_mpirun(err)) == 1, err
    for needle in needles:
        assert needle in err


def goes_on(folder: Path) -> None:
    """A restart goes on after the rows that its checkpoint counts."""
    step = int(attribute(folder / "checkpoint.h5"))
    rows = (folder / "series.csv").read_text().splitlines()[: step + 2]
    run = run_petves(folder, f"{SCENE} -time_end {0.02 * (step + 5)} -restart {folder}/checkpoint.h5")
    assert step > 0 and run.series["step"].tolist() == list(range(step + 6))
    assert (folder / "series.csv").read_text().splitlines()[: step + 2] == rows


STEPS = 300
END = f"-time_end {0.02 * STEPS} -checkpoint_every 10"


def two(folder: Path, kind: str, draw: random.Random) -> list[subprocess.Popen]:
    """The two runs of a kind; the first may be live already, or both begin in the same moment."""
    begin = lambda options="": start(folder, f"{END} {options}")
    restart = f"-restart {folder}/checkpoint.h5"
    if kind in ("restart twice", "overwrite and restart"):
        assert begin(f"-time_end {0.02 * (STEPS // 3)}").wait() == 0
        return [begin("-output_overwrite" if kind == "overwrite and restart" else restart), begin(restart)]
    first = begin()
    if kind == "fresh":
        time.sleep(draw.choice((0, 0, draw.uniform(0, 0.3))))
        return [first, begin()]
    wait_for((folder / "checkpoint.h5").exists)
    return [first, begin(restart if kind == "restart" else "-output_overwrite")]


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("kind", ["fresh", "overwrite", "restart", "restart twice", "overwrite and restart"])
def test_double_starts(kind, seed, tmp_path):
    """Of two runs those that are not refused end well. The folder has every row, every frame, the last checkpoint and an end, and
    no lock is left behind."""
    folder = tmp_path / "run"
    runs = two(folder, kind, random.Random(seed))
    said = [run.communicate(timeout=120)[1] for run in runs]
    for run, text in zip(runs, said):
        assert run.returncode in (0, 1), text
        if run.returncode:
            assert text.count("\n") == 1 and text.startswith("petves: error: -output_dir"), text
            assert "in use by process" in text or "holds" in text, text
    assert sum(run.returncode for run in runs) < 2, said
    assert read_series(folder / "series.csv")["step"].tolist() == list(range(STEPS + 1))
    with h5py.File(folder / "run.h5") as file:
        np.testing.assert_allclose(file["time"][:], 0.1 * np.arange(STEPS // 5 + 1), atol=1e-12)
        assert len(file["fluid/u"]) == len(file["time"]) and np.isfinite(file["vesicle/markers"][:]).all()
    assert attribute(folder / "checkpoint.h5") == STEPS
    assert json.loads((folder / "summary.json").read_text())["reason"] == "finished"
    assert not (folder / "run.lock").exists()


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_live_run_keeps_its_folder(ranks, tmp_path):
    """Host and process of who has it, for runs of one rank and of two; nothing in it is touched. When it has been killed,
    the lock is free."""
    folder = tmp_path / "run"
    live = start(folder, "-checkpoint_every 5", ranks)
    wait_for((folder / "checkpoint.h5").exists)
    for options in ("-output_overwrite", f"-restart {folder}/checkpoint.h5", "")[:: 3 - ranks]:
        needles = f"-output_dir {folder}: in use by process ", f" on {os.uname().nodename}", "allowed: another folder"
        refused(folder, f"{SCENE} -time_end 0.1 {options}", *needles, ranks=3 - ranks)
    who = int((folder / "run.lock").read_text().split()[1])
    assert "petves" in Path(f"/proc/{who}/cmdline").read_text()
    live.kill()
    live.communicate()
    wait_for(lambda: not Path(f"/proc/{who}").exists())
    rows = read_series(folder / "series.csv")["step"]
    assert rows.tolist() == list(range(len(rows)))
    run_petves(folder, f"{SCENE} -time_end 0.04 -output_overwrite")
    assert not (folder / "run.lock").exists()


def replace(folder: Path, name: str) -> None:
    """As an editor, a copy or a run of another program would."""
    (folder / "other").write_bytes((folder / name).read_bytes())
    (folder / "other").rename(folder / name)


@pytest.mark.parametrize("name, ranks", [("series.csv", 2), ("run.h5", 1), ("run.xmf", 1), ("", 1)])
def test_files_replaced_under_a_live_run(name, ranks, tmp_path):
    """The run notices at its next row. What has been put there, also in a folder of the same name, stays as it is."""
    folder = tmp_path / "run"
    live = start(folder, "-checkpoint_every 5", ranks)
    wait_for((folder / "checkpoint.h5").exists)
    if name:
        replace(folder, name)
        ends_with_line(live, str(folder / name), "cannot be written: it is gone, or another file has its name")
        return
    live.send_signal(signal.SIGSTOP)
    folder.rename(tmp_path / "elsewhere")
    run_petves(folder, f"{SCENE} -time_end 0.1")
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    live.send_signal(signal.SIGCONT)
    ends_with_line(live, str(folder), "cannot be written")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == files


@pytest.mark.parametrize("victim", [0, 1])
def test_one_rank_of_two_is_killed(victim, tmp_path):
    """mpirun ends the other one; the checkpoint is good and the lock is free."""
    folder = tmp_path / "run"
    live = start(folder, "-checkpoint_every 2", 2)
    wait_for((folder / "checkpoint_1.h5").exists)
    ranks = sorted(int(pid) for pid in Path(f"/proc/{live.pid}/task/{live.pid}/children").read_text().split())
    os.kill(ranks[victim], signal.SIGKILL)
    live.communicate(timeout=60)
    assert live.returncode not in (0, None)
    goes_on(folder)


def test_stopped_and_continued(tmp_path):
    """The run goes on, and the lock is held meanwhile."""
    folder, end = tmp_path / "run", "-time_end 4"
    live = start(folder, end)
    wait_for((folder / "run.xmf").exists)
    live.send_signal(signal.SIGSTOP)
    refused(folder, f"{SCENE} {end} -output_overwrite", "in use by process")
    live.send_signal(signal.SIGCONT)
    assert live.wait(timeout=60) == 0
    assert without_wall(folder) == without_wall(run_petves(tmp_path / "whole", f"{SCENE} {end}").folder)


@pytest.mark.skipif(os.geteuid() != 0, reason="root writes into what others may not")
def test_folder_becomes_read_only(tmp_path_factory, monkeypatch):
    """A user's run says so at its next checkpoint, and goes on from the one before when the folder is writable again.
    The program is copied, as the clone may be where only root can look."""
    place = tmp_path_factory.mktemp("open")
    for part in ("bin", "lib"):
        shutil.copytree(Path(PETVES).parents[1] / part, place / part)
    monkeypatch.setattr(harness, "PETVES", str(place / "bin" / "petves"))
    for path in (place, *list(place.parents)[:-2]):
        path.chmod(0o777)
    folder = place / "run"
    live = start(folder, "-checkpoint_every 5", user=65534)
    wait_for((folder / "checkpoint_1.h5").exists)
    folder.chmod(0o555)
    ends_with_line(live, f"{folder}/checkpoint.h5", "cannot be written")
    folder.chmod(0o777)
    goes_on(folder)


#: From the second second on the time of day is an hour earlier.
CLOCK = r"""
#include <sys/time.h>
#include <time.h>

static time_t back(time_t now) {
  static time_t first;
  if (!first) first = now;
  return now > first ? now - 3600 : now;
}

int gettimeofday(struct timeval *now, void *zone) {
  const int error = REAL(gettimeofday)(now, zone);
  now->tv_sec = back(now->tv_sec);
  return error;
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  const int error = REAL(clock_gettime)(clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec = back(now->tv_sec);
  return error;
}
"""


def test_clock_set_back(tmp_path):
    """The wall limit, the progress lines and the seconds of a step go by a clock that nobody sets."""
    options = f"{SCENE} -time_step 1e-5 -time_end 1000 -output_every 10 -time_wall_limit 4".split()
    options += ["-output_dir", str(tmp_path / "run")]
    done = mpirun([PETVES, *options], 1, 60, LD_PRELOAD=preloaded(tmp_path, CLOCK))
    assert done.returncode == 0 and "-time_wall_limit" in done.stdout, done.stdout + done.stderr
    assert read_series(tmp_path / "run" / "series.csv")["wall"].min() >= 0
    assert 0 < json.loads((tmp_path / "run" / "summary.json").read_text())["wall_seconds"]["run"] < 4
    assert "step " in done.stdout.split("stopping after")[0], "a progress line"


def test_signal_before_the_first_step(tmp_path):
    """It ends the process at once: there is nothing to save."""
    process = start(tmp_path / "run", "-domain_cells 192,192 ")

    def caught() -> int:  # signals that the process handles itself, a bit each
        lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
        return int(next(line for line in lines if line.startswith("SigCgt")).split()[1], 16)

    wait_for(lambda: caught() >> (signal.SIGTERM - 1) & 1)
    process.send_signal(signal.SIGTERM)
    assert process.wait(timeout=20) == -signal.SIGTERM
    assert not (tmp_path / "run" / "summary.json").exists()


#: A step that lasts, for all that a signal knows: a callback between two of them.
TWICE = """
import os, signal, time
import petves
sim = {simulation}
sim._lib.PetvesCatchSignals()
def wait(sim):
    for pause in {pauses}:
        time.sleep(pause)
        os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(0.1)
print(sim.run(callback=wait))
"""


@pytest.mark.skipif(SANITIZE, reason="Python is not built with the sanitizers")
@pytest.mark.parametrize("pauses, status", [((0, 0.1), 0), ((0, 1.2), -signal.SIGTERM)])
def test_second_signal_ends_the_process(pauses, status, tmp_path):
    """A second later; one that comes sooner is the same request, which mpirun and the batch system both send."""
    code = TWICE.format(simulation=simulation(SCENE), pauses=pauses)
    done = run_python(code, good=False, TMPDIR=str(tmp_path))
    assert done.returncode == status, done.stdout + done.stderr
    assert done.stdout.split() == ([] if status else ["stopped"])


def test_files_of_limited_size_are_a_line(tmp_path):
    """A file that may not grow further is one that cannot be written."""
    options = f"-domain_cells 64,64 -time_end 0.02 -output_dir {tmp_path / 'run'}"
    done = mpirun(["bash", "-c", f"ulimit -f 64; exec {PETVES} {options}"], 1, 20)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
    assert "petves: error: " in done.stderr and "cannot be written" in done.stderr


@pytest.mark.parametrize("ranks", [1, 2])
def test_no_link_is_followed(ranks, tmp_path):
    """Links in a folder, under the names of its files and of those under way, lead to no file that is changed."""
    folder, victim = tmp_path / "run", tmp_path / "victim"
    options = f"{SCENE} -time_end 0.1 -output_overwrite"
    victim.write_text("precious")
    folder.mkdir()
    files = ["series.csv", "run.h5", "run.xmf", "checkpoint.h5", "summary.json", "resolved.opts"]
    for name in [*files, *(f"{name}.tmp" for name in files), "run.h5.index", "run.h5.index.tmp"]:
        (folder / name).symlink_to(victim)
    run_petves(folder, options, ranks)
    assert victim.read_text() == "precious" and not any((folder / name).is_symlink() for name in files)
    (folder / "run.lock").symlink_to(victim)
    run = run_petves(folder, options, ranks, good=False)
    assert run.status == 1 and "run.lock: cannot be written (" in run.errors[0] and victim.read_text() == "precious"


@pytest.mark.skipif(SANITIZE, reason="the sanitizers take memory of their own")
def test_too_little_memory_is_a_line(tmp_path):
    """OpenBLAS would ask for its own memory for ever."""
    options = f"-domain_cells 24,24 -time_end 0.01 -output_dir {tmp_path / 'run'}"
    done = mpirun(["bash", "-c", f"ulimit -v 350000; exec {PETVES} {options}"], 1, 20)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
    assert "petves: error: out of memory" in done.stderr and "allowed: " in done.stderr
