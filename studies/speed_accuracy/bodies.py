"""More scenes of the work-precision diagrams: no box, two vesicles, sixteen, another viscosity inside, an obstacle."""

from __future__ import annotations

import numpy as np

from studies.common.engine import Series
from studies.common.paper import SHEAR_FREE
from studies.common.scenes import cells, option_file, tank_treading, words
from studies.gallery.passing import EXACT as PASSING
from studies.gallery.scene import least
from studies.speed_accuracy.scenes import BEST, DEFAULT, Point, Scene, drift, grid, shape_error

TREADING = SHEAR_FREE[0.7, 10]
CONTRAST = (0.094352, 0.248789)
"""Angle over pi and frequency over the rate, twice as viscous inside, 8 x 8 box: boundary integral, 1e-6."""
UNCERTAIN = {
    "free": {"angle": 1e-6 / TREADING[0], "frequency": 1e-6 / TREADING[1]},
    "passing": {"place": 1e-5},
    "contrast": {"angle": 1e-6 / CONTRAST[0], "frequency": 1e-6 / CONTRAST[1]},
}
"""Of the boundary integrals, as errors."""
UNCORRECTED = "coupled 2, uncorrected"
CHECK = words("-vesicle_markers 91 -vesicle_allow_close_markers true -coupled_ksp_rtol 1e-8")
"""Of the fine runs."""


def free_options(point: Point) -> dict[str, str]:
    """Return runs/free.opts with rate 1, t = 12, and so many markers."""
    return option_file("free") | words(
        f"-flow_rate 1 -vesicle_bending 0.03066241 -vesicle_markers {point.cells} -time_end 12"
    )


def suspension_options(point: Point) -> dict[str, str]:
    """Return sixteen vesicles in a sheared channel, chi = 10, three tenths of its area."""
    text = "-domain_box 0,8.4,0,6.3 -domain_bc_x periodic -flow_type shear -flow_rate 1 -flow_center_y 3.15 -fluid_inertia none "
    text += "-vesicle_packing 0.3 -vesicle_count 16 -vesicle_packing_gap 0.13 -vesicle_reduced_area 0.7 "
    return words(text + "-vesicle_bending 0.0303 -time_end 1") | cells(point.cells, 3 * point.cells // 4)


def _steady(target: tuple[float, float], found: dict) -> dict[str, float]:
    pairs = zip(("angle", "frequency"), target)
    return {name: abs(found[name] / exact - 1) for name, exact in pairs} | drift(found)


def _passed(series: Series) -> dict[str, object]:
    gap, _ = least(series)
    return {"center": [series[f"center_{c}_1"][-1] for c in "xy"], "least_gap": gap}


def _passing_errors(found: dict, fine: dict) -> dict[str, float]:
    place = np.hypot(*np.subtract(found["center"], PASSING["center"])) / found["radius"]
    return {"place": float(place), "gap": abs(found["least_gap"] / fine["least_gap"] - 1)}


def _suspension_errors(found: dict, fine: dict) -> dict[str, float]:
    return {"shape": shape_error(found, fine), "viscosity": abs(found["viscosity"] / fine["viscosity"] - 1)} | drift(
        found
    )


def _post_errors(found: dict, fine: dict) -> dict[str, float]:
    off = {name: abs(found[name] / fine[name] - 1) for name in ("gap", "force")}
    return {"shape": shape_error(found, fine)} | off | drift(found)


def _both(some: tuple[int, ...], dts: tuple[float, ...], few: tuple[int, ...]) -> list[Point]:
    """Return points of order 3, and of order 2 on some of its grids."""
    return grid(BEST, few, dts=dts[1:]) + grid(DEFAULT, some, dts=dts)


# fmt: off
SCENES = (
    Scene("free", r"tank-treading in unbounded shear, $V = 0.7$, $\chi = 10$, $t = 12$", free_options, 1, 12,
          lambda found, fine: _steady(TREADING, found), ("angle", "frequency"),
          tuple(_both((17, 25, 35, 45, 65, 91), (0.4, 0.2, 0.1, 0.05), (25, 45)))),
    Scene("passing", r"two vesicles passing in shear, $V = 0.8$, $\chi = 5$, box 8 x 8, $t = 15$",
          lambda point: option_file("gallery/passing") | cells(point.cells), 8, 15, _passing_errors, ("place", "gap"),
          tuple(_both((24, 32, 48, 64), (0.2, 0.1, 0.05), (24, 48)) + grid(DEFAULT, (24, 32, 64), dts=(0.025,)) + grid(DEFAULT, (24, 32, 48), tolerances=(1e-2, 1e-3, 1e-4))
                + grid(UNCORRECTED, (48, 96), dts=(0.05,))),
          option_file("gallery/passing") | cells(96) | CHECK | {"-time_step": "0.01"},
          words("-domain_cells 64,64 -time_step 0.0125"), words("-domain_cells 48,48 -time_step 0.05"), more=_passed),
    Scene("suspension", r"sixteen vesicles in a sheared channel, $V = 0.7$, $\chi = 10$, 30 % of its area, $t = 1$",
          suspension_options, 8.4, 1, _suspension_errors, ("shape", "viscosity"),
          tuple(_both((32, 48, 64, 96), (0.2, 0.1, 0.05), (32, 64)) + grid(DEFAULT, (32, 64), dts=(0.025,))),
          suspension_options(Point(DEFAULT, 96)) | CHECK | {"-time_step": "0.0125"},
          words("-domain_cells 80,60 -time_step 0.02"), words("-domain_cells 64,48 -time_step 0.05"),
          more=lambda series: {"viscosity": series["viscosity"][-1]}),
    Scene("contrast", r"tank-treading, twice as viscous inside, $V = 0.7$, $\chi = 10$, box 8 x 8, $t = 24$",
          lambda point: tank_treading("box", point.cells, 0.7, 10, 24) | {"-vesicle_viscosity_ratio": "2"}, 8, 24,
          lambda found, fine: _steady(CONTRAST, found), ("angle", "frequency"),
          tuple(_both((24, 32, 48, 64, 128), (0.2, 0.1, 0.05), (32, 64)) + grid(DEFAULT, (16,), dts=(0.2,)))),
    Scene("post", "draped round a post by a stream, runs/posts.opts, $t = 1.8$",
          lambda point: option_file("posts") | cells(point.cells), 2, 1.8, _post_errors, ("shape", "gap", "force"),
          tuple(_both((24, 32, 48, 64, 96), (0.1, 0.05, 0.025, 0.0125), (24, 48))),
          option_file("posts") | cells(128) | CHECK | {"-time_step": "0.005"}, words("-domain_cells 96,96 -time_step 0.01"),
          words("-domain_cells 48,48 -time_step 0.025"),
          more=lambda series: {"gap": series["gap"][-1], "force": series["obstacle_force_x"][-1]}),
)
# fmt: on
