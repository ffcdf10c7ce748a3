"""Bodies that the fluid carries: exact answers and dense boundary integrals in unbounded fluid, the speed of a disc in a
channel, a body against the same one whose motion is given, bodies in and beside vesicles, ranks, restarts, fields."""

import h5py
import numpy as np
import pytest
from harness import REFERENCES, ROOT, run_petves
from restarts import agree
from test_obstacles import CHANNEL, PERIODIC

EXACT = REFERENCES["free_bodies"]
ALONE = "-vesicle_shape none -obstacle_free all -obstacle_shape posts"
FREE = f"{ALONE} -domain_bc_x free -domain_bc_y free -domain_box -4,4,-4,4 -domain_cells 64,64"
ONCE = "-coupled_ksp_rtol 1e-11 -time_step 1e-5 -time_end 1e-5"
#: Two discs between walls, one of them pulled.
PAIR = "-domain_box -2,2,-2,2 -domain_cells 48,48 -obstacle_radius .5,.4 -obstacle_center -.6,.3,.6,-.2"
PAIR += " -flow_type shear"
PULL = "-obstacle_force 1,-2,0,0 -obstacle_torque 0,.5"
RATES = ("velocity_x", "velocity_y", "rotation")


def rates(series, body, row=-1):
    """Velocity and rotation of a body."""
    return np.array([series[f"obstacle_{name}_{body}"][row] for name in RATES])


def ellipses(folder, *bodies):
    """A file of ellipses (x, y, semi-axis along x, along y)."""
    t = 2 * np.pi * np.arange(400) / 400
    folder.mkdir(exist_ok=True)
    curves = [np.column_stack([x + a * np.cos(t), y + b * np.sin(t)]) for x, y, a, b in bodies]
    (folder / "curves.txt").write_text("\n".join("\n".join(f"{x:.17g} {y:.17g}" for x, y in c) + "\n" for c in curves))
    return f"-obstacle_shape file -obstacle_file {folder / 'curves.txt'} -obstacle_free all"


def balanced(series, bodies, loads=None):
    """Whether the fluid's force and torque on each body are those from outside, turned, in all rows."""
    for body in range(1, bodies + 1):
        found = np.array([series[f"obstacle_{name}_{body}"] for name in ("force_x", "force_y", "torque")]).T
        assert np.abs(found + (loads[body - 1] if loads else 0)).max() < 1e-12


def test_a_disc_in_shear(tmp_path):
    """It moves with the flow in its centre and turns at half the rate, exactly; inside the fluid turns with it."""
    options = f"{FREE} {ONCE} -flow_type shear -obstacle_radius .7 -obstacle_center .3,.4"
    series = run_petves(tmp_path, options).series
    assert np.abs(rates(series, 1) - [0.4, 0, -0.5]).max() < 1e-10
    balanced(series, 1)
    with h5py.File(tmp_path / "run.h5") as file:
        x, y, u = file["fluid/x"][:], file["fluid/y"][:], [file[f"fluid/{name}"][0] for name in "uv"]
    inside = np.hypot(x - 0.3, y[:, None] - 0.4) < 0.6
    assert inside.sum() > 50
    assert np.abs(u[0] - (0.4 + 0.5 * (y[:, None] - 0.4)))[inside].max() < 1e-8
    assert np.abs(u[1] + 0.5 * (x - 0.3))[inside].max() < 1e-8


@pytest.mark.parametrize(
    "name, options",
    [("two", "-flow_type shear -obstacle_radius 1"), ("pulled", "-obstacle_radius 1,.5 -obstacle_force 0,-1,0,1")],
)
def test_two_discs_against_boundary_integrals(name, options, tmp_path):
    series = run_petves(tmp_path, f"{FREE} {ONCE} {options} -obstacle_center 0,0,2.4,.5").series
    for body in (1, 2):
        assert np.abs(rates(series, body) - EXACT[name][body - 1]).max() < 1e-6


@pytest.mark.parametrize("order, within", [(2, 5e-6), (3, 2e-6)])
def test_jeffery_s_orbit(order, within, tmp_path):
    """An ellipse 2:1 turns once in 5 pi, in 200 steps; twice the steps take the order's part of the error away."""
    options = f"{FREE} {ellipses(tmp_path, (0, 0, 2, 1))} -flow_type shear -scheme_order {order} -output_every 99"
    options += f" -coupled_ksp_rtol 1e-9 -time_end {5 * np.pi!r} -time_step"
    off = []
    for steps in (200, 400):
        series = run_petves(tmp_path / str(steps), f"{options} {5 * np.pi / steps!r}").series
        slowest = 0.2  # the rate at which it turns where the turn ends
        off.append(abs(series["obstacle_angle_1"][-1] + 2 * np.pi) / slowest / (5 * np.pi))
        balanced(series, 1)
    assert off[0] < within and off[1] < off[0] / 2 ** (order - 0.2)


