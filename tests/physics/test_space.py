"""Vesicles in three dimensions, against solutions of the shape equations, theories of small deformation and themselves turned.

Steady states in shear, equilibria and relaxation: independent calculations with spherical harmonics (degree 16) and of the shape equations.
"""

import numpy as np
import pytest
from harness import run_petves

import petves

SPACE = "-dim 3 -vesicle_bending 0.1 -sphere_degree 8 -output_every 100 -checkpoint_every 0"
SHEAR = f"{SPACE} -flow_type shear -vesicle_axis 0.8776,0.4794,0"


@pytest.mark.parametrize(
    "change, angle, energy, axes, rotation",
    [
        ("-vesicle_reduced_volume 0.9 -time_step 0.5", 0.153393, 1.208341, (0.7466, 0.86161, 1.55499), -0.341488),
        ("-vesicle_reduced_volume 0.9 -time_step 1", 0.153393, 1.208341, (0.7466, 0.86161, 1.55499), -0.341488),
        ("-vesicle_reduced_volume 0.95 -time_step 0.25", 0.180015, 1.101962, (0.80595, 0.92642, 1.33936), -0.41303),
    ],
)
def test_tank_treading(change, angle, energy, axes, rotation, tmp_path):
    """A steady state does not depend on the step."""
    last = run_petves(tmp_path / "run", f"{SHEAR} -time_end 24 {change}").series
    assert abs(last["inclination"][-1] / np.pi - angle) < 3e-6
    assert abs(last["energy_bending"][-1] / (0.1 * 8 * np.pi) - energy) < 5e-6
    assert np.allclose([last[f"axis_{k}"][-1] for k in ("short", "middle", "long")], axes, atol=2e-5)
    assert abs(last["rotation_z"][-1] - rotation) < 1e-5
    assert abs(last["area_error"][-1]) < 1e-5 and abs(last["volume_error"][-1]) < 1e-12
    assert np.mean(last["coupled_its"][1:]) < 6


def test_viscosity_ratio(tmp_path):
    """Five times as viscous inside, reduced volume 0.99: 29.953 degrees."""
    options = f"{SHEAR} -vesicle_reduced_volume 0.99 -vesicle_viscosity_ratio 5 -time_step 0.1 -time_end 8"
    assert abs(np.degrees(run_petves(tmp_path / "run", options).series["inclination"][-1]) - 29.953) < 0.02


@pytest.mark.parametrize("shape, volume, energy", [("prolate", 0.9, 1.189644), ("oblate", 0.9, 1.21786)])
def test_equilibrium(shape, volume, energy, tmp_path):
    """The energy of a shape at rest, which never rises on the way."""
    options = f"{SPACE} -vesicle_bending 1 -vesicle_spheroid {shape} -vesicle_reduced_volume {volume} -sphere_degree 10"
    run = run_petves(tmp_path / "run", f"{options} -scheme_order 1 -time_step 1 -time_end 10 -bending_newton 2")
    energies = run.series["energy_bending"] / (8 * np.pi)
    assert abs(energies[-1] - energy) < 1e-5
    assert np.diff(energies).max() < 1e-7


def test_a_degree_too_small_is_named(tmp_path):
    rough = "-sphere_degree 4 -vesicle_bending 1 -vesicle_reduced_volume 0.3"
    run = run_petves(tmp_path / "run", f"{SPACE} {rough} -time_step 0.05 -time_end 0.3")
    (warning,) = run.summary["warnings"]
    assert run.series["spectrum_tail"][-1] > 0.01 and "try -sphere_degree 8" in warning


def test_a_sphere_settles(tmp_path):
    """Its membrane is incompressible, so it falls as a rigid one: 2/9 of weight R0^2/nu (Stokes)."""
    options = f"{SPACE} -vesicle_reduced_volume 1 -fluid_gravity 0,0,-2 -vesicle_density_difference 0.5"
    last = run_petves(tmp_path / "run", f"{options} -fluid_viscosity 3 -time_step 0.1 -time_end 0.5").series
    assert abs(last["velocity_z"][-1] + 2 / 27) < 1e-7 and abs(last["velocity_x"][-1]) < 1e-9


def test_orders_in_time(tmp_path):
    """The angle at t = 1.6 from a smooth start at t = 0.4, made by tiny steps."""

    small = f"{SHEAR} -sphere_degree 6"

    def angle(order, step):
        folder = tmp_path / f"{order}_{step}"
        start = run_petves(folder, f"{small} -scheme_order {order} -time_step 0.02 -time_end 0.4").folder
        options = f"{small} -scheme_order {order} -time_step {step} -time_end 1.6 -restart {start / 'checkpoint.h5'}"
        return run_petves(tmp_path / f"{order}_{step}_on", options).series["inclination"][-1]

    for order, least in ((2, 1.8), (3, 2.5)):
        found = [angle(order, step) for step in (0.1, 0.05, 0.025)]
        assert np.log2(abs((found[0] - found[1]) / (found[1] - found[2]))) > least


