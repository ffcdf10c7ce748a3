"""Membranes that stretch: capsules in shear of two boundary integrals, the stiff limit, energy, ranks, restarts."""

import math

import numpy as np
import pytest
from boundary_integral import capsule, derivative
from harness import REFERENCES, run_petves
from restarts import agree

from petves.measures import deformation
from petves.run import Run

CAPSULES = REFERENCES["capsules"]
FREE = "-domain_bc_x free -domain_bc_y free -domain_cells 32,32 -domain_box -4,4,-4,4 -output_every 1e9"
CIRCLE = f"{FREE} -flow_type shear -vesicle_semi_axes 1,1 -vesicle_bending 0 -time_step 0.05"
ELLIPSE = f"{FREE} -vesicle_area {0.7 * math.pi!r} -vesicle_reduced_area 0.7 -vesicle_bending 0.1"
FINE = "-vesicle_markers 65 -domain_cells 64,64 -time_step 0.025"
TWO = "-domain_box -3,3,-3,3 -domain_cells 32,32 -flow_type shear -vesicle_count 2 -vesicle_center -1.2,.3,1.2,-.3"
TWO += " -vesicle_area 1 -vesicle_reduced_area .9 -time_step .05"
CASES = [(law, Ca) for law in ("hooke", "green", "neo_hookean") for Ca in CAPSULES[law]]


def deformed(run) -> float:
    return deformation(run.saved("vesicle/markers"))


def angle(run) -> float:
    return run.series["inclination"][-1] / math.pi


def stretched(law: str, modulus: float) -> str:
    return f"-membrane_law {law} -membrane_stretching {modulus!r}"


@pytest.mark.parametrize(("law", "Ca"), CASES)
def test_steady_capsules(tmp_path, law, Ca):
    """Deformation to 2e-5, angle, frequency and length of the boundary integrals, to their digits. Hooke's energy and
    tension are those of the markers: E_s/2 (L - 1)^2 a length at rest, and E_s (L - 1)."""
    end, modulus = 14 if float(Ca) < 0.1 else 24, 1 / float(Ca)
    run = run_petves(tmp_path, f"{CIRCLE} {stretched(law, modulus)} -time_end {end}")
    D, theta, turns, length = CAPSULES[law][Ca]
    last = {name: values[-1] for name, values in run.series.items()}
    assert deformed(run) == pytest.approx(D, abs=2e-5)
    assert angle(run) == pytest.approx(theta, abs=6e-5)
    assert last["frequency"] / (2 * math.pi) == pytest.approx(turns, abs=1.5e-5)
    assert last["length"] / (2 * math.pi) == pytest.approx(length, abs=6e-5)
    assert abs(last["area_error"]) < 1e-12
    assert run.series["coupled_its"][6:].mean() < 3
    if law != "hooke":
        return
    X, tension = run.saved("vesicle/markers", "run.h5")[-1], run.saved("vesicle/tension", "run.h5")[-1]
    stretch = np.linalg.norm(derivative(len(X)) @ X, axis=1) * len(X) / (2 * math.pi)  # the radius is 1
    assert last["energy_stretching"] == pytest.approx(modulus * math.pi * np.mean((stretch - 1) ** 2), rel=1e-10)
    assert tension == pytest.approx(modulus * (stretch - 1), abs=2e-4)
    assert run.saved("vesicle/stretch", "run.h5")[-1] == pytest.approx(stretch, abs=1e-9)
    assert Run.read(run.folder).stretch[-1] == pytest.approx(stretch, abs=1e-9)


