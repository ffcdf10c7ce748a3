"""Run the study of inertia and write its tables and its pictures."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullLocator

from studies.common.tables import table, write_csv
from petves.views.plot import dress, new_figure, save_figure
from studies.common.engine import Results
from studies.common.paper import PARACHUTE, POISEUILLE, RELAXATION
from studies.common.scenes import BOXES
from studies.inertia import runs as study

RELAXATIONS = (
    [("periodic", half, round(24 * half), 0.01) for half in (0.75, 1, 1.5, 2)]
    + [("periodic", 1, n, 0.01) for n in (28, 32, 40, 48, 64)]
    + [("periodic", 1, 48, dt) for dt in (0.005, 0.025)]
    + [(box, 1, 48, 0.01) for box in ("channel", "walls")]
)
"""Box, half width, cells in its width, time step."""

WINDOWS = (
    [(window, 40, 6, 0.005) for window in (20, 28, 40, 60)]
    + [(window, 40, 8, 0.005) for window in (28, 40)]
    + [(28, 40, 8, 0.0025)]
    + [(80, 80, 6, 0.005)]
)
"""Window and height in R0, cells a radius, time step over nu R0^3/c_b."""

PARACHUTES = [(20, 40, 8, 0.005), (28, 40, 8, 0.005), (40, 40, 8, 0.005), (40, 40, 6, 0.005)]
REYNOLDS = (0.001, 0.01, 0.1, 0.3, 0.9, 3, 10)
TRAVEL, SHORT = 160, 60


def write(folder: str | Path, quick: bool = False) -> list[Path]:
    """Run what is not there yet; write inertia_*.csv with every number, the tables of
    docs/evidence.md, two pictures and tables.md with all tables. Quick: without the channels."""
    folder = Path(folder)
    results = Results(folder / "inertia.json")
    text = _relaxation(results, folder) + _galilean(results, folder) + _iterations(results, folder)
    pictures = [folder / "galilean.png"]
    if not quick:
        text += _migration(results, folder) + _free(results, folder) + _parachute(results, folder)
        pictures.append(folder / "migration.png")
    path = folder / "tables.md"
    path.write_text("\n".join(text))
    return [path, *pictures]


def _relaxation(results: Results, folder: Path) -> list[str]:
    """Errors of the relaxing ellipse, percent."""
    rows, shown = [], []
    for box, half, n, dt in RELAXATIONS:
        one = results.get(study.relaxation(half, n, dt, box))
        errors = {t: [100 * (a / b - 1) for a, b in zip(one["found"][f"{t:g}"], RELAXATION[t])] for t in RELAXATION}
        rows += [[box, half, n, dt, t, *errors[t]] for t in errors]
        worst = [max(abs(e[k]) for e in errors.values()) for k in range(3)]
        energies = [f"{errors[t][0]:+.3f}" for t in errors]
        shown.append([box, f"{half:g}", str(n), f"R0/{0.36626 * n / 2 / half:.1f}", f"{dt:g}", *energies,
                      *(f"{w:.3f}" for w in worst), f"{one['its']:.1f} ({one['most']:.0f})"])  # fmt: skip
    names = ["energy", "x_extent", "y_extent"]
    write_csv(folder / "inertia_relaxation.csv", ["box", "half_width", "cells", "dt", "t", *names], rows)
    header = ["box", "half width", "cells", "h", "dt", *(f"E_B, t = {t:g}" for t in RELAXATION)]
    header += ["worst E_B", "worst x", "worst y", "iterations (most)"]
    write_csv(folder / "relaxation.csv", header, shown)
    title = "### Relaxing ellipse, none, against unbounded Stokes flow: errors in percent\n"
    return [title, *table(header, shown)]


def _deviation(results: Results, n: int, model: str, name: str, key: str) -> float:
    """Return the rms of a run's saved values minus those of the vesicle at rest, over R0 or the latter's largest."""
    rest, other = [np.array(results.get(study.galilean(n, model, x))[key]) for x in ("rest", name)]
    return float(np.sqrt(np.mean((other - rest) ** 2)) / (0.36626 if key == "shape" else np.abs(rest).max()))


def _galilean(results: Results, folder: Path) -> list[str]:
    """A vesicle in a stream against one at rest, and what a shift of half a cell makes."""
    keys, cells = ("shape", "velocity", "tension"), (32, 64, 128)
    rows, shown = [], []
    figure, axes = new_figure(11, 3.6, columns=3)
    for model, name, label, style in (
        ("convective", "stream", "convective", "o-"),
        ("unsteady", "stream", "unsteady", "s--"),
        ("convective", "shifted", "at rest, shifted by h/2", "x:"),
    ):
        errors = {k: [_deviation(results, n, model, name, k) for n in cells] for k in keys}
        rows += [[label, n, *(errors[k][i] for k in keys)] for i, n in enumerate(cells)]
        for i, n in enumerate(cells):
            orders = [f", order {np.log2(errors[k][i - 1] / errors[k][i]):.1f}" if i else "" for k in keys]
            shown.append([label, f"1/{n // 2}", *(f"{errors[k][i]:.1e}{o}" for k, o in zip(keys, orders))])
        for panel, key in zip(axes, keys):
            panel.loglog([2 / n for n in cells], errors[key], style, ms=4, lw=1.2, label=label)
    for panel, key in zip(axes, keys):
        dress(panel, grid="both", xlabel="cell size $h$ (length)", ylabel=f"deviation of the {key}")
        panel.set_xticks([2 / n for n in cells], [f"1/{n // 2}" for n in cells])
        panel.xaxis.set_minor_locator(NullLocator())
    axes[0].legend(frameon=False, fontsize=8)
    save_figure(figure, folder / "galilean.png")
    write_csv(folder / "inertia_galilean.csv", ["vesicle", "cells", *keys], rows)
    write_csv(folder / "galilean.csv", ["model", "h", "shape/R0", "velocity", "tension"], shown)
    title = "### A vesicle in a stream, Re = 1, against one at rest: rms over markers at t = 0.125, 0.3125, 0.5\n"
    return [title, *table(["", "h", "shape/R0", "velocity", "tension"], shown)]


def _iterations(results: Results, folder: Path) -> list[str]:
    """Iterations of none beside unsteady."""
    rows, shown = [], []
    for box, n in product(BOXES, (64, 128, 256)):
        line = [box, f"1/{n // 2}"]
        for model in ("unsteady", "none"):
            one = results.get(study.iterations(box, n, model))
            rows.append([box, n, model, one["its"], one["most"], one["nsolve"]])
            line += [f"{one['its']:.1f} ({one['most']:.0f})", f"{one['nsolve']:.0f}"]
        shown.append(line)
    write_csv(folder / "inertia_iterations.csv", ["box", "cells", "model", "mean", "most", "nsolve"], rows)
    header = ["box", "h", "unsteady (most)", "solves a step", "none (most)", "solves a step"]
    return ["### Iterations: relaxing ellipse, dt = h, default corrections, steps 11 to 40\n", *table(header, shown)]


def _way(results: Results, reynolds: float, model: str, n: int = 64, travel: float = TRAVEL, across: bool = False):
    one = results.get(study.migration(0.9 if model == "none" else reynolds, model, n, travel, across))
    return np.array(one["travel"]), np.array(one["height"])


def _migration(results: Results, folder: Path) -> list[str]:
    """Draw and tabulate migration in the channel of section 5.5."""
    rows, shown = [], []
    figure, axes = new_figure(11, 4.2, columns=2)
    for model, style in (("unsteady", "--"), ("convective", "-")):
        for k, reynolds in enumerate(REYNOLDS):
            way, height = _way(results, reynolds, model)
            color = f"C{k}"
            axes[0].plot(way, height, style, color=color, lw=1.1, label=f"{reynolds:g}" if style == "-" else None)
    way, height = _way(results, 0, "none")
    axes[0].plot(way, height, "k-", lw=1.8, label="none")
    axes[0].set(xlabel="$u_{max} t/R_0$", ylabel="height of the centroid over $R_0$")
    axes[0].legend(frameon=False, fontsize=7, title="Re; dashed: unsteady", title_fontsize=7)
    for model, style in (("none", "k-"), ("unsteady", "s--"), ("convective", "o-")):
        ends = [np.interp(SHORT, *_way(results, re, model)) for re in REYNOLDS]
        axes[1].semilogx(REYNOLDS, ends, style, ms=4, lw=1.2, label=model)
    axes[1].set(xlabel="Re $= u_{max} R_0/\\nu$", ylabel=f"height over $R_0$ at $u_{{max}} t/R_0$ = {SHORT}")
    axes[1].axhline(1, color="0.6", lw=0.8)
    axes[1].legend(frameon=False, fontsize=8)
    for panel in axes:
        panel.grid(alpha=0.3)
    save_figure(figure, folder / "migration.png")
    for reynolds in REYNOLDS:
        line = [f"{reynolds:g}"]
        for model, at in product(study.MODELS, (SHORT, TRAVEL)):
            height = np.interp(at, *_way(results, reynolds, model))
            rows.append([model, reynolds, 64, "along", at, height])
            line.append(f"{height:.3f}")
        shown.append(line)
    header = ["Re", *(f"{model}, {at}" for model, at in product(study.MODELS, (SHORT, TRAVEL)))]
    write_csv(folder / "migration.csv", header, shown)
    text = ["### Migration, w = 60, V = 0.7: height over R0 after u_max t/R0 = 60 and 160, h = R0/7.2\n"]
    text += table(header, shown)
    shown = []
    for name, n, travel, across in (("h = R0/10.8", 96, SHORT, False), ("across at the start", 64, TRAVEL, True)):
        line = [name]
        for model in study.MODELS:
            way, height = _way(results, 0.9, model, n, travel, across)
            values = [np.interp(at, way, height) for at in (SHORT, TRAVEL) if at <= travel]
            rows += [[model, 0.9, n, "across" if across else "along", at, v] for at, v in zip((SHORT, TRAVEL), values)]
            line.append(", ".join(f"{v:.3f}" for v in values))
        shown.append(line)
    write_csv(folder / "inertia_migration.csv", ["model", "reynolds", "cells", "start", "travel", "height"], rows)
    return text + ["### The same at Re = 0.9: a finer grid (60), a vesicle across the flow (60, 160)\n",
                   *table(["", *study.MODELS], shown)]  # fmt: skip


def _free(results: Results, folder: Path) -> list[str]:
    """Migration against unbounded Stokes flow."""
    rows, shown = [], []
    for window, height, cells, dt in WINDOWS:
        one = results.get(study.migration_free(window, height, cells, dt))
        apart = {t: one["height"][f"{t:g}"] - POISEUILLE[t] for t in (1, 2, 4, 6)}
        rows.append([window, height, cells, dt, *apart.values(), one["its"]])
        shown.append([f"{window}", f"{height}", f"R0/{cells}", f"{dt:g}", *(f"{a:+.4f}" for a in apart.values()),
                      f"{one['its']:.1f} ({one['most']:.0f})"])  # fmt: skip
    header = ["window", "height", "h", "dt", "t = 1", "t = 2", "t = 4", "t = 6", "iterations (most)"]
    write_csv(folder / "inertia_free.csv", ["window", "height", "cells", "dt", *header[4:8], "its"], rows)
    write_csv(folder / "free.csv", header, shown)
    title = (
        "### Migration, none, Ca = 10, against unbounded Stokes flow: height of the centroid minus target, over R0\n"
    )
    return [title, *table(header, shown)]


def _parachute(results: Results, folder: Path) -> list[str]:
    """Aspect and slip velocity of the centred vesicle."""
    rows, shown = [], []
    for window, height, cells, dt in PARACHUTES:
        one = results.get(study.parachute(window, height, cells, dt))
        got = one["aspect"][-1], one["slip"][-1]
        errors = [100 * (a / b - 1) for a, b in zip(got, PARACHUTE)]
        change = [abs(one[key][-1] / one[key][-2] - 1) for key in ("aspect", "slip")]
        rows.append([window, height, cells, dt, *got, *errors])
        shown.append([f"{window}", f"{height}", f"R0/{cells}", f"{got[0]:.4f} ({errors[0]:+.2f} %)",
                      f"{got[1]:.4f} ({errors[1]:+.2f} %)", f"{max(change):.0e}"])  # fmt: skip
    header = ["window", "height", "cells", "dt", "aspect", "slip", "aspect_percent", "slip_percent"]
    write_csv(folder / "inertia_parachute.csv", header, rows)
    columns = ["window", "height", "h", "aspect", "slip velocity", "change over the last 0.5"]
    return ["### Centred vesicle at Ca = 10, none: the parachute at t = 1.5\n", *table(columns, shown)]
