"""Viscosity contrast: angle and frequency of the boundary integral, tumbling, ranks, restarts, scaling."""

import math

import numpy as np
import pytest
from harness import REFERENCES, run_petves
from restarts import agree

from petves.measures import half_periods, turned_angle
from petves.run import Run

QUIET = "-output_every 100"
R0 = math.sqrt(1 / (0.7 * math.pi))  # of the unit area
SHEAR = f"{QUIET} -domain_box -4,4,-4,4 -domain_cells 64,64 -flow_type shear -vesicle_area 1"
SHEAR += f" -vesicle_reduced_area 0.7 -vesicle_bending {R0**3 / 10!r} -time_step 0.1"
RATIOS = REFERENCES["viscosity_ratio"]
SMALL = f"{QUIET} -domain_box -2,2,-2,2 -domain_cells 32,32 -flow_type shear -vesicle_area 0.5 -vesicle_markers 25"
SMALL += " -vesicle_count 2 -vesicle_center -.6,.2,.6,-.2 -vesicle_angle 60 -vesicle_bending .03 -time_step .1"
SMALL += " -vesicle_viscosity_ratio 5,.3 -time_end .3"
NEAR = "-vesicle_center -.8,-1.58,.8,1.6 -vesicle_angle 5"  # 1.3 cells from one wall, 1.2 from the other
PLAIN = "-coupling_box_part false"  # whose table takes longer than the steps
TIGHT = "-coupled_ksp_rtol 1e-12"


def markers(run) -> np.ndarray:
    return run.saved("vesicle/markers")


@pytest.mark.parametrize("ratio", ["2", "0.1"])
def test_steady_angle_and_frequency(tmp_path, ratio):
    """Of the boundary integral: within .005 % in a box of four walls on 32^2, .002 % in unbounded fluid."""
    for place, options, rel in (("box", "", 5e-5), ("unbounded", "-domain_bc_x free -domain_bc_y free", 2e-5)):
        scene = f"{SHEAR} -domain_cells 32,32 -vesicle_viscosity_ratio {ratio} -time_end 35 {options}"
        run = run_petves(tmp_path / place, scene)
        reference = RATIOS[place][ratio]
        assert run.series["inclination"][-1] / math.pi == pytest.approx(reference["angle"], rel=rel)
        assert run.series["frequency"][-1] == pytest.approx(reference["frequency"], rel=rel)
        assert run.series["coupled_its"][6:].mean() <= 5


def test_a_block_turns_with_its_vesicle(tmp_path):
    """One that tumbles; blocks that stay where they are made take 3 to 7 iterations a step."""
    scene = f"{QUIET} -vesicle_area 1 -vesicle_reduced_area .8 -vesicle_bending 1 -vesicle_viscosity_ratio 20"
    box = "-domain_box -2,2,-2,2 -domain_cells 32,32 -domain_bc_x periodic -flow_type shear -vesicle_angle 110"
    run = run_petves(tmp_path / "run", f"{scene} {box} -time_step .05 -time_end 1.5")
    angle, its = run.series["inclination"], run.series["coupled_its"][11:]
    assert abs(angle[-1] - angle[0]) > 0.5
    assert its.mean() <= 3.5 and its.max() <= 4, its


def test_second_order_without_box_part(tmp_path):
    """The angle at 32^2 is off by .1 % then, four times less at 64^2."""
    error = []
    for cells in (32, 64):
        options = f"-domain_cells {cells},{cells} -coupling_box_part false -vesicle_viscosity_ratio 2 -time_end 30"
        run = run_petves(tmp_path / str(cells), f"{SHEAR} {options}")
        error.append(run.series["inclination"][-1] / math.pi / RATIOS["box"]["2"]["angle"] - 1)
    assert 3.5 < error[0] / error[1] < 5 and abs(error[0]) < 1.2e-3


