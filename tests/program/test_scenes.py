"""The option files of runs/: each says how to run it and starts; ours reach their expected numbers."""

import re

import numpy as np
import pytest
from harness import ROOT, run_petves

from petves.run import Run as Files
from studies.common.curves import at, radius
from studies.common.scenes import option_file
from studies.reproduction.convergence import differences
from studies.reproduction.scene_figures import keller_skalak

SCENES = ("energy", "relax", "shear_convergence", "equilibrium", "poiseuille", "shear")
TWO = ("default", "two_vesicles", "suspension", *(f"paper/{name}" for name in SCENES))
RANKS = {f"{name}.opts": 1 for name in (*SCENES, "free")} | {f"{name}.opts": 2 for name in TWO}
QUIET = {name for name, ranks in RANKS.items() if ranks == 1} - {"shear_convergence.opts"}


def run_file(name, folder, options="", ranks=1):
    """Run a file of runs/ as it is, but for the options given."""
    return run_petves(folder, f"-options_file {ROOT / 'runs' / name} {options}", ranks)


@pytest.mark.parametrize("name", RANKS)
def test_file_starts(name, tmp_path):
    """The header has the command; two steps solve the constraints and keep area and length. The first tenth of QUIET does
    not warn."""
    text = (ROOT / "runs" / name).read_text()
    assert f"mpirun -n {RANKS[name]} bin/petves -options_file runs/{name}" in text
    dt, whole = (float(re.search(rf"^-time_{what} (\S+)", text, re.MULTILINE)[1]) for what in ("step", "end"))
    end = whole / 10 if name in QUIET else 2 * dt
    shorter = "-domain_box 0,12,0,6 -domain_cells 384,192" if name == "paper/poiseuille.opts" else ""  # of 384, 12
    run = run_file(name, tmp_path, f"-time_end {end!r} {shorter}", RANKS[name])
    series = run.series
    assert series["time"][-1] == pytest.approx(end) and not (name in QUIET and run.summary["warnings"])
    assert max(np.abs(series[f"{what}_error"][:3]).max() for what in ("area", "length")) < 1e-3
    assert series["div_max"].max() < 1e-8


def test_equilibrium_reaches_its_energy(tmp_path):
    """runs/equilibrium.opts: E_B R0/c_b of the boundary integral, 6.24184, to 0.1 percent."""
    series = run_file("equilibrium.opts", tmp_path).series
    radius = (1 / (0.7 * np.pi)) ** 0.5
    assert series["energy_bending"][-1] * radius / 0.01 == pytest.approx(6.24184, rel=1e-3)


@pytest.mark.parametrize(
    "file, rate", [("shear", 0.326116), ("redcell", 10 * 2e-16 / (1.6e-11 / (0.7 * np.pi)) ** 1.5)]
)
def test_shear_reaches_its_angle(file, rate, tmp_path):
    """Inclination and frequency of the boundary integral, to 0.1 percent; one of them in metres and seconds."""
    series = run_file(f"{file}.opts", tmp_path).series
    assert series["inclination"][-1] / np.pi == pytest.approx(0.12343, rel=1e-3)
    assert series["frequency"][-1] / rate == pytest.approx(0.31665, rel=1e-3)


def test_poiseuille_migrates_inwards(tmp_path):
    """runs/poiseuille.opts from c_0 = R0: half a radius inwards at t = 96 to 0.05; from -R0 as far on the other side."""
    above = run_file("poiseuille.opts", tmp_path / "above").series
    below = run_file("poiseuille.opts", tmp_path / "below", "-vesicle_center 6,2.325664 -time_end 9.6").series
    height = (above["center_y"] - 3) / 0.674336
    assert height[[0, -1]] == pytest.approx([1, 0.505], abs=0.05)
    assert (3 - below["center_y"]) / 0.674336 == pytest.approx(height[: len(below["time"])], abs=1e-4)


