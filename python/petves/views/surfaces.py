"""Pictures and films of runs in three dimensions."""

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from petves.run import SurfaceRun
from petves.views.curves import draw_curves
from petves.views.field import TENSION
from petves.views.figures import PLAIN, Look, blank_figure

#: Views: what is on the two axes of the picture, and from where one looks (elevation, azimuth in degrees).
SIDES = {"$x, y$": (90, -90), "$x, z$": (0, -90), "$y, z$": (0, 0)}
LIGHT = np.array([0.3, -0.5, 0.8])  # where it comes from
SHADE = 0.55  # of a surface that looks away from the light


def plot_surfaces(
    run: SurfaceRun, look: Look = PLAIN, frame: int = -1, over: np.ndarray | None = None, figure: Figure | None = None
) -> Figure:
    """Draw the surfaces at a saved time, coloured by tension: one view from the side and three along the axes.

    Colours span the tensions of the saved times `over`, or of that time. A figure that is given is cleared and drawn on.
    """
    width = look.width or 7
    figure = figure or blank_figure(width, 0.86 * width)
    figure.clear()
    limits = run.tension_range(frame if over is None else over)
    colours = ScalarMappable(Normalize(*limits), matplotlib.colormaps[look.cmap or "viridis"])
    faces = run.points[frame][:, run.triangles].reshape(-1, 3, 3)  # triangle, corner, xyz
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    bright = SHADE + (1 - SHADE) * (1 + normals @ (LIGHT / np.linalg.norm(LIGHT))) / 2
    rgba = colours.to_rgba(run.tension[frame][:, run.triangles].mean(axis=-1).ravel())
    rgba[:, :3] *= bright[:, None]
    low, high = faces.min(axis=(0, 1)), faces.max(axis=(0, 1))
    middle, reach = (high + low) / 2, 0.52 * (high - low).max()
    sides = {f"{c}lim": (middle[d] - reach, middle[d] + reach) for d, c in enumerate("xyz")}
    for k, (name, (elevation, azimuth)) in enumerate({"": (24, -56), **SIDES}.items()):
        axes = figure.add_axes((0.5 * (k % 2), 0.54 - 0.43 * (k // 2), 0.5, 0.43), projection="3d", proj_type="ortho")
        axes.add_collection3d(Poly3DCollection(faces, facecolors=rgba, edgecolors=rgba, linewidths=0.2))
        axes.set(**sides)
        axes.set_box_aspect((1, 1, 1), zoom=1.5)
        axes.view_init(elevation, azimuth)
        axes.set_axis_off()
        axes.set_title(name or f"$t$ = {run.time[frame]:.4g}", fontsize=9, y=0.96)
    bar = figure.add_axes((0.25, 0.085, 0.5, 0.02))
    figure.colorbar(colours, cax=bar, orientation="horizontal", label=TENSION)
    return figure


def plot_course(run: SurfaceRun, look: Look = PLAIN) -> Figure:
    """Draw energy, angle and axes of the first vesicle over time."""
    series = run.series
    axes = [(f"{name} axis", series[f"axis_{name}"]) for name in ("long", "middle", "short")]
    panels = [
        ("bending energy", "length^5/time^2", [("", series["energy_bending"])]),
        ("angle / $\\pi$", "", [("", series["inclination"] / np.pi)]),
        ("half axes", "length", axes),
    ]
    return draw_curves(series["time"], panels, "time $t$", look)
