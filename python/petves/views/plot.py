"""Pictures of a run."""

from pathlib import Path
from typing import Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from petves.measures import ENERGIES
from petves.run import Run, RunError, RunFolder, SurfaceRun
from petves.views.curves import plot_columns, plot_line, plot_points, plot_walls
from petves.views.field import OVER_STREAMS, TENSION, box_sheet, draw_members, draw_solids, kinds_of, plot_field
from petves.views.figures import LEGEND, MANY, PLAIN, TICK, Look
from petves.views.figures import dress, legend_above, new_figure, new_sheet, save_figure
from petves.views.surfaces import plot_course, plot_surfaces
from petves.views.window import Window

IN_CROWD = dict(ms=0, lw=0.5, color="black", alpha=0.3)  # of a curve among many
OUTLINES = 7  # outlines in the picture of shapes
LEAST_SPAN = 0.02  # of an axis of angles over pi
FLOOR = 1e-16  # smallest value on a logarithmic axis
LAST = 0.1  # part of the run that says whether it is steady,
STEADY = 0.002  # and by how much of itself a steady value changes in it at most


def plot_run(
    folder: str | Path,
    look: Look = PLAIN,
    time: float | None = None,
    columns: Sequence[str] = (),
    fields: Sequence[str] = (),
    points: Sequence[Sequence[float]] = (),
    line: Sequence[float] | None = None,
    walls: bool = False,
) -> list[Path]:
    """Draw every picture that a run's files allow, or those that are asked for.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``; the pictures go there too. `RunError` when it cannot be read, or not be drawn this way.
    look : Look
        Format, size, colours, and whether fields and outlines go along with a vesicle.
    time : float, optional
        Draw what is of one time, field and tension or the fields, line and walls asked for, at the saved time nearest to it.
    columns : sequence of str
        Draw these columns of series.csv over time.
    fields : sequence of str
        Draw the membranes over these fields: pressure, speed, vorticity, stream_function.
    points : sequence of (x, y)
        Draw velocity and pressure at these points over time.
    line : (x, y, x, y), optional
        Draw velocity and pressure along a line.
    walls : bool
        Draw the shear stress along the walls.

    Returns
    -------
    list of Path
        The files written. All: energy, field, with vesicles conservation, motion, tension, shapes, and series where the run
        has a gap, a pressure drop, torques or a viscosity. Asked for: series, field, points, line, walls; with `time`
        pictures of one time have what was asked for in their names, as in field_t1.5.png. Of a run in three dimensions
        surfaces and course, or surfaces at that time.
    """
    run = Run.read(folder)
    frame, at = (-1, "") if time is None else (run.frame_at(time), f"_t{time:g}")
    figures: dict[str, Figure | None] = {}
    if isinstance(run, SurfaceRun):
        if columns or fields or len(points) or line is not None or walls:
            raise RunError(f"{folder}: a run in three dimensions has pictures of its surfaces alone; allowed: --time")
        course = {} if at else {"course": plot_course(run, look)}
        return _saved(run, {f"surfaces{at}": plot_surfaces(run, look, frame)} | course, look)
    if columns:
        figures["series"] = plot_columns(run, columns, look)
    if len(points):
        figures["points"] = plot_points(run, points, look)
    if line is not None:
        figures[f"line{at}"] = plot_line(run, line, look, frame)
    if walls:
        figures[f"walls{at}"] = plot_walls(run, look, frame)
    if fields or (time is not None and line is None and not walls):
        figures[f"field{at}"] = plot_field(run, look, frame, fields or ("pressure", "speed"))
        if run.vesicles and not fields:
            figures[f"tension{at}"] = plot_tension(run, look, frame)
    if not figures:
        figures = {"energy": plot_energy(run, look), "field": plot_field(run, look)}
        if run.vesicles:
            figures |= {"conservation": plot_conservation(run, look), "motion": plot_motion(run, look)}
            figures |= {"tension": plot_tension(run, look), "shapes": plot_shapes(run, look)}
        figures["series"] = plot_columns(run, look=look)
    return _saved(run, figures, look)


