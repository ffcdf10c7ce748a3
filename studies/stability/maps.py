"""The maps of one vesicle by itself, a panel a scheme."""

from __future__ import annotations

from studies.common.curves import radius
from studies.common.scenes import KERNELS
from studies.stability.cells import STEPS, Map

RELAX = "-vesicle_semi_axes 0.2,0.5"
SHEAR = "-domain_box -2.4,2.4,-2.4,2.4 -flow_type shear -vesicle_area 1"


def times(dt: float, steps: int = STEPS) -> str:
    """Return the options of so many steps."""
    return f"-time_step {dt!r} -time_end {steps * dt!r}"


def relax(dt: float, c_b: float, cells: int = 32, steps: int = STEPS) -> str:
    """Return the options of an ellipse in fluid at rest, [-1,1]^2."""
    return f"{RELAX} -domain_cells {cells},{cells} -vesicle_bending {c_b} {times(dt, steps)}"


def shear(dt: float, reduced_area: float, chi: float, cells: int = 64) -> str:
    """Return the options of a vesicle of unit area in shear of rate 1, nu = 1, [-2.4,2.4]^2."""
    bending = radius(reduced_area) ** 3 / chi
    vesicle = f"-vesicle_reduced_area {reduced_area} -vesicle_bending {bending!r}"
    return f"{SHEAR} -domain_cells {cells},{cells} {vesicle} {times(dt)}"


def thin(dt: float, reduced_area: float) -> str:
    """Return the options of a thin vesicle of unit area in fluid at rest."""
    return (
        "-domain_box -2.4,2.4,-2.4,2.4 -domain_cells 64,64 -vesicle_area 1 "
        f"-vesicle_reduced_area {reduced_area} -vesicle_bending 0.1 {times(dt)}"
    )


def change(dt: float, factor: float) -> tuple[str, str]:
    """Return the options of 20 steps of an ellipse, and of STEPS more with another step."""
    scene = f"{RELAX} -domain_cells 32,32 -vesicle_bending 0.1"
    after = dt * factor
    return (
        f"{scene} {times(dt, 20)}",
        f"{scene} -time_step {after!r} -time_end {20 * dt + STEPS * after!r}",
    )


def powers(*exponents: int) -> tuple[float, ...]:
    """Return 2^-k for each k."""
    return tuple(2.0**-k for k in exponents)


ACROSS, STRONG = "cells across the box", r"shear, V = 0.7, $\chi = 1000$"
CHANGE = "ellipse at rest, $c_b = 0.1$, $32^2$: dt changes after 20 steps"
KERNEL = r"shear, V = 0.7, $\chi = 10$, $dt$ = 1/256, $64^2$"
CHIS, OVER_RATE = (0.1, 1.0, 10.0, 100.0, 1000.0), "$dt$ (over 1/rate)"
# fmt: off
STEP_MAP = Map("dt_h", "ellipse at rest, $c_b = 1$", ACROSS, (24, 32, 48, 64, 96), "$dt$", powers(*range(3, 15)),
               lambda n, dt: (relax(dt, 1, n, 4 * STEPS),))  # a slow growth counts too
MAPS = (
    Map("dt_cb", "ellipse at rest, $32^2$", "$c_b$", (1e-4, 1e-2, 1.0, 100.0), "$dt$", powers(3, 5, 7, 9, 11, 13),
        lambda c_b, dt: (relax(dt, c_b),)),
    Map("dt_chi", "shear, V = 0.7, $64^2$", r"$\chi$", CHIS, OVER_RATE, powers(2, 4, 6, 8, 10),
        lambda chi, dt: (shear(dt, 0.7, chi),)),
    STEP_MAP,
    Map("V_chi", "shear, $dt$ = 1/64, $64^2$", r"$\chi$", CHIS[1:], "V", (0.2, 0.3, 0.5, 0.7, 0.9),
        lambda chi, v: (shear(1 / 64, v, chi),)),
    Map("spacing_kernel", KERNEL, "kernel", KERNELS, "ds/h", (0.75, 1.1, 1.3, 1.5, 2.0, 2.5),
        lambda kernel, spacing: (f"{shear(1 / 256, 0.7, 10)} -delta_type {kernel} -vesicle_spacing {spacing}",)),
    Map("dt_change", CHANGE, "new $dt$ over old", (1 / 64, 1 / 8, 8.0, 64.0), "first $dt$", powers(6, 9, 12),
        lambda factor, dt: change(dt, factor)),
    Map("thin", "thin ellipse at rest, $c_b = 0.1$, $64^2$", "V", (0.2, 0.3, 0.4), "$dt$", powers(4, 6, 8, 10),
        lambda v, dt: (thin(dt, v),)),
    Map("strong", STRONG, ACROSS, (32, 48, 64), OVER_RATE, powers(2, 4, 6, 8), lambda n, dt: (shear(dt, 0.7, 1000, n),)),
)
# fmt: on