def test_distant_images_without_box_part(tmp_path):
    """On 128^2 walls are 64 cells away, and the double layer's images there still matter: errors fall by 3.6 from 64^2."""
    angle = []
    for cells, part in ((64, "true"), (64, "false"), (128, "false")):
        options = f"-domain_cells {cells},{cells} -coupling_box_part {part} -vesicle_viscosity_ratio 2 -time_end 1"
        run = run_petves(tmp_path / f"{cells}_{part}", f"{SHEAR} {options} -coupled_ksp_rtol 1e-9")
        angle.append(run.series["inclination"][-1])
    assert 3 < (angle[1] - angle[0]) / (angle[2] - angle[0]) < 5


def test_tumbling_half_period(tmp_path):
    """Passes of the long axis through vertical, ratio 10: the half period of the boundary integral within .03 %."""
    scene = f"{SHEAR} -domain_cells 32,32 -time_step .05 -vesicle_viscosity_ratio 10 -time_end 23"
    series = run_petves(tmp_path / "run", scene).series
    half = half_periods(series["time"], series["inclination"])
    assert half == pytest.approx([RATIOS["box"]["10"]["half_period"]], rel=3e-4)
    assert turned_angle(series["inclination"])[-1] < -1.4 * math.pi


RELAXING = [(64, 0.1, 0.1, 0.05), (64, 0.1, 50, 4), (64, 0.1, 10, 4), (64, 10, 10, 0.05), (64, 1000, 50, 0.05)]


@pytest.mark.parametrize("cells, bending, ratio, step", [*RELAXING, (64, 1000, 0.1, 4), (32, 1000, 0.1, 4)])
def test_relaxing(tmp_path, cells, bending, ratio, step):
    """Without a flow, soft and stiff, short and long steps, by the default tolerance: the area stays, the bending energy
    falls to that of rest."""
    scene = f"{QUIET} {PLAIN} -domain_box -4,4,-4,4 -domain_cells {cells},{cells} -vesicle_area 1"
    scene += " -vesicle_reduced_area 0.7"
    scene += f" -vesicle_bending {bending} -vesicle_viscosity_ratio {ratio} -time_step {step} -time_end {8 * step}"
    series = run_petves(tmp_path / "run", scene).series
    energy = series["energy_bending"] / bending
    assert series["area"] == pytest.approx(series["area"][0], rel=1e-10)
    assert energy[0] == pytest.approx(12.119, rel=1e-4) and energy[-1] == pytest.approx(9.256, rel=1e-3)
    assert np.diff(energy).max() < 2e-7 * energy[0]


CHANNEL = f"{SMALL} {NEAR} -domain_bc_x periodic"
WALLS = f"{SHEAR} -vesicle_bending .03 -domain_cells 32,32 -vesicle_viscosity_ratio 10 -time_step .05 -time_end .1"
BOXES = {
    "channel": (CHANNEL, 0.125, 3),
    "periodic": (f"{CHANNEL} -domain_bc_y periodic", 0.125, 3),
    "flux": (f"{CHANNEL} -flow_drive flux", 0.125, 3),
    "walls": (WALLS, 0.25, 1),
}


@pytest.mark.parametrize("box", BOXES)
def test_kinetic_energy_is_of_the_saved_velocity(tmp_path, box):
    """Measured in the solve of a step, whose velocity is made afterwards; vesicles on a seam or near walls."""
    scene, h, ranks = BOXES[box]
    run = run_petves(tmp_path / "run", f"{scene} {PLAIN}", ranks)
    squares = sum((run.saved(f"fluid/{name}") ** 2).sum() for name in "uv")
    assert run.series["energy_kinetic"][-1] == pytest.approx(squares / 2 * h**2, rel=1e-11)


