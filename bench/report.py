"""Tables and pictures of docs/performance, from bench/results."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import model
from petves.views.plot import new_figure, save_figure
from studies.common.tables import write_csv

Kept = dict[str, list[dict]]


def load(results: Path, name: str) -> Kept:
    """Return an item's runs."""
    return json.loads((results / f"{name}.json").read_text())


def median(values: list[float]) -> float:
    """Return the median."""
    return float(np.median(values))


def gathered(kept: Kept) -> dict[str, dict]:
    """Return the runs by name, the lists of all rounds put together; numbers become lists, one a round."""
    found: dict[str, dict] = {}
    for key, (one,) in kept.items():
        name = key.rsplit(" #", 1)[0]
        into = found.setdefault(name, {k: [] for k in one})
        for k, v in one.items():
            into[k] += v if isinstance(v, list) else [v]
    return found


def share(one: dict) -> float:
    """Return what steps spend besides their fast solves; a sum, as dense factors are made in some steps only."""
    return float(np.sum(one["rest"]) / (np.sum(one["rest"]) + np.sum(one["fast"])))


Table = tuple[list[str], list[list[str]]]


def report(results: Path, folder: Path) -> list[Path]:
    """Write the tables that docs/evidence.md and docs/performance/model.md show, and the pictures, into a folder; return the
    paths."""
    folder.mkdir(parents=True, exist_ok=True)
    rates, fitted = _fitted(results)
    tables = {
        "machine": _machine(results),
        "solve": _solve(results),
        "step": _step(results),
        "ranks": _ranks(results),
        "steady": _steady(results),
        "solvers": _solvers(results),
        "startup": _startup(results),
    }
    tables |= _size(results) | fitted | _predictions(rates)
    written = [write_csv(folder / f"{name}.csv", *table) for name, table in tables.items()]
    return [*written, _draw_solves(results, folder), _draw_size(results, folder), _draw_model(rates, folder)]


def _machine(results: Path) -> Table:
    return ["what", "this machine"], [[k, v] for k, v in json.loads((results / "machine.json").read_text()).items()]


def _solve(results: Path) -> Table:
    """Fast solves over copies and over fftw, medians of ratios within a repetition."""
    rows = []
    for one in (one for lines in load(results, "solve").values() for one in lines):
        a, copy = np.array(one["fftw_tridiagonal"]), np.array(one["copy"])
        line = [f"{one['cells']}^2", str(one["ranks"]), one["box"], one["what"], f"{1e3 * median(a):.2f}", f"{median(a / copy):.1f}"]  # fmt: skip
        for name in ("fftw", "hypre"):
            line.append(f"{median(np.array(one[name]) / a):.1f}" if name in one else "")
        line.append(f"{one['fftw_tridiagonal_residual']:.0e}" if one["what"] != "stokes" else "")
        rows.append(line)
    header = ["cells", "ranks", "box", "solve", "ms", "over a copy", "fftw over it", "hypre over it", "residual"]
    return header, rows


def _step(results: Path) -> Table:
    rows = []
    for name, one in gathered(load(results, "share")).items():
        scheme, cells, box, ranks = name.split()
        its = [median(one[k + "_its"]) for k in ("tension", "bending", "coupled")]
        shown = f"{its[0]:.0f}, {its[1]:.0f}" if scheme == "split" else f"{its[2]:.0f}"
        rows.append(
            [scheme, f"{cells}^2", box, ranks, f"{1e3 * median(one['step']):.3g}", f"{100 * share(one):.0f} %", f"{median(one['nsolve']):.0f}", shown]  # fmt: skip
        )
    header = ["scheme", "cells", "box", "ranks", "ms a step", "besides fast solves", "scalar solves", "iterations"]
    return header, rows


def _ranks(results: Path) -> Table:
    """Speed-up of two ranks, round by round."""
    rows = []
    for item in ("share", "ranks"):
        kept = load(results, item)
        for key, (two,) in kept.items():
            name, number = key.rsplit(" #", 1)
            scheme, cells, box, ranks = name.split()
            if ranks != "2" or number != "0":
                continue
            both = gathered(kept)
            one, two = both[f"{scheme} {cells} {box} 1"], both[name]
            ratios = [median(one[k]) / median(two[k]) for k in ("step", "fast", "rest")]
            size = cells if "x" in cells else f"{cells}^2"
            rows.append([scheme, size, box, *(f"{q:.2f}" for q in ratios)])
    return ["scheme", "cells", "box", "step", "fast solves", "rest"], rows


def _sizes(results: Path, box: str) -> list[dict]:
    """Return the runs of one box by size."""
    found = [one for name, one in gathered(load(results, "size")).items() if name.split()[2] == box]
    return sorted(found, key=lambda one: one["cells"][0])


