"""A user's mistake stops the run before the first step, with one line that names the option, the value and what is
allowed. A step that cannot be taken stops it with the reason, and leaves checkpoint.h5 and summary.json."""

import json
import re

import h5py
import numpy as np
import pytest
from conftest import run_petves

SMALL = "-domain_cells 32,32 -time_step 0.01 -time_end 0.05"

#: Options, ranks, and what the one line must hold.
MISTAKES = {
    "misspelt": ("-vesicle_bendin 1", 1, ["-vesicle_bendin", "1", "-vesicle_bending"]),
    "misspelt_solver_option": ("-tension_ksp_rtl 1e-3", 2, ["-tension_ksp_rtl", "1e-3", "-tension_ksp_rtol"]),
    "unused": ("-vesicle_shape none -tension_ksp_rtol 1e-3", 1, ["-tension_ksp_rtol", "1e-3"]),
    "missing_curve_file": ("-vesicle_shape file -vesicle_file no.txt", 2, ["-vesicle_file", "no.txt", "No such file"]),
    "missing_options_file": ("-options_file no.opts", 2, ["-options_file", "no.opts"]),
    "no_curve_file": ("-vesicle_shape file", 1, ["-vesicle_shape file", "-vesicle_file", "allowed"]),
    "curve_file_not_read": ("-vesicle_file shape.txt", 1, ["-vesicle_file shape.txt", "-vesicle_shape file"]),
    "negative_viscosity": ("-fluid_viscosity -1", 2, ["-fluid_viscosity -1", ">0"]),
    "zero_viscosity": ("-fluid_viscosity 0", 1, ["-fluid_viscosity 0", ">0"]),
    "negative_bending": ("-vesicle_bending -0.1", 1, ["-vesicle_bending -0.1", ">=0"]),
    "negative_step": ("-time_step -1", 1, ["-time_step -1", ">0"]),
    "outside": ("-vesicle_center 5,0", 2, ["-vesicle_center 5,0", "vesicle 1", "wall x_max = 1", "inside -domain_box"]),
    "near_wall": ("-vesicle_center 0,0.4", 2, ["-vesicle_center 0,0.4", "wall y_max = 1", "needs 3", "allowed"]),
    "near_wall_x": ("-vesicle_center -0.7,0", 1, ["-vesicle_center -0.7,0", "wall x_min = -1", "cells", "3"]),
    "spacing_ib6": ("-vesicle_spacing 1.2", 1, ["-vesicle_spacing 1.2", "ib6", "at least 1.25 h"]),
    "spacing_cbs32": ("-delta_type cbs32 -vesicle_spacing 0.9", 1, ["-vesicle_spacing 0.9", "cbs32", "at least 1 h"]),
    "spacing_cbs43": ("-delta_type cbs43 -vesicle_spacing 0.9", 1, ["-vesicle_spacing 0.9", "cbs43", "at least 1 h"]),
    "spacing_cbs54": ("-delta_type cbs54 -vesicle_spacing 0.9", 1, ["-vesicle_spacing 0.9", "cbs54", "at least 1 h"]),
    "spacing_cbs65": ("-delta_type cbs65 -vesicle_spacing 0.9", 1, ["-vesicle_spacing 0.9", "cbs65", "at least 1 h"]),
    "markers_too_close": ("-vesicle_markers 60", 1, ["-vesicle_markers 60", "ib6", "at least 1.25 h"]),
    "too_few_markers": ("-vesicle_markers 4", 1, ["-vesicle_markers 4", "at least 8"]),
    "spacing_and_markers": ("-vesicle_markers 20 -vesicle_spacing 2", 1, ["-vesicle_markers 20", "-vesicle_spacing"]),
    "cells_not_square": ("-domain_cells 32,33", 2, ["-domain_cells 32,33", "square"]),
    "cells_one": ("-domain_cells 32", 1, ["-domain_cells", "1 numbers", "two"]),
    "cells_few": ("-domain_cells 4,4", 1, ["-domain_cells", "4", ">=8"]),
    "cells_not_integer": ("-domain_cells 32.5,32.5", 1, ["-domain_cells", "32.5", "integer"]),
    "box_empty": ("-domain_box 1,-1,-1,1", 1, ["-domain_box 1,-1,-1,1", "x_min < x_max"]),
    "box_three": ("-domain_box 1,2,3", 1, ["-domain_box", "3 numbers", "x_min,x_max,y_min,y_max"]),
    "more_ranks_than_rows": (
        "-domain_cells 8,8 -vesicle_shape none",
        9,
        ["mpirun -n 9", "8 rows", "allowed: 1,2,3,4 ranks"],
    ),
    "rank_without_rows": ("-domain_cells 9,9 -vesicle_shape none", 4, ["mpirun -n 4", "9 rows", "allowed: 1,2"]),
    "bad_boundary": ("-domain_bc_x open", 1, ["-domain_bc_x open", "wall|periodic"]),
    "bad_flow": ("-flow_type couette", 2, ["-flow_type couette", "quiescent|shear|poiseuille|extension"]),
    "bad_kernel": ("-delta_type ib4", 1, ["-delta_type ib4", "ib6|cbs32|cbs43|cbs54|cbs65"]),
    "bad_scheme": ("-scheme_type splitt", 1, ["-scheme_type splitt", "split"]),
    "bad_order": ("-scheme_order 3", 1, ["-scheme_order 3", "1"]),
    "bad_back_end": ("-helmholtz_type mumps", 1, ["-helmholtz_type mumps", "fftw|", "hypre"]),
    "not_a_number": ("-time_step fast", 2, ["-time_step fast", "not a number", ">0"]),
    "number_with_rest": ("-time_step 0.1s", 1, ["-time_step 0.1s", "not a number"]),
    "nan": ("-fluid_viscosity nan", 1, ["-fluid_viscosity nan", "number"]),
    "infinite": ("-time_end inf", 1, ["-time_end inf", "number"]),
    "no_value": ("-fluid_viscosity", 1, ["-fluid_viscosity", "without a value"]),
    "bad_boolean": ("-view maybe", 1, ["-view maybe", "true or false"]),
    "two_descriptions": ("-vesicle_area 1 -vesicle_semi_axes 1,2", 1, ["-vesicle_semi_axes", "-vesicle_area"]),
    "reduced_area": ("-vesicle_reduced_area 1.2", 1, ["-vesicle_reduced_area 1.2", "(0,1)"]),
    "bad_ksp_type": ("-tension_ksp_type gmress", 2, ["gmress"]),
    "bad_pc_type": ("-bending_pc_type foo", 1, ["foo"]),
    "bad_ksp_number": ("-tension_ksp_rtol abc", 1, ["tension_ksp_rtol", "abc"]),
    "total_form_periodic": ("-flow_type shear -flow_form total -domain_bc_y periodic", 1, ["-flow_form total", "wall"]),
    "too_many_steps": ("-time_step 1e-12 -time_end 1", 1, ["-time_step 1e-12", "larger"]),
    "bad_folder": ("-output_dir /proc/none", 2, ["-output_dir /proc/none", "allowed"]),
}


