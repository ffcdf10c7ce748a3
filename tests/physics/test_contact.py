"""Repulsion and adhesion between membranes in whole runs."""

import numpy as np
import pytest
from harness import run_petves
from restarts import agree

BASE = "-fluid_inertia none -vesicle_count 2 -vesicle_semi_axes 0.4,0.8 -vesicle_bending 0.05 -vesicle_markers 21 "
BASE += "-vesicle_allow_close_markers -domain_bc_x periodic -domain_box -1.35,1.35,-1.35,1.35 -domain_cells 24,24 "
BASE += "-coupling_box_part false "
#: Near one another, over the seam, and near a wall.
TOUCHING = BASE + "-vesicle_center -0.45,0,0.45,0.3 -contact_repulsion 30 -contact_repulsion_range 0.3 "
STICKY = "-contact_adhesion 1 -contact_adhesion_range 0.2 "


def test_ranks_restart_and_tolerances(tmp_path):
    """The springs are in the matrix, the pull in the right-hand side."""
    options = TOUCHING + STICKY + "-flow_type shear -time_step 0.02"
    names = ("energy_bending", "energy_contact", "gap", "center_x_1", "center_y_2")
    tight = agree(tmp_path, f"{options} -coupled_ksp_rtol 1e-12", 0.04, 0.06, names, abs=1e-9)["whole"].series
    loose = run_petves(tmp_path / "loose", f"{options} -time_end 0.06").series
    assert (loose["energy_contact"] != 0).all()
    for name in names:
        assert loose[name] == pytest.approx(tight[name], rel=0, abs=1e-5 * max(np.abs(tight[name]).max(), 1)), name


@pytest.mark.parametrize("order", [1, 3])
def test_energy_falls_at_rest(order, tmp_path):
    """Stiff springs in long steps: bending and contact together lose energy, and the membranes part."""
    options = TOUCHING.replace("repulsion 30", "repulsion 3000") + f"-scheme_order {order} -time_step 0.1 -time_end 0.5"
    series = run_petves(tmp_path / "run", options).series
    energy = series["energy_bending"] + series["energy_contact"]
    assert series["energy_contact"][0] > 10 * series["energy_bending"][0]
    assert (np.diff(energy) < 0).all() and series["energy_contact"][-1] < 0.1 * series["energy_contact"][0]
    assert series["gap"][1:].min() > 2 * series["gap"][0]


def test_sticking_membranes(tmp_path):
    """Two vesicles in the band give energy of contact away, and their centres come closer than without adhesion."""
    options = BASE + "-vesicle_center -0.45,0,0.45,0 -contact_repulsion 30 -contact_repulsion_range 0.06 "
    options = options.replace("-domain_bc_x periodic ", "").replace("1.35", "2.7")
    options += "-time_step 0.05 -time_end 0.2 "
    series = run_petves(tmp_path / "run", options + STICKY).series
    free = run_petves(tmp_path / "free", options).series
    assert series["energy_contact"][0] < 0 and (np.diff(series["energy_contact"]) < 0).all()
    apart, freely = (s["center_x_2"] - s["center_x_1"] for s in (series, free))
    assert apart[-1] < freely[-1] - 1e-3 and series["gap"].min() > 0.06, apart


def least_inside(run):
    """Least distance of the vesicle's last markers that are an eighth of its length or more apart along it."""
    x = run.saved("vesicle/markers")[-1] @ [1, 1j]
    steps = np.abs(np.subtract.outer(np.arange(len(x)), np.arange(len(x))))
    far = np.minimum(steps, len(x) - steps) >= len(x) // 8
    return np.abs(np.subtract.outer(x, x))[far].min()


def test_sides_of_a_thin_cell_stay_apart(tmp_path):
    """The middle of a thin vesicle that becomes a dumbbell closes slowly; a repulsion holds it, and energy still falls."""
    options = "-fluid_inertia none -vesicle_count 1 -vesicle_area 0.6 -vesicle_reduced_area 0.2 -vesicle_markers 61 "
    options += "-vesicle_bending 0.05 -domain_bc_x periodic -domain_box -2,2,-2,2 -domain_cells 32,32 "
    options += "-time_step 0.5 -time_end 20 "
    free = run_petves(tmp_path / "free", options)
    held = run_petves(tmp_path / "held", options + "-contact_repulsion 30 -contact_repulsion_range 0.15")
    series = held.series
    energy = series["energy_bending"] + series["energy_contact"]
    assert (np.diff(energy) < 0).all() and series["energy_contact"].min() > 0
    assert least_inside(free) < 0.1 and 0.13 < least_inside(held) < 0.15
