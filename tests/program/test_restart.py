"""A restarted run is the run that was not interrupted: the same bits on the same ranks, 1e-10 on others; and what is
not the run's own is refused."""

import json
import random
import shutil

import h5py
import numpy as np
import pytest
from harness import run_petves
from refusals import refused, seal
from restarts import SCHEMES, N, at_step, frames, same_frames, without_wall

pytestmark = pytest.mark.xdist_group("restart")  # its tests share runs


RANKS = dict.fromkeys(SCHEMES, 1) | dict.fromkeys(("split", "order_2", "adaptive", "two_vesicles"), 2)


@pytest.fixture(scope="module")
def straight(cached_run):
    """A run of 2 N steps that keeps all its checkpoints, a scheme."""
    ends = f"-time_end {0.02 * 2 * N} -checkpoint_every {N} -checkpoint_keep 9"
    return lambda name: cached_run(f"{SCHEMES[name]} {ends}", RANKS[name])


@pytest.mark.parametrize("name", SCHEMES)
def test_restart_gives_the_same_bits(name, straight, tmp_path):
    """From the checkpoint of step N in the folder of the run, which went on past it: series.csv and run.h5 are those of
    the run that was never interrupted."""
    whole = straight(name)
    folder = tmp_path / "run"
    shutil.copytree(whole.folder, folder)
    options = f"{SCHEMES[name]} -time_end {0.02 * 2 * N} -checkpoint_every {N} -checkpoint_keep 9"
    run = run_petves(folder, f"{options} -restart {folder / at_step(folder, N)}", RANKS[name])
    assert len(without_wall(folder)) > N + 2
    assert without_wall(folder) == without_wall(whole.folder)
    same_frames(folder, whole.folder)
    assert len(frames(folder)) == 12
    totals = [json.loads((f / "summary.json").read_text())["totals"] for f in (folder, whole.folder)]
    assert totals[0] == totals[1]
    assert "closer than" not in run.stdout


OTHER_RANKS = [("split", 4), ("penalty", 2), ("order_1", 3), ("order_2", 4), ("adaptive", 1), ("two_vesicles", 3)]


@pytest.mark.parametrize("name, ranks", OTHER_RANKS)
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
    """The same options give the same bits twice. It goes on from its end, a step at which the long run wrote no checkpoint:
    solvers that keep something from step to step find it again. The frame saved at the end of the first part goes."""
    whole = straight(name)
    folder = tmp_path / "run"
    run_petves(folder, f"{SCHEMES[name]} -time_end 0.12", ranks=2)
    assert frames(folder)["time"][-1] == pytest.approx(0.12)
    run_petves(folder, f"{SCHEMES[name]} -time_end {0.02 * 2 * N} -restart {folder}/checkpoint.h5", ranks=2)
    assert without_wall(folder) == without_wall(whole.folder)
    same_frames(folder, whole.folder)


#: What is given, and the value of the checkpoint.
OTHER = {"-domain_cells 64,64": "32,32", "-vesicle_bending 0.02": "0.01", "-scheme_order 2": "1"}
OTHER |= {"-fluid_viscosity 2": "1", "-vesicle_angle 10": "0"}


@pytest.mark.parametrize("change, there", OTHER.items())
def test_another_scene_is_refused(change, there, straight, tmp_path):
    options = f"{SCHEMES['order_1']} {change} -restart {straight('order_1').folder}/checkpoint.h5"
    refused(tmp_path / "new", options, change, f"has {there};", "checkpoint.h5", "allowed: the same value")


def outline(a, b, note="", n=60):
    """Text of a curve file: an ellipse about (-0.4, 0)."""
    angle = 2 * np.pi * np.arange(n) / n
    return note + "".join(f"{x - 0.4:.15g} {y:.15g}\n" for x, y in np.c_[a * np.cos(angle), b * np.sin(angle)])


@pytest.mark.parametrize(
    "solid, began, then",
    [
        (False, outline(0.3, 0.3), outline(0.31, 0.31)),
        (False, outline(0.2, 0.35), outline(0.2801379, 0.2801379)),
        (True, outline(0.3, 0.3), outline(0.31, 0.31)),
        (True, outline(0.2, 0.3, "# rotation 1\n"), outline(0.2, 0.3, "# rotation 5\n")),
        (True, outline(0.2, 0.3, "# rotation 1\n"), outline(0.2, 0.3, "# rotation 1\n# velocity 3 0\n")),
    ],
    ids=["size", "area of one length", "solid size", "rotation", "velocity"],
)
def test_another_curve_is_refused(solid, began, then, tmp_path):
    """The same options, but what the curve file holds has changed. What it holds may be elsewhere, with other comments."""
    curve, moved = tmp_path / "curve.txt", tmp_path / "moved.txt"
    kind = "obstacle" if solid else "vesicle"
    options = "-domain_cells 32,32 -time_step 0.02 -time_end 0 -fluid_inertia none "
    options += "-domain_bc_x periodic -domain_bc_y periodic -vesicle_semi_axes 0.2,0.3 " * solid
    options += "-vesicle_center 0.5,0 " * solid + f"-{kind}_shape file -{kind}_file "
    curve.write_text(began)
    run_petves(tmp_path / "run", options + str(curve))
    restart = f" -time_end 0.02 -restart {tmp_path}/run/checkpoint.h5"
    curve.write_text(then)
    refused(tmp_path / "new", f"{options}{curve}{restart}", f"-{kind}_file {curve}: its curves", ranks=2)
    moved.write_text("# a circle\n" + began)
    run_petves(tmp_path / "new", f"{options}{moved}{restart}")


