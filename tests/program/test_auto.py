"""-scheme_auto: what it chooses, that it is what was measured, and that a run with it has the error asked for."""

import csv
import re
from dataclasses import replace

import numpy as np
import pytest
from harness import ROOT, run_petves, run_scenes
from studies.common import paper
from studies.common.engine import Case, Results
from studies.common.scenes import words
from studies.speed_accuracy import unseen

CALIBRATION = ROOT / "docs" / "speed_accuracy" / "calibration.csv"
WANTED = (0.1, 1e-2, 1e-3, 1e-4)
BOX = "-domain_box 0,8,0,8 -flow_type shear -flow_center_y 4 -vesicle_center 4,4 -vesicle_angle 20 -fluid_inertia none"
REST = "-domain_box -1.5,1.5,-1.5,1.5 -domain_cells 48,48 -domain_bc_x periodic -domain_bc_y periodic"
REST += " -fluid_inertia none"
QUIET = "-output_every 1000 -checkpoint_every 0"


def radius(reduced_area: float) -> float:
    """R0 of unit area."""
    return (1 / (np.pi * reduced_area)) ** 0.5


def measured(table: str, value: str) -> float:
    """Worst error of a table of the calibration at a value."""
    with CALIBRATION.open() as file:
        rows = [row for row in csv.DictReader(file) if row["table"] == table and float(row["value"]) == float(value)]
        errors = [float(row["error"]) for row in rows]
    assert errors, (table, value)
    return max(errors)


def settings(text: str) -> dict[str, tuple[str, str]]:
    """Value and reason of each line that -scheme_auto prints."""
    return {name: (value, why) for name, value, why in re.findall(r"^  (-\S+) +(\S+) +(.*)$", text, re.M)}


@pytest.mark.parametrize("wanted", WANTED)
def test_choice_is_what_was_measured(wanted, tmp_path):
    """Each printed error is the table's worst at the value chosen; those of steps and solver leave room for the grid's."""
    run = run_petves(tmp_path, f"{REST} {QUIET} -vesicle_area 1 -scheme_auto {wanted} -time_end 0")
    chosen = settings(run.stdout)
    relaxation = radius(0.7) ** 3 / 0.01
    for name, table, scale in (
        ("-time_adapt_tol", "adapt_tol", 1),
        ("-coupled_ksp_rtol", "ksp_rtol", 1),
        ("-time_adapt_max_step", "max_step", relaxation),
    ):
        value, why = chosen[name]
        printed = float(re.search(r"leaves? up to (\S+)", why)[1])
        if scale == 1:
            worst = measured(table, value)
        else:  # of an ellipse of 1e-3 shorter edges: the printed multiple of nu R0^3/c_b
            multiple = float(why.split()[0])
            assert float(value) == pytest.approx(multiple * relaxation, rel=0.02)
            worst = measured(table, str(multiple))
        assert printed == pytest.approx(worst, rel=0.06), name
        assert worst <= wanted / 2, name
    assert chosen["-scheme_order"][0] == "3" and chosen["-time_adapt"][0] == "error"
    assert chosen["-delta_type"][0] == "cbs54" and "-vesicle_spacing" not in chosen


@pytest.mark.parametrize(
    "wanted, cells, reduced_area, chi",
    [(0.1, 40, 0.7, 10), (1e-2, 64, 0.5, 1), (1e-2, 64, 0.7, 10), (1e-2, 72, 0.9, 10), (1e-3, 192, 0.7, 10)],
)
def test_tank_treading_within_the_wanted_error(wanted, cells, reduced_area, chi, tmp_path):
    """Angle and frequency in the 8 x 8 box against the boundary integral, on a grid that the program calls enough."""
    bending = radius(reduced_area) ** 3 / chi
    options = f"{BOX} {QUIET} -domain_cells {cells},{cells} -vesicle_reduced_area {reduced_area} -time_end 12"
    run = run_petves(tmp_path, f"{options} -vesicle_bending {bending!r} -scheme_auto {wanted}")
    assert wanted == 0.1 or ": enough\n" in run.stdout
    angle, frequency = paper.SHEAR["box"][reduced_area, chi]
    found = run.series["inclination"][-1] / np.pi, run.series["frequency"][-1]
    np.testing.assert_allclose(found, (angle, frequency), rtol=wanted)


