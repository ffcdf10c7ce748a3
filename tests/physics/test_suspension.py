"""Suspensions: packed vesicles, mixtures, and the files of many vesicles."""

import json
import re
import signal
import subprocess
import xml.etree.ElementTree as ET

import h5py
import numpy as np
import pytest
from harness import attribute, run_petves, start, wait_for_rows
from restarts import agree, frames, same_columns

import petves
from petves.run import Run as Files
from petves.run import RunError
from petves.views.plot import draw_members, new_figure, plot_run
from petves.views.report import report
from petves.views.words import scene_in_words

PACKED = "-domain_box 0,6,0,3 -domain_cells 96,48 -domain_bc_x periodic -fluid_inertia none -flow_type shear"
PACKED += " -vesicle_markers 24 -vesicle_packing .4 -time_step .05 -time_end 0 -vesicle_mixture .75,.25"
PACKED += " -vesicle_area .3,.15 -vesicle_reduced_area .7,.9 -vesicle_bending .01,.04"


def test_packing_is_the_same_on_all_ranks(tmp_path):
    """Number, kinds and fraction are those asked for, on any number of ranks and when resolved.opts is fed back."""
    first = run_petves(tmp_path / "a", PACKED)
    run = Files.read(first.folder)
    count = run.vesicles
    small = [area < 0.2 for area in (run.series[f"area_{v + 1}"][0] for v in range(count))]
    assert count == round(0.4 * 18 / (0.75 * 0.3 + 0.25 * 0.15))
    assert sum(small) == pytest.approx(count / 4, abs=1)
    assert run.series["area"][0] / 18 == pytest.approx(0.4, abs=0.01)
    again = run_petves(tmp_path / "b", f"-options_file {first.folder}/resolved.opts", ranks=3)
    other = run_petves(tmp_path / "c", f"{PACKED} -vesicle_packing_seed 2")
    assert np.array_equal(Files.read(again.folder).markers, run.markers)
    assert np.abs(Files.read(other.folder).markers[0] - run.markers[0]).max() > 0.1


def test_number_and_fraction_give_the_area(tmp_path):
    """With -vesicle_count the area of the vesicles follows from the fraction."""
    run = run_petves(tmp_path, "-vesicle_packing .3 -vesicle_count 5 -vesicle_reduced_area .8 -time_end 0")
    assert run.series["area_3"][0] == pytest.approx(0.3 * 4 / 5, rel=1e-2)  # a polygon's


def test_bending_of_each(tmp_path):
    """Energies go by each vesicle's own c_b; a pair with its stiffnesses exchanged is the mirror image."""
    pair = "-fluid_inertia none -vesicle_count 2 -vesicle_semi_axes .2,.4 -vesicle_center -.5,0,.5,0"
    pair += " -time_step .1 -time_end .3 -vesicle_bending "
    one, two = (run_petves(tmp_path / name, pair + c).series for name, c in (("a", ".01,.1"), ("b", ".1,.01")))
    assert one["energy_bending_2"][0] / one["energy_bending_1"][0] == pytest.approx(10, rel=1e-12)
    assert one["energy_bending_2"][-1] / one["energy_bending_1"][-1] < 9.97  # and so do the forces
    assert one["energy_bending_1"] == pytest.approx(two["energy_bending_2"], rel=1e-8)
    assert one["center_x_1"] == pytest.approx(-two["center_x_2"], abs=1e-9)


MANY = "-scheme_type split -domain_box 0,9,0,6 -domain_cells 96,64 -domain_bc_x periodic -flow_type shear"
MANY += " -flow_center_y 3 -vesicle_packing .25 -vesicle_packing_type lattice -vesicle_angle 30 -vesicle_count 42"
MANY += " -vesicle_reduced_area .8 -time_step .01 -output_every .02 -checkpoint_every 2"


