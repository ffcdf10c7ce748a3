"""What every scene of the gallery is made of: runs of an option file, measures kept of them, pictures made beside them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Callable

import numpy as np

from petves.run import Run
from petves.views.field import draw_members, draw_solids
from petves.views.figures import PLAIN, new_figure, save_figure
from petves.views.movie import movie
from petves.views.window import Window
from studies.common.engine import Case, Measure, Results, Series
from studies.common.scenes import option_file, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Table = list[list[object]]
"""The header and the rows of a CSV file."""

Values = dict[str, str | Table]
"""What the template's places are filled with, by their names: texts, and the names of tables' files."""


@dataclass(frozen=True)
class Scene:
    """A block of the template and what fills it.

    Attributes
    ----------
    name : str
        Name of its block in page.md; that of its option file, runs/gallery/NAME.opts.
    fill : callable
        Takes the results, makes what runs are missing, draws the scene's pictures; returns the values of its places.
    long : bool
        Left out by QUICK=1.
    """

    name: str
    fill: Callable[[Results], Values]
    long: bool = False


def case(name: str, file: str, changes: str, measure: Measure, ranks: int = 1, may_fail: bool = False) -> Case:
    """Return a run of runs/gallery/FILE.opts with changes, named FILE_NAME among the results."""
    options = option_file(f"gallery/{file}") | {"-checkpoint_every": "0"} | words(changes)
    return Case(f"{file}_{name}" if name else file, options, measure, ranks, may_fail)


def with_pictures(results: Results, one: Case, *names: str) -> dict:
    """Return the measures of a case whose measure also makes these files in the gallery's folder, again if one is missing."""
    if not all((results.path.parent / name).is_file() for name in names):
        results.entries.pop(one.name, None)
    return results.get(one)


Limits = tuple[float, float, float, float]


def moments(
    folder: Path, path: Path, times: tuple[float, ...], limits: Limits | None = None, rows: int = 1, width: float = 12
) -> None:
    """Draw all outlines of a run at some times, each at the saved one next to it, in the box or in other limits."""
    run = Run.read(folder)
    limits = limits or tuple(run.box)
    columns = -(-len(times) // rows)
    high = width / columns * (limits[3] - limits[2]) / (limits[1] - limits[0])
    figure, panels = new_figure(width, rows * (high + 0.3), columns=columns, rows=rows, equal=True)
    for panel, time in zip(panels, times):
        frame = int(np.abs(run.time - time).argmin())
        draw_solids(panel, Window(run, frame))
        draw_members(panel, run, frame)
        panel.set(xlim=limits[:2], ylim=limits[2:], aspect="equal", xticks=[], yticks=[])
        panel.set_title(f"$t$ = {run.time[frame]:.3g}", fontsize=9)
    save_figure(figure, path)


def film(folder: Path, path: Path, rate: float = 12, width: int = 640, every: int = 1) -> None:
    """Film the speed and the membranes of a run."""
    movie(folder, path, rate=rate, width=width, every=every, look=PLAIN)


def least(series: Series, column: str = "gap") -> tuple[float, float]:
    """Return the least value of a column and its time: by a parabola through the least row and its neighbours, if it has two."""
    time, value = series["time"], series[column]
    k = int(np.nanargmin(value))
    if k in (0, len(value) - 1):
        return float(value[k]), float(time[k])
    a, b, c = np.polyfit(time[k - 1 : k + 2] - time[k], value[k - 1 : k + 2], 2)
    return float(c - b * b / (4 * a)), float(time[k] - b / (2 * a))


def plain_ticks(panel: Axes, x: tuple[float, ...] = (), y: tuple[float, ...] = ()) -> None:
    """Write numbers as they are at these ticks of logarithmic axes, and none elsewhere."""
    for axis, ticks in ((panel.xaxis, x), (panel.yaxis, y)):
        if ticks:
            axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
            axis.set_minor_formatter("")


def seconds(*found: dict) -> str:
    """Return the processor seconds of some runs, as text."""
    total = sum(one["cpu_seconds"] for one in found)
    return f"{total:.1f}" if total < 10 else f"{total:.0f}"
