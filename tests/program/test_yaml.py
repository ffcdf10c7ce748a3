"""Options in YAML, as PETSc reads them: the same run as from an options file, and one line for a broken file."""

import pytest
from harness import PETVES, mpirun, run_python

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


def test_the_options_of_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in (("a.opts", OPTIONS), ("a.yaml", YAML), ("rest.yml", REST), ("b", YAML)):
        (tmp_path / name).write_text(text)
    resolved = []
    for words in (["run", "a.opts"], ["run", "a.yaml"], ["-options_file", "a.yaml"], ["-options_file_yaml", "b"]):
        done = mpirun([PETVES, *words, "-time_step", "0.02", "-output_overwrite"], 2 if "b" in words else 1)
        assert done.returncode == 0, done.stderr
        resolved.append((tmp_path / "out" / "run" / "resolved.opts").read_text())
    assert '-flow_u "-y * sin(2*t)"\n' in resolved[0] and resolved == resolved[:1] * 4
    (tmp_path / "own.py").write_text(PYTHON)
    done = run_python(tmp_path / "own.py", "a.yaml")
    assert done.stdout.split("\n")[0].endswith("-y * sin(2*t) 0.10000000000000001"), done.stderr


@pytest.mark.parametrize("text", MESSAGES)
def test_a_broken_file(text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.yaml").write_text(text)
    done = mpirun([PETVES, "-options_file_yaml", "own.yaml"], 1)
    start, dots, _ = MESSAGES[text].partition("...")
    assert done.returncode == 1 and not (tmp_path / "out").exists()
    assert done.stderr.startswith(f"petves: error: -options_file_yaml own.yaml: {start}"), done.stderr
    assert done.stderr.count("\n") == 1 and (dots or done.stderr.endswith(f"{start}\n"))
