"""What tests share: paths, the environment of runs, petves under mpirun, and what a run leaves."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
import pytest

from petves.program import OPEN_MPI

ROOT = Path(__file__).resolve().parents[2]
PETVES = os.environ.get("PETVES", str(ROOT / "bin" / "petves"))
PROGRAMS = Path(os.environ.get("PETVES_TESTS", str(ROOT / "build" / "tests")))
LIBRARY = Path(PETVES).resolve().parent.parent / "lib" / "libpetves.so"
SITE = PROGRAMS.parent / "site"  # what the tests need that Debian does not have: SITE_PACKAGES of the Makefile
SANITIZE = bool(os.environ.get("SANITIZE"))
#: Exact and published numbers.
REFERENCES = json.loads((ROOT / "tests" / "support" / "references.json").read_text())

#: What the package gives Open MPI; what tests need of it besides, and of the sanitizers: MPI and PETSc leak by themselves.
ENVIRONMENT = OPEN_MPI | {
    "OMPI_MCA_odls_base_sigkill_timeout": "0",  # else mpirun sleeps two seconds after a non-zero exit
    "OMPI_MCA_hwloc_base_binding_policy": "none",  # or runs side by side would all be bound to the first cores
    "OMPI_MCA_pml": "ob1",  # shared memory: looking for other networks takes longer than most runs
    "OMPI_MCA_btl": "^openib,ofi,uct,usnic",
    "OMPI_MCA_osc": "^ucx",
    "ASAN_OPTIONS": "detect_leaks=0",
    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1",
}

if SANITIZE:  # also programs that the package or a study starts
    os.environ.update({name: ENVIRONMENT[name] for name in ("ASAN_OPTIONS", "UBSAN_OPTIONS")})

#: Where this package and the library of the program under test are.
PACKAGE = {"PETVES_LIBRARY": str(LIBRARY), "PYTHONPATH": str(ROOT / "python")}

#: The paper's scheme; its discretisation follows from it. Tests start from the default scheme unless they say this.
PAPER = "-scheme_type split"

COLUMNS = """step time dt energy_kinetic energy_bending area length area_error length_error edge_ratio div_max
surface_div_max center_x center_y inclination frequency tension_its bending_its coupled_its nsolve wall area_shift normal_speed
velocity_x velocity_y energy_gravity gap energy_contact viscosity_wall viscosity normal_stress_wall normal_stress""".split()


def mpirun(command: list[str], ranks: int, timeout: float = 300, wrapper: tuple[str, ...] = (), **environment: str):
    """Run a command on `ranks` ranks, one of them without mpirun; returns the CompletedProcess with text streams."""
    words = [*(["mpirun", "-n", str(ranks)] if ranks > 1 else []), *wrapper, *command]
    how = dict(env={**os.environ, **ENVIRONMENT, **environment}, capture_output=True, text=True, timeout=timeout)
    done = subprocess.run(words, **how)
    if "An error occurred in MPI_Init" in done.stderr and ranks == 1:  # of two that start in the same moment
        return mpirun(command, ranks, timeout, wrapper, **environment)
    lacks = re.search("solver type (mumps)|PC type (hypre)", done.stderr)
    if lacks and os.environ.get("PETSC_DIR"):  # Debian's has both
        pytest.skip(f"this PETSc was built without {lacks[1] or lacks[2]}")
    return done


def run_tool(*words, folder=None, **environment: str) -> subprocess.CompletedProcess:
    """Run python3 -m petves, of this package with the program under test."""
    paths = {"PETVES": PETVES, "PYTHONPATH": str(ROOT / "python"), **environment}
    words = [sys.executable, "-m", "petves", *map(str, words)]
    how = dict(capture_output=True, text=True, cwd=folder, timeout=300)
    return subprocess.run(words, env={**os.environ, **ENVIRONMENT, **paths}, **how)


def run_python(script: Path | str, *words: str, ranks: int = 1, good: bool = True, **environment: str):
    """Run a Python script, or a text of one, on some ranks, with this package and the library of the program under test; with
    `good` it must end well."""
    start = [str(script)] if isinstance(script, Path) else ["-c", script]
    done = mpirun(["/usr/bin/python3", *start, *words], ranks, **PACKAGE, **environment)
    assert not good or done.returncode == 0, done.stdout + done.stderr
    return done


def simulation(options: str, **more) -> str:
    """The call in Python that makes a simulation of these options, a value each."""
    words = options.split()
    named = dict(zip((name[1:] for name in words[::2]), words[1::2]))
    named |= {name: str(value) for name, value in more.items()}
    return f"petves.Simulation({', '.join(f'{name}={value!r}' for name, value in named.items())})"


#: A library's own function calls the one of the same name that it stands for.
REAL = """#define _GNU_SOURCE
#include <dlfcn.h>
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
"""


def preloaded(folder: Path, source: str, compiler: str = "gcc") -> str:
    """Compile a library that a program is to load first (LD_PRELOAD); the sanitizers want to be that themselves."""
    if SANITIZE:
        pytest.skip("the sanitizers' library must be the first to be loaded")
    (folder / "first.c").write_text(REAL + source)
    command = [compiler, "-O1", "-shared", "-fPIC", "-o", folder / "first.so", folder / "first.c", "-ldl"]
    subprocess.run(command, env={**os.environ, **ENVIRONMENT}, check=True)
    return str(folder / "first.so")


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

    @property
    def resolved(self) -> dict[str, str]:
        """The value of each option of resolved.opts, those without one left out."""
        lines = (self.folder / "resolved.opts").read_text().splitlines()
        return dict(line.split(maxsplit=1) for line in lines if line.startswith("-") and " " in line)

    @property
    def summary(self) -> dict:
        return json.loads((self.folder / "summary.json").read_text())

    def saved(self, name: str, file: str = "checkpoint.h5") -> np.ndarray:
        """A dataset of the checkpoint, or of another file."""
        with h5py.File(self.folder / file) as opened:
            return opened[name][:]


def run_petves(folder: Path, options: str | list, ranks: int = 1, good: bool = True, timeout: float = 300) -> Run:
    """Run petves with its output in `folder`, unless the options say another; with `good` the run must end well. Options
    are a list where a value has blanks."""
    words = options.split() if isinstance(options, str) else map(str, options)
    done = mpirun([PETVES, "-output_dir", str(folder), *words], ranks, timeout)
    run = Run(folder, done.returncode, done.stdout, without_mpirun(done.stderr))
    if good:
        assert run.status == 0, f"petves {options}\n{done.stdout}\n{done.stderr}"
    return run


def run_scenes(folder: Path, scenes: dict, ranks: int = 1, good: bool = True, **environment: str) -> dict:
    """Run scenes one after another in one process (scenes.c), as its start takes longer than most of them; each in a folder of
    its name. With `good` all must end well; the errors of one that was refused are its line."""
    folder.mkdir(exist_ok=True)
    places = [folder / re.sub(r"\W", "_", str(name)) for name in scenes]
    lines = [f"-output_dir {place} {options}\n" for place, options in zip(places, scenes.values())]
    (folder / "scenes").write_text("".join(lines))
    done = mpirun([str(PROGRAMS / "scenes"), str(folder / "scenes")], ranks, **environment)
    ended = re.findall(r"(.*?)^([012]) ([^\n]*)\n", done.stdout, re.DOTALL | re.MULTILINE)
    assert done.returncode == 0 and len(ended) == len(scenes), done.stdout + done.stderr
    assert not good or not any(int(status) for _, status, _ in ended), done.stdout
    errors = [[f"petves: error: {line}"] if line else [] for _, _, line in ended]
    runs = [Run(place, int(n), said, lines) for place, (said, n, _), lines in zip(places, ended, errors)]
    return dict(zip(scenes, runs))


def attribute(path: Path, name: str = "step"):
    """Of a checkpoint, or of another HDF5 file."""
    with h5py.File(path) as file:
        return file.attrs[name]


def start(folder: Path, options: str, ranks: int = 1, **streams) -> subprocess.Popen:
    """petves in the background."""
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += [PETVES, "-output_dir", str(folder), *options.split()]
    heed = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # which tests in the background ignore
    return subprocess.Popen(command, env={**os.environ, **ENVIRONMENT}, text=True, preexec_fn=heed, **streams)


def wait_for(condition) -> None:
    end = time.time() + 60
    while not condition():
        assert time.time() < end, "not within a minute"
        time.sleep(0.005)


def wait_for_rows(folder: Path, rows: int):
    """Until the run has saved so many frames."""
    path = folder / "run.xmf"
    wait_for(lambda: path.exists() and path.read_text().count("<Time") >= rows)