@pytest.mark.parametrize("wanted", (1e-2, 1e-3))
def test_shape_at_rest_within_the_wanted_error(wanted, tmp_path):
    """Energy of the shape at rest, V = 0.7, against the boundary integral's."""
    end = 20 * radius(0.7) ** 3 / 0.01
    scene = f"{REST} {QUIET} -vesicle_area 1 -vesicle_angle 90"
    run = run_petves(tmp_path, f"{scene} -time_end {end} -scheme_auto {wanted}")
    found = run.series["energy_bending"][-1] * radius(0.7) / 0.01
    assert found == pytest.approx(paper.REST[0.7][0], rel=wanted)


def test_what_is_given_stays(tmp_path):
    """Options that the user gives win and are called theirs; the resolved options repeat the run."""
    given = "-time_adapt_tol 0.02 -coupled_ksp_rtol 1e-7 -vesicle_spacing 1.25"
    base = f"{REST} {QUIET} -vesicle_area 1 -time_end 3"
    run = run_petves(tmp_path / "a", f"{base} {given} -scheme_auto 1e-2")
    chosen = settings(run.stdout)
    for name, value in zip(given.split()[::2], given.split()[1::2]):
        assert float(chosen[name][0]) == float(value) and chosen[name][1] == "yours"
    again = run_petves(tmp_path / "b", f"-options_file {run.folder}/resolved.opts -output_dir {tmp_path}/b")
    lines = [set((folder / "resolved.opts").read_text().split("\n")) for folder in (run.folder, again.folder)]
    assert {line.split()[0] for line in lines[0] ^ lines[1]} == {"-output_dir"}
    for name in ("time", "energy_bending", "nsolve"):
        np.testing.assert_array_equal(run.series[name], again.series[name])


def test_coarse_grid_is_called_so(tmp_path):
    """32 cells in a box of 8, markers 1.5 h apart, are too coarse for 1 percent: the square cells that it takes are named,
    and the markers with which it would do."""
    options = f"{BOX} {QUIET} -vesicle_area 1 -time_end 0 -scheme_auto 1e-2"
    run = run_petves(tmp_path / "coarse", f"{options} -domain_cells 32,32 -vesicle_spacing 1.5")
    assert "or this grid and -vesicle_markers 45\n" in run.stdout
    named = re.search(r"TOO COARSE for 0.01, take R0/h = (\S+), -domain_cells (\d+),(\d+)", run.stdout).groups()
    assert named[1] == named[2] and int(named[1]) * radius(0.7) / 8 >= float(named[0])
    fine = run_petves(tmp_path / "fine", f"{options} -domain_cells {named[1]},{named[2]}")
    assert ": enough\n" in fine.stdout
    wide = f"{options.replace('0,8,0,8', '0,16,0,8')} -domain_cells 56,28 -vesicle_spacing 1.5"
    named = re.search(r"-domain_cells (\d+),(\d+)", run_petves(tmp_path / "wide", wide).stdout).groups()
    assert int(named[0]) == 2 * int(named[1]) > 56


def domain(text: str, name: str) -> list[float]:
    """Numbers of -domain_box or -domain_cells as -scheme_auto prints them."""
    return [float(x) for x in settings(text)[name][0].split(",")]


