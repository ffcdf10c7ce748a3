"""Every output file of a run is there, and they agree with one another. resolved.opts repeats the run, whatever its folder and its
files are called. How much a run writes: frames by default, their precision."""

import xml.etree.ElementTree as ET
from pathlib import Path

import h5py
import numpy as np
import pytest
from harness import COLUMNS, PAPER, PETVES, mpirun, run_petves
from refusals import refused
from restarts import frames, same_columns, without_wall

pytestmark = pytest.mark.xdist_group("output")  # its tests share runs

#: The paper's scheme, whose areas are polygons' and whose frames have the checkpoint's pressure next to the membrane too.
#: Saved times fall on steps 0, 5, 10 and, as the end state, 12. A channel: u has as many columns as cells, v one row less.
OPTIONS = (
    f"{PAPER} -domain_box 0,2,-1,1 -domain_cells 40,40 -domain_bc_x periodic -flow_type shear -flow_rate 0.5 -fluid_viscosity 0.7 "
    "-vesicle_center 1.9,0.1 -vesicle_semi_axes 0.4,0.25 -time_step 0.02 -time_end 0.24 -output_every 0.1 "
    "-vesicle_bending 0.02 -checkpoint_every 5 -tension_ksp_rtol 1e-10 -tension_ksp_monitor_short"
)
FRAMES, STEPS = 4, 12


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return run_petves(tmp_path_factory.mktemp("files") / "made" / "here", OPTIONS, ranks=2)


def attributes(file) -> dict:
    return {name: value for name, value in file.attrs.items()}


def polygon_area(points: np.ndarray) -> float:
    x, y = points.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_folder_holds_every_file(run):
    names = {path.name for path in run.folder.iterdir()}
    files = "series.csv run.h5 run.xmf checkpoint.h5 checkpoint_1.h5 resolved.opts summary.json"
    assert names == set(files.split())
    for text in ("100 %", f"step {STEPS}", f"finished at time 0.24 after {STEPS} steps", "files in"):
        assert text in run.stdout


def test_series_has_its_columns(run):
    text = (run.folder / "series.csv").read_text().splitlines()
    assert text[0].split(",") == COLUMNS
    assert len(text) == STEPS + 2
    assert all(len(line.split(",")) == len(COLUMNS) for line in text)
    series = run.series
    np.testing.assert_array_equal(series["step"], np.arange(STEPS + 1))
    np.testing.assert_allclose(series["time"], 0.02 * np.arange(STEPS + 1), rtol=1e-13)
    assert (series["dt"] == 0.02).all() and (series["coupled_its"] == 0).all()
    assert series["area_error"][0] == 0 and series["length_error"][0] == 0
    np.testing.assert_allclose(series["area_error"], series["area"] / series["area"][0] - 1, atol=1e-14)
    np.testing.assert_allclose(series["length_error"], series["length"] / series["length"][0] - 1, atol=1e-14)
    assert series["wall"][0] == 0 and (series["wall"][1:] > 0).all()


def test_run_h5_has_its_shapes_and_attributes(run):
    markers = run.summary["markers"]
    with h5py.File(run.folder / "run.h5") as file:
        shapes = {name: file[name].shape for name in ("time", "fluid/u", "fluid/v", "fluid/p")}
        assert shapes == {"time": (FRAMES,)} | {f"fluid/{c}": (FRAMES, 40, 40) for c in "uvp"}
        np.testing.assert_allclose(file["fluid/x"], 0.05 * (np.arange(40) + 0.5), rtol=1e-15)
        np.testing.assert_allclose(file["fluid/y"], 0.05 * (np.arange(40) + 0.5) - 1, rtol=1e-14, atol=1e-16)
        assert (file["fluid/pressure_gradient"][:] == np.zeros(FRAMES)).all()
        units = {name: file[name].attrs["units"].decode() for name in ("time", "fluid/y", "fluid/p", "vesicle/tension")}
        assert list(units.values()) == ["time", "length", "length^2/time^2", "length^3/time^2"]
        assert file["vesicle/markers"].shape == file["vesicle/velocity"].shape == (FRAMES, markers, 2)
        assert file["vesicle/tension"].shape == (FRAMES, markers)
        found = attributes(file)
        np.testing.assert_array_equal(found["box"], [0, 2, -1, 1])
        np.testing.assert_array_equal(found["cells"], [40, 40])
        np.testing.assert_array_equal(found["vesicle_start"], [0, markers])
        assert (found["h"], found["nu"], found["c_b"]) == pytest.approx((0.05, 0.7, 0.02), rel=1e-15)


