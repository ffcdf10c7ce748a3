"""Step sizes: what the loop around StepJudge (tests/unit/scheme/test_judge.c) does in a run."""

import numpy as np
import pytest
from harness import run_petves


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