def test_the_end_of_a_long_list_is_compared(tmp_path):
    """4200 characters: the message begins with the entry that differs."""
    places = [f"{x:.16f},{y:.16f}" for x in np.linspace(0.15, 7.85, 15) for y in np.linspace(0.15, 3.85, 8)]
    scene = "-domain_box 0,8,0,4 -domain_cells 256,128 -domain_bc_x periodic -domain_bc_y periodic -flow_type uniform -vesicle_shape none"
    scene += " -time_end 0 -obstacle_shape posts -obstacle_radius 0.1 -obstacle_center "
    run_petves(tmp_path / "run", scene + ",".join(places))
    places[-1] = "7.85,3.75"
    scene += f"{','.join(places)} -restart {tmp_path}/run/checkpoint.h5"
    needles = "-obstacle_center ...,3.75:", "has ...,3.85", "allowed: the same value"
    refused(tmp_path / "new", scene, *needles, ranks=2)


def test_another_format_is_refused(straight, tmp_path):
    """Both formats are named, with a good checksum or without one."""
    path = tmp_path / "checkpoint.h5"
    shutil.copy(straight("split").folder / "checkpoint.h5", path)
    with h5py.File(path, "r+") as file:
        file.attrs["format"] = np.int32(99)
    for _ in range(2):
        refused(tmp_path / "new", f"{SCHEMES['split']} -restart {path}", str(path), "format is 99", "allowed: 9")
        seal(path)


def test_damaged_checkpoints_are_refused(straight, tmp_path):
    """Cut off at any length, or with any one bit flipped: one line, on every rank, and no file of the run is touched."""
    data = (straight("split").folder / "checkpoint.h5").read_bytes()
    path, draw = tmp_path / "checkpoint.h5", random.Random(6)
    damaged = [data[:n] for n in (0, 10, 100, len(data) // 2, len(data) - 34, len(data) - 1)] + [b"no hdf5 " * 100]
    for place in [0, len(data) - 3, len(data) - 30] + [draw.randrange(len(data)) for _ in range(6)]:
        damaged.append(data[:place] + bytes([data[place] ^ (1 << draw.randrange(8))]) + data[place + 1 :])
    for number, content in enumerate(damaged):
        path.write_bytes(content)
        needles = "-restart", str(path), "checksum", "checkpoint_1.h5"
        refused(tmp_path / "new", f"{SCHEMES['split']} -restart {path}", *needles, ranks=2 if number < 2 else 1)
        assert not (tmp_path / "new").exists()


#: A file, what is said of it, and what it is made.
UNFIT = [
    ("series.csv", "cannot be read", None),
    ("series.csv", "ends before", lambda data: data[: data.rindex(b"\n", 0, -200) + 20]),
    ("series.csv", "other columns", lambda data: b"step,time\n" + data.partition(b"\n")[2]),
    ("run.h5", "0 readable frames", None),
    ("run.h5", "readable frames", lambda data: data[:3000]),
]


@pytest.mark.parametrize("file, needle, change", UNFIT)
def test_files_that_do_not_fit_are_refused(file, needle, change, straight, tmp_path):
    """The restart stops with one line, and leaves the files as they are."""
    folder = tmp_path / "run"
    shutil.copytree(straight("split").folder, folder)
    data = (folder / file).read_bytes()
    (folder / file).unlink()
    if change:
        (folder / file).write_bytes(change(data))
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "summary.json"}
    refused(folder, f"{SCHEMES['split']} -restart {folder}/checkpoint.h5", file, needle, "new -output_dir")
    after = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "summary.json"}
    after.pop("series.csv.tmp", None)
    assert after == before


def test_results_are_not_overwritten_unasked(straight, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(straight("split").folder, folder)
    options = f"{SCHEMES['split']} -time_end 0.02"
    refused(folder, options, f"-output_dir {folder}", "-output_overwrite", "-restart", ranks=2)
    other = straight("split").folder / "checkpoint.h5"
    refused(folder, f"{options} -restart {other}", f"-output_dir {folder}", "-output_overwrite")
    assert without_wall(folder) == without_wall(straight("split").folder)
    run = run_petves(folder, f"{options} -output_overwrite")
    assert len(run.series["step"]) == 2
    assert not (folder / "checkpoint_1.h5").exists(), "of the run that was there before"
