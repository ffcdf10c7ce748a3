"""Pictures of a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

from petves.run import Run

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ARROWS = 20  # arrows across the longer side of a velocity picture
OUTLINES = 7  # outlines in shapes.png
LEAST_SPAN = 0.02  # of an axis of angles over pi
FLOOR = 1e-16  # smallest value on a logarithmic axis
MANY = 8  # vesicles above which each has a colour and none a name


def new_figure(
    width: float, height: float, columns: int = 1, rows: int = 1, equal: bool = False
) -> tuple[Figure, np.ndarray]:
    """Return a figure that needs no display, and its axes, row by row; equal: of equal scales in x and y."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="compressed" if equal else "constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False).ravel()


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a PNG file; return its path."""
    figure.savefig(path, dpi=120)
    return path


def dress(axes: Axes, legend: float = 0, grid: str = "major", **names: Any) -> None:
    """Set what is named, draw a grid (major, minor or both) and, in letters of a size, a legend."""
    axes.set(**names)
    axes.grid(alpha=0.3, which=grid)
    if legend:
        axes.legend(frameon=False, fontsize=legend)


def plot_run(folder: str | Path) -> list[Path]:
    """Draw every picture that a run's files allow.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``; the pictures go there too.

    Returns
    -------
    list of Path
        The PNG files written.
    """
    run = Run.read(folder)
    drawn = [plot_energy(run), plot_field(run)]
    if run.vesicles:
        drawn += [plot_conservation(run), plot_tension(run), plot_shapes(run)]
    return drawn


def plot_energy(run: Run) -> Path:
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
    dress(axes, 10, xlabel="time $t$", ylabel=f"$E/{name}$" if name != "1" else "$E$ (length$^4$/time$^2$)")
    return save_figure(figure, run.folder / "energy.png")


def plot_conservation(run: Run) -> Path:
    """Draw the relative errors of area and length against time, on a logarithmic axis."""
    figure, (axes,) = new_figure(6, 4)
    time = run.series["time"][1:]
    for column, style, label in (
        ("area_error", "-", "area, $|A - A_0|/A_0$"),
        ("length_error", "--", "length, $|L - L_0|/L_0$"),
    ):
        axes.semilogy(time, np.maximum(np.abs(run.series[column][1:]), FLOOR), style, label=label)
    dress(axes, 10, xlabel="time $t$", ylabel="relative error")
    return save_figure(figure, run.folder / "conservation.png")


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


def draw_membranes(axes: Axes, run: Run, frame: int, limits: tuple[float, float], color: str) -> list[Artist]:
    """Draw the vesicles' edges coloured by tension over a wider line of one colour, the first outline dotted.

    More than MANY vesicles are areas instead, each of a colour that it keeps. Images across a periodic seam are there too.

    Returns
    -------
    list of Artist
        What was drawn; of few vesicles the last one is what a colour bar of the tension needs.
    """
    from matplotlib.collections import LineCollection

    drawn: list[Artist] = []
    if run.vesicles > MANY:
        return [draw_members(axes, run, frame)]
    for vesicle in range(run.vesicles):
        for initial in run.images(0, vesicle):
            drawn += axes.plot(*initial.T, ":", color=color, lw=1)
        for points in run.images(frame, vesicle):
            drawn += axes.plot(*points.T, "-", color=color, lw=4, solid_joinstyle="round")
            edges = np.stack([np.roll(points[:-1], 1, axis=0), points[:-1]], axis=1)
            lines = LineCollection(edges, cmap="plasma", lw=2.4, capstyle="round")
            lines.set_array(run.edge_tension(frame, vesicle))
            lines.set_clim(*limits)
            drawn.append(axes.add_collection(lines))
    return drawn


def draw_members(axes: Axes, run: Run, frame: int) -> Artist:
    """Draw many vesicles as areas, images across a periodic seam included; vesicle v has colour v of a cycle of 20."""
    import matplotlib
    from matplotlib.collections import PolyCollection

    outlines = [(v, points) for v in range(run.vesicles) for points in run.images(frame, v)]
    colors = matplotlib.colormaps["tab20"]([v % 20 for v, _ in outlines])
    width = 0.8 if run.vesicles < 200 else 0.4
    return axes.add_collection(
        PolyCollection([points for _, points in outlines], facecolors=colors, edgecolors="black", lw=width)
    )


def plot_motion(run: Run) -> Path:
    """Draw the inclination and the tank-treading frequency against time."""
    figure, (axes,) = new_figure(6, 4)
    time = run.series["time"]
    if run.vesicles > MANY:
        return _plot_motion_of_many(run, figure, axes)
    for vesicle in range(run.vesicles):
        suffix = f"_{vesicle + 1}" if run.vesicles > 1 else ""
        angle = np.unwrap(run.series["inclination" + suffix], period=np.pi) / np.pi
        name = f" of vesicle {vesicle + 1}" if run.vesicles > 1 else ""
        axes.plot(time, angle, color=f"C{vesicle}", label=rf"inclination $\theta/\pi${name}")
    if any(np.isfinite(run.series[name]).any() for name in run.series if name.startswith("frequency")):
        other = axes.twinx()
        other.set(ylabel="frequency (radians/time), dashed")
        for vesicle in range(run.vesicles):
            suffix = f"_{vesicle + 1}" if run.vesicles > 1 else ""
            other.plot(time, run.series["frequency" + suffix], "--", color=f"C{vesicle}")
    middle, half = np.mean(axes.get_ylim()), max(np.ptp(axes.get_ylim()) / 2, LEAST_SPAN / 2)
    limits, legend = (middle - half, middle + half), 10 if run.vesicles > 1 else 0
    dress(axes, legend, xlabel="time $t$", ylabel=r"inclination $\theta/\pi$", ylim=limits)
    return save_figure(figure, run.folder / "motion.png")


def _plot_motion_of_many(run: Run, figure: Figure, axes: Axes) -> Path:
    """Draw how vesicles lie: the mean axis of all (of twice the angle), and how well they agree with it."""
    turned = np.mean(np.exp(2j * run.each("inclination")), axis=1)
    axes.plot(
        run.series["time"],
        np.unwrap(np.angle(turned) / 2, period=np.pi) / np.pi,
        "C0-",
        label=r"mean axis $\theta/\pi$",
    )
    axes.plot(run.series["time"], np.abs(turned), "C1--", label="order $|\\langle e^{2i\\theta}\\rangle|$")
    dress(axes, 10, xlabel="time $t$", title=f"{run.vesicles} vesicles")
    return save_figure(figure, run.folder / "motion.png")


def draw_outlines(axes: Axes, run: Run, frame: int, color: object, style: str, label: str | None = None) -> None:
    """Draw the vesicles' outlines at a saved time, marker 0 as a dot."""
    for vesicle in range(run.vesicles):
        points = run.outline(frame, vesicle)
        axes.plot(*points.T, style, color=color, lw=1.5, label=label if vesicle == 0 else None)
        axes.plot(*points[0], "o", color=color, ms=4)


