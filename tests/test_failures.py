"""A fast solve that does not converge (back end hypre, which iterates) is a failed step on every rank alike: the run ends,
one line names the options' prefix and the reason, and the last good state is on disk."""

import re

import pytest
from conftest import run_petves
from test_errors import SMALL, leaves_files


def reason(prefix: str, its: int) -> str:
    """Pattern of the message, up to its advice."""
    return (
        rf"^the solve with prefix {prefix} failed in step \d+ at time [\d.e-]+: DIVERGED_ITS after {its} iterations, "
        rf"residual [\d.e-]+; try a smaller -time_step, more iterations \(-{prefix}ksp_max_it\)"
    )


@pytest.mark.parametrize("ranks", [1, 2, 3])
@pytest.mark.parametrize("solver", ["helmholtz", "poisson"])
@pytest.mark.parametrize("scheme", ["split", "penalty", "coupled"])
def test_fast_solve_that_fails_ends_the_run(scheme, solver, ranks, tmp_path):
    """In the first step: the state on disk is the initial one."""
    options = f"{SMALL} -scheme_type {scheme} -{solver}_type hypre -{solver}_ksp_max_it 1"
    run = run_petves(tmp_path / "out", options, ranks, good=False, timeout=60)
    summary, series = leaves_files(run, reason(f"{solver}_", 1))
    assert "in step 1 at time 0.01:" in summary["reason"]
    assert list(series["step"]) == [0]


FIVE = "-domain_cells 32,32 -scheme_type coupled -helmholtz_type hypre -helmholtz_ksp_max_it 5"


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_fast_solve_that_fails_later_keeps_the_steps_before(ranks, tmp_path):
    """In a larger step H is closer to a Laplacian, and five iterations are no longer enough; step and time in the line are
    those of the step that failed."""
    options = f"{FIVE} -time_step 0.001 -helmholtz_ksp_max_it 10"
    run_petves(tmp_path / "out", f"{options} -time_end 0.003", ranks)
    options = f"{FIVE} -time_step 0.5 -time_end 3 -restart {tmp_path}/out/checkpoint.h5"
    run = run_petves(tmp_path / "out", options, ranks, good=False, timeout=60)
    summary, series = leaves_files(run, reason("helmholtz_", 5))
    step, time = re.search(r"in step (\d+) at time ([\d.e-]+):", summary["reason"]).groups()
    assert series["step"][-1] > 1 and int(step) == series["step"][-1] + 1
    assert float(time) == pytest.approx(series["time"][-1] + 0.5)


@pytest.mark.parametrize("ranks", [1, 2])
def test_step_control_tries_a_failed_fast_solve_again_with_half_the_step(ranks, tmp_path):
    """The run goes on to its end in steps for which five iterations are enough; with more of them steps are larger."""
    options = "-time_step 0.1 -time_end 0.4 -time_adapt error"
    five = run_petves(tmp_path / "five", f"{FIVE} {options}", ranks).series
    more = run_petves(tmp_path / "more", f"{FIVE} {options} -helmholtz_ksp_max_it 100", ranks).series
    assert five["time"][-1] == more["time"][-1] == pytest.approx(0.4)
    assert 2 * five["dt"][1:].max() < 1.01 * more["dt"][1:].max()
    for name in ("area", "length", "energy_bending"):
        assert five[name][-1] == pytest.approx(more[name][-1], rel=1e-4)


def test_fast_solve_without_vesicle(tmp_path):
    """No outer iteration sees the failed solve: what the step leaves is looked at."""
    options = (
        "-domain_cells 32,32 -time_step 0.1 -time_end 1 -scheme_type coupled -vesicle_shape none -flow_type shear "
        "-flow_form total -helmholtz_type hypre -helmholtz_ksp_max_it 1"
    )
    run = run_petves(tmp_path / "out", options, 2, good=False, timeout=60)
    assert run.status == 2 and len(run.errors) == 1
    assert re.search(reason("helmholtz_", 1), run.errors[0].removeprefix("petves: error: "))
    assert (run.folder / "checkpoint.h5").exists()
