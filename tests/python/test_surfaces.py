"""Runs in three dimensions from Python: what is loaded, drawn and filmed, and what VTK reads."""

import numpy as np
import pytest
from harness import SITE, run_petves, run_python

import petves
from petves.run import SurfaceRun
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


def test_a_simulation_in_space_is_refused():
    done = run_python("import petves; petves.Simulation(dim=3)", good=False)
    assert done.returncode == 1 and "-dim 3: not from Python or C; allowed: 2, or petves run" in done.stderr


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
