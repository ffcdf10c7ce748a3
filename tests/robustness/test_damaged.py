"""Folders of runs that go on, were killed, are damaged or come from somebody else: what is whole is read, the rest is one line."""

import os
import signal
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from harness import ENVIRONMENT, PETVES, read_series, run_petves, start, wait_for
from test_forged import attribute, dataset, external_link, external_storage, soft_link, virtual

import petves
from petves.errors import Error, RunError
from petves.files import writing
from petves.sweeps import sweep

pytestmark = pytest.mark.xdist_group("damaged")  # its tests share a run

SCENE = "-domain_cells 16,16 -vesicle_semi_axes 0.4,0.5 -flow_type shear -domain_bc_x periodic"
SCENE += " -time_step 0.01 -time_end"


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    return run_petves(tmp_path_factory.mktemp("damaged") / "run", f"{SCENE} 0.05 -output_every 0.02").folder


@pytest.fixture
def folder(whole, tmp_path) -> Path:
    """A copy, to be damaged."""
    subprocess.run(["cp", "-r", whole, tmp_path / "run"], check=True)
    return tmp_path / "run"


def tool(*words: object, **places: object) -> subprocess.CompletedProcess:
    """Run a tool of the program, as users do."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | ENVIRONMENT
    words = [PETVES, *map(os.fspath, words)]
    return subprocess.run(words, env=environment, capture_output=True, errors="replace", timeout=120, **places)


def test_cut_row_is_left_out(folder):
    """A file that ends anywhere in its last row, or in the line end, has the rows before it, and no wrong number."""
    path = folder / "series.csv"
    text, series = path.read_text(), read_series(path)
    for end in range(text.rstrip("\n").rfind("\n") + 1, len(text), 7):
        path.write_text(text[:end])
        found = petves.load(folder, "numpy").series
        for name, values in series.items():
            np.testing.assert_array_equal(found[name], values[:-1], err_msg=name)
    path.write_text(text.replace("\n3,", "\n3,0,", 1))
    with pytest.raises(RunError, match="series.csv: cannot be read"):
        petves.load(folder, "numpy")


def test_run_that_goes_on_and_is_killed(tmp_path):
    """What is loaded meanwhile, and after the kill, are rows and frames of the whole run; each row is there at once."""
    folder, found, sizes = tmp_path / "run", [], set()
    process = start(folder, f"{SCENE} 100 -output_every 0.2 -checkpoint_every 0", stdout=subprocess.DEVNULL)
    wait_for((folder / "run.xmf").exists)
    while len(found) < 60:
        found.append(petves.load(folder, "numpy"))
        text = (folder / "series.csv").read_text()
        if not text.endswith("\n"):  # the kernel writes a row that crosses a page of the file in two parts
            text = (folder / "series.csv").read_text()
        sizes.add(len(text))
        assert text.endswith("\n"), "no part of a row stays"
    process.kill()
    assert process.wait() == -signal.SIGKILL and len(sizes) > 5
    last = petves.load(folder, "numpy")
    for run in found:
        for name, values in run.series.items():
            np.testing.assert_array_equal(values, last.series[name][: len(values)], err_msg=name)
        np.testing.assert_array_equal(run.markers, last.markers[: len(run.time)])
    assert len(last.series["step"]) > 20 * (len(last.time) - 1)


def fields(change):
    """A change of run.h5, as test_forged.py makes them of checkpoints."""

    def changed(folder: Path) -> None:
        with h5py.File(folder / "run.h5", "r+") as file:
            change(file, folder)

    return changed


def put(name: str, value: object):
    return fields(lambda file, _: (file.__delitem__(name), file.__setitem__(name, value)))


def text(name: str, content: bytes):
    return lambda folder: (folder / name).write_bytes(content)


DAMAGES = {
    "summary.json empty": text("summary.json", b""),
    "summary.json of a list": text("summary.json", b"[1, 2]"),
    "summary.json too deep": text("summary.json", b"[" * 100000),
    "series.csv without rows": text("series.csv", b"step,time\n"),
    "series.csv of something else": text("series.csv", b"a,b\n1,2\n"),
    "series.csv in another coding": text("series.csv", b"\xff\xfe\n1,2\n"),
    "run.h5 empty": text("run.h5", b""),
    "run.h5 cut": lambda folder: os.truncate(folder / "run.h5", 20000),
    "run.h5 without a frame": put("time", np.zeros(0)),
    "run.h5 with times of words": put("time", [b"a", b"b"]),
    "run.h5 with times that fall": put("time", [0.0, 2.0, 1.0]),
    "run.h5 with a scalar": put("vesicle/markers", 1.0),
    "run.h5 with fields as a number": put("fluid", 1.0),
    "run.h5 with nan markers": lambda folder: put("vesicle/markers", np.nan * Run(folder).markers)(folder),
    "run.h5 with other cells": fields(attribute("h", 0.3)),
    "run.h5 without a size": fields(attribute("h", 0.0)),
    "run.h5 with a short box": fields(attribute("box", [0.0, 1.0])),
    "run.h5 with other vesicles": fields(attribute("vesicle_start", [0, 10**9])),
    "run.h5 with a link out": fields(dataset("fluid/u", external_link)),
    "run.h5 with a link in": fields(dataset("fluid/u", soft_link)),
    "run.h5 with storage outside": fields(dataset("fluid/u", external_storage)),
    "run.h5 with virtual values": fields(dataset("fluid/u", virtual)),
}


def Run(folder: Path):
    return petves.load(folder, "numpy")


@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_is_one_line(damage, folder):
    DAMAGES[damage](folder)
    for kind in ("numpy", "auto"):
        with pytest.raises(RunError, match=f"{folder / damage.split()[0]}: ") as caught:
            petves.load(folder, kind)
        assert "\n" not in str(caught.value)


def test_report_needs_the_options(folder):
    (folder / "resolved.opts").unlink()
    done = tool("report", folder)
    assert done.returncode == 1 and done.stderr == f"petves: error: {folder / 'resolved.opts'}: no such file\n"


def test_name_of_bytes(whole, tmp_path):
    """A folder's name that is not UTF-8 is drawn, reported, compared, and printed as it is."""
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/l\xe4ufe")
    done = tool(*SCENE.split(), "0.02", "-output_dir", folder)
    assert done.returncode == 0, done.stderr
    for words in (("plot", folder, "--column", "area"), ("report", folder), ("compare", folder, whole)):
        done = tool(*words, cwd=tmp_path)
        assert done.returncode == 0 and not done.stderr, done.stderr
    assert (Path(folder) / "report.html").is_file()


