"""Options drawn at random, good and bad: a run ends well with finite numbers in its files, or with one line."""

import random
import resource
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import ENVIRONMENT, PETVES, ROOT, SANITIZE, os, read_series, run_petves

sys.path.insert(0, str(ROOT / "python"))
from check_readme import described  # noqa: E402

SEED = 2024
SETS = 300
SECONDS = 10

#: What numbers are drawn from besides the default, and words where a number or a name should be.
NUMBERS = ["0", "1", "2", "0.5", "1e-3", "0.1", "3", "10", "100", "-1", "1e9", "1e-9", "1e300", "1e-300"]
WORDS = ["nan", "inf", "abc", "1,2", "", "0x10", "1e", "-", "true", "9" * 40, "%s%n", "a" * 600]

#: Options with draws of their own; None: not drawn.
OWN = {
    "-domain_cells": ["8,8", "16,16", "24,24", "16,8", "17,17", "22,22", "9,9", "0,0", "7,7", "-8,-8", "16"],
    "-domain_box": ["-1,1,-1,1", "0,2,0,2", "-2,2,-1,1", "0,0,0,0", "-1e9,1e9,-1e9,1e9", "-1e-9,1e-9,-1e-9,1e-9"],
    "-vesicle_center": ["0,0", "0.1,-0.1", "1,1", "0.95,0", "1e300,0", "0,0,0.5,0.5", "-0.4,0,0.4,0"],
    "-vesicle_semi_axes": ["0.2,0.5", "0.5,0.5", "0.01,0.5", "0.3,0.3,0.2,0.2", "1e-9,1", "5,5", "1e150,1e150"],
    "-vesicle_file": ["no.txt", "{curve}", "/", "/dev/null"],
    "-restart": ["{checkpoint}", "no.h5", "/", "/dev/null", "{curve}"],
    "-vesicle_markers": ["8", "20", "21", "40", "7", "1000", "2000000000"],
    "-output_dir": None,
    "-time_wall_limit": None,
    "-output_overwrite": None,
}


def draw_value(draw: random.Random, default: str, allowed: str) -> str:
    """A value for an option that the help describes so; one in eight is no sensible text at all."""
    if draw.random() < 0.125:
        return draw.choice(WORDS)
    if "|" in allowed:
        return draw.choice(allowed.split("|"))
    return draw.choice([default, *NUMBERS])


def draw_options(draw: random.Random, table: list, places: dict[str, str]) -> list[str]:
    """A small scene and up to six options."""
    options = ["-domain_cells", "16,16", "-time_step", "0.01", "-time_end", "0.03", "-time_wall_limit", "3"]
    if draw.random() < 0.5:
        options += ["-scheme_type", draw.choice(["split", "penalty", "coupled", "direct"])]
    for name, default, _, allowed in draw.sample(table, draw.randint(0, 6)):
        values = OWN.get(name, [])
        if values is not None:
            options += [name, draw.choice(values).format(**places) if values else draw_value(draw, default, allowed)]
    if draw.random() < 0.1:
        options += [draw.choice(["-tension_ksp_max_it", "-coupled_ksp_rtol", "-bending_pc_type", "-no_such"]), "1"]
    return [word for word in options if word != ""]


def check(number: int, options: list[str], folder: Path) -> str:
    """Run one set; what is wrong with how it ended, or nothing."""
    limit = lambda: resource.setrlimit(
        resource.RLIMIT_CPU, (SECONDS * (4 if SANITIZE else 1), SECONDS * 8)
    )  # noqa: E731
    try:
        done = subprocess.run(
            [PETVES, *options, "-output_dir", str(folder)],
            env={**os.environ, **ENVIRONMENT},
            capture_output=True,
            text=True,
            errors="replace",
            timeout=12 * SECONDS,
            preexec_fn=limit,
            cwd=folder.parent,
        )
    except subprocess.TimeoutExpired:
        return "hangs"
    if "An error occurred in MPI_Init" in done.stderr:  # of two that start in the same moment: before petves begins
        return check(number, options, folder)
    lines = done.stderr.splitlines()
    if done.returncode not in (0, 1, 2):
        return f"status {done.returncode}: {done.stderr[-600:]}"
    if done.returncode == 0 and lines:
        return f"a good run with {done.stderr[-600:]}"
    if done.returncode and not (len(lines) == 1 and lines[0].startswith("petves: error: ") and len(lines[0]) > 30):
        return f"status {done.returncode}: {done.stderr[-600:]}"
    return "" if done.returncode == 1 else not_finite(folder)


def not_finite(folder: Path) -> str:
    """The first number in the files that is not finite; an empty frequency is no number."""
    series = read_series(folder / "series.csv")
    for name, column in series.items():
        if not name.startswith("frequency") and not np.isfinite(column).all():
            return f"series.csv: {name}"
    bad = []
    for path in (folder / "run.h5", folder / "checkpoint.h5"):
        with h5py.File(path) as file:
            file.visititems(
                lambda name, item: bad.append(f"{path.name}: {name}")
                if isinstance(item, h5py.Dataset) and not np.isfinite(item[:]).all()
                else None
            )
    return bad[0] if bad else ""


def test_random_options_end_well(tmp_path):
    draw, table = random.Random(SEED), described(PETVES)
    assert len(table) > 40
    curve = tmp_path / "curve.txt"
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    np.savetxt(curve, 0.4 * np.c_[np.cos(t), np.sin(t)])
    run_petves(tmp_path / "first", "-domain_cells 16,16 -time_step 0.01 -time_end 0.02 -scheme_type coupled")
    places = {"curve": str(curve), "checkpoint": str(tmp_path / "first" / "checkpoint.h5")}
    sets = [draw_options(draw, table, places) for _ in range(SETS)]
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda k: check(k, sets[k], tmp_path / f"set{k}"), range(SETS)))
    wrong = [f"set {k}: {' '.join(sets[k])}\n  {what}" for k, what in enumerate(results) if what]
    assert not wrong, f"seed {SEED}: {len(wrong)} of {SETS}\n" + "\n".join(wrong)
    good = sum((tmp_path / f"set{k}" / "summary.json").exists() for k in range(SETS))
    assert SETS / 10 < good < SETS, "both kinds were drawn"
