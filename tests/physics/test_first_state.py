"""Frame 0 and row 0 are a solution: of the flow past the first membranes and solids, before anything has moved."""

import numpy as np
import pytest
from harness import run_scenes
from restarts import frames

pytestmark = pytest.mark.xdist_group("first_state")  # its tests share runs

VESICLE = "-vesicle_semi_axes 0.25,0.5 -vesicle_angle 30 -vesicle_center 0.1,-0.2 -vesicle_bending 0.1"
SHEAR = f"-domain_box -2,2,-2,2 -domain_cells 32,32 -flow_type shear {VESICLE} -fluid_inertia none"
POST = "-obstacle_shape posts -obstacle_radius 0.45 -obstacle_center 1.2,0.6"
KINDS = {
    "free": f"{SHEAR} -domain_bc_x free -domain_bc_y free",
    "box": SHEAR,
    "channel": f"{SHEAR} -domain_bc_x periodic",
    "contrast": f"{SHEAR} -domain_bc_x periodic -vesicle_viscosity_ratio 5",
    "heavy": f"{SHEAR} -fluid_gravity 0,-1 -vesicle_density_difference 1",
    "capsule": f"{SHEAR} -membrane_law hooke -membrane_stretching 10 -membrane_viscosity 1",
    "posts": f"{SHEAR} {POST} -domain_bc_x periodic",
    "turning": f"{SHEAR} {POST} -obstacle_moving -obstacle_rotation 1",
    "posts with inertia": f"{SHEAR} {POST} -domain_bc_x periodic -fluid_inertia unsteady",
}
OTHER = set("step time dt wall nsolve coupled_its div_max surface_div_max area_shift obstacle_angle_1".split())


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    short = "-time_step 1e-8 -time_end 1e-8 -output_every 1e-8 -scheme_startup euler -coupled_ksp_rtol 1e-10"
    return run_scenes(tmp_path_factory.mktemp("runs"), {kind: f"{KINDS[kind]} {short}" for kind in KINDS}, ranks=2)


@pytest.mark.parametrize("kind", KINDS)
def test_the_first_state_is_what_a_short_step_leads_to(kind, runs):
    """Fields, tension, forces and every column, on 2 ranks."""
    run = runs[kind]
    compared = {name: values for name, values in run.series.items() if name not in OTHER}
    apart = {name: abs(np.diff(values)[0]) / max(1, abs(values[1])) for name, values in compared.items()}
    saved = frames(run.folder)
    names = "fluid/u fluid/v fluid/p vesicle/tension vesicle/velocity obstacle/force".split()
    for name in saved.keys() & set(names):
        first, second = saved[name]
        apart[name] = np.abs(second - first).max() / np.abs(second).max()
    assert np.nanmax(list(apart.values())) < 5e-5 and not np.isnan([apart["fluid/p"], apart["vesicle/tension"]]).any()
    assert run.series["coupled_its"][0] > 0
