"""Pictures of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from petves.run import Run
from petves.views.field import OVER_STREAMS, box_sheet, draw_members, draw_solids, plot_field
from petves.views.figures import MANY, PLAIN, Look, Sheet, dress, legend_above, new_figure, new_sheet, save_figure
from petves.views.window import Window

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OUTLINES = 7  # outlines in the picture of shapes
LEAST_SPAN = 0.02  # of an axis of angles over pi
FLOOR = 1e-16  # smallest value on a logarithmic axis
LAST = 0.1  # part of the run that says whether it is steady,
STEADY = 0.002  # and by how much of itself a steady value changes in it at most


def plot_run(folder: str | Path, look: Look = PLAIN) -> list[Path]:
    """Draw every picture that a run's files allow.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``; the pictures go there too.
    look : Look
        Format, size, colours, and whether fields and outlines go along with a vesicle.

    Returns
    -------
    list of Path
        The files written: energy, field, and with vesicles conservation, motion, tension, shapes.

    Raises
    ------
    RunError
        When the run cannot be read, or not be drawn this way.
    """
    run = Run.read(folder)
    drawn = [plot_energy(run, look), plot_field(run, look=look)]
    if run.vesicles:
        drawn += [plot(run, look=look) for plot in (plot_conservation, plot_motion, plot_tension, plot_shapes)]
    return drawn


def plot_energy(run: Run, look: Look = PLAIN) -> Path:
    """Draw kinetic, bending and total energy over the initial total energy (or over the largest, if that is 0)."""
    figure, (axes,) = new_figure(6, 4)
    time = run.series["time"]
    kinetic, bending = run.series["energy_kinetic"], run.series["energy_bending"]
    total = kinetic + bending
    scale, name = total[0], "E_0"
    if scale <= 0:
        scale, name = np.max(total), r"E_{\max}"
    if scale <= 0:
        scale, name = 1.0, "1"
    axes.plot(time, total / scale, "k-", lw=2, label="total $E$")
    if run.vesicles and run.c_b > 0:
        axes.plot(time, bending / scale, "--", color="C0", label="bending $E_B$")
    axes.plot(time, kinetic / scale, "-.", color="C1", label="kinetic $E_K$")
    dress(axes, xlabel="time $t$", ylabel=f"$E/{name}$" if name != "1" else "$E$ (length$^4$/time$^2$)")
    legend_above(axes)
    return save_figure(figure, run.folder / "energy.png", look)


def plot_conservation(run: Run, look: Look = PLAIN) -> Path:
    """Draw the relative errors of area and length against time, on a logarithmic axis."""
    figure, (axes,) = new_figure(6, 4)
    time = run.series["time"][1:]
    for column, style, label in (
        ("area_error", "-", "area, $|A - A_0|/A_0$"),
        ("length_error", "--", "length, $|L - L_0|/L_0$"),
    ):
        axes.semilogy(time, np.maximum(np.abs(run.series[column][1:]), FLOOR), style, label=label)
    dress(axes, xlabel="time $t$", ylabel="relative error")
    legend_above(axes)
    return save_figure(figure, run.folder / "conservation.png", look)


def steady_value(time: np.ndarray, values: np.ndarray) -> float | None:
    """Return the last value when the last tenth of the run changes by less than STEADY of it, else None."""
    last = values[time >= time[-1] - LAST * (time[-1] - time[0])]
    if len(last) < 3 or not np.isfinite(last).all():
        return None
    return float(last[-1]) if np.ptp(last) <= STEADY * abs(last[-1]) else None


def _draw_course(axes: Axes, time: np.ndarray, values: np.ndarray, color: str, label: str | None) -> None:
    """Draw a quantity against time, with its steady value, where it has one, as a dotted line and a number."""
    axes.plot(time, values, color=color, label=label)
    steady = steady_value(time, values)
    if steady is not None:
        axes.axhline(steady, color=color, ls=":", lw=1)
        place = dict(xytext=(4, 0), textcoords="offset points", va="center", fontsize=9, annotation_clip=False)
        axes.annotate(f"{steady:.4g}", (1.0, steady), xycoords=("axes fraction", "data"), color=color, **place)


def plot_motion(run: Run, look: Look = PLAIN) -> Path:
    """Draw the inclination and the tank-treading frequency against time; a steady value is marked."""
    if run.vesicles > MANY:
        return _plot_motion_of_many(run, look)
    time = run.series["time"]
    angles = np.unwrap(run.each("inclination"), period=np.pi, axis=0) / np.pi
    frequencies = run.each("frequency")
    turning = bool(np.isfinite(frequencies).any())
    figure, axes = new_figure(6, 4, rows=2 if turning else 1)
    for vesicle in range(run.vesicles):
        label = f"vesicle {vesicle + 1}" if run.vesicles > 1 else None
        _draw_course(axes[0], time, angles[:, vesicle], f"C{vesicle}", label)
        if turning:
            _draw_course(axes[1], time, frequencies[:, vesicle], f"C{vesicle}", None)
    middle, half = np.mean(axes[0].get_ylim()), max(np.ptp(axes[0].get_ylim()) / 2, LEAST_SPAN / 2)
    dress(axes[0], ylabel=r"inclination $\theta/\pi$", ylim=(middle - half, middle + half))
    if turning:
        dress(axes[1], ylabel="frequency (radians/time)", xlim=axes[0].get_xlim())
    axes[-1].set_xlabel("time $t$")
    if run.vesicles > 1:
        legend_above(axes[0], columns=4)
    return save_figure(figure, run.folder / "motion.png", look)


def _plot_motion_of_many(run: Run, look: Look) -> Path:
    """Draw how vesicles lie: the mean axis of all (of twice the angle), and how well they agree with it."""
    figure, (axes,) = new_figure(6, 4)
    turned = np.mean(np.exp(2j * run.each("inclination")), axis=1)
    time, axis = run.series["time"], np.unwrap(np.angle(turned) / 2, period=np.pi) / np.pi
    axes.plot(time, axis, "C0-", label=rf"mean axis $\theta/\pi$ of {run.vesicles} vesicles")
    axes.plot(time, np.abs(turned), "C1--", label="order $|\\langle e^{2i\\theta}\\rangle|$")
    dress(axes, xlabel="time $t$")
    legend_above(axes)
    return save_figure(figure, run.folder / "motion.png", look)


def plot_tension(run: Run, frame: int = -1, look: Look = PLAIN) -> Path:
    """Draw the tension against the phase angle about the centroid, at a saved time; many vesicles in one colour."""
    figure, (axes,) = new_figure(6, 4)
    few = run.vesicles <= MANY
    for vesicle in range(run.vesicles):
        angle = run.phase_angle(frame, vesicle) / np.pi
        order = np.argsort(angle)
        label = f"vesicle {vesicle + 1}" if run.vesicles > 1 else None
        style = dict(ms=4, lw=1, label=label) if few else dict(ms=0, lw=0.5, color="black", alpha=0.3)
        axes.plot(angle[order], run.edge_tension(frame, vesicle)[order], ".-", **style)
    names = dict(xlabel=r"phase angle $\varphi/\pi$", ylabel=r"tension $\sigma$ (length$^3$/time$^2$)", xlim=(-1, 1))
    dress(axes, **names)
    axes.set_title(f"$t$ = {run.time[frame]:g}", loc="right", fontsize=10)
    if few and run.vesicles > 1:
        legend_above(axes, columns=4)
    return save_figure(figure, run.folder / "tension.png", look)


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


def _left_the_box(run: Run) -> bool:
    """Return whether a membrane reaches over a periodic side of the box at a saved time."""
    if not run.markers.size:
        return False
    low, high = run.markers.min(axis=(0, 1)), run.markers.max(axis=(0, 1))
    return any(
        period > 0 and (low[d] < run.box[2 * d] or high[d] > run.box[2 * d + 1]) for d, period in enumerate(run.periods)
    )


def plot_shapes(run: Run, look: Look = PLAIN) -> Path:
    """Draw outlines at evenly spread saved times in the colours of time, with marker 0 as a dot.

    With obstacles, which are grey where they are last, or where a vesicle has left a periodic box, the whole box is drawn, outlines cut at the seam.
    """
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm

    if run.vesicles > MANY:
        return _plot_first_and_last(run, look)
    whole = look.follow is None and (bool(run.obstacles) or _left_the_box(run))
    frames = np.unique(np.linspace(0, len(run.time) - 1, min(OUTLINES, len(run.time))).round().astype(int))
    colors = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, len(frames)))
    sheet, limits = _sheet_of_shapes(run, frames, whole, look)
    for frame, color in zip(frames, colors):
        draw_outlines(sheet.panels[0], run, frame, color, "-", look.follow)
    if look.follow is None:  # seen from a vesicle they are elsewhere at each time
        draw_solids(sheet.panels[0], Window(run, -1))
    names = dict(xlabel="$x$ (length)", ylabel="$y$ (length)", xlim=limits[:2], ylim=limits[2:])
    dress(sheet.panels[0], aspect="equal", **names)
    scale = ScalarMappable(
        BoundaryNorm(np.arange(len(frames) + 1), len(frames)), matplotlib.colors.ListedColormap(colors)
    )
    ticks = np.arange(len(frames)) + 0.5
    bar = sheet.figure.colorbar(scale, cax=sheet.bars[0], label="time $t$", ticks=ticks, orientation="horizontal")
    bar.set_ticklabels([f"{run.time[frame]:.4g}" for frame in frames])
    return save_figure(sheet.figure, run.folder / "shapes.png", look)


def _sheet_of_shapes(run: Run, frames: np.ndarray, whole: bool, look: Look) -> tuple[Sheet, np.ndarray]:
    """Return a sheet with one panel, and its limits: the box, or what the outlines of these frames take."""
    if whole:
        return box_sheet(Window(run, 0), look, panels=1), run.box
    windows = [Window(run, frame, look.follow) for frame in frames]
    points = np.vstack([image for w in windows for v in range(run.vesicles) for image in w.images(v)])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.08 * np.max(high - low)
    low, high = low - margin, high + margin
    return new_sheet(*(high - low), panels=1, look=look), np.array([low[0], high[0], low[1], high[1]])


def _plot_first_and_last(run: Run, look: Look) -> Path:
    """Draw many vesicles in the box at the first and the last saved time."""
    sheet = box_sheet(Window(run, 0), look, panels=2, bars=False)
    for panel, frame in zip(sheet.panels, (0, -1)):
        draw_members(panel, run, frame, look.follow)
        draw_solids(panel, Window(run, frame, look.follow))
        limits = Window(run, frame, look.follow).limits
        panel.set(xlim=limits[:2], ylim=limits[2:], aspect="equal", xlabel="$x$ (length)", ylabel="$y$ (length)")
        panel.set_title(f"$t$ = {run.time[frame]:.4g}", fontsize=10)
    return save_figure(sheet.figure, run.folder / "shapes.png", look)