@pytest.mark.parametrize("derivative", ["spectral", "fd"])
def test_tension_is_where_it_is_said_to_be(derivative, tmp_path):
    """The relaxing ellipse is its own mirror image, so tension against the phase angle is even; half an edge off it is not."""
    run_file("relax.opts", tmp_path, f"-membrane_derivative {derivative}")
    run = Files.read(tmp_path)
    angle, tension = run.phase_angle(-1), run.tension[-1]
    there = np.interp(-angle, angle, tension, period=2 * np.pi)
    assert np.abs(there - tension).max() < 0.02 * np.ptp(tension)


def test_option_files_are_read():
    """Comments and the output folder are left out; values keep their text."""
    options = option_file("shear")
    assert options["-domain_box"] == "-4,12,0,8" and options["-flow_rate"] == "0.326116"
    assert "-output_dir" not in options


def test_ellipses_of_keller_and_skalak():
    """atan(b/a)/pi and a b/(a^2 + b^2) of ellipses whose reduced area a series gives; a circle: 1/4 and 1/2."""
    for a, b in ((1.0, 0.99), (1.0, 0.5), (1.0, 0.3)):
        turn = np.linspace(0, 2 * np.pi, 4000, endpoint=False)
        length = np.hypot(a * np.sin(turn), b * np.cos(turn)).mean() * 2 * np.pi
        angle, frequency = keller_skalak(np.array(a * b * np.pi / (np.pi * (length / (2 * np.pi)) ** 2)))
        assert angle == pytest.approx(np.arctan(b / a) / np.pi, abs=2e-3)
        assert frequency == pytest.approx(a * b / (a**2 + b**2), abs=2e-3)
    assert radius(0.7) == pytest.approx(0.67434, abs=1e-5)


def _state(cells, markers, shift=0.0):
    """A smooth field and curve on a 2 x 2 box, at the centres and markers of one resolution."""
    x = -1 + 2 * (np.arange(cells) + 0.5) / cells
    field = np.sin(np.pi * x)[None, :] * np.cos(np.pi * x)[:, None]
    turn = 2 * np.pi * np.arange(markers) / markers
    curve = np.stack([0.2 * np.cos(turn) + shift, 0.5 * np.sin(turn)], axis=1)
    tension = np.cos(turn - np.pi / markers)  # at the edges' midpoints
    return {"u": field, "v": field, "p": field, "dp": field, "markers": curve, "tension": tension, "omega": np.nan}


def test_differences_of_one_function_on_two_grids():
    """Sampling alone makes a difference of second order in the fields and none on the membrane; a shift shows as itself."""
    fine = _state(128, 96)
    errors = [differences(_state(n, n), fine, 2 / n) for n in (16, 32)]
    assert errors[0]["u"] < 2 * (np.pi / 128) ** 2 / 4 * 2 and errors[0]["u"] == pytest.approx(errors[1]["u"], rel=0.05)
    assert max(errors[0][name] for name in ("X", "Y", "sigma")) < 1e-6
    slope = 0.5 * 2 * np.pi / 16 / 2**0.5 * 2.3**0.5  # of cos(turn), half an edge, in the L2 norm
    assert errors[0]["sigma_half"] == pytest.approx(slope, rel=0.03)
    moved = differences(_state(32, 33, 0.01), fine, 1 / 16)
    points = _state(32, 33)["markers"]
    perimeter = np.hypot(*(np.roll(points, -1, axis=0) - points).T).sum()
    assert moved["X"] == pytest.approx(0.01 * perimeter**0.5, rel=1e-6) and moved["Y"] < 1e-6


def test_values_between_markers_are_trigonometric():
    turn = np.arange(9) / 9
    place = np.array([0.03, 0.5, 0.97, 1.2])
    values = np.stack([np.cos(2 * np.pi * turn), np.sin(6 * np.pi * turn)], axis=1)
    expected = np.stack([np.cos(2 * np.pi * place), np.sin(6 * np.pi * place)], axis=1)
    np.testing.assert_allclose(at(values, place), expected, atol=1e-6)