@pytest.mark.parametrize("tolerance, steps", [(1e-3, 90), (1e-5, 230)])
def test_jeffery_s_orbit_in_adaptive_steps(tolerance, steps, tmp_path):
    options = f"{FREE} {ellipses(tmp_path, (0, 0, 2, 1))} -flow_type shear -time_end {5 * np.pi!r} -output_every 99"
    options += f" -time_step .05 -time_adapt error -time_adapt_tol {tolerance} -coupled_ksp_rtol 1e-9"
    series = run_petves(tmp_path, options).series
    assert abs(series["obstacle_angle_1"][-1] + 2 * np.pi) < tolerance and len(series["time"]) < steps


def test_bodies_that_meet_take_smaller_steps(tmp_path):
    """Two discs that are pressed together: the film between them drains, steps become short, and one line ends the run."""
    options = "-domain_bc_x periodic -domain_bc_y periodic -domain_box -4,4,-4,4 -domain_cells 64,64 -obstacle_radius 1"
    options += " -obstacle_center -1.5,0,1.5,0 -obstacle_force 20,0,-20,0 -time_step .5 -time_adapt error -time_end 10"
    run = run_petves(tmp_path, f"{ALONE} {options}", good=False)
    assert run.status == 2 and "obstacles 1 and 2 run into one another" in run.errors[-1]
    # by less than 0.037 apart their forces are not right
    assert run.series["dt"][-1] < 1e-9 and abs(run.series["obstacle_center_x_1"][-1]) > 1.018


def test_discs_that_pass(tmp_path):
    """In shear, of third order in time; both end as far from the middle."""
    options = f"{FREE} -flow_type shear -obstacle_radius 1 -obstacle_center -2,.5,2,-.5 -time_step .0125 -time_end 8"
    options += " -coupled_ksp_rtol 1e-8"
    series = run_petves(tmp_path, f"{options} -output_every 99").series
    for sign, body in ((1, 1), (-1, 2)):
        place = [series[f"obstacle_center_{d}_{body}"][-1] for d in "xy"]
        assert place == pytest.approx(sign * np.array(EXACT["passing"]), abs=1e-6)


def test_discs_that_move_beside_a_vesicle_that_hardly_does(tmp_path):
    """A step of 0.05, in which discs go a tenth of their radius, is not made again by backward Euler as one too long."""
    options = "-domain_box 0,8,0,8 -domain_cells 96,96 -vesicle_center 6.8,6.8 -vesicle_area 1 -vesicle_bending .1"
    options += " -obstacle_shape posts -obstacle_radius .5,.3 -obstacle_center 2,2.2,2.95,2 -obstacle_free all"
    options += " -obstacle_force 20,0,-20,0 -obstacle_torque 1,0 -vesicle_reduced_area .98 -time_step .05 -time_end 1"
    series = run_petves(tmp_path, options).series
    place = [series[f"obstacle_center_{name}"][-1] for name in ("x_1", "y_2")]
    assert place == pytest.approx([2.50344, 1.82172], abs=2e-3)  # with steps of 0.003


def test_a_disc_settles_in_a_channel(tmp_path):
    """Under a force, and under its weight, along a channel at no flux; the force is that of a disc that is moved."""
    channel = f"{CHANNEL} -domain_cells 96,32 -flow_drive flux -obstacle_free all -obstacle_radius .1"
    pulled = run_petves(tmp_path / "pulled", f"{channel} -obstacle_force 1,0").series
    assert rates(pulled, 1)[0] * REFERENCES["obstacles"]["faxen"] == pytest.approx(1, abs=1e-4)
    assert np.abs(rates(pulled, 1)[1:]).max() < 1e-8 and pulled["flux"][-1] == pytest.approx(0, abs=1e-9)
    weight = 2 * np.pi * 0.1**2  # of the density 3 under a gravity of 1
    heavy = run_petves(tmp_path / "heavy", f"{channel} -obstacle_density 3 -fluid_gravity 1,0").series
    assert rates(heavy, 1)[0] == pytest.approx(weight * rates(pulled, 1)[0], rel=1e-8)
    balanced(heavy, 1, [(weight, 0, 0)])


