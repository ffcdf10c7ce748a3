"""Scheme coupled as runs: on any number of ranks, for any number of vesicles; what is wrong with options or a step is said."""

import numpy as np
import pytest
from harness import run_petves
from refusals import SMALL
from restarts import last_state, same_columns, same_state

pytestmark = pytest.mark.xdist_group("coupled_runs")  # its tests share runs

TIGHT = "-coupled_ksp_rtol 1e-12"

CHANNEL = "-domain_cells 60,48 -domain_box 0,2.5,-1,1 -domain_bc_x periodic -vesicle_center 2.4,0.1"
TWO = "-vesicle_count 2 -vesicle_semi_axes 0.2,0.4"

SCENES = {
    "walls": "-domain_cells 48,48 -vesicle_angle 20",
    "channel": f"{CHANNEL} -flow_type poiseuille -flow_half_width 1 -vesicle_semi_axes 0.3,0.45",
    "two_vesicles": f"-domain_cells 60,60 -flow_type shear {TWO} -vesicle_center -0.35,0,0.35,0.05",
}


@pytest.mark.parametrize("scene", SCENES)
def test_ranks_agree(scene, cached_run):
    """1 and 3 ranks over 20 steps at rtol 1e-12: every physical column and the last state to 1e-9."""
    options = f"{SCENES[scene]} -time_step 0.02 -time_end 0.4 {TIGHT}"
    one = cached_run(options, 1)
    assert len(one.series["step"]) == 21
    other = cached_run(options, 3)
    same_columns(one.series, other.series, 1e-9, ("wall", "coupled_its", "nsolve"))
    same_state(last_state(one.folder), last_state(other.folder), 1e-9)
    assert np.abs(other.series["coupled_its"] - one.series["coupled_its"]).max() <= 1
    assert one.series["div_max"].max() < 1e-9 and one.series["surface_div_max"].max() < 1e-9


def test_two_vesicles_are_two(tmp_path):
    """Columns of each, totals, mirror symmetry; split takes them too, and a file with two curves is the same scene."""
    options = "-domain_cells 64,64 -flow_type shear -time_step 0.01 -time_end 0.05"
    pair = f"{TWO} -vesicle_markers 44 -vesicle_center -0.375,0,0.375,0"
    t = 2 * np.pi * np.arange(200) / 200
    curve = [f"{0.2 * np.cos(a):.15g} {0.4 * np.sin(a):.15g}" for a in t]
    (tmp_path / "two.txt").write_text("\n".join(["# first", *curve, "", "# second", *curve]) + "\n")
    for scheme in ("-scheme_type coupled", "-scheme_type split"):
        run = run_petves(tmp_path / scheme[-5:], f"{options} {pair} {scheme}")
        series, state = run.series, last_state(run.folder)
        half = len(state["vesicle/tension"][0]) // 2
        np.testing.assert_allclose(series["area"], series["area_1"] + series["area_2"], rtol=1e-12)
        np.testing.assert_allclose(series["length"], series["length_1"] + series["length_2"], rtol=1e-12)
        np.testing.assert_allclose(series["center_x_1"], -series["center_x_2"], rtol=0, atol=1e-5)
        np.testing.assert_allclose(series["inclination_1"], series["inclination_2"], rtol=0, atol=1e-4)
        # the second vesicle is the first turned by half a turn, which moves marker k to k + M/2
        turned = -np.roll(state["vesicle/markers"][0, half:], half // 2, axis=0)
        np.testing.assert_allclose(turned, state["vesicle/markers"][0, :half], rtol=0, atol=1e-5)
        file = f"{options} {scheme} -vesicle_markers 44 -vesicle_shape file -vesicle_file {tmp_path}/two.txt -view"
        same = run_petves(tmp_path / f"file{scheme[-5:]}", f"{file} -vesicle_center -0.375,0,0.375,0")
        same_state(state, last_state(same.folder), 1e-4, ("vesicle/markers",))
        assert "vesicle 2" in same.stdout


def test_far_vesicles_do_as_one(tmp_path):
    """A second vesicle a long way down the channel changes nothing: the disturbance decays in 3 half widths."""
    box = "-domain_cells 240,40 -domain_box 0,12,-1,1 -domain_bc_x periodic -time_step 0.02 -time_end 0.1"
    one = run_petves(tmp_path / "one", f"{box} -vesicle_center 3,0 {TIGHT}")
    two = run_petves(tmp_path / "two", f"{box} -vesicle_count 2 -vesicle_center 3,0,9,0 {TIGHT}")
    a, b = last_state(one.folder)["vesicle/markers"][0], last_state(two.folder)["vesicle/markers"][0]
    np.testing.assert_allclose(b[: len(a)], a, rtol=0, atol=1e-6)
    np.testing.assert_allclose(b[len(a) :] - [6, 0], a, rtol=0, atol=1e-6)


def test_options_of_the_solver_work(tmp_path):
    """-coupled_ksp_type and -view: another Krylov method gives the same run."""
    options = f"{SMALL} -scheme_startup euler -coupled_ksp_rtol 1e-11 "
    one = run_petves(tmp_path / "one", f"{options} -view")
    assert "fgmres" in one.stdout
    two = run_petves(tmp_path / "two", f"{options} -coupled_ksp_type gmres -coupled_ksp_pc_side right -view")
    assert "type: gmres" in two.stdout
    same_state(last_state(one.folder), last_state(two.folder), 1e-8)
