"""The membranes over the flow."""

from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from petves.run import Run, RunError
from petves.views.figures import MANY, PLAIN, Look, Sheet, add_bar, new_sheet
from petves.views.window import Window

STREAMS = 1.1  # density of streamlines
OVER_FIELD, OVER_STREAMS = 1.2, 1.5  # matplotlib's order: streamlines, solids; membranes at its 2
SOLID = "#9a9a9a"  # colour of obstacles
LEAST = 1.0  # points that a membrane is wide at least, where it is thinner than usual so as not to hide a small vesicle
CROWD = 200  # vesicles from which outlines are thin
KINDS = 4  # of vesicles, up to which each has a colour
RARE = 1.5  # times what 99.5 % of the cells have at most: from there on colours leave the others out


@dataclass
class FieldKind:
    """How a field is drawn: its values in a window, its colours, and the colour of what lies on it."""

    values: Callable[[Window], np.ndarray]
    label: str
    cmap: str
    line: str = "black"
    signed: bool = True


FIELDS = {
    "pressure": FieldKind(lambda w: w.fields()[2], "pressure $p$ (length$^2$/time$^2$)", "RdBu_r"),
    "pressure_deviation": FieldKind(
        Window.pressure_deviation, "$p$ less mean gradient (length$^2$/time$^2$)", "RdBu_r"
    ),
    "speed": FieldKind(Window.speed, r"speed $|\mathbf{u}|$ (length/time)", "viridis", "white", False),
    "vorticity": FieldKind(Window.vorticity, r"vorticity $\omega$ (1/time)", "PuOr_r"),
    "stream_function": FieldKind(Window.stream_function, r"stream function $\psi$ (length$^2$/time)", "PRGn"),
}
TENSION = r"tension $\sigma$ (length$^3$/time$^2$)"


def field_kind(name: str) -> FieldKind:
    """Return how a field is drawn; RunError when there is none of that name."""
    if name not in FIELDS:
        raise RunError(f"field {name}: unknown; allowed: {', '.join(FIELDS)}")
    return FIELDS[name]


def reach(values: np.ndarray) -> float:
    """Return where colours end: at the largest value, or before it where few cells have much more than all others."""
    most, usual = np.max(np.abs(values)), np.percentile(np.abs(values), 99.5)
    return float(usual if 0 < RARE * usual < most else most) or 1.0


def draw_field(axes: Axes, kind: FieldKind, window: Window, look: Look, high: float = 0, most: float = 0) -> AxesImage:
    """Draw a field smoothly; colours reach to `high`, as `reach` says when left out. A film's largest value is `most`."""
    values = kind.values(window)
    high = high or reach(values)
    low, cmap = (-high, kind.cmap) if kind.signed else (0.0, look.cmap or kind.cmap)
    places = dict(extent=window.extent, origin="lower", aspect="equal", interpolation="bilinear")
    image = axes.imshow(values, cmap=cmap, vmin=low, vmax=high, **places)
    if max(most, np.max(np.abs(values))) > high:  # arrows at the ends of its colour bar
        image.cmap.colorbar_extend = "both" if kind.signed else "max"
    unit = "(length from the vesicle)"
    names = [f"${c}$ {unit if window.origin[d] else '(length)'}" for d, c in enumerate("xy")]
    axes.set(xlabel=names[0], ylabel=names[1], xlim=window.limits[:2], ylim=window.limits[2:])
    return image


def draw_membranes(
    axes: Axes, run: Run, frame: int, limits: tuple[float, float], color: str, follow: int | None = None
) -> list[Artist]:
    """Draw the outlines coloured by tension over a wider line of one colour, of up to MANY vesicles smooth, the first one dotted.

    Obstacles are areas in grey, tracers dots. Images across a periodic seam are there too. Returns what was drawn; with vesicles the last one
    is what a colour bar of the tension needs.
    """
    window, first = Window(run, frame, follow), Window(run, 0, follow)
    drawn: list[Artist] = draw_solids(axes, window)
    if run.tracers.size:
        style = dict(color="C1", markeredgecolor="black", markeredgewidth=0.3, markersize=2.5, zorder=OVER_STREAMS)
        drawn += axes.plot(*window.tracers().T, "o", **style)
    few, smooth = run.vesicles <= MANY, run.vesicles < CROWD
    wide = 4.0 if few else 2.0 if smooth else 1.0
    below, segments, tensions = [], [], []
    for vesicle in range(run.vesicles):
        if few:
            for initial in first.images(vesicle):
                drawn += axes.plot(*initial.T, ":", color=color, lw=1)
        for points in window.images(vesicle, curve=smooth):
            below.append(points)
            segments.append(np.stack([points[:-1], points[1:]], axis=1))
            tensions.append(run.curve_tension(frame, vesicle) if smooth else run.edge_tension(frame, vesicle))
    if run.vesicles:
        points = 72 / axes.figure.dpi * axes.get_window_extent().width / (window.limits[1] - window.limits[0])
        wide = np.clip(points * np.min(run.each("area")[0] / run.each("length")[0]) / 2, LEAST, wide)
        style = dict(zorder=OVER_FIELD + 0.8, rasterized=not smooth)
        drawn.append(axes.add_collection(LineCollection(below, colors=color, lw=wide, joinstyle="round", **style)))
        lines = LineCollection(np.concatenate(segments), cmap="plasma", lw=0.6 * wide, capstyle="round", **style)
        lines.set_array(np.concatenate(tensions))
        lines.set_clim(*limits)
        drawn.append(axes.add_collection(lines))
    return drawn