@pytest.mark.parametrize("ranks, box", [(1, "wall"), (2, "wall"), (3, "wall"), (1, "channel"), (1, "periodic")])
def test_a_body_whose_motion_is_given(ranks, box, tmp_path):
    """Surfaces that move with the velocities of free bodies feel the same forces, marker by marker."""
    sides = {"wall": "", "channel": "-domain_bc_x periodic", "periodic": f"{PERIODIC} -flow_type uniform"}[box]
    options = f"{PAIR} {sides} {ONCE} -vesicle_shape none -obstacle_shape posts"
    free = run_petves(tmp_path / "free", f"{options} -obstacle_free all {PULL}", ranks=ranks)
    balanced(free.series, 2, [(1, -2, 0), (0, 0, 0.5)])
    q = [rates(free.series, body, 0) for body in (1, 2)]
    velocity = ",".join(repr(x) for body in q for x in body[:2])
    options += f" -obstacle_velocity {velocity} -obstacle_rotation {q[0][2]!r},{q[1][2]!r}"
    given = run_petves(tmp_path / "given", options)
    with h5py.File(free.folder / "run.h5") as one, h5py.File(given.folder / "run.h5") as two:
        assert np.abs(one["obstacle/force"][0] - two["obstacle/force"][0]).max() < 1e-8


@pytest.mark.parametrize("case", EXACT["inclusion"])
def test_an_inclusion(case, tmp_path):
    """A disc in a vesicle that tank-treads in unbounded shear: angle, frequency, and the disc's rotation."""
    radius, ratio = case.split(", ")
    exact = EXACT["inclusion"][case]
    options = f"-options_file {ROOT / 'runs' / 'inclusion.opts'} -output_dir {tmp_path} -output_every 99"
    options += f" -obstacle_radius {radius} -vesicle_viscosity_ratio {ratio} -vesicle_angle {180 * exact[0]}"
    series = run_petves(tmp_path, f"{options} -time_end 30").series
    found = [series["inclination"][-1] / np.pi, series["frequency"][-1], rates(series, 1)[2]]
    assert found == pytest.approx(exact, abs=2e-4)
    assert series["coupled_its"][5:].max() <= 8
    balanced(series, 1)


def test_an_inclusion_within_the_wanted_error(tmp_path):
    """-scheme_auto 0.001 with a disc in a vesicle."""
    exact = EXACT["inclusion"]["0.3, 1"]
    options = "-scheme_auto .001 -domain_bc_x free -domain_bc_y free -flow_type shear -time_end 30 -vesicle_bending .1"
    options += f" -vesicle_reduced_area .8 -vesicle_area 2.513274122871834 -vesicle_angle {180 * exact[0]}"
    series = run_petves(tmp_path, f"{options} -obstacle_shape posts -obstacle_free all -obstacle_radius .3").series
    found = [series["inclination"][-1] / np.pi, series["frequency"][-1], rates(series, 1)[2]]
    assert found == pytest.approx(exact, rel=1e-3)


def test_a_disc_passes_a_constriction(tmp_path):
    """Between bumps of many markers, which rest on the walls: the preconditioner knows both."""
    x = np.linspace(-3, 3, 257)
    bump = -1 + 0.2 * (1 + np.cos(np.pi * x / 3))
    disc = np.column_stack([0.15 * f(np.linspace(0, 2 * np.pi, 97)[:-1]) for f in (np.cos, np.sin)]) - [3.4, -0.1]
    curves = [np.column_stack([x[::-1], bump[::-1]]), np.column_stack([x, -bump]), disc]
    text = "\n".join("".join(f"{a!r} {b!r}\n" for a, b in c.tolist()) for c in curves)
    text = "# open\n" + text.replace("\n\n", "\n\n# open\n", 1)
    (tmp_path / "curves.txt").write_text(text)
    options = "-vesicle_shape none -domain_box -4,4,-1,1 -domain_cells 400,100 -domain_bc_x periodic"
    options += " -flow_type poiseuille -flow_half_width 1 -obstacle_shape file -obstacle_free 3 -time_step .01"
    options += f" -obstacle_file {tmp_path / 'curves.txt'} -time_end .03"
    assert run_petves(tmp_path / "run", options).series["coupled_its"].max() <= 4