def test_no_module_of_the_current_folder(folder, tmp_path):
    """Whoever stands in a folder of somebody else runs nothing from there."""
    for name in ("h5py.py", "petves/__init__.py", "petves/__main__.py", "argparse.py"):
        path = tmp_path / "here" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("import sys\nsys.exit('taken')\n")
    for python_path in ({}, {"PYTHONPATH": ""}):
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        how = dict(env=environment | python_path, cwd=tmp_path / "here", capture_output=True, text=True)
        done = subprocess.run([PETVES, "plot", folder, "--column", "no"], **how)
        assert "column no: not one of this run" in done.stderr, done.stderr


def test_links_are_not_followed(folder, tmp_path):
    """A picture, a page and a film at whose name a link lies are refused, and the link's file stays."""
    mine = tmp_path / "mine"
    mine.write_text("mine")
    for draw, name in (petves.plot, "energy.png"), (petves.report, "report.html"), (petves.movie, "movie.mp4"):
        (folder / name).symlink_to(mine)
        with pytest.raises(RunError, match=rf"{name}: cannot be written \(it is a link"):
            draw(folder)
        assert mine.read_text() == "mine"
    with pytest.raises(RunError), writing(folder / "new"):
        raise OSError("no space")
    left = [path for path in folder.iterdir() if path.name.startswith((".petves", "new"))]
    assert not left, "and nothing is left over"


@pytest.mark.parametrize("name", ["OUTPUT_DIR", "python", "-start_in_debugger", "dll_append", "History", "log_view"])
def test_sweep_takes_no_option_that_runs_programs(name, tmp_path):
    with pytest.raises(Error, match="cannot vary"):
        sweep(tmp_path / "grid", {name: ["touch x"]})
    assert not (tmp_path / "grid").exists()
