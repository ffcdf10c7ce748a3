"""Tracers: exact paths at second order, vesicles that keep what is in them, restarts and ranks, what the tools read."""

import numpy as np
import pytest
from harness import ROOT, run_petves, run_tool
from petves.curves import trigonometric
from refusals import refused
from restarts import at_step, frames

import petves
from petves.views.window import Window

TURNING = ["-flow_u", " -y*cos(t + 1)", "-flow_v", "x*cos(t + 1)"]  # a circle, by the angle sin(t + 1) - sin(1)
SHEAR = f"-options_file {ROOT / 'runs' / 'shear.opts'} -domain_cells 64,32 -time_step 0.15"


def points(folder) -> np.ndarray:
    return frames(folder)["tracers/points"]


def inside(places: np.ndarray, curve: np.ndarray) -> np.ndarray:
    around = curve - (places[:, 0] + 1j * places[:, 1])[:, None]
    return np.abs(np.angle(np.roll(around, -1, axis=1) / around).sum(axis=1)) > np.pi


@pytest.mark.parametrize("bc", ["wall", "free"])
def test_a_path_at_second_order(bc, tmp_path):
    """In a flow that turns as a whole, without a vesicle, and in steps of two lengths."""
    (tmp_path / "points.txt").write_text("# x y\n0.5 0\n\n0.1,-0.3\n")
    start = np.array([0.5, 0.1 - 0.3j, -0.5, 0.5])
    errors = []
    for dt in ("0.08", "0.04"):
        scene = f"-domain_cells 16,16 -domain_bc_x {bc} -domain_bc_y {bc} -vesicle_shape none"
        scene += f" -time_end 2 -time_step {dt}"
        files = ["-tracer_file", tmp_path / "points.txt", "-tracer_grid", "2,1"]
        run_petves(tmp_path / dt, [*scene.split(), *TURNING, *files])
        x, y = points(tmp_path / dt)[-1].T
        errors.append(np.abs(x + 1j * y - start * np.exp(1j * (np.sin(3) - np.sin(1)))).max())
    assert errors[1] < 1e-3 and 3.3 < errors[0] / errors[1] < 4.7, errors


@pytest.mark.parametrize("box", ["", "-vesicle_viscosity_ratio 4", "-domain_bc_x free -domain_bc_y free"])
def test_a_vesicle_keeps_them(box, tmp_path):
    """Tank-treading for two turns: the points that start on the membrane stay on it to 0.2 cells, or in unbounded fluid
    to 0.02, and what is inside stays there."""
    first = run_petves(tmp_path / "first", f"{SHEAR} {box} -time_end 0").saved("vesicle/markers", "run.h5")[0]
    middle, n = first.mean(axis=0), len(first)
    np.savetxt(tmp_path / "points.txt", np.concatenate([first, middle + 0.85 * (first - middle)]), fmt="%.17g")
    more = f"-tracer_file {tmp_path / 'points.txt'} -time_end 120 -output_every 20"
    found = frames(run_petves(tmp_path / "run", f"{SHEAR} {box} {more}").folder)
    for frame in range(1, len(found["time"])):
        curve = trigonometric(found["vesicle/markers"][frame], 200 * n) @ [1, 1j]
        places = found["tracers/points"][frame]
        on = np.abs(curve - (places[:n, 0] + 1j * places[:n, 1])[:, None]).min(axis=1)
        assert on.max() < (0.02 if "free" in box else 0.2) * 0.25
        assert inside(places[n:], curve[::20]).all()
    treaded = found["tracers/points"][-1, :n] - found["vesicle/markers"][-1]
    assert np.abs(treaded).max() > 0.01  # markers and tracers do not keep together


def test_restart_and_ranks(tmp_path):
    """A restart gives the bits of the whole run; 1, 2 and 3 ranks the same paths."""
    scene = f"{SHEAR} -tracer_grid 5,4 -output_every 0.3 -coupled_ksp_rtol 1e-12 -time_adapt error"
    whole = run_petves(tmp_path / "whole", f"{scene} -time_end 1.5")
    run_petves(tmp_path / "half", f"{scene} -time_end 1.5 -checkpoint_every 4 -checkpoint_keep 9")
    checkpoint = tmp_path / "half" / at_step(tmp_path / "half", 4)
    run_petves(tmp_path / "half", f"{scene} -time_end 1.5 -restart {checkpoint}")
    again = frames(tmp_path / "half")
    assert all(np.array_equal(values, again[name]) for name, values in frames(whole.folder).items())
    for ranks in (2, 3):
        other = run_petves(tmp_path / str(ranks), f"{scene} -time_end 1.5", ranks)
        assert np.abs(points(other.folder) - points(whole.folder)).max() < 1e-9


def test_a_restart_with_other_tracers_is_refused(tmp_path):
    small = "-domain_cells 32,32 -time_step 0.01 -time_end 0.02"
    run_petves(tmp_path / "run", f"{small} -tracer_grid 2,2")
    restart = f"-restart {tmp_path / 'run' / 'checkpoint.h5'} -time_end 0.03"
    refused(tmp_path / "run", f"{small} {restart} -tracer_grid 2,3", "-tracer_grid 2,3")


def test_what_the_tools_read(tmp_path):
    """In a periodic box places go on outside of it; xarray has them, and pictures show them in the box."""
    run = run_petves(tmp_path / "run", f"{SHEAR} -tracer_grid 3,2 -time_end 6")
    data, read = petves.load(run.folder), petves.load(run.folder, "numpy")
    assert data["tracers"].dims == ("time", "tracer", "xy") and data["tracers"].attrs["units"] == "length"
    assert np.array_equal(data["tracers"], read.tracers) and read.tracers.shape[1:] == (6, 2)
    seen, wrapped = Window(read, -1).tracers(), run.saved("tracers/wrapped", "run.h5")[-1]
    assert np.abs(seen - wrapped).max() < 1e-12 and np.abs(seen - read.tracers[-1]).max() > 1
    assert (seen > read.box[::2]).all() and (seen < read.box[1::2]).all()
    assert 'Polyvertex" NumberOfElements="6"' in (run.folder / "run.xmf").read_text()
    assert run_tool("plot", run.folder, "--field", "speed").returncode == 0
