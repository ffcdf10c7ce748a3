"""The runs behind the work-precision diagrams: scenes, schemes, points, and the errors that are kept of each."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

import numpy as np

from petves.run import Run
from studies.common.curves import material_distance, outline_distance, radius
from studies.common.engine import Case, Series
from studies.common.paper import shear_errors
from studies.common.scenes import CHANNEL_V, LAST_ONLY, PAPER_MEMBRANE, PEAK, cells, ellipse, fine_options, option_file
from studies.common.scenes import tank_treading, words

LIMITS = words("-limit_edge_ratio 5 -limit_area_error 0.2 -limit_length_error 0.2")  # the program's own
FIRST_ORDER, SECOND_ORDER = (words(f"-scheme_type coupled -scheme_order {order}") for order in (1, 2))
SCHEMES = {
    "penalty": words("-scheme_type penalty"),
    "split": words("-scheme_type split"),
    "coupled 1, uncorrected": FIRST_ORDER | PAPER_MEMBRANE,
    "coupled 2, uncorrected": SECOND_ORDER | PAPER_MEMBRANE,
    "coupled 2, exact": SECOND_ORDER,
    "coupled 3, exact": words("-scheme_type coupled"),
}
BEST, DEFAULT = tuple(SCHEMES)[4:]
EXACT = (BEST, DEFAULT)
"""Those with the exact near field, among which settings are recommended."""
FIRST = tuple(SCHEMES)[:2]  # those of the paper and before, whose points are chosen by dt/h
ERRORS = tuple("largest shape energy angle frequency velocity place gap viscosity force area length".split())
KEPT = ("steps", "solves", "step_seconds")
ADAPTIVE_STEPS = 60  # for the estimate of work


@dataclass(frozen=True)
class Point:
    """One point: a scheme on one grid with one step, or one tolerance of the step's control; the other is 0."""

    scheme: str  # key of SCHEMES
    cells: int  # of the scene's measure: across the box, or a unit of length (channel); free: markers
    dt: float = 0.0
    tolerance: float = 0.0  # -time_adapt_tol

    def step(self) -> dict[str, str]:
        """Return the options of the step."""
        if self.tolerance:
            return words(f"-time_step 0.02 -time_adapt error -time_adapt_tol {self.tolerance!r}")
        return {"-time_step": repr(self.dt)}

    def label(self) -> str:
        """Return a name for the file of results."""
        step = f"tol_{self.tolerance:g}" if self.tolerance else f"dt_{self.dt:g}"
        return f"{self.scheme.replace(', ', '_').replace(' ', '_')}_{self.cells}_{step}"


@dataclass(frozen=True)
class Scene:
    """A scene of the chart."""

    name: str  # in the files
    title: str
    options: Callable[[Point], dict[str, str]]  # of the run of a point but those of the scheme and the step
    width: float  # h times Point.cells
    time_end: float
    errors: Callable[[dict, dict], dict[str, float]]  # by name, from the measures of a run and of the reference
    wanted: tuple[str, ...]  # the errors drawn, which a recommendation must keep
    points: tuple[Point, ...]
    reference: dict[str, str] = field(default_factory=dict)  # the fine run; empty: errors against boundary integrals
    other: dict[str, str] = field(default_factory=dict)  # changed in another, which shows how far that has converged
    quick: dict[str, str] = field(default_factory=dict)  # changed in the reference of a quick call
    more: Callable[[Series], dict[str, object]] = lambda series: {}  # what the errors need besides `_measure`

    def measure(self, series: Series, folder: Path) -> dict[str, object]:
        """Return what the errors of the scene need of a run."""
        return _measure(series, folder) | self.more(series)

    def case(self, point: Point, repeat: int, fine: dict) -> Case:
        """Return the run of a point; fine: the measures of the reference."""

        def measure(series: Series, folder: Path) -> dict[str, object]:
            found = self.measure(series, folder)
            return {key: found[key] for key in KEPT} | {"errors": self.errors(found, fine)}

        options = self.options(point) | LAST_ONLY | LIMITS | SCHEMES[point.scheme] | point.step()
        return Case(f"{self.name}_{point.label()}_{repeat}", options, measure, may_fail=True)

    def largest(self, errors: dict[str, float]) -> float:
        """Return the largest of the wanted errors."""
        return max(errors[name] for name in self.wanted)

    def fine(self, other: bool = False) -> Case:
        """Return the reference run, or the other fine one."""
        options = self.reference | (self.other if other else {}) | LAST_ONLY
        return Case(f"{self.name}_{'other' if other else 'reference'}", options, self.measure)

    def work(self, point: Point) -> float:
        """Return an estimate of the work of a point: cells times steps."""
        steps = self.time_end / point.dt if point.dt else ADAPTIVE_STEPS * (1e-3 / point.tolerance) ** 0.5
        return point.cells**2 * steps


