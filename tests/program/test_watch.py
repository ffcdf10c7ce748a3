"""What is watched after every step: limits, finite values, contact. A stop leaves the state before, which a restart
takes."""


import h5py
import numpy as np
import pytest
from harness import PAPER, attribute, run_petves
from restarts import same_columns
from test_warnings import warnings

STRETCHED = f"{PAPER} -domain_cells 32,32 -flow_type extension -flow_rate 10 -time_step 0.01 -time_end 1"


@pytest.mark.parametrize(
    "limit, column",
    [("edge_ratio 1.1", "edge_ratio"), ("area_error 0.01", "area_error"), ("length_error 0.01", "length_error")],
)
def test_limit_stops_at_the_state_before(limit, column, tmp_path):
    """No row is beyond the limit; the checkpoint is the last row's; with a larger limit the run goes on from it and is
    the run that had that limit from the start."""
    value = float(limit.split()[1])
    run = run_petves(tmp_path / "run", f"{STRETCHED} -limit_{limit}", ranks=2, good=False)
    series, summary = run.series, run.summary
    assert run.status == 2 and f"-limit_{column}" in summary["reason"] and "; try " in summary["reason"]
    assert 5 < len(series["step"]) < 80
    assert np.abs(series[column]).max() <= value
    assert attribute(run.folder / "checkpoint.h5") == series["step"][-1]
    last = int(series["step"][-1])
    end = f"-limit_{column} {10 * value} -time_end {0.01 * (last + 2)}"
    run_petves(run.folder, f"{STRETCHED} {end} -restart {run.folder}/checkpoint.h5", ranks=2)
    whole = run_petves(tmp_path / "whole", f"{STRETCHED} {end}", ranks=2)
    same_columns(run.series, whole.series)
    assert np.abs(whole.series[column][last + 1]) > value, "the step that was refused"


def test_no_limit(tmp_path):
    """0 is no limit: the split scheme with a stiff membrane gains length without end."""
    options = f"{PAPER} -domain_cells 32,32 -vesicle_bending 100 -time_step 0.03125 -time_end 0.09375"
    options += " -limit_area_error 0"
    run = run_petves(tmp_path / "run", f"{options} -limit_length_error 0 -limit_edge_ratio 0")
    assert np.abs(run.series["length_error"]).max() > 0.2
    stopped = run_petves(tmp_path / "stopped", options, good=False)
    assert stopped.status == 2 and len(stopped.series["step"]) == 2


def test_failed_graded_start_leaves_the_first_state(tmp_path):
    """One of the parts of the first step fails: the step as a whole has not been taken."""
    options = "-domain_cells 32,32 -scheme_order 2 -flow_type shear -flow_rate 2000 -time_step 0.01"
    run = run_petves(tmp_path / "run", options, good=False)
    assert run.status == 2 and "beyond the wall x_max" in run.errors[0] and "; try " in run.errors[0]
    with h5py.File(run.folder / "checkpoint.h5") as file:
        assert file.attrs["step"] == 0 and file.attrs["time"] == 0 and file.attrs["past"] == 0
        assert not file["fluid/u"][:].any()


PAIR = "-vesicle_count 2 -vesicle_semi_axes 0.2"


@pytest.mark.parametrize(
    "options, who",
    [
        (f"{PAIR},0.5 -vesicle_center -0.25,0,0.25,0", "vesicles 1 and 2"),
        ("-vesicle_semi_axes 0.05,0.6 -vesicle_bending 0", "parts of vesicle 1"),
        (f"-domain_bc_x periodic {PAIR},0.4 -vesicle_center -0.75,0,0.75,0", "vesicles 1 and 2"),
    ],
)
def test_contact_is_warned_of_once(options, who, tmp_path):
    """With the paper's scheme, which has no near field."""
    options = f"{PAPER} -domain_cells 32,32 {options} -time_step 0.002 -time_end 0.01"
    (line,) = warnings(tmp_path / "run", options, 2)
    assert who in line and "closer than 2 cells after step 1," in line
    apart = f"{options} {PAIR},0.5 -vesicle_center -0.35,0,0.35,0 -vesicle_bending 0.01 -domain_bc_x wall"
    assert not warnings(tmp_path / "apart", apart)


