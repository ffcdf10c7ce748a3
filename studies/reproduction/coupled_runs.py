"""The runs behind the coupled scheme's study: their options and what is kept of each."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.curves import last_markers
from studies.common.engine import Case, Series
from studies.common.scenes import BOXES, PAPER_MEMBRANE, TIGHT, TIGHT_SPLIT, cells, words

ELLIPSE = PAPER_MEMBRANE | words(
    "-domain_box -1,1,-1,1 -vesicle_semi_axes 0.2,0.5 -output_every 1000 -checkpoint_every 0"
)
STIFFNESS, ENERGY_STEPS = (0.01, 1.0, 100.0), (1 / 32, 1 / 8, 1 / 2, 2.0)
STEPS_OF_ENERGY_RUN = 24
SPLIT = words("-scheme_type split") | TIGHT_SPLIT
OFF = words("-scheme_length_target false")
EULER = words("-scheme_startup euler")
WALLS = words("-domain_bc_x wall -domain_bc_y wall")
TOLERANCES = (*(1e-2 / 2**k for k in range(11)), 1e-6)
STEPS = (32, 64, 128, 256)
"""1/dt of the table of temporal errors."""


def coupled(order: int, rtol: str = TIGHT) -> dict[str, str]:
    """Return the options of the coupled scheme at one order and tolerance."""
    return words(f"-scheme_type coupled -scheme_order {order} -coupled_ksp_rtol {rtol}")


def _measure_energy(series: Series, folder: Path) -> dict[str, object]:
    energy = series["energy_kinetic"] + series["energy_bending"]
    its = series["coupled_its"][1:]
    return {
        "ratio": energy[-1] / energy[0],
        "rise": np.max(np.diff(energy)) / energy[0],
        "rise_later": np.max(np.diff(energy)[1:]) / energy[0],
        "length": series["length_error"][-1],
        "area": series["area_error"][-1],
        "coupled_its": its.mean(),
    }


ENERGY_SCHEMES = {
    "split": SPLIT,
    "1": coupled(1) | OFF,
    "1_loose": coupled(1, "1e-6") | OFF,
    "2": coupled(2) | OFF,
    "2_euler": coupled(2) | OFF | EULER,
    "1_target": coupled(1),
    "2_target": coupled(2),
    "2_target_euler": coupled(2) | EULER,
}


def energy_sweep(scheme: str, bending: float, dt: float) -> Case:
    """Return a run of the energy sweep: h = 1/32, 36 markers, 24 steps; scheme is a key of ENERGY_SCHEMES."""
    options = ELLIPSE | cells(64) | ENERGY_SCHEMES[scheme]
    options |= words(f"-vesicle_markers 36 -vesicle_bending {bending!r} -time_step {dt!r}")
    options |= words(f"-time_end {STEPS_OF_ENERGY_RUN * dt!r} -output_every 100000")
    return Case(f"sweep_{scheme}_{bending:g}_{dt:g}", options, _measure_energy, may_fail=True)


def _measure_markers(series: Series, folder: Path) -> dict[str, object]:
    found = {"steps": len(series["time"]) - 1, "time": series["time"][-1], "nsolve": series["nsolve"][1:].sum()}
    return found | {"dt_max": series["dt"][1:].max(), "markers": list(np.ravel(last_markers(folder)))}


TEMPORAL_SCHEMES = {
    "split": SPLIT,
    "coupled, order 1": coupled(1) | OFF,
    "coupled, order 2, euler start": coupled(2) | OFF | EULER,
    "coupled, order 2, graded start": coupled(2) | OFF,
}


def temporal(scheme: str, steps: int) -> Case:
    """Return a run to t = 0.25 with dt = 1/steps, length target off; scheme is a key of TEMPORAL_SCHEMES."""
    options = ELLIPSE | cells(64) | TEMPORAL_SCHEMES[scheme]
    options |= words(f"-vesicle_markers 36 -time_step {1 / steps!r} -time_end 0.25")
    return Case(f"temporal_{scheme.replace(', ', '_').replace(' ', '_')}_{steps}", options, _measure_markers)


def reference() -> Case:
    """Return the run that temporal errors are measured against."""
    return temporal("coupled, order 2, graded start", 1024)


def adaptive(tolerance: float) -> Case:
    """Return a run to t = 0.25 with step-size control, length target off."""
    options = ELLIPSE | cells(64) | coupled(2, "1e-10") | OFF
    options |= words(f"-vesicle_markers 36 -time_step 0.03125 -time_end 0.25 -time_adapt error")
    options |= {"-time_adapt_tol": repr(tolerance)}
    return Case(f"adaptive_{tolerance:g}", options, _measure_markers)


def _measure_iterations(series: Series, folder: Path) -> dict[str, object]:
    its = series["coupled_its"][2:]  # the first row is the start, the next one the graded start's five solves
    return {"mean": its.mean(), "min": its.min(), "max": its.max(), "first": series["coupled_its"][1]}


STIFF = {False: "dt = h, c_b = 0.01", True: "dt = 1/4, c_b = 1"}


def iterations(box: str, stiff: bool, n: int) -> Case:
    """Return a run of six steps from a zero guess: box is a key of BOXES, stiff one of STIFF."""
    dt, bending = (0.25, 1.0) if stiff else (1 / n, 0.01)
    options = ELLIPSE | cells(2 * n) | WALLS | BOXES[box] | coupled(2, "1e-6")
    options |= words(f"-vesicle_bending {bending!r} -time_step {dt!r} -time_end {6 * dt!r}")
    options |= words("-coupled_ksp_initial_guess_nonzero false")
    name = f"iterations_{box}_{'stiff' if stiff else 'soft'}_{n}"
    return Case(name, options, _measure_iterations, may_fail=True)


def _measure_work(series: Series, folder: Path) -> dict[str, object]:
    later = np.s_[1:] if len(series["time"]) < 5 else np.s_[3:]  # after the first two steps, if there are more
    return {
        "nsolve": series["nsolve"][later].mean(),
        "seconds": float(np.median(series["wall"][later])),
        "its": (series["coupled_its"] + series["tension_its"])[later].mean(),
    }


def work(scheme: str, n: int, ranks: int) -> Case:
    """Return a timed run of a relaxing ellipse, dt = h, twelve steps."""
    options = ELLIPSE | cells(2 * n) | words(f"-time_step {1 / n!r} -time_end {12 / n!r} -scheme_type {scheme}")
    options |= {} if scheme == "split" else EULER
    return Case(f"work_{scheme}_{n}_{ranks}", options, _measure_work, ranks=ranks, may_fail=True)


def _measure_start(series: Series, folder: Path) -> dict[str, object]:
    length = np.abs(series["length_error"])
    return {
        "length_peak": length.max(),
        "length_end": length[-1],
        "edge_peak": series["edge_ratio"].max(),
        "edge_end": series["edge_ratio"][-1],
    }


SHEAR_RATE = 0.326116  # chi = 10 for area 1, V = 0.7, nu = 1, c_b = 0.01
START_SCENES = {
    "relaxing ellipse": ELLIPSE | cells(128) | words(f"-time_step {1 / 64!r} -time_end 1"),
    "shear": PAPER_MEMBRANE
    | words(
        f"-domain_box 0,8,0,8 -domain_cells 128,128 -flow_type shear -flow_rate {SHEAR_RATE!r} -flow_center_y 4 "
        "-vesicle_area 1 -vesicle_reduced_area 0.7 -vesicle_center 4,4 -vesicle_spacing 1.5 "
        f"-time_step {0.05 / SHEAR_RATE!r} -time_end {10 / SHEAR_RATE!r} -output_every 1000 -checkpoint_every 0"
    ),
}


def start(scene: str, startup: str, rtol: str) -> Case:
    """Return a run that shows what the start-up leaves: scene is a key of START_SCENES."""
    options = START_SCENES[scene] | coupled(2, rtol) | {"-scheme_startup": startup}
    return Case(f"start_{scene.split()[0]}_{startup}_{rtol}", options, _measure_start)