def _measure(series: Series, folder: Path) -> dict[str, object]:
    """Return what the errors of most scenes need of a run."""
    run = Run.read(folder)
    return {
        "steps": len(series["time"]) - 1,
        "solves": float(series["nsolve"].sum()),
        "step_seconds": float(series["wall"].sum()),
        "energy": series["energy_bending"][-1],
        "angle": series["inclination"][-1] / np.pi,
        "frequency": series["frequency"][-1],
        "area": abs(series["area_error"][-1]),
        "length": abs(series["length_error"][-1]),
        "radius": series["length"][0] / (2 * np.pi * run.vesicles),
        "outlines": [np.round(run.outline(-1, k)[:-1], 10).tolist() for k in range(run.vesicles)],
    }


def shape_error(found: dict, fine: dict) -> float:
    """Return the root mean square distance over R0 of all markers from a fine run's, at equal material points."""
    apart = [material_distance(np.array(a), np.array(b)) for a, b in zip(found["outlines"], fine["outlines"])]
    return float(np.mean(np.square(apart)) ** 0.5 / fine["radius"])


def drift(found: dict) -> dict[str, float]:
    """Return the errors of area and length."""
    return {key: found[key] for key in ("area", "length")}


def _relax_errors(found: dict, fine: dict) -> dict[str, float]:
    return {"shape": shape_error(found, fine), "energy": abs(found["energy"] / fine["energy"] - 1)} | drift(found)


def _shear_errors(found: dict, fine: dict) -> dict[str, float]:
    errors = map(abs, shear_errors(found["angle"], found["frequency"], 0.7, 10))
    return dict(zip(("angle", "frequency"), errors)) | drift(found)


def _channel_errors(found: dict, fine: dict) -> dict[str, float]:
    shape = outline_distance(*(np.array(one["outlines"][0]) for one in (found, fine))) / fine["radius"]
    return {"velocity": abs(found["rise"] / fine["rise"] - 1), "shape": shape} | drift(found)


