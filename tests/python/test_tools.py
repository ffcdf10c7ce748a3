"""python3 -m petves plot, movie, compare, sweep, report; petves.load; run.xmf in VTK."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from harness import SITE, read_series, run_petves, run_tool

import petves
from petves.program import scene_file
from petves.run import Run
from petves.views.report import report

pytestmark = pytest.mark.xdist_group("tools")  # its tests share runs

OPTIONS = "-domain_cells 32,48 -domain_box -1,1,-1,2 -flow_type shear -vesicle_semi_axes 0.3,0.5"
OPTIONS += " -time_step 0.01 -time_end 0.04 -output_every 0.02"
CHROMIUM = shutil.which("chromium-headless-shell") or shutil.which("chromium")


def tool(*words, good=True, folder=None):
    """Run python3 -m petves; return its lines, of standard error when it must fail with one of them."""
    done = run_tool(*words, folder=folder)
    assert done.returncode == (0 if good else 1), done.stdout + done.stderr
    assert good or (len(done.stderr.splitlines()) == 1 and done.stderr.startswith("petves: error: "))
    return (done.stdout if good else done.stderr).splitlines()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return run_petves(tmp_path_factory.mktemp("tools") / "one", OPTIONS).folder


@pytest.fixture(scope="module")
def other(tmp_path_factory):
    return run_petves(tmp_path_factory.mktemp("tools") / "other", OPTIONS + " -fluid_viscosity 2").folder


def test_mistyped_commands_and_scenes():
    own = "no option, file, scene or command"
    assert tool("polt", "out", good=False) == [f'petves: error: "polt": {own}; petves plot is meant?']
    assert tool("shaer", good=False) == [f'petves: error: "shaer": {own}; petves shear is meant?']
    line = f'petves: error: "my.opts": {own}; allowed: -name value, or what petves help lists'
    assert tool("my.opts", good=False) == [line]


def test_a_folder_hides_no_scene(here):
    """Of the same name; a file does."""
    (here / "shear").mkdir()
    (here / "relax").touch()
    assert scene_file("shear").endswith("runs/shear.opts") and scene_file("relax") == "relax"


def test_load_has_the_files_and_units(folder):
    data, run, series = petves.load(folder, "xarray"), petves.load(folder, "numpy"), read_series(folder / "series.csv")
    assert isinstance(run, Run) and data.attrs["reason"] == "finished"
    for name in set(series) - {"step", "time"}:
        np.testing.assert_array_equal(data[name], series[name])
        assert data[name].attrs["units"], name
    np.testing.assert_array_equal(data["step_time"], series["time"])
    with h5py.File(folder / "run.h5") as file:
        for name in "uvp":
            np.testing.assert_array_equal(data[name], file["fluid"][name])
        for name in ("markers", "velocity", "tension"):
            np.testing.assert_array_equal(data[name], file["vesicle"][name])
    assert data["p"].attrs["units"] == "length^2/time^2" and data["u"].dims == ("time", "y", "x")
    shear = data["u"].isel(time=0) - data["y"]  # at rest, but for the background
    assert float(abs(shear).max()) < 1e-14, "the coordinates are the cells' centres"
    with pytest.raises(petves.Error, match="no such folder"):
        petves.load(folder / "nothing")


@pytest.mark.parametrize(
    "suffix, first, chosen, count",
    [(".mp4", b"ftyp", (), 3), (".gif", b"GIF89a", ("--every", 2, "--from", 0.01, "--to", 0.04), 1)],
)
def test_movie_has_a_picture_a_saved_time(suffix, first, chosen, count, folder, tmp_path):
    path = tmp_path / f"film{suffix}"
    assert tool("movie", folder, "--output", path, "--field", "pressure", *chosen) == [str(path)]
    assert first in path.read_bytes()[:12]
    shown = "stream=nb_read_frames"
    words = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", shown, "-of", "csv=p=0", str(path)]
    frames = subprocess.run(words, capture_output=True, text=True).stdout
    assert int(frames.strip().strip(",")) == count and len(Run.read(folder).time) == 3


def test_movie_without_ffmpeg_is_a_gif(folder, tmp_path, monkeypatch):
    from petves.views import movie

    monkeypatch.setattr(movie.shutil, "which", lambda name: None)
    assert movie.movie(folder).name == "movie.gif"
    with pytest.raises(petves.Error, match="ffmpeg is not installed"):
        movie.movie(folder, tmp_path / "film.mp4")
    with pytest.raises(petves.Error, match="allowed: a name that ends in .mp4 or .gif"):
        movie.movie(folder, tmp_path / "film.avi")
    with pytest.raises(petves.Error, match="no saved time; allowed: times in 0 to 0.04"):
        movie.movie(folder, begin=1)
    with pytest.raises(petves.Error, match="every 0: out of range"):
        movie.movie(folder, every=0)


def test_compare_says_what_differs(folder, other, tmp_path):
    lines = tool("compare", folder, other, "--output", tmp_path / "two.png")
    assert f"| -fluid_viscosity | 1 | 2 |" in lines and not any("-flow_type" in line for line in lines)
    a, b = Run.read(folder), Run.read(other)
    row = next(line for line in lines if line.startswith("| inclination"))
    largest = np.abs(a.series["inclination"] - b.series["inclination"]).max()
    assert float(row.split("|")[4]) == pytest.approx(largest, rel=1e-3)
    gap = np.linalg.norm(a.markers - b.markers, axis=2).max()
    assert f"Markers: {gap:.3e} apart at most" in "\n".join(lines)
    assert (tmp_path / "two.png").read_bytes()[:4] == b"\x89PNG"
    assert "The options are the same." in petves.compare(folder, folder, tmp_path / "one.png")[0]
    with pytest.raises(petves.Error, match="no such folder"):
        petves.compare(folder, tmp_path / "none")


def test_report_is_whole_and_offline(folder, tmp_path):
    (path,) = map(Path, tool("report", folder, "--output", tmp_path / "page.html"))
    page = path.read_text()
    assert not re.search(r"(src|href)=\"(?!data:)", page) and "http" not in page and "__" not in page
    run = Run.read(folder)
    data = json.loads(re.search(r'type="application/json">(.*?)</script>', page, re.S).group(1))
    named = tmp_path / "__DATA____PLOTS__"  # as the page's own places are
    shutil.copytree(folder, named)
    report(named)
    assert (named / "report.html").read_text() == page.replace(f"petves: {folder.name}", f"petves: {named.name}")
    np.testing.assert_allclose(data["markers"], run.markers, atol=1e-5)
    np.testing.assert_allclose(data["time"], run.time)
    assert "shear flow of rate 1" in page and "reduced area 0." in page and f"{run.start[1]} markers" in page


@pytest.fixture(scope="module")
def left(tmp_path_factory):
    """A vesicle that starts two periods away from the box."""
    beyond = " -domain_bc_x periodic -vesicle_center 4.3,0.5"
    return run_petves(tmp_path_factory.mktemp("tools") / "left", OPTIONS + beyond).folder


@pytest.mark.parametrize("name, frame, periods", [("folder", 2, 0), ("left", 0, 2)])
def test_report_draws_the_membrane_in_a_browser(name, frame, periods, request, tmp_path):
    """The page runs without a script error, and the membrane's pixels lie where the markers are, less whole periods."""
    from matplotlib.image import imread

    assert CHROMIUM, "no headless Chromium"
    folder = request.getfixturevalue(name)
    tool("report", folder, "--output", tmp_path / "page.html")
    shot = tmp_path / "shot.png"
    words = "--no-sandbox --headless --hide-scrollbars --window-size=1200,1000 --enable-logging=stderr".split()
    words += ["--virtual-time-budget=2000", f"--screenshot={shot}", f"file://{tmp_path}/page.html#frame={frame}"]
    done = subprocess.run([CHROMIUM, *words], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and shot.is_file(), done.stderr
    assert "CONSOLE" not in done.stderr, done.stderr
    red, green, blue = imread(shot)[..., :3].transpose(2, 0, 1)
    dot = np.argwhere((red > 0.75) & (green < 0.1) & (blue < 0.1)).mean(axis=0)  # marker 0, (row, column)
    line = (red < 0.3) & (green < 0.3) & (blue < 0.3) & (abs(red - blue) < 0.04)
    line[:, 700:] = False  # the table
    left, right = np.sort(np.argsort(line.sum(axis=0))[-2:])  # the frame's sides, the longest dark lines
    bottom = np.argmax(line[:, left:right].sum(axis=1))
    run = Run.read(folder)
    scale = (right - left) / (run.box[1] - run.box[0])
    drawn = run.box[0] + (dot[1] - left) / scale, run.box[2] + (bottom - dot[0]) / scale
    np.testing.assert_allclose(drawn, run.markers[frame, 0] - (2 * periods, 0), atol=2 / scale)  # pixels


def test_run_xmf_opens_in_vtk(folder):
    """Fields and membrane at the right places and times, read with VTK's own reader."""
    if not (SITE / "vtkmodules").is_dir():
        pytest.skip("vtk could not be installed from PyPI")
    script = """
import sys, json
sys.path.insert(0, sys.argv[1])
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.util.numpy_support import vtk_to_numpy
reader = vtkXdmfReader()
reader.SetFileName(sys.argv[2])
reader.UpdateInformation()
keys = reader.GetOutputInformation(0)
times = [keys.Get(Pipeline.TIME_STEPS(), k) for k in range(keys.Length(Pipeline.TIME_STEPS()))]
frames = []
for time in times:
    reader.UpdateTimeStep(time)
    blocks = reader.GetOutputDataObject(0)
    fluid, vesicle = (blocks.GetBlock(k) for k in range(2))
    values = {name: vtk_to_numpy(fluid.GetPointData().GetArray(name)).tolist() for name in ("pressure", "velocity")}
    cell = vesicle.GetCell(0)
    frames.append(dict(values, origin=fluid.GetOrigin(), spacing=fluid.GetSpacing(), size=fluid.GetDimensions(),
        points=vtk_to_numpy(vesicle.GetPoints().GetData()).tolist(),
        tension=vtk_to_numpy(vesicle.GetPointData().GetArray("tension")).tolist(),
        line=[cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]))
json.dump(dict(times=times, frames=frames), sys.stdout)
"""
    words = [sys.executable, "-c", script, str(SITE), str(folder / "run.xmf")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and not done.stderr, done.stderr
    seen, run = json.loads(done.stdout), Run.read(folder)
    np.testing.assert_array_equal(seen["times"], run.time)
    x, y = run.cell_centers()
    M = run.start[-1]
    for k, frame in enumerate(seen["frames"]):
        u, v, p = run.fields(k)
        assert frame["size"] == [len(x), len(y), 1]
        np.testing.assert_allclose(frame["origin"], [x[0], y[0], 0], atol=1e-14)
        np.testing.assert_allclose(frame["spacing"][:2], run.h)
        np.testing.assert_array_equal(np.reshape(frame["pressure"], p.shape), p)
        velocity = np.reshape(frame["velocity"], (*u.shape, 3))
        np.testing.assert_array_equal(velocity, np.stack([u, v, 0 * u], axis=-1))
        np.testing.assert_array_equal(np.array(frame["points"])[:, :2], run.markers[k])
        np.testing.assert_array_equal(frame["tension"], run.tension[k])
        assert frame["line"] == [*range(M), 0], "the line closes"