def test_transient_is_of_the_order_of_the_scheme(tmp_path):
    """D at t = 4 of the explicit boundary integral; order 2 gains 4 by half the step, order 3 has 1e-6 at dt = .05."""
    for Ca, (D, theta) in CAPSULES["hooke_transient"].items():
        run = run_petves(tmp_path / Ca, f"{CIRCLE} {stretched('hooke', 1 / float(Ca))} {FINE} -time_end 4")
        assert deformed(run) == pytest.approx(D, abs=1e-5)
        assert angle(run) == pytest.approx(theta, abs=1e-5)
    capsule = f"{CIRCLE} {stretched('hooke', 10.0)} -coupled_ksp_rtol 1e-12 -time_end 1"
    errors = {}
    fine = deformed(run_petves(tmp_path / "fine", f"{capsule} -time_step {1 / 320}"))
    for order, steps in ((2, 20), (2, 40), (3, 20), (3, 80)):
        options = f"{capsule} -scheme_order {order} -time_step {1 / steps}"
        errors[order, steps] = abs(deformed(run_petves(tmp_path / f"{order}.{steps}", options)) - fine)
    assert errors[2, 20] > 3.8 * errors[2, 40]
    assert errors[3, 20] < 2e-6 and errors[3, 80] < 1e-7


TENSIONS = {
    "hooke": lambda stretch: stretch - 1,
    "green": lambda stretch: (stretch**3 - stretch) / 2,
    "neo_hookean": lambda stretch: (stretch**1.5 - stretch**-1.5) / 3,
}


@pytest.mark.parametrize("law", TENSIONS)
def test_markers_are_those_of_an_explicit_code(tmp_path, law):
    """Every marker after a strain of 1.5, Ca = .1, of another method in all: explicit steps, forces from tensions."""
    run = run_petves(tmp_path, f"{CIRCLE} {stretched(law, 10.0)} -time_step 0.0125 -time_end 1.5 -output_every 1.5")
    first, last = run.saved("vesicle/markers", "run.h5")
    exact = capsule(first, lambda stretch: 10 * TENSIONS[law](stretch), 1.0, 1.5)
    assert np.abs(last - exact).max() < 2e-6 and np.abs(last - first).max() > 0.5


def test_adaptive_steps_of_a_capsule_with_uneven_edges(tmp_path):
    """Ca = 2/3: edges differ by 3 and steps go on, to the deformation of fixed steps."""
    strong = f"{CIRCLE} {stretched('hooke', 1.5)} -time_end 8"
    run = run_petves(tmp_path / "adapt", f"{strong} -time_adapt error -time_adapt_tol 1e-4")
    assert run.series["edge_ratio"].max() > 3
    assert deformed(run) == pytest.approx(deformed(run_petves(tmp_path / "fixed", strong)), abs=5e-6)


def test_small_capillary_number(tmp_path):
    """Ca = 1e-4, steps of 100 times its own time: D sqrt((3 D^2/(8 Ca))^2 + 1) = 1/2, the limit without bending."""
    run = run_petves(tmp_path, f"{CIRCLE} {stretched('hooke', 1e4)} -time_step 0.1 -time_end 60")
    D = deformed(run)
    assert D * math.hypot(3 * D**2 / 8e-4, 1) == pytest.approx(0.5, rel=0.01)
    assert pytest.approx(0.050998, rel=0.005) == D


def test_box_contrast_and_number(tmp_path):
    """Images of a periodic box of 20 on 64^2; a viscosity ratio of 5 on its way; -flow_ca_stretching is the rate."""
    box = "-domain_bc_x periodic -domain_bc_y periodic -domain_box -10,10,-10,10 -domain_cells 64,64"
    box += " -fluid_inertia none"
    run = run_petves(tmp_path / "box", f"{CIRCLE} {box} {stretched('hooke', 10.0)} -time_end 10")
    assert deformed(run) == pytest.approx(CAPSULES["box_of_20"], abs=2e-4)
    ratio = f"{CIRCLE} {stretched('hooke', 10.0)} -vesicle_viscosity_ratio 5 -time_end 15"
    run = run_petves(tmp_path / "ratio", ratio)
    assert [deformed(run), angle(run)] == pytest.approx(CAPSULES["ratio_5_at_15"], abs=2e-6)
    same = run_petves(tmp_path / "ca", f"{ratio} -flow_ca_stretching 0.1 -time_end 0")
    assert same.resolved["-flow_rate"] == run.resolved["-flow_rate"]


