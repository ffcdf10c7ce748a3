"""Flows by their dimensionless numbers, the red cell's outline, and curves of a file turned about their centroids.
petves numbers: options from SI numbers; petves scenes and run NAME: scenes that come with petves."""

import json
import re

import h5py
import numpy as np
import pytest
from harness import ROOT, read_series, run_petves, run_tool
from restarts import without_wall

import petves
from petves.curves import trigonometric
from petves.program import scene_file, scene_files

SMALL = f"-domain_cells 32,32 -domain_box -2,2,-2,2 -time_step 0.1 -time_end 0.1 -output_every 10"
VIEW = re.compile(r"background flow: \w+, (?:rate|u_max) = (\S+): .* = (\S+) with R0 = (\S+), nu R0\^3/c_b = (\S+)\n")


def markers(run) -> np.ndarray:
    return run.saved("vesicle/markers", "run.h5")[0]


def spectral_measures(X: np.ndarray) -> tuple[float, float, complex]:
    """Area, length and centroid of the trigonometric curve through markers."""
    z = trigonometric(X, 8 * len(X)) @ [1, 1j]
    dz = np.fft.ifft(np.fft.fft(z) * 2j * np.pi * np.fft.fftfreq(len(z), 1 / len(z)))
    area = np.mean((z.conj() * dz).imag) / 2
    centroid = np.mean(z * (z.conj() * dz).imag) / 3 / area
    return area, np.mean(np.abs(dz)), centroid


def test_chi_is_the_rate_that_it_stands_for(tmp_path):
    """V = 0.7, unit area: R0 = 1/sqrt(pi V), rate = chi c_b/(nu R0^3)."""
    scene = f"{SMALL} -flow_type shear -vesicle_area 1 -vesicle_reduced_area 0.7"
    scene += " -fluid_viscosity 2 -vesicle_bending 0.03"
    chi = run_petves(tmp_path / "chi", f"{scene} -flow_chi 10 -view")
    rate = 10 * 0.03 / 2 * np.sqrt(np.pi * 0.7) ** 3
    assert float(chi.resolved["-flow_rate"]) == pytest.approx(rate, rel=1e-9)
    shown = [float(x) for x in VIEW.search(chi.stdout).groups()]
    assert shown == pytest.approx([rate, 10, 1 / np.sqrt(np.pi * 0.7), 10 / rate], rel=1e-5)
    assert "-flow_chi" not in chi.resolved
    again = run_petves(tmp_path / "rate", f"{scene} -flow_rate {chi.resolved['-flow_rate']}", 2)
    first, second = chi.series, again.series
    assert np.max(np.abs(first["inclination"] - second["inclination"])) < 1e-10
    run_petves(tmp_path / "again", ["-options_file", chi.folder / "resolved.opts"])
    assert without_wall(tmp_path / "again") == without_wall(chi.folder)


@pytest.mark.parametrize(
    "flow, power, name",
    [("extension -flow_chi 3", 3, "-flow_rate"), ("poiseuille -flow_ca 3", 2, "-flow_peak_velocity")],
)
def test_numbers_go_by_the_largest_vesicle(flow, power, name, tmp_path):
    """Circles of radius .3 and .4."""
    two = "-vesicle_count 2 -vesicle_center -1,0,1,0 -vesicle_semi_axes 0.3,0.3,0.4,0.4 -fluid_inertia none"
    run = run_petves(tmp_path / "run", f"{SMALL} {two} -flow_type {flow} -time_end 0 -view")
    assert float(run.resolved[name]) == pytest.approx(3 * 0.01 / 0.4**power, rel=1e-9)
    assert float(VIEW.search(run.stdout)[2]) == pytest.approx(3, rel=1e-5)