def test_a_packing_of_discs_and_vesicles(tmp_path):
    """At random, none touches another; resolved.opts packs it again; the same on three ranks."""
    options = "-domain_box 0,4,0,4 -domain_cells 48,48 -domain_bc_x periodic -flow_type shear -vesicle_packing .2"
    options += " -vesicle_area .4 -vesicle_reduced_area .8 -vesicle_bending .01 -obstacle_shape posts -obstacle_count 8"
    options += " -obstacle_radius .3568 -obstacle_free all -time_step .02 -coupled_ksp_rtol 1e-8"
    names = ("gap", "center_x", "inclination", "obstacle_center_x_1", "obstacle_rotation_8")
    series = agree(tmp_path, options, 0.06, 0.1, names, (3,), rel=1e-6)["whole"].series
    assert series["gap"].min() > 0.05 and series["coupled_its"][2:].max() <= 16
    centers = np.array([[series[f"obstacle_center_{d}_{k}"][0] for d in "xy"] for k in range(1, 9)])
    apart = centers[:, None] - centers[None]
    apart[..., 0] -= 4 * np.round(apart[..., 0] / 4)
    assert np.hypot(*apart.T)[~np.eye(8, dtype=bool)].min() > 2 * 0.3568
    balanced(series, 8)
    again = run_petves(tmp_path / "again", f"-options_file {tmp_path / 'whole' / 'resolved.opts'} -time_end .02").series
    assert again["obstacle_center_x_1"][0] == series["obstacle_center_x_1"][0]


def test_contact_with_a_vesicle_is_equal_and_opposite(tmp_path):
    """A disc that is pulled into a vesicle: what it bears less than its load, the vesicle bears; the same on 3 ranks."""
    options = f"{PERIODIC} -domain_box -1,1,-1,1 -domain_cells 48,48 -vesicle_center .2,.05 -vesicle_area .2"
    options += " -vesicle_reduced_area .9 -vesicle_angle 90 -obstacle_shape posts -obstacle_free all"
    options += " -obstacle_radius .2 -obstacle_center -.27,0 -obstacle_force 6,0 -contact_repulsion 100"
    options += " -contact_repulsion_range .1 -time_step .02 -output_overwrite"
    names = ("gap", "center_x", "coupled_its", "obstacle_rotation_1", "obstacle_force_x_1", "pressure_drop")
    series = agree(tmp_path, options, 0.2, 0.4, names, (3,), rel=1e-8)["whole"].series
    borne = series["obstacle_force_x_1"] + 6
    assert borne[0] > 2 and series["gap"].min() > 0.05
    balance = 2 * series["pressure_drop"] + 6  # of all forces on the fluid
    assert abs(balance[0]) < 1e-10 and np.abs(balance).max() < 1e-3


def test_discs_come_to_rest_on_the_floor(tmp_path):
    """Two heavy discs without vesicles: at last the wall and the other disc bear them, and the fluid rests."""
    options = f"{ALONE} -domain_box -1,1,-1,1 -domain_cells 48,48 -domain_bc_x periodic -obstacle_radius .2,.15"
    options += " -obstacle_center 0,-.3,.05,.3 -obstacle_density 2 -fluid_gravity 0,-300 -contact_repulsion 500"
    series = run_petves(tmp_path, f"{options} -contact_repulsion_range .1 -time_step .01 -time_end 1.5").series
    place = np.array([[series[f"obstacle_center_{d}_{body}"][-1] for d in "xy"] for body in (1, 2)])
    for body, radius in ((1, 0.2), (2, 0.15)):
        weight = 300 * np.pi * radius**2
        assert series[f"obstacle_force_y_{body}"][0] == pytest.approx(weight, rel=1e-6)
        assert abs(series[f"obstacle_force_y_{body}"][-1]) < 2e-3 * weight
        assert np.abs(rates(series, body)[:2]).max() < 1e-2
        assert 0.04 < place[body - 1, 1] + 1 - radius < 0.1
    assert 0.35 < np.hypot(*(place[0] - place[1]))


SHEARED = "-domain_box 0,4,0,4 -domain_bc_x periodic -flow_type shear -obstacle_shape posts -obstacle_free all"