def _deviation(cells: np.ndarray, seconds: np.ndarray) -> tuple[float, np.ndarray]:
    """Return c of the closest c N log2 N (relative), and each point's deviation."""
    work = cells**2 * np.log2(cells**2)
    ratio = seconds / work
    c = np.sum(1 / ratio) / np.sum(1 / ratio**2)
    return c, seconds / (c * work) - 1


def _size(results: Path) -> dict[str, Table]:
    """Steps and solves by size, of each box."""
    tables = {}
    for box in ("channel", "walls"):
        runs = _sizes(results, box)
        cells = np.array([one["cells"][0] for one in runs])
        seconds = np.array([median(one["step"]) for one in runs])
        each = np.array([median(one["fast"]) / median(one["nsolve"]) for one in runs])
        memory = np.array([max(one["memory"]) for one in runs])
        whole, solve = _deviation(cells, seconds)[1], _deviation(cells, each)[1]
        rows = []
        for k, one in enumerate(runs):
            grown = f"{np.diff(memory)[k - 1] / np.diff(cells**2)[k - 1] / 8:.0f}" if k else ""
            rows.append(
                [f"{cells[k]}^2", str(one["markers"][0]), f"{1e3 * seconds[k]:.1f}", f"{100 * whole[k]:+.0f} %", f"{median(one['nsolve']):.0f}",
                 f"{1e3 * each[k]:.2f}", f"{100 * solve[k]:+.0f} %", f"{100 * share(one):.0f} %", grown]
            )  # fmt: skip
        header = ["cells", "markers", "ms a step", "off N log N", "scalar solves", "ms a solve", "off N log N", "besides", "doubles a cell"]  # fmt: skip
        tables[f"size_{box}"] = (header, rows)
    return tables


def _steady(results: Path) -> Table:
    rows = []
    for name, one in gathered(load(results, "steady")).items():
        scheme, cells, box, _ = name.split()
        n, its = np.array(one["nsolve"]), np.array(one["coupled_its"])
        rows.append([f"{cells}^2", box, f"{n.mean():.1f}", f"{n.max():.0f}", f"{its.mean():.1f}"])
    return ["cells", "box", "scalar solves a step", "most", "iterations"], rows


def _solvers(results: Path) -> Table:
    rows = []
    found = gathered(load(results, "solvers"))
    for name, one in found.items():
        back_end, cells, box, ranks = name.split()
        base = median(found[f"fftw_tridiagonal {cells} {box} {ranks}"]["step"])
        rows.append([f"{cells}^2", back_end, f"{1e3 * median(one['step']):.3g}", f"{median(one['step']) / base:.1f}", f"{median(one['nsolve']):.0f}"])  # fmt: skip
    return ["cells", "back end", "ms a step", "over fftw_tridiagonal", "scalar solves"], rows


def _startup(results: Path) -> Table:
    rows = []
    for name, one in gathered(load(results, "startup")).items():
        _, cells, box, _ = name.split()
        start = np.array(one["setup"]) + np.array(one["first"])
        rows.append([f"{cells}^2", box, f"{median(one['setup']):.2f}", f"{median(start):.2f}"])
    return ["cells", "box", "set-up, s", "set-up and first step, s"], rows


def _copy_rate(results: Path) -> float:
    """Return the seconds a byte of copies on one rank, of the largest arrays: a word is read and written."""
    found = [one for lines in load(results, "solve").values() for one in lines if one["ranks"] == 1]
    most = max(one["cells"] for one in found)
    return median(
        [median(one["copy"]) / (16 * most**2) for one in found if one["cells"] == most and one["what"] == "p"]
    )


def _fitted(results: Path) -> tuple[model.Rates, dict[str, Table]]:
    """Fit the model to the sizes in the channel; by medians, without the few steps that make new dense factors."""
    measured, rows = [], []
    for one in _sizes(results, "channel"):
        s = model.Scene(one["cells"][0], one["markers"][0], np.mean(one["coupled_its"]))
        measured.append((s, median(one["fast"]), median(one["rest"])))
    rates, deviation = model.fit(measured, _copy_rate(results))
    for s, fast, rest in measured:
        solve = s.n**2 * (rates.flop * model.solve_flops(s) + rates.byte * model.solve_bytes(s))
        other = sum(model.parts(s, rates, 1, "petves").values()) - solve
        rows.append([f"{s.n}^2", *(f"{1e3 * t:.2f}" for t in (fast, solve, rest, other))])
    fitted = [
        ["grid data, copies, read and write", f"{1e-9 / rates.byte:.0f} GB/s"],
        ["arithmetic of the solves", f"{1e-9 / rates.flop:.1f} Gflop/s"],
        ["a step, however small", f"{1e3 * rates.step:.2f} ms"],
        ["a marker", f"{1e6 * rates.marker:.1f} microseconds"],
        ["M^2 and solve of M markers", f"{1e9 * rates.dense:.1f} ns"],
        ["largest deviation of the fit", f"{100 * deviation:.0f} %"],
    ]
    compared = (["cells", "fast solves, ms", "model", "rest, ms", "model"], rows)
    return rates, {"rates": (["of one rank", "rate"], fitted), "fit": compared}


