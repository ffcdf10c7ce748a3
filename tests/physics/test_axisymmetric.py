"""Bodies of revolution, in unbounded fluid and in tubes: against the shape equations, three dimensions and themselves.

Energies at rest: solutions of the shape equations in arc length (boundary-value solver).
"""

import numpy as np
import pytest
from harness import run_petves

AXIAL = "-dim axisymmetric -output_every 100 -checkpoint_every 0"
TUBE = f"{AXIAL} -flow_type tube -flow_peak_velocity 2"


@pytest.mark.parametrize(
    "shape, volume, degree, energy",
    [
        ("prolate", 0.95, 16, 1.0955649),
        ("oblate", 0.9, 16, 1.2178603),
        ("prolate", 0.8, 24, 1.3874404),
        ("prolate", 0.65, 24, 1.8279299),
        ("oblate", 0.65, 24, 1.8262335),
    ],
)
def test_equilibrium(shape, volume, degree, energy, tmp_path):
    """Prolate and oblate shapes cross at v = 0.65108, where their energies differ by less than at 0.65."""
    still = f"{AXIAL} -vesicle_bending 1 -time_step 0.1 -time_end 40 -time_steady_tol 1e-6"
    options = f"-vesicle_spheroid {shape} -vesicle_reduced_volume {volume} -sphere_degree {degree}"
    last = run_petves(tmp_path / "run", f"{still} {options}").series
    assert abs(last["energy_bending"][-1] / (8 * np.pi) - energy) < 1e-6


def test_relaxation(tmp_path):
    options = "-vesicle_bending 1 -vesicle_reduced_volume 0.8 -sphere_degree 16 -time_step 0.0025 -time_end 0.1"
    energy = run_petves(tmp_path / "run", f"{AXIAL} {options}").series["energy_bending"][-1]
    assert abs(energy / (8 * np.pi) - 1.428729) < 4e-6


@pytest.mark.parametrize("flow", ["axial -flow_rate 0.3 -vesicle_viscosity_ratio 3", "uniform -flow_velocity 1,0,0"])
def test_as_three_dimensions(flow, tmp_path):
    """The same scene with -dim 3, which has no axis: shapes, tension and motion, in the flow and with two vesicles."""
    scene = f"-flow_type {flow} -vesicle_bending 0.1 -sphere_degree 10 -time_step 0.05 -time_end 0.5 -output_every 9"
    if "uniform" in flow:
        scene += " -vesicle_count 2 -vesicle_center -2,0,0,1.6,0,0 -fluid_gravity 1,0,0 -vesicle_density_difference 0,3"
    axial, whole = (run_petves(tmp_path / d[0], f"-dim {d} {scene}").series for d in ("axisymmetric", "3"))
    for column, most in {"energy_bending": 2e-4, "axis_long": 2e-4, "tension_max": 2e-3, "velocity_x": 2e-4}.items():
        for suffix in ("_1", "_2") if "uniform" in flow else ("",):
            assert abs(axial[column + suffix][-1] - whole[column + suffix][-1]) < most, column
    assert axial["velocity_y"][-1] == 0


@pytest.mark.parametrize("volume, radius, bending, speed", [(0.9, 1.3, 1, 1.52206), (0.9, 1.3, 0.1, 1.48034)])
def test_speed_in_a_tube(volume, radius, bending, speed, tmp_path):
    """The second speed is what this program has at degrees 16 and 24 and another program has at degree 16."""
    options = f"-tube_radius {radius} -vesicle_reduced_volume {volume} -vesicle_bending {bending} -sphere_degree 16"
    last = run_petves(tmp_path / "run", f"{TUBE} {options} -time_step 0.1 -time_end 30").series
    assert abs(last["velocity_x"][-1] - speed) < 1e-5
    assert last["mean_velocity"][-1] == 1 and abs(last["area_error"][-1]) < 1e-7


def test_given_pressure_drop(tmp_path):
    """The mean velocity follows from the pressure drop, and makes the same vesicle as when it is given."""
    scene = (
        f"{AXIAL} -flow_type tube -tube_radius 1.2 -vesicle_bending 0.5 -sphere_degree 10 -time_step 0.1 -time_end 30"
    )
    driven = run_petves(tmp_path / "driven", f"{scene} -tube_period 6 -tube_pressure_drop 40").series
    mean = driven["mean_velocity"][-1]
    assert abs(8 * mean * 6 / 1.2**2 + driven["pressure_drop_extra"][-1] - 40) < 1e-10
    given = run_petves(tmp_path / "given", f"{scene} -flow_peak_velocity {2 * mean}").series
    for column in ("velocity_x", "film", "pressure_drop_extra", "energy_bending"):
        assert given[column][-1] == pytest.approx(driven[column][-1], rel=1e-3), column


def test_two_in_a_tube_on_ranks(tmp_path):
    """Both feel the tube and one another alike on 1 and 2 ranks; far apart each is alone."""
    scene = f"{TUBE} -tube_radius 1.3 -vesicle_bending 0.5 -sphere_degree 8 -time_step 0.1 -time_end 1 -vesicle_count 2"
    near = [run_petves(tmp_path / f"n{n}", f"{scene} -vesicle_center -1.8,0,0,1.8,0,0", n).series for n in (1, 2)]
    far = run_petves(tmp_path / "far", f"{scene} -vesicle_center -6,0,0,6,0,0").series
    one = run_petves(tmp_path / "one", scene.removesuffix(" -vesicle_count 2")).series
    for column in ("velocity_x_1", "energy_bending_2", "gap", "film"):
        assert near[0][column][-1] == pytest.approx(near[1][column][-1], abs=1e-9), column
    assert abs(far["velocity_x_2"][-1] - one["velocity_x"][-1]) < 1e-5
    assert abs(near[0]["velocity_x_2"][-1] - one["velocity_x"][-1]) > 1e-4