def draw_solids(axes: Axes, window: Window) -> list[Artist]:
    """Draw the obstacles as grey areas over field and streamlines, below the membranes; return what was drawn."""
    curves = window.solids()
    if not curves:
        return []
    path = Outline.make_compound_path(*(Outline(points, closed=True) for points in curves))
    return [axes.add_patch(PathPatch(path, facecolor=SOLID, edgecolor="black", lw=0.8, zorder=OVER_STREAMS))]


def kinds_of(run: Run) -> tuple[np.ndarray, list[str]]:
    """Return the number of each vesicle's kind, and the name of each kind; one kind without a name when they are many.

    Vesicles of a kind have one area, reduced area, bending stiffness and viscosity ratio, to a hundredth.
    """
    area, length = (run.each(name)[0] for name in ("area", "length"))
    reduced = 4 * np.pi * area / length**2
    names = {"$A$": area, "$V$": reduced, "$c_b$": run.bending, r"$\lambda$": run.viscosity_ratio}
    table = np.array([[f"{value:.2g}" for value in values] for values in names.values()])
    kinds, members = np.unique(table, axis=1, return_inverse=True)
    if kinds.shape[1] > KINDS or kinds.shape[1] == 1:
        return np.zeros(run.vesicles, int), [""]
    differ = [k for k in range(len(names)) if len(set(kinds[k])) > 1]
    return members, [", ".join(f"{list(names)[k]} = {kind[k]}" for k in differ) for kind in kinds.T]


def draw_members(axes: Axes, run: Run, frame: int, follow: int | None = None) -> Artist:
    """Draw many vesicles as areas in the colours of their kinds, images across a periodic seam included."""
    window, (members, _) = Window(run, frame, follow), kinds_of(run)
    outlines = [(v, points) for v in range(run.vesicles) for points in window.images(v, curve=run.vesicles < CROWD)]
    colors = [f"C{members[v]}" for v, _ in outlines]
    style = dict(facecolors=colors, edgecolors="black", lw=0.8 if run.vesicles < CROWD else 0.4)
    return axes.add_collection(PolyCollection([points for _, points in outlines], **style))


def box_sheet(window: Window, look: Look, panels: int, bars: bool = True, last: bool = False) -> Sheet:
    """Return a sheet of panels with the window's proportions."""
    return new_sheet(*(window.limits[1::2] - window.limits[::2]), panels, bars, last, look)


def plot_field(run: Run, look: Look = PLAIN, frame: int = -1, fields: Sequence[str] = ("pressure", "speed")) -> Figure:
    """Draw the membranes, coloured by tension, over fields at a saved time, the speed with streamlines.

    The dotted outline is the initial one.
    """
    window = Window(run, frame, look.follow)
    sheet = box_sheet(window, look, panels=len(fields), last=run.vesicles > 0)
    drawn: list[Artist] = []
    for panel, bar, field in zip(sheet.panels, sheet.bars, fields):
        kind = field_kind(field)
        image = draw_field(panel, kind, window, look)
        frame_of = ", in the frame of the vesicle" if window.moving and field in ("speed", "stream_function") else ""
        add_bar(bar, image, kind.label + frame_of)
        drawn = draw_membranes(panel, run, frame, run.tension_range(frame), kind.line, look.follow)
        if field == "speed":
            draw_streamlines(panel, window)
    if sheet.last is not None:
        add_bar(sheet.last, drawn[-1], TENSION)
    sheet.panels[0].set_title(f"$t$ = {run.time[frame]:g}", loc="left", fontsize=10)
    return sheet.figure


def draw_streamlines(axes: Axes, window: Window) -> None:
    """Draw streamlines of the window's velocity."""
    u, v, _ = window.fields()
    if np.hypot(u, v).max() > 0:
        sides = window.limits[1::2] - window.limits[::2]
        inches = axes.get_window_extent().width / axes.figure.dpi
        density = STREAMS * np.clip(2 * sides / sides.max(), 0.4, 1.0) * min(1.0, inches / 4)
        style = dict(color="white", linewidth=0.6, arrowsize=0.7, density=tuple(density), zorder=OVER_FIELD)
        axes.streamplot(*window.cell_centers(), u, v, **style).lines.set_alpha(0.7)
        axes.set(xlim=window.limits[:2], ylim=window.limits[2:])