def test_velocity_is_of_two_fluids(tmp_path):
    """Continuous across the membrane: next to it cells of 32^2 have what 128^2 has, inside and outside."""
    scene = f"{SHEAR} {PLAIN} -vesicle_viscosity_ratio 10 -time_step .05 -time_end .1 -output_every .1"
    fields = []
    for cells in (32, 128):
        run = Run.read(run_petves(tmp_path / str(cells), f"{scene} -domain_cells {cells},{cells}").folder)
        fields.append(np.stack(run.fields(-1)[:2]))
    part = sum(fields[1][:, j::4, i::4] for j in (1, 2) for i in (1, 2)) / 4
    off = np.abs(fields[0] - part)
    assert np.quantile(off, 0.99) < 0.005 and off.max() < 0.05


@pytest.mark.parametrize("walls", ["", f"{NEAR} -domain_bc_x periodic", "-domain_bc_x periodic -domain_bc_y periodic"])
def test_no_divergence_is_left(tmp_path, walls):
    """Besides the dipoles' own, of two vesicles of different ratios in every kind of box."""
    run = run_petves(tmp_path, f"{SMALL} {walls} {TIGHT}")
    assert run.series["div_max"].max() < 1e-11 and run.summary["viscosity_ratio"] == [0.3, 5]


def test_ranks_and_restart(tmp_path):
    """The same on 1 and 3 ranks, next to walls; a restart has the same bits."""
    small = f"{SMALL} {NEAR} {TIGHT} -domain_bc_x periodic"
    found = {name: markers(run) for name, run in agree(tmp_path, small, 0.2, 0.3, ()).items()}
    assert np.abs(found[3] - found["whole"]).max() < 1e-10
    assert np.array_equal(found["rest"], found["whole"])


def first_velocity(folder, cells: int, ratio: float) -> np.ndarray:
    """Of an ellipse .04 from the bottom of a channel of height 2, which shear takes along."""
    scene = f"{QUIET} {PLAIN} -domain_box -1,1,-1,1 -domain_cells {cells},{cells} -domain_bc_x periodic"
    scene += " -flow_type shear -vesicle_semi_axes .35,.2 -vesicle_angle 10 -vesicle_center 0,-.7539"
    scene += f" -vesicle_markers 91 -vesicle_bending .02 -vesicle_viscosity_ratio {ratio} -vesicle_allow_close_markers"
    run = run_petves(folder, f"{scene} -time_step 1e-6 -time_end 1e-6 -scheme_startup euler -output_every 1 {TIGHT}")
    assert abs(run.series["gap"][-1] - 0.04) < 1e-3
    return run.saved("vesicle/velocity", "run.h5")[-1]


@pytest.mark.parametrize("ratio", [5, 0.2])
def test_next_to_a_wall(tmp_path, ratio):
    """With .64 cells between membrane and wall the velocity is that of a grid with 2.6 (measured: 1e-4)."""
    fine = first_velocity(tmp_path / "fine", 128, ratio)
    off = first_velocity(tmp_path / "coarse", 32, ratio) - fine
    assert np.abs(off).max() < 5e-4 * np.sqrt((fine**2).sum(axis=1).mean())


def test_scaled_problem(tmp_path):
    """All viscosities doubled, the stiffness too, moves vesicles alike; ratios of 1 are no contrast, to the bit."""
    one = markers(run_petves(tmp_path / "one", f"{SMALL} {PLAIN} {TIGHT}"))
    two = markers(run_petves(tmp_path / "two", f"{SMALL} {PLAIN} {TIGHT} -fluid_viscosity 2 -vesicle_bending .06"))
    assert np.abs(one - two).max() < 1e-10
    plain = f"{PLAIN} {SMALL.replace('-vesicle_viscosity_ratio 5,.3', '')} -fluid_inertia none"
    none = markers(run_petves(tmp_path / "none", plain))
    assert np.array_equal(none, markers(run_petves(tmp_path / "ones", f"{plain} -vesicle_viscosity_ratio 1,1")))
    assert np.abs(none - one).max() > 1e-3
