"""What the near field makes of a coarse grid (docs/evidence.md): steady tank-treading, relaxation and conservation with all
defaults on, and that ranks agree."""

import math

import numpy as np
import pytest
from harness import REFERENCES, run_scenes
from petves.run import Run
from studies.common.curves import last_markers, trigonometric
from studies.common.paper import SHEAR
from restarts import last_state, same_state
from scipy.spatial import KDTree

pytestmark = pytest.mark.xdist_group("accuracy")  # its tests share runs

ROWS = REFERENCES["tank_treading_box"]["V, chi, angle over pi, frequency over rate"]
BOX = {(v, chi): found for v, chi, *found in ROWS}

CORRECTED = "-checkpoint_every 0 -output_every 100"
BOXES = {
    "box": "-domain_box -4,4,-4,4 -domain_cells {n},{n}",
    "channel": "-domain_box -8,8,-4,4 -domain_cells {m},{n} -domain_bc_x periodic",
}


def tank_treading(cached_run, box: str, n: int, reduced_area: float, chi: float, more: str = "") -> tuple[dict, tuple]:
    """Unit area at rate 1, rate dt = 0.05 to rate t = 12 unless `more` says otherwise: columns; angle over pi and
    frequency."""
    stiffness = math.sqrt(1 / (reduced_area * math.pi)) ** 3 / chi
    scene = f"{BOXES[box].format(n=n, m=2 * n)} -flow_type shear -vesicle_area 1 -vesicle_angle 20 "
    scene += f"-vesicle_reduced_area {reduced_area} -vesicle_bending {stiffness} -time_step 0.05 -time_end 12 {more}"
    series = cached_run(f"{CORRECTED} {scene}").series
    return series, (series["inclination"][-1] / math.pi, series["frequency"][-1])


def steady_errors(cached_run, n: int, reduced_area: float, chi: float, more: str = "") -> np.ndarray:
    """Errors of angle and frequency with 45 markers whatever the grid, rate dt = 0.05, which leaves 1e-6."""
    markers = f"{more} -vesicle_markers 45 -vesicle_allow_close_markers"
    found = tank_treading(cached_run, "box", n, reduced_area, chi, markers)[1]
    errors = np.array(found) / BOX[reduced_area, chi] - 1
    return errors


@pytest.mark.parametrize("reduced_area,chi", BOX)
def test_steady_state_of_the_boundary_integral(reduced_area, chi, cached_run):
    """Markers 0.4 h to 1.5 h apart. 32^2, 64^2, 128^2: measured 2.9e-5 of the angle, 1.3e-5 of the frequency or less, which are
    the references' own 1e-5 (over pi, and over the rate), and 1e-5 between the grids."""
    errors = np.array([steady_errors(cached_run, n, reduced_area, chi) for n in (32, 64, 128)])
    assert np.abs(errors[:, 0]).max() < 5e-5 and np.abs(errors[:, 1]).max() < 3e-5
    assert np.ptp(errors, axis=0).max() < 2e-5


def test_order_without_the_box_part(cached_run):
    """What walls and images leave then is of second order in the angle."""
    coarse, fine = (steady_errors(cached_run, n, 0.7, 10, "-coupling_box_part false")[0] for n in (24, 48))
    assert -7e-4 < coarse < -3e-4 and math.log2(coarse / fine) > 1.8


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("reduced_area,chi", [(0.7, 10), (0.5, 1)])
def test_coarse_grid_finds_the_steady_state(box, reduced_area, chi, cached_run):
    """64^2, markers at the default spacing, rate dt = 0.05; measured 0.045 percent or less."""
    _, found = tank_treading(cached_run, box, 64, reduced_area, chi)
    angle, frequency = np.array(found) / SHEAR[box][reduced_area, chi] - 1
    assert abs(angle) < 0.001 and abs(frequency) < 0.001


@pytest.mark.parametrize("n,length", [(64, 5e-5), (128, 1e-5)])
def test_area_and_length_are_kept(n, length, cached_run):
    """From rate t = 1 to 12, V = 0.7, chi = 10; the shift in units of R0."""
    series, _ = tank_treading(cached_run, "box", n, 0.7, 10)
    later = series["time"] > 1 - 1e-9
    worst = {name: np.abs(series[name][later]).max() for name in ("area_error", "length_error", "area_shift")}
    shift = worst["area_shift"] / math.sqrt(1 / (0.7 * math.pi))
    assert worst["area_error"] < 1e-10 and worst["length_error"] < length
    assert 0 < shift < 1e-4


def half_width(run) -> float:
    return float(np.ptp(trigonometric(last_markers(run.folder))[:, 0])) / 2


def relaxed(cached_run, n: int, options: str = "") -> float:
    """Half width of section 5.2's ellipse at t = 0.25, h = 1/n."""
    scene = f"-domain_cells {2 * n},{2 * n} -time_step 0.0078125 -time_end 0.25"
    return half_width(cached_run(f"{CORRECTED} {scene} {options}"))


def test_relaxation_reaches_its_fine_grid_limit(cached_run):
    """Half width: within 1e-4 of its limit at h = 1/16, 2e-5 on finer grids; measured -2.6e-5, -4e-6, 4e-7. Chords have an
    error of their own, of second order in the markers: -9.5e-4 with 24, -2.3e-4 with 50, whatever the near field."""
    got = {n: relaxed(cached_run, n) for n in (16, 32, 64)}
    limit = REFERENCES["relaxation"]["half_width"]
    assert abs(got[16] - limit) < 1e-4 and abs(got[32] - limit) < 2e-5 and abs(got[64] - limit) < 2e-5
    close = "-membrane_derivative bending -vesicle_allow_close_markers -vesicle_markers"
    chords = [abs(relaxed(cached_run, 16, f"{close} {markers}") - limit) for markers in (24, 48)]
    assert chords[0] < 1.1e-3 and chords[1] < chords[0] / 3.5


