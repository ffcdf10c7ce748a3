"""Times are exact: -time_end is reached, in the same way wherever a run was interrupted, fixed steps are at their multiples, and adaptive
steps end at the times of frames. What the loop around StepJudge (tests/unit/scheme/test_judge.c) does in a run."""

import shutil

import numpy as np
import pytest
from harness import run_petves
from restarts import SCHEMES, last_state, without_wall

SMALL = "-domain_cells 24,24 -output_every 10"


@pytest.mark.parametrize("name", ["split", "penalty", "order_1", "order_2", "adaptive"])
def test_a_run_shorter_than_a_step(name, tmp_path):
    """-time_step 0.3 -time_end 0.1 is one step of 0.1, or smaller ones where they are judged."""
    series = run_petves(tmp_path / "run", f"{SCHEMES[name]} {SMALL} -time_step 0.3 -time_end 0.1").series
    assert series["time"][-1] == 0.1
    assert name == "adaptive" or series["dt"].tolist()[1:] == [0.1]


def test_an_end_between_two_steps(tmp_path):
    """Two equal steps at the end, or a single one of less than a step; the flow is that of a run with small steps."""
    options = f"{SCHEMES['order_2']} {SMALL}"
    series = run_petves(tmp_path / "run", f"{options} -time_end 0.11").series
    np.testing.assert_allclose(series["time"], [0, 0.02, 0.04, 0.06, 0.08, 0.095, 0.11], rtol=1e-15)
    assert series["time"][-1] == 0.11
    finer = run_petves(tmp_path / "finer", f"{options} -time_end 0.11 -time_step 0.01").series
    coarser = run_petves(tmp_path / "coarser", f"{options} -time_end 0.11 -time_step 0.04").series
    errors = [abs(run["inclination"][-1] - finer["inclination"][-1]) for run in (series, coarser)]
    assert errors[0] < 0.5 * errors[1] < 1e-3, "of second order still"


def saved(run) -> list[float]:
    return run.saved("time", "run.h5").tolist()


def test_fixed_steps_are_at_their_multiples(tmp_path):
    """In decimals, not sums: 0.3, not 0.1 + 0.1 + 0.1; after a restart with another step too."""
    options = f"{SCHEMES['split']} -domain_cells 24,24 -output_every 0.7 -time_step"
    run = run_petves(tmp_path / "run", f"{options} 0.1 -time_end 3")
    assert run.series["time"].tolist() == [k / 10 for k in range(31)] and set(run.series["dt"]) == {0.1}
    assert saved(run) == [0, 0.7, 1.4, 2.1, 2.8, 3]
    on = run_petves(run.folder, f"{options} 0.07 -time_end 4.4 -restart {run.folder}/checkpoint.h5")
    assert on.series["time"].tolist()[31:] == [(300 + 7 * k) / 100 for k in range(1, 21)]


def test_adaptive_steps_end_at_the_times_of_frames(tmp_path):
    """Whatever the tolerance, and after a restart with the same bits. It takes hardly more steps, none of which is short."""
    options = f"{SCHEMES['adaptive']} -domain_cells 24,24 -time_end 1 -time_step 0.01"
    options += " -checkpoint_every 10 -checkpoint_keep 9 -output_every"
    free = run_petves(tmp_path / "free", f"{options} 10")
    whole, finer = (run_petves(tmp_path / tol, f"{options} 0.1 -time_adapt_tol {tol}") for tol in ("1e-3", "1e-4"))
    assert saved(whole) == saved(finer) == [k / 10 for k in range(11)]
    dt = whole.series["dt"][1:]
    assert len(dt) <= 1.1 * len(free.series["dt"]) and (dt[1:] > 0.4 * dt[:-1]).all()
    for path in sorted(whole.folder.glob("checkpoint_*.h5")):
        folder = tmp_path / path.stem
        shutil.copytree(whole.folder, folder)
        on = run_petves(folder, f"{options} 0.1 -time_adapt_tol 1e-3 -restart {folder / path.name}")
        assert saved(on) == saved(whole) and without_wall(folder) == without_wall(whole.folder)


@pytest.mark.parametrize("name", ["split", "order_2"])
def test_restarts_shorten_the_same_steps(name, tmp_path):
    """From any of the last steps the run has the bits of one that was not interrupted; from its end it goes on to a
    later one."""
    options = f"{SCHEMES[name]} {SMALL} -time_end 0.11 -checkpoint_every 1 -checkpoint_keep 9"
    whole = run_petves(tmp_path / "whole", options).folder
    for path in sorted(whole.glob("checkpoint_[123].h5")):
        folder = tmp_path / path.stem
        shutil.copytree(whole, folder)
        run_petves(folder, f"{options} -restart {folder / path.name}")
        assert without_wall(folder) == without_wall(whole), path.name
        np.testing.assert_array_equal(last_state(folder)["vesicle/markers"], last_state(whole)["vesicle/markers"])
    on = run_petves(whole, f"{options} -time_end 0.2 -restart {whole}/checkpoint.h5").series
    np.testing.assert_allclose(on["time"][6:], [0.11, 0.13, 0.15, 0.17, 0.185, 0.2], rtol=1e-14)


@pytest.mark.parametrize("ranks", [1, 2])
def test_solve_that_fails_is_tried_with_half_the_step(ranks, tmp_path):
    """Two iterations are too few for steps that grow from a base step of 1: the run takes smaller steps, and ends in the same state."""
    options = f"-domain_cells 32,32 -vesicle_bending 1 -time_step 1 -time_end 4 -time_adapt error"
    free = run_petves(tmp_path / "free", options, ranks)
    run = run_petves(tmp_path / "out", f"{options} -coupled_ksp_max_it 2", ranks)
    assert run.series["time"][-1] == 4 and not run.errors
    assert len(run.series["time"]) > len(free.series["time"])
    assert abs(run.series["energy_bending"][-1] / free.series["energy_bending"][-1] - 1) < 1e-3


def test_solve_that_never_converges_ends_the_run(tmp_path):
    """With the solver's line, after steps 2^40 times smaller; the initial state is on disk."""
    options = f"-domain_cells 32,32 -time_step 0.1 -time_end 1 -time_adapt error -coupled_ksp_max_it 0"
    run = run_petves(tmp_path / "out", options, good=False)
    assert run.status == 2 and len(run.errors) == 1
    assert "the solve with prefix coupled_ failed in step 1" in run.errors[0]
    assert (run.folder / "checkpoint.h5").exists() and list(run.series["step"]) == [0]


@pytest.mark.parametrize("ranks", [1, 2])
def test_without_vesicle_steps_are_fixed(ranks, tmp_path):
    """Nothing to judge steps by: -time_adapt error is refused, and where unused options pass it takes -time_step, not one step
    to the end."""
    options = "-domain_cells 16,16 -vesicle_shape none -flow_type shear -time_step 0.1 -time_end 1"
    options += " -time_adapt error"
    refused = run_petves(tmp_path / "out", options, ranks, good=False)
    assert refused.status == 1 and "-time_adapt error: not used by this scene" in refused.errors[0]
    run = run_petves(tmp_path / "out", f"{options} -allow_unused_options", ranks)
    assert np.allclose(run.series["dt"][1:], 0.1) and len(run.series["time"]) == 11