def rows(folder):
    """The datasets of vesicles.h5."""
    return frames(folder, "vesicles.h5")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run of 42 vesicles."""
    return run_petves(tmp_path_factory.mktemp("many"), f"{MANY} -time_end .08").folder


def test_many_have_a_file_of_their_own(whole):
    """Above 40 vesicles series.csv has totals, and vesicles.h5 what they are totals of, at every step."""
    run, each = Files.read(whole), rows(whole)
    assert not any(re.search(r"_\d+$", name) for name in run.series)
    assert each["area"].shape == (9, 42) and list(each["step"]) == list(range(9))
    np.testing.assert_array_equal(each["time"], run.series["time"])
    np.testing.assert_allclose(each["area"].sum(1), run.series["area"], rtol=1e-13)
    np.testing.assert_allclose(each["energy_bending"].sum(1), run.series["energy_bending"], rtol=1e-12)
    np.testing.assert_allclose(each["center_x"].mean(1), run.series["center_x"], rtol=1e-12)
    np.testing.assert_array_equal(each["inclination"][:, 0], run.series["inclination"])
    assert np.isfinite(each["gap"]).all() and (each["gap"] > 0).all()
    of_polygons = each["gap"].min(1)  # where they are half an edge apart
    np.testing.assert_allclose(of_polygons, run.series["gap"], rtol=0.02)


def test_gap_of_each(tmp_path):
    """Circles of radius 1/4: the first two .1 apart, the third .2 from the second over the seam, the fourth .15 from a wall,
    the fifth far from all."""
    scene = f"-domain_box 0,6,0,4 -domain_cells 60,40 -domain_bc_x periodic -vesicle_semi_axes .25,.25 "
    scene += "-vesicle_count 5 -vesicle_center 5,2,5.6,2,.3,2,2,.4,3,3 -vesicle_markers 25 -vesicle_allow_close_markers"
    run = run_petves(tmp_path / "run", f"{scene} -time_end 0")
    gaps = [run.series[f"gap_{v}"][0] for v in range(1, 6)]
    np.testing.assert_allclose(gaps, (0.1, 0.1, 0.2, 0.15, np.nan), atol=2e-3)
    assert petves.load(run.folder)["gap_5"].attrs["units"] == "length"


def test_python_has_each(whole):
    """Arrays of all vesicles by name, from vesicles.h5 or from the columns of series.csv, and in the dataset."""
    run = Files.read(whole)
    np.testing.assert_array_equal(run.each("area"), rows(whole)["area"])
    with pytest.raises(RunError, match="column colour"):
        run.each("colour")
    data = petves.load(whole)
    assert data["each_length"].dims == ("step", "member") and data["each_length"].attrs["units"] == "length"
    np.testing.assert_array_equal(data["each_inclination"], run.each("inclination"))


def test_images_are_cut_at_the_seam(tmp_path):
    """A vesicle that has left a periodic box twice over is drawn in it, on both sides of the seam where it lies on it."""
    options = "-domain_bc_x periodic -vesicle_semi_axes .2,.3 -vesicle_center 4.95,0 -time_end 0"
    run = Files.read(run_petves(tmp_path, options).folder)
    left, right = sorted(run.images_of(run.outline(0)), key=lambda points: points[:, 0].mean())
    assert left[:, 0].mean() == pytest.approx(-1.05, abs=1e-2) and right[:, 0].mean() == pytest.approx(0.95, abs=1e-2)
    whole_box = {path.name for path in plot_run(tmp_path)}
    assert whole_box >= {"field.png", "shapes.png", "tension.png"}


def test_run_xmf_is_wrapped(tmp_path):
    """A vesicle two periods away is shifted back by them, the other is as it is in run.h5; each has its number."""
    pair = "-domain_bc_x periodic -vesicle_count 2 -vesicle_semi_axes .2,.3 -vesicle_center 4.5,0,-.4,0 -time_end 0"
    folder = run_petves(tmp_path, pair).folder
    (grid,) = [g for g in ET.parse(folder / "run.xmf").getroot().iter("Grid") if g.get("Name") == "vesicle"]
    assert "run.h5:/vesicle/wrapped" in [item.text for item in grid.find("Geometry").iter("DataItem")]
    with h5py.File(folder / "run.h5") as file:
        shift = file["vesicle/wrapped"][0] - file["vesicle/markers"][0]
        assert list(file["vesicle/number"]) == [1, 2]
    one = len(shift) // 2
    np.testing.assert_allclose(shift, np.repeat([[-4, 0], [0, 0]], one, axis=0), atol=1e-14)


def test_what_was_written_counts_vesicles_h5(whole):
    written = json.loads((whole / "summary.json").read_text())["written"]
    others = {"resolved.opts", "summary.json"}
    assert written["bytes"] == sum(path.stat().st_size for path in whole.iterdir() if path.name not in others)


def test_many_are_drawn_in_the_colour_of_their_kind(whole, tmp_path):
    """One polygon an image, all of the one kind in one colour; tests/python/test_views.py has two kinds."""
    run = Files.read(whole)
    _, (axes,) = new_figure(4, 3)
    drawn = draw_members(axes, run, -1)
    assert len(drawn.get_paths()) == sum(len(run.images_of(run.outline(-1, v))) for v in range(42)) >= 42
    assert len(np.unique(drawn.get_facecolors(), axis=0)) == 1 and axes.get_legend() is None
    assert scene_in_words(run)[1].startswith("42 vesicles") and "markers each" in scene_in_words(run)[1]
    assert report(whole, tmp_path / "page.html").stat().st_size > 1e5


def test_restart_goes_on_with_the_rows(whole, tmp_path):
    """In its folder and in a new one; a file that lacks the checkpoint's row is refused and left as it is."""
    first = run_petves(tmp_path / "a", f"{MANY} -time_end .05").folder
    checkpoint = f"-restart {first}/checkpoint.h5 -time_end .08"
    new = run_petves(tmp_path / "b", f"{MANY} {checkpoint}")
    same_columns(rows(new.folder), {name: values[5:] for name, values in rows(whole).items()})
    bytes_before = (first / "vesicles.h5").read_bytes()
    with h5py.File(first / "vesicles.h5", "r+") as file:
        for name in file:
            file[name].resize(4, 0)
    short = (first / "vesicles.h5").read_bytes()
    refused = run_petves(first, f"{MANY} {checkpoint}", good=False)
    assert refused.status == 1 and "vesicles.h5 has 4 readable rows, the checkpoint counts 6" in refused.errors[0]
    assert (first / "vesicles.h5").read_bytes() == short
    (first / "vesicles.h5").write_bytes(bytes_before)
    run_petves(first, f"{MANY} {checkpoint}", ranks=2)
    np.testing.assert_allclose(rows(first)["center_y"], rows(whole)["center_y"], atol=1e-10)