def test_membrane_viscosity(tmp_path):
    """Ca = .1 and a membrane viscosity of 1: D, angle and frequency of a dense prototype."""
    run = run_petves(tmp_path / "shear", f"{CIRCLE} {stretched('hooke', 10.0)} -membrane_viscosity 1 -time_end 16")
    D, theta, frequency = CAPSULES["viscous"]
    assert [deformed(run), angle(run)] == pytest.approx([D, theta], abs=5e-6)
    assert run.series["frequency"][-1] == pytest.approx(frequency, rel=5e-5)


@pytest.mark.parametrize("law", ["hooke", "green"])
def test_stiff_membranes_are_inextensible(tmp_path, law):
    """V = .7: angle and frequency of the boundary integral; at E_s = 1e5 those of an inextensible one within 2e-5."""
    scene = f"{ELLIPSE} -flow_type shear -time_step 0.05 -time_end 20"
    found = {}
    for modulus in (1e3, 1e5):
        run = run_petves(tmp_path / str(modulus), f"{scene} {stretched(law, modulus)}")
        found[modulus] = np.array([angle(run), run.series["frequency"][-1]])
    plain = run_petves(tmp_path / "plain", scene)
    limit = np.array([angle(plain), plain.series["frequency"][-1]])
    assert limit == pytest.approx(CAPSULES["vesicle"]["infinity"], rel=2e-5)
    assert found[1e3] == pytest.approx(CAPSULES["vesicle"]["1000"], rel=5e-5)
    assert found[1e5] == pytest.approx(limit, abs=2e-5)
    assert found[1e5] - limit == pytest.approx((found[1e3] - limit) / 100, rel=0.02)  # first order in 1/E_s


def relaxed(folder, options, step, left):
    """The series of 40 steps of a fluid at rest, in which bending and stretching together gain no energy, to the tolerance
    of the solver, and of which so much is left."""
    series = run_petves(folder, f"{options} -time_step {step} -time_end {40 * step}").series
    energy = series["energy_bending"] + series["energy_stretching"]
    assert np.all(np.diff(energy) < 1e-8 * energy[0]) and energy[-1] < left * energy[0]
    return series


#: Steps up to 1e7 of the time of stretching; of other moments than the quadratic one some of them.
SOME = [(100, 0.01), (100, 10), (1e4, 1000)]
RELAXING = [(None, *row) for row in [*SOME, (1, 0.01), (1, 0.3), (1e4, 0.3)]]
RELAXING += [(moment, *row) for moment in ("angle", "helfrich") for row in SOME]


@pytest.mark.parametrize(("moment", "modulus", "step"), RELAXING)
def test_relaxing_never_gains_energy(tmp_path, moment, modulus, step):
    bends = f"-membrane_moment {moment}" if moment else ""
    relaxed(tmp_path, f"{ELLIPSE} {stretched('hooke', float(modulus))} {bends}", step, 0.9)


def test_stretch_and_curvature_are_implicit_together(tmp_path):
    """Bending by Helfrich with many markers, c_b and E_s R0^2 of one size: no gain of energy in steps of .04."""
    options = f"{ELLIPSE} -vesicle_bending .3 -vesicle_markers 161 -domain_cells 96,96 -membrane_moment helfrich"
    relaxed(tmp_path, f"{options} {stretched('hooke', 6.0)}", 0.04, 1)


@pytest.mark.parametrize("moment", CAPSULES["moments"])
def test_bending_of_stretched_capsules(tmp_path, moment):
    """Ca = .1: D, angle, frequency and length of two boundary integrals, with kappa0 = 1 and without; quadratic bending is another material."""
    bending, memory, *targets = CAPSULES["moments"][moment]
    options = f"-vesicle_bending {bending} -membrane_memory {int(memory)} -membrane_moment {moment} -time_end 24"
    run = run_petves(tmp_path, f"{CIRCLE} {stretched('hooke', 10.0)} {options}")
    found = [deformed(run), angle(run), run.series["frequency"][-1] / (2 * math.pi)]
    assert found == pytest.approx(targets, abs=3e-6)