def test_unbounded_where_nothing_asks_for_walls(tmp_path):
    """Neither box nor boundaries: unbounded fluid, with a window that holds both vesicles in square cells."""
    scene = f"{QUIET} -flow_type shear -vesicle_area 1 -vesicle_count 2 -vesicle_center 3,4,6,4.3 -time_end 0"
    run = run_petves(tmp_path / "a", f"{scene} -scheme_auto 1e-2")
    chosen = settings(run.stdout)
    assert [chosen[f"-domain_bc_{x}"][0] for x in "xy"] == ["free", "free"]
    assert "quasi-steady" in chosen["-domain_bc_x"][1] and "3 R0 around" in chosen["-domain_box"][1]
    box, cells = domain(run.stdout, "-domain_box"), domain(run.stdout, "-domain_cells")
    assert box[0] <= 3 - 3 * radius(0.7) and box[1] >= 6 + 3 * radius(0.7)
    assert box[2] <= 4 - 3 * radius(0.7) and box[3] >= 4.3 + 3 * radius(0.7)
    h = (box[1] - box[0]) / cells[0]
    assert h == pytest.approx((box[3] - box[2]) / cells[1]) and 10 <= radius(0.7) / h < 12
    again = run_petves(tmp_path / "b", f"-options_file {run.folder}/resolved.opts -output_dir {tmp_path}/b")
    assert settings(again.stdout)["-domain_box"][1] == "yours"
    given = run_petves(tmp_path / "c", f"{scene} -scheme_auto 1e-2 -domain_cells 96,48").stdout
    box = domain(given, "-domain_box")
    assert box[1] - box[0] == pytest.approx(2 * (box[3] - box[2])) and settings(given)["-domain_cells"][1] == "yours"


@pytest.mark.parametrize("why", ("-domain_bc_x periodic", "-fluid_inertia unsteady"))
def test_box_so_large_that_images_do_not_matter(why, tmp_path):
    """Where the fluid cannot be unbounded, the box goes by the error wanted, as 1/sqrt of it, and x is periodic."""
    scene = f"{QUIET} -flow_type shear -time_end 0 -vesicle_area 1 -coupling_box_part false {why}"
    half = {}
    for wanted in (0.1, 1e-2):
        text = run_petves(tmp_path / f"{wanted}", f"{scene} -scheme_auto {wanted}").stdout
        box, cells = domain(text, "-domain_box"), domain(text, "-domain_cells")
        half[wanted] = float(settings(text)["-domain_box"][1].split()[0])
        assert settings(text)["-domain_bc_x"][0] == "periodic" and settings(text)["-domain_bc_y"][0] == "wall"
        assert box[1] >= half[wanted] * radius(0.7) and cells[0] == cells[1]
        assert ": enough\n" in text and f"leave up to {wanted / 2:.1e}" in settings(text)["-domain_box"][1]
    assert half[1e-2] == pytest.approx(half[0.1] * 10**0.5, rel=0.01)
    most = measured("half_width", "8")
    assert most <= 1e-2 / 2 * half[1e-2] ** 2 <= 1.3 * most


def test_grid_of_a_chosen_box_goes_by_its_own_walls(tmp_path):
    """A vesicle near a side of the default box, -1,1,-1,1, is as far from the walls of its own box as any other."""
    scene = f"{QUIET} -flow_type shear -fluid_inertia unsteady -time_end 0 -scheme_auto 1e-2"
    texts = [run_petves(tmp_path / y, f"{scene} -vesicle_center 0,{y}").stdout for y in ("0", "0.48")]
    assert domain(texts[0], "-domain_cells") == domain(texts[1], "-domain_cells")


def test_box_that_is_the_question_stays(tmp_path):
    """A channel, gravity, posts and a packing keep the box they have; its grid goes by vesicles and walls."""
    scenes = """-flow_type poiseuille -flow_half_width 1
-fluid_gravity 0,-1 -vesicle_density_difference 1
-obstacle_shape posts -obstacle_center 0.7,0.7 -domain_bc_x periodic
-vesicle_packing 0.3 -vesicle_count 2 -domain_bc_x periodic -vesicle_packing_gap 0.1"""
    scenes = {k: f"{QUIET} {scene} -time_end 0 -scheme_auto 1e-2" for k, scene in enumerate(scenes.splitlines())}
    for text in (run.stdout for run in run_scenes(tmp_path, scenes).values()):
        assert domain(text, "-domain_box") == [-1, 1, -1, 1] and "yours to give" in settings(text)["-domain_box"][1]
        assert "free" not in text and domain(text, "-domain_cells")[0] < 128


