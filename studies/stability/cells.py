"""The cells of the stability maps: what each runs, and what its mark is."""

from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

from petves.program import launch
from petves.run import read_series
from studies.common.curves import radius
from studies.common.scenes import KERNELS

SCHEMES = ("penalty", "split", "coupled")
MARKS = {
    "ok": ("·", "#4a9d5b"),
    "refused": ("R", "#d9d9d9"),
    "drift above 1 %": ("D", "#f2d16b"),
    "energy rises": ("E", "#e8973a"),
    "edge ratio above 2": ("S", "#c65d3b"),
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
    "-limit_edge_ratio": "edge ratio above 2",
    "-limit_area_error": "drift above 1 %",
    "-limit_length_error": "drift above 1 %",
    "cells from the wall": "left the box",
}
"""What the message of a run that stopped has in it, and the mark that this stands for; the first counts."""
STEPS = 60
SECONDS = 40
DRIFT = 0.01  # of area or length at the end: a step that overshoots and is taken back has not drifted
RISE = 0.01  # of the first energy: BDF2's plain energy may rise by a few thousandths in a quiescent fluid
COMMON = f"-output_every 1e9 -checkpoint_every 0 -time_wall_limit {SECONDS} -limit_edge_ratio 2"
RELAX = "-vesicle_semi_axes 0.2,0.5"
SHEAR = "-domain_box -2.4,2.4,-2.4,2.4 -flow_type shear -vesicle_area 1"


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

    def cells(self) -> list[tuple[str, object, object]]:
        """Return scheme, x, y of every cell."""
        return [(scheme, x, y) for scheme in SCHEMES for y in self.ys for x in self.xs]

    def quick(self) -> Map:
        """Return the map's corners."""
        ends = lambda values: tuple(dict.fromkeys((values[0], values[-1])))  # noqa: E731
        return Map(self.name, self.title, self.x_label, ends(self.xs), self.y_label, ends(self.ys), self.options)


def _times(dt: float, steps: int = STEPS) -> str:
    return f"-time_step {dt!r} -time_end {steps * dt!r}"


def relax(dt: float, c_b: float, cells: int = 32, steps: int = STEPS) -> str:
    """Return the options of an ellipse in fluid at rest, [-1,1]^2."""
    return f"{RELAX} -domain_cells {cells},{cells} -vesicle_bending {c_b} {_times(dt, steps)}"


def shear(dt: float, reduced_area: float, chi: float, cells: int = 64) -> str:
    """Return the options of a vesicle of unit area in shear of rate 1, nu = 1, [-2.4,2.4]^2."""
    bending = radius(reduced_area) ** 3 / chi
    vesicle = f"-vesicle_reduced_area {reduced_area} -vesicle_bending {bending!r}"
    return f"{SHEAR} -domain_cells {cells},{cells} {vesicle} {_times(dt)}"


def thin(dt: float, reduced_area: float) -> str:
    """Return the options of a thin vesicle of unit area in fluid at rest."""
    return (
        "-domain_box -2.4,2.4,-2.4,2.4 -domain_cells 64,64 -vesicle_area 1 "
        f"-vesicle_reduced_area {reduced_area} -vesicle_bending 0.1 {_times(dt)}"
    )


def change(dt: float, factor: float) -> tuple[str, str]:
    """Return the options of 20 steps of an ellipse, and of STEPS more with another step."""
    scene = f"{RELAX} -domain_cells 32,32 -vesicle_bending 0.1"
    after = dt * factor
    return (
        f"{scene} {_times(dt, 20)}",
        f"{scene} -time_step {after!r} -time_end {20 * dt + STEPS * after!r}",
    )


def _powers(*exponents: int) -> tuple[float, ...]:
    """Return 2^-k for each k."""
    return tuple(2.0**-k for k in exponents)


