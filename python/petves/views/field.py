"""The membranes over the flow."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Callable

import numpy as np

from petves.run import Run
from petves.views.figures import MANY, PLAIN, Look, Sheet, new_sheet, save_figure
from petves.views.window import Window

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage

STREAMS = 1.1  # density of streamlines
OVER_FIELD, OVER_STREAMS = 1.2, 1.5  # matplotlib's order: streamlines, solids; membranes at its 2
SOLID = "#9a9a9a"  # colour of obstacles
CROWD = 200  # vesicles from which outlines are thin


@dataclass
class FieldKind:
    """How a field is drawn: its values from u, v, p, its colours, and the colour of what lies on it."""

    values: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
    label: str
    cmap: str
    line: str
    signed: bool


FIELDS = {
    "pressure": FieldKind(lambda u, v, p: p, "pressure $p$ (length$^2$/time$^2$)", "RdBu_r", "black", True),
    "speed": FieldKind(
        lambda u, v, p: np.hypot(u, v), r"speed $|\mathbf{u}|$ (length/time)", "viridis", "white", False
    ),
}


def draw_field(axes: Axes, kind: FieldKind, window: Window, look: Look, high: float | None = None) -> AxesImage:
    """Draw a field of the window's time smoothly; its colours reach to `high`, its largest value when left out."""
    values = kind.values(*window.fields())
    high = high or np.max(np.abs(values)) or 1.0
    low, cmap = (-high, kind.cmap) if kind.signed else (0.0, look.cmap or kind.cmap)
    places = dict(extent=window.extent, origin="lower", aspect="equal", interpolation="bilinear")
    image = axes.imshow(values, cmap=cmap, vmin=low, vmax=high, **places)
    unit = "(length from the vesicle)"
    names = [f"${c}$ {unit if window.origin[d] else '(length)'}" for d, c in enumerate("xy")]
    axes.set(xlabel=names[0], ylabel=names[1], xlim=window.limits[:2], ylim=window.limits[2:])
    return image


def draw_membranes(
    axes: Axes, run: Run, frame: int, limits: tuple[float, float], color: str, follow: int | None = None
) -> list[Artist]:
    """Draw the smooth outlines coloured by tension over a wider line of one colour, the first outline dotted.

    More than MANY vesicles are areas instead, each of a colour that it keeps. Obstacles are areas in grey. Images across a
    periodic seam are there too.

    Returns
    -------
    list of Artist
        What was drawn; of few vesicles the last one is what a colour bar of the tension needs.
    """
    from matplotlib.collections import LineCollection

    drawn: list[Artist] = []
    window = Window(run, frame, follow)
    drawn += draw_solids(axes, window)
    if run.vesicles > MANY:
        return [*drawn, draw_members(axes, run, frame, follow)]
    first = Window(run, 0, follow)
    for vesicle in range(run.vesicles):
        for initial in first.images(vesicle):
            drawn += axes.plot(*initial.T, ":", color=color, lw=1)
        tension = run.curve_tension(frame, vesicle)
        for points in window.images(vesicle):
            drawn += axes.plot(*points.T, "-", color=color, lw=4, solid_joinstyle="round")
            lines = LineCollection(np.stack([points[:-1], points[1:]], axis=1), cmap="plasma", lw=2.4, capstyle="round")
            lines.set_array(tension)
            lines.set_clim(*limits)
            drawn.append(axes.add_collection(lines))
    return drawn


def draw_solids(axes: Axes, window: Window) -> list[Artist]:
    """Draw the obstacles as grey areas over field and streamlines, below the membranes; return what was drawn."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    curves = window.solids()
    if not curves:
        return []
    codes = [[Outline.MOVETO] + [Outline.LINETO] * (len(points) - 2) + [Outline.CLOSEPOLY] for points in curves]
    path = Outline(np.concatenate(curves), np.concatenate(codes))
    return [axes.add_patch(PathPatch(path, facecolor=SOLID, edgecolor="black", lw=0.8, zorder=OVER_STREAMS))]


def draw_members(axes: Axes, run: Run, frame: int, follow: int | None = None) -> Artist:
    """Draw many vesicles as areas, images across a periodic seam included; vesicle v has colour v of a cycle of 20."""
    import matplotlib
    from matplotlib.collections import PolyCollection

    window = Window(run, frame, follow)
    outlines = [(v, points) for v in range(run.vesicles) for points in window.images(v, curve=run.vesicles < CROWD)]
    colors = matplotlib.colormaps["tab20"]([v % 20 for v, _ in outlines])
    width = 0.8 if run.vesicles < CROWD else 0.4
    return axes.add_collection(
        PolyCollection([points for _, points in outlines], facecolors=colors, edgecolors="black", lw=width)
    )


def box_sheet(window: Window, look: Look, panels: int, bars: bool = True, last: bool = False) -> Sheet:
    """Return a sheet of panels with the window's proportions."""
    x0, x1, y0, y1 = window.limits
    return new_sheet(x1 - x0, y1 - y0, panels, bars, last, look)


def plot_field(run: Run, frame: int = -1, look: Look = PLAIN) -> Path:
    """Draw the membranes, coloured by tension, over pressure and over speed with streamlines, at a saved time.

    The dotted outline is the initial one.
    """
    window = Window(run, frame, look.follow)
    few = 0 < run.vesicles <= MANY
    sheet = box_sheet(window, look, panels=2, last=few)
    limits = (run.tension[frame].min(), run.tension[frame].max()) if run.vesicles else (0.0, 1.0)
    drawn: list[Artist] = []
    for panel, bar, kind in zip(sheet.panels, sheet.bars, FIELDS.values()):
        image = draw_field(panel, kind, window, look)
        frame_of = ", in the frame of the vesicle" if window.moving and not kind.signed else ""
        sheet.figure.colorbar(image, cax=bar, label=kind.label + frame_of, orientation="horizontal")
        drawn = draw_membranes(panel, run, frame, limits, kind.line, look.follow)
    _draw_streamlines(sheet.panels[1], window)
    if few:
        label = r"tension $\sigma$ (length$^3$/time$^2$)"
        sheet.figure.colorbar(drawn[-1], cax=sheet.last, label=label, orientation="horizontal")
    sheet.panels[0].set_title(f"$t$ = {run.time[frame]:g}", loc="left", fontsize=10)
    return save_figure(sheet.figure, run.folder / "field.png", look)


def _draw_streamlines(axes: Axes, window: Window) -> None:
    u, v, _ = window.fields()
    if np.hypot(u, v).max() > 0:
        sides = window.limits[1::2] - window.limits[::2]
        density = STREAMS * np.clip(2 * sides / sides.max(), 0.4, 1.0)
        style = dict(color="white", linewidth=0.6, arrowsize=0.7, density=tuple(density), zorder=OVER_FIELD)
        axes.streamplot(*window.cell_centers(), u, v, **style).lines.set_alpha(0.7)
        axes.set(xlim=window.limits[:2], ylim=window.limits[2:])