def _predictions(rates: model.Rates) -> dict[str, Table]:
    layouts = ("petves", "shared", "pencil")
    rows, finer, limits = [], [], []
    for n in (4096, 8192, 16384, 32768):
        for ranks in (64, 256, 1024, 4096):
            s = model.more(n)
            p = model.parts(s, rates, ranks, "petves")
            cells = [f"{model.seconds(s, rates, ranks, layout):.3g}" for layout in layouts]
            rows.append([f"{n}^2", str(ranks), f"{n / ranks:g}", *cells, *(f"{100 * v / sum(p.values()):.0f} %" for v in p.values())])  # fmt: skip
        s = model.finer(n)
        finer.append([f"{n}^2", f"{s.markers:.0f}", *(f"{model.seconds(s, rates, 1024, layout):.3g}" for layout in layouts)])  # fmt: skip
        limits.append([f"{n}^2", *(str(model.last_useful(n, rates, layout)) for layout in layouts)])
    header = [
        "cells",
        "ranks",
        "rows a rank",
        *layouts,
        *("petves: grid", "markers", "replicated", "chain", "messages"),
    ]
    return {
        "predictions": (header, rows),
        "last_useful": (["cells", *layouts], limits),
        "finer": (["cells", "markers", *layouts], finer),
    }


def _draw_solves(results: Path, folder: Path) -> Path:
    """Draw array copies a solve against cells, one rank."""
    figure, axes = new_figure(9, 3.6, columns=2)
    lines = [one for lines in load(results, "solve").values() for one in lines if one["ranks"] == 1]
    for panel, box in zip(axes, ("walls", "channel")):
        for what, style in zip("uvp", ("o-", "s-", "^-")):
            runs = [one for one in lines if one["box"] == box and one["what"] == what]
            for name, colour in (("fftw_tridiagonal", "C0"), ("fftw", "C1"), ("hypre", "C2")):
                points = [(one["cells"], median(np.array(one[name]) / one["copy"])) for one in runs if name in one]
                if points:
                    panel.loglog(*zip(*points), style, color=colour, ms=4, lw=1, label=f"{name}, {what}")
        panel.axhline(25, color="k", lw=0.8, ls=":")
        cells = sorted({one["cells"] for one in lines})
        panel.set(xlabel="cells a direction", ylabel="time over a copy of the array", title=box)
        panel.set_xticks(cells, [str(n) for n in cells])
        panel.minorticks_off()
        panel.grid(alpha=0.3)
    axes[1].legend(frameon=False, fontsize=6, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return save_figure(figure, folder / "solves.png")


def _draw_size(results: Path, folder: Path) -> Path:
    """Draw seconds a step against cells with N log N."""
    figure, (axes,) = new_figure(6, 4)
    for box, colour in (("channel", "C0"), ("walls", "C1")):
        runs = _sizes(results, box)
        cells = np.array([one["cells"][0] for one in runs])
        seconds = np.array([median(one["step"]) for one in runs])
        c = _deviation(cells, seconds)[0]
        axes.loglog(cells**2, seconds, "o", color=colour, ms=5, label=f"coupled, {box}")
        axes.loglog(cells**2, c * cells**2 * np.log2(cells**2), "-", color=colour, lw=0.8, label="$c\\,N\\log N$")
    axes.set(xlabel="cells $N$", ylabel="seconds a step, one rank")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=8)
    return save_figure(figure, folder / "size.png")


def _draw_model(rates: model.Rates, folder: Path) -> Path:
    """Draw predicted seconds a step against ranks."""
    figure, axes = new_figure(9, 3.8, columns=2)
    for panel, n in zip(axes, (4096, 32768)):
        ranks = 2 ** np.arange(0, 13)
        for layout, style in (("petves", "o-"), ("shared", "x-"), ("pencil", "^-")):
            times = [model.seconds(model.more(n), rates, int(p), layout) for p in ranks]
            panel.loglog(ranks, times, style, ms=3, lw=1, label=layout)
        ideal = model.parts(model.more(n), rates, 1, "petves")["grid"] / ranks
        panel.loglog(ranks, ideal, "k:", lw=0.8, label="grid's work alone")
        panel.set(xlabel="ranks", ylabel="predicted seconds a step", title=f"${n}^2$ cells")
        panel.grid(alpha=0.3)
    axes[0].legend(frameon=False, fontsize=8)
    return save_figure(figure, folder / "model.png")