def _saved(run: RunFolder, figures: dict[str, Figure | None], look: Look) -> list[Path]:
    """Write the figures that there are into the run's folder, by their names; return the files."""
    return [save_figure(figure, run.folder / f"{name}.png", look) for name, figure in figures.items() if figure]


def plot_energy(run: RunFolder, look: Look = PLAIN) -> Figure:
    """Draw the energies of a run and their sum over the initial sum (or over the largest, if that is zero or less)."""
    figure, (axes,) = new_figure(6, 4, look=look)
    time, parts = run.series["time"], run.energies()
    total = sum(parts.values())
    largest = np.max(np.abs(total))
    scales = (total[0], "E_0"), (largest, r"E_{\max}"), (1.0, "1")
    scale, name = next(one for one in scales if one[0] > 1e-12 * largest)
    if len(parts) > 1:
        axes.plot(time, total / scale, "k-", lw=2, label="total $E$")
    styles = dict(zip(ENERGIES, ("--C0", "-.C1", ":C2", ":C3", "--C4", "-.C5")))
    for part, values in parts.items():
        axes.plot(time, values / scale, styles[part], label=f"{part} $E_{part[0].upper()}$")
    dress(axes, xlabel="time $t$", ylabel=f"$E/{name}$" if name != "1" else "$E$ (length$^4$/time$^2$)")
    legend_above(axes)
    return figure


def plot_conservation(run: RunFolder, look: Look = PLAIN) -> Figure:
    """Draw the relative errors of area, volume, and length where no membrane stretches, against time, logarithmically."""
    figure, (axes,) = new_figure(6, 4, look=look)
    time = run.series["time"][1:]
    kept = ("area", "volume") if "energy_stretching" in run.series else ("area", "length", "volume")
    for name, style in zip([name for name in kept if f"{name}_error" in run.series], ("-", "--")):
        values, letter = run.series[f"{name}_error"][1:], name[0].upper()
        label = f"{name}, $|{letter} - {letter}_0|/{letter}_0$"
        axes.semilogy(time, np.maximum(np.abs(values), FLOOR), style, label=label)
    dress(axes, xlabel="time $t$", ylabel="relative error")
    legend_above(axes)
    return figure


def is_steady(time: np.ndarray, values: np.ndarray, scale: float | None = None) -> bool:
    """Return whether the last tenth of the run changes by less than STEADY of the scale, the last value when left out."""
    last = values[time >= time[-1] - LAST * (time[-1] - time[0])]
    if len(last) < 3 or not np.isfinite(last).all():
        return False
    return bool(np.ptp(last) <= STEADY * abs(last[-1] if scale is None else scale))


def _is_at_rest(run: Run, vesicle: int) -> bool:
    """Return whether a vesicle's inclination, turning rate and velocity are steady together."""
    fastest = np.abs(run.velocity[-1]).max()
    scales = {"inclination": None, "frequency": None, "velocity_x": fastest, "velocity_y": fastest}
    own = {name: run.each(name)[:, vesicle] for name in scales}
    if not np.isfinite(own["frequency"][-1]):
        del own["frequency"]
    return all(is_steady(run.series["time"], values, scales[name]) for name, values in own.items())


def _mark(axes: Axes, steady: float, color: str) -> None:
    """Draw a steady value as a dotted line with its number."""
    axes.axhline(steady, color=color, ls=":", lw=1)
    place = dict(xytext=(4, 0), textcoords="offset points", va="center", fontsize=9, annotation_clip=False)
    axes.annotate(f"{steady:.4g}", (1.0, steady), xycoords=("axes fraction", "data"), color=color, **place)