@pytest.mark.parametrize(
    "words, found",
    [
        ("-flow_chi 10", {"-flow_rate": 0.1 * np.sqrt(np.pi * 0.7) ** 3}),
        ("-vesicle_semi_axes 0.3,0.3 -flow_rate 3", {"-flow_rate": 3, "-vesicle_semi_axes": 0.3}),
        ("-vesicle_spacing 1", {"-vesicle_markers": 0, "-vesicle_spacing": 1}),
    ],
)
def test_an_option_replaces_its_alternatives_of_a_file(words, found, tmp_path):
    """What is typed, and what a file says behind those that it includes; two of one source are refused."""
    inner, outer = tmp_path / "inner.opts", tmp_path / "outer.opts"
    given = "-flow_type shear -flow_rate 2 -vesicle_area 1 -vesicle_reduced_area 0.7 -vesicle_markers 45"
    inner.write_text(given.replace(" -", "\n-"))
    outer.write_text(f"-options_file {inner}\n" + words.replace(" -", "\n-"))
    for name, scene in (("typed", f"-options_file {inner} {words}"), ("file", f"-options_file {outer}")):
        given = run_petves(tmp_path / name, f"{scene} {SMALL} -time_end 0").resolved
        for option, value in found.items():
            assert float(given[option].split(",")[0]) == pytest.approx(value, rel=1e-9), (name, option)
        assert ("-vesicle_area" in given) != ("-vesicle_semi_axes" in found)
    done = run_petves(tmp_path / "both", f"-options_file {outer} -flow_chi 1 -flow_rate 1 {SMALL}", good=False)
    assert done.errors == ["petves: error: -flow_chi 1.: given together with -flow_rate; allowed: one of them"]


def test_red_cells_of_two_kinds_in_shear(tmp_path):
    """Areas and bending by -vesicle_mixture; chi by the largest of either."""
    scene = f"{SMALL} -domain_box -3,3,-3,3 -vesicle_shape biconcave -vesicle_count 3 -vesicle_center -1.5,0,0,0,1.5,0"
    kinds = "-vesicle_mixture 0.7,0.3 -vesicle_area 0.5,0.8 -vesicle_bending 0.01,0.02 -vesicle_angle 90"
    run = run_petves(tmp_path / "run", f"{scene} {kinds} -flow_type shear -flow_chi 5 -time_end 0 -view")
    R0 = np.sqrt(0.8 / (np.pi * 0.65))
    assert float(run.resolved["-flow_rate"]) == pytest.approx(5 * 0.02 / R0**3, rel=1e-6)
    assert float(VIEW.search(run.stdout)[2]) == pytest.approx(5, rel=1e-5)
    with h5py.File(run.folder / "run.h5") as file:
        start, X = file.attrs["vesicle_start"], file["vesicle/markers"][0]
        assert list(file.attrs["vesicle_c_b"]) == [0.01, 0.02, 0.01]
    for v, area in enumerate((0.5, 0.8, 0.5)):
        measured, _, centroid = spectral_measures(X[start[v] : start[v + 1]])
        assert measured == pytest.approx(area, rel=1e-6) and abs(centroid - (1.5 * v - 1.5)) < 1e-5


def test_chi_can_be_swept(tmp_path):
    scene = f"{SMALL} -flow_type shear -vesicle_semi_axes 0.4,0.4"
    (tmp_path / "shared.opts").write_text(re.sub(r" (?=-[a-z])", "\n", scene) + "\n")
    words = f"sweep {tmp_path}/s --options-file {tmp_path}/shared.opts --vary flow_chi 1 10".split()
    done = run_tool(*words)
    assert done.returncode == 0, done.stderr
    files = [tmp_path / "s" / f"flow_chi={chi}" / "resolved.opts" for chi in (1, 10)]
    rates = [re.search(r"-flow_rate (\S+)", file.read_text())[1] for file in files]
    assert float(rates[1]) == pytest.approx(10 * float(rates[0]), rel=1e-12)