def test_run_h5_agrees_with_series(run):
    series = run.series
    with h5py.File(run.folder / "run.h5") as file:
        np.testing.assert_allclose(file["time"][:], [0, 0.1, 0.2, 0.24], atol=1e-13)
        for frame, step in enumerate((0, 5, 10, STEPS)):
            assert polygon_area(file["vesicle/markers"][frame]) == pytest.approx(series["area"][step], rel=1e-13)
        y = -1 + 0.05 * (np.arange(40) + 0.5)
        shear = np.tile(0.5 * y[:, None], 40)
        np.testing.assert_allclose(file["fluid/u"][0], shear, atol=1e-15)  # at the start no disturbance
        assert 1e-3 < np.abs(file["fluid/u"][-1] - shear).max() < 0.5
        assert not file["fluid/v"][0].any() and np.abs(file["fluid/v"][-1]).max() > 1e-3
        assert not file["vesicle/tension"][0].any() and file["vesicle/tension"][-1].any()
        moved = file["vesicle/markers"][-1] - file["vesicle/markers"][-2]
        np.testing.assert_allclose(moved, 0.04 * file["vesicle/velocity"][-1], atol=0.02 * 0.04)


def test_run_xmf_refers_to_what_is_there(run):
    """XML, one time a frame, each HDF reference with its dataset's dimensions, and hyperslabs inside them."""
    root = ET.parse(run.folder / "run.xmf").getroot()
    times = [float(item.get("Value")) for item in root.iter("Time")]
    names = set()
    with h5py.File(run.folder / "run.h5") as file:
        np.testing.assert_array_equal(times, file["time"][:])
        for item in root.iter("DataItem"):
            if item.get("Format") == "HDF":
                source, name = item.text.strip().split(":")
                assert source == "run.h5"
                assert file[name].shape == tuple(int(n) for n in item.get("Dimensions").split())
                names.add(name)
            elif item.get("ItemType") == "HyperSlab":
                selection, data = list(item)
                start, stride, count = np.array(selection.text.split(), dtype=int).reshape(3, -1)
                shape = np.array(data.get("Dimensions").split(), dtype=int)
                assert (start + stride * (count - 1) < shape).all() and (count > 0).all()
                assert np.prod(count) == np.prod([int(n) for n in item.get("Dimensions").split()])
    vesicle = {f"/vesicle/{name}" for name in ("wrapped", "tension", "lines", "number")}
    assert names == vesicle | {"/fluid/u", "/fluid/v", "/fluid/p"}


def test_checkpoint_holds_the_state(run):
    series, h = run.series, 0.05
    with h5py.File(run.folder / "checkpoint.h5") as check, h5py.File(run.folder / "run.h5") as fields:
        found = attributes(check)
        assert (found["step"], found["dt"]) == (STEPS, 0.02) and found["time"] == series["time"][-1]
        assert found["-vesicle_bending"].decode().strip("\0") == "0.02"
        assert found["vesicle_area"] == series["area"][0] and found["vesicle_length"] == series["length"][0]
        for name in ("vesicle/markers", "vesicle/velocity", "vesicle/tension", "fluid/p"):
            np.testing.assert_array_equal(check[name][0], fields[name][-1], err_msg=name)
        u, v = check["fluid/u"][0], check["fluid/v"][0]
        assert u.shape == (40, 40) and v.shape == (39, 40)
        assert 0.5 * h * h * (np.sum(u**2) + np.sum(v**2)) == pytest.approx(series["energy_kinetic"][-1], rel=1e-12)
        v = np.pad(v, ((1, 1), (0, 0)))
        divergence = (u - np.roll(u, 1, axis=1) + np.diff(v, axis=0)) / h
        assert np.abs(divergence).max() < 1e-11
        background = 0.5 * (-1 + h * (np.arange(40)[:, None] + 0.5))
        np.testing.assert_allclose(0.5 * (u + np.roll(u, 1, axis=1)) + background, fields["fluid/u"][-1], atol=1e-15)