def test_killed_run_has_its_rows(whole, tmp_path):
    """All of vesicles.h5 but the values of its rows is overwritten: with the index a restart makes it anew."""
    folder = tmp_path / "run"
    process = start(folder, f"{MANY} -time_end 10", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for_rows(folder, 3)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    last = int(attribute(folder / "checkpoint.h5"))
    good = (folder / "vesicles.h5").read_bytes()
    bad = bytearray(len(good))
    for line in (folder / "vesicles.h5.index").read_text().splitlines():
        for k, place in enumerate(int(x) for x in line.split()[2:]):
            size = 8 * (42 if k else 1)
            bad[place : place + size] = good[place : place + size]
    (folder / "vesicles.h5").write_bytes(bad)
    run_petves(folder, f"{MANY} -time_end {max(last + 1, 8) * 0.01} -restart {folder}/checkpoint.h5")
    for name, values in rows(whole).items():
        np.testing.assert_array_equal(rows(folder)[name][:9], values, err_msg=name)
    assert not (folder / "vesicles.h5.index").exists()


#: 7 vesicles at 30 % of a channel, in shear: 315 markers, more than one dense block takes.
SEVEN = (
    " -domain_box 0,6.4,0,3.2 -domain_cells 96,48 -domain_bc_x periodic -flow_type shear -fluid_inertia none -vesicle_count 7"
    " -vesicle_semi_axes 0.35,0.8 -vesicle_markers 45 -vesicle_bending 0.2 -vesicle_angle 70,60,65,60,70,75,65"
    " -vesicle_center 0.9,0.8,2.4,0.8,4.0,0.8,5.6,0.8,1.6,2.4,3.2,2.4,4.9,2.4 -time_step 0.05 -output_every 2"
)


def test_viscosity_contrast_of_seven(tmp_path):
    """Mixed ratios: vesicles know one another's double layer. Without it steps 2 to 4 take 8, 9 and 8 iterations."""
    ratios = "-time_end 0.2 -vesicle_viscosity_ratio .2,10,.2,10,.2,10,.2"
    one, three = (run_petves(tmp_path / str(n), f"{SEVEN} {ratios}", ranks=n).series for n in (1, 3))
    assert one["coupled_its"][2:].mean() <= 7.5
    np.testing.assert_array_equal(three["coupled_its"], one["coupled_its"])
    np.testing.assert_allclose(three["inclination"], one["inclination"], rtol=1e-10, atol=1e-11)


def test_iterations_ranks_and_restart_of_seven(tmp_path):
    """Few iterations: the coarse grid knows what vesicles and walls do to one another. Blocks of each vesicle alone take 8.3 here.
    Its 16 rows are shared by 3 ranks; of 5 each has all of them. A restart finds the patterns again: the same bits."""
    names = ("center_x", "center_y", "inclination", "energy_bending")
    runs = agree(tmp_path, SEVEN, 0.1, 0.2, names, (3, 5), rel=1e-10, abs=1e-11)
    found = {name: run.series for name, run in runs.items()}
    whole, rest = found["whole"], found["rest"]
    assert whole["coupled_its"][2:].mean() <= 7
    for ranks in (3, 5):
        np.testing.assert_array_equal(found[ranks]["coupled_its"], whole["coupled_its"])
    same_columns(rest, {name: column[-len(rest["step"]) :] for name, column in whole.items()})
