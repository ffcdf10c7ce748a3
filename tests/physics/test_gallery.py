"""runs/gallery: every file says how it is run and what it is compared with; a quick version of each reaches its number."""

import os
import re
import sys

import numpy as np
import pytest
from harness import ROOT, SANITIZE, mpirun, run_petves

from petves.measures import half_periods
from petves.run import Run as Files
from studies.common.curves import trigonometric
from studies.gallery import bifurcation, capillary, constriction, couette, passing
from studies.gallery import settling, space, stenosis, suspension, tumbling, vortices
from studies.gallery.page import SCENES, TEMPLATE, filled
from studies.gallery.scene import least

FILES = sorted((ROOT / "runs" / "gallery").glob("*.opts"))


def run_file(name, folder, options=""):
    """Run a file of runs/gallery as it is, but for the options given; return its series."""
    file = f"-options_file {ROOT / 'runs' / 'gallery' / name}.opts -output_dir {folder} -output_every 1e9"
    return run_petves(folder, f"{file} {options}").series


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_header(path):
    """Command, ranks, seconds, expected numbers and whose they are compared with; output in a folder of its own."""
    text = path.read_text()
    command = rf"# mpirun -n \d bin/petves -options_file runs/gallery/{path.name}      \d ranks?, [\d.]+ (s|minutes?)\n"
    python = rf"# PYTHONPATH=python:. python3 -m studies.gallery.vortices {path.stem} out/gallery_{path.stem}      1 rank, [\d.]+ s"
    assert re.search(command, text) or re.search(python, text)
    assert "# Expected: " in text and "# Compared with: " in text
    assert f"-output_dir out/gallery_{path.stem}\n" in text


def test_template_and_scenes_agree():
    """Each scene has one block; a place without a value, or a value without a place, is an error."""
    blocks = re.findall(r"^<!-- scene (\w+) -->$", TEMPLATE.read_text(), re.MULTILINE)
    assert blocks == [scene.name for scene in SCENES]
    assert filled("a {b} c", {"b": "1"}) == "a 1 c"
    for values in ({}, {"b": "1", "c": "2"}):
        with pytest.raises(ValueError, match="differ in"):
            filled("a {b}", values)


def test_tumbling(tmp_path):
    """The first half period of the boundary integral, to 2e-4 of it; Keller and Skalak's is shorter."""
    series = run_file("tumbling", tmp_path, "-time_step .1 -time_end 19")
    half = half_periods(series["time"], series["inclination"])
    assert half == pytest.approx([tumbling.EXACT["free", 10][0]], rel=5e-4)
    assert tumbling.keller_skalak_half(0.7, 10) < half[0]


def test_space(tmp_path):
    """The steady angle of the independent calculation, to 1e-4 of it."""
    angle = run_file("space", tmp_path, "-output_every 1")["inclination"][-1] / np.pi
    assert angle == pytest.approx(space.STEADY[space.SHOWN], rel=1e-4)


def test_keller_skalak():
    """With ratio 1 the steady angle is petves.theory's, with a large one the ellipse is Jeffery's rigid one."""
    from petves.theory import ellipse_axes, keller_skalak_angle

    a, b = ellipse_axes(0.7)
    steady = np.arccos(1 / tumbling.keller_skalak(0.7, 1)) / 2
    assert steady == pytest.approx(keller_skalak_angle(a, b), rel=1e-12)
    assert tumbling.keller_skalak(0.7, tumbling.keller_skalak_critical(0.7)) == pytest.approx(1, rel=1e-12)
    assert tumbling.keller_skalak(0.7, 1e9) == pytest.approx((a * a - b * b) / (a * a + b * b), rel=1e-8), "Jeffery"


def test_passing(tmp_path):
    """The least gap of the boundary integral to 1 %, the centre's height to 1.5e-3, on 32^2 with long steps."""
    series = run_file("passing", tmp_path, "-domain_cells 32,32 -time_step .1")
    assert least(series)[0] == pytest.approx(passing.EXACT["gap"], rel=0.01)
    assert series["center_y_1"][-1] == pytest.approx(passing.EXACT["center"][1], abs=1.5e-3)


