"""A restarted run is the run that was not interrupted: the same bits on the same ranks, 1e-10 on others; and nothing
that an interruption leaves is taken for good when it is not."""

import json
import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import COLUMNS, ENVIRONMENT, PAPER, PETVES, ROOT, SANITIZE, mpirun, read_series, run_petves

BASE = "-domain_cells 32,32 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.02 -output_every 0.05"
DEFAULTS = "-delta_type cbs54 -membrane_derivative spectral -coupling_self_mobility symbol -scheme_area_target true"
TWO = (
    "-domain_box -1.5,1.5,-1.5,1.5 -domain_cells 48,48 -vesicle_semi_axes 0.2,0.4 -vesicle_count 2 "
    "-vesicle_center -0.5,0.2,0.5,-0.2"
)
SCHEMES = {
    "split": f"{BASE} -scheme_type split",
    "penalty": f"{BASE} -scheme_type penalty",
    "order_1": f"{BASE} -scheme_type coupled -scheme_order 1",
    "order_2": f"{BASE} -scheme_type coupled {DEFAULTS}",
    "stiff": f"{BASE} -scheme_type coupled {DEFAULTS} -vesicle_bending 100",  # edges are put right after its steps
    "adaptive": f"{BASE} -scheme_type coupled {DEFAULTS} -time_adapt error -time_adapt_tol 1e-3",
    "two_vesicles": f"{BASE} {TWO} -scheme_type coupled {DEFAULTS}",
    "total_form": f"{BASE} -flow_form total -scheme_type coupled -scheme_order 1",
}
N = 8  # steps to the checkpoint; twice as many in all


def without_wall(path: Path, first: int = 0) -> list[str]:
    """Rows of a series.csv as text from a step on, the column wall left out."""
    rows = [line.split(",") for line in path.read_text().splitlines()[1:]]
    wall = COLUMNS.index("wall")
    return [",".join(row[:wall] + row[wall + 1 :]) for row in rows if int(row[0]) >= first]


def frames(folder: Path) -> dict[str, np.ndarray]:
    """Every dataset of run.h5."""
    found = {}
    with h5py.File(folder / "run.h5") as file:
        file.visititems(lambda name, item: found.update({name: item[:]}) if isinstance(item, h5py.Dataset) else None)
    return found


def one_line(run, *needles):
    """The run was refused with one line that holds every needle."""
    assert run.status == 1 and len(run.errors) == 1, "\n".join(run.errors)
    assert run.errors[0].startswith("petves: error: ")
    for needle in needles:
        assert needle in run.errors[0]


@pytest.fixture(scope="module")
def straight(tmp_path_factory):
    """A run of 2 N steps that keeps all its checkpoints, a scheme; made once."""
    made = {}

    def get(name: str):
        if name not in made:
            options = f"{SCHEMES[name]} -time_end {0.02 * 2 * N} -checkpoint_every {N} -checkpoint_keep 9"
            made[name] = run_petves(tmp_path_factory.mktemp(name) / "run", options, ranks=2)
        return made[name]

    return get


def at_step(folder: Path, step: int) -> str:
    """The name of the checkpoint of a step."""
    for path in folder.glob("checkpoint*.h5"):
        with h5py.File(path) as file:
            if file.attrs["step"] == step:
                return path.name
    raise AssertionError(f"no checkpoint of step {step} in {folder}")


@pytest.mark.parametrize("name", SCHEMES)
def test_restart_gives_the_same_bits(name, straight, tmp_path):
    """From the checkpoint of step N in the folder of the run, which went on past it: series.csv and run.h5 are those of
    the run that was never interrupted."""
    whole = straight(name)
    folder = tmp_path / "run"
    shutil.copytree(whole.folder, folder)
    options = f"{SCHEMES[name]} -time_end {0.02 * 2 * N} -checkpoint_every {N} -checkpoint_keep 9"
    run = run_petves(folder, f"{options} -restart {folder / at_step(folder, N)}", ranks=2)
    assert len(without_wall(folder / "series.csv")) > N + 1
    assert without_wall(folder / "series.csv") == without_wall(whole.folder / "series.csv")
    ours, theirs = frames(folder), frames(whole.folder)
    assert set(ours) == set(theirs) and len(ours) == 7
    for key in ours:
        np.testing.assert_array_equal(ours[key], theirs[key], err_msg=key)
    totals = [json.loads((f / "summary.json").read_text())["totals"] for f in (folder, whole.folder)]
    assert totals[0] == totals[1]
    assert "closer than" not in run.stdout