def test_shape_at_rest_of_a_file(tmp_path):
    """A circle at rest of 0.8 of the radius: tension E_s/4 and its energy from frame 0 on. An ellipse that is at rest as a
    circle of its area becomes it, by steps of any size, without a gain of energy after the first step."""
    round_ = 2 * math.pi * np.arange(200) / 200
    for name, radius in (("small", 0.8), ("one", 1.0)):
        np.savetxt(tmp_path / f"{name}.txt", radius * np.c_[np.cos(round_), np.sin(round_)])
    small = f"{FREE} -vesicle_semi_axes 1,1 -vesicle_bending 0.01 {stretched('hooke', 10.0)} -membrane_rest {tmp_path}/small.txt"
    run = run_petves(tmp_path / "small", f"{small} -time_step 0.1 -time_end 1")
    assert run.saved("vesicle/tension", "run.h5") == pytest.approx(np.full((2, 45), 2.5), abs=1e-6)
    assert run.series["energy_stretching"] == pytest.approx(np.full(11, 0.5 * math.pi), rel=1e-7)
    one = f"{FREE} -vesicle_semi_axes 1.25,.8 -vesicle_bending 0.1 -membrane_memory 1 -membrane_rest {tmp_path}/one.txt"
    for modulus, step in ((1.0, 1.0), (100.0, 1.0), (1e4, 1.0), (100.0, 100.0)):
        series = relaxed(tmp_path / f"{modulus}.{step}", f"{one} {stretched('hooke', modulus)}", step, 2e-5)
        assert series["length"][-1] == pytest.approx(2 * math.pi, rel=2e-6)


@pytest.mark.parametrize("step", [0.02, 1, 100])
def test_memory_keeps_the_shape(tmp_path, step):
    """An ellipse that remembers its curvature stays, by steps of any size, to what its markers resolve; no step gains energy."""
    options = f"{ELLIPSE} -membrane_memory 1 -time_step {step} -time_end {20 * step}"
    run = run_petves(tmp_path, options)
    assert deformed(run) == pytest.approx(0.46881, abs=5e-5)
    assert np.diff(run.series["energy_bending"]).max() < 1e-9


def test_memory_turns_a_shape_to_its_rest(tmp_path):
    """An ellipse whose memory is that of the ellipse turned by a third of its markers finds the shape again, without a gain of energy."""
    round_ = 2 * math.pi * (np.arange(200) / 200 + 1 / 3)
    np.savetxt(tmp_path / "rest.txt", np.c_[np.cos(round_), 0.4 * np.sin(round_)])
    ellipse = f"{FREE} -vesicle_semi_axes 1,.4 -vesicle_bending 0.1"
    ellipse += f" -membrane_memory 1 -membrane_rest {tmp_path}/rest.txt"
    for step in (0.02, 1):
        series = run_petves(tmp_path / str(step), f"{ellipse} -time_step {step} -time_end 60").series
        energy = series["energy_bending"]
        assert np.diff(energy).max() < 1e-4 * energy[0] and energy[-1] < 1e-3 * energy[0]


def test_memory_swings_and_tumbles(tmp_path):
    """V = .7 in shear: angles over pi between which it swings, of a dense prototype in unbounded fluid; c_b = 1 tumbles."""
    scene = f"{ELLIPSE} -flow_type shear -membrane_memory 1 -time_step 0.05"
    for bending, between in (("0.1", (0.104, 0.139)), ("0.3", (0.050, 0.166))):
        run = run_petves(tmp_path / bending, f"{scene} -vesicle_bending {bending} -time_end 40")
        angles = run.series["inclination"][400:] / math.pi
        assert [angles.min(), angles.max()] == pytest.approx(between, abs=1e-3)
    angles = run_petves(tmp_path / "1", f"{scene} -vesicle_bending 1 -time_end 20").series["inclination"] / math.pi
    assert angles.min() < -0.45 and angles.max() > 0.45