@pytest.mark.parametrize("text", ["no wisdom\n", "", "(fftw-3.3.10 fftw_wisdom #x0 #x0 #x0 #x0\n)\n"])
def test_bad_wisdom_is_named(text, tmp_path):
    path = tmp_path / "wisdom"
    path.write_text(text)
    run = run_petves(tmp_path / "out", f"{SMALL} -fftw_wisdom {path}", 2, good=False, timeout=60)
    stops_with(run, [f"-fftw_wisdom {path}", "not wisdom", "allowed"])
    assert path.read_text() == text


def test_wisdom_that_cannot_be_written_is_named(tmp_path):
    path = tmp_path / "none" / "wisdom"
    run = run_petves(tmp_path / "out", f"{SMALL} -fftw_wisdom {path}", 2, good=False, timeout=60)
    stops_with(run, [f"-fftw_wisdom {path}", "cannot be written", "allowed"])


def stops_with(run, needles):
    """One line on standard error, with every needle; exit status 1; no step taken."""
    assert run.status == 1, run.stdout
    assert len(run.errors) == 1, "\n".join(run.errors)
    assert run.errors[0].startswith("petves: error: ")
    line = re.sub(r"(\d)\.(?!\d)", r"\1", run.errors[0])  # PETSc prints the number 1 as "1."
    for needle in needles:
        assert needle in line
    assert not (run.folder / "series.csv").exists() or len(run.series["step"]) == 0
    assert "step 1 " not in run.stdout


