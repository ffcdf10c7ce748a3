"""Bodies in bodies, against exact numbers: a vesicle around a post, containers that move, what lies in a solid."""

import numpy as np
import pytest
from harness import run_petves
from test_obstacles import PERIODIC, STILL, last

BOX = "-domain_box -1,1,-1,1 -domain_cells 64,64 -fluid_inertia none"
CIRCLES = "-obstacle_shape couette -obstacle_radius .3,.7"
CLOSED = f"{STILL} -domain_box -2,2,-2,2 -domain_cells 48,48 -obstacle_shape file"


def circle(radius, center=(0, 0), container=False, notes=()):
    """The lines of a curve file with one circle."""
    t = 2 * np.pi * np.arange(200) / 200 * (-1 if container else 1)
    points = np.column_stack([np.cos(t), np.sin(t)]) * radius + center
    return "\n".join([*notes, *(f"{x:.17g} {y:.17g}" for x, y in points)]) + "\n\n"


def between(inner, outer, ratio=1):
    """The torque between two circles that turn at rates that differ by 1."""
    return 4 * np.pi * ratio / (inner**-2 - outer**-2)


@pytest.mark.parametrize("ratio", [1, 5, 0.2])
def test_a_vesicle_around_a_post(ratio, tmp_path):
    """A post of radius 0.3 turns within a circular vesicle of 0.6 in a container of 0.9: the torque passes the fluid
    inside and the fluid outside in a row, and the film between post and vesicle is a gap as others are."""
    curves = tmp_path / "circles.txt"
    curves.write_text(circle(0.3, notes=["# rotation 1"]) + circle(0.9, container=True))
    options = f"{BOX} -time_step .02 -time_end .1 -obstacle_shape file -obstacle_file {curves} -vesicle_semi_axes .6,.6"
    row = last(tmp_path / "run", f"{options} -vesicle_viscosity_ratio {ratio}")
    inside, outside = between(0.3, 0.6, ratio), between(0.6, 0.9)
    torque = 1 / (1 / inside + 1 / outside)
    assert row["obstacle_torque_2"] == pytest.approx(torque, rel=1e-4)
    assert -row["obstacle_torque_1"] == pytest.approx(torque, rel=1e-4)
    assert row["frequency"] == pytest.approx(torque / outside, rel=1e-4)
    assert row["gap"] == pytest.approx(0.3, rel=1e-3)


def test_a_vesicle_is_pushed_off_a_post_within(tmp_path):
    curves = tmp_path / "post.txt"
    curves.write_text(circle(0.3, center=(0.25, 0)))
    options = f"{BOX} -time_step .01 -time_end .05 -obstacle_shape file -obstacle_file {curves}"
    row = last(tmp_path, f"{options} -vesicle_semi_axes .6,.6 -contact_repulsion 100 -contact_repulsion_range .1")
    assert row["gap"] > 0.0505 and row["center_x"] > 0.0005 and row["energy_contact"] > 0, row


@pytest.mark.parametrize("sides", ["", PERIODIC])
def test_the_outer_of_two_circles_turns(sides, tmp_path):
    """The fluid that the program has outside a container does not count."""
    row = last(tmp_path, f"{STILL} {BOX} {sides} {CIRCLES} -obstacle_rotation 0,1")
    assert row["obstacle_torque_1"] == pytest.approx(between(0.3, 0.7), rel=1e-5)
    assert row["obstacle_torque_2"] == pytest.approx(-between(0.3, 0.7), rel=1e-5)


def test_a_container_that_moves(tmp_path):
    """Of a file: fluid that is carried along as a solid has no force, a post at rest has the container's."""
    alone, post = tmp_path / "alone.txt", tmp_path / "post.txt"
    outer = circle(1, container=True, notes=["# velocity 1 0.5", "# rotation 2"])
    alone.write_text(outer)
    post.write_text(outer + circle(0.4, center=(0.2, 0.1)))
    loads = ["obstacle_force_x_1", "obstacle_force_y_1", "obstacle_torque_1"]
    row = last(tmp_path / "alone", f"{CLOSED} {PERIODIC} -obstacle_moving -obstacle_file {alone}")
    assert all(abs(row[name]) < 1e-12 for name in loads)
    row = last(tmp_path / "post", f"{CLOSED} {PERIODIC} -obstacle_moving -obstacle_file {post}")
    force = np.array([row["obstacle_force_x_2"], row["obstacle_force_y_2"]])
    place = np.array([0.2, 0.1]) - [row["obstacle_center_x_1"], row["obstacle_center_y_1"]]
    assert np.hypot(*force) > 1
    assert [row[name] for name in loads[:2]] == pytest.approx(-force, rel=1e-12)
    torque = row["obstacle_torque_2"] + place[0] * force[1] - place[1] * force[0]
    assert row[loads[2]] == pytest.approx(-torque, rel=1e-10)


def test_a_heavy_vesicle_in_a_container(tmp_path):
    """The container bears the weight, density difference times gravity times area; both sides of a container at rest in
    fluid at rest are its inner one."""
    curves = tmp_path / "container.txt"
    curves.write_text(circle(1, container=True))
    options = STILL.replace("-vesicle_shape none", "-vesicle_semi_axes .3,.4 -fluid_gravity 0,-1")
    options = f"{options} -domain_box -2,2,-2,2 -domain_cells 48,48 -obstacle_shape file -obstacle_file {curves}"
    row = last(tmp_path / "run", f"{options} -fluid_inertia none -vesicle_density_difference 2")
    assert row["obstacle_force_y_1"] == pytest.approx(-2 * np.pi * 0.3 * 0.4, rel=1e-6)


def test_contact_keeps_the_momentum(tmp_path):
    """A container bears what acts on the bodies in it, however they push one another."""
    curves = tmp_path / "disc.txt"
    curves.write_text(circle(1.6, container=True) + circle(0.3, center=(0.1, 0.1)))
    options = (
        f"-domain_box -2,2,-2,2 -domain_cells 64,64 -fluid_inertia none -obstacle_shape file -obstacle_file {curves}"
    )
    options += " -obstacle_free 2 -obstacle_force 0,0,3,1 -vesicle_semi_axes .3,.4 -vesicle_center .8,.2 -time_step .01"
    options += " -time_end .1 -contact_repulsion 50 -contact_repulsion_range .3 -coupled_ksp_rtol 1e-11"
    series = run_petves(tmp_path, options).series
    assert series["energy_contact"].min() > 0.1
    assert series["obstacle_force_x_1"] == pytest.approx(3, abs=1e-7) and series["obstacle_force_y_1"] == pytest.approx(
        1, abs=1e-7
    )


def test_with_inertia_the_load_of_a_container_that_moves_is_not_given(tmp_path):
    row = last(tmp_path, f"{STILL} {BOX} {CIRCLES} -obstacle_rotation 0,1".replace("inertia none", "inertia unsteady"))
    assert np.isnan(row["obstacle_torque_2"]) and row["obstacle_torque_1"] > 0
