"""-scheme_auto on scenes that its calibration has not seen: drawn from a seed, each against a far finer run."""

from __future__ import annotations

import re
import tempfile
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from petves.program import launch
from petves.run import Run
from studies.common.tables import write_csv
from studies.common.curves import material_distance
from studies.common.engine import Case, Results, Series
from studies.common.scenes import words

SEED = 22
WANTED = {0.01: 36, 0.001: 12}
"""Relative errors asked for, and how many of the scenes."""
QUASI_STEADY = 24
"""The scenes after so many have inertia, unsteady and convective in turn, and the program's grid."""
BOXES = {
    "free": (8, 8, "-domain_bc_x free -domain_bc_y free"),
    "channel": (10, 5, "-domain_bc_x periodic"),
    "box": (5, 5, ""),
    "pipe": (10, 4, "-domain_bc_x periodic"),
    "press": (8, 8, ""),
}
"""Length and height in R0, and boundaries: shear, but for the pipe, a parabola, and the press, extension."""


FINE = words(
    "-vesicle_allow_close_markers true -scheme_order 3 -time_adapt error -time_adapt_tol 3e-6 -time_step 0.01 "
    "-coupled_ksp_rtol 1e-8"
)
"""Of the runs that stand for the truth."""
FINE_INERTIA_CELLS, FINE_INERTIA_TOLERANCE = 24, "1e-4"
"""The same with inertia: cells a R0, markers 1.5 h apart."""


@lru_cache(maxsize=1000)
def _ellipse(reduced_area: float) -> np.ndarray:
    """Return points of the ellipse with R0 = 1 about the origin, along x."""
    t = 2 * np.pi * np.arange(2000) / 2000
    low, high = 0.02, 1.0
    for _ in range(60):
        ratio = (low + high) / 2
        points = np.stack([np.cos(t), ratio * np.sin(t)], axis=1)
        length = np.hypot(*(points - np.roll(points, 1, axis=0)).T).sum()
        low, high = (ratio, high) if 4 * np.pi * np.pi * ratio / length**2 < reduced_area else (low, ratio)
    return points * (2 * np.pi / length)


@lru_cache(maxsize=100)
def _side_by_side(outline: tuple[complex, ...], up: float, gap: float) -> float:
    """Return how far along x a second outline, lower by `up`, lies from the first for the gap: their facing halves."""
    points = np.array(outline)
    apart = points[points.real >= 0][:, None] - points[points.real <= 0]
    along, across = apart.real.copy(), (apart.imag + up) ** 2
    low, high = 0.0, 6.0
    for _ in range(40):
        x = (low + high) / 2
        inside = x * x + up * up < 0.2 or ((along - x) ** 2 + across).min() < gap**2
        low, high = (x, high) if inside else (low, x)
    return x


@dataclass
class Scene:
    """A scene in units of R0 and the flow's rate: one ellipse, or two beside one another."""

    place: str
    count: int
    reduced_area: float
    chi: float
    angle: float  # degrees; negative: the flow compresses the vesicle
    gap: float  # between the two vesicles, or below the one (R0)
    cells: int  # a R0; 0: the program's choice
    ratio: float = 1  # viscosity inside over outside
    inertia: str = "none"

    def ellipse(self) -> np.ndarray:
        """Return points of the ellipse about the origin, turned."""
        turn = np.deg2rad(self.angle)
        matrix = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        return _ellipse(self.reduced_area) @ matrix

    def centers(self) -> list[float]:
        """Return where the vesicles are for the gap wanted."""
        points = self.ellipse()
        if self.count == 1:
            below = -BOXES[self.place][1] / 2 + self.gap - points[:, 1].min()
            return [0.0, float(below) if self.near_wall() else 0.0]
        up = 0.4 if self.place != "press" else 0.0
        x = _side_by_side(tuple(points @ (1, 1j)), up, self.gap)
        return [-x / 2, up / 2, x / 2, -up / 2]

    def options(self) -> dict[str, str]:
        """Return the scene's options, without those of accuracy."""
        length, height, walls = BOXES[self.place]
        flow = "-flow_type shear -flow_rate 1"
        if self.place == "pipe":  # its rate at the wall is 1
            flow = f"-flow_type poiseuille -flow_half_width {height / 2} -flow_peak_velocity {height / 4}"
        if self.place == "press":  # together
            flow = "-flow_type extension -flow_rate -1"
        text = f"-domain_box {-length / 2},{length / 2},{-height / 2},{height / 2} {walls} {flow} "
        text += f"-fluid_inertia {self.inertia} -vesicle_area {np.pi * self.reduced_area!r} -vesicle_reduced_area {self.reduced_area} "
        text += f"-vesicle_angle {self.angle} -vesicle_bending {1 / self.chi!r} -vesicle_count {self.count} "
        text += f"-vesicle_viscosity_ratio {self.ratio:g} "
        text += f"-vesicle_center {','.join(f'{x:.6f}' for x in self.centers())} -time_end {3 if self.place == 'press' else 6} "
        text += "-output_every 1000 -checkpoint_every 0"
        return words(text)

    def grid(self) -> dict[str, str]:
        """Return the option of the grid, none where the program chooses it."""
        length, height, _ = BOXES[self.place]
        return words(f"-domain_cells {length * self.cells},{height * self.cells}") if self.cells else {}

    def near_wall(self) -> bool:
        """Return whether the gap is to a wall."""
        return self.count == 1 and self.place in ("channel", "pipe")


