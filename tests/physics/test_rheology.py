"""Stress of a sheared channel from its walls and from the membranes' forces, in the dilute limit too; profiles."""

import numpy as np
import pytest
from harness import ROOT, run_petves
from petves import rheology
from petves.run import Run

EXACT = "-fluid_inertia none "
CHANNEL = EXACT + "-domain_box 0,4,0,4 -domain_cells 32,32 -domain_bc_x periodic -flow_type shear -flow_rate 2 "
CHANNEL += "-vesicle_count 2 -vesicle_area 1 -vesicle_angle 25 -vesicle_bending 0.05 -vesicle_markers 31 "
CHANNEL += "-vesicle_allow_close_markers -coupling_box_part false -time_step 0.02 -time_end 0.1 -output_every 0.05 "
APART = "-vesicle_center 0.8,2,2.7,2.4 "
#: Pushing one another over the seam.
SEAM = "-vesicle_center 0.1,2,2.3,2.4 -contact_repulsion 20 -contact_repulsion_range 0.6 "


#: Of two ratios of the viscosities.
UNLIKE = "-vesicle_viscosity_ratio 5,.3 "
LEAKS = UNLIKE + "-membrane_permeability .1 -membrane_osmotic 2,1 "
POST = "-coupling_box_part true -obstacle_shape posts -obstacle_radius 0.45 -obstacle_center 3.5,.9 "


@pytest.mark.parametrize("options, ranks", [(APART, 2), (APART + UNLIKE, 1), (APART + POST, 3), (SEAM, 1), (SEAM, 3)])
def test_walls_agree_with_stresslets(options, ranks, tmp_path):
    """To rounding; and with what Python makes of the saved markers and tensions, to the error of the step."""
    run = run_petves(tmp_path / "run", CHANNEL + options, ranks)
    series = run.series
    for name in ("viscosity", "normal_stress"):
        np.testing.assert_allclose(series[f"{name}_wall"], series[name], rtol=1e-9)
    if "posts" in options:  # their moment along x depends on where x = 0 is
        assert np.isnan(series["normal_stress"]).all()
        return
    assert (series["viscosity"] > 1.1).all()
    if "repulsion" not in options:
        total = rheology.stresslets(Run.read(run.folder), -1).sum(axis=0) / -16
        assert abs(1 + total[0, 1] / 2 - series["viscosity"][-1]) < 2e-3 and abs(total[0, 1] - total[1, 0]) < 1e-12
        assert abs(total[0, 0] - total[1, 1] - series["normal_stress"][-1]) < 5e-3


#: Vesicles .4, .5 and 1.3 cells from a wall, and one in the middle.
BOTTOM, TOP = "-vesicle_center 0.8,0.55,2.7,2.4 ", "-vesicle_center 0.8,2,2.7,3.45 "
BOTH = "-vesicle_center 0.8,0.5,2.7,3.5 -vesicle_angle 6 -contact_repulsion 5 "


@pytest.mark.parametrize("options, ranks", [(BOTTOM, 1), (TOP + LEAKS, 3), (BOTH, 2), (TOP, 1)])
def test_walls_agree_with_stresslets_next_to_walls(options, ranks, tmp_path):
    """Where stencils are folded and scaled: what the fluid on the grid does not feel of a force acts on the wall."""
    series = run_petves(tmp_path / "run", CHANNEL + options + " -time_end 0.04", ranks).series
    assert 0 < series["gap"][-1] < 1.5 / 8 and len(series["gap"]) == 3
    for name in ("viscosity", "normal_stress"):
        np.testing.assert_allclose(series[f"{name}_wall"], series[name], rtol=1e-12)


def test_contact_over_the_seam_is_contact_inside(tmp_path):
    """The same scene moved along the channel has the same stress."""
    there = run_petves(tmp_path / "there", CHANNEL + SEAM + "-coupled_ksp_rtol 1e-10").series
    moved = SEAM.replace("0.1,2,2.3,2.4", "1.1,2,3.3,2.4")
    here = run_petves(tmp_path / "here", CHANNEL + moved + "-coupled_ksp_rtol 1e-10").series
    for name in ("viscosity", "normal_stress", "energy_contact"):
        np.testing.assert_allclose(here[name], there[name], rtol=1e-6, err_msg=name)


def test_dilute_limit(tmp_path):
    """One vesicle in a channel of 20 R0 adds to the viscosity what it does in unbounded fluid, to 1 %."""
    scene = f"-options_file {ROOT}/runs/free.opts {EXACT} -time_end 12 -output_every 12 "
    free = Run.read(run_petves(tmp_path / "free", scene).folder)
    box = "-domain_box -6.75,6.75,-6.75,6.75 -domain_cells 48,48 -domain_bc_x periodic -domain_bc_y wall "
    channel = run_petves(tmp_path / "channel", scene + box + "-vesicle_allow_close_markers").series
    stresslet = rheology.stresslets(free, -1)[0]
    for name in ("viscosity", "viscosity_wall"):
        added = (channel[name][-1] - 1) * 13.5**2
        assert abs(added / (-stresslet[0, 1] / 0.326116) - 1) < 0.01, added
    assert "viscosity" not in free.series or np.isnan(free.series["viscosity"]).all()


def test_profiles(tmp_path):
    """Areas add up, the fluid at the walls goes with them, nothing has moved at lag 0."""
    run = Run.read(run_petves(tmp_path / "run", CHANNEL + APART + "-time_end 0.08 -output_every 0.04").folder)
    y, part = rheology.area_fraction_profile(run, -1, 16)
    assert abs(part.mean() * 16 - run.series["area"][-1]) < 0.03 and part[0] == part[-1] == 0 and part.max() < 1
    assert abs(y[0] - 0.125) < 1e-12
    y, u = rheology.velocity_profile(run, -1)
    assert len(y) == 32 and abs(u[-1] - u[0] - 2 * (y[-1] - y[0])) < 0.4
    lag, squares = rheology.mean_square_displacement(run)
    assert (squares[0] == 0).all() and (squares[1:] > 0).all() and len(lag) == len(run.time) == 3
    steps = np.diff(rheology.centers(run), axis=0)
    np.testing.assert_allclose(squares[1], np.mean(steps**2, axis=(0, 1)))