def test_summary_agrees_with_series(run):
    series, summary = run.series, run.summary
    assert summary["reason"] == "finished" and summary["ranks"] == 2 and summary["cells"] == [40, 40]
    assert list(summary["last"]) == COLUMNS
    for name in COLUMNS:
        last = series[name][-1]
        assert (summary["last"][name] is None) if np.isnan(last) else summary["last"][name] == last
    for name in ("nsolve", "tension_its", "bending_its", "coupled_its"):
        assert summary["totals"][name] == series[name].sum()
    assert summary["totals"]["steps"] == STEPS
    assert set(summary["wall_seconds"]) == {"run", "setup", "step", "fast_solve", "output"}
    assert set(summary["versions"]) == {"petves", "petsc", "fftw", "hdf5"} and summary["git_commit"]
    assert summary["command"][:3] == [PETVES, "-output_dir", str(run.folder)] and "-domain_cells" in summary["command"]


def test_resolved_options_repeat_the_run(run, tmp_path):
    """The same bits in every column but wall, and the same resolved options but the folder."""
    folder = tmp_path / "again"
    again = run_petves(folder, f"-options_file {run.folder / 'resolved.opts'} -output_dir {folder}", ranks=2)
    same_columns(run.series, again.series)

    def options(folder):
        lines = (folder / "resolved.opts").read_text().splitlines()
        return {line for line in lines if not line.startswith(("#", "-output_dir"))}

    assert options(again.folder) == options(run.folder)
    names = [line.split()[0] for line in sorted(options(run.folder))]
    assert len(names) == len(set(names)), "an option with two values"
    for name in ("-domain_box", "-fluid_viscosity", "-delta_type", "-tension_ksp_rtol", "-bending_ksp_max_it"):
        assert name in names


def test_steady_state_ends_the_run(tmp_path):
    options = "-domain_cells 32,32 -vesicle_semi_axes 0.4,0.4 -time_step 0.01 -time_steady_tol 0.1"
    run = run_petves(tmp_path / "out", options)
    assert run.summary["reason"] == "steady"
    assert len(run.series["step"]) == 2


def test_view_prints_the_model_in_force(tmp_path):
    run = run_petves(tmp_path / "out", "-domain_cells 32,32 -time_end 0 -view")
    for text in ("Model in force", "32 x 32 cells", "nu = 1", "c_b = 0.01", "cbs54", "coupled_"):
        assert text in run.stdout, text
    assert len(run.series["step"]) == 1


@pytest.mark.parametrize("scheme", ["split -flow_form total", "coupled"])
def test_no_memory_is_left(scheme, tmp_path):
    """PETSc's own account, of a run and of its restart: every PetscMalloc freed and every object destroyed."""
    options = f"-domain_cells 32,32 -flow_type shear -time_step 0.01 -output_every 0.01 -scheme_type {scheme}"
    options += " -malloc_debug -malloc_dump -objects_dump"
    first = run_petves(tmp_path / "out", options + " -time_end 0.03", ranks=2)
    second = run_petves(tmp_path / "out", f"{options} -time_end 0.04 -restart {tmp_path}/out/checkpoint.h5", ranks=2)
    for run in (first, second):
        assert not [line for line in run.stdout.splitlines() if " bytes " in line]
        assert "never freed" not in run.stdout
        assert not run.errors


@pytest.mark.parametrize(
    "name",
    ["two words", "out/ü 'é' ", " before", "back\\slash%s$HOME", "it's", "pipe|;*?[1]~", "a,b=c", "a #b", "#", "'"],
)
def test_resolved_options_of_any_name(name, here):
    """In a folder of any name that is not refused, and with a curve file of that name."""
    angle = 2 * np.pi * np.arange(40) / 40
    Path("curve").mkdir()
    curve = Path("curve") / name.replace("/", "")
    np.savetxt(curve, 0.4 * np.c_[np.cos(angle), np.sin(angle)])
    words = f"-domain_cells 24,24 -output_every 10 -vesicle_shape file -time_end 0.02".split()
    words = [*words, "-vesicle_file", str(curve), "-output_dir", name]
    assert mpirun([PETVES, *words], 1).returncode == 0
    first = Path(name).rename("first")
    done = mpirun([PETVES, "-options_file", "first/resolved.opts"], 1)
    assert done.returncode == 0 and (Path(name) / "run.h5").is_file(), done.stderr
    assert without_wall(Path(name)) == without_wall(first)


