"""The runs behind the comparison with the paper's settings at h = 1/256: sections 5.2 (relax) and 5.3 (shear)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from petves.run import RunError
from studies.common.tables import table, write_csv
from studies.common.curves import edge_lengths, last_markers, material_distance
from studies.common.engine import Case, Results, Series
from studies.common.scenes import (
    LAST_ONLY,
    TIGHT_SPLIT,
    cells,
    ellipse,
    fine_options,
    option_text,
    split_options,
    words,
)
from studies.speed_accuracy.starts import starts

KINDS = ("relax", "shear")
REPEATS = 5  # runs in turn, whose median counts
STRETCH = 20  # steps of the paper's run that are timed
STEP_CELLS, PAIR_CELLS = (
    8000,
    4,
)  # what a step costs besides its solves, and in it a pair of markers, in cells of one solve
TABLE_SOLVES = 3 * 2 * 64  # scalar solves on the coarser grid of the box part's tables
FINER = {"relax": (384, "3e-7"), "shear": (288, "3e-6")}  # cells and tolerance


def _measure(series: Series, folder: Path) -> dict[str, object]:
    return {
        "steps": len(series["time"]) - 1,
        "solves": float(series["nsolve"].sum()),
        "step_seconds": float(np.median(series["wall"][1:])),
        "all_steps_seconds": float(series["wall"].sum()),
        "markers": np.round(last_markers(folder), 9).ravel().tolist(),
    }


def paper(kind: str, n: int, tight: bool = False) -> Case:
    """Return the paper's run on h = 1/n; its solves to h^2, or (tight) to 1e-12."""
    options = split_options(kind, n) | LAST_ONLY | (TIGHT_SPLIT if tight else {})
    return Case(f"paper_{kind}_{n}{'_tight' if tight else ''}", options, _measure)


def truth(kind: str, finer: bool = False) -> Case:
    """Return the fine coupled run of docs/reproduction.md, or a finer one that shows how far that has converged."""
    options = fine_options(kind) | LAST_ONLY
    if finer:
        options |= cells(FINER[kind][0]) | {"-time_adapt_tol": FINER[kind][1]}
    return Case(f"{'finer' if finer else 'truth'}_{kind}", options, _measure)


def ours(kind: str, n: int, tolerance: float, rtol: float = 1e-6, **more: str) -> Case:
    """Return a run of the default scheme on n^2 cells, and other options without their dash."""
    options = without(ellipse(kind, 0, 0, 0.02), "-vesicle_markers", "-scheme_type", "-scheme_order")
    options |= LAST_ONLY | cells(n) | words("-fluid_inertia unsteady -time_adapt error")
    options |= {"-time_adapt_tol": repr(tolerance), "-coupled_ksp_rtol": repr(rtol)}
    label = "_".join([f"{n}_{tolerance:g}_{rtol:g}", *(f"{a}_{b}" for a, b in more.items()), "0"])
    options |= {f"-{name}": value for name, value in more.items()}
    return Case(f"ours_{kind}_{label}", options, _measure, may_fail=True)


def fixed(kind: str, n: int, rtol: float, **more: str) -> Case:
    """Return a run of the default scheme with equal steps, time_step among the options."""
    case = ours(kind, n, 1e-3, rtol, **more)
    return replace(case, options=without(case.options, "-time_adapt", "-time_adapt_tol"))


def distance(found: dict, fine: dict) -> float:
    """Return the L2 norm along the membrane of the markers' distance from a fine run's, at equal material points."""
    markers, exact = (np.reshape(one["markers"], (-1, 2)) for one in (found, fine))
    return material_distance(markers, exact, edge_lengths(markers).sum())


def error(results: Results, case: Case, kind: str) -> float:
    """Return the distance of a run from the fine coupled one."""
    return distance(results.get(case), results.get(truth(kind)))


def candidates(kind: str) -> list[Case]:
    """Return the runs among which the cheapest as good as the paper's is looked for."""
    plain = {"coupling_box_part": "false"}  # its tables are the larger part of the start
    found = [ours(kind, n, tol, 1e-3, **plain) for n in (28, 32, 40) for tol in (1e-2, 3e-3, 1e-3, 5e-4)]
    found += [ours(kind, 28, tol, rtol, **plain) for tol in (2e-3, 4e-3, 5e-3) for rtol in (1e-2, 1e-3)]
    found += [ours(kind, n, tol, rtol) for n in (24, 32) for tol in (3e-3, 1e-3) for rtol in (1e-6, 1e-4, 1e-3)]
    for dt in {"relax": (1 / 32, 1 / 128), "shear": (1 / 16, 1 / 64)}[kind]:
        found.append(fixed(kind, 32, 1e-4, scheme_order="1", time_step=repr(dt), **plain))
    # so few steps that equal ones are cheaper than sizes by error: their dense factors are made three times in all
    end, counts, rtols, numbers = {
        "relax": (1, (10, 12, 13), (2e-3, 1e-3), ("25", "27", "29")),
        "shear": (5, (20, 21, 24), (1e-2, 3e-3), ("23", "25", "27")),
    }[kind]
    for count in counts:
        for markers in numbers:
            more = {"time_step": repr(end / count), "vesicle_markers": markers} | plain
            found += [fixed(kind, 24, rtol, **more) for rtol in rtols]
    return found


