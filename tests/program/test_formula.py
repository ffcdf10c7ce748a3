"""A background flow by formulas of the options file: equal to the built-in flow, and to a function of Python's. Options
in YAML, as PETSc reads them: the same run as from an options file, and one line for a broken file."""

import numpy as np
import pytest
from harness import PETVES, ROOT, mpirun, run_petves, run_python
from refusals import refused
from restarts import without_wall

SMALL = "-domain_cells 32,32 -vesicle_semi_axes 0.35,0.5 -vesicle_angle 20 -time_step 0.02 -time_end 0.2"
CALLBACK = """
import sys
import numpy as np, petves

channel = lambda x, y, t: ((1 - y**2) * (1 + 0.8 * np.sin(np.pi * t)), 0)
with petves.Simulation(sys.argv[1], flow=channel, time_end=0.8, output_dir=sys.argv[3]) as sim:
    sim.run()
    own = sim.markers.copy(), [field.copy() for field in sim.cell_velocity()]
with petves.Simulation(sys.argv[2], time_end=0.8, output_dir=sys.argv[4]) as sim:
    sim.run()
    assert sim.options["flow_type"] == "formula" and "formula" in repr(sim)
    assert np.abs(sim.markers - own[0]).max() < 1e-12
    assert all(np.abs(a - b).max() < 1e-12 for a, b in zip(sim.cell_velocity(), own[1]))
print("facts hold")
"""


FLOWS = {
    "shear -flow_rate 1.5 -flow_center_y 0.1": ["-flow_u", "1.5 * (y - 0.1)"],
    "extension -flow_rate -0.7": ["-flow_u", " -0.7*x", "-flow_v", "0.7*y"],
}


@pytest.mark.parametrize("flow", FLOWS)
def test_the_built_in_flow(flow, tmp_path):
    built_in = run_petves(tmp_path / "type", f"{SMALL} -fluid_inertia none -flow_type {flow}")
    by_formula = run_petves(tmp_path / "formula", [*f"{SMALL} -fluid_inertia none".split(), *FLOWS[flow]])
    for name in ("vesicle/markers", "vesicle/tension", "fluid/u", "fluid/v"):
        expected = built_in.saved(name, "run.h5")
        assert np.abs(by_formula.saved(name, "run.h5") - expected).max() < 1e-12 * max(1, np.abs(expected).max()), name


def test_a_pulsating_flow_as_from_python(tmp_path):
    """runs/formula.opts, read by the program's own rules, against the same flow of a callback."""
    scene = (ROOT / "runs" / "formula.opts").read_text()
    (tmp_path / "callback.opts").write_text("".join(line for line in scene.splitlines(True) if "-flow_u" not in line))
    words = [tmp_path / "callback.opts", ROOT / "runs" / "formula.opts", tmp_path / "callback", tmp_path / "formula"]
    assert "facts hold" in run_python(CALLBACK, *map(str, words), ranks=2).stdout


def test_it_is_written_and_goes_on_after_a_restart(tmp_path):
    """resolved.opts repeats formulas with blanks, quotes' marks and a dash; a restart gives the bits of the whole run."""
    file, whole, half = tmp_path / "f.opts", tmp_path / "whole", tmp_path / "half"
    flow = "\n-flow_u \"-y * exp(-t)\"  # a comment\n-flow_v 'max(0, sin(3*t)) * x^2'\n"
    file.write_text("\n".join(f"-{line}" for line in SMALL[1:].split(" -")) + flow)
    said = run_petves(whole, f"-options_file {file} -view").stdout
    assert "background flow: formula, u = -y * exp(-t), v = max(0, sin(3*t)) * x^2\n" in said
    resolved = (whole / "resolved.opts").read_text()
    assert '\n-flow_u "-y * exp(-t)"\n-flow_v "max(0, sin(3*t)) * x^2"\n' in resolved
    again = f"-options_file {whole}/resolved.opts"
    run_petves(half, f"{again} -time_end 0.1 -checkpoint_every 1")
    run_petves(half, f"{again} -restart {half}/checkpoint.h5")
    assert without_wall(half) == without_wall(whole)
    refused(half, f"{again} -restart {half}/checkpoint.h5 -flow_v 0 -time_end 1", "-flow_v")


OPTIONS = """
-domain_box -1,1,-1,1
-domain_cells 32,32
-flow_u "-y * sin(2*t)"
-vesicle_semi_axes 0.35,0.5
-vesicle_angle 20
-time_step 0.02
-time_end 0.1
-coupled_ksp_rtol 1e-8
"""
YAML = """
# nested names and names with underscores
domain: {box: [-1, 1, -1, 1], cells: [32, 32]}
flow:
  u: -y * sin(2*t)
vesicle:
  semi_axes: [0.35, 0.5]
time_step: 0.1    # that of the file below does not win
options_file: rest.yml
"""
REST = """
vesicle_angle: 20
time: {end: 0.1, step: 0.05}
coupled_ksp_rtol: 1e-8
"""
PYTHON = """import sys, petves
with petves.Simulation(sys.argv[1]) as s: print(s.options['flow_u'], s.options['time_step'])"""
MESSAGES = {
    "domain: [1, 2\nflow: }": "cannot be read; allowed: names with values, lists or names of their own in YAML",
    "only text": "cannot be read; allowed: ...",
    "log:\n  view: file": "-log_view: not for a file, which may come from others; allowed: on the command line",
    "options_file: own.yaml": "-options_file own.yaml: not read (includes itself); allowed: a readable file of options",
}


def test_the_options_of_a_file(here):
    for name, text in (("a.opts", OPTIONS), ("a.yaml", YAML), ("rest.yml", REST), ("b", YAML)):
        (here / name).write_text(text)
    resolved = []
    for words in (["run", "a.opts"], ["run", "a.yaml"], ["-options_file", "a.yaml"], ["-options_file_yaml", "b"]):
        done = mpirun([PETVES, *words, "-time_step", "0.02", "-output_overwrite"], 2 if "b" in words else 1)
        assert done.returncode == 0, done.stderr
        resolved.append((here / "out" / "run" / "resolved.opts").read_text())
    assert '-flow_u "-y * sin(2*t)"\n' in resolved[0] and resolved == resolved[:1] * 4
    (here / "own.py").write_text(PYTHON)
    done = run_python(here / "own.py", "a.yaml")
    assert done.stdout.split("\n")[0].endswith("-y * sin(2*t) 0.10000000000000001"), done.stderr


@pytest.mark.parametrize("text", MESSAGES)
def test_a_broken_file(text, here):
    (here / "own.yaml").write_text(text)
    done = mpirun([PETVES, "-options_file_yaml", "own.yaml"], 1)
    start, dots, _ = MESSAGES[text].partition("...")
    assert done.returncode == 1 and not (here / "out").exists()
    assert done.stderr.startswith(f"petves: error: -options_file_yaml own.yaml: {start}"), done.stderr
    assert done.stderr.count("\n") == 1 and (dots or done.stderr.endswith(f"{start}\n"))
