"""Tables 1 to 3 and 5 to 7, and the same errors against a fine coupled run beside ours."""

from __future__ import annotations

from pathlib import Path

from petves.convergence import EULERIAN, LAGRANGIAN, finest, ours, split_case
from petves.paper import CELLS, CONVERGENCE, TABLE_3, TABLE_7
from petves.scenes import QUIET, option_file
from petves.studies import Results
from petves.tables import table, write_csv

RACES = 3  # times that both runs of a comparison are repeated, in turn


def convergence(results: Results, folder: Path, kind: str, quick: bool) -> list[str]:
    """Return Tables 1 to 3 (relax) or 5 to 7 (shear)."""
    first, how = {
        "relax": (1, "fluid at rest, dt = h/2, t = 1, 1/h markers"),
        "shear": (5, "shear rate 1, dt = h/4, t = 5, markers 1.5 h apart"),
    }[kind]
    finer = finest(results, kind, quick)
    cells = [n for n in CELLS if n < finer]
    found = {n: results.get(split_case(results, kind, n, finer)) for n in cells}
    text = [f"## Tables {first} to {first + 2}: {how}\n"]
    text.append(
        f"L2 differences from the same method on h = 1/{finer} (the paper: 1/512), in brackets the paper's. Fields at cell\n"
        f"centres. {_expected(finer, cells)}\n"
    )
    rows = []
    names = (*EULERIAN, *LAGRANGIAN, *(["omega"] if kind == "shear" else []))
    for name in names:
        paper = CONVERGENCE[kind][name]
        values = [found[n]["itself"][name] for n in cells]
        pairs = [f"{value:.3e} ({paper[CELLS.index(n)]:.3e})" for n, value in zip(cells, values)]
        rows.append([name, *pairs, ", ".join(_rates(values)), ", ".join(_rates(paper[: len(cells)]))])
    text += table(["", *(f"h = 1/{n}" for n in cells), "rates", "the paper's"], rows)
    kept = {"relax": TABLE_3, "shear": TABLE_7}[kind]
    rows = []
    for name in ("area", "length"):
        for n in cells:
            value, paper = found[n][f"{name}_error"], kept[name][CELLS.index(n)]
            rows.append([name, f"1/{n}", f"{value:.4e}", f"{paper:.3e}", f"{100 * (value / paper - 1):+.1f} %"])
    text.append(f"Table {first + 2}: relative errors of area and length at the end.\n")
    text += table(["", "h", "here", "paper", "difference"], rows)
    shown = [[n, name, found[n]["itself"][name], found[n]["truth"].get(name, "")] for n in cells for name in names]
    write_csv(folder / f"convergence_{kind}.csv", ["1/h", "quantity", "from_finer_run", "from_coupled_run"], shown)
    return text


def _rates(values: list[float]) -> list[str]:
    """Return the logarithms to base 2 of the ratios of neighbours."""
    from math import log2

    return [f"{log2(a / b):.2f}" for a, b in zip(values, values[1:])]


def _expected(finer: int, cells: list[int]) -> str:
    """Say what a coarser reference does to an error of first order."""
    if finer == 512:
        return ""
    shares = ", ".join(f"{(1 / n - 1 / finer) / (1 / n - 1 / 512):.2f}" for n in cells)
    return f"By an error in proportion to h, this coarser reference would show {shares} of the paper's difference."


def race(results: Results, quick: bool) -> list[list[str]]:
    """Return rows: scene, the paper's method and ours, both errors, both times, each over the other."""
    rows = []
    for kind, name in (("relax", "relax"), ("shear", "shear_convergence")):
        sizes = (32, 64) if quick else CELLS
        for n in sizes:
            taken = {"paper": [], "ours": []}
            for repeat in range(RACES):
                theirs = split_case(results, kind, n, finest(results, kind, quick))
                theirs.name = f"race_{kind}_{n}_split_{repeat}"
                theirs.measure = ours(results, kind, {}, "").measure
                mine = ours(results, kind, option_file(name) | QUIET, f"beside_{n}_{repeat}")
                taken["paper"].append(results.get(theirs))
                taken["ours"].append(results.get(mine))
            rows.append(_compared(kind, n, taken))
    return rows


def _compared(kind: str, n: int, taken: dict[str, list[dict]]) -> list[str]:
    """Return one row of the comparison."""
    error = {who: sum(runs[0]["truth"][x] ** 2 for x in "XY") ** 0.5 for who, runs in taken.items()}
    ratios = sorted(a["step_seconds"] / b["step_seconds"] for a, b in zip(taken["paper"], taken["ours"]))
    scene = {"relax": "relaxing ellipse, t = 1", "shear": "ellipse in shear, t = 5"}[kind]
    steps = [str(taken[who][0]["steps"]) for who in ("paper", "ours")]
    errors = [f"{error['paper']:.2e}", f"{error['ours']:.2e}", f"{error['paper'] / error['ours']:.1f}"]
    return [scene, f"1/{n}", *steps, *errors, f"{ratios[len(ratios) // 2]:.1f}"]
