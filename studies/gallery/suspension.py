"""A suspension of 256 vesicles in a sheared channel: effective viscosity, cell-free layer, profile."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.rheology import area_fraction_profile, velocity_profile
from petves.run import Run
from petves.views.figures import new_figure, save_figure
from petves.views.plot import dress
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, moments, seconds, with_pictures

BOXES = {0.2: ("0,100,0,32", "400,128"), 0.4: ("0,50,0,32", "200,128")}
"""Box and cells by area fraction: as high, half as long."""
SEEDS = (1, 2)
"""Places at the start; what is told is the mean over them, and how far they are apart."""
ALONE = "-allow_unused_options true -domain_box 0,32,0,32 -domain_cells 128,128 -vesicle_packing_type lattice -vesicle_angle 22 -vesicle_count 1"


def suspension(fraction: float, seed: int, pictures: Path | None = None) -> Case:
    """Return 256 vesicles: viscosity over the last fifth, distance from a wall to the first vesicle, profiles at the end."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        if pictures:
            moments(folder, pictures / "suspension.png", (series["time"][-1],), (0, 50, 0, 32))
        run = Run.read(folder)
        end = series["time"][-1]
        y, u = velocity_profile(run, -1)
        layers, part = area_fraction_profile(run, -1, 32)
        heights = run.markers[-1, :, 1]
        return {
            "viscosity": series["viscosity"][series["time"] > 0.8 * end].mean(),
            "layer": min(heights.min() - run.box[2], run.box[3] - heights.max()),
            "gap": np.nanmin(series["gap"]),
            "strain": end,
            "profile": [np.round(u, 4).tolist()[::4], np.round(part, 4).tolist()],
            "wall_rate": float((u[1] - u[0]) / (y[1] - y[0])),
        }

    box, cells = BOXES[fraction]
    options = f"-domain_box {box} -domain_cells {cells} -vesicle_packing {fraction} -vesicle_packing_seed {seed}"
    return case(f"{fraction}_{seed}", "suspension", options, measure)


def alone() -> Case:
    """Return one vesicle in a channel as high: what it adds to the viscosity over its fraction."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        fraction = series["area"][-1] / 32**2
        return {"intrinsic": (series["viscosity"][-1] - 1) / fraction}

    return case("alone", "suspension", f"{ALONE} -vesicle_packing 0.0024543693 -time_end 20", measure)


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    one, home = results.get(alone()), results.path.parent
    runs = {(fraction, seed): results.get(suspension(fraction, seed)) for fraction in BOXES for seed in SEEDS[1:]}
    runs[0.2, SEEDS[0]] = results.get(suspension(0.2, SEEDS[0]))
    runs[0.4, SEEDS[0]] = with_pictures(results, suspension(0.4, SEEDS[0], home), "suspension.png")
    draw_profiles(runs, home / "suspension_profile.png")
    rows = [row(fraction, [runs[fraction, seed] for seed in SEEDS], one["intrinsic"]) for fraction in BOXES]
    strain = f"viscosity at a strain of {min(found['strain'] for found in runs.values()):g}"
    return {
        "suspensions": [["fraction", strain, "dilute", "layer at a wall", "rate at a wall", "least gap"], *rows],
        "seconds": seconds(one, *runs.values()),
    }


def row(fraction: float, found: list[dict], intrinsic: float) -> list[object]:
    """Return a row of the table: means over the seeds, half the seeds' range behind the viscosity at the end."""
    late, layer, rate = (np.mean([one[name] for one in found]) for name in ("viscosity", "layer", "wall_rate"))
    apart = np.ptp([one["viscosity"] for one in found]) / 2
    gap = min(one["gap"] for one in found)
    dilute = f"{1 + intrinsic * fraction:.3f}"
    return [fraction, f"{late:.3f} +- {apart:.3f}", dilute, f"{layer:.2f}", f"{rate:.2f}", f"{gap:.3f}"]


def draw_profiles(runs: dict[tuple[float, int], dict], path: Path) -> None:
    """Draw velocity and area fraction across the channel at the end, means over the seeds."""
    figure, (left, right) = new_figure(12, 4.6, columns=2)
    for fraction in BOXES:
        velocity, part = (np.mean([runs[fraction, seed]["profile"][k] for seed in SEEDS], axis=0) for k in (0, 1))
        heights = (np.arange(len(velocity)) + 0.125) * 32 / len(velocity)
        left.plot(velocity - (heights - 16), heights, lw=1.2, label=f"{100 * fraction:.0f} %")
        right.plot(part, (np.arange(len(part)) + 0.5) * 32 / len(part), lw=1.2, label=f"{100 * fraction:.0f} %")
    dress(left, grid="both", xlabel="u - rate (y - 16)", ylabel="y over R0")
    dress(right, grid="both", xlabel="area fraction", ylabel="y over R0")
    left.legend(frameon=False, fontsize=8)
    save_figure(figure, path)


SCENE = Scene("suspension", fill, long=True)