@pytest.mark.parametrize(
    "name, ranks", [("split", 4), ("penalty", 4), ("order_1", 1), ("order_2", 4), ("adaptive", 1), ("two_vesicles", 4)]
)
def test_restart_on_other_ranks(name, ranks, straight, tmp_path):
    """In a new folder, which begins with the checkpoint's state."""
    whole = straight(name)
    options = f"{SCHEMES[name]} -time_end {0.02 * 2 * N} -checkpoint_every {N}"
    run = run_petves(tmp_path / "new", f"{options} -restart {whole.folder / at_step(whole.folder, N)}", ranks)
    ours, theirs = run.series, whole.series
    first = np.searchsorted(theirs["step"], N)
    assert ours["step"][0] == N
    for key in set(ours) - {"wall"}:
        scale = np.abs(theirs[key][np.isfinite(theirs[key])]).max(initial=1)
        np.testing.assert_allclose(ours[key], theirs[key][first:], rtol=0, atol=1e-10 * scale, err_msg=key)
    fields = frames(run.folder)
    assert fields["time"][0] == ours["time"][0]
    assert (np.diff(fields["time"]) > 0).all()


@pytest.mark.parametrize("name", ["order_2", "two_vesicles"])
def test_a_shorter_run_goes_on_to_another_end(name, straight, tmp_path):
    """From its end, a step at which the long run wrote no checkpoint: solvers that keep something from step to step find
    it again. The frame that was saved because the first part ended goes."""
    whole = straight(name)
    folder = tmp_path / "run"
    run_petves(folder, f"{SCHEMES[name]} -time_end 0.12", ranks=2)
    assert frames(folder)["time"][-1] == pytest.approx(0.12)
    run_petves(folder, f"{SCHEMES[name]} -time_end {0.02 * 2 * N} -restart {folder}/checkpoint.h5", ranks=2)
    assert without_wall(folder / "series.csv") == without_wall(whole.folder / "series.csv")
    np.testing.assert_array_equal(frames(folder)["time"], frames(whole.folder)["time"])


@pytest.mark.parametrize(
    "change",
    ["-domain_cells 64,64", "-vesicle_bending 0.02", "-scheme_order 2", "-fluid_viscosity 2", "-vesicle_angle 10"],
)
def test_another_scene_is_refused(change, straight, tmp_path):
    """The option, its value and the checkpoint's."""
    whole = straight("order_1")
    there = {"-domain_cells": "32,32", "-vesicle_bending": "0.01", "-scheme_order": "1", "-fluid_viscosity": "1"}
    run = run_petves(
        tmp_path / "new", f"{SCHEMES['order_1']} {change} -restart {whole.folder}/checkpoint.h5", good=False
    )
    one_line(run, change, f"has {there.get(change.split()[0], '0')};", "checkpoint.h5", "allowed: the same value")


def test_another_curve_is_refused(tmp_path):
    """The same options, but what the curve file holds has changed."""
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    curve = tmp_path / "curve.txt"
    options = f"-domain_cells 32,32 -vesicle_shape file -vesicle_file {curve} -time_step 0.02 -time_end 0.02"
    np.savetxt(curve, 0.4 * np.c_[np.cos(angle), np.sin(angle)])
    run_petves(tmp_path / "run", options)
    np.savetxt(curve, 0.41 * np.c_[np.cos(angle), np.sin(angle)])
    run = run_petves(tmp_path / "new", f"{options} -restart {tmp_path}/run/checkpoint.h5", good=False)
    one_line(run, "vesicle 1", "length", "allowed: the same vesicles")


def seal(path: Path):
    """Give a checkpoint that was edited its checksum back."""
    import zlib

    data = path.read_bytes()
    path.write_bytes(data + b"petves checkpoint, crc32 %08x\n" % zlib.crc32(data))


def test_another_format_is_refused(straight, tmp_path):
    """Both formats are named, with a good checksum or without one."""
    path = tmp_path / "checkpoint.h5"
    shutil.copy(straight("split").folder / "checkpoint.h5", path)
    with h5py.File(path, "r+") as file:
        file.attrs["format"] = np.int32(99)
    for _ in range(2):
        run = run_petves(tmp_path / "new", f"{SCHEMES['split']} -restart {path}", good=False)
        one_line(run, str(path), "format is 99", "allowed: 2")
        seal(path)


