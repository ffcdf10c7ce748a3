"""The cells of the stability maps: what each runs, and what its mark is."""

from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Callable

import numpy as np

from petves.program import launch
from petves.run import read_series

SCHEMES = ("penalty", "split", "coupled")
"""Panels of a map that are schemes; all others are of coupled."""
MARKS = {
    "ok": ("·", "#4a9d5b"),
    "refused": ("R", "#d9d9d9"),
    "drift above 1 %": ("D", "#f2d16b"),
    "energy rises": ("E", "#e8973a"),
    "uneven edges": ("S", "#c65d3b"),
    "film drained": ("G", "#7a9e9f"),
    "membranes cross": ("X", "#3f5e5a"),
    "left the box": ("B", "#9c3848"),
    "solver failed": ("F", "#6b4c9a"),
    "NaN": ("N", "#222222"),
    "too slow": ("T", "#8fb7d9"),
    "no clean stop": ("!", "#ff00ff"),
}
"""Marks of a cell, with their letters and colours in the pictures; the last one is a defect of the program."""
NEEDLES = {
    "NANORINF": "NaN",
    "not finite": "NaN",
    "the solve with prefix": "solver failed",
    "-limit_edge_ratio": "uneven edges",
    "-limit_area_error": "drift above 1 %",
    "-limit_length_error": "drift above 1 %",
    "cells from the wall": "left the box",
    "is beyond the wall": "left the box",
    "the film between": "film drained",
    " cross after step": "membranes cross",
}
"""What the message of a run that stopped has in it, and the mark that this stands for; the first counts."""
STEPS = 60
SECONDS = 40
DRIFT = 0.01  # of area or length at the end: a step that overshoots and is taken back has not drifted
RISE = 0.01  # of the first energy: BDF2's plain energy may rise by a few thousandths in a quiescent fluid
STRETCHES = "-membrane_law"  # of a scene whose edges need not stay equal
COMMON = f"-output_every 1e9 -checkpoint_every 0 -time_wall_limit {SECONDS}"


@dataclass(frozen=True)
class Map:
    """A map of cells."""

    name: str  # in the CSV file
    title: str
    x_label: str
    xs: tuple
    y_label: str
    ys: tuple
    options: Callable[[object, object], tuple[str, ...]]  # at x, y: of one run, or of two, one going on from the other
    panels: dict[str, str] = field(default_factory=lambda: dict.fromkeys(SCHEMES, ""))  # name and options of each

    def cells(self) -> list[tuple[str, object, object]]:
        """Return panel, x, y of every cell."""
        return [(panel, x, y) for panel in self.panels for y in self.ys for x in self.xs]

    def stages(self, panel: str, x: object, y: object) -> tuple[str, ...]:
        """Return the options of a cell's run, or of its two."""
        return tuple(f"{options} {self.panels[panel]}".strip() for options in self.options(x, y))

    def quick(self) -> Map:
        """Return the map's corners."""
        ends = lambda values: tuple(dict.fromkeys((values[0], values[-1])))  # noqa: E731
        return replace(self, xs=ends(self.xs), ys=ends(self.ys))


def run_cell(panel: str, stages: tuple[str, ...]) -> dict[str, object]:
    """Run one cell; return its mark, the message of the run that stopped, and measures of its last run."""
    scheme = panel if panel in SCHEMES else "coupled"
    with tempfile.TemporaryDirectory() as folder:
        extra = ""
        for number, options in enumerate(stages):
            here = Path(folder) / str(number)
            if number:
                last = here.parent / str(number - 1)
                extra = f" -restart {last / 'checkpoint.h5'}"
                if scheme == "penalty":  # springs do not change when the step does
                    found = re.search(r"-penalty_stiffness (\S+)", (last / "resolved.opts").read_text())
                    extra += f" -penalty_stiffness {found[1]}"
            limit = f"-limit_edge_ratio {5 if STRETCHES in options else 2}"
            status, message = _launch(f"-scheme_type {scheme} {options} {COMMON} {limit}{extra}", here)
            if status:
                break
        return _measure(here, status, message, options)


def _launch(options: str, folder: Path) -> tuple[int, str]:
    """Run petves on one rank; return its status (-1: killed or not one line) and its line."""
    try:
        done = launch([*options.split(), "-output_dir", str(folder)], timeout=3 * SECONDS)
    except subprocess.TimeoutExpired:
        return -1, f"no end after {3 * SECONDS} seconds"
    lines = done.stderr.strip().splitlines()
    if not done.returncode:
        return 0, next((line for line in done.stdout.splitlines() if "petves: stopping" in line), "")
    if done.returncode in (1, 2) and len(lines) == 1 and lines[0].startswith("petves: error: "):
        return done.returncode, lines[0].removeprefix("petves: error: ").split("; the last good state")[0]
    return -1, f"status {done.returncode}: {' '.join(lines)[-300:]}"


def _measure(folder: Path, status: int, message: str, options: str) -> dict[str, object]:
    """Return mark, message and measures. With a viscosity ratio the flow is quasi-steady, and energy_kinetic no part of
    what falls."""
    quiescent = not any(name in options for name in ("-flow_type", "-fluid_gravity"))
    found = {"mark": mark(status, message), "message": message, "steps": 0}
    found |= {key: float("nan") for key in ("energy_rise", "area_error", "length_error", "drift", "edge_ratio", "its")}
    if status == 1 or not (folder / "series.csv").is_file():
        return found
    series = read_series(folder / "series.csv")
    energy = series["energy_bending"] + (0 if "_viscosity_ratio" in options else series["energy_kinetic"])
    found |= {
        "steps": len(energy) - 1,
        "energy_rise": (energy - np.minimum.accumulate(energy)).max() / energy[0] if quiescent else float("nan"),
        "area_error": np.abs(series["area_error"]).max(),
        "length_error": np.abs(series["length_error"]).max(),
        "drift": max(abs(series["area_error"][-1]), 0 if STRETCHES in options else abs(series["length_error"][-1])),
        "edge_ratio": series["edge_ratio"].max(),
        "its": series["coupled_its"][1:].mean() if len(energy) > 1 else float("nan"),
    }
    if found["drift"] > DRIFT and found["mark"] == "ok":
        found["mark"] = "drift above 1 %"
    if found["energy_rise"] > RISE and found["mark"] in ("ok", "drift above 1 %", "uneven edges"):
        found["mark"] = "energy rises"
    return found


def mark(status: int, message: str) -> str:
    """Return the mark that the end of a run alone stands for."""
    if status < 0:
        return "no clean stop"
    if status == 1:
        return "refused"
    if not status:
        return "too slow" if message else "ok"
    return next((name for needle, name in NEEDLES.items() if needle in message), "no clean stop")
