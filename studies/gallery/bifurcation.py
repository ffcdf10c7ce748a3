"""A channel that an island divides: how the flux splits, and which way vesicles go."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from petves.run import Run
from petves.views.figures import new_figure, save_figure
from studies.common.curves import trigonometric
from studies.common.engine import Case, Results, Series
from studies.gallery.scene import Scene, Values, case, seconds

LOW, HIGH, MIDDLE, RADIUS = 0.3, 0.5, 2.25, 0.1
"""Heights of the branches: the island lies from y = .3 to y = .5; where its middle is, half its height."""
CUBE = (LOW / HIGH) ** 3
"""Flux of the lower branch over that of the upper one, of long branches: parallel plates."""
LENGTHS = (1.0, 1.5, 2.0, 2.5)
BISECTIONS, ENTER = 5, (0.2, 0.36)


def island(length: float) -> np.ndarray:
    """Return the island's curve, counter-clockwise, shape (n, 2); the file runs/gallery/island.txt has that of length 2."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 13)
    half, centre = length / 2 - RADIUS, LOW + RADIUS
    right = np.column_stack([MIDDLE + half + RADIUS * np.cos(angle), centre + RADIUS * np.sin(angle)])
    left = np.column_stack([MIDDLE - half - RADIUS * np.cos(angle), centre - RADIUS * np.sin(angle)])
    x = np.linspace(MIDDLE + half, MIDDLE - half, 40)[1:-1]
    top, bottom = (np.column_stack([x, np.full_like(x, centre + side)]) for side in (RADIUS, -RADIUS))
    return np.vstack([right, top, left, bottom[::-1]])


def with_island(one: Case, length: float) -> Case:
    """Return the case with an island of this length."""
    one.options["-obstacle_file"] = f"island of length {length:g}"
    one.files["-obstacle_file"] = "".join(f"{x:.9f} {y:.9f}\n" for x, y in island(length))
    return one


def split(length: float, cells: int = 32) -> Case:
    """Return the flow without vesicles past an island: fluxes of the lower and the upper branch in its middle."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        run = Run.read(folder)
        (x, y), (u, _, _) = run.cell_centers(), run.fields(-1)
        column = int(np.abs(x - MIDDLE).argmin())
        parts = [float(u[side, column].sum() * run.h) for side in (y < LOW + RADIUS, y > LOW + RADIUS)]
        return {"flux": parts}

    changes = f"-vesicle_shape none -allow_unused_options true -time_end 0.02 -domain_cells {4 * cells},{cells}"
    return with_island(case(f"split_{length:g}_{cells}", "bifurcation", changes, measure), length)


def vesicle(height: float) -> Case:
    """Return a vesicle that starts at this height: whether it goes below the island, where it is, its gap, outlines."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        run = Run.read(folder)
        at = float(np.interp(MIDDLE, series["center_x"], series["center_y"]))
        kept = [np.round(trigonometric(x, 48), 3).ravel().tolist() for x in run.markers[::5]]
        return {"below": at < LOW + RADIUS, "height": at, "gap": np.nanmin(series["gap"]), "outlines": kept}

    changes = f"-vesicle_center 0.25,{height:.6f} -time_end 3"
    return with_island(case(f"{height:.4f}", "bifurcation", changes, measure), 2.0)


def dividing_streamline(part: float) -> float:
    """Return the height below which this part of the flux of a parabola between 0 and 1 flows."""
    roots = np.roots([-2, 3, 0, -part])
    return float(min((root.real for root in roots if abs(root.imag) < 1e-9 and 0 < root.real < 1)))


def limit(ratio: dict[float, float]) -> float:
    """Return the ratio of long branches: ratio (length + b) = limit (length + a), by least squares."""
    lengths, values = np.array(list(ratio)), np.array(list(ratio.values()))
    matrix = np.column_stack([lengths, np.ones_like(lengths), -values])
    return float(np.linalg.lstsq(matrix, lengths * values, rcond=None)[0][0])


def dividing_height(results: Results) -> tuple[float, list[dict]]:
    """Return the start height that parts vesicles which go below from those that go above, and their runs."""
    low, high, runs = *ENTER, []
    for height in ENTER:
        runs.append(results.get(vesicle(height)))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        runs.append(results.get(vesicle(middle)))
        low, high = (middle, high) if runs[-1]["below"] else (low, middle)
    return 0.5 * (low + high), runs


def fill(results: Results) -> Values:
    """Make the runs; return the values."""
    found = {length: results.get(split(length)) for length in LENGTHS}
    ratio = {length: one["flux"][0] / one["flux"][1] for length, one in found.items()}
    height, runs = dividing_height(results)
    _picture(results.path.parent / "bifurcation.png", runs[:2])
    return {
        "split_ratio": f"{ratio[2.0]:.3f}",
        "split_limit": f"{limit(ratio):.3f}",
        "split_cube": f"{CUBE:.3f}",
        "dividing_fluid": f"{dividing_streamline(found[2.0]['flux'][0]):.3f}",
        "dividing_vesicle": f"{height:.3f}",
        "seconds": seconds(*found.values(), *runs),
    }


def _picture(path: Path, runs: list[dict]) -> None:
    """Draw both vesicles' outlines at some times."""
    figure, panels = new_figure(12, 6.2, rows=2, equal=True)
    for panel, one in zip(panels, runs):
        panel.fill(*island(2.0).T, fc="#9a9a9a", ec="black", lw=0.8)
        for flat in one["outlines"]:
            panel.fill(*np.array(flat).reshape(-1, 2).T, fc="#d98880", ec="black", lw=0.8)
        panel.set(xlim=(0, 4), ylim=(0, 1), aspect="equal", xticks=[], yticks=[])
    save_figure(figure, path)


SCENE = Scene("bifurcation", fill)
