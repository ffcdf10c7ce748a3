"""Bodies that move: seen from a body that rests the same, against boundary integrals, to second order in time, through
the seam of a box, with inertia of the fluid, ranks, restarts, files, and what they run into."""

import numpy as np
import pytest
from boundary_integral import driven
from harness import ROOT, attribute, run_petves
from restarts import agree, frames
from test_obstacles import PERIODIC, STILL, agree_with_solids, last, swinging

import petves
from petves.views.window import Window

ONCE = STILL.replace("-time_step .01 -time_end .01", "")
#: A post in a periodic box of side 1, in steps of a tenth.
POST = f"{ONCE} {PERIODIC} -domain_box 0,1,0,1 -obstacle_shape posts -obstacle_radius .2 -obstacle_center .5,.5"
#: A vesicle in a periodic box of side 2.
VESICLE = f"{PERIODIC} -domain_box 0,2,0,2 -domain_cells 32,32 -vesicle_semi_axes .2,.35 -vesicle_markers 41"
VESICLE += " -vesicle_center 1,1.5 -vesicle_bending .01"


def ellipse(folder, center, note, axes=(0.4, 0.2), angle=0.0):
    """A file with one, turned, which moves as the note says."""
    t = 2 * np.pi * np.arange(80) / 80
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    points = np.column_stack([axes[0] * np.cos(t), axes[1] * np.sin(t)]) @ turn + center
    folder.mkdir(exist_ok=True)
    np.savetxt(folder / "ellipse.txt", points, header=note)
    return f"-obstacle_shape file -obstacle_file {folder / 'ellipse.txt'} -obstacle_moving"


def test_a_moving_post_feels_what_a_resting_one_does(tmp_path):
    """In a stream the other way; where it has moved by whole cells to rounding. The preconditioner of its first place
    serves on."""
    still = last(tmp_path / "rest", f"{POST} -domain_cells 32,32 -time_step .05 -time_end .05 -flow_type uniform")
    options = f"{POST} -domain_cells 32,32 -time_step .0625 -time_end .625 -obstacle_moving -obstacle_velocity -1,.3"
    moving = run_petves(tmp_path / "move", options).series
    assert moving["obstacle_force_x_1"][1:] == pytest.approx(still["obstacle_force_x_1"], rel=1e-6)
    assert np.abs(moving["obstacle_force_y_1"][1:] + 0.3 * still["obstacle_force_x_1"]).max() < 1e-5
    assert moving["obstacle_center_x_1"] == pytest.approx(0.5 - moving["time"], abs=1e-12)
    assert moving["coupled_its"][2:].max() <= 2
    along = run_petves(tmp_path / "along", options.replace("-1,.3", "-1,0")).series
    assert along["obstacle_force_x_1"][1:] == pytest.approx(still["obstacle_force_x_1"], rel=1e-9)


@pytest.mark.parametrize("more", ["", "-vesicle_viscosity_ratio 4"])
def test_a_scene_that_moves_past(more, tmp_path):
    """A vesicle carried past a resting post, and the same seen from the stream, the post going through the seam."""
    options = f"{VESICLE} {more} -obstacle_shape posts -obstacle_radius .3 -obstacle_center .2,.7 -time_step .02"
    options += " -flow_type uniform -time_end .2 -coupled_ksp_rtol 1e-8"
    still = run_petves(tmp_path / "rest", f"{options} -flow_velocity 2,.5")
    moving = f"{options} -flow_velocity 0,0 -obstacle_moving -obstacle_velocity -2,-.5"
    other = run_petves(tmp_path / "move", moving)
    for name, speed in (("center_x", 2), ("center_y", 0.5)):
        shift = speed * still.series["time"]
        assert np.abs(still.series[name] - shift - other.series[name]).max() < 1e-5
    for name in ("obstacle_force_x", "obstacle_torque_1", "gap", "pressure_drop"):
        assert other.series[name][1:] == pytest.approx(still.series[name][1:], rel=1e-3)


