"""Times are exact: -time_end is reached, in the same way wherever a run was interrupted, fixed steps are at their multiples, and adaptive
steps end at the times of frames."""

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
    print(f"{len(dt)} steps with frames, {len(free.series['dt']) - 1} without: {dt}")
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
