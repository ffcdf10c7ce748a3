"""Repulsion and adhesion between membranes, and a potential that draws them together: energy, periods of a turning doublet, ranks,
restarts, seams."""

import math

import numpy as np
import pytest
from harness import REFERENCES, run_petves
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


UNBOUNDED = "-domain_bc_x free -domain_bc_y free -domain_cells 32,32 -domain_box -4,4,-4,4 -output_every 1e9"
PAIR = f"-vesicle_count 2 -vesicle_area {0.9 * math.pi!r} -vesicle_reduced_area .9 -vesicle_angle 90 -vesicle_bending 1"
BOUND = "-vesicle_center -.925,0,.925,0 -contact_potential_distance .4"
SMALL = PAIR.replace(f"{0.9 * math.pi!r}", ".8").replace("-vesicle_bending 1", "-vesicle_bending .1 ")
SMALL += "-domain_bc_x periodic -domain_cells 48,48 -domain_box -3,3,-3,3 -flow_type shear -contact_potential 2 -contact_potential_distance .4 -time_step .05"


@pytest.mark.parametrize(("rate", "H"), [(r, H) for r in ("0.5", "1") for H in ("1.5", "3.5")])
def test_period_of_a_doublet(tmp_path, rate, H):
    """Quaife, Veerapaneni and Young 2019, V = .9: the pair turns as a whole, its period to 1 % of theirs."""
    period = REFERENCES["doublets"][rate][H]
    options = f"-flow_type shear -flow_rate {rate} -contact_potential {H} -time_step .05 -time_end {1.3 * period}"
    run = run_petves(tmp_path, f"{UNBOUNDED} {PAIR} {BOUND} {options}")
    x, y = (run.series[f"center_{c}_2"] - run.series[f"center_{c}_1"] for c in "xy")
    turned = -np.unwrap(np.arctan2(y, x))
    first, last = (np.interp(t, turned, run.series["time"]) for t in (math.pi / 4, 9 * math.pi / 4))
    assert last - first == pytest.approx(period, rel=0.01)
    assert run.series["coupled_its"][6:].mean() < 4


def test_energy_of_a_doublet_falls(tmp_path):
    """At rest, to a minimum in which the pair has flat sides; its contact energy is the sum over markers."""
    run = run_petves(tmp_path, f"{UNBOUNDED} {PAIR} {BOUND} -contact_potential 2 -time_step .05 -time_end 5")
    energy = run.series["energy_bending"] + run.series["energy_potential"]
    assert np.all(np.diff(energy) < 1e-6 * abs(energy[0])) and energy[-1] < energy[0] - 0.1
    X = run.saved("vesicle/markers", "run.h5")[-1].reshape(2, -1, 2)
    z = 0.4 / np.linalg.norm(X[0][:, None] - X[1][None], axis=-1)
    energy = 2 * np.sum(z**4 - 2 * z**2) * (2 * math.pi / len(z)) ** 2
    assert run.series["energy_potential"][-1] == pytest.approx(energy)


def test_beside_a_free_body(tmp_path):
    """A repulsion that reaches nothing changes nothing, nor do the two forces take one another's place."""
    scene = f"{SMALL} -vesicle_center -.6,.1,.55,0 -obstacle_shape posts -obstacle_radius .5 -obstacle_center 1.8,0"
    scene += " -obstacle_free all -time_end .2"
    repulsion = "-contact_repulsion 1 -contact_repulsion_range .01"
    alone, both = (run_petves(tmp_path / str(len(more)), f"{scene} {more}").series for more in ("", repulsion))
    for name in ("energy_potential", "center_x_1", "obstacle_velocity_x_1", "coupled_its"):
        assert np.array_equal(alone[name], both[name])
    assert "energy_contact" in both and not both["energy_contact"].any()


def test_potential_on_ranks_after_a_restart_and_over_seams(tmp_path):
    """In a channel, and the same with the pair over the seam of its period."""
    names = ("center_y_1", "inclination_2", "energy_potential", "viscosity", "normal_stress")
    scene = f"{SMALL} -coupled_ksp_rtol 1e-12 -vesicle_center"
    found = agree(tmp_path, f"{scene} -.6,.1,.55,0", 0.2, 0.4, names, (3,))["whole"].series
    over = run_petves(tmp_path / "seam", f"{scene} 2.4,.1,3.55,0 -time_end .4").series
    for name in names:
        assert over[name] == pytest.approx(found[name], rel=1e-8, abs=1e-9, nan_ok=True)