def test_a_turning_ellipse_against_boundary_integrals(tmp_path):
    """Force and torque at three places and angles."""
    note = "velocity .5 .2\nrotation 2"
    options = f"{ONCE} {PERIODIC} -domain_box -1,1,-1,1 -domain_cells 32,32 -time_step .2 -time_end .6 -output_every .2"
    run_petves(tmp_path, f"{options} {ellipse(tmp_path, (0.1, 0.0), note)} -obstacle_spacing .75")
    run = petves.load(tmp_path, "numpy")
    for frame in (1, 2, 3):
        force, torque = driven(run.obstacles_at(frame)[0], (0.5, 0.2), 2.0, 2.0, 3)
        found = [run.series[f"obstacle_{name}_1"][frame] for name in ("force_x", "force_y", "torque")]
        assert found == pytest.approx([*force, torque], rel=2e-5)


def test_a_vesicle_in_a_moving_cage(tmp_path):
    """Two circles with a vesicle between them, the inner one turning; all of it carried along, the same."""
    options = f"{PERIODIC} -domain_box 0,2,0,2 -domain_cells 32,32 -vesicle_semi_axes .3,.12"
    options += " -vesicle_center .9,1.5 -vesicle_bending .01 -obstacle_shape couette -obstacle_radius .2,.8"
    options += " -obstacle_center .9,1 -obstacle_rotation 2,0 -time_step .02 -time_end .1"
    still = last(tmp_path / "rest", options)
    moving = last(tmp_path / "move", f"{options} -obstacle_moving -obstacle_velocity 1.25,.5")
    for name, speed in (("center_x", 1.25), ("center_y", 0.5)):
        assert moving[name] == pytest.approx(still[name] + 0.1 * speed, abs=1e-4)
    assert moving["obstacle_torque_1"] == pytest.approx(still["obstacle_torque_1"], rel=5e-4)
    assert moving["obstacle_angle_1"] == pytest.approx(0.2, rel=1e-12)


def test_order_in_time(tmp_path):
    """A vesicle that an ellipse carries which swings and turns: second order."""
    body = ellipse(tmp_path, (1, 0.7), "velocity .6 .3\nrotation 3")
    options = f"{VESICLE} -scheme_order 2 {body} -obstacle_frequency 8 -time_end .4"
    places = []
    for steps in (10, 20, 40):
        run_petves(tmp_path / str(steps), f"{options} -time_step {0.4 / steps}")
        places.append(petves.load(tmp_path / str(steps), "numpy").markers[-1])
    coarse, fine = (np.abs(a - b).max() for a, b in zip(places, places[1:]))
    assert 3.4 < coarse / fine < 7 and fine < 1e-3


def test_direct_ranks_and_restart(tmp_path):
    """1 and 3 ranks agree; a restart has the same bits, in run.h5 too."""
    body = ellipse(tmp_path, (1, 0.7), "velocity .6 .3\nrotation 3", (0.4, 0.27))
    options = f"{VESICLE} {body} -obstacle_frequency 4 -time_step .02 -output_every .02"
    options = options.replace("32,32", "24,24").replace("-vesicle_markers 41", "-vesicle_markers 31")
    agree_with_solids(tmp_path, options, 0.02)
    whole, rest = frames(tmp_path / "whole"), frames(tmp_path / "rest")
    for name in ("obstacle/markers", "obstacle/force", "vesicle/markers", "fluid/u"):
        np.testing.assert_array_equal(rest[name][-1], whole[name][-1])


def test_blocks_are_renewed_beside_a_bump(tmp_path):
    """An ellipse turns past a bump on a wall: the preconditioner is made anew, and a restart has the same bits."""
    note = "velocity 4 0\nrotation 10"
    body = ellipse(tmp_path, (1, 1.3), note, (0.3, 0.2))
    bump = [f"{0.6 + 0.8 * s:.15g} {0.25 * (1 - np.cos(2 * np.pi * s)):.15g}" for s in np.arange(60) / 59]
    with (tmp_path / "ellipse.txt").open("a") as file:
        file.write("\n".join(["", "# open", *bump]))
    options = f"{ONCE} -domain_bc_x periodic -domain_box 0,2,0,2 -domain_cells 32,32 {body} -time_step .02"
    options = options.replace("-coupled_ksp_rtol 1e-10", "")
    names = ("obstacle_torque_1", "obstacle_force_x_2", "coupled_its")
    its = agree(tmp_path, options, 0.3, 0.6, names, ())["whole"].series["coupled_its"][2:]
    assert 1 in its and its.max() > 3


