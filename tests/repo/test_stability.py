"""The stability maps: marks, resuming, the largest step and its power, and what a handful of cells must show."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from harness import PETVES, run_petves

from petves.run import RunError
from studies.stability import bodies, maps
from studies.stability import cells as study
from studies.stability import page as report

DT_CB, CHANGE = (next(one for one in maps.MAPS if one.name == name) for name in ("dt_cb", "dt_change"))
SPACING = next(one for one in maps.MAPS if one.name == "spacing_kernel")


def some(one: study.Map, xs: tuple, ys: tuple) -> study.Map:
    return study.Map(one.name, one.title, one.x_label, xs, one.y_label, ys, one.options)


def read(folder) -> dict[tuple[str, str, float, float], dict[str, str]]:
    with open(folder / "stability.csv", newline="") as file:
        return {(row["map"], row["scheme"], row["x"], row["y"]): row for row in csv.DictReader(file)}


@pytest.mark.parametrize(
    "status, message, want",
    [
        (0, "", "ok"),
        (0, "petves: stopping after step 3: -time_wall_limit 40", "too slow"),
        (1, "-vesicle_spacing 0.75: markers 0.743329 h apart", "refused"),
        (2, "vesicle 1: edge ratio 2.3 beyond -limit_edge_ratio 2 after step 4", "uneven edges"),
        (2, "vesicle 1: area error 0.3 beyond -limit_area_error 0.2 after step 4", "drift above 1 %"),
        (2, "the solve with prefix bending_ failed in step 1 at time 1: DIVERGED_ITS after 9", "solver failed"),
        (2, "the solve with prefix bending_ failed in step 1 at time 1: DIVERGED_NANORINF after 0", "NaN"),
        (2, "the tension is not finite after step 1", "NaN"),
        (2, "vesicle 1: a marker at (7,0) is -9 cells from the wall x_max = 1", "left the box"),
        (2, "vesicle 1: a marker at (7,0) is beyond the wall x_max = 1. after step 4", "left the box"),
        (2, "the film between vesicles 1 and 2 went from 0.1 to 0.01 in one step", "film drained"),
        (2, "vesicle 1 and obstacle 2 cross after step 7, time 0.3", "membranes cross"),
        (2, "something else", "no clean stop"),
        (-1, "status 139: ", "no clean stop"),
    ],
)
def test_ends_have_marks(status, message, want):
    assert study.mark(status, message) == want


def test_powers_are_fitted():
    points = [(h, 7 * h**2.5) for h in (0.1, 0.05, 0.02)]
    assert abs(report.fitted_power(points) - 2.5) < 1e-12
    assert report.fitted_power(points[:2]) != report.fitted_power(points[:2])  # two points fit any power


def test_largest_step_is_bisected(tmp_path, monkeypatch):
    """A bound of h^3: found to the eighth of an octave, and its power; no bound, no bisection."""
    one = maps.STEP_MAP

    def run_cell(scheme, stages):
        n, dt = map(float, stages[0].split())
        good = scheme == "coupled" or dt <= 300 / n**3
        return {name: 0.0 for name in report.COLUMNS[5:12]} | {"mark": "ok" if good else "energy rises", "message": ""}

    monkeypatch.setattr(report, "run_cell", run_cell)
    one = study.Map(one.name, "", "", one.xs, "", one.ys, lambda n, dt: (f"{n} {dt!r}",))
    cells = report.Cells(tmp_path / "stability.csv")
    cells.run(one, one.cells())
    found = []
    for n in one.xs:
        dt, bounded = report.largest_step(cells, one, "split", n)
        assert bounded and dt <= 300 / n**3 < dt * 2 ** (1 / 2**report.HALVINGS) * (1 + 1e-5)
        found.append((2 / n, dt))
        assert report.largest_step(cells, one, "coupled", n) == (max(one.ys), False)
    assert abs(report.fitted_power(found) - 3) < 0.2


def test_quick_is_the_corners():
    for one in maps.MAPS + bodies.MAPS:
        cells = one.quick().cells()
        assert len(cells) == 4 * len(one.panels) and set(cells) <= set(one.cells())


def test_panels_have_options_of_their_own(tmp_path, monkeypatch):
    """Other panels than schemes: their options come after the map's; what the program said is in tables.md."""
    one = next(one for one in bodies.MAPS if one.name == "throat")
    panels = {name: one.panels[name] for name in ("no repulsion", "repulsion")}
    one = replace(one, xs=(0.4,), ys=(0.0448,), panels=panels)
    monkeypatch.setenv("PETVES", PETVES)
    report.write(tmp_path, maps=(one,))
    rows = read(tmp_path)
    assert [key[1] for key in rows] == ["no repulsion", "repulsion"]
    plain, pushed = rows.values()
    assert plain["mark"] == "membranes cross" and "vesicle 1 and obstacle 2 cross" in plain["message"]
    assert pushed["mark"] == "film drained" and pushed["options"].endswith("-contact_repulsion 2000")
    text = (tmp_path / "tables.md").read_text()
    assert f"| throat | no repulsion | membranes cross | 1 | {plain['message']} |" in text
    assert "| repulsion | 0 of 1 |" in text


