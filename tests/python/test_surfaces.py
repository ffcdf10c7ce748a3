"""Runs in three dimensions from Python: what is loaded, drawn and filmed, and what VTK reads."""

from types import SimpleNamespace

import numpy as np
import pytest
from harness import SITE, run_petves, run_python

import petves
from petves.run import SurfaceRun
from petves.views.surfaces import smooth_surfaces, tube_radius
from petves.views.words import key_numbers, scene_in_words

SCENE = "-dim 3 -flow_type shear -vesicle_bending 0.1 -sphere_degree 8 -time_step 0.2 -time_end 0.4 -output_every 0.2"
PAIR = f"{SCENE} -vesicle_count 2 -vesicle_center -2,0.8,0,2,-0.8,0"


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    return run_petves(tmp_path_factory.mktemp("pair") / "run", PAIR).folder


def test_surfaces_are_closed_and_have_their_volume(pair):
    run = petves.load(pair, kind="numpy")
    assert isinstance(run, SurfaceRun) and run.vesicles == 2 and list(run.time) == [0, 0.2, 0.4]
    edges = np.sort(run.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()  # each edge has two triangles
    for vesicle in range(2):
        a, b, c = np.moveaxis(run.points[-1, vesicle][run.triangles], 1, 0)
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        assert 0.9 < volume / run.series[f"volume_{vesicle + 1}"][-1] < 1
        assert run.tension[-1, vesicle].max() < run.series[f"tension_max_{vesicle + 1}"][-1] + 0.1


def test_drawn_surfaces_are_those_of_the_harmonics(tmp_path):
    """The finer grid of an ellipsoid lies on it, and has the tension's range."""
    run = petves.load(run_petves(tmp_path / "run", f"{SCENE} -vesicle_half_axes 1.3,0.9,0.8").folder, kind="numpy")
    x, y, z, _ = smooth_surfaces(run, 0)[0]
    assert abs((x / 1.3) ** 2 + (y / 0.9) ** 2 + (z / 0.8) ** 2 - 1).max() < 1e-12
    tension = smooth_surfaces(run, -1)[0, 3]
    known = [run.series[f"tension_{end}"][-1] for end in ("min", "max")]  # of another fine grid
    assert np.allclose((tension.min(), tension.max()), known, atol=0.01 * np.ptp(tension))


def test_dataset_has_units(pair):
    data = petves.load(pair)
    assert data.points.dims == ("time", "vesicle", "point", "xyz") and data.points.attrs["units"] == "length"
    assert data.energy_bending.attrs["units"] == "length^5/time^2" and data.attrs["degree"] == 8
    assert not [name for name in data.data_vars if name != "triangles" and not data[name].attrs["units"]]


def test_pictures_and_a_film(pair):
    assert [path.name for path in petves.plot(pair)] == ["surfaces.png", "course.png"]
    assert [path.name for path in petves.plot(pair, time=0.2)] == ["surfaces_t0.2.png"]
    assert petves.movie(pair, pair / "film.gif", width=400).stat().st_size > 10000
    with pytest.raises(petves.RunError, match="three dimensions"):
        petves.plot(pair, columns=["gap"])


def test_report_has_words_numbers_pictures_and_warnings(pair, tmp_path):
    page = petves.report(pair, tmp_path / "page.html").read_text()
    assert page.count("data:image/png;base64,") == 3 and "<td></td>" not in page and "http" not in page
    assert "<p>2 vesicles" in page and "reduced volume 0.9, spherical harmonics of degree 8 each" in page
    run = petves.load(pair, kind="numpy")
    numbers = dict(key_numbers(run))
    assert float(numbers["chi = rate nu R0^3/c_b"]) == pytest.approx(1 / 0.1) and "last rotation about z" in numbers
    volume = run.series["volume_1"][0] + run.series["volume_2"][0]
    assert float(numbers["volume of all vesicles"]) == pytest.approx(volume, rel=1e-4)
    run.summary["warnings"] = ["grids of near vesicles grow"]
    assert scene_in_words(run)[-1] == "Warning: grids of near vesicles grow"


def test_compare_says_what_differs(pair, tmp_path):
    stiff = run_petves(tmp_path / "stiff", f"{PAIR} -vesicle_bending 0.2").folder
    lines, picture = petves.compare(pair, stiff, tmp_path / "two.png")
    assert (
        "| -vesicle_bending | 0.10000000000000001 | 0.20000000000000001 |" in lines and picture.stat().st_size > 10000
    )
    a, b = (petves.load(folder, kind="numpy").points for folder in (pair, stiff))
    assert f"Markers: {np.linalg.norm(a - b, axis=-1).max():.3e} apart at most (length) at 3 common" in lines[-1]


IN_SPACE = "dim=3, vesicle_reduced_volume=0.9, vesicle_bending=0.1, sphere_degree=8, time_step=0.2, time_end=0.6"


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_simulation_from_python(ranks, tmp_path):
    """The flow of a function is that of the same name; what the plane alone has is refused."""
    code = f"""
import numpy as np, petves
with petves.Simulation({IN_SPACE}, flow_type="shear", output_dir={str(tmp_path / "run")!r}) as sim:
    sim.step()
    assert sim.markers.shape == sim.marker_velocity.shape == (164, 3) and sim.tension.shape == (164,)
    assert sim.run() == "finished" and sim.time == 0.6 and list(sim.ksp) == ["coupled"] and sim.obstacles == []
    assert "three dimensions, degree 8" in repr(sim)
    angle, markers = sim.inclination, sim.markers.copy()
    try:
        sim.cell_velocity()
    except petves.Error as error:
        assert "-dim 3: no grid to ask for" in str(error)
    else:
        raise AssertionError
with petves.Simulation({IN_SPACE}, flow=lambda x, y, z, t: (y, 0 * y, 0 * z)) as sim:
    sim.run()
    assert abs(sim.inclination - angle) < 1e-12 and np.allclose(sim.markers, markers, atol=1e-12)
def late(x, y, z, t):
    return (y, 0, 0) if t < 0.5 else 1 / 0
try:
    with petves.Simulation({IN_SPACE}, flow=late) as sim:
        sim.run()
except (ZeroDivisionError, petves.Error):  # where the flow is not called
    assert sim.time == 0.4
"""
    run_python(code, ranks=ranks)
    assert petves.load(tmp_path / "run", kind="numpy").series["time"][-1] == 0.6


@pytest.mark.skipif(not (SITE / "vtk.py").exists(), reason="vtk is not to be had")
def test_vtk_reads_every_frame(pair, monkeypatch):
    monkeypatch.syspath_prepend(str(SITE))
    vtk = pytest.importorskip("vtkmodules.vtkIOXdmf2")
    reader = vtk.vtkXdmfReader()
    reader.SetFileName(str(pair / "run.xmf"))
    reader.UpdateInformation()
    for time in (0, 0.2, 0.4):
        reader.UpdateTimeStep(time)
        frame = reader.GetOutputDataObject(0)
        assert frame.GetNumberOfPoints() == 2 * 164 and frame.GetNumberOfCells() == 2 * 324
        assert frame.GetPointData().GetArray("tension") and frame.GetCellData().GetArray("vesicle")


def test_wall_of_a_tube_is_drawn():
    """A throat of radius 0.8 and length 1 in a tube of radius 1.5, whose mouths are as long as the tube is wide."""
    tube = {"tube_radius": "1.5", "tube_throat": "0.8", "tube_throat_length": "1", "tube_throat_mouth": "0"}
    run = SimpleNamespace(options=lambda: tube | {"tube_throat_center": "2"})
    assert np.allclose(tube_radius(run, np.array([2, 2.5, 3.25, 4, -9])), [0.8, 0.8, 1.15, 1.5, 1.5])
    assert (
        tube_radius(SimpleNamespace(options=lambda: {"tube_radius": "1.5", "tube_throat": "0"}), np.ones(2)) == 1.5
    ).all()
    for nothing in ({}, {"tube_radius": "0"}):  # of -dim 3, and of -dim axisymmetric
        assert tube_radius(SimpleNamespace(options=lambda: nothing), np.ones(2)) is None
