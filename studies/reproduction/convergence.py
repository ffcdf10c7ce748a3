"""Tables 1 to 3 and 5 to 7, self-convergence of sections 5.2 and 5.3: differences from a finer run, beside the paper's."""

from __future__ import annotations

from math import log2
from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.tables import table, write_csv
from studies.common.curves import at, edge_lengths
from studies.common.engine import Results, Series
from studies.common.paper import CONVERGENCE, TABLE_3, TABLE_7
from studies.common.scenes import CELLS, fine_options, split_options

EULERIAN, LAGRANGIAN = ("u", "v", "p", "dp"), ("X", "Y", "sigma", "sigma_half")
NAMES = {
    "u": "u",
    "v": "v",
    "dp": "p: its change in the last step",
    "X": "X",
    "Y": "Y",
    "sigma_half": "sigma, half an edge off",
    "omega": "omega",
}
"""What the paper's norms are found to be of; see `_norms`."""
QUICK_REFERENCE = {"relax": 256, "shear": 128}
"""1/h of the finer run in quick mode; 512 otherwise, as in the paper."""


def state(series: Series, folder: Path) -> Series:
    """Return what a run ends with: fields at cell centres, dp of the last two saved times, markers, tension, frequency."""
    run = Run.read(folder)
    u, v, p = run.fields(-1)
    last = {"markers": run.markers[-1], "tension": run.tension[-1], "omega": series["frequency"][-1]}
    last["dp"] = p - run.fields(-2)[2]
    last["dp"] -= last["dp"].mean()
    return {"u": u, "v": v, "p": p - p.mean()} | {key: np.asarray(value) for key, value in last.items()}


def differences(coarse: Series, fine: Series, h: float) -> dict[str, float]:
    """Return L2 norms over the box (EULERIAN) and along the membrane (LAGRANGIAN), and |omega - omega_ref|.

    sigma_half: tension of edges beside the finer run's half an edge further on.
    """
    found = {}
    for name in EULERIAN:
        ratio, half = len(fine[name]) // len(coarse[name]), len(fine[name]) // len(coarse[name]) // 2
        if ratio * len(coarse[name]) == len(fine[name]) and ratio % 2 == 0:  # centres of coarse cells are fine corners
            near = [fine[name][half - a :: ratio, half - b :: ratio] for a in (0, 1) for b in (0, 1)]
            found[name] = h * np.sqrt(((coarse[name] - sum(near) / 4) ** 2).sum())
    n, m = len(coarse["markers"]), len(fine["markers"])
    length = edge_lengths(coarse["markers"]).sum()
    position = coarse["markers"] - at(fine["markers"], np.arange(n) / n)
    edges = (np.arange(n) - 0.5) / n + 0.5 / m  # edge k lies before marker k
    pairs = [np.stack([x, 0 * x], axis=1) for x in (fine["tension"], coarse["tension"])]
    tension = [pairs[1][:, 0] - at(pairs[0], edges + shift / n)[:, 0] for shift in (0, 0.5)]
    for name, values in zip(LAGRANGIAN, (*position.T, *tension)):
        found[name] = np.sqrt((values**2).mean() * length)
    omega = abs(float(coarse["omega"] - fine["omega"]))
    return found | ({} if np.isnan(omega) else {"omega": omega})


def split_state(results: Results, kind: str, n: int) -> Series:
    """Return the end of the paper's run on h = 1/n."""
    return results.arrays(f"split_{kind}_{n}", split_options(kind, n), state)


def truth(results: Results, kind: str) -> Series:
    """Return the end of the fine coupled run."""
    return results.arrays(f"truth_{kind}", fine_options(kind), state)


def itself(results: Results, kind: str, n: int, finer: int) -> dict[str, object]:
    """Return the run on h = 1/n against the same method on h = 1/finer: differences, errors of area and length."""

    def measure() -> dict[str, object]:
        own, fine = (split_state(results, kind, cells) for cells in (n, finer))
        return {"itself": differences(own, fine, 1 / n)}

    options = split_options(kind, n)
    found = results.derive(f"convergence_{kind}_{n}_{finer}", options | {"finer": str(finer)}, measure)
    return found | results.entries[f"split_{kind}_{n}"]["measures"]


def finest(results: Results, kind: str, quick: bool) -> int:
    """Return 1/h of the finer run: 512; in quick mode the finest that is there, QUICK_REFERENCE at least."""
    there = [n for n in (512, 256) if f"split_{kind}_{n}" in results.entries] if quick else [512]
    return max([*there, QUICK_REFERENCE[kind]])


