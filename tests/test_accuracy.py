"""What the corrections of docs/accuracy.md make of a coarse grid: steady tank-treading, relaxation and conservation with all
corrections on, and that coupled stays the direct solution."""

import math

import numpy as np
import pytest
from conftest import run_petves
from studies.common.curves import last_markers, trigonometric
from studies.common.paper import SHEAR
from test_coupled_runs import last_state, same_state

pytestmark = pytest.mark.xdist_group("accuracy")  # its tests share runs

CORRECTED = "-scheme_type coupled -delta_type cbs54 -membrane_derivative spectral -coupling_near_field exact "
CORRECTED += "-scheme_area_target true -checkpoint_every 0 -output_every 100"
BOXES = {
    "box": "-domain_box -4,4,-4,4 -domain_cells {n},{n}",
    "channel": "-domain_box -8,8,-4,4 -domain_cells {m},{n} -domain_bc_x periodic",
}


def tank_treading(cached_run, box: str, n: int, reduced_area: float, chi: float) -> tuple[dict, float, float]:
    """Ten shear times of unit area at rate 1 and rate dt = 0.05: columns, errors of angle and frequency."""
    stiffness = math.sqrt(1 / (reduced_area * math.pi)) ** 3 / chi
    scene = f"{BOXES[box].format(n=n, m=2 * n)} -flow_type shear -vesicle_area 1 -vesicle_angle 20 "
    scene += f"-vesicle_reduced_area {reduced_area} -vesicle_bending {stiffness} -time_step 0.05 -time_end 10"
    series = cached_run(f"{CORRECTED} {scene}").series
    angle, frequency = SHEAR[box][reduced_area, chi]
    errors = series["inclination"][-1] / math.pi / angle - 1, series["frequency"][-1] / frequency - 1
    print(f"{box}, {n}^2, V = {reduced_area}, chi = {chi}: angle {errors[0]:+.2%}, frequency {errors[1]:+.2%}")
    return series, *errors


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("reduced_area,chi", [(0.7, 10), (0.5, 1)])
def test_coarse_grid_finds_the_steady_state(box, reduced_area, chi, cached_run):
    """64^2: at most 1.5 % and 2 %; measured 0.27 % and 0.17 % (V = .7, chi = 10), 0.2 % and 0.15 %."""
    _, angle, frequency = tank_treading(cached_run, box, 64, reduced_area, chi)
    assert abs(angle) < 0.004 and abs(frequency) < 0.004


def test_finer_grid_is_closer(cached_run):
    """128^2: at most 0.5 % and 0.6 %; measured 0.04 % and 0.13 %, both below the 64^2 grid's."""
    _, *coarse = tank_treading(cached_run, "box", 64, 0.7, 10)
    _, *fine = tank_treading(cached_run, "box", 128, 0.7, 10)
    assert abs(fine[0]) < 0.001 and abs(fine[1]) < 0.0015
    assert all(abs(a) < abs(b) for a, b in zip(fine, coarse))


@pytest.mark.parametrize("n,length", [(64, 5e-5), (128, 1e-5)])
def test_area_and_length_are_kept(n, length, cached_run):
    """From rate t = 1 to 10, V = 0.7, chi = 10; the shift in units of R0."""
    series, *_ = tank_treading(cached_run, "box", n, 0.7, 10)
    later = series["time"] > 1 - 1e-9
    worst = {name: np.abs(series[name][later]).max() for name in ("area_error", "length_error", "area_shift")}
    shift = worst["area_shift"] / math.sqrt(1 / (0.7 * math.pi))
    print(f"{n}^2: {worst}, shift {shift:.1e} R0")
    assert worst["area_error"] < 1e-10 and worst["length_error"] < length
    assert 0 < shift < 1e-4


def half_width(run) -> float:
    return float(np.ptp(trigonometric(last_markers(run.folder))[:, 0])) / 2


def relaxed(cached_run, n: int, options: str = "") -> float:
    """Half width of section 5.2's ellipse at t = 0.25, h = 1/n."""
    scene = f"-domain_cells {2 * n},{2 * n} -time_step 0.0078125 -time_end 0.25"
    return half_width(cached_run(f"{CORRECTED} {scene} {options}"))