def test_a_handful_of_cells(tmp_path, monkeypatch):
    """Stiff membrane, large step: penalty and split fail, coupled does not; a small step is good for all; a changed
    step; a refused spacing. What has run is not run again, unless its options have changed."""
    monkeypatch.setenv("PETVES", PETVES)
    chosen = some(DT_CB, (1.0,), (2**-5, 2**-13)), some(CHANGE, (1 / 64, 64.0), (1 / 512,))
    chosen += (some(SPACING, ("ib6",), (0.75,)),)
    paths = report.write(tmp_path, maps=chosen)
    assert {p.name for p in paths} == {"stability.csv", "tables.md", "dt_cb.png", "dt_change.png", "spacing_kernel.png"}
    assert all(p.stat().st_size for p in paths)
    rows = read(tmp_path)
    marks = {key: row["mark"] for key, row in rows.items()}
    assert len(marks) == 15 and set(marks.values()) <= set(study.MARKS) - {"no clean stop", "too slow"}
    for scheme in study.SCHEMES:
        assert (marks["dt_cb", scheme, "1", "0.03125"] == "ok") == (scheme == "coupled")
        assert marks["dt_cb", scheme, "1", "0.00012207"] == "ok"
        assert marks["dt_change", scheme, "0.015625", "0.00195312"] == "ok"
        assert marks["spacing_kernel", scheme, "ib6", "0.75"] == ("ok" if scheme == "coupled" else "refused")
    assert marks["dt_change", "coupled", "64", "0.00195312"] == "ok"
    assert all(bool(row["message"]) == (int(row["steps"]) < study.STEPS) for row in rows.values())
    assert all(int(row["steps"]) == study.STEPS for row in rows.values() if row["mark"] == "ok")
    text = (tmp_path / "tables.md").read_text()
    assert "| dt_cb | ellipse at rest, $32^2$ | 1 of 2 | 1 of 2 | 2 of 2 |" in text

    ran = []
    monkeypatch.setattr(report, "run_cell", lambda scheme, stages: ran.append(stages) or study.run_cell(scheme, stages))
    report.write(tmp_path, maps=chosen)
    assert not ran and read(tmp_path) == rows
    text = (tmp_path / "stability.csv").read_text()
    (tmp_path / "stability.csv").write_text(text.replace("-vesicle_bending 1.0 -time_step 0.03125", "other", 1))
    report.write(tmp_path, maps=chosen)
    assert len(ran) == 1 and read(tmp_path) == rows


def stiff(folder, stiffness: float, dt: float):
    """A membrane of this c_b for 60 steps; largest rise of its energy over the energy at the start, and that at the end
    over that of c_b = 1."""
    membrane = "-scheme_type coupled -delta_type cbs54 -membrane_derivative spectral -coupling_near_field exact"
    scene = f"{membrane} -vesicle_semi_axes 0.2,0.5 -domain_cells 32,32 -vesicle_bending"
    run = run_petves(folder / "stiff", f"{scene} {stiffness} -time_step {dt} -time_end {60 * dt}")
    series = run.series
    energy = series["energy_bending"] + series["energy_kinetic"]
    rise = (energy - np.minimum.accumulate(energy)).max() / energy[0]
    soft = run_petves(folder / "soft", f"{scene} 1 -time_step {1 / 64} -time_end 4").series
    warnings = [line for line in run.stdout.splitlines() if "has been corrected" in line]
    assert len(warnings) == 1, run.stdout
    return series, rise, series["energy_bending"][-1] / (stiffness * soft["energy_bending"][-1])


@pytest.mark.parametrize("stiffness, dt, rise", [(100, 1 / 8, 2e-3), (200, 1 / 32, 2e-3), (100, 1 / 32, 5e-3)])
def test_stiff_membranes_keep_area_length_and_shape(stiffness, dt, rise, tmp_path):
    """250, 120 and 60 times the membrane's own time a step: the area stays; edges that are off by more than
    1e-3 are made right, with a warning in the first step, and less is left to the length target. Energy rises by 2e-3 at most, 5e-3 in
    the last case (the length target has no energy law), and the shape at the end is that of c_b = 1, its energy to 1e-3; the
    user is told."""
    series, found, energy = stiff(tmp_path, stiffness, dt)
    length = abs(series["length_error"])
    assert abs(series["area_error"]).max() < 1e-12 and length.max() < 1e-3
    assert found < rise and abs(energy - 1) < 1e-3
    assert series["area_shift"][2:].max() < 3e-4, "the near field lets nearly nothing through"


def test_strong_shear_at_a_quarter_of_the_rate(monkeypatch):
    """chi = 1000, a strain of 1/4 a step, once stopped by the limit of the length."""
    monkeypatch.setenv("PETVES", PETVES)
    cell = study.run_cell("coupled", (maps.shear(1 / 4, 0.7, 1000),))
    assert cell["mark"] == "ok" and cell["steps"] == study.STEPS
    assert cell["drift"] < 1e-12 and cell["length_error"] < 2e-3  # 1e-3 is what is left alone


def test_time_ends_the_maps_and_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(report, "MINUTES", 0)
    monkeypatch.setattr(report.Cells.__init__, "__defaults__", (0,))
    report.write(tmp_path, maps=(some(DT_CB, (1.0,), (2**-5,)),))
    assert "3 cells did not run" in (tmp_path / "tables.md").read_text()


def test_other_columns_are_refused(tmp_path):
    (tmp_path / "stability.csv").write_text("a,b\n1,2\n")
    with pytest.raises(RunError, match="stability.csv: other columns"):
        report.write(tmp_path, maps=())