def test_missing_entries_are_refused(straight, tmp_path):
    path = tmp_path / "checkpoint.h5"
    shutil.copy(straight("split").folder / "checkpoint.h5", path)
    with h5py.File(path, "r+") as file:
        del file["fluid/u"]
    seal(path)
    one_line(run_petves(tmp_path / "new", f"{SCHEMES['split']} -restart {path}", good=False), "entries are missing")


def test_damaged_checkpoints_are_refused(straight, tmp_path):
    """Cut off at any length, or with any one bit flipped: one line, on every rank, and no file of the run is touched."""
    data = (straight("split").folder / "checkpoint.h5").read_bytes()
    path, draw = tmp_path / "checkpoint.h5", random.Random(6)
    damaged = [data[:n] for n in (0, 10, 100, len(data) // 2, len(data) - 34, len(data) - 1)] + [b"no hdf5 " * 100]
    for place in [0, len(data) - 3, len(data) - 30] + [draw.randrange(len(data)) for _ in range(6)]:
        damaged.append(data[:place] + bytes([data[place] ^ (1 << draw.randrange(8))]) + data[place + 1 :])
    for number, content in enumerate(damaged):
        path.write_bytes(content)
        run = run_petves(tmp_path / "new", f"{SCHEMES['split']} -restart {path}", 2 if number < 2 else 1, good=False)
        one_line(run, "-restart", str(path), "checksum", "checkpoint_1.h5")
        assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    "damage, needles",
    [
        ("no series", ["series.csv", "cannot be read"]),
        ("short series", ["series.csv", "ends before"]),
        ("other columns", ["series.csv", "other columns"]),
        ("no fields", ["run.h5", "0 readable frames"]),
        ("cut fields", ["run.h5", "readable frames"]),
    ],
)
def test_files_that_do_not_fit_are_refused(damage, needles, straight, tmp_path):
    """The restart stops with one line, and leaves the files as they are."""
    folder = tmp_path / "run"
    shutil.copytree(straight("split").folder, folder)
    series, fields = folder / "series.csv", folder / "run.h5"
    lines = series.read_text().splitlines(keepends=True)
    if damage == "no series":
        series.unlink()
    elif damage == "short series":
        series.write_text("".join(lines[:-3]) + lines[-3][:20])
    elif damage == "other columns":
        series.write_text("".join(["step,time\n"] + lines[1:]))
    elif damage == "no fields":
        fields.unlink()
    else:
        fields.write_bytes(fields.read_bytes()[:3000])
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "summary.json"}
    run = run_petves(folder, f"{SCHEMES['split']} -restart {folder}/checkpoint.h5", good=False)
    one_line(run, *needles, "new -output_dir")
    after = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "summary.json"}
    after.pop("series.csv.tmp", None)
    assert after == before