def test_stress_of_a_sheared_channel(tmp_path):
    """A dilute suspension of discs: 1 + 2 phi. With a vesicle and bodies near walls the same from walls and forces."""
    options = f"{SHEARED} -vesicle_shape none -domain_cells 64,64 -obstacle_radius .2 -obstacle_center 2,2 {ONCE}"
    dilute = run_petves(tmp_path / "dilute", options).series["viscosity"][-1]
    assert (dilute - 1) / (np.pi * 0.2**2 / 16) == pytest.approx(2, abs=0.03)
    options = f"{SHEARED} -domain_cells 32,32 -obstacle_radius .5,.4 -obstacle_center .8,.6,3.2,2.9 -vesicle_center 2,2"
    options += " -vesicle_area .7 -vesicle_viscosity_ratio 3 -coupled_ksp_rtol 1e-10 -time_step .02 -time_end .1"
    series = run_petves(tmp_path / "dense", options, ranks=2).series
    assert series["viscosity"][-1] > 1.2
    for name in ("viscosity", "normal_stress"):
        np.testing.assert_allclose(series[f"{name}_wall"], series[name], rtol=1e-9)


def test_stress_of_a_contact_over_the_seam(tmp_path):
    """A vesicle and a disc that push one another: the stress is that of the pair half a period on, on odd cells."""
    options = "-domain_box 0,4,0,4 -domain_cells 33,33 -domain_bc_x periodic -flow_type shear -flow_center_y 2"
    options += " -vesicle_semi_axes .4,.6 -obstacle_shape posts -obstacle_radius .45 -obstacle_free all -time_step .2"
    options += " -time_end .8 -coupled_ksp_rtol 1e-12 -contact_repulsion 2000 -contact_repulsion_range .25"
    stress = []
    for vesicle, disc in ((1.5, 2.46), (3.5, 0.46)):
        places = f"-vesicle_center {vesicle},2.1 -obstacle_center {disc},1.9"
        stress.append(run_petves(tmp_path / str(vesicle), f"{options} {places}").series["normal_stress"][1:])
    assert stress[1] == pytest.approx(stress[0], rel=1e-5) and abs(stress[0]).min() > 0.01


def test_a_disc_falls_beside_a_vesicle(tmp_path):
    """runs/falling.opts shows what its header says."""
    row = run_petves(tmp_path, f"-options_file {ROOT / 'runs' / 'falling.opts'} -output_dir {tmp_path}").series
    names = [f"obstacle_{name}_1" for name in ("center_x", "center_y", "angle")]
    names += ["center_x", "center_y", "inclination"]
    exact = [0.4243, -1.1268, -0.5707, -0.4828, 0.9549, 0.8198]
    assert [row[name][-1] for name in names] == pytest.approx(exact, abs=2e-4)
    assert row["coupled_its"][5:].max() <= 4


#: A disc in the middle of a box of ten radii.
DISC = f"{ALONE} -domain_box 0,10,0,10 -obstacle_radius 1 -obstacle_center 5.013,5.027"
TIMES = [0.1, 0.2, 0.4, 0.6, 1]


def spun(folder, options):
    """Rotation at TIMES of the disc, from rest under a unit torque in fluid with inertia."""
    series = run_petves(folder, f"{DISC} {PERIODIC} -obstacle_torque 1 -time_end 1 -output_every 9 {options}").series
    assert series["coupled_its"][2:].max() <= 5
    return np.interp(TIMES, series["time"], series["obstacle_rotation_1"])


@pytest.mark.parametrize("density", ["0.02", "1", "3"])
@pytest.mark.parametrize("order, cells, within", [(2, 48, [1e-2, 3e-3, 1e-3, 1e-3, 1e-3]), (3, 96, 2.5e-3)])
def test_a_torque_from_rest(density, order, cells, within, tmp_path):
    """In unbounded fluid; the images are worth 1e-4."""
    options = f"-domain_cells {cells},{cells} -fluid_inertia unsteady -scheme_order {order} -obstacle_density {density}"
    assert (np.abs(spun(tmp_path, f"{options} -time_step .01") / EXACT["torque"][density] - 1) < within).all()


def test_inertia_is_galilean_invariant(tmp_path):
    """A disc that is spun in a stream turns as one in fluid at rest."""
    options = "-domain_cells 48,48 -fluid_inertia convective -obstacle_density .3 -time_step .02 -coupled_ksp_rtol 1e-8"
    rest, stream = (spun(tmp_path / v, f"{options} -flow_type uniform -flow_velocity {v}") for v in ("0,0", "1,.3"))
    assert stream == pytest.approx(rest, rel=2e-3)