@pytest.mark.parametrize("inertia", ("none", "unsteady"))
def test_grid_for_a_box(inertia, tmp_path):
    """The fewest square cells that are enough; with inertia more of them where a vesicle begins near a wall."""
    scene = f"{QUIET} -domain_box 0,12,0,5 -domain_bc_x periodic -flow_type poiseuille -flow_center_y 2.5"
    scene += f" -vesicle_area 1 -fluid_inertia {inertia} -time_end 0"
    cells = {}
    near = (1e-2, 0.5)
    cases = ((0.1, 2.5), (1e-2, 2.5), (1e-3, 2.5), near, (1e-3, 0.6))
    scenes = {case: f"{scene} -vesicle_center 3,{case[1]} -scheme_auto {case[0]}" for case in cases}
    for (wanted, height), text in ((case, run.stdout) for case, run in run_scenes(tmp_path, scenes).items()):
        nx, ny = domain(text, "-domain_cells")
        beyond = inertia == "unsteady" and (wanted, height) == (1e-3, 0.6)
        assert 5 * nx == 12 * ny and ": enough\n" in text
        assert ("TOO NEAR for 0.001, and for any grid up to R0/h = 24" in text) == beyond
        assert "TOO" not in text or beyond
        assert "nearest wall" not in text or height < 1 or inertia == "unsteady"
        cells[wanted, height] = nx
    if inertia == "none":
        assert cells[0.1, 2.5] <= cells[1e-2, 2.5] <= cells[1e-3, 2.5] <= cells[1e-3, 0.6]
    else:
        assert cells[0.1, 2.5] < cells[1e-2, 2.5] < cells[1e-3, 2.5]
        assert cells[1e-2, 2.5] < cells[near]


@pytest.mark.parametrize("peak, inertia", ((1e-3, False), (1, True)))
def test_grid_goes_by_what_inertia_stands_for(peak, inertia, tmp_path):
    """-fluid_inertia auto in a channel has inertia by the Reynolds number, and so has the choice of the grid."""
    scene = f"{QUIET} -domain_box 0,12,0,6 -domain_bc_x periodic -flow_type poiseuille -flow_center_y 3 -vesicle_area 1"
    scene += f" -vesicle_center 3,3 -flow_peak_velocity {peak} -time_end 0 -scheme_auto 0.01"
    text = run_petves(tmp_path, scene).stdout
    assert (" with inertia: enough" in text) == inertia and "TOO" not in text
    assert (domain(text, "-domain_cells")[1] > 40) == inertia


def within(found: float, table: str, values: list[str]) -> None:
    """What is printed is the worst of the calibration at a value and at finer ones, rounded up but for a digit in print."""
    worst = max(measured(table, value) for value in values)
    assert 0.99 * measured(table, values[0]) <= found <= 1.15 * worst, (table, values[0])


WALL = re.compile(r"nearest wall: (\S+) cells, which leaves up to (\S+) of R0")
FLUIDS = {
    "-fluid_inertia none": ("cells_a_radius", "cells_to_wall"),
    "-fluid_inertia none -coupling_box_part false": ("cells_a_radius", "cells_to_wall_plain"),
    "-fluid_inertia unsteady": ("cells_with_inertia", "cells_to_wall_plain"),
}