def test_steps_by_error(tmp_path):
    """The angle at t = 2 follows the tolerance: fixed steps of third order are the reference. Steps grow with the motion's end."""

    def last(name, steps):
        return run_petves(tmp_path / name, f"{SHEAR} -vesicle_reduced_volume 0.9 -time_end 2 {steps}").series

    fine = last("fine", "-scheme_order 3 -time_step 0.02")["inclination"][-1]
    wrong = []
    for tolerance in (1e-3, 1e-4):
        run = last(str(tolerance), f"-time_step 0.2 -time_adapt error -time_adapt_tol {tolerance}")
        wrong.append(abs(run["inclination"][-1] - fine))
        assert run["dt"][1] == 0.2 / 32 and run["dt"].max() > 8 * run["dt"][1] and len(run["dt"]) < 50
    assert wrong[1] < 1e-4 and wrong[1] < wrong[0] < 1e-3


def test_turned_in_space(tmp_path):
    """Space has no direction of its own: a vesicle at rest that is turned, poles included, relaxes alike."""
    rows = []
    for axis in ("1,0,0", "0,0,1", "0.3,-0.5,0.8"):
        options = f"{SPACE} -sphere_degree 10 -coupled_ksp_rtol 1e-12 -vesicle_half_axes 1.2,0.9,0.9 -vesicle_axis {axis} -time_step 0.1 -time_end 0.2"
        rows.append(run_petves(tmp_path / axis, options).series["energy_bending"])
    assert np.allclose(rows, rows[0], rtol=1e-9)


@pytest.mark.parametrize("step", ["0.2 -vesicle_viscosity_ratio 5,2", "1 -time_adapt error -time_adapt_tol 1e-3"])
def test_one_rank_or_three(step, tmp_path):
    """Two vesicles that pass one another, also from a checkpoint on, which gives the same bits."""
    pair = f"{SHEAR} -sphere_degree 6 -vesicle_count 2 -vesicle_center -1.6,0.3,0,1.6,-0.3,0 -time_step {step}"
    pair += " -output_every 1 -coupled_ksp_rtol 1e-12"
    one, three = (run_petves(tmp_path / str(n), f"{pair} -time_end 2", n).series for n in (1, 3))
    for name in ("inclination_1", "center_x_2", "tension_max", "energy_bending"):
        assert np.allclose(one[name], three[name], rtol=1e-9)
    half = run_petves(tmp_path / "half", f"{pair} -time_end 1")
    again = f"{pair} -time_end 2 -restart {half.folder / 'checkpoint.h5'} -output_dir {half.folder}"
    rest = run_petves(tmp_path / "half", again).series
    for name in set(one) - {"wall"}:
        assert np.array_equal(one[name], rest[name]), name


def test_iterations(tmp_path):
    """With factors that are kept several vesicles in shear take at most 6 iterations in the mean."""
    places = "0,0,0,3.4,0.5,0,6.8,0,0,10.2,0.5,0"
    four = f"{SHEAR} -vesicle_count 4 -vesicle_center {places} -vesicle_bending 0.1 -time_step 0.1 -time_end 2"
    assert run_petves(tmp_path / "run", four).series["coupled_its"][3:].mean() <= 6


def test_repulsion_keeps_a_film(tmp_path):
    """Two vesicles that extension presses together, with and without repulsion, which costs no iterations."""
    pair = f"{SPACE} -sphere_degree 4 -flow_type extension -vesicle_axis 0,1,0 -vesicle_reduced_volume 0.98 -vesicle_count 2"
    pair += " -vesicle_center 0,1.1,0,0.1,-1.4,0 -time_step 0.1 -time_end 1"
    push = f"{pair} -contact_repulsion 50 -contact_repulsion_range 0.2"
    bare, pushed, three = (
        run_petves(tmp_path / name, options, ranks).series
        for name, options, ranks in (("bare", pair, 1), ("pushed", push, 1), ("three", f"{push} -time_end 0.4", 3))
    )
    assert pushed["gap"].min() > bare["gap"].min() + 0.015
    assert (bare["energy_contact"] == 0).all() and (np.diff(pushed["energy_contact"][4:]) > 0).all()
    assert pushed["coupled_its"].max() < bare["coupled_its"].max() + 3
    assert np.allclose(pushed["energy_contact"][:5], three["energy_contact"], rtol=1e-5)


