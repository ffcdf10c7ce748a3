"""Bodies of revolution: energies at rest, in tubes, through a throat, relaxing, and in axial extension."""

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
THROAT = "-tube_radius 1.5 -tube_throat 0.95 -tube_throat_mouth 1.5"
RELAXING = {0.02: 1.46775, 0.1: 1.428729, 0.5: 1.391079}
"""Energies over 8 pi kappa by time of a relaxing prolate spheroid, v = 0.8, of another program; 3e-5 to 1e-6."""
RATES = (0, 1, 2, 3, 4, 5)
CRITICAL = 5.15
"""The rate above which a vesicle of v = 0.7 loses its symmetry (tests/physics/test_axisymmetric.py)."""


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


def passing() -> Case:
    """Return a vesicle that passes a throat: meridians on its way."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        run = Run.read(folder)
        shapes = [smooth_surfaces(run, frame)[0][:2] for frame in range(0, len(run.time), 2)]
        return {
            "x": [x[:, 0].tolist() for x, _ in shapes],
            "y": [y[:, 0].tolist() for _, y in shapes],
        }

    flow = "-flow_type tube -flow_peak_velocity 2 -time_steady_tol 0 -output_every 0.4"
    start = "-vesicle_center -4,0,0 -time_step 0.01 -time_end 5"
    return case("throat", "revolved", f"{flow} {THROAT} {start}", measure)


def relaxing() -> Case:
    """Return a stretched vesicle on its way to rest: its energy over 8 pi kappa in time."""

    def measure(series: Series, _) -> dict[str, object]:
        return {"t": list(series["time"]), "energy": [e / (8 * np.pi) for e in series["energy_bending"]]}

    return case("relaxing", "revolved", "-vesicle_reduced_volume 0.8 -time_step 0.0025 -time_end 0.5", measure)


def extended(rate: float) -> Case:
    """Return a vesicle of v = 0.7 in axial extension: its long half axis at rest."""

    def measure(series: Series, _) -> dict[str, object]:
        return {"half": series["axis_long"][-1]}

    flow = f"-flow_type axial -flow_rate {rate}" if rate else ""
    return case(f"extended_{rate}", "revolved", f"{flow} -vesicle_reduced_volume 0.7 -time_step 0.02", measure)


def draw_tube(panel, title: str, walls, shapes) -> None:
    """Draw the wall's radius (x, R) and meridians (x, y), both mirrored."""
    for x, y in shapes:
        panel.plot(np.r_[x, x[::-1]], np.r_[y, -np.array(y[::-1])], color="C3")
    for side in (-1, 1):
        panel.plot(walls[0], side * np.array(walls[1]), color="k")
    panel.set(aspect="equal", xticks=[], yticks=[], title=title, xlim=(walls[0][0], walls[0][-1]))


def fill(results: Results) -> Values:
    """Make the runs; draw energies and shapes; return the values."""
    rest = {(s, v): results.get(resting(s, v)) for s in EXACT for v in VOLUMES[s]}
    tubes = {name: results.get(driven(name)) for name in TUBES}
    throat, relaxed = results.get(passing()), results.get(relaxing())
    lengths = [results.get(extended(rate)) for rate in RATES]
    figure, (panel, *shapes, energy, length, way) = new_figure(10, 6, rows=2, columns=3)
    for shape, marker in (("prolate", "-"), ("oblate", "--")):
        panel.plot(VOLUMES[shape], [rest[shape, v]["energy"] for v in VOLUMES[shape]], marker, label=shape)
        panel.plot(list(EXACT[shape]), list(EXACT[shape].values()), "k+", label=None)
    panel.set(xlabel="reduced volume", ylabel="energy / 8 $\\pi\\kappa$")
    panel.legend(frameon=False)
    for where, (name, found) in zip(shapes, tubes.items()):
        radius = float(driven(name).options["-tube_radius"])
        draw_tube(where, name, ([-2.2, 2.2], [radius, radius]), [(found["x"], found["y"])])
    energy.plot(relaxed["t"], relaxed["energy"])
    energy.plot(list(RELAXING), list(RELAXING.values()), "k+")
    energy.set(xlabel="time", ylabel="energy / 8 $\\pi\\kappa$", title="relaxation, v = 0.8")
    length.plot(RATES, [found["half"] for found in lengths], "o-")
    length.axvline(CRITICAL, color="k", linestyle=":")
    length.set(xlabel="rate of extension", ylabel="long half axis", title="extension, v = 0.7")
    wide, narrow, mouth = (float(passing().options[f"-tube_{name}"]) for name in ("radius", "throat", "throat_mouth"))
    x = np.linspace(-5.5, 6, 200)
    wall = wide - (wide - narrow) * (1 + np.cos(np.pi * np.minimum(np.abs(x) / mouth, 1))) / 2
    draw_tube(way, "through a throat", (x, wall), zip(throat["x"], throat["y"]))
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
        "seconds": seconds(*rest.values(), *tubes.values(), throat, relaxed, *lengths),
    }


SCENE = Scene("revolved", fill)
