"""Helpers of the tests: run petves under mpirun, read what it leaves, and end with one plain line of counts."""

import csv
import fcntl
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT)]  # the package, and the studies of docs/
PETVES = os.environ.get("PETVES", str(ROOT / "bin" / "petves"))
PROGRAMS = Path(os.environ.get("PETVES_TESTS", str(ROOT / "build" / "tests")))
SITE = PROGRAMS.parent / "site"  # what the tests need that Debian does not have: SITE_PACKAGES of the Makefile
SANITIZE = bool(os.environ.get("SANITIZE"))

#: What Open MPI needs as root and on few cores, and what the sanitizers need: MPI and PETSc leak by themselves.
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_odls_base_sigkill_timeout": "0",  # else mpirun sleeps two seconds after a non-zero exit
    "OMPI_MCA_ess_singleton_isolated": "1",  # one rank without mpirun starts no daemon
    "OMPI_MCA_hwloc_base_binding_policy": "none",  # or runs side by side would all be bound to the first cores
    "OMPI_MCA_pml": "ob1",  # shared memory: looking for other networks takes longer than most runs
    "OMPI_MCA_btl": "^openib,ofi,uct,usnic",
    "OMPI_MCA_osc": "^ucx",
    "OMP_NUM_THREADS": "1",
    "ASAN_OPTIONS": "detect_leaks=0",
    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1",
}

if SANITIZE:  # also programs that the package or a study starts
    os.environ.update({name: ENVIRONMENT[name] for name in ("ASAN_OPTIONS", "UBSAN_OPTIONS")})

#: The paper's scheme and discretisation, which most tests start from: options given after them win.
PAPER = "-scheme_type split -delta_type ib6 -membrane_derivative fd -coupling_near_field none -scheme_area_target false"

COLUMNS = (
    "step,time,dt,energy_kinetic,energy_bending,area,length,area_error,length_error,edge_ratio,div_max,"
    "surface_div_max,center_x,center_y,inclination,frequency,tension_its,bending_its,coupled_its,nsolve,wall,area_shift,"
    "normal_speed,velocity_x,velocity_y,energy_gravity,"
    "gap,energy_contact,viscosity_wall,viscosity,normal_stress_wall,normal_stress"
).split(",")


def mpirun(command: list[str], ranks: int, timeout: float = 300, wrapper: tuple[str, ...] = (), **environment: str):
    """Run a command on `ranks` ranks, one of them without mpirun; returns the CompletedProcess with text streams."""
    done = subprocess.run(
        [*(["mpirun", "-n", str(ranks)] if ranks > 1 else []), *wrapper, *command],
        env={**os.environ, **ENVIRONMENT, **environment},
        capture_output=True,
        text=True,
        timeout=timeout,
    )
    if "An error occurred in MPI_Init" in done.stderr and ranks == 1:  # of two that start in the same moment
        return mpirun(command, ranks, timeout, wrapper, **environment)
    lacks = re.search("solver type (mumps)|PC type (hypre)", done.stderr)
    if lacks and os.environ.get("PETSC_DIR"):  # Debian's has both
        pytest.skip(f"this PETSc was built without {lacks[1] or lacks[2]}")
    return done


def without_mpirun(text: str) -> list[str]:
    """Lines of standard error that are not mpirun's own: its report, which it frames in dashes, and its event loop's."""
    lines, inside = [], False
    for line in text.splitlines():
        if line.startswith("-----"):
            inside = not inside
        elif not inside and line.strip() and not line.startswith("[warn] Epoll"):
            lines.append(line)
    return lines


def read_series(path: Path) -> dict[str, np.ndarray]:
    """Columns of a series.csv by name; an empty entry is NaN."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    values = np.array([[float(x) if x else np.nan for x in row] for row in rows[1:]])
    return {name: values[:, i] for i, name in enumerate(rows[0])}


@dataclass
class Run:
    """A finished run: its folder, exit status, output and standard error without mpirun's lines."""

    folder: Path
    status: int
    stdout: str
    errors: list[str]

    @property
    def series(self) -> dict[str, np.ndarray]:
        return read_series(self.folder / "series.csv")


def run_petves(folder: Path, options: str, ranks: int = 1, good: bool = True, timeout: float = 300) -> Run:
    """Run petves with its output in `folder`, unless the options say another; with `good` the run must end well.

    The scheme is split, and the membrane's discretisation the paper's, unless the options say otherwise.
    """
    paper = PAPER if "-vesicle_shape none" not in options else "-scheme_type split"
    done = mpirun([PETVES, "-output_dir", str(folder), *paper.split(), *options.split()], ranks, timeout)
    run = Run(folder, done.returncode, done.stdout, without_mpirun(done.stderr))
    if good:
        assert run.status == 0, f"petves {options}\n{done.stdout}\n{done.stderr}"
    return run


@pytest.fixture(scope="session")
def cached_run(tmp_path_factory):
    """run_petves for runs that several tests look at: each is made once."""
    runs: dict[tuple[str, int], Run] = {}

    def get(options: str, ranks: int = 1) -> Run:
        if (options, ranks) not in runs:
            runs[options, ranks] = run_petves(tmp_path_factory.mktemp("run"), options, ranks)
        return runs[options, ranks]

    return get


#: Files that last longest, in the order in which their tests are handed to workers, so that none is begun last.
LONG = "coupled_runs runs fuzz metamorphic accuracy valgrind interrupted programs restart chart python tools baselines".split()


def pytest_configure(config):
    """`make test` has two workers (pytest-xdist). The process that starts them makes the folder of their locks."""
    config.addinivalue_line("markers", "alone: measures time, so that no other test may run meanwhile")
    config.addinivalue_line("markers", "xdist_group(name): tests of one name run on one worker, and share its runs")
    if not hasattr(config, "workerinput") and config.getoption("numprocesses", None):
        config.petves_locks = tempfile.TemporaryDirectory(prefix="petves-tests-")
        os.environ["PETVES_TEST_LOCKS"] = config.petves_locks.name


def pytest_collection_modifyitems(items):
    order = {f"test_{name}": place for place, name in enumerate(LONG)}
    items.sort(key=lambda item: order.get(item.path.stem, len(LONG)))


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    """Tests of two workers share the machine, but for those marked alone. The gate lets tests in one after
    another, so that one that waits to be alone is not passed by later ones."""
    folder = os.environ.get("PETVES_TEST_LOCKS")
    if not folder:
        yield
        return
    with open(Path(folder) / "gate", "w") as gate, open(Path(folder) / "lock", "w") as lock:
        fcntl.flock(gate, fcntl.LOCK_EX)
        fcntl.flock(lock, fcntl.LOCK_EX if item.get_closest_marker("alone") else fcntl.LOCK_SH)
        fcntl.flock(gate, fcntl.LOCK_UN)
        yield


_passed: set[str] = set()
_failed: set[str] = set()


def pytest_runtest_logreport(report):
    if report.failed:
        _failed.add(report.nodeid)
    elif report.when == "call" and report.passed:
        _passed.add(report.nodeid)


def pytest_collectreport(report):
    if report.failed:
        _failed.add(report.nodeid)


def pytest_unconfigure(config):
    """The last line of all; errors of set-up or collection count as failures. Workers leave it to the process
    that started them."""
    if hasattr(config, "workerinput"):
        return
    if hasattr(config, "petves_locks"):
        config.petves_locks.cleanup()
        os.environ.pop("PETVES_TEST_LOCKS")
    if not config.option.collectonly:
        print(f"{len(_passed - _failed)} passed, {len(_failed)} failed", flush=True)