def test_with_inertia(tmp_path):
    """Convective flow is the same seen from a moving post. A swinging one has its force, that of the fluid within it
    among it, to second order."""
    options = f"{POST} -domain_cells 32,32 -fluid_inertia convective"
    steps = "-time_step .005 -time_end .05"
    still = last(tmp_path / "rest", f"{options} {steps} -flow_type uniform -flow_velocity -1,0")
    moving = f"{options} -obstacle_moving"
    row = last(tmp_path / "move", f"{moving} {steps} -obstacle_velocity 1,0")
    assert row["obstacle_force_x"] == pytest.approx(still["obstacle_force_x"], rel=1e-4)
    swinging(tmp_path, f"{moving} -obstacle_velocity .5,0", "obstacle_force_x", 20, 1)


def test_files_have_the_body_where_it_is(tmp_path):
    """run.h5 and run.xmf at each saved time, shifted into the box in run.xmf, also after a restart; series.csv its
    middle and angle; a picture its place."""
    body = ellipse(tmp_path, (0.1, 0.7), "velocity -2 0\nrotation 3")
    options = f"{VESICLE} {body} -time_step .05 -output_every .1"
    run_petves(tmp_path, f"{options} -time_end .1", ranks=2)
    run_petves(tmp_path, f"{options} -time_end .2 -restart {tmp_path / 'checkpoint.h5'}")
    run = petves.load(tmp_path, "numpy")
    assert run.series["obstacle_angle_1"] == pytest.approx(3 * run.series["time"], abs=1e-12)
    assert run.series["obstacle_center_x_1"] == pytest.approx(0.1 - 2 * run.series["time"], abs=1e-6)
    first = run.obstacles_at(0)[0] - (0.1, 0.7)
    for frame, t in enumerate((0, 0.1, 0.2)):
        c, s = np.cos(3 * t), np.sin(3 * t)
        wanted = first @ np.array([[c, s], [-s, c]]) + (0.1 - 2 * t, 0.7)
        np.testing.assert_allclose(run.obstacles_at(frame)[0], wanted, atol=1e-7)
        solids = Window(run, frame).solids()
        middles = sorted(np.mean(points[:-1, 0]) for points in solids)
        assert middles[-1] == pytest.approx((0.1 - 2 * t) % 2 + (2 if t == 0 else 0), abs=1e-3)
    np.testing.assert_array_equal(run.obstacles[0], run.obstacles_at(2)[0])
    assert petves.load(tmp_path, "xarray").obstacles.dims == ("time", "obstacle_marker", "xy")
    assert (tmp_path / "run.xmf").read_text().count("run.h5:/obstacle/wrapped") == 3
    saved = frames(tmp_path)
    assert saved["obstacle/markers"].shape == (3, len(first), 2)
    shift = saved["obstacle/wrapped"] - saved["obstacle/markers"]
    np.testing.assert_allclose(shift, np.array([0, 2, 2])[:, None, None] * [1, 0] + 0 * shift, atol=1e-15)


TOUCH = {
    "-obstacle_radius .25 -obstacle_center .3,.4,1.2,.4 -obstacle_velocity 1,0,0,0": "obstacles 1 and 2 run into",
    "-obstacle_radius .25 -obstacle_center 1,.4 -obstacle_velocity 0,-1 -domain_bc_y wall": "the wall y_min",
}


@pytest.mark.parametrize("posts", TOUCH)
@pytest.mark.parametrize("adapt", ["none", "error"])
def test_bodies_stop_before_they_touch(posts, adapt, tmp_path):
    """With the reason, at the last good state, from which the body has come to less than a step's way of the other."""
    options = f"{VESICLE} -time_step .02 -time_end 1 -time_adapt {adapt} -obstacle_shape posts -obstacle_moving {posts}"
    run = run_petves(tmp_path, options, good=False)
    assert TOUCH[posts] in run.errors[-1] and "the last good state is in" in run.errors[-1]
    t = attribute(tmp_path / "checkpoint.h5", "time")
    gap = 0.4 - t if "1,0,0,0" in posts else 0.15 - t
    assert 0 < gap < 0.04


def test_the_scene_of_runs(tmp_path, monkeypatch):
    """runs/stirring.opts shows what its header says."""
    monkeypatch.chdir(ROOT)
    row = last(tmp_path, f"-options_file runs/stirring.opts -time_end .2")
    assert row["obstacle_angle_1"] == pytest.approx(0.4, rel=1e-12)
    assert row["center_x_1"] == pytest.approx(-row["center_x_2"], abs=1e-4)