def test_relaxation_reaches_its_fine_grid_limit(cached_run):
    """Half width: within 1e-4 of its limit at h = 1/16."""
    got = {n: relaxed(cached_run, n) for n in (16, 32, 64)}
    limit = got[64] + (got[64] - got[32]) / 3
    chords = relaxed(cached_run, 16, "-membrane_derivative bending -coupling_self_mobility local")
    print(got, limit, chords)
    assert abs(limit - 0.19296) < 5e-5, "that of a NumPy prototype"
    assert abs(got[16] - limit) < 1e-4 and abs(got[32] - limit) < 1e-4 and abs(got[64] - limit) < 5e-5
    assert abs(chords - limit) < 1e-4


def test_trigonometric_interpolation():
    """Of an ellipse, exact, with an odd and an even number of markers."""
    for n in (11, 12):
        t = 2 * np.pi * np.arange(n) / n
        fine = 2 * np.pi * np.arange(256) / 256
        got = trigonometric(np.stack([2 * np.cos(t) + 1, np.sin(t)], axis=1), 256)
        np.testing.assert_allclose(got, np.stack([2 * np.cos(fine) + 1, np.sin(fine)], axis=1), rtol=0, atol=1e-13)


CASES = {
    "symbol": "",
    "local": "-coupling_self_mobility local",
    "ib6": "-delta_type ib6",
    "order_1": "-scheme_order 1",
    "chords": "-membrane_derivative bending",
    "channel": "-domain_box 0,2.5,-1,1 -domain_bc_x periodic -domain_cells 40,32 -vesicle_center 1.2,0.1",
}


@pytest.mark.parametrize("case", CASES)
def test_corrected_is_the_direct_solution(case, tmp_path):
    """Scheme direct puts Theta into its sparse matrix: 3 steps in 32^2 cells to 1e-9."""
    options = f"{CORRECTED} -domain_cells 32,32 -flow_type shear -flow_rate 2 -vesicle_angle 20 -time_step 0.02 "
    options += f"-time_end 0.06 {CASES[case]}"
    direct = run_petves(tmp_path / "direct", f"{options} -scheme_type direct")
    coupled = run_petves(tmp_path / "coupled", f"{options} -coupled_ksp_rtol 1e-12")
    assert coupled.series["coupled_its"][1:].min() > 0 and not direct.series["coupled_its"].any()
    same_state(last_state(direct.folder), last_state(coupled.folder), 1e-9)


def test_split_with_self_mobility_tends_to_coupled(tmp_path):
    """The correction in the split scheme: its markers tend to coupled's with dt, and it moves them further than the
    splitting error at the smallest step does."""
    scene = "-domain_cells 48,48 -vesicle_markers 36 -time_end 0.0625 -checkpoint_every 0 -delta_type cbs54"
    scene += " -membrane_derivative bending"
    symbol = f"{scene} -coupling_near_field exact"
    tight = "-tension_ksp_rtol 1e-10 -bending_ksp_rtol 1e-10"

    def markers(name, options):
        run = run_petves(tmp_path / name, options)
        if "split" in options:
            assert run.series["surface_div_max"][1:].max() < 1e-9
        return last_state(run.folder)["vesicle/markers"][0]

    want = markers("coupled", f"-scheme_type coupled -scheme_length_target false -time_step 0.00390625 {symbol}")
    error = [
        np.abs(markers(f"split{n}", f"-scheme_type split -time_step {1 / n} {tight} {symbol}") - want).max()
        for n in (128, 512, 2048)
    ]
    without = np.abs(markers("none", f"-scheme_type split -time_step {1 / 2048} {tight} {scene}") - want).max()
    print(f"split against coupled, dt = 1/128, 1/512, 1/2048: {error}; without the correction {without:.1e}")
    assert error[1] < error[0] / 3 and error[2] < error[1] / 3
    assert without > 10 * error[2]