@pytest.mark.parametrize("fluid", FLUIDS)
def test_grid_and_walls_are_what_was_measured(fluid, tmp_path):
    """What a grid and a wall of the calibration are said to leave. Without the box part what the grid leaves of a wall farther
    away goes on as h^2 over the gap, from the last that was measured."""
    cells, gaps = ["2", "3", "4", "6", "8"], ["0.4", "0.6", "0.8", "1.2", "1.6", "2.4"]
    scene = f"{QUIET} -vesicle_area {0.7 * np.pi} -vesicle_center 0,0 -time_end 0 {fluid} -scheme_auto 0.1 -domain_box"
    scenes = {("grid", n): f"{scene} -5,5,-5,5 -domain_cells {n}0,{n}0" for n in cells}
    for gap in (*gaps[:5], "6.2745098"):
        low = unseen.Scene("box", 1, 0.7, 1, 0, 0.5, 8).ellipse()[:, 1].min() - 1.02 * float(gap) / 8
        scenes["wall", gap] = f"{scene} -5,5,{low},{low + 10} -domain_cells 80,80"
    texts = {key: run.stdout for key, run in run_scenes(tmp_path, scenes).items()}
    for first, n in enumerate(cells):
        found = re.search(r"R0/h = .*leaves up to ([^\s:]+)", texts["grid", n])[1]
        within(float(found), FLUIDS[fluid][0], cells[first:])
        near, found = map(float, WALL.search(texts["wall", gaps[first]]).groups())
        within(found / (near / 8), FLUIDS[fluid][1], gaps[first:])
    if fluid == "-fluid_inertia unsteady":
        near, found = map(float, WALL.search(texts["wall", "6.2745098"]).groups())
        assert found == pytest.approx(measured("cells_to_wall_plain", "3.2") * 3.2**2 / 8 / near, rel=0.05)


FREE = "-domain_box -4,4,-4,4 -domain_cells 32,32 -domain_bc_x free -domain_bc_y free"


def test_compressed_start_within_the_wanted_error(tmp_path):
    """V = 0.65, chi = 100, start at -20 degrees: the vesicle wrinkles, and the steps that do elsewhere leave ten times the error."""
    scene = unseen.Scene("free", 1, 0.65, 100, -20, 0.5, 4)
    results = Results(tmp_path / "unseen.json")
    fine = scene.options() | unseen.FINE | words("-vesicle_markers 121 -time_end 3")
    exact = results.get(Case("fine", fine, unseen.measure))
    for wanted in (1e-2, 1e-3):
        auto = scene.options() | words(f"-scheme_auto {wanted} -time_end 3")
        assert unseen.error(results.get(Case(f"{wanted}", auto, unseen.measure)), exact) < wanted
        earlier = auto | words(f"-scheme_order 2 -time_adapt_tol {0.3 * wanted}")
        assert unseen.error(results.get(Case(f"earlier {wanted}", earlier, unseen.measure)), exact) > 1.5 * wanted


@pytest.mark.parametrize("number", (0, 5))
def test_unseen_scenes_within_the_wanted_error(number, tmp_path):
    """Two of the study's scenes, in unbounded fluid, against a run of ten times its tolerance, a hundredth of the smaller
    error; docs/speed_accuracy/unseen.csv has all."""
    results, fine = Results(tmp_path / "unseen.json"), unseen.fine(number)
    exact = results.get(replace(fine, options=fine.options | words("-time_adapt_tol 3e-5")))
    for wanted in (1e-2, 1e-3):
        assert unseen.error(results.get(unseen.auto(number, wanted)), exact) < wanted


def test_film_at_the_start(tmp_path):
    """Two ellipses .08 apart: too thin for 25 markers, .45 spacings, and for .1 %; more markers are chosen where they are left open."""
    scene = f"{FREE} {QUIET} -flow_type shear -vesicle_count 2 -vesicle_semi_axes 0.5,1 -vesicle_angle 0 -time_end 0 "
    scene += "-vesicle_center -0.54,0,0.54,0 -scheme_auto 1e-3"
    few = run_petves(tmp_path / "few", f"{scene} -vesicle_markers 25").stdout
    assert re.search(r"thinnest film: 0\.4\d marker spacings.*: TOO THIN, take more -vesicle_markers\n", few)
    chosen = run_petves(tmp_path / "chosen", scene)
    assert int(settings(chosen.stdout)["-vesicle_markers"][0]) > 55
    assert "TOO THIN" not in chosen.stdout and "grid: none, unbounded fluid: enough\n" in chosen.stdout


