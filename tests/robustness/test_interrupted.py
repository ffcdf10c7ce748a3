"""Signals, kills, full disks: what an interrupted run leaves is whole, or it is refused."""

import json
import random
import signal
import subprocess
import time
from pathlib import Path

import h5py
import pytest
from harness import PAPER, PETVES, SANITIZE, attribute, read_series, run_petves, run_python, simulation, start
from harness import wait_for_rows
from refusals import one_line
from restarts import BASE, same_frames, without_wall


@pytest.mark.parametrize("ranks, name", [(1, "SIGTERM"), (2, "SIGUSR1"), (1, "SIGINT")])
def test_signals_stop_the_run_after_a_step(ranks, name, tmp_path):
    """Status 0, checkpoint and summary of the last step; the restart ends as the run without a signal."""
    folder, options = tmp_path / "run", f"{BASE} -output_every 0.02"
    process = start(folder, f"{options} -time_end 100", ranks, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    wait_for_rows(folder, 3)
    process.send_signal(getattr(signal, name))
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0 and name in out, out + err
    summary = json.loads((folder / "summary.json").read_text())
    last = int(read_series(folder / "series.csv")["step"][-1])
    assert summary["reason"] == "stopped" and summary["totals"]["steps"] == last
    assert attribute(folder / "checkpoint.h5") == last
    end = f"-time_end {0.02 * (last + 3)}"
    run_petves(folder, f"{options} {end} -restart {folder}/checkpoint.h5", ranks)
    whole = run_petves(tmp_path / "whole", f"{options} {end}", ranks)
    assert without_wall(folder) == without_wall(whole.folder)


def test_ctrl_c_is_ignored_where_a_shell_says_so(tmp_path):
    """As for a background job of a script, which is to live on when its terminal stops something else."""
    folder, line = tmp_path / "run", f"trap '' INT; exec {PETVES} -output_dir {tmp_path / 'run'} $0"
    options = f"{BASE} -output_every 0.02 -time_end 0.4"
    process = subprocess.Popen(["bash", "-c", line.replace("$0", options)], stdout=subprocess.PIPE, text=True)
    wait_for_rows(folder, 3)
    process.send_signal(signal.SIGINT)
    assert "finished at time 0.4" in process.communicate(timeout=60)[0]


@pytest.mark.alone
def test_wall_limit_stops_in_time(tmp_path):
    """With room for one more step and the checkpoint, and not at once."""
    begin = time.time()
    run = run_petves(tmp_path / "run", f"{PAPER} {BASE} -domain_cells 96,96 -time_end 1000 -time_wall_limit 3", 2)
    assert time.time() - begin < 8, "limit and start of mpirun on a busy machine"
    assert "-time_wall_limit" in run.stdout
    assert run.summary["reason"] == "stopped"
    assert len(run.series["step"]) > 2 and (run.folder / "checkpoint.h5").exists()


def wait_for_writing(process: subprocess.Popen, folder: Path):
    """Until this launch has written its first frame, or has ended."""
    begin = time.time_ns()
    file = folder / "run.xmf"
    while process.poll() is None and not (file.exists() and file.stat().st_mtime_ns > begin):
        time.sleep(0.002)


#: The paper's steps are the shortest, so the run does little but write.
KILLED = f"{PAPER} {BASE} -domain_cells 24,24 -output_every 0.02 -checkpoint_every 1"
TRIALS = 30


def test_killed_at_any_moment(tmp_path):
    """SIGKILL, 30 times, mostly in the middle of a file, in a run that does little but write. Each launch goes on from the newest checkpoint; in the end
    the run is the one that was never killed, row by row and frame by frame."""
    draw, folder = random.Random(30), tmp_path / "run"
    for _ in range(TRIALS):
        restart = f"-restart {folder}/checkpoint.h5" if (folder / "checkpoint.h5").exists() else "-output_overwrite"
        with open(tmp_path / "errors", "w") as file:
            process = start(folder, f"{KILLED} -time_end 100 {restart}", stdout=subprocess.DEVNULL, stderr=file)
            wait_for_writing(process, folder)
            time.sleep(draw.uniform(0, 0.1))
            process.kill()
        status, text = process.wait(), (tmp_path / "errors").read_text()
        assert status == -signal.SIGKILL, text
    last = int(read_series(folder / "series.csv")["step"][-2])
    end = f"-time_end {0.02 * (last + 5)}"
    run_petves(folder, f"{KILLED} {end} -restart {folder}/checkpoint.h5")
    whole = run_petves(tmp_path / "whole", f"{KILLED} {end}")
    assert last > (TRIALS / 3 if SANITIZE else TRIALS), "there was time to write between the kills"
    assert without_wall(folder) == without_wall(whole.folder)
    same_frames(folder, whole.folder)


def break_tables(folder: Path, width: int = 8) -> int:
    """Overwrite everything in the run.h5 of a killed run but the frames that its checkpoint counts; its last step. A number of
    the fields has `width` bytes."""
    with h5py.File(folder / "checkpoint.h5") as file:
        last, saved = int(file.attrs["step"]), int(file.attrs["frames"])
        bytes_of = [width * file["fluid/p"].size] * 3
        bytes_of += [8 * file[name].size for name in ("vesicle/markers", "vesicle/markers", "vesicle/tension")]
        bytes_of.append(8)  # of the pressure gradient
    rows = [row.split() for row in (folder / "run.h5.index").read_text().splitlines()]
    kept = [(int(x), n) for row in rows if int(row[0]) < saved for x, n in zip(row[2:], bytes_of)]
    good = (folder / "run.h5").read_bytes()
    bad = bytearray(len(good))
    for place, size in kept:
        bad[place : place + size] = good[place : place + size]
    (folder / "run.h5").write_bytes(bad)
    return last


@pytest.mark.parametrize("ranks, precision", [(1, "double"), (2, "double"), (1, "single")])
def test_killed_run_with_broken_tables(ranks, precision, tmp_path):
    """Everything in run.h5 but its frames is overwritten: with the index of a killed run it is made anew."""
    folder, options = tmp_path / "run", f"{KILLED} -output_precision {precision}"
    with open(tmp_path / "errors", "w") as file:
        process = start(folder, f"{options} -time_end 100", stdout=subprocess.DEVNULL, stderr=file)
        wait_for_rows(folder, 6)
        process.kill()
    assert process.wait() == -signal.SIGKILL, (tmp_path / "errors").read_text()
    last = break_tables(folder, 8 if precision == "double" else 4)
    end = f"-time_end {0.02 * (last + 5)}"
    run_petves(folder, f"{options} {end} -restart {folder}/checkpoint.h5", ranks)
    whole = run_petves(tmp_path / "whole", f"{options} {end}")
    assert not (folder / "run.h5.index").exists(), "of a run that was killed only"
    same_frames(folder, whole.folder, 0 if ranks == 1 else 1e-9)


@pytest.mark.skipif(SANITIZE, reason="Python is not built with the sanitizers")
def test_broken_tables_after_an_end_that_was_not_the_end(tmp_path):
    """From Python a run goes on after its end: the frame of that end, at no saved time, is written over. Then it is
    killed."""
    options = f"{BASE} -domain_cells 24,24 -output_every 0.04 -checkpoint_every 1 -time_end 0.06"
    call = simulation(options, output_dir=tmp_path / "run")
    code = f"import os, petves\nsim = {call}\nsim.run()\nsim.run(until=0.22)\nos.kill(os.getpid(), 9)\n"
    assert run_python(code, good=False).returncode == -signal.SIGKILL
    assert break_tables(tmp_path / "run") == 11
    run_plainly = f"{BASE} -domain_cells 24,24 -output_every 0.04 -time_end 0.4"
    run_petves(tmp_path / "run", f"{run_plainly} -checkpoint_every 1 -restart {tmp_path}/run/checkpoint.h5")
    whole = run_petves(tmp_path / "whole", run_plainly)
    same_frames(tmp_path / "run", whole.folder)


@pytest.mark.parametrize("kib, ranks", [(8, 1), (56, 1), (60, 1), (120, 2), (240, 1), (600, 2), (800, 1)])
def test_full_disk(kib, ranks, tmp_path, request):
    """One line; a checkpoint that is there is good, and no half one has its name. Needs the right to mount a disk."""
    (tmp_path / "disk").mkdir()
    words = f"mount -t tmpfs -o size={kib}k tmpfs {tmp_path / 'disk'}".split()
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"mount is not permitted here: {done.stderr.strip()}")
    request.addfinalizer(lambda: subprocess.run(["umount", tmp_path / "disk"], check=True))
    folder = tmp_path / "disk" / "run"
    run = run_petves(folder, f"{BASE} -time_end 9 -output_every 0.02 -checkpoint_every 2", ranks, False)
    one_line(run, str(folder), "cannot be written", "allowed")
    for path in folder.glob("checkpoint*"):
        step = attribute(path)
        again = run_petves(tmp_path / path.stem, f"{BASE} -restart {path} -time_end {0.02 * (step + 1)}")
        assert again.series["step"][0] == step and len(again.series["step"]) == 2
    assert kib < 600 or (folder / "checkpoint.h5").exists()


def test_vanished_folder(tmp_path):
    """The folder is removed while the run goes on: one line at the next file."""
    folder = tmp_path / "run"
    process = start(folder, f"{KILLED} -time_end 100", stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wait_for_rows(folder, 3)
    folder.rename(tmp_path / "elsewhere")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1 and err.count("\n") == 1 and "cannot be written" in err, err