def test_results_are_not_overwritten_unasked(straight, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(straight("split").folder, folder)
    options = f"{SCHEMES['split']} -time_end 0.02"
    one_line(run_petves(folder, options, 2, good=False), f"-output_dir {folder}", "-output_overwrite", "-restart")
    other = straight("split").folder / "checkpoint.h5"
    one_line(
        run_petves(folder, f"{options} -restart {other}", good=False), f"-output_dir {folder}", "-output_overwrite"
    )
    assert without_wall(folder / "series.csv") == without_wall(straight("split").folder / "series.csv")
    run = run_petves(folder, f"{options} -output_overwrite")
    assert len(run.series["step"]) == 2
    assert not (folder / "checkpoint_1.h5").exists(), "of the run that was there before"


def start(folder: Path, options: str, ranks: int = 1, **streams) -> subprocess.Popen:
    """petves in the background."""
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += [PETVES, "-output_dir", str(folder), *PAPER.split(), *options.split()]
    return subprocess.Popen(command, env={**os.environ, **ENVIRONMENT}, text=True, **streams)


def wait_for_rows(folder: Path, rows: int):
    """Until the run has saved so many frames."""
    end = time.time() + 60
    while time.time() < end:
        if (folder / "run.xmf").exists() and (folder / "run.xmf").read_text().count("<Time") >= rows:
            return
        time.sleep(0.02)
    raise AssertionError("the run does not get on")


@pytest.mark.parametrize("ranks, name", [(1, "SIGTERM"), (2, "SIGUSR1")])
def test_signals_stop_the_run_after_a_step(ranks, name, tmp_path):
    """Status 0, checkpoint and summary of the last step; the restart ends as the run without a signal."""
    folder, options = tmp_path / "run", f"{BASE} -scheme_type split -output_every 0.02"
    process = start(folder, f"{options} -time_end 100", ranks, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    wait_for_rows(folder, 3)
    process.send_signal(getattr(signal, name))
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0 and name in out, out + err
    summary, last = json.loads((folder / "summary.json").read_text()), int(
        read_series(folder / "series.csv")["step"][-1]
    )
    assert summary["reason"] == "stopped" and summary["totals"]["steps"] == last
    with h5py.File(folder / "checkpoint.h5") as file:
        assert file.attrs["step"] == last
    end = f"-time_end {0.02 * (last + 3)}"
    run_petves(folder, f"{options} {end} -restart {folder}/checkpoint.h5", ranks)
    whole = run_petves(tmp_path / "whole", f"{options} {end}", ranks)
    assert without_wall(folder / "series.csv") == without_wall(whole.folder / "series.csv")


def test_wall_limit_stops_in_time(tmp_path):
    """With room for one more step and the checkpoint, and not at once."""
    begin = time.time()
    run = run_petves(tmp_path / "run", f"{BASE} -time_end 1000 -time_wall_limit 4", ranks=2)
    assert time.time() - begin < 8, "limit and start of mpirun on a busy machine"
    assert "-time_wall_limit" in run.stdout
    assert json.loads((run.folder / "summary.json").read_text())["reason"] == "stopped"
    assert len(run.series["step"]) > 2 and (run.folder / "checkpoint.h5").exists()


def wait_for_writing(process: subprocess.Popen, folder: Path):
    """Until this launch has written its first frame, or has ended."""
    begin = time.time_ns()
    file = folder / "run.xmf"
    while process.poll() is None and not (file.exists() and file.stat().st_mtime_ns > begin):
        time.sleep(0.002)


KILLED = f"{BASE} -domain_cells 24,24 -scheme_type split -output_every 0.02 -checkpoint_every 1"
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
    assert last > TRIALS, "there was time to write between the kills"
    assert without_wall(folder / "series.csv") == without_wall(whole.folder / "series.csv")
    ours, theirs = frames(folder), frames(whole.folder)
    for key in theirs:
        np.testing.assert_array_equal(ours[key], theirs[key], err_msg=key)


def break_tables(folder: Path) -> int:
    """Overwrite everything in the run.h5 of a killed run but the frames that its checkpoint counts; its last step."""
    with h5py.File(folder / "checkpoint.h5") as file:
        last, saved = int(file.attrs["step"]), int(file.attrs["frames"])
        bytes_of = [8 * file[name].size for name in ("fluid/p",) * 3 + ("vesicle/markers",) * 2 + ("vesicle/tension",)]
    kept = [
        (int(x), n)
        for row in (folder / "run.h5.index").read_text().splitlines()
        if int(row.split()[0]) < saved
        for x, n in zip(row.split()[2:], bytes_of)
    ]
    good = (folder / "run.h5").read_bytes()
    bad = bytearray(len(good))
    for place, size in kept:
        bad[place : place + size] = good[place : place + size]
    (folder / "run.h5").write_bytes(bad)
    return last


@pytest.mark.parametrize("ranks", [1, 2])
def test_killed_run_with_broken_tables(ranks, tmp_path):
    """Everything in run.h5 but its frames is overwritten: with the index of a killed run it is made anew."""
    folder = tmp_path / "run"
    with open(tmp_path / "errors", "w") as file:
        process = start(folder, f"{KILLED} -time_end 100", stdout=subprocess.DEVNULL, stderr=file)
        wait_for_rows(folder, 6)
        process.kill()
    assert process.wait() == -signal.SIGKILL, (tmp_path / "errors").read_text()
    last = break_tables(folder)
    end = f"-time_end {0.02 * (last + 5)}"
    run_petves(folder, f"{KILLED} {end} -restart {folder}/checkpoint.h5", ranks)
    whole = run_petves(tmp_path / "whole", f"{KILLED} {end}")
    assert not (folder / "run.h5.index").exists(), "of a run that was killed only"
    ours, theirs = frames(folder), frames(whole.folder)
    for key in theirs:
        np.testing.assert_allclose(ours[key], theirs[key], rtol=0, atol=0 if ranks == 1 else 1e-9, err_msg=key)


@pytest.mark.skipif(SANITIZE, reason="Python is not built with the sanitizers")
def test_broken_tables_after_an_end_that_was_not_the_end(tmp_path):
    """From Python a run goes on after its end: the frame of that end, at no saved time, is written over. Then it is
    killed."""
    options = f"{PAPER} {BASE} -scheme_type split -domain_cells 24,24 -output_every 0.04 -checkpoint_every 1".split()
    words = dict(zip(options[::2], options[1::2])) | {"-time_end": "0.06", "-output_dir": str(tmp_path / "run")}
    call = ", ".join(f"{name[1:]}={value!r}" for name, value in words.items())
    (tmp_path / "script.py").write_text(
        f"import os, petves\nsim = petves.Simulation({call})\nsim.run()\nsim.run(until=0.22)\nos.kill(os.getpid(), 9)\n"
    )
    library = str(Path(PETVES).parent.parent / "lib" / "libpetves.so")
    python = {"PETVES_LIBRARY": library, "PYTHONPATH": str(ROOT / "python")}
    done = mpirun(["/usr/bin/python3", str(tmp_path / "script.py")], 1, **python)
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert break_tables(tmp_path / "run") == 11
    run_plainly = f"{BASE} -scheme_type split -domain_cells 24,24 -output_every 0.04 -time_end 0.4"
    run_petves(tmp_path / "run", f"{run_plainly} -checkpoint_every 1 -restart {tmp_path}/run/checkpoint.h5")
    whole = run_petves(tmp_path / "whole", run_plainly)
    ours, theirs = frames(tmp_path / "run"), frames(whole.folder)
    for key in theirs:
        np.testing.assert_array_equal(ours[key], theirs[key], err_msg=key)


@pytest.fixture
def small_disk(tmp_path):
    """A function that mounts a small tmpfs; needs the right to mount."""
    place = tmp_path / "disk"
    place.mkdir()
    mounted = []

    def mount(kib: int) -> Path:
        done = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={kib}k", "tmpfs", str(place)], capture_output=True, text=True
        )
        if done.returncode:
            pytest.skip(f"mount is not permitted here: {done.stderr.strip()}")
        mounted.append(place)
        return place

    yield mount
    for path in mounted:
        subprocess.run(["umount", str(path)], check=True)


@pytest.mark.parametrize("kib, ranks", [(8, 1), (60, 1), (120, 2), (240, 1), (300, 2), (420, 1)])
def test_full_disk(kib, ranks, small_disk, tmp_path):
    """One line; a checkpoint that is there is good, and no half one has its name."""
    folder = small_disk(kib) / "run"
    run = run_petves(
        folder, f"{BASE} -scheme_type split -time_end 9 -output_every 0.02 -checkpoint_every 2", ranks, False
    )
    one_line(run, str(folder), "cannot be written", "allowed")
    for path in folder.glob("checkpoint*"):
        with h5py.File(path) as file:
            step = file.attrs["step"]
        again = run_petves(
            tmp_path / path.stem, f"{BASE} -scheme_type split -restart {path} -time_end {0.02 * (step + 1)}"
        )
        assert again.series["step"][0] == step and len(again.series["step"]) == 2
    assert kib < 240 or (folder / "checkpoint.h5").exists()


def test_vanished_folder(tmp_path):
    """The folder is removed while the run goes on: one line at the next file."""
    folder = tmp_path / "run"
    process = start(folder, f"{KILLED} -time_end 100", stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wait_for_rows(folder, 3)
    folder.rename(tmp_path / "elsewhere")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1 and err.count("\n") == 1 and "cannot be written" in err, err


def test_same_bits_twice(tmp_path):
    """The same options, ranks and binary: the same series.csv but for wall, the same run.h5 and checkpoint."""
    for name in ("order_2", "two_vesicles"):
        runs = [run_petves(tmp_path / f"{name}{k}", f"{SCHEMES[name]} -time_end 0.1", ranks=2) for k in range(2)]
        assert without_wall(runs[0].folder / "series.csv") == without_wall(runs[1].folder / "series.csv")
        one, two = (frames(run.folder) for run in runs)
        for key in one:
            np.testing.assert_array_equal(one[key], two[key], err_msg=key)
