"""Bodies of revolution: energies at rest against the shape equations, a bullet and a parachute in a tube."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from petves.views.figures import new_figure, save_figure
from petves.views.surfaces import smooth_surfaces
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, seconds

EXACT = {
    "prolate": {0.95: 1.0955649, 0.9: 1.1896440, 0.8: 1.3874404, 0.7: 1.6432704, 0.65: 1.8279299},
    "oblate": {0.95: 1.1061146, 0.9: 1.2178603, 0.7: 1.6991111, 0.65: 1.8262335, 0.6: 1.9556806},
}
"""Energies over 8 pi kappa of the shape equations by reduced volume; 2e-7, the last one 1e-5."""
VOLUMES = {"prolate": (0.99, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65), "oblate": (0.99, 0.95, 0.9, 0.8, 0.7, 0.65, 0.6)}
TUBES = {
    "bullet": "-vesicle_bending 0.1 -tube_radius 1.3 -sphere_degree 16 -time_step 0.1 -time_end 20",
    "parachute": "-vesicle_bending 0.02 -tube_radius 1.8 -vesicle_reduced_volume 0.65 -vesicle_spheroid oblate "
    "-sphere_degree 20 -time_step 0.02 -time_end 12",
}


def resting(shape: str, volume: float) -> Case:
    """Return a vesicle that comes to rest: its energy over 8 pi kappa."""

    def measure(series: Series, _) -> dict[str, object]:
        return {"energy": series["energy_bending"][-1] / (8 * np.pi)}

    return case(f"{shape}_{volume}", "revolved", f"-vesicle_spheroid {shape} -vesicle_reduced_volume {volume}", measure)


def driven(name: str) -> Case:
    """Return a vesicle in a tube: its speed, and the meridian of its last shape."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        x, y, *_ = smooth_surfaces(Run.read(folder), -1)[0]
        middle = (x.max() + x.min()) / 2
        return {"speed": series["velocity_x"][-1], "x": (x[:, 0] - middle).tolist(), "y": y[:, 0].tolist()}

    flow = "-flow_type tube -flow_peak_velocity 2 -time_steady_tol 0 -output_every 100"
    return case(name, "revolved", f"{flow} {TUBES[name]}", measure)


def fill(results: Results) -> Values:
    """Make the runs; draw energies and shapes; return the values."""
    rest = {(s, v): results.get(resting(s, v)) for s in EXACT for v in VOLUMES[s]}
    tubes = {name: results.get(driven(name)) for name in TUBES}
    figure, (panel, *shapes) = new_figure(10, 3, columns=3)
    for shape, marker in (("prolate", "-"), ("oblate", "--")):
        panel.plot(VOLUMES[shape], [rest[shape, v]["energy"] for v in VOLUMES[shape]], marker, label=shape)
        panel.plot(list(EXACT[shape]), list(EXACT[shape].values()), "k+", label=None)
    panel.set(xlabel="reduced volume", ylabel="energy / 8 $\\pi\\kappa$")
    panel.legend(frameon=False)
    for where, (name, found) in zip(shapes, tubes.items()):
        radius = float(driven(name).options["-tube_radius"])
        x, y = np.array(found["x"]), np.array(found["y"])
        where.plot(np.r_[x, x[::-1]], np.r_[y, -y[::-1]], color="C3")
        for side in (-radius, radius):
            where.axhline(side, color="k")
        where.set(aspect="equal", xlim=(-2.2, 2.2), ylim=(-1.9, 1.9), xticks=[], yticks=[], title=name)
    save_figure(figure, results.path.parent / "revolved.png")
    rows = [
        [shape, v, f"{rest[shape, v]['energy']:.7f}", f"{energy:.7f}"]
        for shape, energies in EXACT.items()
        for v, energy in energies.items()
    ]
    return {
        "energies": [["branch", "v", "petves", "shape equations"], *rows],
        "bullet": f"{tubes['bullet']['speed']:.4f}",
        "parachute": f"{tubes['parachute']['speed']:.4f}",
        "seconds": seconds(*rest.values(), *tubes.values()),
    }


SCENE = Scene("revolved", fill)