def plot_field(run: Run, frame: int = -1) -> Path:
    """Draw the membrane, coloured by tension, over pressure and over speed with arrows, at a saved time.

    The dotted outline is the initial one.
    """
    u, v, p = run.fields(frame)
    x, y = run.cell_centers()
    sides = run.box[1] - run.box[0], run.box[3] - run.box[2]
    tall = min(max(4.7 * sides[1] / sides[0], 1.6), 9.0)
    figure, axes = new_figure(12.4, tall + 1.9, columns=2, equal=True)
    few = run.vesicles <= MANY
    tension, drawn = run.tension[frame], []
    limits = (tension.min(), tension.max()) if run.vesicles else (0.0, 1.0)
    for panel, kind in zip(axes, FIELDS.values()):
        values = kind.values(u, v, p)
        high = np.max(np.abs(values)) or 1.0
        low = -high if kind.signed else 0.0
        image = panel.imshow(
            values, origin="lower", extent=run.box, cmap=kind.cmap, vmin=low, vmax=high, aspect="equal"
        )
        figure.colorbar(image, ax=panel, label=kind.label, location="bottom", shrink=0.8, pad=0.02)
        drawn = draw_membranes(panel, run, frame, limits, kind.line)
        panel.set(xlabel="$x$ (length)", ylabel="$y$ (length)", xlim=run.box[:2], ylim=run.box[2:])
    every = max(1, round(max(len(x), len(y)) / ARROWS))
    cut = np.s_[every // 2 :: every]
    axes[1].quiver(x[cut], y[cut], u[cut, cut], v[cut, cut], color="white", alpha=0.8, pivot="mid", width=0.003)
    if drawn and few:
        figure.colorbar(
            drawn[-1], ax=list(axes), label=r"tension $\sigma$ (length$^3$/time$^2$)", shrink=0.7, aspect=30
        )
    figure.suptitle(f"$t$ = {run.time[frame]:g}")
    return save_figure(figure, run.folder / "field.png")


def plot_tension(run: Run, frame: int = -1) -> Path:
    """Draw the tension against the phase angle about the centroid, at a saved time."""
    figure, (axes,) = new_figure(6, 4)
    few = run.vesicles <= MANY
    for vesicle in range(run.vesicles):
        angle = run.phase_angle(frame, vesicle) / np.pi
        order = np.argsort(angle)
        label = f"vesicle {vesicle + 1}" if few and run.vesicles > 1 else None
        style = dict(ms=4, lw=1) if few else dict(ms=0, lw=0.3, color=f"C{vesicle % 10}")
        axes.plot(angle[order], run.edge_tension(frame, vesicle)[order], ".-", label=label, **style)
    axes.set(xlabel=r"phase angle $\varphi/\pi$", ylabel=r"tension $\sigma$ (length$^3$/time$^2$)", xlim=(-1, 1))
    dress(axes, 10 if few and run.vesicles > 1 else 0, title=f"$t$ = {run.time[frame]:g}")
    return save_figure(figure, run.folder / "tension.png")


def plot_shapes(run: Run) -> Path:
    """Draw outlines at evenly spread saved times, with marker 0 as a dot."""
    import matplotlib

    if run.vesicles > MANY:
        return _plot_first_and_last(run)
    figure, (axes,) = new_figure(6, 5.2, equal=True)
    frames = np.unique(np.linspace(0, len(run.time) - 1, min(OUTLINES, len(run.time))).round().astype(int))
    colors = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, len(frames)))
    for frame, color in zip(frames, colors):
        draw_outlines(axes, run, frame, color, "-", label=f"{run.time[frame]:.4g}")
    axes.set(xlabel="$x$ (length)", ylabel="$y$ (length)", aspect="equal")
    axes.margins(0.08)
    axes.grid(alpha=0.3)
    axes.legend(title="time $t$", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return save_figure(figure, run.folder / "shapes.png")


def _plot_first_and_last(run: Run) -> Path:
    """Draw many vesicles in the box at the first and the last saved time."""
    sides = run.box[1] - run.box[0], run.box[3] - run.box[2]
    wide = sides[0] > sides[1]
    tall = 9 * min(max(sides[1] / sides[0], 0.2), 1.2)
    figure, axes = new_figure(
        9, 2 * tall + 1 if wide else tall / 2 + 1, rows=2 if wide else 1, columns=1 if wide else 2
    )
    for panel, frame in zip(axes, (0, -1)):
        draw_members(panel, run, frame)
        panel.set(xlim=run.box[:2], ylim=run.box[2:], aspect="equal", xlabel="$x$ (length)", ylabel="$y$ (length)")
        panel.set_title(f"$t$ = {run.time[frame]:.4g}")
    return save_figure(figure, run.folder / "shapes.png")
