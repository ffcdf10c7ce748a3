"""The runs behind the study of inertia: their options and what is kept of each."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from petves.run import Run
from studies.common.curves import aspect, radius, trigonometric
from studies.common.engine import Case, Series
from studies.common.paper import RELAXATION
from studies.common.scenes import BOXES, cells, words

MODELS = ("none", "unsteady", "convective")
STREAM = 2.73  # speed that makes Re = 1 for the ellipse (0.2, 0.5), R0 = 0.366, nu = 1
RADIUS = radius(0.7)


def relaxation_options(half: float, n: int, dt: float, box: str) -> dict[str, str]:
    """Return the relaxing ellipse in quasi-steady flow, n^2 cells in a box of the half width; dt divides 0.25."""
    options = BOXES[box] | words(f"-domain_box {-half:g},{half:g},{-half:g},{half:g}") | cells(n)
    return options | words(f"-fluid_inertia none -time_step {dt!r} -time_end 3 -output_every 0.25")


def extents(folder: Path) -> dict[float, tuple[float, float, float]]:
    """Return bending energy and half extents in x and y by the times of the target."""
    run = Run.read(folder)
    found = {}
    for time in RELAXATION:
        frame = int(np.abs(run.time - time).argmin())
        row = int(np.abs(run.series["time"] - time).argmin())
        curve = trigonometric(run.markers[frame])
        half = 0.5 * np.ptp(curve, axis=0)
        found[time] = (run.series["energy_bending"][row], *half)
    return found


def relaxation(half: float, n: int, dt: float, box: str) -> Case:
    """Return the relaxing ellipse of relaxation_options."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        its = series["coupled_its"][10:]
        return {"found": {f"{t:g}": row for t, row in extents(folder).items()}, "its": its.mean(), "most": its.max()}

    options = relaxation_options(half, n, dt, box) | {"-checkpoint_every": "0"}
    return Case(f"relaxation_{box}_{half:g}_{n}_{dt:g}", options, measure)


def poiseuille_options(
    window: float, height: float, cells: int, dt: float, t_end: float, centred: bool = False
) -> dict[str, str]:
    """Return a vesicle, V = 0.7, in quasi-steady flow at Ca = 10; lengths in R0, `cells` a radius, c_b = nu = R0 = 1.

    It lies along the flow, released one radius above the middle, or in the middle and across.
    """
    options = words(f"-domain_box 0,{window:g},{-height / 2:g},{height / 2:g}")
    options |= {"-domain_cells": f"{round(window * cells)},{round(height * cells)}"}
    options |= words(f"-domain_bc_x periodic -flow_type poiseuille -flow_half_width {height / 2:g}")
    options |= words(f"-flow_peak_velocity {10 * (height / 2) ** 2!r} -fluid_inertia none")
    options |= words(f"-vesicle_area {0.7 * float(np.pi)!r} -vesicle_reduced_area 0.7")
    options |= words(f"-vesicle_center {window / 2:g},{0 if centred else 1} -vesicle_angle {90 if centred else 0}")
    return options | words(f"-vesicle_bending 1 -time_step {dt!r} -time_end {t_end:g} -output_every 0.5")


def _run_name(window: float, height: float, cells: int, dt: float) -> str:
    return f"{window:g}_{height:g}_{cells}_{dt:g}"


def migration_free(window: float, height: float, cells: int, dt: float) -> Case:
    """Return the migrating vesicle, to t = 6."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        height = {f"{t:g}": np.interp(t, series["time"], series["center_y"]) for t in (0.5, 1, 2, 4, 6)}
        its = series["coupled_its"][10:]
        return {"height": height, "steps": len(series["time"]) - 1, "its": its.mean(), "most": its.max()}

    options = poiseuille_options(window, height, cells, dt, 6) | {"-checkpoint_every": "0"}
    return Case(f"free_{_run_name(window, height, cells, dt)}", options, measure)


def parachute(window: float, height: float, cells: int, dt: float, t_end: float = 1.5) -> Case:
    """Return the centred vesicle: aspect and mean velocity minus u_max at the saved times."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        run = Run.read(folder)
        slip = run.velocity[:, :, 0].mean(axis=1) - 10 * (height / 2) ** 2
        return {"time": list(run.time), "aspect": [aspect(trigonometric(x)) for x in run.markers], "slip": list(slip)}

    options = poiseuille_options(window, height, cells, dt, t_end, centred=True) | {"-checkpoint_every": "0"}
    return Case(f"parachute_{_run_name(window, height, cells, dt)}", options, measure)