def drawn(number: int) -> Scene:
    """Return the scene of a number: place and count in turn, the rest at random; two grids of four are the program's."""
    random = np.random.default_rng([SEED, number])
    inertia = number >= QUASI_STEADY
    place = list(BOXES)[1 + number // 2 % 4 if inertia else number % 5]
    gap = 10 ** random.uniform(-1, 0)
    scene = Scene(
        place=place,
        count={"press": 2, "box": 1}.get(place, 1 + number // 5 % 2),
        reduced_area=round(random.uniform(0.5, 0.95), 2),
        chi=float(f"{10 ** random.uniform(0, 2):.2g}"),
        angle=90 if place == "press" else round(random.uniform(-45, 80)),
        gap=float(f"{gap:.2g}"),
        cells=number % 4 // 2 * int(random.integers(3, 6)),
        ratio=float(f"{10 ** random.uniform(-0.7, 0.7):.2g}") if random.random() < 0.5 else 1.0,
    )
    if not inertia:
        return scene
    return replace(scene, cells=0, ratio=1.0, inertia="convective" if number % 2 else "unsteady")


def measure(series: Series, folder: Path) -> dict[str, object]:
    """Return a Measure: steps, bending energy, markers of each vesicle and the warnings."""
    run = Run.read(folder)
    outlines = [np.round(run.outline(-1, k)[:-1], 8).tolist() for k in range(len(run.start) - 1)]
    kept: dict[str, object] = {
        "steps": len(series["time"]) - 1,
        "energy": series["energy_bending"][-1],
        "markers": outlines,
    }
    return kept | {"warnings": run.summary["warnings"]}


def fine(number: int) -> Case:
    """Return the run that stands for the truth: a fine grid, twice the default's markers or more, small steps.

    It has half the cells' size or R0/8, and 2.4 cells to a wall that is near.
    """
    scene = drawn(number)
    if number >= QUASI_STEADY:
        options = scene.options() | replace(scene, cells=FINE_INERTIA_CELLS).grid() | FINE
        options |= {"-time_adapt_tol": FINE_INERTIA_TOLERANCE}
        options["-vesicle_markers"] = f"{int(2 * np.pi * FINE_INERTIA_CELLS / 1.5) | 1}"
        return Case(f"fine_{number}", options, measure)
    finer = max(8, 2 * scene.cells, int(np.ceil(2.4 / scene.gap)) if scene.near_wall() else 0)
    markers = 2 * int(45 * max(1, 0.6 / scene.reduced_area) * (1.3 if scene.chi > 50 or scene.gap < 0.3 else 1)) + 1
    options = scene.options() | replace(scene, cells=finer).grid() | words(f"-vesicle_markers {markers}")
    return Case(f"fine_{number}", options | FINE, measure)


def auto(number: int, wanted: float) -> Case:
    """Return the run with -scheme_auto."""
    scene = drawn(number)
    return Case(
        f"auto_{number}_{wanted:g}", scene.options() | scene.grid() | words(f"-scheme_auto {wanted:g}"), measure
    )


def said(results: Results, number: int, wanted: float) -> dict[str, str]:
    """Return what -scheme_auto calls not enough (TOO COARSE, TOO NEAR, TOO THIN; empty where all is), and R0/h."""
    options = auto(number, wanted).options | {"-time_end": "0"}

    def listen() -> dict[str, object]:
        with tempfile.TemporaryDirectory() as folder:
            text = launch([word for pair in options.items() for word in pair] + ["-output_dir", folder], 1).stdout
        return {"said": " ".join(re.findall("TOO [A-Z]+", text)), "grid": re.search(r"R0/h = (\S+?),|$", text)[1] or ""}

    return results.derive(f"said_{number}_{wanted:g}", options, listen)


def apart(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Return the root mean square distance of equal material points."""
    if len(ours) != len(theirs):
        return material_distance(ours, theirs)
    return float(np.sqrt(((ours - theirs) ** 2).sum(axis=1).mean()))


def error(found: dict, exact: dict) -> float:
    """Return the worse of energy and markers, root mean square over R0 = 1."""
    distances = [apart(np.array(x), np.array(y)) for x, y in zip(found["markers"], exact["markers"])]
    return max(abs(found["energy"] / exact["energy"] - 1), *distances)


def write(folder: str | Path, quick: bool = False) -> list[Path]:
    """Run what is not there yet and write unseen.csv; quick: four scenes for .01."""
    folder = Path(folder)
    results = Results(folder / "unseen.json")
    rows = []
    for wanted, count in {0.01: 4}.items() if quick else WANTED.items():
        for number in range(count):
            scene, found = drawn(number), results.get(auto(number, wanted))
            row = {"wanted": wanted, "scene": number} | vars(scene)
            row |= {"error": f"{error(found, results.get(fine(number))):.2e}", "steps": found["steps"]}
            row |= {"markers": len(found["markers"][0]), "warnings": len(found["warnings"])}
            rows.append(row | said(results, number, wanted))
    return [write_csv(folder / "unseen.csv", list(rows[0]), [list(row.values()) for row in rows])]
