"""petves numbers: options from SI numbers; petves scenes and run NAME: scenes that come with petves."""

import json
import re

import pytest
from harness import ROOT, read_series, run_petves, run_tool

import petves
from petves.program import scene_file, scene_files

CELL = dict(radius=3e-6, bending=2e-19, viscosity=1.2e-3, rate=100.0)


def test_numbers_are_those_of_the_run(tmp_path):
    """chi, Re and the time scale are what their definitions say; the printed lines are a scene that has them."""
    options, found = petves.numbers(**CELL)
    assert found["lambda_t"] == pytest.approx(1.2e-3 * 2.7e-17 / 2e-19) and found["chi"] == pytest.approx(16.2)
    assert found["Re"] == pytest.approx(100 * 9e-12 / 1.2e-6) and found["V"] == 0.7 and found["viscosity_ratio"] == 1
    words = ["--radius", 3e-6, "--bending", 2e-19, "--viscosity", 1.2e-3, "--rate", 100]
    done = run_tool("numbers", *words)
    assert done.returncode == 0 and "chi = 16.2, Re = 0.00075" in done.stdout.splitlines()[0]
    (tmp_path / "cell.opts").write_text(done.stdout)
    run = run_petves(tmp_path / "run", f"-options_file {tmp_path}/cell.opts -time_end 0.001")
    summary, series = json.loads((run.folder / "summary.json").read_text()), read_series(run.folder / "series.csv")
    assert summary["reynolds"] == pytest.approx(found["Re"], rel=0.01)
    assert series["length"][0] == pytest.approx(2 * 3.14159265 * 3e-6, rel=1e-6)
    assert f"-vesicle_bending {2e-19 / 1000:g}" in done.stdout.splitlines()
    assert float(options["vesicle_bending"]) == 2e-22
    with petves.Simulation(**petves.numbers(**CELL, inside=6e-3, flow="extension")[0] | {"time_end": 0}) as sim:
        assert float(sim.options["vesicle_viscosity_ratio"]) == 5 and sim.options["flow_type"] == "extension"


@pytest.mark.parametrize(
    "wrong, line",
    [
        (dict(bending=0), "bending 0: out of range; allowed: >0, in SI units"),
        (dict(reduced_area=1.2), "reduced_area 1.2: out of range"),
        (dict(flow="poiseuille"), "flow poiseuille: unknown; allowed: shear, extension"),
    ],
)
def test_numbers_that_cannot_be(wrong, line):
    with pytest.raises(petves.Error, match=line):
        petves.numbers(**CELL | wrong)


def test_scenes_run_by_name(tmp_path):
    assert scene_files()["shear"] == ROOT / "runs" / "shear.opts" and "gallery/stenosis" in scene_files()
    done = run_tool("scenes")
    assert done.returncode == 0 and len(done.stdout.splitlines()) == len(list((ROOT / "runs").rglob("*.opts")))
    assert re.search("^ *settling +A heavy vesicle sinks in a box of four walls *$", done.stdout, re.M)
    done = run_tool("run", "free", "-time_end", 0.1, "-output_dir", "out", folder=tmp_path)
    assert done.returncode == 0 and (tmp_path / "out" / "series.csv").is_file(), done.stderr
    (tmp_path / "shear").write_text("")
    assert scene_file("shear") == str(ROOT / "runs" / "shear.opts") and scene_file("-help") == "-help"
    assert scene_file(str(tmp_path / "shear")) == str(tmp_path / "shear")
    assert "No such file" in run_tool("run", "sheer", folder=tmp_path).stderr
