"""The Python package installed, its examples, its notebook and its reference."""

import ast
import inspect
import os
import pkgutil
import re
import resource
import shutil
import subprocess
import sys
import tempfile

import petves
import pytest
from harness import ENVIRONMENT, LIBRARY, PACKAGE, ROOT, SANITIZE, mpirun, run_petves, without_mpirun

EXAMPLES = sorted(path.stem for path in (ROOT / "python" / "examples").glob("*.py") if path.stem != "common")
LEFT = {"quick_start": "quick_start/shapes.png", "restart": "halves/series.csv"}
RUN = """
import petves
with petves.Simulation(domain_cells=(24, 24), vesicle_semi_axes=(0.4, 0.5), time_end=0.01) as sim: sim.run()
print(petves.__file__, petves.library.library()._name)
"""
#: What a simulation says of itself, and what it does with attributes.
SAYS = """
import petves
sim = petves.Simulation(domain_cells=(24, 24), flow_type='shear', time_end=0.02, output_dir='out')
sim.run()
print(sim)
for name in ('foo', 'time'):
    try: setattr(sim, name, 3)
    except AttributeError as error: print(error)
sim.close()
print(repr(sim))
"""
NO_LIBRARY = """
import petves
try: petves.Simulation()
except petves.Error as error: print(error)
"""
#: What a Python without petsc4py does with a run.
NO_PETSC = """
import sys
sys.modules['petsc4py'] = None
import petves
print(len(petves.load(sys.argv[1])['time']), len(petves.plot(sys.argv[1])))
"""