def test_poiseuille_flow_goes_from_wall_to_wall(tmp_path):
    """Its half width and its middle are those of walls in y, unless they are given; without walls they stay."""
    channel = "-domain_box 0,2,1,2 -domain_cells 48,24 -domain_bc_x periodic -flow_type poiseuille -vesicle_shape none -time_end 0"
    for words, half_width, middle in (
        ("-domain_bc_y wall", 0.5, 1.5),
        ("-flow_half_width 4 -flow_center_y 0", 4, 0),
        ("-domain_bc_y periodic", 3, 0),
    ):
        lines = run_petves(tmp_path / "out", f"{channel} {words} -output_overwrite").resolved
        assert (float(lines["-flow_half_width"]), float(lines["-flow_center_y"])) == (half_width, middle)


SMALL = "-domain_cells 32,32 -vesicle_semi_axes 0.4,0.5 -flow_type shear"
FIELDS = ("fluid/u", "fluid/v", "fluid/p", "vesicle/markers", "vesicle/velocity", "vesicle/tension")


@pytest.mark.parametrize(
    "end, every, count",
    [(0.25, 0.1, 4), (9.9, 0.1, 100), (9.91, 0.2, 51), (36, 0.5, 73), (99, 1, 100), (2.1e4, 500, 43)],
)
def test_a_run_has_at_most_100_frames(end, every, count, tmp_path):
    """Without vesicles, at rest, in steps that the times saved are multiples of; the end is saved too."""
    options = f"-vesicle_shape none -domain_cells 8,8 -time_step {every / 2} -time_end {end} -view"
    run = run_petves(tmp_path / "run", options)
    assert float(run.resolved["-output_every"]) == pytest.approx(every, rel=1e-9)
    times = run.saved("time", "run.h5")
    assert len(times) == count and times[-1] == pytest.approx(end, rel=1e-12)
    assert run.summary["written"]["frames"] == count


def test_what_was_written_is_said(tmp_path):
    run = run_petves(tmp_path / "run", f"{SMALL} -time_step 0.01 -time_end 0.03 -output_every 0.01 -checkpoint_every 1")
    written = run.summary["written"]
    sizes = {path.name: path.stat().st_size for path in run.folder.iterdir()}
    names = ("run.h5", "run.xmf", "series.csv", "checkpoint.h5", "checkpoint_1.h5")
    assert set(sizes) - set(names) <= {"resolved.opts", "summary.json"}
    assert written == {"frames": 4, "bytes": sum(sizes[name] for name in names), "bytes_run_h5": sizes["run.h5"]}
    line = f"files in {run.folder}: {written['bytes'] / 1e6:.3g} MB, {sizes['run.h5'] / 1e6:.3g} MB of them run.h5 with 4 frames"
    assert line in run.stdout


def test_single_precision(tmp_path):
    """The fields alone, rounded, on any number of ranks; the run is the same, and goes on with no other precision."""
    options = f"{SMALL} -domain_cells 48,48 -time_step 0.01 -time_end 0.03 -output_every 0.01"
    double = run_petves(tmp_path / "double", options)
    single = run_petves(tmp_path / "single", f"{options} -output_precision single", 2)
    one = run_petves(tmp_path / "one", f"{options} -output_precision single")
    assert without_wall(one.folder) == without_wall(double.folder)
    exact, rounded, others = frames(double.folder), frames(one.folder), frames(single.folder)
    for name in FIELDS:
        small = name.startswith("fluid")
        assert rounded[name].dtype == (np.float32 if small else np.float64), name
        np.testing.assert_array_equal(rounded[name], exact[name].astype(np.float32) if small else exact[name])
        np.testing.assert_allclose(others[name], exact[name], rtol=1e-6, atol=1e-7 * np.abs(exact[name]).max())
    assert (one.folder / "run.h5").stat().st_size < 0.62 * (double.folder / "run.h5").stat().st_size
    text = (one.folder / "run.xmf").read_text()
    assert text.count('"Float" Precision="4"') == 3 * 4 and text.count('"Float" Precision="8"') == 2 * 4
    restart = f"{options} -time_end 0.04 -restart {one.folder}/checkpoint.h5"
    refused(one.folder, f"{restart} -output_precision double", "-output_precision double: the checkpoint of")