@pytest.mark.parametrize("name", MISTAKES)
def test_mistake_is_named(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options, ranks, needles = MISTAKES[name]
    stops_with(run_petves(tmp_path / "out", f"{SMALL} {options}", ranks, good=False, timeout=60), needles)


def circle(n: int) -> list[str]:
    t = 2 * np.pi * np.arange(n) / n
    return [f"{0.3 * np.cos(a):.15g} {0.3 * np.sin(a):.15g}" for a in t]


CURVES = {
    "nan": (circle(20)[:7] + ["nan 0.1"] + circle(20)[7:], ["line 8", "nan 0.1", "finite"]),
    "infinite": (circle(20)[:7] + ["0.1 -inf"] + circle(20)[7:], ["line 8", "-inf", "finite"]),
    "three_points": (circle(3), ["3 points", "at least 8"]),
    "empty": (["# nothing"], ["0 points", "at least 8"]),
    "words": (circle(20) + ["x y"], ["line 21", "x y", "two finite numbers"]),
    "three_columns": (["0.1 0.2 0.3"] + circle(20), ["line 1", "two finite numbers"]),
    "repeated_point": (circle(20)[:5] + circle(20)[4:], ["point 5", "twice"]),
    "flat": ([f"{0.01 * k} 0" for k in range(20)], ["area of 0", "closed simple curve"]),
}


@pytest.mark.parametrize("name", CURVES)
def test_bad_curve_file_is_named(name, tmp_path):
    lines, needles = CURVES[name]
    path = tmp_path / "curve.txt"
    path.write_text("\n".join(lines) + "\n")
    options = f"{SMALL} -vesicle_shape file -vesicle_file {path}"
    stops_with(run_petves(tmp_path / "out", options, ranks=2, good=False), ["-vesicle_file", str(path), *needles])


@pytest.mark.parametrize("name", ["series.csv", "run.h5", "run.xmf", "resolved.opts", "checkpoint.h5", "summary.json"])
def test_file_that_cannot_be_written_is_named(name, tmp_path):
    """A folder is in the file's place; every rank stops."""
    (tmp_path / "out" / name / "in the way").mkdir(parents=True)
    run = run_petves(tmp_path / "out", SMALL, ranks=2, good=False, timeout=60)
    assert run.status == 1
    assert len(run.errors) == 1 and run.errors[0].startswith("petves: error: "), "\n".join(run.errors)
    assert name in run.errors[0] and "cannot be written" in run.errors[0] and "allowed" in run.errors[0]


def test_close_markers_go_on_when_allowed(tmp_path):
    run = run_petves(tmp_path / "out", f"{SMALL} -vesicle_spacing 1.2 -vesicle_allow_close_markers -time_end 0.01")
    assert len(run.series["step"]) == 2


def test_unused_options_go_on_when_allowed(tmp_path):
    run_petves(tmp_path / "out", f"{SMALL} -vesicle_bendin 1 -allow_unused_options -time_end 0.01")


def leaves_files(run, reason):
    """checkpoint.h5 and summary.json of the last good state, the reason in both the line and the summary."""
    assert run.status == 2, run.stdout
    lines = [line for line in run.errors if line.startswith("petves: error: ")]
    assert len(lines) == 1 and len(run.errors) == 1, "\n".join(run.errors)
    summary, series = json.loads((run.folder / "summary.json").read_text()), run.series
    assert summary["reason"] in lines[0]
    assert re.search(reason, summary["reason"]), summary["reason"]
    assert summary["totals"]["steps"] == series["step"][-1]
    with h5py.File(run.folder / "checkpoint.h5") as file:
        assert file.attrs["step"] == series["step"][-1] and file.attrs["time"] == series["time"][-1]
        assert np.isfinite(file["vesicle/markers"][:]).all()
    return summary, series


@pytest.mark.parametrize("prefix", ["tension_", "bending_"])
def test_failed_solve_stops_the_run(prefix, tmp_path):
    """Prefix, step, time and residual in the message."""
    options = f"{SMALL} -{prefix}ksp_max_it 1 -{prefix}ksp_rtol 1e-12"
    run = run_petves(tmp_path / "out", options, ranks=2, good=False)
    reason = rf"prefix {prefix} failed in step \d+ at time [\d.e-]+: DIVERGED_ITS after 1 iterations, residual [\d.]+"
    summary, series = leaves_files(run, reason)
    step = int(re.search(r"in step (\d+)", summary["reason"])[1])
    time = float(re.search(r"at time ([\d.e-]+):", summary["reason"])[1])
    assert step == series["step"][-1] + 1 and time == pytest.approx(series["time"][-1] + 0.01)


def test_vesicle_carried_into_a_wall_stops_the_run(tmp_path):
    """Extension carries the vesicle away from the centre of the flow, to the wall at x_max."""
    options = "-domain_cells 48,48 -flow_type extension -vesicle_center 0.4,0 -time_step 0.02 -time_end 5"
    run = run_petves(tmp_path / "out", options, ranks=2, good=False)
    summary, series = leaves_files(run, r"vesicle 1.*wall x_max = 1.*needs 3; after step \d+, time [\d.]+")
    assert float(summary["reason"].split()[-1]) == pytest.approx(series["time"][-1], rel=1e-5)
    assert 2 <= series["step"][-1] < 100
    with h5py.File(run.folder / "checkpoint.h5") as file:
        assert 2 < (1 - file["vesicle/markers"][0, :, 0].max()) / (2 / 48) < 3, "found in the step after"
