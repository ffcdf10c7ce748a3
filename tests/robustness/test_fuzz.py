"""Cases drawn at random, good and bad, for a run of petves: numbers, words, files, environment, signals. It must end well with
finite numbers in its files, or with one line. A case is drawn again from the seed and its number alone; `make fuzz` draws others."""

from __future__ import annotations

import os
import random
import resource
import signal
import subprocess
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pytest
from check_options import described
from harness import ENVIRONMENT, PETVES, SANITIZE, read_series, run_petves, without_mpirun

SEED, CASES = int(os.environ.get("FUZZ_SEED", 2024)), int(os.environ.get("FUZZ_CASES", 300))
TOGETHER = 50  # cases of a test
SECONDS = 10  # of processor time

#: What numbers are drawn from besides the default, and words where a number or a name should be.
NUMBERS = ["0", "1", "2", "0.5", "1e-3", "0.1", "3", "10", "100", "-1", "1e9", "1e-9", "1e300", "1e-300", "1e100"]
WORDS = ["nan", "inf", "abc", "1,2", "", "0x10", "1e", "-", "true", "9" * 40, "%s%n", "a" * 600, "é", "=", "a b"]

#: Options with draws of their own; None: not drawn.
OWN = {
    "-domain_cells": "8,8 16,16 24,24 16,8 17,17 22,22 9,9 0,0 7,7 -8,-8 16 99999,99999".split(),
    "-domain_box": ["-1,1,-1,1", "0,2,0,2", "-2,2,-1,1", "0,0,0,0", "-1e9,1e9,-1e9,1e9", "-1e-9,1e-9,-1e-9,1e-9"],
    "-vesicle_center": ["0,0", "0.1,-0.1", "1,1", "0.95,0", "1e300,0", "0,0,0.5,0.5", "-0.4,0,0.4,0", "100,0"],
    "-vesicle_semi_axes": ["0.2,0.5", "0.5,0.5", "0.01,0.5", "0.3,0.3,0.2,0.2", "1e-9,1", "5,5", "1e150,1e150"],
    "-vesicle_reduced_area": ["0.7", "0.99", "0.3", "1e-6", "0.999999"],
    "-vesicle_area": ["1", "0.1", "1e6", "1e-6", "1e300"],
    "-vesicle_file": ["no.txt", "{curve}", "/", "/dev/null"],
    "-restart": ["{checkpoint}", "no.h5", "/", "/dev/null", "{curve}"],
    "-vesicle_markers": ["8", "20", "21", "40", "7", "1000", "2000000000"],
    **dict.fromkeys(("-output_dir", "-time_wall_limit", "-output_overwrite")),
}

#: PETSc's own options, with values that it takes or not.
PETSC = ["-log_view", "-log_view gmres", "-log_view :/proc/none", "-malloc_debug maybe", "-malloc_debug", "-info /no/x"]
PETSC += ["-coupled_ksp_view foo", "-options_left maybe", "-fp_trap x", "-prefix_push a_", "-prefix_pop"]
PETSC += ["-log_trace /no", "-tension_ksp_max_it 1", "-coupled_ksp_rtol 1", "-bending_pc_type 1", "-no_such 1"]
PETSC += ["-coupled_pc_type lu"]
PETSC += ["-coupled_ksp_type nosuch", "-coupled_ksp_monitor", "-coupled_ksp_rtol abc", "-options_view", "-skip_petscrc"]


@dataclass
class Case:
    """One run: its words, what is in the environment and in files, and the signal that it gets."""

    kind: str
    words: list[str]
    environment: dict[str, str] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)
    signal: int = 0
    ranks: int = 1

    def __str__(self) -> str:
        extra = [f"{name}={value!r}" for name, value in self.environment.items()]
        extra += [f"{name}: {text[:200]!r}" for name, text in self.files.items()]
        words = " ".join([*map(repr, self.words), *extra])
        return f"{self.kind}, {self.ranks} ranks: {words} {self.signal or ''}"