def measured_in_space(volume: float, degree: int, table: str = "degree") -> float:
    """Worst error of a degree at reduced volumes from this one up to the next that has a degree of its own."""
    group = {0.95: (0.95, 0.99)}.get(volume, (volume,))
    with CALIBRATION.open() as file:
        rows = [row for row in csv.DictReader(file) if row["table"] == table and row["value"] == str(degree)]
    return max(float(row["error"]) for row in rows if any(f"v={v:g} " in row["scene"] for v in group))


@pytest.mark.parametrize("wanted", WANTED)
def test_degree_and_steps_are_what_was_measured(wanted, tmp_path):
    """In three dimensions: printed errors are the worst of the calibration, and each leaves room for the other."""
    scene = f"-dim 3 -flow_type shear -flow_chi 10 -time_end 0 {QUIET} -scheme_auto {wanted} -vesicle_reduced_volume"
    scenes = {volume: f"{scene} {volume}" for volume in (0.95, 0.9, 0.8, 0.7)[: 4 if wanted > 1e-4 else 3]}
    for volume, run in run_scenes(tmp_path, scenes).items():
        chosen = settings(run.stdout)
        for name, table in (("-sphere_degree", None), ("-time_adapt_tol", "space_tol_1")):
            value, why = chosen[name]
            worst = measured(table, value) if table else measured_in_space(volume, int(value))
            assert float(re.search(r"leaves? up to (\S+)", why)[1]) == pytest.approx(worst, rel=0.06), (name, volume)
            assert worst <= wanted / 2, (name, volume)


@pytest.mark.parametrize("wanted", (0.1, 1e-2, 1e-3))
def test_vesicle_in_a_tube(wanted, tmp_path):
    """Printed errors are the worst of the calibration, and the speed is that of test_axisymmetric.py."""
    tube = "-dim axisymmetric -flow_type tube -flow_peak_velocity 2 -vesicle_bending 1 -tube_radius 1.3"
    for volume in (0.95, 0.9, 0.8, 0.7)[: 4 if wanted > 1e-3 else 3]:
        scene = f"{tube} -vesicle_reduced_volume {volume} -time_end {20 if volume == 0.9 else 0} {QUIET}"
        run = run_petves(tmp_path / f"{volume}", f"{scene} -scheme_auto {wanted}")
        for name in ("-sphere_degree", "-time_adapt_tol"):
            value, why = settings(run.stdout)[name]
            degree = name == "-sphere_degree"
            worst = measured_in_space(volume, int(value), "tube_degree") if degree else measured("tube_tol", value)
            assert float(re.search(r"leaves? up to (\S+)", why)[1]) == pytest.approx(worst, rel=0.06), (name, volume)
            assert worst <= wanted / 2, (name, volume)
        if volume == 0.9:
            assert run.series["velocity_x"][-1] == pytest.approx(1.52206, rel=wanted)


@pytest.mark.parametrize("wanted, volume, angle", [(0.1, 0.95, 0.180015), (1e-2, 0.9, 0.153393), (1e-3, 0.9, 0.153393)])
def test_treading_in_space_within_the_wanted_error(wanted, volume, angle, tmp_path):
    """The steady angle of the independent calculation of test_space.py."""
    scene = f"-dim 3 -flow_type shear -vesicle_bending 0.1 -vesicle_reduced_volume {volume} -time_end 16 {QUIET}"
    run = run_petves(tmp_path, f"{scene} -scheme_auto {wanted}")
    assert run.series["inclination"][-1] / np.pi == pytest.approx(angle, rel=wanted)