ACROSS, STRONG = "cells across the box", r"shear, V = 0.7, $\chi = 1000$"
CHANGE = "ellipse at rest, $c_b = 0.1$, $32^2$: dt changes after 20 steps"
KERNEL = r"shear, V = 0.7, $\chi = 10$, $dt$ = 1/256, $64^2$"
CHIS, OVER_RATE = (0.1, 1.0, 10.0, 100.0, 1000.0), "$dt$ (over 1/rate)"
# fmt: off
STEP_MAP = Map("dt_h", "ellipse at rest, $c_b = 1$", ACROSS, (24, 32, 48, 64, 96), "$dt$", _powers(*range(3, 15)),
               lambda n, dt: (relax(dt, 1, n, 4 * STEPS),))  # a slow growth counts too
MAPS = (
    Map("dt_cb", "ellipse at rest, $32^2$", "$c_b$", (1e-4, 1e-2, 1.0, 100.0), "$dt$", _powers(3, 5, 7, 9, 11, 13),
        lambda c_b, dt: (relax(dt, c_b),)),
    Map("dt_chi", "shear, V = 0.7, $64^2$", r"$\chi$", CHIS, OVER_RATE, _powers(2, 4, 6, 8, 10),
        lambda chi, dt: (shear(dt, 0.7, chi),)),
    STEP_MAP,
    Map("V_chi", "shear, $dt$ = 1/64, $64^2$", r"$\chi$", CHIS[1:], "V", (0.2, 0.3, 0.5, 0.7, 0.9),
        lambda chi, v: (shear(1 / 64, v, chi),)),
    Map("spacing_kernel", KERNEL, "kernel", KERNELS, "ds/h", (0.75, 1.1, 1.3, 1.5, 2.0, 2.5),
        lambda kernel, spacing: (f"{shear(1 / 256, 0.7, 10)} -delta_type {kernel} -vesicle_spacing {spacing}",)),
    Map("dt_change", CHANGE, "new $dt$ over old", (1 / 64, 1 / 8, 8.0, 64.0), "first $dt$", _powers(6, 9, 12),
        lambda factor, dt: change(dt, factor)),
    Map("thin", "thin ellipse at rest, $c_b = 0.1$, $64^2$", "V", (0.2, 0.3, 0.4), "$dt$", _powers(4, 6, 8, 10),
        lambda v, dt: (thin(dt, v),)),
    Map("strong", STRONG, ACROSS, (32, 48, 64), OVER_RATE, _powers(2, 4, 6, 8), lambda n, dt: (shear(dt, 0.7, 1000, n),)),
)
# fmt: on


def run_cell(scheme: str, stages: tuple[str, ...]) -> dict[str, object]:
    """Run one cell; return its mark, the message of the run that stopped, and measures of its last run."""
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
            status, message = _launch(f"-scheme_type {scheme} {options} {COMMON}{extra}", here)
            if status:
                break
        return _measure(here, status, message, quiescent="-flow_type" not in options)


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


def _measure(folder: Path, status: int, message: str, quiescent: bool) -> dict[str, object]:
    """Return mark, message and measures."""
    found = {"mark": mark(status, message), "message": message, "steps": 0}
    found |= {key: float("nan") for key in ("energy_rise", "area_error", "length_error", "drift", "edge_ratio", "its")}
    if status == 1 or not (folder / "series.csv").is_file():
        return found
    series = read_series(folder / "series.csv")
    energy = series["energy_kinetic"] + series["energy_bending"]
    found |= {
        "steps": len(energy) - 1,
        "energy_rise": (energy - np.minimum.accumulate(energy)).max() / energy[0] if quiescent else float("nan"),
        "area_error": np.abs(series["area_error"]).max(),
        "length_error": np.abs(series["length_error"]).max(),
        "drift": max(abs(series["area_error"][-1]), abs(series["length_error"][-1])),
        "edge_ratio": series["edge_ratio"].max(),
        "its": series["coupled_its"][1:].mean() if len(energy) > 1 else float("nan"),
    }
    if found["drift"] > DRIFT and found["mark"] == "ok":
        found["mark"] = "drift above 1 %"
    if found["energy_rise"] > RISE and found["mark"] in ("ok", "drift above 1 %", "edge ratio above 2"):
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