class Draw:
    """Draws cases; places are the files that options may name."""

    def __init__(self, seed: int, number: int, table: list, places: dict[str, str]) -> None:
        self.random = random.Random(f"{seed} {number}")
        self.table = table
        self.places = places

    def case(self, ranks: int) -> Case:
        kind = self.random.choice([self.numbers] * 3 + [self.words, self.option_file, self.data_file, self.environment])
        if ranks == 1 and self.random.random() < 0.03:
            kind = self.signals
        case = kind()
        case.ranks = ranks
        return case

    def value(self, default: str, allowed: str) -> str:
        """A value for an option that the help describes so; one in eight is no sensible text at all."""
        if self.random.random() < 0.125:
            return self.random.choice(WORDS)
        if "|" in allowed:
            return self.random.choice(allowed.split("|"))
        return self.random.choice([default, *NUMBERS])

    def scene(self, most: int = 5) -> list[str]:
        """A small scene and some options."""
        words = "-domain_cells 16,16 -time_step 0.01 -time_end 0.01 -time_wall_limit 3".split()
        if self.random.random() < 0.5:
            words += ["-scheme_type", self.random.choice(["split", "penalty", "coupled"])]
        if self.random.random() < 0.3:
            words.append("-allow_unused_options")
        for name, default, _, allowed, _ in self.random.sample(self.table, self.random.randint(0, most)):
            values = OWN.get(name, [])
            if values is not None:
                text = self.random.choice(values).format(**self.places) if values else self.value(default, allowed)
                words += [name, text] if text or self.random.random() < 0.5 else [name]
        return words

    def numbers(self) -> Case:
        words = self.scene()
        if self.random.random() < 0.1:
            words += self.random.choice(PETSC).split()
        return Case("numbers", words)

    def misspell(self, word: str) -> str:
        k = self.random.randrange(len(word)) if word else 0
        odd = self.random.choice(["", "=", "-", "é", "\t", "\x01", " ", ",", '"', "#", "x"])
        return self.random.choice([word[:k] + odd + word[k + 1 :], word[:k] + odd + word[k:], f"-{word}", word.upper()])

    def words(self) -> Case:
        words = self.scene(2)
        for _ in range(self.random.randint(1, 2)):
            k = self.random.randrange(len(words))
            what = self.random.randrange(5)
            if what == 0:
                words.insert(k, self.random.choice([*WORDS, "my.opts", "--help", "-", "--", "-h"]))
            elif what == 1:
                del words[k]
            elif what == 2:
                words[k] = self.misspell(words[k])
            elif what == 3:
                words[k : k + 2] = ["=".join(words[k : k + 2])]
            else:
                words += self.random.choice(PETSC).split()
            words = words or ["-time_end"]
        return Case("words", words)

    def mangled(self, text: bytes) -> bytes:
        """Bytes changed, cut, put in."""
        out = bytearray(text)
        for _ in range(self.random.randint(0, 3)):
            k = self.random.randrange(len(out) + 1)
            what = self.random.randrange(4)
            if what == 0:
                out[k:k] = self.random.choice([b"\0", b"\r", b"\xff", b"=", b" ", b'"', b"#", b"\n\n", b"-", b"," * 3])
            elif what == 1 and k < len(out):
                out[k] = self.random.randrange(256)
            elif what == 2:
                del out[k : k + self.random.randint(1, 8)]
            else:
                out = out[: max(k, 1)]
        return bytes(out)

    def option_file(self) -> Case:
        words = self.scene(2)
        lines, end = [], self.random.choice(["\n", "\r\n", "\r"])
        for name, value in zip(words, [*words[1:], "-"]):
            if name.startswith("-") and name[1:2].isalpha():
                lines.append(name if value.startswith("-") else f"{name} {value}")
        extra = ["-options_file a.opts", "-options_file b.opts", "-options_file no.opts", "-options_file /", "# x", ""]
        extra += ["stray", "-flow_rate = 2", "-domain_cells 16, 16", "-vesicle_angle 1 2", "-output_dir 'a b'"]
        extra += ["-x " * 9]
        for _ in range(self.random.randint(0, 2)):
            lines.insert(self.random.randint(0, len(lines)), self.random.choice(extra))
        text = self.random.choice([b"", b"\xef\xbb\xbf"]) + end.join(lines).encode()
        files = {"a.opts": self.mangled(text), "b.opts": self.random.choice([b"-options_file a.opts\n", b"-view\n"])}
        name = self.random.choice(["a.opts"] * 8 + ["/", "/dev/null", PETVES, "{checkpoint}", ""]).format(**self.places)
        return Case("option file", ["-options_file", name, "-time_end", "0.01", "-time_wall_limit", "3"], files=files)

    def data_file(self) -> Case:
        """A curve or a checkpoint that somebody has changed."""
        small = "-domain_cells 16,16 -time_step 0.01 -time_end 0.03".split()
        if self.random.random() < 0.5:
            files = {"curve.txt": self.mangled(Path(self.places["curve"]).read_bytes())}
            return Case("curve", [*small, "-vesicle_shape", "file", "-vesicle_file", "curve.txt"], files=files)
        files = {"checkpoint.h5": self.mangled(Path(self.places["checkpoint"]).read_bytes())}
        return Case("checkpoint", [*small, "-fluid_inertia", "unsteady", "-restart", "checkpoint.h5"], files=files)

    def environment(self) -> Case:
        case = Case("environment", self.scene(1))
        for _ in range(self.random.randint(1, 2)):
            options = [" ".join(self.scene(2)), *PETSC, "stray", "'"]
            options += ["-options_file no.opts", "-time_end = 1", "\t \n", "#"]
            choices = [("PETSC_OPTIONS", options)] * 2 + [
                ("HOME", ["/nowhere", "", "."]),
                ("TMPDIR", ["", "/tmp"]),  # one that is not there stops MPI before petves begins
                ("LC_ALL", ["C", "de_DE.UTF-8", "nonsense"]),
                ("OMP_NUM_THREADS", ["1", "2"]),
                ("COLUMNS", ["0", "-1"]),
                ("PATH", ["/usr/bin:/bin", "/usr/bin:/bin:/nowhere"]),
            ]
            name, values = self.random.choice(choices)
            case.environment[name] = self.random.choice(values).replace("\0", "")
        if self.random.random() < 0.2:
            case.files[".petscrc"] = self.mangled("\n".join(self.random.sample(PETSC, 2)).encode())
        return case

    def signals(self) -> Case:
        words = "-domain_cells 16,16 -time_step 0.01 -time_end 1000 -output_every 1000 -time_wall_limit 20".split()
        return Case("signal", words, signal=self.random.choice([signal.SIGTERM, signal.SIGUSR1]))