def test_water_inflates_a_circle(tmp_path):
    """E_s = 2, membrane viscosity 1.5, permeability .3, osmotic pressures 3 pi/A and 1.2: R(2) of the equation for R, which
    orders 2 and 3 reach with their order, whatever the viscosity inside: the fluid is at rest."""
    circle = f"{FREE} -vesicle_semi_axes 1,1 -vesicle_bending 0 {stretched('hooke', 2.0)} -membrane_viscosity 1.5"
    water = "-membrane_permeability 0.3 -membrane_osmotic 3,1.2 -time_end 2"
    error = {}
    for order, steps in ((2, 20), (2, 40), (3, 10), (3, 20)):
        options = f"{circle} {water} -scheme_order {order} -time_step {1 / steps} -vesicle_viscosity_ratio {5 if order > 2 else 1}"
        run = run_petves(tmp_path / f"{order}.{steps}", options)
        error[order, steps] = abs(math.sqrt(run.series["area"][-1] / math.pi) - CAPSULES["inflated"])
        assert abs(run.saved("fluid/u", "run.h5")[-1]).max() < 5e-4
    assert error[2, 20] < 1e-4 and error[2, 40] < error[2, 20] / 3.5
    assert error[3, 10] < 2e-5 and error[3, 20] < error[3, 10] / 6


@pytest.mark.parametrize("derivative", ["fd", "bending", "spectral"])
def test_water_passes_along_normals(tmp_path, derivative):
    """A circle at rest that water inflates does not turn: each marker goes outward."""
    circle = f"{FREE} -vesicle_semi_axes 1,1 -vesicle_bending 0 {stretched('hooke', 2.0)}"
    circle += f" -membrane_derivative {derivative}"
    water = "-membrane_permeability 0.3 -membrane_osmotic 3,1.2 -time_step 0.1 -time_end 0.5"
    X = run_petves(tmp_path, f"{circle} {water}").saved("vesicle/markers", "run.h5")
    first, last = X[0, :, 0] + 1j * X[0, :, 1], X[-1, :, 0] + 1j * X[-1, :, 1]
    assert (abs(last) > 1.1).all() and abs(np.angle(last / first)).max() < 1e-8


def test_water_passes_without_near_field(tmp_path):
    """What the pressure drives back does not hang on the near field: the same area in a box of four walls."""
    circle = f"-domain_box -3,3,-3,3 -domain_cells 48,48 -fluid_inertia none -vesicle_semi_axes 1,1 {stretched('hooke', 2.0)}"
    water = "-membrane_permeability 0.3 -membrane_osmotic 3,1.2 -time_step 0.05 -time_end 0.5"
    plain = "-coupling_near_field none -coupling_box_part false"
    runs = [run_petves(tmp_path / str(k), f"{circle} {water} {more}") for k, more in enumerate(("", plain))]
    areas = [run.series["area"][-1] for run in runs]
    assert areas[0] == pytest.approx(areas[1], rel=1e-3) and areas[0] > 1.3 * math.pi


def test_permeable_vesicles(tmp_path):
    """At rest they swell into circles, whose tension is 3/2 - 1/2 of c_b/R0^2 below zero; in shear V and angle settle."""
    scene = f"{ELLIPSE} -vesicle_bending 1"
    rest = f"{scene} -membrane_permeability 0.05 -time_step 0.1 -time_end 60 -coupled_ksp_rtol 1e-8"
    run = run_petves(tmp_path / "rest", rest)
    assert 4 * math.pi * run.series["area"][-1] / run.series["length"][-1] ** 2 == pytest.approx(1, abs=1e-9)
    assert run.saved("vesicle/tension") == pytest.approx(-1, abs=1e-6)
    for chi, (P, V, theta) in CAPSULES["permeable"].items():
        rate = f"-flow_type shear -flow_rate {chi} -time_step {0.05 / math.sqrt(int(chi))} -time_end {90 / int(chi)}"
        run = run_petves(tmp_path / chi, f"{scene} {rate} -membrane_permeability {P}")
        last = {name: values[-1] for name, values in run.series.items()}
        assert 4 * math.pi * last["area"] / last["length"] ** 2 == pytest.approx(V, abs=1e-3)
        assert angle(run) == pytest.approx(theta, abs=1e-3)