def test_a_neutral_disc_in_shear_at_re_1(tmp_path):
    """Inertia slows its rotation; the reference is a box without walls."""
    options = f"{DISC} -domain_cells 64,64 -domain_bc_x periodic -flow_type shear -flow_center_y 5.027"
    series = run_petves(tmp_path, f"{options} -fluid_inertia convective -time_step .015 -time_end 9").series
    assert rates(series, 1, 0)[2] < -0.49
    assert rates(series, 1)[2] == pytest.approx(EXACT["sheared"]["rotation"], rel=0.01)


@pytest.mark.parametrize("order, more", [(2, 2.9), (3, 5.5)])
def test_order_in_time_with_inertia(order, more, tmp_path):
    """A heavy ellipse that turns and falls to the middle of a sheared channel: half the step, and half of that."""
    options = f"{ellipses(tmp_path, (5.013, 5.4, 1.2, 0.7))} -domain_box 0,10,0,10 -domain_cells 48,48 -time_end 3.2"
    options += " -vesicle_shape none -domain_bc_x periodic -flow_type shear -flow_center_y 5 -fluid_inertia convective"
    options += f" -obstacle_density 3 -scheme_order {order} -coupled_ksp_rtol 1e-10 -time_cfl_limit 2 -output_every 9"
    ends = []
    for step in (0.08, 0.04, 0.02):
        series = run_petves(tmp_path / str(step), f"{options} -time_step {step}").series
        ends.append([series[f"obstacle_{name}_1"][-1] for name in ("angle", "center_y", "rotation")])
    first, second = np.abs(np.diff(ends, axis=0))
    assert (first > more * second).all() and first.max() < 2e-3


@pytest.mark.parametrize("inertia", ["unsteady", "convective"])
def test_a_heavy_disc_reaches_its_speed(inertia, tmp_path):
    """From rest to the speed of quasi-steady flow, with 1 - exp(-t resistance/mass) for an upper bound."""
    options = f"{CHANNEL} -domain_cells 96,32 -flow_drive flux -obstacle_free all -obstacle_radius .1 -time_step .005"
    options += f" -obstacle_density 3 -fluid_gravity 1,0 -fluid_inertia {inertia} -time_end .5 -coupled_ksp_rtol 1e-8"
    series = run_petves(tmp_path, options).series
    speed, load = series["obstacle_velocity_x_1"], 2 * np.pi * 0.1**2
    last = load / REFERENCES["obstacles"]["faxen"]
    assert speed[0] == 0 and (np.diff(speed[:20]) > 0).all()
    assert (speed <= last * (1.0001 - np.exp(-series["time"] * load / last / (3 * np.pi * 0.1**2)))).all()
    assert speed[-1] == pytest.approx(last, rel=1e-4)
    assert series["obstacle_force_x_1"][-1] == pytest.approx(-load, rel=1e-7)


@pytest.mark.parametrize("steps", ["", "-time_adapt error -time_adapt_tol 1e-4"])
@pytest.mark.parametrize("inertia", ["unsteady", "convective", "none"])
def test_ranks_and_restart(inertia, steps, tmp_path):
    """An ellipse in a vesicle and one beside it, with inertia a light and a heavy one, without it in a vesicle three times
    as viscous: the same on three ranks; a restart has the same bits."""
    kinds = dict.fromkeys(("unsteady", "convective"), "-obstacle_density .3,3 -domain_bc_x periodic")
    kinds["none"] = "-vesicle_viscosity_ratio 3" + " -domain_bc_x periodic" * bool(steps)
    options = f"{ellipses(tmp_path, (-0.55, 0.1, 0.2, 0.15), (0.5, -0.2, 0.3, 0.2))} {steps} {kinds[inertia]}"
    options += f" -fluid_inertia {inertia}" + " -time_cfl_limit 1" * (inertia == "convective") + " -flow_type shear"
    options += " -domain_box -1.5,1.5,-1.5,1.5 -domain_cells 64,64 -vesicle_center -.5,.1 -vesicle_semi_axes .4,.45"
    options += " -obstacle_force 1,0,0,-2 -time_step .02 -output_every .1 -coupled_ksp_rtol 1e-8"
    columns = [f"obstacle_{name}_{body}" for name in ("center_y", "angle", *RATES) for body in (1, 2)]
    agree(tmp_path, options, 0.1, 0.5, ("center_x", "inclination", "coupled_its", *columns), (3,), rel=1e-6)
