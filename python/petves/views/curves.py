"""Curves: columns of series.csv over time, values at points and along lines and walls."""

import difflib
import re
from typing import Sequence

import numpy as np
from matplotlib.figure import Figure

from petves.dataset import load, unit
from petves.quantities import line, probe, wall_shear_stress
from petves.run import Run, RunError, RunFolder
from petves.views.figures import MANY, PLAIN, Look, dress, legend_above, new_figure

USUAL = ("gap", "pressure_drop", "obstacle_torque", "viscosity")  # columns drawn where a run has them
Panel = tuple[str, str, list[tuple[str, np.ndarray]]]
"""What is drawn, its unit, and curves with their labels."""


def spelled(text: str) -> str:
    """Return a unit in matplotlib's letters: length^2/time as length$^2$/time."""
    return re.sub(r"\^(\d)", r"$^\1$", text)


def draw_curves(x: np.ndarray, panels: list[Panel], xlabel: str, look: Look) -> Figure:
    """Draw panels one above the other over one x; labels stand over the first panel that has them."""
    told: list[str] = [""]
    figure, axes = new_figure(6, 1.0 + 1.7 * len(panels), rows=len(panels), look=look)
    for panel, (name, units, curves) in zip(axes, panels):
        for k, (label, values) in enumerate(curves):
            many = dict(color="black", alpha=0.3, lw=0.5) if len(curves) > MANY else dict(color=f"C{k}")
            panel.plot(x, values, label=label, **many)
        dress(panel, ylabel=f"{name}\n({spelled(units)})" if units not in ("", "1") else name, xlim=(x[0], x[-1]))
        panel.yaxis.label.set_size(9)
        if 1 < len(curves) <= MANY and told != [label for label, _ in curves]:
            told = [label for label, _ in curves]
            legend_above(panel, columns=4)
    axes[-1].set_xlabel(xlabel)
    figure.align_ylabels(axes)
    return figure


def columns_of(run: RunFolder, name: str) -> list[tuple[str, np.ndarray]]:
    """Return a column with an empty label, or each of the columns name_1, name_2, ... with its number; [] if there is none."""
    if name in run.series:
        return [("", run.series[name])]
    own = {k: v for k, v in run.series.items() if re.fullmatch(rf"{re.escape(name)}_\d+", k)}
    if not own and name in run.columns_of_each():
        return [("", values) for values in run.each(name).T]
    return [(key[len(name) + 1 :], values) for key, values in own.items()]


def plot_columns(run: RunFolder, columns: Sequence[str] = (), look: Look = PLAIN) -> Figure | None:
    """Draw columns of series.csv over time, a panel each: those asked for, else those of USUAL with values.

    A name without a number stands for all columns that have it with one (obstacle_torque). Without a column no picture.
    """
    known = dict.fromkeys(name for key in run.series for name in (key, re.sub(r"_\d+$", "", key)))
    known |= dict.fromkeys(run.columns_of_each())
    for name in columns:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            meant = f"; {near[0]} is meant?" if near else ""
            shown = ", ".join(key for key in known if not re.search(r"_\d+$", key))
            allowed = f"{shown}, and of one of several with its number, gap_1"
            raise RunError(f"column {name}: not one of this run{meant}; allowed: {allowed}")
    usual = [name for name in USUAL if name != "gap" or run.vesicles > 1]
    found = {name: columns_of(run, name) for name in columns or usual}
    if not columns:
        found = {name: curves for name, curves in found.items() if any(np.nan_to_num(y).any() for _, y in curves)}
    panels = [(name, unit(name, run), curves) for name, curves in found.items()]
    return draw_curves(run.series["time"], panels, "time $t$", look) if panels else None


def plot_points(run: Run, points: Sequence[Sequence[float]], look: Look = PLAIN) -> Figure:
    """Draw u, v and the total pressure at points over the saved times."""
    found = probe(load(run.folder, "xarray"), points)
    labels = [f"({x:g}, {y:g})" for x, y in points]
    panels = [(f"${name}$", unit(name), list(zip(labels, found[name].values.T))) for name in "uvp"]
    return draw_curves(run.time, panels, "time $t$", look)


def plot_line(run: Run, ends: Sequence[float], look: Look = PLAIN, frame: int = -1) -> Figure:
    """Draw u, v and the total pressure at a saved time along a line; `ends` are x, y of its begin and of its end."""
    found = line(load(run.folder, "xarray").isel(time=frame), ends[:2], ends[2:])
    panels = [(f"${name}$", unit(name), [("", found[name].values)]) for name in "uvp"]
    xlabel = f"distance (length), $t$ = {run.time[frame]:.4g}"
    return draw_curves(found["distance"].values, panels, xlabel, look)


def plot_walls(run: Run, look: Look = PLAIN, frame: int = -1) -> Figure:
    """Draw the shear stress on the walls at a saved time: on bottom and top along x, on left and right along y."""
    found = wall_shear_stress(load(run.folder, "xarray").isel(time=frame))
    if not found:
        raise RunError(f"{run.folder}: the box has no wall")
    directions = [along for along in "xy" if any(along in stress.dims for stress in found.values())]
    figure, axes = new_figure(6, 1.0 + 1.7 * len(directions), rows=len(directions), look=look)
    for panel, along in zip(axes, directions):
        for side, stress in found.items():
            if along in stress.dims:
                panel.plot(stress[along], stress, "--" if side in ("top", "right") else "-", label=side)
        dress(panel, xlabel=f"${along}$ (length)", ylabel=f"wall shear stress\n({spelled(unit('p'))})")
        legend_above(panel)
    axes[0].set_title(f"$t$ = {run.time[frame]:.4g}", loc="right", fontsize=10)
    return figure