@pytest.mark.parametrize("given, V", [("", 0.65), ("-vesicle_reduced_area 0.461009301", 0.461009301)])
def test_biconcave_is_the_red_cell_s_outline(given, V, tmp_path):
    """Area, reduced area, symmetry, and with the cell's own V the profile of Evans and Fung: .207 of its radius thick in the
    middle, thickest, .656, at .77 of it."""
    scene = f"{SMALL} -vesicle_shape biconcave {given} -vesicle_area 0.9 -vesicle_markers 131 -time_end 0"
    X = markers(run_petves(tmp_path / "run", f"{scene} -vesicle_allow_close_markers"))
    area, length, centroid = spectral_measures(X)
    assert area == pytest.approx(0.9, rel=1e-8) and 4 * np.pi * area / length**2 == pytest.approx(V, rel=1e-7)
    assert abs(centroid) < 1e-7
    radius = X[:, 0].max()
    upper = X[X[:, 1] > 0]
    upper = upper[np.argsort(upper[:, 0])]
    middle = 2 * np.interp(0, *upper.T) / radius
    thickest = 2 * upper[:, 1].max() / radius
    assert middle < 0.65 * thickest, "it has dimples"
    if given:
        assert middle == pytest.approx(0.207, abs=1e-3) and thickest == pytest.approx(0.656, abs=1e-3)


def test_a_file_s_curve_turns_about_its_centroid(tmp_path):
    """An egg beside the origin, turned by 90 degrees and moved."""
    turn = np.exp(2j * np.pi * np.arange(200) / 200)
    egg = 0.4 * turn + 0.07 * turn**2 + (0.4 - 0.3j)
    np.savetxt(tmp_path / "egg.txt", np.c_[egg.real, egg.imag])
    about = spectral_measures(np.c_[egg.real, egg.imag])[2]
    assert abs(about - (0.4 - 0.3j)) > 0.05, "its parameter's middle is another point"
    file = f"{SMALL} -vesicle_shape file -vesicle_file {tmp_path}/egg.txt -time_end 0"
    first = markers(run_petves(tmp_path / "still", file)) @ [1, 1j]
    last = markers(run_petves(tmp_path / "turned", f"{file} -vesicle_angle 90 -vesicle_center 0.2,0.1")) @ [1, 1j]
    np.testing.assert_allclose(last, 1j * (first - about) + about + (0.2 + 0.1j), rtol=0, atol=1e-6)
    ends = [spectral_measures(np.c_[z.real, z.imag])[2] for z in (first, last)]
    assert abs(ends[0] - about) < 1e-6 and abs(ends[1] - about - (0.2 + 0.1j)) < 1e-6


#: In other units of time and mass: the same flow with a viscosity, a rate and a bending stiffness that go with them.
UNITS = {
    "quasi-steady": ("-fluid_inertia none -flow_rate 1 -time_step 0.1 -time_end 2", "-fluid_viscosity 64 -vesicle_bending 1.28"),
    "unsteady": (
        "-fluid_inertia unsteady -flow_rate 1 -time_step 0.1 -time_end 2",
        "-fluid_viscosity 64 -vesicle_bending 81.92 -flow_rate 64 -time_step 0.0015625 -time_end 0.03125",
    ),
}  # fmt: skip


@pytest.mark.parametrize("walls", ["", "-domain_bc_x periodic"], ids=["box", "channel"])
@pytest.mark.parametrize("kind", UNITS)
def test_other_units_take_the_same_iterations(kind, walls, tmp_path):
    """The tolerance is relative to forces, and so are the rows that it is compared with."""
    scene, other = UNITS[kind]
    scene = f"-domain_cells 48,48 -flow_type shear -vesicle_semi_axes 0.3,0.5 -vesicle_bending 0.02 {walls} {scene}"
    one = run_petves(tmp_path / "one", scene).series
    two = run_petves(tmp_path / "two", f"{scene} {other}").series
    np.testing.assert_array_equal(two["coupled_its"], one["coupled_its"])
    np.testing.assert_allclose(two["inclination"], one["inclination"], rtol=0, atol=1e-9)


