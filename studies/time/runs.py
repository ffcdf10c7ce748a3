"""The runs behind the study of the time step: their options and what is kept of each. R0 = nu = rate = 1, c_b = 1/chi."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.curves import last_markers, radius
from studies.common.engine import Case, Series
from studies.common.scenes import LAST_ONLY, cells, option_file, words

FREE = words("-domain_bc_x free -domain_bc_y free -domain_box -4,4,-4,4 -domain_cells 32,32")
BOXES = {
    "free": FREE,
    "box": words("-domain_box -4,4,-4,4 -domain_cells 32,32 -fluid_inertia none"),
    "channel": words("-domain_box -4,4,-4,4 -domain_cells 32,32 -domain_bc_x periodic -fluid_inertia none"),
}
"""R0/h = 4; every one quasi-steady, so that only time steps differ."""
SHAPES = ((0.7, 10), (0.55, 3), (0.9, 1))
"""Reduced area and chi of the steady shapes."""
WAYS = {"order 2": 2, "order 3": 3}
EXACT = words("-coupled_ksp_rtol 1e-8")


def vesicle(reduced_area: float, chi: float, angle: float = 17.1887) -> dict[str, str]:
    """Return the options of a vesicle with R0 = 1 in shear."""
    shape = f"-vesicle_reduced_area {reduced_area} -vesicle_area {np.pi * reduced_area!r} -vesicle_angle {angle}"
    return words(f"-flow_type shear {shape} -vesicle_bending {1 / chi!r}")


def resting(c_b: float) -> dict[str, str]:
    """Return the options of an ellipse with R0 = 1 in fluid at rest."""
    return words(f"-vesicle_reduced_area 0.7 -vesicle_area {np.pi * 0.7!r} -vesicle_bending {c_b}")


def way(name: str) -> dict[str, str]:
    """Return the options of an order."""
    return words(f"-scheme_order {WAYS[name]}")


def until(dt: float, end: float) -> dict[str, str]:
    """Return the options of a step and an end."""
    return words(f"-time_step {dt!r} -time_end {end!r}") | LAST_ONLY


PAIR = words(
    "-flow_type shear -vesicle_count 2 -vesicle_reduced_area 0.8 -vesicle_area 2.5132741228718345 -vesicle_bending 0.2 "
    "-vesicle_center -3,0.5,3,-0.5 -vesicle_angle 20"
)
OFF_CENTRE = words(
    "-flow_type poiseuille -flow_half_width 5 -flow_peak_velocity 5 -vesicle_reduced_area 0.7 "
    "-vesicle_area 2.199114857512855 -vesicle_bending 0.1 -vesicle_center 0,1"
)
PARACHUTE = words(
    "-domain_box 0,12,-3,3 -domain_cells 48,24 -domain_bc_x periodic -flow_type poiseuille -flow_half_width 3 "
    "-flow_peak_velocity 3 -fluid_inertia none -vesicle_reduced_area 0.7 -vesicle_area 2.199114857512855 "
    "-vesicle_bending 0.1 -vesicle_angle 90 -vesicle_center 3,0"
)
RELAX = words("-domain_cells 32,32 -vesicle_semi_axes 0.2,0.5 -vesicle_bending 0.01 -fluid_inertia unsteady")
CHANNEL = option_file("poiseuille") | cells(96, 48)
CHANNEL |= words(f"-fluid_inertia unsteady -vesicle_center 6,{3 + radius(0.7)!r}")
TRANSIENTS = {
    "ellipse": ("ellipse to steady shear, V = 0.7, chi = 10", FREE | vesicle(0.7, 10), 4, (0.4, 0.2, 0.1, 0.05, 0.025)),
    "wrinkles": (
        "start at -20 degrees, V = 0.65, chi = 100, 61 markers",
        FREE | vesicle(0.65, 100, -20) | words("-vesicle_markers 61"),
        2,
        (0.1, 0.05, 0.025, 0.0125),
    ),
    "relaxing": ("ellipse at rest, c_b = 1", FREE | resting(1), 0.5, (0.0625, 0.03125, 0.015625, 0.0078125)),
    "pair": ("two vesicles passing, V = 0.8, chi = 5", FREE | PAIR, 12, (0.1, 0.05, 0.025, 0.0125)),
    "parabola": ("parabolic flow, off centre", FREE | OFF_CENTRE, 6, (0.4, 0.2, 0.1, 0.05)),
    "parachute": ("channel, centred", PARACHUTE, 4, (0.2, 0.1, 0.05, 0.025)),
    "relax": ("section 5.2, walls, unsteady", RELAX, 1, (0.05, 0.025, 0.0125, 0.00625)),
    "shear": (
        "8 x 8 box, unsteady",
        BOXES["box"] | vesicle(0.7, 10, 0) | words("-domain_cells 64,64 -fluid_inertia unsteady"),
        12,
        (0.4, 0.2, 0.1, 0.05),
    ),
    "channel": ("section 5.5, unsteady", CHANNEL, 24, (0.24, 0.12, 0.06, 0.03)),
}
"""What, options, end, steps. The last three are the scenes of docs/evidence.md."""
FINER = 4
"""Times that the references' steps are smaller than the least of a scene's: in unsteady flow they stay above .34 h^2/nu, below
which the lag of inertia has a limit and another field is solved for (docs/nearfield.md, Unsteady flow)."""
TOLERANCES = (3e-2, 3e-3, 3e-4)
CONTROLLED = {
    "ellipse to the steady shape": (FREE | vesicle(0.7, 10), 20, 0.05),
    "wrinkles": (TRANSIENTS["wrinkles"][1], 2, 0.05),
    "relaxing": (TRANSIENTS["relaxing"][1], 0.5, 0.01),
    "relax": (RELAX, 1, 0.02),
    "parabola": (TRANSIENTS["parabola"][1], 6, 0.05),
}
"""Options, end, -time_step."""
CHIS, LARGE = (1, 10, 100, 1000), (0.125, 0.25, 0.5, 1, 2, 4)
STIFF, LONG = (1, 100), (0.01, 0.1, 1, 10)


def _end(series: Series, folder: Path) -> dict[str, object]:
    """Steps, iterations, angle and markers at the end."""
    return {
        "steps": len(series["time"]) - 1,
        "its": series["coupled_its"][1:].sum(),
        "angle": series["inclination"][-1],
        "largest": series["dt"][1:].max(),
        "markers": np.round(last_markers(folder), 12).ravel().tolist(),
    }


def steady(box: str, reduced_area: float, chi: float, name: str, dt: float) -> Case:
    """Return a vesicle that has reached its steady shape: angle, frequency, iterations a step of the last half."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        half = len(series["time"]) // 2
        its = series["coupled_its"][half:].mean()
        return {"angle": series["inclination"][-1], "frequency": series["frequency"][-1], "its": its}

    options = BOXES[box] | vesicle(reduced_area, chi) | way(name) | until(dt, 30) | EXACT
    return Case(f"steady_{box}_{reduced_area}_{chi}_{name}_{dt:g}", options, measure)


