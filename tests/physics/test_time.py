"""Time steps: a steady shape does not depend on them, what a step solves, orders, and how far steps grow."""

import numpy as np
import pytest
from harness import run_petves

from studies.common.curves import last_markers
from studies.common.paper import SHEAR_FREE
from studies.time import runs as study
from studies.time.page import step_for

FREE = "-domain_bc_x free -domain_bc_y free -domain_box -4,4,-4,4 -domain_cells 32,32"
FREE += " -output_every 1e9 -checkpoint_every 0"


def vesicle(reduced_area: float, chi: float, angle: float = 17) -> str:
    """R0 = nu = rate = 1."""
    shape = f"-vesicle_reduced_area {reduced_area} -vesicle_area {np.pi * reduced_area!r} -vesicle_angle {angle}"
    return f"-flow_type shear {shape} -vesicle_bending {1 / chi!r}"


@pytest.mark.parametrize("reduced_area, chi, dt", [(0.7, 10, 0.2), (0.7, 1, 0.4), (0.9, 1, 0.2)])
def test_steady_shape_does_not_depend_on_the_step(reduced_area, chi, dt, tmp_path):
    """Angle and frequency against the boundary integral's, at a step that would leave 0.3 and -0.8 % and more with labels
    that do not turn."""
    options = f"{FREE} {vesicle(reduced_area, chi)} -time_step {dt} -time_end 24"
    angle, frequency = SHEAR_FREE[reduced_area, chi]
    series = run_petves(tmp_path, options).series
    errors = series["inclination"][-1] / np.pi / angle - 1, series["frequency"][-1] / frequency - 1
    assert np.abs(errors).max() < 3e-6  # the reference has seven digits


def test_two_vesicles_and_walls(tmp_path):
    """A pair far apart in a channel, with other shapes: each has labels of its own; the angles are those of small steps."""
    scene = "-domain_box -8,8,-2.5,2.5 -domain_cells 64,20 -domain_bc_x periodic -flow_type shear -fluid_inertia none"
    scene += " -vesicle_count 2 -vesicle_area 2.199114857512855,2.5 -vesicle_reduced_area 0.7,0.9 -vesicle_angle 20,30"
    scene += " -vesicle_center -4,0,4,0 -vesicle_bending 0.5 -output_every 1e9 -checkpoint_every 0 -time_end 12"
    coarse, fine = (run_petves(tmp_path / f"{dt}", f"{scene} -time_step {dt}").series for dt in (0.4, 0.05))
    for name in ("inclination", "frequency"):
        for one in (name, f"{name}_2"):
            assert abs(coarse[one][-1] / fine[one][-1] - 1) < 4e-4, one


def test_orders(tmp_path):
    """An ellipse that turns into its shape in shear: order 2, and with -scheme_order 3 more, and smaller errors."""

    def markers(order: int, dt: float) -> np.ndarray:
        options = f"{FREE} {vesicle(0.7, 10)} -time_end 2 -coupled_ksp_rtol 1e-8 -time_step {dt} -scheme_order {order}"
        return last_markers(run_petves(tmp_path / f"{order}_{dt}", options).folder)

    exact, steps = markers(3, 0.0025), (0.1, 0.05, 0.025)
    errors = {order: [np.abs(markers(order, dt) - exact).max() for dt in steps] for order in (2, 3)}
    slopes = {order: np.polyfit(np.log(steps), np.log(errors[order]), 1)[0] for order in (2, 3)}
    assert slopes[2] > 1.8 and slopes[3] > 2.6
    assert errors[3][0] < 0.5 * errors[2][0] and errors[3][2] < 0.2 * errors[2][2]


@pytest.mark.parametrize("order, steps", [(2, 60), (3, 60)])
def test_steps_grow_at_a_steady_shape(order, steps, tmp_path):
    """From an ellipse to the steady state with error control: error and motion vanish there, so the step goes to its
    default limit, and the angle is that of the steady state."""
    options = f"{FREE} {vesicle(0.7, 10)} -scheme_order {order} -time_step 0.05 -time_end 20 -time_adapt error"
    series = run_petves(tmp_path / "run", f"{options} -time_adapt_tol 3e-3").series
    limit = 1 / (1 + 0.03 * 10)
    assert len(series["dt"]) - 1 <= steps
    assert limit / 2**0.5 < series["dt"].max() <= limit
    assert abs(series["inclination"][-1] - np.pi * SHEAR_FREE[0.7, 10][0]) < 1e-5


def test_without_a_rate_the_membranes_time_is_the_limit(tmp_path):
    """Relaxing: nu R0^3/c_b; what the user gives stays, also no limit."""
    options = f"{FREE} -vesicle_semi_axes 0.9,1.1 -vesicle_bending 0.5 -time_step 0.125 -time_end 60 -time_adapt error"
    for given, limit in (("", 2), ("-time_adapt_max_step 1", 1), ("-time_adapt_max_step 0", np.inf)):
        run = run_petves(tmp_path / f"{limit}", f"{options} -time_adapt_tol 1e-2 {given}")
        largest = run.series["dt"].max()
        assert largest <= limit * 1.01 and largest > min(limit, 4) / 1.5, (given, largest)


def test_step_for_an_error():
    """Errors of second order: the step is exact between those known, the largest where all are below, none above all."""
    errors = {dt: 5 * dt**2 for dt in (0.4, 0.1, 0.2)}
    assert step_for(errors, 5 * 0.15**2) == pytest.approx(0.15, rel=1e-12)
    assert step_for(errors, 1) == 0.4
    assert step_for(errors, 1e-3) is None


@pytest.mark.parametrize("order", (1, 2, 3))
def test_cases_of_the_study_are_scenes(order, tmp_path):
    """An option that a scene does not use stops it: a start of order 1 for instance."""
    case = study.energy(1, order, 0.01)
    run_petves(tmp_path, [word for option in (case.options | {"-time_end": "0.02"}).items() for word in option])
