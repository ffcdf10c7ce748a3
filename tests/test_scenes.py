"""The option files of runs/: each says how to run it and starts; ours reach their expected numbers."""

import re

import numpy as np
import pytest
from conftest import PETVES, ROOT, Run, mpirun

SCENES = ("energy", "relax", "shear_convergence", "equilibrium", "poiseuille", "shear")
RANKS = {f"{name}.opts": 1 for name in SCENES} | {"default.opts": 2, "two_vesicles.opts": 2}
RANKS |= {f"paper/{name}.opts": 2 for name in SCENES}


def run_file(name, folder, options="", ranks=1):
    """Run a file of runs/ as it is, but for the options given."""
    words = ["-options_file", str(ROOT / "runs" / name), "-output_dir", str(folder), *options.split()]
    done = mpirun([PETVES, *words], ranks, 300)
    assert done.returncode == 0, f"{name}\n{done.stdout}\n{done.stderr}"
    return Run(folder, done.returncode, done.stdout, done.stderr)


@pytest.mark.parametrize("name", RANKS)
def test_file_starts(name, tmp_path):
    """The header has the command; two steps solve the constraints and keep area and length."""
    text = (ROOT / "runs" / name).read_text()
    assert f"mpirun -n {RANKS[name]} bin/petves -options_file runs/{name}" in text
    dt = float(re.search(r"^-time_step (\S+)", text, re.MULTILINE)[1])
    shorter = "-domain_box 0,12,0,6 -domain_cells 384,192" if name == "paper/poiseuille.opts" else ""  # of 384, 12
    series = run_file(name, tmp_path, f"-time_end {2 * dt!r} {shorter}", RANKS[name]).series
    assert series["time"][-1] == pytest.approx(2 * dt)
    assert max(abs(series["area_error"][-1]), abs(series["length_error"][-1])) < 1e-3
    assert series["div_max"].max() < 1e-8


def test_equilibrium_reaches_its_energy(tmp_path):
    """runs/equilibrium.opts: E_B R0/c_b of the boundary integral, 6.24184, to 0.1 percent."""
    series = run_file("equilibrium.opts", tmp_path).series
    radius = (1 / (0.7 * np.pi)) ** 0.5
    assert series["energy_bending"][-1] * radius / 0.01 == pytest.approx(6.24184, rel=1e-3)


def test_shear_reaches_its_angle(tmp_path):
    """runs/shear.opts: inclination and frequency of the boundary integral, to 0.4 percent."""
    series = run_file("shear.opts", tmp_path).series
    assert series["inclination"][-1] / np.pi == pytest.approx(0.12559, rel=4e-3)
    assert series["frequency"][-1] / 0.326116 == pytest.approx(0.31938, rel=4e-3)


@pytest.mark.parametrize("sign", [1, -1])
def test_poiseuille_migrates_inwards(sign, tmp_path):
    """runs/poiseuille.opts from c_0 = R0 and -R0: mirror images, half a radius inwards at t = 96 to 0.05."""
    center = "" if sign > 0 else "-vesicle_center 6,2.325664"
    height = (run_file("poiseuille.opts", tmp_path, center).series["center_y"] - 3) / 0.674336
    assert height[[0, -1]] * sign == pytest.approx([1, 0.505], abs=0.05)