def test_pressed(tmp_path):
    """The film of 96^2 with 151 markers to .2 %, on 32^2 with 49 to t = 4; it thins ever more slowly."""
    series = run_file("pressed", tmp_path, "-domain_cells 32,32 -vesicle_markers 49 -time_step .1 -time_end 4")
    film = [np.interp(t, series["time"], series["gap"]) for t in (2, 4)]
    assert film == pytest.approx([0.16056, 0.11008], rel=2e-3)
    assert 0.45 < np.log(film[0] / film[1]) / np.log(2) < 0.66


@pytest.mark.skipif(SANITIZE, reason="a sanitized library cannot be loaded into Python")
def test_vortex(tmp_path):
    """A Taylor-Green flow from Python: four vesicles turned by quarters stay so, whatever they do otherwise."""
    command = [sys.executable, "-m", "studies.gallery.vortices", "vortex", str(tmp_path)]
    command += "-domain_cells 32,32 -vesicle_markers 31 -time_step .1 -time_end 1 -output_every 1".split()
    done = mpirun(command, 1, PYTHONPATH=os.pathsep.join([str(ROOT / "python"), str(ROOT)]))
    assert done.returncode == 0, done.stderr
    found = vortices.measures(tmp_path)
    assert vortices.turned(found["middle"]) < 1e-6 and max(found["area"], found["length"]) < 1e-10
    assert np.abs(np.array(found["middle"][0]) - np.pi / 2 - (0.7, 0)).max() > 0.1, "they move"


def test_what_the_lattice_is_judged_by():
    """Places moved by half a period both ways, and not."""
    place = np.array([[0.1, 0.2], [0.1 + np.pi, 0.2 - np.pi], [1, 2], [1 - np.pi, 2 + 3 * np.pi]])
    assert vortices.shifted(place) < 1e-12 < 0.1 < vortices.shifted(place + [[0.1, 0], [0, 0], [0, 0.1], [0, 0]])


def test_settling(tmp_path):
    """The boundary integral's height at t = 1 to 1e-4."""
    series = run_file("settling", tmp_path, "-time_step .1 -time_end 1")
    assert series["center_y"][-1] == pytest.approx(settling.EXACT[1], abs=1e-4)


def test_tandem(tmp_path):
    """Distance at t = 10 of a grid twice as fine to 1e-3; the one above is slower at first."""
    series = run_file("tandem", tmp_path, "-time_step .2 -time_end 10")
    assert series["center_y_2"][-1] - series["center_y_1"][-1] == pytest.approx(5.1676, abs=1e-3)


def test_couette(tmp_path):
    """The exact torque without vesicles, from a grid half as fine; one vesicle adds less than a rigid disc, 2."""
    options = "-domain_cells 32,32 -time_step .1 -time_end .2"
    series = run_file("couette", tmp_path / "none", f"{couette.WHAT['none']} {options}")
    assert -series["obstacle_torque_1"][-1] == pytest.approx(couette.EXACT, rel=1e-5)
    options = f"{couette.ONE} -domain_cells 32,32 -time_end 2 -vesicle_allow_close_markers true"
    series = run_file("couette", tmp_path / "one", options)
    added = (-series["obstacle_torque_1"][-1] / couette.EXACT - 1) / 0.003 * np.pi * (0.45**2 - 0.2**2)
    assert 0.5 < added < 2


def test_posts(tmp_path):
    """On both sides of the critical size of rigid spheres: after three rows the small one has changed lanes, the large one has not."""
    aside = {}
    for diameter in (0.2, 0.4):
        area = 0.95 * np.pi * diameter**2 / 4
        series = run_file("posts", tmp_path / f"{diameter}", f"-vesicle_area {area!r} -time_step .04 -time_end 3.2")
        at = np.interp(3.3, series["center_y"], series["center_x"])
        assert series["center_y"][-1] > 3.3
        aside[diameter] = at - 0.95
    assert aside[0.2] < 0 and aside[0.4] > 0.4


def test_reynolds(tmp_path):
    """Inertia raises the angle: .16929 of pi at Re = 1 on 64^2, here on 32^2 to 2 %; without inertia it is .1177."""
    angle = {}
    for name, options in (("one", "-time_step .025"), ("none", "-fluid_inertia none -time_step .2")):
        series = run_file("reynolds", tmp_path / name, f"-domain_cells 32,32 -time_end 12 {options}")
        angle[name] = series["inclination"][-1] / np.pi
    assert angle["one"] == pytest.approx(0.16929, rel=0.02) and angle["none"] == pytest.approx(0.11773, rel=1e-3)