def test_iterations_of_many_markers(tmp_path):
    """What passes the membrane does not take more iterations above 300 markers, 20 times as viscous inside."""
    options = (
        f"{ELLIPSE} -vesicle_markers 303 -vesicle_allow_close_markers -flow_type shear -time_step .02 -time_end .4"
    )
    run = run_petves(
        tmp_path, f"{options} -membrane_permeability 1 -membrane_osmotic .2,.1 -vesicle_viscosity_ratio 20"
    )
    assert run.series["coupled_its"][2:].mean() < 5


@pytest.mark.parametrize("ratio", [1, 5])
def test_area_grows_by_the_law_of_water(tmp_path, ratio):
    """dA/dt = P INT (f.n + Pi) ds, f of tension and bending by the markers' Fourier series, Pi = 3 A0/A - 1."""
    water = "-membrane_permeability 0.05 -membrane_osmotic 3,1 -time_step 0.01 -time_end 0.5 -coupled_ksp_rtol 1e-12"
    run = run_petves(tmp_path, f"{ELLIPSE} -vesicle_bending 1 {water} -vesicle_viscosity_ratio {ratio}")
    X, U, tension = (run.saved(f"vesicle/{name}", "run.h5")[-1] for name in ("markers", "velocity", "tension"))
    size = np.linalg.norm(derivative(len(X)) @ X, axis=1, keepdims=True)
    along = lambda values: derivative(len(X)) @ values / size  # the derivative by the arc length
    tangent = along(X)
    normal = tangent @ [[0, -1], [1, 0]]
    force = along(tension[:, None] * tangent) - along(along(along(tangent)))
    osmotic = 3 * 0.7 * math.pi / run.series["area"][-1] - 1
    grown, passed = (np.sum(size[:, 0] * values) for values in ((U * normal).sum(1), (force * normal).sum(1) + osmotic))
    assert grown == pytest.approx(0.05 * passed, rel=1e-6) and grown > 0


@pytest.mark.parametrize("wanted", [1e-2, 1e-3])
def test_accuracy_asked_for(tmp_path, wanted):
    """-scheme_auto: a capsule in shear against the boundary integral, and one that an extension draws to 1.55 of its length
    and a thin shape against many markers and small steps, its points over R0."""
    shear = f"-domain_bc_x free -domain_bc_y free -flow_type shear -vesicle_semi_axes 1,1 -vesicle_bending 0 {stretched('hooke', 10.0)}"
    run = run_petves(tmp_path / "shear", f"{shear} -scheme_auto {wanted} -time_end 24")
    assert [deformed(run), angle(run)] == pytest.approx(CAPSULES["hooke"]["0.1"][:2], abs=0.1 * wanted)
    drawn = f"-domain_bc_x free -domain_bc_y free -flow_type extension -vesicle_semi_axes 1,1 -vesicle_bending 0.02 {stretched('green', 4.0)}"
    drawn += " -scheme_auto {} -time_end 3 -output_every 1e9"
    points = []
    for name, more in (("auto", ""), ("fine", "-vesicle_markers 101 -time_adapt_tol 1e-6 -time_adapt_max_step 0.02")):
        run = run_petves(tmp_path / name, f"{drawn.format(wanted if name == 'auto' else 1e-4)} {more}")
        X = run.saved("vesicle/markers", "run.h5")[-1]
        modes = np.fft.fft(X[:, 0] + 1j * X[:, 1]) / len(X)
        wave = np.fft.fftfreq(len(X), 1 / len(X))
        points.append(np.exp(1j * np.outer(np.linspace(0, 2 * np.pi, 200), wave)) @ modes)
    assert abs(points[0] - points[1]).max() < wanted


APART = 4e4


