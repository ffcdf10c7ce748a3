"""The runs behind the comparison with the paper's settings at h = 1/256: sections 5.2 (relax) and 5.3 (shear)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.accuracy_studies import last_markers
from petves.convergence import at, fine_options, split_options
from petves.studies import Case, Results, scene

KINDS = ("relax", "shear")
QUIET = {"-output_every": "1e9", "-checkpoint_every": "0"}


def _measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    return {
        "steps": len(series["time"]) - 1,
        "solves": float(series["nsolve"].sum()),
        "step_seconds": float(np.median(series["wall"][1:])),
        "all_steps_seconds": float(series["wall"].sum()),
        "markers": np.round(last_markers(folder), 9).ravel().tolist(),
    }


def paper(kind: str, n: int, tight: bool = False) -> Case:
    """Return the paper's run on h = 1/n; its solves to h^2, or (tight) to 1e-12."""
    options = split_options(kind, n) | QUIET
    if not tight:
        options = {name: value for name, value in options.items() if not name.endswith("_ksp_rtol")}
    return Case(f"paper_{kind}_{n}{'_tight' if tight else ''}", options, _measure, ranks=1)


def truth(kind: str, finer: bool = False) -> Case:
    """Return the fine coupled run of docs/reproduction.md, or a finer one that shows how far that has converged."""
    options = fine_options(kind) | QUIET
    if finer:
        cells, tolerance = {"relax": (384, "3e-7"), "shear": (288, "3e-6")}[kind]
        options |= {"-domain_cells": f"{cells},{cells}", "-time_adapt_tol": tolerance}
    return Case(f"{'finer' if finer else 'truth'}_{kind}", options, _measure, ranks=1)


def ours(kind: str, cells: int, tolerance: float, rtol: float = 1e-6, repeat: int = 0, **more: str) -> Case:
    """Return a run of the default scheme on cells^2 cells, and other options without their dash."""
    options = scene(kind, 0, 0, 0.02) | QUIET | {"-domain_cells": f"{cells},{cells}"}
    for name in ("-vesicle_markers", "-scheme_type", "-scheme_order"):
        del options[name]
    options |= {"-fluid_inertia": "unsteady", "-time_adapt": "error", "-time_adapt_tol": repr(tolerance)}
    options |= {"-coupled_ksp_rtol": repr(rtol)} | {f"-{name}": value for name, value in more.items()}
    label = "_".join([f"{cells}_{tolerance:g}_{rtol:g}", *(f"{a}_{b}" for a, b in more.items()), str(repeat)])
    return Case(f"ours_{kind}_{label}", options, _measure, ranks=1)


def distance(found: dict, fine: dict) -> float:
    """Return the L2 norm along the membrane of the markers' distance from a fine run's, at equal material points."""
    markers, exact = (np.reshape(one["markers"], (-1, 2)) for one in (found, fine))
    length = np.hypot(*(np.roll(markers, 1, axis=0) - markers).T).sum()
    apart = markers - at(exact, np.arange(len(markers)) / len(markers))
    return float(((apart**2).sum(axis=1).mean() * length) ** 0.5)


def error(results: Results, case: Case, kind: str) -> float:
    """Return the distance of a run from the fine coupled one."""
    return distance(results.get(case), results.get(truth(kind)))
