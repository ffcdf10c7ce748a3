"""The baseline schemes: penalty (Kim and Lai 2010), and split with explicit bending."""

import re

import numpy as np
import pytest
from harness import PAPER, run_petves
from restarts import frames, same_columns

pytestmark = pytest.mark.xdist_group("baselines")  # its tests share runs

SCENE = "-domain_cells 32,32 -vesicle_angle 20 -flow_type shear"
H = 2 / 32
END = 0.125
BOTH = "-tension_ksp_rtol 1e-12 -bending_ksp_rtol 1e-12"

#: Bounds of docs/split.md with ib6, nu = 1.
SPRINGS = lambda dt: 50 * H / dt + 100 * H**3 / dt**2  # noqa: E731
BENDING = lambda dt: 43 * H**3 / dt + 45 * H**5 / dt**2  # noqa: E731


def markers(folder, options: str) -> np.ndarray:
    """Markers at the end of a run with the paper's membrane."""
    run = run_petves(folder, f"{SCENE} -time_end {END} -output_every {END} {options}")
    return frames(run.folder)["vesicle/markers"][-1]


@pytest.fixture(scope="module")
def unsplit(tmp_path_factory):
    """What every scheme with the paper's membrane tends to on this grid: split at two fine steps, its first order taken off."""
    folder = tmp_path_factory.mktemp("unsplit")
    coarse, fine = (markers(folder / f"{n}", f"{PAPER} {BOTH} -time_step {END / n}") for n in (512, 1024))
    return 2 * fine - coarse


def test_penalty_tends_to_the_unsplit_scheme_with_the_step(unsplit, tmp_path):
    """With its default springs, which stiffen at least as 1/dt: first order or better."""
    steps = (32, 64, 128, 256)
    error = [np.abs(markers(tmp_path / f"{n}", f"-scheme_type penalty -time_step {END / n}") - unsplit) for n in steps]
    error = np.array([e.max() for e in error])
    assert (error[:-1] / error[1:] > 1.9).all()
    assert error[-1] < 1e-3 * H


def test_penalty_tends_to_the_unsplit_scheme_with_the_springs(unsplit, tmp_path):
    """What they stretch goes as 1/sigma_0 while the error of the step, of the size of the last one above, is small."""
    stiffness = (100, 400, 1600)
    options = f"-scheme_type penalty -time_step {END / 1024} -penalty_stiffness"
    error = [np.abs(markers(tmp_path / f"{k}", f"{options} {k}") - unsplit).max() for k in stiffness]
    assert error[0] > 2.5 * error[1] > 2.5**2 * error[2]


@pytest.mark.parametrize("dt", [0.1 * H**2, 10 * H**2], ids=["inertial", "viscous"])
def test_explicit_bending_has_a_bound(dt, tmp_path):
    """150 steps at rest: with half the stiffness of the bound bending energy is never above its first value; with half as
    much again as the bound the run is stopped."""
    options = f"-domain_cells 32,32 -vesicle_angle 20 -scheme_type penalty -time_step {dt} "
    options += f"-time_end {150 * dt} -checkpoint_every 0"
    below = run_petves(tmp_path / "below", f"{options} -vesicle_bending {0.5 * BENDING(dt)}").series
    assert len(below["step"]) == 151 and below["energy_bending"].max() == below["energy_bending"][0]
    above = run_petves(tmp_path / "above", f"{options} -vesicle_bending {1.5 * BENDING(dt)}", good=False)
    assert above.status == 2 and len(above.errors) == 1 and "vesicle 1: " in above.errors[0]


@pytest.mark.parametrize("dt", [0.1 * H**2, 10 * H**2], ids=["inertial", "viscous"])
def test_springs_have_a_bound(dt, tmp_path):
    """150 steps in a weak shear: edges stay equal under the bound, half of which is the default."""
    options = f"{SCENE} -flow_rate {0.2 / (150 * dt)} -scheme_type penalty -vesicle_bending 0 -time_step {dt} "
    options += f"-time_end {150 * dt} -checkpoint_every 0 -view"
    default = run_petves(tmp_path / "default", options)
    stiffness = float(re.search(r"sigma_0 = (\S+)", default.stdout)[1])
    assert abs(stiffness / SPRINGS(dt) - 0.5) < 1e-4
    below = run_petves(tmp_path / "below", f"{options} -penalty_stiffness {0.8 * SPRINGS(dt)}")
    for run in (default, below):
        assert run.series["edge_ratio"].max() < 1.05
    above = run_petves(tmp_path / "above", f"{options} -penalty_stiffness {1.3 * SPRINGS(dt)}", good=False)
    assert above.status == 2 and "edge ratio" in above.errors[0] or above.series["edge_ratio"].max() > 1.5


def test_restart_with_another_step_keeps_the_springs(tmp_path):
    """The default follows the step, so it has to be named."""
    options = f"{SCENE} -scheme_type penalty -checkpoint_every 0"
    first = run_petves(tmp_path / "first", f"{options} -time_step 0.004 -time_end 0.04 -view")
    options += f" -restart {first.folder}/checkpoint.h5 -time_step 0.002 -time_end 0.06"
    refused = run_petves(tmp_path / "refused", options, good=False)
    assert refused.status == 1 and "-penalty_stiffness" in refused.errors[0]
    value = first.resolved["-penalty_stiffness"]
    assert len(run_petves(tmp_path / "good", f"{options} -penalty_stiffness {value}").series["step"]) == 11


@pytest.mark.parametrize("flow, solves", [("shear -domain_bc_x periodic", 2), ("poiseuille -flow_half_width 1", 3)])
def test_penalty_on_ranks(flow, solves, tmp_path):
    """1 and 3 ranks: every column but wall to 1e-10; two scalar solves a step in a channel, three between four walls,
    and none for the membrane."""
    options = f"-domain_cells 40,40 -vesicle_angle 20 -flow_type {flow} -scheme_type penalty -time_step 0.01"
    one, other = (run_petves(tmp_path / f"{n}", f"{options} -time_end 0.2", n).series for n in (1, 3))
    assert len(one["step"]) == 21 and (one["nsolve"][1:] == solves).all()
    assert not (one["tension_its"] + one["bending_its"] + one["coupled_its"]).any()
    same_columns(one, other, 1e-10)


def test_penalty_in_the_total_form(tmp_path):
    """Walls that move with the background flow, as far from the vesicle as the disturbance form's are."""
    scene = f"{SCENE} -scheme_type penalty -time_step {END / 64} -time_end {END} -fluid_viscosity 0.5 -flow_form"
    series = {form: run_petves(tmp_path / form, f"{scene} {form}").series for form in ("disturbance", "total")}
    for name in ("area", "length", "inclination", "energy_bending", "energy_kinetic", "edge_ratio"):
        np.testing.assert_allclose(series["total"][name], series["disturbance"][name], rtol=0, atol=1e-9, err_msg=name)
    assert series["total"]["div_max"].max() < 1e-10


def test_penalty_without_vesicle_is_the_projection_step(tmp_path):
    """No springs, nothing to move: three solves a step, and fluid at rest stays there."""
    run = run_petves(tmp_path / "run", "-domain_cells 16,16 -vesicle_shape none -scheme_type penalty -time_end 0.02")
    assert (run.series["nsolve"][1:] == 3).all() and (run.series["energy_kinetic"] == 0).all()