def plot_motion(run: Run, look: Look = PLAIN) -> Figure:
    """Draw the inclination, without jumps by pi, and the tank-treading frequency against time; steady values are marked."""
    if run.vesicles > MANY:
        return _plot_motion_of_many(run, look)
    angles = np.unwrap(run.each("inclination"), period=np.pi, axis=0) / np.pi
    angles -= np.round(angles[-1] - run.each("inclination")[-1] / np.pi)  # the last one is that of series.csv
    courses = [angles, run.each("frequency")]
    courses = courses if np.isfinite(courses[1]).any() else courses[:1]
    figure, axes = new_figure(6, 4, rows=len(courses), look=look)
    for vesicle in range(run.vesicles):
        style = dict(color=f"C{vesicle}", ls="--" if vesicle else "-")  # one may hide another
        at_rest = _is_at_rest(run, vesicle)
        for panel, values in zip(axes, courses):
            panel.plot(run.series["time"], values[:, vesicle], label=f"vesicle {vesicle + 1}", **style)
            if at_rest and np.isfinite(values[-1, vesicle]):
                _mark(panel, values[-1, vesicle], style["color"])
    middle, half = np.mean(axes[0].get_ylim()), max(np.ptp(axes[0].get_ylim()) / 2, LEAST_SPAN / 2)
    dress(axes[0], ylabel=r"inclination $\theta/\pi$", ylim=(middle - half, middle + half))
    if len(courses) > 1:
        dress(axes[1], ylabel="frequency\n(radians/time)", xlim=axes[0].get_xlim())
    axes[-1].set_xlabel("time $t$")
    if run.vesicles > 1:
        legend_above(axes[0], columns=4)
    return figure


def _plot_motion_of_many(run: Run, look: Look) -> Figure:
    """Draw how vesicles lie: the mean axis of all (of twice the angle), and how well they agree with it."""
    figure, (axes,) = new_figure(6, 4, look=look)
    turned = np.mean(np.exp(2j * run.each("inclination")), axis=1)
    time, axis = run.series["time"], np.unwrap(np.angle(turned) / 2, period=np.pi) / np.pi
    axes.plot(time, axis, "C0-", label=rf"mean axis $\theta/\pi$ of {run.vesicles} vesicles")
    axes.plot(time, np.abs(turned), "C1--", label="order $|\\langle e^{2i\\theta}\\rangle|$")
    dress(axes, xlabel="time $t$")
    legend_above(axes)
    return figure


def plot_tension(run: Run, look: Look = PLAIN, frame: int = -1) -> Figure:
    """Draw the tension, and the stretch of membranes that stretch, against the phase angle about the centroid at a saved time."""
    shown = [(run.tension[frame], TENSION), (run.stretch[frame], "stretch")][: 1 + bool((run.stretch != 1).any())]
    figure, panels = new_figure(6 * len(shown), 4, columns=len(shown), look=look)
    few = run.vesicles <= MANY
    for vesicle in range(run.vesicles):
        angle, own = run.phase_angle(frame, vesicle) / np.pi, slice(*run.start[vesicle : vesicle + 2])
        order = np.argsort(angle)
        style = dict(ms=4, lw=1, label=f"vesicle {vesicle + 1}") if few else IN_CROWD
        for axes, (values, _) in zip(panels, shown):
            axes.plot(angle[order], values[own][order], ".-", **style)
    for axes, (_, label) in zip(panels, shown):
        dress(axes, xlabel=rf"phase angle $\varphi/\pi$ at $t$ = {run.time[frame]:.4g}", ylabel=label, xlim=(-1, 1))
    if few and run.vesicles > 1:
        legend_above(panels[0], columns=4)
    return figure