def convergence(results: Results, folder: Path, kind: str, quick: bool) -> list[str]:
    """Return Tables 1 to 3 (relax) or 5 to 7 (shear)."""
    first, how = {
        "relax": (1, "fluid at rest, dt = h/2, t = 1, 1/h markers"),
        "shear": (5, "shear rate 1, dt = h/4, t = 5, markers 1.5 h apart"),
    }[kind]
    finer = finest(results, kind, quick)
    cells = [n for n in CELLS if n < finer]
    found = {n: itself(results, kind, n, finer) for n in cells}
    text = [f"## Tables {first} to {first + 2}: {how}\n", _norms(kind, finer, cells)]
    rows = []
    for name, label in NAMES.items():
        if name == "omega" and kind == "relax":
            continue
        paper = CONVERGENCE[kind]["p" if name == "dp" else name.split("_")[0]]
        power = -0.5 if kind == "relax" and name in EULERIAN else 0
        values = [found[n]["itself"][name] * (1 / n) ** power for n in cells]
        pairs = [f"{value:.3e} ({paper[CELLS.index(n)]:.3e})" for n, value in zip(cells, values)]
        label += ", over h^(1/2)" if power else ""
        rows.append([label, *pairs, _rates(values), _rates(paper[: len(cells)])])
    heads = [f"h = 1/{n}" for n in cells]
    text += table(["", *heads, "rates", "the paper's"], rows)
    text.append("The same runs in plain L2 norms, every quantity at its own place and time.\n")
    plain = {name: [found[n]["itself"][name] for n in cells] for name in ("u", "v", "p", "X", "Y", "sigma")}
    text += table(["", *heads, "rates"], [[k, *(f"{x:.3e}" for x in row), _rates(row)] for k, row in plain.items()])
    text += _conservation(
        results, kind, found | {finer: results.entries[f"split_{kind}_{finer}"]["measures"]}, first + 2
    )
    shown = [[n, name, found[n]["itself"][name]] for n in cells for name in found[n]["itself"]]
    write_csv(folder / f"convergence_{kind}.csv", ["1/h", "quantity", "from_finer_run"], shown)
    return text


def _conservation(results: Results, kind: str, found: dict[int, dict], number: int) -> list[str]:
    """Return Table 3 or 7."""
    kept, rows = {"relax": TABLE_3, "shear": TABLE_7}[kind], []
    for name in ("area", "length"):
        for n in (n for n in CELLS if n in found):
            value, paper = found[n][f"{name}_error"], kept[name][CELLS.index(n)]
            rows.append([name, f"1/{n}", f"{value:.4e}", f"{paper:.3e}", f"{100 * (value / paper - 1):+.1f} %"])
    text = [f"Table {number}: relative errors of area and length at the end.\n"]
    return text + table(["", "h", "here", "paper", "difference"], rows)


def _norms(kind: str, finer: int, cells: list[int]) -> str:
    """Say what the numbers beside the paper's are."""
    about = f"Differences from the same method on h = 1/{finer} (the paper: 1/512), in brackets the paper's. Fields at cell centres.\n"
    if kind == "shear":
        about += "The norms are those found for Tables 1 to 3, without the factor h^(1/2).\n"
    else:
        about += (
            "The paper does not say more of its norms. With L2 norms of u, v, p and sigma they cannot be: at rest its difference in u at\n"
            "h = 1/32 is three times the L2 norm of u itself (2.7e-3), and in shear its pressures are thousands of times smaller than the\n"
            "differences here. They fit, in size and rate, when\n\n"
            "- p is the last step's increment dp (step 5 of the method), not the pressure: in shear the flow is nearly steady;\n"
            "- sigma, which belongs to edges, is compared with a reference taken at markers, half an edge off: first order with\n"
            "  norm ds/2 of the derivative, whatever the method's own error;\n"
            "- the sums over cells at rest carry h, not h^2 (not so in shear): L2 norms over h^(1/2). The paper's v at 1/64 repeats\n"
            "  the number of u.\n"
        )
    return about + (f"\n{_expected(finer, cells)}\n" if finer != 512 else "")


def _rates(values: list[float]) -> str:
    """Return the logarithms to base 2 of the ratios of neighbours."""
    return ", ".join(f"{log2(a / b):.2f}" for a, b in zip(values, values[1:]))


def _expected(finer: int, cells: list[int]) -> str:
    """Say what a finer reference would add to the differences."""
    factors = [[(1 - (n / 512) ** p) / (1 - (n / finer) ** p) for n in cells] for p in (1, 2)]
    first, second = (", ".join(f"{x:.2f}" for x in row) for row in factors)
    return (
        f"From a run on 1/512 the differences would be larger by the factors {first} where the error is of first order,\n"
        f"{second} where it is of second."
    )