def test_laws_of_kinds(tmp_path):
    """Four membranes that hardly feel one another, with laws, moduli and viscosities of their own, move as they do alone."""
    laws, moduli, viscosities = ("hooke", "inextensible", "neo_hookean", "green"), (10, 0, 5, 20), (1, 0, 0.5, 0)

    def run(name, of):
        law, modulus, viscosity = (",".join(str(of_all[k]) for k in of) for of_all in (laws, moduli, viscosities))
        options = f"-membrane_law {law} -membrane_stretching {modulus} -membrane_viscosity {viscosity}"
        centers = ",".join(f"{APART * k!r},0" for k in range(len(of)))
        many = f"-vesicle_count {len(of)} -vesicle_center {centers} -vesicle_angle 30 -flow_type shear"
        options += " -coupled_ksp_rtol 1e-12 -scheme_order 2 -time_step 0.05 -time_end 1"
        return run_petves(tmp_path / name, f"{ELLIPSE} {many} {options}")

    both = run("all", [0, 1, 2, 3])
    stretching = 0.0
    for k in range(4):
        alone = run(str(k), [k])
        for name in ("markers", "tension", "stretch"):
            found = both.saved(f"vesicle/{name}", "run.h5")[-1][45 * k :][:45]
            wanted = alone.saved(f"vesicle/{name}", "run.h5")[-1] if k != 1 or name != "stretch" else np.ones(45)
            shift = found.mean(axis=0) - wanted.mean(axis=0) if name == "markers" else 0
            assert found - shift == pytest.approx(wanted, abs=1e-7), name
        for name in ("length", "area", "inclination", "frequency"):
            assert both.series[f"{name}_{k + 1}"] == pytest.approx(alone.series[name], abs=1e-8, nan_ok=True)
        stretching += alone.series["energy_stretching"] if k != 1 else 0
    assert both.series["energy_stretching"] == pytest.approx(stretching, rel=1e-7) and stretching[-1] > 0.1


GREEN = f"{TWO} -vesicle_viscosity_ratio 3,.5 -membrane_law green -membrane_viscosity .5 -membrane_memory 1"
KINDS = TWO.replace("-vesicle_count 2 -vesicle_center -1.2,.3,1.2,-.3", "-vesicle_count 3 -vesicle_mixture .4,.6")
KINDS += " -vesicle_center -1.5,.3,0,-.8,1.5,.6 -vesicle_viscosity_ratio 3,.5 -membrane_law neo_hookean,inextensible"
#: More ranks than vesicles: the dense block of both is on one rank, the places where they bend on others.
RANKS = {
    "permeable": f"{TWO} -vesicle_bending .05 -membrane_permeability .2 -membrane_osmotic 1,.5 -membrane_memory 1",
    "angle": f"{GREEN} -membrane_stretching 2 -membrane_moment angle -domain_bc_x periodic -membrane_permeability .1 -membrane_osmotic 1,.5",
    "helfrich": f"{GREEN} -membrane_stretching 2 -membrane_moment helfrich -domain_bc_x periodic",
    "laws of kinds": f"{KINDS} -membrane_stretching 2,0 -membrane_viscosity .5,0 -membrane_memory 1",
    "one of two": f"{GREEN} -membrane_stretching 2,0 -membrane_memory 1,.5",
}
#: Those of RANKS that are inextensible, the others stretch.
STIFF = {"laws of kinds": (1, 3), "one of two": (2,)}


@pytest.mark.parametrize("name", RANKS)
def test_ranks_and_restart(tmp_path, name):
    """In a channel and between four walls: permeable membranes, bending of stretched ones, a neo-Hookean membrane with contrast among
    inextensible ones, and one that stretches beside one that does not, with memories of their own."""
    columns = ["center_x_1", "inclination_2", "length_1", "area_2", "length_2", "coupled_its"]
    columns += ["energy_stretching"] * (name != "permeable")
    whole = agree(tmp_path, RANKS[name], 0.1, 0.2, columns, (3,))["whole"].series
    if name == "permeable":
        assert whole["coupled_its"][2:].mean() < 5
        return
    for vesicle in range(1, 4 if name == "laws of kinds" else 3):
        error = abs(whole[f"length_error_{vesicle}"]).max()
        assert error < 1e-7 if vesicle in STIFF.get(name, ()) else error > 1e-4, vesicle