def test_capillary(tmp_path):
    """Fast flow in a narrow channel makes a parachute, slower flow in a wide one a slipper, which lags less."""
    found = {}
    wide = "-time_step .2 -flow_half_width 2.5 -domain_box 0,8,-2.5,2.5 -domain_cells 48,30"
    for what, options in (("parachute", "-flow_ca 40"), ("slipper", wide)):
        series = run_file("capillary", tmp_path / what, f"{options} -time_end 30")
        peak = 4 if what == "parachute" else 1
        outline = trigonometric(Files.read(tmp_path / what).markers[-1], 64)
        found[what] = (capillary.asymmetry(outline), 1 - series["velocity_x"][-1] / peak)
    assert found["parachute"][0] < 0.05 < 0.5 < found["slipper"][0]
    assert found["slipper"][1] < found["parachute"][1]


def test_bifurcation(tmp_path):
    """Fluxes of the branches of a grid twice as fine to 1 %; the fit of islands' lengths finds the limit it was given."""
    one = bifurcation.split(2.0, 32)
    (tmp_path / "island.txt").write_text(one.files["-obstacle_file"])
    own = (ROOT / "runs" / "gallery" / "island.txt").read_text()
    np.testing.assert_allclose(np.loadtxt(own.splitlines()), bifurcation.island(2.0), atol=1e-6)
    words = "-vesicle_shape none -allow_unused_options true -time_end .02 -output_every .02"
    run_file("bifurcation", tmp_path / "run", f"{words} -obstacle_file {tmp_path / 'island.txt'}")
    assert one.measure({"pressure_drop": [0]}, tmp_path / "run")["flux"] == pytest.approx([0.1933, 0.8067], rel=0.01)
    assert bifurcation.limit({x: 0.2 * (x + 0.1) / (x + 0.3) for x in (1, 2, 3)}) == pytest.approx(0.2)
    assert bifurcation.dividing_streamline(0.5) == pytest.approx(0.5)


def test_suspension(tmp_path):
    """One vesicle adds 1.62 times its fraction to the viscosity of a channel 32 R0 high, less than a rigid disc's 2."""
    words = f"{suspension.ALONE} -vesicle_packing 0.0024543693 -time_step .2 -time_end 10"
    series = run_file("suspension", tmp_path, words)
    added = (series["viscosity"][-1] - 1) / (series["area"][-1] / 32**2)
    assert added == pytest.approx(1.62, rel=0.01)


def test_hundred(tmp_path):
    """Ten of the hundred in a tenth of the box: bending, contact and gravity together fall in every step, centres sink."""
    words = "-domain_box 0,9,0,12.8 -domain_cells 45,64 -vesicle_count 10 -time_step .5 -time_end 4"
    series = run_file("hundred", tmp_path, words)
    energy = sum(series[f"energy_{name}"] for name in ("bending", "contact", "gravity"))
    assert np.diff(energy).max() < 0 and series["center_y"][-1] < series["center_y"][0] - 0.1
    assert max(np.abs(series[f"{name}_error"]).max() for name in ("area", "length")) < 1e-10


def test_constriction(tmp_path):
    """The exact pressure drop of a throat without a vesicle, to .1 %; with one it takes more."""
    words = f"-obstacle_throat {constriction.EMPTY}"
    empty = f"{words} -vesicle_shape none -allow_unused_options true -time_end .01"
    series = run_file("constriction", tmp_path / "empty", empty)
    assert series["pressure_drop"][-1] == pytest.approx(constriction.EXACT, rel=1e-3)
    assert constriction.lubrication(0.999999) == pytest.approx(36, rel=1e-5), "a channel without bumps"
    series = run_file("constriction", tmp_path / "vesicle", f"{words} -vesicle_markers 45 -time_step .02 -time_end .1")
    assert series["pressure_drop"][-1] > constriction.EXACT


def test_stenosis(tmp_path):
    """Twenty vesicles keep the symmetry of the flow; their first drop is the finer grid's."""
    series = run_file("stenosis", tmp_path, "-time_step .02 -time_end .26")
    x = np.array([series[f"center_x_{k + 1}"][-1] for k in range(stenosis.COUNT)])
    assert stenosis.asymmetry(x) < 1e-6 < 0.1 < stenosis.asymmetry(np.arange(stenosis.COUNT))
    assert np.interp(0.25, series["time"], series["pressure_drop"]) == pytest.approx(124.44, rel=2e-3)