def least_gap(run, frame: int) -> float:
    """Least distance of the two vesicles' curves."""
    first, second = (trigonometric(run.outline(frame, k)[:-1]) for k in (0, 1))
    return float(KDTree(first).query(second)[0].min())


#: Two ellipses pressed together.
PRESSED = "-flow_type extension -flow_rate -1 -fluid_inertia none -vesicle_count 2 -vesicle_semi_axes 0.4,0.8 "
PRESSED += "-vesicle_center -0.55,0,0.55,0 -vesicle_angle 0 -vesicle_allow_close_markers -time_end 4"


def test_film_between_pressed_vesicles(cached_run):
    """Two ellipses pressed together in extension, 1.2 h apart on 32^2 at the start, 0.44 h at t = 4: the gap is the same on
    the grid with half the cells' size to 2e-3, measured 7e-4, and thins like Reynolds' film, t^(-1/2)."""
    scene = f"{PRESSED} -vesicle_bending 0.05 -time_step 0.05 -output_every 1 -vesicle_markers 63"
    gaps = []
    for n in (32, 64):
        run = cached_run(f"{CORRECTED} {BOXES['box'].format(n=n)} {scene}")
        gaps.append([least_gap(Run.read(run.folder), frame) for frame in range(5)])
    coarse, fine = np.array(gaps)
    np.testing.assert_allclose(coarse, fine, rtol=2e-3)
    rise = np.diff(1 / fine**2)
    assert (fine > 0).all() and 0.8 < rise[3] / rise[2] < 1.25


@pytest.mark.parametrize("chi", [100, 1000])
def test_film_between_soft_vesicles(chi, cached_run):
    """The same at chi = 100, 1000 in long steps, where waves under tension may swing and drain the film: the gap at t = 4 is that
    of half the step to .5 % (measured .1 %), no edge is corrected, length and area stay."""
    scene = f"{PRESSED} -vesicle_bending {0.2345 / chi} -vesicle_markers 45 -time_step"
    long, short = (cached_run(f"{CORRECTED} {BOXES['box'].format(n=32)} {scene} {dt}") for dt in (0.1, 0.05))
    gaps = [run.series["gap"][-1] for run in (long, short)]
    assert abs(gaps[0] / gaps[1] - 1) < 5e-3 and "has been corrected" not in long.stdout
    for name in ("area_error", "length_error"):
        assert abs(long.series[f"{name}_1"]).max() < 1e-12, name


PAIR = "-domain_box -1.5,1.5,-1.5,1.5 -domain_cells 48,48 -vesicle_count 2 -vesicle_semi_axes 0.2,0.4 -vesicle_angle 0 "
CASES = {
    "exact": "",
    "ib6": "-delta_type ib6",
    "order_1": "-scheme_order 1",
    "chords": "-membrane_derivative bending",
    "unsteady": "-fluid_inertia unsteady",
    "quasi_steady": "-fluid_inertia none",
    "quasi_steady_channel": "-fluid_inertia none -domain_bc_x periodic",
    "channel": "-domain_box 0,2.5,-1,1 -domain_bc_x periodic -domain_cells 40,32 -vesicle_center 1.2,0.1",
    "seam": "-domain_bc_x periodic -domain_bc_y periodic -domain_cells 33,33 -vesicle_center 0.97,-0.95",
    "close_markers": "-vesicle_spacing 0.7 -vesicle_allow_close_markers",
    "pair": PAIR + "-vesicle_center -0.29375,0.05,0.29375,-0.05",  # 3 h apart
    "pair_over_seam": PAIR + "-vesicle_center -1.3,0.05,1.1,-0.05 -domain_bc_x periodic",
    **{f"bending_{c_b:g}": f"-vesicle_bending {c_b:g}" for c_b in (0, 1e-4, 1, 100)},
}


@pytest.fixture(scope="module")
def on_ranks(tmp_path_factory):
    """The runs of CASES on one rank and on two."""
    options = f"{CORRECTED} -domain_cells 32,32 -flow_type shear -flow_rate 2 -vesicle_angle 20 -time_step 0.02 "
    scenes = {case: f"{options} -time_end 0.06 {CASES[case]} -coupled_ksp_rtol 1e-12" for case in CASES}
    return [run_scenes(tmp_path_factory.mktemp("ranks"), scenes, ranks) for ranks in (1, 2)]


@pytest.mark.parametrize("case", CASES)
def test_corrected_on_two_ranks(case, on_ranks):
    """3 steps in 32^2 cells on one rank (test_direct.c has their sparse LU) and on two, to 1e-9; with c_b = 100, whose
    forces are 100 times as large against the solve's tolerance, to 1e-7, of the tension's 8e3."""
    one, two = (runs[case] for runs in on_ranks)
    assert two.series["coupled_its"][1:].min() > 0
    want, got = last_state(one.folder), last_state(two.folder)
    for name in ("vesicle/markers", "vesicle/velocity", "vesicle/tension", "fluid/u", "fluid/v"):
        same_state(want, got, 1e-9 * (100 * max(1, np.abs(want[name]).max()) if case == "bending_100" else 1), [name])