def relax_options(point: Point) -> dict[str, str]:
    """Return section 5.2's ellipse; split and penalty with the paper's 1/h markers."""
    options = ellipse("relax", 1, point.cells // 2, 1) | cells(point.cells)
    for name in ("-scheme_type", "-scheme_order", *(() if point.scheme in FIRST else ("-vesicle_markers",))):
        del options[name]
    return options | {"-fluid_inertia": "unsteady"}


def channel_options(point: Point) -> dict[str, str]:
    """Return section 5.5's vesicle, c_0 = R0, in a window of 12."""
    options = words(f"-fluid_inertia unsteady -vesicle_center 6,{3 + radius(CHANNEL_V)!r}")
    return option_file("poiseuille") | options | cells(12 * point.cells, 6 * point.cells) | {"-time_end": "24"}


def grid(scheme: str, cells: tuple[int, ...], dts: tuple[float, ...] = (), tolerances: tuple[float, ...] = ()) -> list:
    """Return the points of a scheme on some grids with some steps, or some tolerances."""
    fixed = [Point(scheme, n, dt=dt) for n in cells for dt in dts]
    return fixed + [Point(scheme, n, tolerance=tolerance) for n in cells for tolerance in tolerances]


def over_h(scheme: str, width: float, cells: tuple[int, ...], parts: tuple[float, ...]) -> list[Point]:
    """Return points with dt = h/part for each part."""
    return [Point(scheme, n, dt=width / n / part) for n in cells for part in parts]


def _relax_points() -> list[Point]:
    points = over_h("penalty", 2, (64, 128), (2, 8, 32, 128)) + over_h("penalty", 2, (256,), (8, 32))
    points += over_h("split", 2, (64, 128), (2, 8, 32)) + over_h("split", 2, (256,), (2, 8))
    points += over_h("split", 2, (512,), (2,))
    points += grid("coupled 1, uncorrected", (32, 64, 128, 256), dts=(1 / 16, 1 / 64, 1 / 256))
    points += grid("coupled 2, uncorrected", (32, 64, 128, 256), tolerances=(1e-2, 1e-3, 1e-4))
    points += grid(BEST, (16, 24, 32, 48, 64), tolerances=(1e-2, 1e-3, 1e-4))
    points += grid(DEFAULT, (16, 24, 32, 48, 64, 128, 256), tolerances=(1e-2, 1e-3, 1e-4))
    return points + grid(DEFAULT, (32, 48, 64), tolerances=(1e-5,))


def _shear_points() -> list[Point]:
    points = over_h("penalty", 8, (64, 128), (8, 32, 128))
    points += over_h("split", 8, (64, 128), (2, 8, 32)) + over_h("split", 8, (256,), (2, 8))
    for name in ("coupled 1, uncorrected", "coupled 2, uncorrected"):
        points += grid(name, (48, 64, 128), dts=(0.1, 0.05, 0.0125)) + grid(name, (256,), dts=(0.05,))
    points += grid(BEST, (24, 32, 64, 128), dts=(0.1, 0.05, 0.025))
    return points + grid(DEFAULT, (16, 24, 32, 48, 64, 96, 128, 192, 256), dts=(0.2, 0.1, 0.05))


def _channel_points() -> list[Point]:
    points = over_h("penalty", 1 / PEAK, (8, 16), (2, 8, 32))
    points += over_h("split", 1 / PEAK, (8, 16), (2, 8, 32)) + over_h("split", 1 / PEAK, (32,), (2,))
    for name in ("coupled 1, uncorrected", "coupled 2, uncorrected"):
        points += grid(name, (8, 16), dts=(0.12, 0.03, 0.0075)) + grid(name, (32,), dts=(0.03,))
    points += grid(BEST, (5, 8, 12), dts=(0.12, 0.06, 0.03))
    return points + grid(DEFAULT, (3, 4, 5, 6, 8, 12, 16), dts=(0.12, 0.06, 0.03))


# fmt: off
SCENES = (
    Scene("relax", "relaxing ellipse, section 5.2, $t = 1$", relax_options, 2, 1, _relax_errors, ("shape", "energy"),
          tuple(_relax_points()), fine_options("relax"), words("-domain_cells 384,384 -time_adapt_tol 3e-7"),
          words("-domain_cells 192,192 -time_adapt_tol 1e-5")),
    Scene("shear", r"tank-treading in shear, $V = 0.7$, $\chi = 10$, box 8 x 8, $t = 12$",
          lambda point: tank_treading("box", point.cells, 0.7, 10), 8, 12, _shear_errors,
          ("angle", "frequency", "area", "length"), tuple(_shear_points())),
    Scene("channel", "migration in a channel, section 5.5, window 12 x 6, $t = 24$", channel_options, 1, 24,
          _channel_errors, ("velocity", "shape"), tuple(_channel_points()),
          channel_options(Point(DEFAULT, 40)) | {"-time_step": "0.015"}, words("-domain_cells 336,168 -time_step 0.02"),
          words("-domain_cells 120,60 -time_step 0.03"),
          more=lambda series: {"rise": series["center_y"][-1] - series["center_y"][0]}),
)
# fmt: on