def test_curve_file_as_programs_write_it(tmp_path):
    """The last point is the first but for rounding, comments of any length, a header of CSV: the markers of the plain file."""
    t = np.linspace(0, 2 * np.pi, 101)
    points = np.column_stack([0.5 * np.cos(t), 0.8 * np.sin(t)])
    assert np.any(points[-1] != points[0])
    np.savetxt(tmp_path / "plain.txt", points[:-1], fmt="%.17g")
    np.savetxt(tmp_path / "closed.txt", points, fmt="%.17g", header="9 " * 2000)
    np.savetxt(tmp_path / "table.txt", points[:-1], fmt="%.17g", delimiter=",", header="x,y", comments="")
    scene, names = f"{SMALL} -vesicle_shape file -vesicle_file {tmp_path}", ("plain", "closed", "table")
    plain, closed, table = (markers(run_petves(tmp_path / name, f"{scene}/{name}.txt")) for name in names)
    np.testing.assert_array_equal(plain, closed)
    np.testing.assert_array_equal(plain, table)


CELL = dict(radius=3e-6, bending=2e-19, viscosity=1.2e-3, rate=100.0)


def test_numbers_are_those_of_the_run(tmp_path):
    """chi, Re and the time scale are what their definitions say; the printed lines are a scene that has them."""
    options, found = petves.numbers(**CELL)
    assert found["lambda_t"] == pytest.approx(1.2e-3 * 2.7e-17 / 2e-19) and found["chi"] == pytest.approx(16.2)
    assert found["Re"] == pytest.approx(100 * 9e-12 / 1.2e-6) and found["V"] == 0.7 and found["viscosity_ratio"] == 1
    words = ["--radius", 3e-6, "--bending", 2e-19, "--viscosity", 1.2e-3, "--rate", 100]
    done = run_tool("numbers", *words)
    assert done.returncode == 0 and "chi = 16.2, Re = 0.00075" in done.stdout.splitlines()[0]
    (tmp_path / "cell.opts").write_text(done.stdout)
    run = run_petves(tmp_path / "run", f"-options_file {tmp_path}/cell.opts -time_end 0.001")
    summary, series = json.loads((run.folder / "summary.json").read_text()), read_series(run.folder / "series.csv")
    assert summary["reynolds"] == pytest.approx(found["Re"], rel=0.01)
    assert series["length"][0] == pytest.approx(2 * 3.14159265 * 3e-6, rel=1e-6)
    assert f"-vesicle_bending {2e-19 / 1000:g}" in done.stdout.splitlines()
    assert float(options["vesicle_bending"]) == 2e-22
    with petves.Simulation(**petves.numbers(**CELL, inside=6e-3, flow="extension")[0] | {"time_end": 0}) as sim:
        assert float(sim.options["vesicle_viscosity_ratio"]) == 5 and sim.options["flow_type"] == "extension"


@pytest.mark.parametrize(
    "wrong, line",
    [
        (dict(bending=0), "bending 0: out of range; allowed: >0, in SI units"),
        (dict(reduced_area=1.2), "reduced_area 1.2: out of range"),
        (dict(flow="poiseuille"), "flow poiseuille: unknown; allowed: shear, extension"),
    ],
)
def test_numbers_that_cannot_be(wrong, line):
    with pytest.raises(petves.Error, match=line):
        petves.numbers(**CELL | wrong)


def test_scenes_run_by_name(tmp_path):
    assert scene_files()["shear"] == ROOT / "runs" / "shear.opts" and "gallery/stenosis" in scene_files()
    done = run_tool("scenes")
    assert done.returncode == 0 and len(done.stdout.splitlines()) == len(list((ROOT / "runs").rglob("*.opts")))
    assert re.search("^ *settling +A heavy vesicle sinks in a box of four walls *$", done.stdout, re.M)
    done = run_tool("run", "free", "-time_end", 0.1, "-output_dir", "out", folder=tmp_path)
    assert done.returncode == 0 and (tmp_path / "out" / "series.csv").is_file(), done.stderr
    (tmp_path / "shear").write_text("")
    assert scene_file("shear") == str(ROOT / "runs" / "shear.opts") and scene_file("-help") == "-help"
    assert scene_file(str(tmp_path / "shear")) == str(tmp_path / "shear")
    assert "No such file" in run_tool("run", "sheer", folder=tmp_path).stderr