def transient(scene: str, name: str, dt: float) -> Case:
    """Return a scene with fixed steps."""
    _, options, end, _ = TRANSIENTS[scene]
    return Case(f"transient_{scene}_{name}_{dt:g}", options | way(name) | until(dt, end) | EXACT, _end)


def controlled(scene: str, name: str, tolerance: float) -> Case:
    """Return a scene with error control."""
    options, end, dt = CONTROLLED[scene]
    control = words(f"-time_adapt error -time_adapt_tol {tolerance} -time_adapt_max_move 0")
    return Case(
        f"controlled_{scene}_{name}_{tolerance:g}", options | way(name) | until(dt, end) | control | EXACT, _end
    )


def fine(scene: str, name: str) -> Case:
    """Return the reference of a scene with error control."""
    options, end, dt = CONTROLLED[scene]
    return Case(f"fine_{scene}_{name}", options | way(name) | until(dt / 20, end) | EXACT, _end)


def large(chi: float, name: str, dt: float) -> Case:
    """Return 50 steps from an ellipse: angle and frequency at the end, largest energy over the first."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        energy = series["energy_bending"]
        return {
            "angle": series["inclination"][-1],
            "frequency": series["frequency"][-1],
            "energy": energy.max() / energy[0],
        }

    options = FREE | vesicle(0.7, chi) | words(f"-vesicle_markers {61 if chi > 10 else 45}")
    return Case(f"large_{chi}_{name}_{dt:g}", options | way(name) | until(dt, 50 * dt), measure, may_fail=True)


def energy(c_b: float, order: int, dt: float) -> Case:
    """Return 40 steps of an ellipse at rest: the largest rise of the bending energy in a step and its end, over E_0."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        found = series["energy_bending"] / series["energy_bending"][0]
        return {"rise": np.diff(found).max(), "end": found[-1]}

    startup = "-scheme_startup euler" if order > 1 else ""
    options = FREE | resting(c_b) | words(f"-scheme_order {order} {startup}")
    return Case(f"energy_{c_b}_{order}_{dt:g}", options | until(dt, 40 * dt) | EXACT, measure)
