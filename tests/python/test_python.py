"""petves.Simulation: the facts of tests/python, and the same series as the program's, to the bit."""

import json
import subprocess

import pytest
from harness import ROOT, SANITIZE, run_petves, run_python, simulation, without_mpirun
from restarts import without_wall

SCRIPTS = ROOT / "tests" / "python"
PYTHON = "/usr/bin/python3"
FACTS = [
    ("interface", ["state", "measures", "solvers"], 1),
    ("interface", ["running", "several", "quiet"], 1),
    ("interface", ["state", "measures", "running", "several", "solids"], 2),
    ("interface", ["restarting"], 1),
    ("interface", ["memory"], 1),
    ("flow", ["same_as_built_in", "right_time", "failures"], 1),
    ("flow", ["same_as_built_in"], 2),
]
SCENES = {
    "default": "-domain_cells 48,48 -flow_type shear -time_step 0.01 -time_end 0.05 -output_every 0.02",
    "split": "-domain_cells 48,48 -scheme_type split -flow_type extension -time_step 0.005 -time_end 0.02",
    "adaptive": "-domain_cells 48,48 -time_adapt error -time_step 0.02 -time_end 0.05 -output_every 0.01",
    "steady": "-domain_cells 32,32 -vesicle_semi_axes 0.4,0.5 -time_steady_tol 0.002 -time_step 0.05 -time_end 5",
}


COMMA = """
import locale, sys
import petves
def run(name, early):
    if early: locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
    with petves.Simulation(domain_cells=(24, 24), vesicle_semi_axes=(0.4, 0.5), time_step=0.01, time_end=0.05,
                           output_dir=sys.argv[1] + "/" + name) as sim:
        sim.step()
        if name == "commas": locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
        return sim.run()
run("points", False)
done = run("commas", {early})
print(locale.str(1.5), done, locale.str(1.5))
"""
THREADS = """
import threading
import numpy as np
import petves
def run(found, k):
    flow = (lambda x, y, t: (y, 0 * x)) if k else None
    with petves.Simulation(domain_cells=(24, 24), vesicle_semi_axes=(0.4, 0.5), time_step=0.01, time_end=0.3, flow=flow) as sim:
        sim.run(callback=lambda sim: sim.pressure.sum())
        found[k] = sim.markers.copy()
alone, beside = {}, {}
for k in range(2): run(alone, k)
threads = [threading.Thread(target=run, args=(beside, k)) for k in range(2)]
for thread in threads: thread.start()
for thread in threads: thread.join()
print("same" if all(np.array_equal(alone[k], beside[k]) for k in range(2)) else (alone, beside))
"""


if not SANITIZE:  # a sanitized library cannot be loaded into Python

    @pytest.mark.parametrize("script,facts,ranks", FACTS, ids=lambda x: x if isinstance(x, (str, int)) else x[0])
    def test_facts_hold(script, facts, ranks, tmp_path):
        arguments = [str(tmp_path)] if script == "interface" else []
        done = run_python(SCRIPTS / f"{script}.py", *arguments, *facts, ranks=ranks)
        assert done.stdout == "facts hold\n", "PETSc reports what was not freed:\n" + done.stdout
        assert not without_mpirun(done.stderr)

    @pytest.mark.parametrize("ranks", [1, 2])
    def test_mistakes_are_errors_of_one_line(ranks, tmp_path):
        done = run_python(SCRIPTS / "interface.py", str(tmp_path), "mistakes", ranks=ranks)
        assert "facts hold" in done.stdout and not without_mpirun(
            done.stderr
        ), "nothing is printed: the exception has the message"

    def test_no_options_of_the_current_folder(here):
        (here / ".petscrc").write_text(f'-python "touch {here}/made"\n')
        run_python("import petves\nprint(petves.Simulation)\n")
        assert not (here / "made").exists()

    def test_a_callback_costs_forty_calls():
        assert float(run_python(SCRIPTS / "overhead.py").stdout) < 40

    def test_progress_bar_where_one_is_asked_for():
        code = "import petves\nwith petves.Simulation(domain_cells=(24, 24), vesicle_semi_axes=(0.4, 0.5)) as sim:\n"
        done = run_python(code + "    sim.run(until=0.03, progress=True)\n    sim.run(until=0.05)\n", ranks=2)
        assert "100%" in done.stderr
        assert done.stderr.count("| 0/0.03 ") == 1 and "/0.05" not in done.stderr  # a slow bar draws its end twice

    @pytest.mark.parametrize("scene,ranks", [*((scene, 1) for scene in SCENES), ("default", 2), ("adaptive", 2)])
    def test_same_bits_as_the_command_line(scene, ranks, tmp_path):
        options = SCENES[scene]
        run_petves(tmp_path / "program", options, ranks)
        code = f"import petves\nwith {simulation(options, output_dir=tmp_path / 'python')} as sim:\n"
        done = run_python(code + "    sim.run(callback=lambda s: s.markers.sum())\n", ranks=ranks)
        assert not done.stdout and not without_mpirun(done.stderr), done.stderr
        rows = [without_wall(tmp_path / name) for name in ("program", "python")]
        assert len(rows[0]) > 4 and rows[0] == rows[1]
        for name in ("resolved.opts", "run.xmf"):
            texts = [(tmp_path / kind / name).read_text().replace(kind, "") for kind in ("program", "python")]
            assert texts[0] == texts[1]

    @pytest.mark.parametrize("comma_from", ["the start", "the first step on"])
    def test_decimal_commas_reach_no_file(comma_from, tmp_path):
        """A program whose locale writes 0,5, as a window of Qt sets it, has the series of one with points."""
        words = f"localedef -i de_DE -f UTF-8 {tmp_path}/de_DE.UTF-8".split()
        made = subprocess.run(words, capture_output=True)
        if made.returncode:
            pytest.skip("no locale with commas can be made here")
        done = run_python(COMMA.format(early=comma_from == "the start"), str(tmp_path), LOCPATH=str(tmp_path))
        assert done.stdout == "1,5 finished 1,5\n" and not done.stderr, done.stderr
        points, commas = (without_wall(tmp_path / name) for name in ("points", "commas"))
        assert len(points) > 4 and points == commas
        assert json.loads((tmp_path / "commas" / "summary.json").read_text())["last"]["time"] == pytest.approx(0.05)

    def test_threads_take_turns():
        """Two runs at once, one of them with a flow of Python: the numbers of one after the other."""
        assert run_python(THREADS).stdout == "same\n"