def test_adhesion_draws_vesicles_together(tmp_path):
    """Vesicles at rest within the band of adhesion come nearer, and the energy of bending and contact falls."""
    scene = f"{SPACE} -sphere_degree 6 -vesicle_count 2 -vesicle_center 0,0.95,0,0,-0.95,0 -vesicle_bending 1"
    scene += " -contact_repulsion 200 -contact_repulsion_range 0.2 -contact_adhesion 4 -contact_adhesion_range 0.3"
    run = run_petves(tmp_path / "run", f"{scene} -time_step 0.02 -time_end 0.3").series
    energy = run["energy_contact"] + run["energy_bending_1"] + run["energy_bending_2"]
    assert (np.diff(energy) < 0).all() and energy[-1] < energy[0] - 2
    assert run["gap"][0] > 0.3 and 0.15 < run["gap"][-1] < 0.22


def test_an_ellipsoid_of_points(tmp_path):
    """Points of an ellipsoid are that of -vesicle_half_axes to 1e-10, along x with its energy, turned with its points."""
    points = np.random.default_rng(7).normal(size=(400, 3))
    points *= np.array([1.5, 0.9, 0.8]) / np.linalg.norm(points, axis=1)[:, None]
    turn = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))[0]
    given = run_petves(tmp_path / "given", f"{SPACE} -vesicle_half_axes 1.5,0.9,0.8 -vesicle_center 3,2,1 -time_end 0")
    for name, rows in (("along", points), ("turned", points @ turn.T)):
        np.savetxt(tmp_path / f"{name}.txt", rows, fmt="%.17g", header="a cloud", delimiter=",")
        options = f"{SPACE} -vesicle_file {tmp_path / name}.txt -vesicle_center 3,2,1 -time_end 0"
        found = run_petves(tmp_path / name, options)
        own = ["area", "volume", "axis_short", "axis_long", "center_x", "center_z"]
        for column in own + ["energy_bending", "inclination"] * (name == "along"):
            assert abs(found.series[column][0] - given.series[column][0]) < 1e-10, (name, column)
        surface = petves.load(found.folder, kind="numpy").points[0, 0] - (3, 2, 1)
        surface = surface @ turn if name == "turned" else surface
        assert abs(np.linalg.norm(surface / (1.5, 0.9, 0.8), axis=1) - 1).max() < 1e-10


def coefficient_lines(coefficients):
    """The lines of a file of surfaces, coefficients (vesicles, 3, harmonics)."""
    degrees = [(k, m) for k in range(99) for m in range(-k, k + 1)]
    each = [
        [f"{k} {m} {x:.17g} {y:.17g} {z:.17g}" for (k, m), (x, y, z) in zip(degrees, own.T)] for own in coefficients
    ]
    return "\n\n".join("\n".join(lines) for lines in each)


def test_a_run_begins_where_another_ended(tmp_path):
    """Coefficients of a last frame in a file are its shapes, also at another size; a restart knows the file's numbers."""
    pair = f"{SHEAR} -vesicle_count 2 -vesicle_center -2,0.3,0,2,-0.3,0 -time_step 0.2 -time_end 0.4"
    first = petves.load(run_petves(tmp_path / "first", pair).folder, kind="numpy")
    file = tmp_path / "last.txt"
    file.write_text(coefficient_lines(first.coefficients[-1]))
    options = f"{SPACE} -vesicle_file {file} -time_step 0.2 -time_end 0.2"
    run = run_petves(tmp_path / "on", options)
    again = petves.load(run.folder, kind="numpy")
    assert np.array_equal(again.coefficients[0], first.coefficients[-1])
    large = run_petves(tmp_path / "large", f"{options} -vesicle_radius 2 -vesicle_center -9,0,0,9,0,0")
    larger = petves.load(large.folder)
    assert np.allclose(larger.volume_1[0], 32 / 3 * np.pi, rtol=1e-14)
    assert np.allclose(larger.axis_long_1[0], 2 * again.series["axis_long_1"][0], rtol=1e-12)
    assert np.allclose(larger.center_x_1[0], again.series["center_x_1"][0] - 9, rtol=1e-12)
    file.write_text(coefficient_lines(first.coefficients[0]))
    restart = f"{options} -time_end 0.4 -restart {run.folder / 'checkpoint.h5'}"
    stopped = run_petves(tmp_path / "other", restart, good=False)
    assert "its curves are not those that the run of -restart" in stopped.errors[0]