def limits() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS * (4 if SANITIZE else 1), SECONDS * 8))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def start(case: Case, folder: Path) -> subprocess.Popen:
    folder.mkdir()
    for name, text in case.files.items():
        (folder / name).write_bytes(text)
    words = [word.replace("\0", "") for word in case.words]
    words = [*(["mpirun", "-n", str(case.ranks)] if case.ranks > 1 else []), PETVES, *words, "-output_dir", "out"]
    streams = dict(stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, errors="replace")
    environment = {**os.environ, **ENVIRONMENT, **case.environment}
    return subprocess.Popen(words, env=environment, preexec_fn=limits, cwd=folder, **streams)


def check(case: Case, folder: Path, tries: int = 3) -> str:
    """Run one case; what is wrong with how it ended, or nothing."""
    process = start(case, folder)
    series = folder / "out" / "series.csv"
    while case.signal and process.poll() is None:
        if series.is_file() and series.stat().st_size > 2000:  # steps are under way
            process.send_signal(case.signal)
            break
        time.sleep(0.05)
    try:
        _, stderr = process.communicate(timeout=12 * SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return "hangs"
    if "An error occurred in MPI_Init" in stderr and tries:  # of two that start in the same moment
        return check(case, folder.with_name(folder.name + "+"), tries - 1)
    lines = without_mpirun(stderr) if case.ranks > 1 else stderr.splitlines()
    if process.returncode not in (0, 1, 2):
        return f"status {process.returncode}: {stderr[-600:]}"
    if process.returncode == 0 and lines:
        return f"a good run with {stderr[-600:]}"
    if process.returncode and not (len(lines) == 1 and lines[0].startswith("petves: error: ") and len(lines[0]) > 30):
        return f"status {process.returncode}: {stderr[:3000]}"  # from its start: mpirun's own lines are at the end
    return "" if process.returncode == 1 else not_finite(folder / "out")


MAY_BE_EMPTY = ("frequency", "gap", "viscosity", "normal_stress")  # columns, docs/output.md says when


def not_finite(folder: Path) -> str:
    """The first number in the files that is not finite; what may be empty is no number. -help leaves no files."""
    if not folder.exists():
        return ""
    series = read_series(folder / "series.csv")
    for name, column in series.items():
        wrong = np.isinf if name.startswith(MAY_BE_EMPTY) else lambda x: ~np.isfinite(x)
        if wrong(column).any():
            return f"series.csv: {name}"
    bad = []
    for path in (folder / "run.h5", folder / "checkpoint.h5"):
        with h5py.File(path) as file:
            names = []
            file.visit(names.append)
            sets = [name for name in names if isinstance(file[name], h5py.Dataset)]
            bad += [f"{path.name}: {name}" for name in sets if not np.isfinite(file[name][:]).all()]
    return bad[0] if bad else ""


def make_places(folder: Path) -> dict[str, str]:
    """A curve and a checkpoint that options may name."""
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    np.savetxt(folder / "curve.txt", 0.4 * np.c_[np.cos(t), 0.6 * np.sin(t)])
    first = "-domain_cells 16,16 -time_step 0.01 -time_end 0.02 -scheme_type coupled -scheme_order 2 -delta_type cbs54 "
    first += "-membrane_derivative spectral -coupling_near_field exact -fluid_inertia unsteady"
    run_petves(folder / "first", first)
    return {"curve": str(folder / "curve.txt"), "checkpoint": str(folder / "first" / "checkpoint.h5")}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """The case of a seed and a number; one in ten is of two ranks."""
    table, places = described(PETVES), make_places(tmp_path_factory.mktemp("places"))
    return lambda seed, k: Draw(seed, k, table, places).case(2 if k % 10 == 9 else 1)


@pytest.mark.parametrize("first", range(0, CASES, TOGETHER))
def test_cases_end_well(first, drawn, tmp_path):
    cases = {k: drawn(SEED, k) for k in range(first, first + TOGETHER)}
    found = {k: check(case, tmp_path / str(k)) for k, case in cases.items()}
    wrong = [f"case {k}, {cases[k]}\n  {what}" for k, what in found.items() if what]
    assert not wrong, f"seed {SEED}: {len(wrong)} of {TOGETHER}\n" + "\n".join(wrong)
    good = sum((tmp_path / str(k) / "out" / "summary.json").exists() for k in cases)
    assert TOGETHER / 10 < good < TOGETHER, "both kinds were drawn"


def test_every_kind_of_case_is_drawn(drawn):
    kinds = Counter(drawn(2024, k).kind for k in range(300))
    assert min(kinds[kind] for kind in ("numbers", "words", "option file", "curve", "checkpoint", "environment")) > 5
    assert kinds["signal"] > 0
