"""What is watched after every step: limits, finite values, contact. A stop leaves the state before, which a restart
takes."""

import json

import h5py
import numpy as np
import pytest
from conftest import run_petves

STRETCHED = "-domain_cells 32,32 -flow_type extension -flow_rate 10 -time_step 0.01 -time_end 1"


@pytest.mark.parametrize(
    "limit, column",
    [("edge_ratio 1.1", "edge_ratio"), ("area_error 0.01", "area_error"), ("length_error 0.01", "length_error")],
)
def test_limit_stops_at_the_state_before(limit, column, tmp_path):
    """No row is beyond the limit; the checkpoint is the last row's; with a larger limit the run goes on from it and is
    the run that had that limit from the start."""
    value = float(limit.split()[1])
    run = run_petves(tmp_path / "run", f"{STRETCHED} -limit_{limit}", ranks=2, good=False)
    series, summary = run.series, json.loads((run.folder / "summary.json").read_text())
    assert run.status == 2 and f"-limit_{column}" in summary["reason"] and "; try " in summary["reason"]
    assert 5 < len(series["step"]) < 80
    assert np.abs(series[column]).max() <= value
    with h5py.File(run.folder / "checkpoint.h5") as file:
        assert file.attrs["step"] == series["step"][-1]
    last = int(series["step"][-1])
    end = f"-limit_{column} {10 * value} -time_end {0.01 * (last + 2)}"
    run_petves(run.folder, f"{STRETCHED} {end} -restart {run.folder}/checkpoint.h5", ranks=2)
    whole = run_petves(tmp_path / "whole", f"{STRETCHED} {end}", ranks=2)
    for name in set(series) - {"wall"}:
        np.testing.assert_array_equal(run.series[name], whole.series[name], err_msg=name)
    assert np.abs(whole.series[column][last + 1]) > value, "the step that was refused"


def test_no_limit(tmp_path):
    """0 is no limit: the split scheme with a stiff membrane gains length without end."""
    options = "-domain_cells 32,32 -vesicle_bending 100 -time_step 0.03125 -time_end 0.09375 -limit_area_error 0"
    run = run_petves(tmp_path / "run", f"{options} -limit_length_error 0 -limit_edge_ratio 0")
    assert np.abs(run.series["length_error"]).max() > 0.2
    stopped = run_petves(tmp_path / "stopped", options, good=False)
    assert stopped.status == 2 and len(stopped.series["step"]) == 2


def test_failed_graded_start_leaves_the_first_state(tmp_path):
    """One of the parts of the first step fails: the step as a whole has not been taken."""
    options = (
        "-domain_cells 32,32 -scheme_type coupled -scheme_order 2 -flow_type shear -flow_rate 2000 -time_step 0.01"
    )
    run = run_petves(tmp_path / "run", options, good=False)
    assert run.status == 2 and "needs 3" in run.errors[0] and "; try " in run.errors[0]
    with h5py.File(run.folder / "checkpoint.h5") as file:
        assert file.attrs["step"] == 0 and file.attrs["time"] == 0 and file.attrs["past"] == 0
        assert not file["fluid/u"][:].any()


@pytest.mark.parametrize(
    "options, who",
    [
        ("-vesicle_count 2 -vesicle_semi_axes 0.2,0.5 -vesicle_center -0.25,0,0.25,0", "vesicles 1 and 2"),
        ("-vesicle_semi_axes 0.05,0.6 -vesicle_bending 0", "parts of vesicle 1"),
        (
            "-domain_bc_x periodic -vesicle_count 2 -vesicle_semi_axes 0.2,0.4 -vesicle_center -0.75,0,0.75,0",
            "vesicles 1 and 2",
        ),
    ],
)
def test_contact_is_warned_of_once(options, who, tmp_path):
    run = run_petves(tmp_path / "run", f"-domain_cells 32,32 {options} -time_step 0.002 -time_end 0.01", ranks=2)
    lines = [line for line in run.stdout.splitlines() if "petves: warning" in line]
    assert len(lines) == 1 and who in lines[0] and "closer than 2 cells after step 1," in lines[0], run.stdout


def test_no_warning_without_contact(tmp_path):
    options = "-vesicle_count 2 -vesicle_semi_axes 0.2,0.5 -vesicle_center -0.35,0,0.35,0"
    run = run_petves(tmp_path / "run", f"-domain_cells 32,32 {options} -time_step 0.002 -time_end 0.01")
    assert "petves: warning" not in run.stdout
