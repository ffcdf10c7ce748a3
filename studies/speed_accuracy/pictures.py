"""Work-precision diagrams: a panel an error, log-log, every point and the envelope of each scheme."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from petves.views.plot import new_figure, save_figure
from studies.common.paper import BOUNDARY_INTEGRAL_CODES, SHEAR
from studies.speed_accuracy.bodies import UNCERTAIN
from studies.speed_accuracy.scenes import SCHEMES, Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STYLES = dict(
    zip(SCHEMES, zip("v^sDPopX", "#999999 #56b4e9 #0072b2 #cc79a7 #e69f00 #000000 #d55e00 #009e73".split()))
)  # the colours of Okabe and Ito: told apart without red and green
LABELS = {"cpu_seconds": "CPU seconds, one rank", "solves": "scalar fast solves"}
NAMES = {
    "largest": "largest of these errors",
    "shape": "shape: root mean square distance over $R_0$",
    "energy": "bending energy, relative",
    "angle": "inclination, relative",
    "frequency": "frequency, relative",
    "area": "area, relative",
    "length": "length, relative",
    "velocity": "migration velocity, relative",
    "place": "place of the first at the end, over $R_0$",
    "gap": "gap, relative",
    "viscosity": "effective viscosity, relative",
    "force": "force on the post, relative",
}
LOWEST, HIGHEST = 1e-8, 2.0  # errors drawn
UNCERTAINTY = 2e-5  # of SHEAR


def envelope(costs: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return the indices, by rising cost, of the points that no cheaper one equals in error."""
    order = np.lexsort((errors, costs))
    least = np.minimum.accumulate(np.append(np.inf, errors[order]))[:-1]
    return order[errors[order] < least]


def picture(folder: Path, one: Scene, rows: list[dict], cost: str, floor: dict[str, float], start: float) -> Path:
    """Draw the errors of a scene, rows of chart.csv, over a cost: cpu_seconds or solves.

    `floor`: errors of the reference itself, as far as known; `start`: CPU seconds of a run without steps.
    """
    names = ("largest", *one.wanted)
    columns = (len(names) + 2) // 2
    figure, axes = new_figure(4.2 * columns, 7.6, columns=columns, rows=2)
    for panel in axes[len(names) :]:
        panel.axis("off")
    for panel, name in zip(axes, names):
        for scheme, (marker, color) in STYLES.items():
            ran = [row for row in rows if row["scheme"] == scheme and not row["message"]]
            costs = np.array([row[cost] for row in ran], float)
            errors = np.maximum(np.array([row[name] for row in ran], float), LOWEST)
            keep = (errors < HIGHEST) & (costs > 0)
            costs, errors = costs[keep], errors[keep]
            if len(costs):
                panel.loglog(costs, errors, marker, color=color, ms=4, alpha=0.45, mew=0)
                best = envelope(costs, errors)
                panel.loglog(costs[best], errors[best], f"{marker}-", color=color, ms=5.5, lw=1.6, label=scheme)
        if cost == "cpu_seconds":
            panel.axvline(start, color="#999999", lw=0.8, ls="--", label="start of the program")
            if one.name == "free":
                _codes(panel, name)
        _floor(panel, one, name, floor)
        panel.set(xlabel=LABELS[cost], ylabel="error", title=NAMES[name])
        panel.title.set_fontsize(10)
        panel.grid(alpha=0.25)
        _decades(panel)
    handles = {label: h for p in axes for h, label in zip(*p.get_legend_handles_labels())}
    axes[len(names)].legend(handles.values(), handles.keys(), loc="center left", frameon=False, fontsize=9)
    figure.suptitle(one.title, fontsize=10)
    return save_figure(figure, folder / f"{one.name}_{'seconds' if cost == 'cpu_seconds' else cost}.png")


def _decades(panel: Axes) -> None:
    """Show two powers of ten of costs at least, and number powers of ten only."""
    from matplotlib.ticker import NullFormatter

    low, high = panel.get_xlim()
    panel.set_xlim(min(low, 0.9 * 10.0 ** (np.floor(np.log10(high)) - 1)), high)
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.yaxis.set_minor_formatter(NullFormatter())


def _codes(panel: Axes, name: str) -> None:
    """Draw the boundary integral codes, which solve the same unbounded flow."""
    column = {"angle": 1, "frequency": 2}.get(name)
    for (code, values), marker in zip(BOUNDARY_INTEGRAL_CODES.items(), "*p<"):
        if column and values[column]:
            label = f"{code},\n  boundary integral"
            panel.loglog(values[0], values[column], marker, mfc="white", mec="black", ms=9, ls="", label=label)


def _floor(panel: Axes, one: Scene, name: str, floor: dict[str, float]) -> None:
    """Draw what the reference is good for."""
    level = UNCERTAIN.get(one.name, {}).get(name) or floor.get(name, 0)
    if one.name == "shear" and name in ("angle", "frequency"):
        level = UNCERTAINTY / SHEAR["box"][0.7, 10][("angle", "frequency").index(name)]
    if name not in ("area", "length") and level:
        panel.axhline(max(level, LOWEST), color="black", lw=0.8, ls=":", label="uncertainty of the reference")
