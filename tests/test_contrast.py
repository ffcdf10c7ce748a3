"""Viscosity contrast: angle and frequency of the boundary integral, tumbling, the sparse LU, ranks, restarts, scaling."""

import json
import math

import h5py
import numpy as np
import pytest
from conftest import ROOT, run_petves

COUPLED = "-scheme_type coupled -membrane_derivative spectral -delta_type cbs54 -coupling_near_field exact"
COUPLED += " -scheme_area_target true -scheme_order 3 -output_every 100"
R0 = math.sqrt(1 / (0.7 * math.pi))  # of the unit area
SHEAR = f"{COUPLED} -domain_box -4,4,-4,4 -domain_cells 64,64 -flow_type shear -vesicle_area 1"
SHEAR += f" -vesicle_reduced_area 0.7 -vesicle_bending {R0**3 / 10!r} -time_step 0.1"
REFERENCES = json.loads((ROOT / "tests" / "references.json").read_text())["viscosity_ratio"]
SMALL = f"{COUPLED} -domain_box -2,2,-2,2 -domain_cells 32,32 -flow_type shear -vesicle_area 0.5 -vesicle_markers 25"
SMALL += " -vesicle_count 2 -vesicle_center -.6,.2,.6,-.2 -vesicle_angle 60 -vesicle_bending .03 -time_step .1"
SMALL += " -vesicle_viscosity_ratio 5,.3 -time_end .3"
TIGHT = "-coupled_ksp_rtol 1e-12"


def markers(run) -> np.ndarray:
    with h5py.File(run.folder / "checkpoint.h5") as file:
        return np.array([file["vesicle/markers"][k] for k in range(len(file["vesicle/markers"]))])


@pytest.mark.parametrize("ratio", ["2", "0.1"])
def test_steady_angle_and_frequency(tmp_path, ratio):
    """Within .05 % of the boundary integral, in the box of four walls and in unbounded fluid."""
    for place, options in (("box", ""), ("unbounded", "-domain_bc_x free -domain_bc_y free")):
        run = run_petves(tmp_path / place, f"{SHEAR} -vesicle_viscosity_ratio {ratio} -time_end 25 {options}")
        reference = REFERENCES[place][ratio]
        assert run.series["inclination"][-1] / math.pi == pytest.approx(reference["angle"], rel=5e-4)
        assert run.series["frequency"][-1] == pytest.approx(reference["frequency"], rel=5e-4)
        assert run.series["coupled_its"][6:].mean() <= 5


def test_tumbling_half_period(tmp_path):
    """Passes of the long axis through vertical, ratio 10: the half period of the boundary integral within .1 %."""
    run = run_petves(tmp_path / "run", f"{SHEAR} -vesicle_viscosity_ratio 10 -time_end 23")
    angle = np.unwrap(2 * run.series["inclination"]) / 2
    passes = [np.interp(at, -angle, run.series["time"]) for at in (math.pi / 2, 3 * math.pi / 2)]
    assert passes[1] - passes[0] == pytest.approx(REFERENCES["box"]["10"]["half_period"], rel=1e-3)


@pytest.mark.parametrize(
    "walls",
    ["", "-domain_bc_x periodic", "-domain_bc_x periodic -domain_bc_y periodic"],
    ids=["walls", "channel", "periodic"],
)
def test_sparse_lu(tmp_path, walls):
    """coupled solves the equations that direct assembles, two vesicles of different ratios in every kind of box."""
    one = run_petves(tmp_path / "coupled", f"{SMALL} {walls} {TIGHT}")
    other = run_petves(tmp_path / "direct", f"{SMALL} {walls} -scheme_type direct")
    assert np.abs(markers(one) - markers(other)).max() < 1e-9
    assert other.series["div_max"].max() < 1e-11 and one.series["div_max"].max() < 1e-11


def test_ranks_and_restart(tmp_path):
    """The same on 1, 2 and 3 ranks; a restart has the same bits."""
    whole = markers(run_petves(tmp_path / "whole", f"{SMALL} {TIGHT}"))
    for ranks in (2, 3):
        other = markers(run_petves(tmp_path / str(ranks), f"{SMALL} {TIGHT}", ranks))
        assert np.abs(other - whole).max() < 1e-10
    run_petves(tmp_path / "half", f"{SMALL} {TIGHT} -time_end .2")
    rest = run_petves(tmp_path / "rest", f"{SMALL} {TIGHT} -restart {tmp_path / 'half' / 'checkpoint.h5'}")
    assert np.array_equal(markers(rest), whole)


def test_scaled_problem(tmp_path):
    """All viscosities doubled, the stiffness too, moves vesicles alike; ratios of 1 are no contrast, to the bit."""
    one = markers(run_petves(tmp_path / "one", f"{SMALL} {TIGHT}"))
    two = markers(run_petves(tmp_path / "two", f"{SMALL} {TIGHT} -fluid_viscosity 2 -vesicle_bending .06"))
    assert np.abs(one - two).max() < 1e-10
    plain = f"{SMALL.replace('-vesicle_viscosity_ratio 5,.3', '')} -fluid_inertia none"
    none = markers(run_petves(tmp_path / "none", plain))
    assert np.array_equal(none, markers(run_petves(tmp_path / "ones", f"{plain} -vesicle_viscosity_ratio 1,1")))
    assert np.abs(none - one).max() > 1e-3
