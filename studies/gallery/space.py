"""Three dimensions: tank-treading in shear against an independent calculation, and tumbling."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from petves.measures import half_periods
from petves.run import Run, SurfaceRun
from petves.views.field import TENSION
from petves.views.figures import Look, add_bar, blank_figure, save_figure
from petves.views.surfaces import LIGHT, plot_surfaces, smooth_surfaces
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, seconds, with_pictures

STEADY = {(0.99, 0.1): 39.188 / 180, (0.95, 0.1): 0.180015, (0.9, 0.1): 0.153393, (0.9, 1.0): 0.153306}
"""Angles over pi by reduced volume and bending, of an independent calculation; 2e-6, the first one 1e-5."""
SHOWN = (0.9, 0.1)
TUMBLING = "-vesicle_viscosity_ratio 10 -vesicle_axis 1,0,0 -time_adapt_tol 1e-4 -time_end 24 -output_every 1"
TIMES = (12, 15, 17, 18, 19, 22)
"""Half a turn of it, about the time at which its long axis stands across the flow."""


def strip(run: SurfaceRun, path: Path) -> None:
    """Draw a run seen along z at some times, side by side, coloured by tension."""
    frames = [run.frame_at(time) for time in TIMES]
    figure = blank_figure(2 * len(frames), 2.5)
    colours = ScalarMappable(Normalize(*run.tension_range(frames)), matplotlib.colormaps["viridis"])
    reach = np.abs(run.points[frames][..., :3]).max()
    for k, frame in enumerate(frames):
        place = (k / len(frames), 0.24, 1 / len(frames), 0.72)
        panel = figure.add_axes(place, projection="3d", proj_type="ortho")
        x, y, z, tension = smooth_surfaces(run, frame)[0]
        shown = dict(rstride=1, cstride=1, linewidth=0.5, lightsource=LIGHT)
        panel.plot_surface(x, y, z, facecolors=colours.to_rgba(tension), **shown)
        panel.set(**{f"{c}lim": (-reach, reach) for c in "xyz"})
        panel.set_box_aspect((1, 1, 1), zoom=1.55)
        panel.view_init(90, -90)
        panel.set_axis_off()
        panel.set_title(f"$t$ = {run.time[frame]:g}", fontsize=9, y=0.94)
    add_bar(figure.add_axes((0.3, 0.2, 0.4, 0.05)), colours, TENSION)
    save_figure(figure, path, Look(dpi=90))


def treading(volume: float, bending: float, pictures: Path | None = None) -> Case:
    """Return a vesicle that tank-treads: its last angle over pi."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            save_figure(plot_surfaces(Run.read(folder)), pictures / "space.png", Look(dpi=90))
        return {"angle": series["inclination"][-1] / np.pi}

    changes = f"-vesicle_reduced_volume {volume} -vesicle_bending {bending}"
    return case(f"{volume}_{bending}", "space", changes, measure)


def tumbling(pictures: Path) -> Case:
    """Return a vesicle ten times as viscous inside: its half periods."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        strip(Run.read(folder), pictures / "space_tumbling.png")
        return {"half": half_periods(series["time"], series["inclination"]).tolist()}

    return case("tumbling", "space", TUMBLING, measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    folder = results.path.parent
    made = {key: results.get(treading(*key)) for key in STEADY if key != SHOWN}
    made[SHOWN] = with_pictures(results, treading(*SHOWN, folder), "space.png")
    turning = with_pictures(results, tumbling(folder), "space_tumbling.png")
    rows = [
        [v, f"{1 / bending:g}", f"{made[v, bending]['angle']:.6f}", f"{STEADY[v, bending]:.6f}"]
        for v, bending in STEADY
    ]
    return {
        "space_angles": [["v", "chi", "petves", "independent"], *rows],
        "space_half": f"{turning['half'][-1]:.2f}",
        "seconds": seconds(turning, *made.values()),
    }


SCENE = Scene("space", fill)