def python(words: list[str], **environment: str) -> subprocess.CompletedProcess:
    """Run Debian's Python, which must end well, without this test's own settings of where petves is."""
    kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PETVES", "PETVES_LIBRARY")}
    environment = {**kept, **ENVIRONMENT, **environment}
    done = subprocess.run([sys.executable, *words], env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


def test_names_are_offered_before_they_are_imported():
    """dir(petves), py.typed and the stub have the same names."""
    done = python(["-c", "import petves; print(dir(petves))"], PYTHONPATH=str(ROOT / "python"))
    names = {name for name in ast.literal_eval(done.stdout) if not name.startswith("__")}
    stub = ast.parse((ROOT / "python" / "petves" / "__init__.pyi").read_text())
    imported = {node.names[0].asname for node in stub.body if isinstance(node, (ast.Import, ast.ImportFrom))}
    views = {"plot", "movie", "report", "compare", "sweep", "quantities", "watch", "numbers"}
    assert names == imported == {"Error", "Run", "RunError", "Simulation", "load"} | views
    home = "petves.views.plot petves.views.movie petves.views.report petves.views.compare petves.sweeps".split()
    code = "import petves, petves.sweeps\nprint(*(getattr(petves, x).__module__ for x in 'plot movie report compare sweep'.split()))"
    assert python(["-c", code], PYTHONPATH=str(ROOT / "python")).stdout.split() == home
    assert (ROOT / "python" / "petves" / "py.typed").is_file()


def test_help_starts_at_once():
    """In a fifth of a second of processor time: nothing is imported for it."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = python(["-m", "petves", "--help"], PYTHONPATH=str(ROOT / "python"))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert "sweep" in done.stdout
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 0.2


if not SANITIZE:  # a sanitized library cannot be loaded into Python

    @pytest.mark.parametrize("name", EXAMPLES)
    def test_example_runs(name, tmp_path):
        assert len(EXAMPLES) == 7
        ranks = 2 if name == "quick_start" else 1
        script = str(ROOT / "python" / "examples" / f"{name}.py")
        done = mpirun([sys.executable, script, str(tmp_path), "--short"], ranks, **PACKAGE)
        assert done.returncode == 0, done.stdout + done.stderr
        assert not without_mpirun(done.stderr)
        assert (tmp_path / LEFT.get(name, f"{name}.png")).stat().st_size > 1000

    def test_a_simulation_says_what_it_is_and_takes_no_attributes():
        with tempfile.TemporaryDirectory() as folder:
            done = python(["-c", f"import os\nos.chdir({folder!r})\n{SAYS}"], **PACKAGE)
        scene = "<petves.Simulation: 1 vesicle in shear, 24 x 24 cells, wall in x, wall in y, "
        refused = ": a simulation has no attribute to set; options are given when it is made"
        expected = [f"{scene}t = 0.02 of 0.02, out>", f"foo{refused}", f"time{refused}", f"{scene}closed, out>"]
        assert done.stdout.splitlines() == expected, done.stderr

    def test_pip_installs_a_package_that_runs(tmp_path):
        shutil.copytree(ROOT / "python", tmp_path / "tree" / "python", ignore=shutil.ignore_patterns("__pycache__"))
        (tmp_path / "tree" / "lib").mkdir()
        shutil.copy(LIBRARY, tmp_path / "tree" / "lib")
        shutil.copytree(ROOT / "runs", tmp_path / "tree" / "runs")
        words = "-m pip install -q --no-build-isolation --no-deps --no-index --root-user-action=ignore".split()
        python([*words, "--target", str(tmp_path / "site"), str(tmp_path / "tree" / "python")])
        shutil.rmtree(tmp_path / "tree")
        done = python(["-c", RUN], PYTHONPATH=str(tmp_path / "site"))
        home = tmp_path / "site" / "petves"
        assert done.stdout.split() == [str(home / "__init__.py"), str(home / "libpetves.so")]
        assert (home / "views" / "report.html").is_file() and (home / "py.typed").is_file()
        assert not (tmp_path / "site" / "studies").exists()
        words = f"run stirring -time_end 0 -output_dir {tmp_path / 'out'}".split()
        python([str(tmp_path / "site" / "bin" / "petves"), *words], PYTHONPATH=str(tmp_path / "site"))
        assert (tmp_path / "out" / "run.h5").is_file(), "pip's command has the program"
        words = ["sweep", str(tmp_path / "s"), "--vary", "time_end", "0"]
        python([str(tmp_path / "site" / "bin" / "petves"), *words], PYTHONPATH=str(tmp_path / "site"))
        assert list((tmp_path / "s").glob("*/run.h5"))

    def reference() -> list[str]:
        """The names whose docstrings docs/api.md shows, in the site."""
        return re.findall(r"^::: petves\.(\S+)$", (ROOT / "docs" / "api.md").read_text(), re.MULTILINE)

    def test_reference_has_every_public_name():
        first = {name.split(".")[0] for name in reference()}
        assert not set(petves.__all__) - first

    def test_every_parameter_is_described():
        """In the docstring of its function or, of a method, of its class."""
        wrong, count = [], 0
        for name in reference():
            thing = pkgutil.resolve_name(f"petves.{name}")
            owner = inspect.getdoc(thing) or ""
            callable_ = lambda x: inspect.isclass(thing) and (inspect.isfunction(x) or inspect.ismethod(x))
            members = inspect.getmembers(thing, callable_)
            for label, routine in [(name, thing), *((k, f) for k, f in members if not k.startswith("_"))]:
                text = f"{inspect.getdoc(routine) or ''}\n{owner}"
                if text.startswith("\n"):
                    wrong.append(f"{name}.{label}: nothing is said")
                if issubclass(type(routine), type) and issubclass(routine, Exception):
                    continue
                names = [p for p in inspect.signature(routine).parameters if p not in ("self", "cls")]
                wrong += [f"{name}.{label}: {p}" for p in names if not re.search(rf"\b{p}\b", text)]
                count += len(names)
        assert count > 60 and not wrong

    def test_reading_and_drawing_need_no_petsc(tmp_path):
        run = run_petves(tmp_path / "run", "-domain_cells 24,24 -vesicle_semi_axes 0.4,0.5 -time_end 0.01")
        done = python(["-c", NO_PETSC + NO_LIBRARY, str(run.folder)], PYTHONPATH=str(ROOT / "python"))
        first, last = done.stdout.splitlines()
        assert first == "2 6" and last.startswith("petsc4py is not installed, which simulating needs; "), done.stderr

    def test_missing_library_is_one_line():
        done = python(["-c", NO_LIBRARY], **PACKAGE | {"PETVES_LIBRARY": "/nowhere/libpetves.so"})
        assert done.stdout == "libpetves.so: not found in /nowhere; run make, or set PETVES_LIBRARY\n", done.stderr