def draw_outlines(axes: Axes, run: Run, frame: int, color: object, style: str, follow: int | None = None) -> None:
    """Draw the vesicles' smooth outlines at a saved time, images across a periodic seam too, marker 0 as a dot.

    Obstacles that move are dotted.
    """
    window = Window(run, frame, follow)
    for vesicle in range(run.vesicles):
        for points in window.images(vesicle):
            axes.plot(*points.T, style, color=color, lw=1.5)
            axes.plot(*points[0], "o", color=color, ms=4)
    if follow is None and len(run.obstacle_markers):
        for points in window.solids():
            axes.plot(*points.T, ":", color=color, lw=1.0, zorder=OVER_STREAMS)


def plot_shapes(run: Run, look: Look = PLAIN) -> Figure:
    """Draw outlines at evenly spread saved times in the colours of time, with marker 0 as a dot.

    With obstacles, which are grey where they are last, or where a vesicle has left a periodic box, the whole box is drawn, outlines cut at the seam.
    """
    if run.vesicles > MANY:
        return _plot_first_and_last(run, look)
    low, high = run.markers.min(axis=(0, 1)), run.markers.max(axis=(0, 1))
    left = np.any(((low < run.box[::2]) | (high > run.box[1::2])) & (np.array(run.periods) > 0))
    whole = look.follow is None and (bool(run.obstacles) or left)
    frames = run.spread_frames(OUTLINES)
    colors = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, len(frames)))
    limits = run.box
    if not whole:
        windows = [Window(run, frame, look.follow) for frame in frames]
        points = np.vstack([image for w in windows for v in range(run.vesicles) for image in w.images(v)])
        margin = 0.08 * np.ptp(points, axis=0).max()
        limits = np.ravel([points.min(axis=0) - margin, points.max(axis=0) + margin], "F")
    sheet = new_sheet(*(limits[1::2] - limits[::2]), panels=1, look=look)
    for frame, color in zip(frames, colors):
        draw_outlines(sheet.panels[0], run, frame, color, "-", look.follow)
    if look.follow is None:  # seen from a vesicle they are elsewhere at each time
        draw_solids(sheet.panels[0], Window(run, -1))
    dress(sheet.panels[0], aspect="equal", xlabel="$x$ (length)", ylabel="$y$ (length)")
    sheet.panels[0].set(xlim=limits[:2], ylim=limits[2:])
    scale = ScalarMappable(BoundaryNorm(np.arange(len(frames) + 1), len(frames)), ListedColormap(colors))
    each = -(-len(frames) // max(1, int(sheet.bars[0].get_window_extent().width / sheet.figure.dpi / TICK)))
    ticks = np.arange(len(frames))[::-each][::-1] + 0.5
    bar = sheet.figure.colorbar(scale, cax=sheet.bars[0], label="time $t$", ticks=ticks, orientation="horizontal")
    bar.set_ticklabels([f"{run.time[frame]:.4g}" for frame in frames[::-each][::-1]])
    return sheet.figure


def _plot_first_and_last(run: Run, look: Look) -> Figure:
    """Draw many vesicles in the box at the first and the last saved time, kinds in colours that a legend below names."""
    _, kinds = kinds_of(run)
    sheet = box_sheet(Window(run, 0), look, panels=2, bars=False, last=len(kinds) > 1)
    if sheet.last is not None:
        sheet.last.set_axis_off()
        patches = [sheet.last.fill(np.nan, np.nan, f"C{k}", ec="black", label=kind)[0] for k, kind in enumerate(kinds)]
        columns = max(1, int(sheet.figure.get_figwidth() / 2.6))
        sheet.last.legend(handles=patches, loc="center", ncols=columns, frameon=False, fontsize=LEGEND)
    for panel, frame in zip(sheet.panels, (0, -1)):
        draw_members(panel, run, frame, look.follow)
        window = Window(run, frame, look.follow)
        draw_solids(panel, window)
        panel.set(xlim=window.limits[:2], ylim=window.limits[2:], aspect="equal")
        panel.set(xlabel="$x$ (length)", ylabel="$y$ (length)")
        panel.set_title(f"$t$ = {run.time[frame]:.4g}", fontsize=10)
    return sheet.figure