def without(options: dict[str, str], *names: str) -> dict[str, str]:
    """Return options but for some."""
    return {name: value for name, value in options.items() if name not in names}


def work(case: Case, found: dict) -> float:
    """Return what a run costs in cells of scalar solves, from counts, which no other program on the machine disturbs.

    Beside its solves: those for the tables of the box part, the steps, and in them the pairs of markers.
    """
    tables = 0 if case.options.get("-coupling_box_part") == "false" else TABLE_SOLVES
    cells_of_all = float(case.options["-domain_cells"].split(",")[0]) ** 2
    markers = len(found["markers"]) / 2
    return (found["solves"] + tables) * cells_of_all + found["steps"] * (STEP_CELLS + PAIR_CELLS * markers**2)


def cheapest(results: Results, kind: str, target: float) -> Case:
    """Return the candidate of least work whose error is at most the target."""
    ran = [(case, results.get(case)) for case in candidates(kind)]
    good = [(work(case, found), case.name, case) for case, found in ran if "failed" not in found]
    fine = results.get(truth(kind))
    good = [one for one in good if distance(results.get(one[2]), fine) <= target]
    if not good:
        raise RunError(f"{kind}: no candidate has an error of at most {target:.2e}")
    return min(good)[2]


def claim(results: Results, folder: Path, n: int) -> list[str]:
    """Compare the paper's settings on h = 1/n with the cheapest of ours that are as good; write claim.csv."""
    rows, chosen, costs = [], {}, {}
    for kind in KINDS:
        theirs = paper(kind, n)
        target = error(results, theirs, kind)
        best = cheapest(results, kind, target)
        seconds, cpu, per_solve = in_turn(results, kind, n, best)
        chosen[kind], costs[kind] = best, per_solve
        found = results.get(best)
        mine = [kind, n, "ours", error(results, best, kind), found["steps"], found["solves"]]
        rows.append([*mine, seconds, cpu, "", "", option_text(best.options)])
        cases = {"h^2": theirs} | ({"1e-12": paper(kind, n, tight=True)} if kind == "relax" else {})
        for name, case in cases.items():
            found = results.get(case)
            steps, whole = per_solve * found["solves"], found["cpu_seconds"]
            row = [kind, n, f"the paper's, solves to {name}", error(results, case, kind), found["steps"]]
            row += [found["solves"], steps, whole, steps / seconds, whole / cpu]
            rows.append([*row, option_text(case.options)])
    header = ["scene", "1/h", "run", "error", "steps", "solves", "step_seconds", "cpu_seconds"]
    write_csv(folder / "claim.csv", [*header, "ratio", "cpu_ratio", "options"], rows)
    shown = [[str(x) if isinstance(x, (str, int)) else f"{x:.3g}" for x in row[:-1]] for row in rows]
    text = [f"## The cheapest coupled run as good as the paper's settings on h = 1/{n}\n"]
    if n >= 256:
        apart = [distance(results.get(truth(kind)), results.get(truth(kind, finer=True))) for kind in KINDS]
        names = ", ".join(f"{kind} {value:.1e}" for kind, value in zip(KINDS, apart))
        text.append(f"The reference differs from a finer run by: {names}.\n")
    text += table([*header, "ratio of step seconds", "ratio of CPU seconds"], shown)
    measured = {kind: results.get(paper(kind, n)) for kind in KINDS}
    return text + (starts(results, chosen, measured, costs) if n >= 256 else [])


def in_turn(results: Results, kind: str, n: int, best: Case) -> tuple[float, float, float]:
    """Return medians of runs in turn: our step seconds in all, our CPU seconds, the paper's step seconds a solve."""
    taken = results.in_turn({"ours": best, "theirs": stretch(kind, n)}, REPEATS)
    # the first steps of a run take more solves
    a_solve = [one["step_seconds"] / (one["solves"] / one["steps"]) for one in taken["theirs"]]
    columns = [[one[key] for one in taken["ours"]] for key in ("all_steps_seconds", "cpu_seconds")]
    return tuple(float(np.median(values)) for values in (*columns, a_solve))


def stretch(kind: str, n: int) -> Case:
    """Return the first steps of the paper's run, for the time that a solve takes."""
    case = paper(kind, n)
    options = case.options | {"-time_end": repr(STRETCH * float(case.options["-time_step"]))}
    return replace(case, name=case.name.replace("paper", "stretch"), options=options)
