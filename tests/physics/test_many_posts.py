"""The preconditioner's block of obstacles: by each curve's own and waves, and in steps of many sizes; the near field of
distant ones."""

import re

import pytest
from harness import run_petves
from test_obstacles import PERIODIC, POST, STILL, agree_with_solids, last
from restarts import at_step


def lattice(posts, radius=0.25, shift=0.5):
    """Posts in a periodic square, a unit and 16 cells for each, rows shifted."""
    box = f"{PERIODIC} -flow_type uniform -domain_box 0,{posts},0,{posts} -domain_cells {16 * posts},{16 * posts}"
    return f"{box} -obstacle_shape posts -obstacle_lattice {posts},{posts} -obstacle_radius {radius} -obstacle_shift {shift}"


def test_factor_by_modes(tmp_path):
    """Each post's own block and a few waves on it give the flow that the dense block gives, in a few iterations however
    many posts there are."""
    ways = ((4, "dense"), (4, "modes"), (8, "modes"))
    posts = {(n, way): last(tmp_path / f"{n}{way}", f"{STILL} {lattice(n)} -obstacle_factor {way}") for n, way in ways}
    dense, modes = posts[4, "dense"], posts[4, "modes"]
    two = last(tmp_path / "two", f"{STILL} {lattice(4)}", ranks=2)
    assert two["obstacle_force_x"] == pytest.approx(dense["obstacle_force_x"], rel=1e-13), "posts half a period apart"
    assert modes["obstacle_force_x"] == pytest.approx(dense["obstacle_force_x"], rel=1e-9)
    assert modes["obstacle_force_x"] != dense["obstacle_force_x"], "both took the same way"
    assert modes["coupled_its"] <= 5 and posts[8, "modes"]["coupled_its"] <= modes["coupled_its"] + 1
    assert posts[8, "modes"]["obstacle_force_x"] == pytest.approx(4 * dense["obstacle_force_x"], rel=1e-5)


def test_free_bodies_by_modes(tmp_path):
    """Discs of two densities that sink among one another, in quasi-steady and in unsteady flow: as by the dense block."""
    options = f"{lattice(3, 0.25, 0.3333333333333333)} -vesicle_shape none -flow_velocity 0,0 -obstacle_free all"
    options += " -obstacle_density 2,1,3,2,1,3,2,1,3 -fluid_gravity .3,-1 -time_step .02 -time_end .04"
    for inertia in ("none", "unsteady"):
        tight = f"{options} -coupled_ksp_rtol 1e-10 -fluid_inertia {inertia} -obstacle_factor"
        run = {way: last(tmp_path / f"{way}{inertia}", f"{tight} {way}") for way in ("dense", "modes")}
        for column in ("obstacle_velocity_y_1", "obstacle_velocity_x_2", "obstacle_rotation_3"):
            assert run["modes"][column] == pytest.approx(run["dense"][column], rel=1e-5)
        assert run["modes"]["obstacle_rotation_3"] != run["dense"]["obstacle_rotation_3"], "both took the same way"
        assert run["modes"]["coupled_its"] <= run["dense"]["coupled_its"] + 4


def test_distant_posts(tmp_path):
    """Posts far from one another have their near field by polynomials: as by all pairs of markers, which those have that
    move, however slowly."""
    options = f"{STILL} {PERIODIC} -flow_type uniform -domain_box 0,3,0,3 -domain_cells 96,96 -obstacle_shape posts"
    options += " -obstacle_center .5,.5,1.9,.7,1,2 -obstacle_radius .2 -obstacle_velocity 1e-13,0"
    rest = last(tmp_path / "rest", options)
    move = last(tmp_path / "move", f"{options} -obstacle_moving")
    for column in ("obstacle_force_x_1", "obstacle_force_x_2", "obstacle_torque_2", "obstacle_force_y_3"):
        assert rest[column] == pytest.approx(move[column], rel=1e-8, abs=1e-7)
        assert rest[column] != move[column], "both took the same way"
    two = last(tmp_path / "two", options, ranks=2)
    assert two["obstacle_force_x_1"] == pytest.approx(rest["obstacle_force_x_1"], rel=1e-10)


def test_direct_ranks_and_restart_with_modes(tmp_path):
    """A vesicle among posts whose block is taken apart: as test_direct_ranks_and_restart."""
    vesicle = "-vesicle_semi_axes .1,.2 -vesicle_markers 25 -vesicle_center 1,.6 -vesicle_bending .01"
    agree_with_solids(tmp_path, f"{lattice(3, 0.25, 0)} {vesicle} -obstacle_factor modes -time_step .02", 0.02)


def test_adaptive_steps_with_inertia(tmp_path):
    """Steps of many sizes: the factors of earlier ones serve, and a restart has the same bits."""
    options = f"{POST} -fluid_inertia unsteady -time_adapt error -time_adapt_tol 1e-3 -time_step .01 -time_end .6"
    options += " -checkpoint_every 20"
    whole = run_petves(tmp_path / "whole", f"{options} -log_view :{tmp_path / 'log'}").series
    made = re.search(r"FactorObstacles +(\d+)", (tmp_path / "log").read_text())[1]
    assert int(made) < 0.6 * len(whole["dt"]) and whole["coupled_its"][2:].mean() <= 4, "made for half of the steps"
    again = f"-restart {tmp_path / 'whole' / at_step(tmp_path / 'whole', 20)}"
    rest = run_petves(tmp_path / "rest", f"{options} {again}").series
    for column in ("center_x", "gap", "obstacle_force_x", "obstacle_torque_1", "coupled_its"):
        assert rest[column][-1] == whole[column][-1]
