"""A red-cell-like biconcave cell in capillaries: parachutes and slippers over strength of the flow and width."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from petves.run import Run
from petves.views.figures import new_figure, save_figure
from studies.common.curves import about_centroid, trigonometric
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, seconds

STRENGTHS = (2, 10, 20, 40)
HEIGHTS = {3.0: 18, 10 / 3: 20, 5.0: 30}
"""Height of the channel over R0, and its cells."""
ALONG = tuple(product((5, 10, 15, 20), {2.5: 15, 3.0: 18, 10 / 3: 20}.items()))
"""Strength, height and cells of the runs whose cell starts along the flow."""


def capillary(strength: float, height: float) -> Case:
    """Return a cell: height of its centre, asymmetry and lag at the end, how the height still swings, its outline."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        late = series["time"] > 0.75 * series["time"][-1]
        outline = trigonometric(Run.read(folder).markers[-1], 64)
        peak = strength * 0.1
        return {
            "height": series["center_y"][-1],
            "swing": np.ptp(series["center_y"][late]),
            "lag": 1 - series["velocity_x"][-1] / peak,
            "asymmetry": asymmetry(outline),
            "outline": np.round(about_centroid(outline), 3).ravel().tolist(),
        }

    half = height / 2
    options = f"-flow_ca {strength} -flow_half_width {half!r} -domain_box 0,8,{-half!r},{half!r}"
    name = f"{strength}_{height:.3g}"
    return case(name, "capillary", f"{options} -domain_cells 48,{HEIGHTS[height]}", measure, may_fail=True)


def along(strength: float, height: float, cells: int) -> Case:
    """Return an ellipse that starts along the flow: the last turns of its centre's height, and their times."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        turns = turning_points(series["time"], series["center_y"])[-4:]
        return {"height": series["center_y"][-1], "turns": np.round(turns, 4).tolist()}

    half = height / 2
    options = (
        f"-flow_ca {strength} -flow_half_width {half!r} -domain_box 0,8,{-half!r},{half!r} -domain_cells 48,{cells}"
    )
    start = "-vesicle_shape ellipse -vesicle_angle 0 -vesicle_center 2,.2 -time_end 400"
    return case(f"along_{strength}_{height:.3g}", "capillary", f"{options} {start}", measure)


def turning_points(time: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Return time and height where a height turns round by more than a hundredth: array (n, 2)."""
    inner = np.flatnonzero(np.diff(height)[1:] * np.diff(height)[:-1] < 0) + 1
    kept = [k for k in inner if abs(height[k]) > 0.01]
    return np.column_stack([time[kept], height[kept]])


def swing(found: dict, peak: float) -> str:
    """Return what a cell that started along the flow does: amplitude over R0 and period times peak over R0 of the last swing, or its height."""
    time, height = np.array(found["turns"]).reshape(-1, 2).T
    if len(height) < 3 or np.any(height[1:] * height[:-1] > 0):
        return f"settled, {found['height']:+.2f}"
    return f"snaking, {np.abs(height[-2:]).mean():.3f}, {2 * (time[-1] - time[-2]) * peak:.0f}"


def asymmetry(outline: np.ndarray) -> float:
    """Return the largest distance of the outline mirrored in the axis through its centroid from the outline, R0 = 1."""
    place = about_centroid(outline) @ [1, 1j]
    return float(np.abs(place.conj()[:, None] - place[None, :]).min(axis=1).max())


def shape(found: dict) -> str:
    """Return what it is: a parachute is its own mirror image in the middle of the channel."""
    if "failed" in found:
        return "stopped"
    if found["asymmetry"] < 0.1 and abs(found["height"]) < 0.05:
        return "parachute"
    return "slipper" if found["swing"] < 0.05 else "moving"


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    runs = {key: results.get(capillary(*key)) for key in product(STRENGTHS, HEIGHTS)}
    figure, panels = new_figure(8, 9.8, columns=len(HEIGHTS), rows=len(STRENGTHS), equal=True)
    for panel, ((strength, height), one) in zip(panels, runs.items()):
        if "failed" not in one:
            x, y = np.array(one["outline"]).reshape(-1, 2).T
            panel.fill(x, y + one["height"], fc="#d98880", ec="black", lw=1)
        for wall in (-height / 2, height / 2):
            panel.axhline(wall, color="black", lw=1.5)
        panel.axhline(0, color="black", lw=0.4, ls=":")
        panel.set(xlim=(-2, 2), ylim=(-2.6, 2.6), aspect="equal", xticks=[], yticks=[])
        panel.set_title(f"Ca = {strength:g}, height {height:.3g}", fontsize=8)
    save_figure(figure, results.path.parent / "capillary.png")
    rows = []
    for strength in STRENGTHS:
        ones = [runs[strength, height] for height in HEIGHTS]
        cells = [
            f"{shape(one)}, {one['height']:+.2f}, {one['lag']:.3f}" if "failed" not in one else "stopped"
            for one in ones
        ]
        rows.append([strength, *cells])
    snakes = {(key[0], key[1][0]): results.get(along(key[0], *key[1])) for key in ALONG}
    snaking = []
    for strength in sorted({key[0] for key in snakes}):
        cells = [swing(one, strength * 0.1) for (other, _), one in snakes.items() if other == strength]
        snaking.append([strength, *cells])
    return {
        "capillaries": [["Ca", *(f"height {height:.3g}" for height in HEIGHTS)], *rows],
        "snaking": [["Ca", *dict.fromkeys(f"height {height:.3g}" for _, height in snakes)], *snaking],
        "seconds": seconds(*runs.values(), *snakes.values()),
    }


SCENE = Scene("capillary", fill)