def moving_and_resting(n: int, inertia: str) -> dict[str, dict[str, str]]:
    """Return the relaxing ellipse in a periodic 2 x 2 box of n^2 cells, at rest and in a stream through the seam."""
    base = BOXES["periodic"] | cells(n) | words(f"-fluid_inertia {inertia} -flow_type poiseuille")
    base |= words("-flow_half_width 1e7 -coupled_ksp_rtol 1e-9")  # a uniform stream; far below the differences
    base |= words(f"-vesicle_semi_axes 0.5,0.2 -time_step {0.25 / n!r} -time_end 0.5 -output_every 0.0625")
    return {name: base | {"-flow_peak_velocity": repr(u)} for name, u in (("rest", 0.0), ("stream", STREAM))}


def galilean(n: int, inertia: str, name: str) -> Case:
    """Return one run of moving_and_resting, or the resting one shifted by half a cell in x.

    Kept at three times: tension, and markers and velocity about their means.
    """

    def measure(series: Series, folder: Path) -> dict[str, object]:
        run = Run.read(folder)
        kept = {"tension": run.tension}
        kept["shape"], kept["velocity"] = [x - x.mean(axis=1, keepdims=True) for x in (run.markers, run.velocity)]
        return {key: [round(float(x), 9) for x in np.ravel(value[2::3])] for key, value in kept.items()}

    options = moving_and_resting(n, inertia)["rest" if name == "shifted" else name] | {"-checkpoint_every": "0"}
    if name == "shifted":
        options |= {"-vesicle_center": f"{1 / n!r},{0.3 / n!r}"}
    return Case(f"galilean_{n}_{inertia}_{name}", options, measure)


def migration(reynolds: float, model: str, n: int, travel: float, across: bool = False) -> Case:
    """Return section 5.5's channel: window 12 x 6, n cells in height, w = 60, released one radius off the middle.

    The vesicle of unit area lies along the flow, or across; `travel` is u_max t over R0.
    """
    peak = reynolds / RADIUS
    dt = 0.45 * 6 / n / peak * (2 if model == "none" else 1)
    options = words("-domain_box 0,12,-3,3") | cells(2 * n, n) | words("-domain_bc_x periodic -flow_type poiseuille")
    options |= words(f"-flow_half_width 3 -flow_peak_velocity {peak!r} -fluid_inertia {model}")
    options |= words(f"-vesicle_area 1 -vesicle_reduced_area 0.7 -vesicle_center 6,{RADIUS!r}")
    options |= words(f"-vesicle_angle {90 if across else 0} -vesicle_bending {peak * RADIUS**2 / 60!r}")
    options |= words(f"-time_step {dt!r} -time_end {travel * RADIUS / peak!r} -output_every 1e9 -checkpoint_every 0")

    def measure(series: Series, folder: Path) -> dict[str, object]:
        way = series["time"] * peak / RADIUS
        at = np.linspace(0, travel, 81)
        found = json.loads((folder / "summary.json").read_text())
        kept = {"travel": list(at), "height": list(np.interp(at, way, series["center_y"] / RADIUS))}
        return kept | {"reynolds": found["reynolds"], "cfl": found["cfl_max"], "its": series["coupled_its"][10:].mean()}

    start = "across" if across else "along"
    return Case(f"migration_{model}_{reynolds:g}_{n}_{travel:g}_{start}", options, measure)


def iterations(box: str, n: int, model: str) -> Case:
    """Return 40 steps of dt = h of the relaxing ellipse in a 2 x 2 box of n^2 cells."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        its, solves = series["coupled_its"][11:], series["nsolve"][11:]
        return {"its": its.mean(), "most": its.max(), "nsolve": solves.mean()}

    options = BOXES[box] | cells(n) | words(f"-fluid_inertia {model} -time_step {2 / n!r} -time_end {80 / n!r}")
    options |= words("-output_every 100 -checkpoint_every 0")
    return Case(f"iterations_{box}_{n}_{model}", options, measure)
