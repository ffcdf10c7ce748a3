"""Vesicles that a potential draws together: periods of a turning doublet, energy, ranks, restarts, seams."""

import math

import numpy as np
import pytest
from harness import REFERENCES, run_petves
from restarts import agree

FREE = "-domain_bc_x free -domain_bc_y free -domain_cells 32,32 -domain_box -4,4,-4,4 -output_every 1e9"
PAIR = f"-vesicle_count 2 -vesicle_area {0.9 * math.pi!r} -vesicle_reduced_area .9 -vesicle_angle 90 -vesicle_bending 1"
BOUND = "-vesicle_center -.925,0,.925,0 -contact_potential_distance .4"
SMALL = PAIR.replace(f"{0.9 * math.pi!r}", ".8").replace("-vesicle_bending 1", "-vesicle_bending .1 ")
SMALL += "-domain_bc_x periodic -domain_cells 48,48 -domain_box -3,3,-3,3 -flow_type shear -contact_potential 2 -contact_potential_distance .4 -time_step .05"


@pytest.mark.parametrize(("rate", "H"), [(r, H) for r in ("0.5", "1") for H in ("1.5", "3.5")])
def test_period_of_a_doublet(tmp_path, rate, H):
    """Quaife, Veerapaneni and Young 2019, V = .9: the pair turns as a whole, its period to 1 % of theirs."""
    period = REFERENCES["doublets"][rate][H]
    options = f"-flow_type shear -flow_rate {rate} -contact_potential {H} -time_step .05 -time_end {1.3 * period}"
    run = run_petves(tmp_path, f"{FREE} {PAIR} {BOUND} {options}")
    x, y = (run.series[f"center_{c}_2"] - run.series[f"center_{c}_1"] for c in "xy")
    turned = -np.unwrap(np.arctan2(y, x))
    first, last = (np.interp(t, turned, run.series["time"]) for t in (math.pi / 4, 9 * math.pi / 4))
    assert last - first == pytest.approx(period, rel=0.01)
    assert run.series["coupled_its"][6:].mean() < 4


def test_energy_of_a_doublet_falls(tmp_path):
    """At rest, to a minimum in which the pair has flat sides; its contact energy is the sum over markers."""
    run = run_petves(tmp_path, f"{FREE} {PAIR} {BOUND} -contact_potential 2 -time_step .05 -time_end 5")
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


def test_ranks_restart_and_seams(tmp_path):
    """In a channel, and the same with the pair over the seam of its period."""
    names = ("center_y_1", "inclination_2", "energy_potential", "viscosity", "normal_stress")
    scene = f"{SMALL} -coupled_ksp_rtol 1e-12 -vesicle_center"
    found = agree(tmp_path, f"{scene} -.6,.1,.55,0", 0.2, 0.4, names, (3,))["whole"].series
    over = run_petves(tmp_path / "seam", f"{scene} 2.4,.1,3.55,0 -time_end .4").series
    for name in names:
        assert over[name] == pytest.approx(found[name], rel=1e-8, abs=1e-9, nan_ok=True)
