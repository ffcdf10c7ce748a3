"""Runs of a study, each made once: one file keeps what is measured of them, so that a study that was stopped goes on."""

from __future__ import annotations

import json
import resource
import tempfile
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from threading import Lock
from typing import Callable

import numpy as np

from petves.program import run_program
from petves.run import RunError, read_series

Series = dict[str, np.ndarray]
Measure = Callable[[Series, Path], dict[str, object]]
"""Takes a run's columns and its folder; returns what the study needs as JSON."""


class Kept:
    """Entries by name in one file, which is written again, as a whole, after each new one."""

    def __init__(self, path: Path) -> None:
        self.path, self.added = path, 0
        self.lock = Lock()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self.entries = self.parse(path.read_text()) if path.is_file() else {}
        except OSError as error:
            raise RunError(f"{path.parent}: cannot be used ({error.strerror})") from None
        except ValueError as error:
            raise RunError(f"{path}: {error}; remove it to start afresh") from None

    def keep(self, name: object, entry: object) -> None:
        """Add an entry and write the file."""
        with self.lock:
            self.entries[name] = entry
            self.added += 1
            temporary = self.path.with_suffix(".tmp")
            temporary.write_text(self.text())
            temporary.replace(self.path)

    def parse(self, text: str) -> dict:
        """Return the entries of a file: JSON, a line an entry."""
        return json.loads(text)

    def text(self) -> str:
        """Return the file of the entries."""
        return "{\n" + ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in self.entries.items()) + "\n}\n"


@dataclass
class Case:
    """One run."""

    name: str  # in the file of results; the part before the first "_" names the study
    options: dict[str, str]
    measure: Measure
    ranks: int = 1  # 0 takes the study's
    may_fail: bool = False  # a run that stops (exit status 2) is a result: its measures are {"failed": line}
    files: dict[str, str] = field(default_factory=dict)  # texts of files that options name; `options` says which ones


class NotRun(RunError):
    """A case is not among the results, and none is to be run."""


class Results(Kept):
    """Measures of finished cases; with `run` false nothing is run."""

    def __init__(self, path: Path, ranks: int = 1, run: bool = True) -> None:
        super().__init__(path)
        self.ranks, self.run = ranks, run

    def has(self, case: Case) -> bool:
        """Return whether the measures of a case are there, for the same options and ranks."""
        known = self.entries.get(case.name)
        return bool(known) and known["options"] == case.options and known["ranks"] == (case.ranks or self.ranks)

    def get(self, case: Case) -> dict:
        """Return the measures of a case; run it first unless they are there for the same options and ranks."""
        if not self.has(case):
            self._may_run(case.name)
            print(f"running {case.name}", flush=True)
            self.keep(case.name, _made(case, case.ranks or self.ranks))
        return self.entries[case.name]["measures"]

    def in_turn(self, cases: dict[str, Case], repeats: int) -> dict[str, list[dict]]:
        """Return the measures of the runs NAME_0, NAME_1, ... of each case, made round by round: they are timed."""
        taken: dict[str, list[dict]] = {who: [] for who in cases}
        for number, (who, case) in product(range(repeats), cases.items()):
            taken[who].append(self.get(replace(case, name=f"{case.name}_{number}")))
        return taken

    def derive(self, name: str, options: dict[str, str], measure: Callable[[], dict[str, object]]) -> dict:
        """Return what is computed from other cases; compute it first unless it is there for the same options."""
        if self.entries.get(name, {}).get("options") != options:
            self._may_run(name)
            self.keep(name, {"options": options, "ranks": 0, "measures": measure()})
        return self.entries[name]["measures"]

    def arrays(self, name: str, options: dict[str, str], keep: Callable[[Series, Path], Series]) -> Series:
        """Return what `keep` takes of a run, from fields/ beside the results; run it when that is not there."""
        path = self.path.parent / "fields" / f"{name}.npz"

        def measure(series: Series, folder: Path) -> dict[str, object]:
            path.parent.mkdir(exist_ok=True)
            np.savez(path, **keep(series, folder))
            ends = {key: abs(series[key][-1]) for key in ("area_error", "length_error")}
            return {"steps": len(series["time"]) - 1} | ends | {"step_seconds": series["wall"].sum()}

        if not path.is_file():
            self.entries.pop(name, None)
        self.get(Case(name, options, measure))
        return dict(np.load(path))

    def _may_run(self, name: str) -> None:
        if not self.run:
            raise NotRun(name)


def _made(case: Case, ranks: int) -> dict[str, object]:
    """Run a case; return its entry."""
    words = [word for pair in case.options.items() for word in pair]
    limited = () if "-dim" in case.options else ("edge_ratio", "area_error", "length_error")
    limits = [word for name in limited for word in (f"-limit_{name}", "0")]
    with tempfile.TemporaryDirectory() as name:
        folder, before = Path(name), cpu_seconds()
        for number, (option, text) in enumerate(case.files.items()):
            (folder / f"input_{number}.txt").write_text(text)
            words += [option, str(folder / f"input_{number}.txt")]
        status, line = run_program([*limits, *words, "-output_dir", name], ranks)  # a study measures bad answers too
        spent = round(cpu_seconds() - before, 3)
        if status and not (case.may_fail and status == 2):
            raise RunError(f"{case.name}: exit status {status}: {line}")
        failed = {"failed": line.partition("; the last good state is in")[0]}
        measures = failed if status else case.measure(read_series(folder / "series.csv"), folder)
        commit = json.loads((folder / "summary.json").read_text())["git_commit"]
    measures |= {"cpu_seconds": spent}
    return {"options": case.options, "ranks": ranks, "commit": commit, "measures": measures}


def cpu_seconds() -> float:
    """Return the processor time of the programs run so far, all ranks, start and output included."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
