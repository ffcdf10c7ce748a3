"""Scenes that several pages look at, as options of petves."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from studies.common.curves import radius

TIGHT = "1e-12"
BENDING, CHANNEL_V, PEAK = 0.01, 0.7, 1.319456  # of the paper's sections 5.4 to 5.6
CELLS = (32, 64, 128, 256)
"""1/h of the paper's tables."""
MARKERS_TABLE_7 = {32: 50, 64: 98, 128: 196, 256: 392}  # 1.5 h apart
RUNS = Path(__file__).resolve().parents[2] / "runs"
"""Where the option files are."""


def words(text: str) -> dict[str, str]:
    """Return options and their values, each option with one, from a command line."""
    parts = text.split()
    return dict(zip(parts[::2], parts[1::2]))


def option_text(options: dict[str, str]) -> str:
    """Return options as a command line."""
    return " ".join(f"{name} {value}" for name, value in options.items())


LAST_ONLY = words("-output_every 1e9 -checkpoint_every 0")
ILU = words("-tension_pc_type ilu -tension_pc_factor_levels 200 -tension_pc_factor_mat_ordering_type nd")
TIGHT_SPLIT = {"-tension_ksp_rtol": TIGHT, "-bending_ksp_rtol": TIGHT}
PAPER_MEMBRANE = words("-delta_type ib6 -membrane_derivative fd -coupling_near_field none")
"""The paper's membrane, where schemes are compared and not the discretisations of a membrane."""
BOXES = {
    "periodic": words("-domain_bc_x periodic -domain_bc_y periodic"),
    "channel": words("-domain_bc_x periodic"),
    "walls": {},
}
KERNELS = ("ib6", "cbs54")


def cells(n: int, m: int | None = None) -> dict[str, str]:
    """Return the option of a grid of n cells in x, m (n) in y."""
    return {"-domain_cells": f"{n},{n if m is None else m}"}


def option_file(name: str) -> dict[str, str]:
    """Return the options of runs/NAME.opts and their values, without -output_dir."""
    return dict(_options_of(name))


@cache
def _options_of(name: str) -> dict[str, str]:
    lines = [line.split("#")[0].split() for line in (RUNS / f"{name}.opts").read_text().splitlines()]
    return {option: " ".join(value) for option, *value in filter(None, lines) if option != "-output_dir"}


def ellipse(kind: str, n: int, markers: int, dt: float) -> dict[str, str]:
    """Return the options of section 5.1 (energy), 5.2 (relax) or 5.3 (shear) with h = 1/n."""
    end = {"energy": "3", "relax": "1", "shear": "5"}[kind]
    options = words("-domain_box -1,1,-1,1") | cells(2 * n)
    options |= words(f"-vesicle_semi_axes 0.2,0.5 -vesicle_bending 0.01 -vesicle_markers {markers}")
    options |= words(f"-time_step {dt!r} -time_end {end} -output_every 1000 -checkpoint_every 0")
    options |= words("-scheme_type split -scheme_order 1")
    return options | (words("-flow_type shear -flow_rate 1") if kind == "shear" else {})


def split_options(kind: str, n: int) -> dict[str, str]:
    """Return section 5.2's run (relax, 1/h markers, dt = h/2) or 5.3's (shear, 1.5 h apart, dt = h/4) on h = 1/n.

    GMRES stops at h^2, split's default. The state before the last step is saved too.
    """
    markers = n if kind == "relax" else MARKERS_TABLE_7.get(n, 2 * MARKERS_TABLE_7[256])
    dt, end = (0.5, 1) if kind == "relax" else (0.25, 5)
    return ellipse(kind, n, markers, dt / n) | ILU | {"-output_every": repr(end - dt / n)}


def fine_options(kind: str) -> dict[str, str]:
    """Return the coupled run that stands for the truth: default corrections, small steps."""
    n, tolerance = {"relax": (128, "1e-6"), "shear": (96, "1e-5")}[kind]
    options = ellipse(kind, n, 0, 0.02)
    del options["-vesicle_markers"]
    adapt = words(f"-time_adapt error -time_adapt_tol {tolerance} -time_step 0.02 -scheme_order 2")
    return options | words("-scheme_type coupled -fluid_inertia unsteady") | adapt


def tank_treading(box: str, n: int, reduced_area: float, chi: float, time_end: float = 12) -> dict[str, str]:
    """Return unit area in shear, rate dt = 0.05, rate 1: 8 x 8 box, or channel 16 x 8, of n cells across."""
    length = 16 if box == "channel" else 8
    options = words(f"-domain_box {-length / 2:g},{length / 2:g},-4,4") | cells(n * length // 8, n)
    options |= words(f"-domain_bc_x {'periodic' if box == 'channel' else 'wall'} -flow_type shear -vesicle_area 1")
    options |= words(f"-vesicle_reduced_area {reduced_area!r} -vesicle_bending {radius(reduced_area) ** 3 / chi!r}")
    options |= words(f"-vesicle_angle 20 -time_step 0.05 -time_end {time_end:g}")
    return options | words("-output_every 100 -checkpoint_every 0")