PRESSED = "-domain_box -4,4,-4,4 -domain_cells 32,32 -flow_type extension -flow_rate -1 -fluid_inertia none "
PRESSED += "-vesicle_count 2 -vesicle_semi_axes 0.4,0.8 -vesicle_center -0.42,0,0.42,0 "


def test_membranes_that_cross_end_the_run(tmp_path):
    """Without the near field and with long steps two vesicles pressed together cross: the last good state is the one before."""
    options = f"{PRESSED} -coupling_near_field none -vesicle_angle 0 -vesicle_bending 0.001 -time_step 0.5 -time_end 8 -limit_gap_loss 0"
    run = run_petves(tmp_path / "run", options, ranks=2, good=False)
    assert run.status == 2 and "vesicles 1 and 2 cross after step" in run.errors[0] and "; try " in run.errors[0]
    last = int(run.series["step"][-1])
    assert 3 < last < 16 and f"after step {last + 1}," in run.errors[0]
    assert attribute(run.folder / "checkpoint.h5") == last


def test_step_that_drains_a_film(tmp_path):
    """A fixed step ends the run before it, with both vesicles named; step-size control goes on with shorter steps, in which
    no film loses more than it may: .9 % would be lost in the longest one."""
    options = f"{PRESSED} -coupling_near_field none -vesicle_bending 0.001 -time_step 0.5 -time_end 8"
    run = run_petves(tmp_path / "run", options, ranks=2, good=False)
    assert run.status == 2 and "the film between vesicles 1 and 2 went from " in run.errors[0], run.errors
    assert run.series["gap"][-1] > 0 and len(run.series["gap"]) > 2
    adaptive = "-scheme_order 2 -time_adapt error -time_adapt_tol 0.1 -time_adapt_max_move 0 -time_adapt_max_step 0.3"
    exact = f"{PRESSED} -vesicle_bending 0.01 {adaptive} -time_step 0.3 -time_end 0.6 -output_every 1"
    runs = [run_petves(tmp_path / str(limit), f"{exact} -limit_gap_loss {limit}") for limit in (0.5, 0.002)]
    gaps = [run.series["gap"] for run in runs]
    kept = [(gap[1:] / gap[:-1]).min() for gap in gaps]
    assert gaps[0].max() < 0.25 * 7.7 / 45  # half an edge; 45 markers each
    assert kept[0] < 0.998 < kept[1] and len(gaps[1]) > len(gaps[0]), kept


def test_corner_is_warned_of_once(tmp_path):
    """2 cells from two walls that meet, and from one of them only; the box part of quasi-steady flow holds there."""
    scene = "-fluid_inertia none -domain_cells 32,32 -domain_box 0,2,0,2 -vesicle_semi_axes 0.3,0.3"
    scene += " -vesicle_markers 45 -time_step 1e-4 -time_end 3e-4"
    for part, centre, count in (("false", "0.425,0.425", 1), ("false", "0.425,1", 0), ("true", "0.425,0.425", 0)):
        options = f"-coupling_box_part {part} -vesicle_center {centre} -output_overwrite"
        run = run_petves(tmp_path / "run", f"{scene} {options}")
        assert run.stdout.count("within 3 cells of two walls that meet after step 1,") == count, run.stdout


def test_window_of_unbounded_fluid_has_no_corner(tmp_path):
    """A vesicle may lie over the corner of its window, and outside of it."""
    scene = "-domain_box 0,2,0,2 -domain_cells 32,32 -domain_bc_x free -domain_bc_y free -fluid_inertia none "
    scene += "-vesicle_semi_axes 0.3,0.4 -vesicle_center -0.1,2.5 -time_step 0.01 -time_end 0.02"
    assert not warnings(tmp_path / "run", scene)
