"""Pictures and films of runs in three dimensions."""

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LightSource, Normalize
from matplotlib.figure import Figure
from numpy.polynomial.legendre import leggauss, legvander

from petves.run import SurfaceRun
from petves.views.curves import plot_columns
from petves.views.field import TENSION
from petves.views.figures import PLAIN, Look, blank_figure

#: Views: what is on the two axes of the picture, and from where one looks (elevation, azimuth in degrees).
SIDES = {"$x, y$": (90, -90), "$x, z$": (0, -90), "$y, z$": (0, 0)}
LIGHT = LightSource(azdeg=150, altdeg=55)
LATITUDES = 36  # that are drawn at least; three times the saved ones, where these are more


def _basis(degree: int, theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Return functions whose sums are those of the spherical harmonics, at points: shape (points, functions)."""
    turns = [(m, turn(m * phi)) for m in range(degree + 1) for turn in (np.cos, np.sin)[: 1 + (m > 0)]]
    return np.hstack([(np.sin(theta) ** m * t)[:, None] * legvander(np.cos(theta), degree - m) for m, t in turns])


def smooth_surfaces(run: SurfaceRun, frame: int) -> np.ndarray:
    """Return x, y, z and tension of all surfaces at a saved time, shape (vesicles, 4, latitudes, longitudes).

    The grid is finer than that of the saved points; beside the poles, not at them, each of its parts has a normal.
    """
    p, n = run.degree, max(LATITUDES, 3 * (run.degree + 1))
    down = np.append(np.repeat(np.arccos(leggauss(p + 1)[0][::-1]), 2 * p + 2), (0, np.pi))
    around = np.append(np.tile(np.pi * np.arange(2 * p + 2) / (p + 1), p + 1), (0, 0))
    theta, phi = np.meshgrid(np.linspace(1e-3, np.pi - 1e-3, n), np.linspace(2 * np.pi, 0, 2 * n + 1), indexing="ij")
    finer = _basis(p, theta.ravel(), phi.ravel()) @ np.linalg.pinv(_basis(p, down, around))
    saved = np.concatenate([run.points[frame], run.tension[frame][..., None]], axis=-1)
    return np.moveaxis((finer @ saved).reshape(-1, *theta.shape, 4), -1, 1)


def tube_radius(run: SurfaceRun, x: np.ndarray) -> np.ndarray | None:
    """Return the radius of the wall at places x along a circular tube (length), shape of x; None in unbounded fluid."""
    tube = {name[5:]: float(value) for name, value in run.options().items() if name.startswith("tube_")}
    if not tube.get("radius"):
        return None
    depth = tube["radius"] - tube["throat"] if tube.get("throat") else 0
    out = np.abs(x - tube.get("throat_center", 0)) - tube.get("throat_length", 0) / 2
    along = np.clip(out / (tube.get("throat_mouth") or tube["radius"]), 0, 1)
    return tube["radius"] - depth * (1 + np.cos(np.pi * along)) / 2


def plot_surfaces(
    run: SurfaceRun, look: Look = PLAIN, frame: int = -1, over: np.ndarray | None = None, figure: Figure | None = None
) -> Figure:
    """Draw the surfaces at a saved time, coloured by tension: one view from the side and three along the axes, two of them
    with the wall of a tube.

    Colours span the tensions of the saved times `over`, or of that time. A figure that is given is cleared and drawn on.
    """
    figure = figure or blank_figure(look.width or 7, 0.86 * (look.width or 7))
    figure.clear()
    limits = Normalize(*run.tension_range(frame if over is None else over))
    colours = ScalarMappable(limits, matplotlib.colormaps[look.cmap or "viridis"])
    surfaces = smooth_surfaces(run, frame)
    along = np.linspace(surfaces[:, 0].min(), surfaces[:, 0].max(), 200)
    wall = tube_radius(run, along)
    for k, (name, (elevation, azimuth)) in enumerate({"": (24, -56), **SIDES}.items()):
        axes = figure.add_axes((0.5 * (k % 2), 0.54 - 0.43 * (k // 2), 0.5, 0.43), projection="3d", proj_type="ortho")
        for x, y, z, tension in surfaces:
            shown = dict(rstride=1, cstride=1, linewidth=0.5, facecolors=colours.to_rgba(tension), lightsource=LIGHT)
            axes.plot_surface(x, y, z, **shown)
        for side in (-1, 1) if wall is not None and k in (1, 2) else ():  # the views along the axes y and z
            axes.plot(along, *[side * wall * (k == other) for other in (1, 2)], color="0.5", lw=1)
        extent = np.array([np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())])
        axes.set_box_aspect(extent, zoom=0.95 * np.linalg.norm(extent) / extent.max())
        axes.view_init(elevation, azimuth)
        axes.set_axis_off()
        axes.set_title(name or f"$t$ = {run.time[frame]:.4g}", fontsize=9, y=0.96)
    figure.colorbar(colours, cax=figure.add_axes((0.25, 0.085, 0.5, 0.02)), orientation="horizontal", label=TENSION)
    return figure


def plot_course(run: SurfaceRun, look: Look = PLAIN) -> Figure:
    """Draw energy, angle and axes over time, of several vesicles the angle and axes of each."""
    return plot_columns(run, ("energy_bending", "inclination", "axis_long", "axis_middle", "axis_short"), look)
