"""The runs behind the coupled scheme's study: their options and what is kept of each."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

from studies.common.engine import TIGHT, Case

PAPER_MEMBRANE = {
    "-delta_type": "ib6",
    "-membrane_derivative": "fd",
    "-coupling_self_mobility": "none",
    "-scheme_area_target": "false",
}
"""The paper's membrane: what is compared here are the schemes, not the discretisations of a membrane."""
ELLIPSE = PAPER_MEMBRANE | {
    "-domain_box": "-1,1,-1,1",
    "-vesicle_semi_axes": "0.2,0.5",
    "-output_every": "1000",
    "-checkpoint_every": "0",
}
STIFFNESS, ENERGY_STEPS = (0.01, 1.0, 100.0), (1 / 32, 1 / 8, 1 / 2, 2.0)
STEPS_OF_ENERGY_RUN = 24
SPLIT = {"-scheme_type": "split", "-tension_ksp_rtol": TIGHT, "-bending_ksp_rtol": TIGHT}
OFF = {"-scheme_length_target": "false"}
EULER = {"-scheme_startup": "euler"}
BOXES = {"periodic": ("periodic", "periodic"), "channel": ("periodic", "wall"), "walls": ("wall", "wall")}
MOBILITIES = ("table", "ilu", "none")
TOLERANCES = (*(1e-2 / 2**k for k in range(11)), 1e-6)
STEPS = (32, 64, 128, 256)
"""1/dt of the table of temporal errors."""


def coupled(order: int, rtol: str = TIGHT) -> dict[str, str]:
    """Return the options of the coupled scheme at one order and tolerance."""
    return {"-scheme_type": "coupled", "-scheme_order": str(order), "-coupled_ksp_rtol": rtol}


def _cells(n: int) -> dict[str, str]:
    """Return the cells of the box [-1,1]^2 with h = 1/n."""
    return {"-domain_cells": f"{2 * n},{2 * n}"}


def _measure_energy(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
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
    options = ELLIPSE | _cells(32) | ENERGY_SCHEMES[scheme]
    options |= {"-vesicle_markers": "36", "-vesicle_bending": repr(bending)}
    options |= {"-time_step": repr(dt), "-time_end": repr(STEPS_OF_ENERGY_RUN * dt), "-output_every": "100000"}
    return Case(f"sweep_{scheme}_{bending:g}_{dt:g}", options, _measure_energy, ranks=1, may_fail=True)


def _measure_markers(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    with h5py.File(folder / "checkpoint.h5") as file:
        markers = np.ravel(file["vesicle/markers"][:])
    found = {"steps": len(series["time"]) - 1, "time": series["time"][-1], "nsolve": series["nsolve"][1:].sum()}
    return found | {"dt_max": series["dt"][1:].max(), "markers": list(markers)}


TEMPORAL_SCHEMES = {
    "split": SPLIT,
    "coupled, order 1": coupled(1) | OFF,
    "coupled, order 2, euler start": coupled(2) | OFF | EULER,
    "coupled, order 2, graded start": coupled(2) | OFF,
}


def temporal(scheme: str, steps: int) -> Case:
    """Return a run to t = 0.25 with dt = 1/steps, length target off; scheme is a key of TEMPORAL_SCHEMES."""
    options = ELLIPSE | _cells(32) | TEMPORAL_SCHEMES[scheme]
    options |= {"-vesicle_markers": "36", "-time_step": repr(1 / steps), "-time_end": "0.25"}
    return Case(f"temporal_{scheme.replace(', ', '_').replace(' ', '_')}_{steps}", options, _measure_markers, ranks=1)


def reference() -> Case:
    """Return the run that temporal errors are measured against."""
    return temporal("coupled, order 2, graded start", 1024)


def adaptive(tolerance: float) -> Case:
    """Return a run to t = 0.25 with step-size control, length target off."""
    options = ELLIPSE | _cells(32) | coupled(2, "1e-10") | OFF
    options |= {"-vesicle_markers": "36", "-time_step": "0.03125", "-time_end": "0.25"}
    options |= {"-time_adapt": "error", "-time_adapt_tol": repr(tolerance)}
    return Case(f"adaptive_{tolerance:g}", options, _measure_markers, ranks=1)


def _measure_iterations(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    its = series["coupled_its"][2:]  # the first row is the start, the next one the graded start's five solves
    return {"mean": its.mean(), "min": its.min(), "max": its.max(), "first": series["coupled_its"][1]}


STIFF = {False: "dt = h, c_b = 0.01", True: "dt = 1/4, c_b = 1"}


def iterations(box: str, stiff: bool, mobility: str, n: int) -> Case:
    """Return a run of six steps from a zero guess: box is a key of BOXES, stiff one of STIFF."""
    dt, bending = (0.25, 1.0) if stiff else (1 / n, 0.01)
    options = ELLIPSE | _cells(n) | dict(zip(("-domain_bc_x", "-domain_bc_y"), BOXES[box])) | coupled(2, "1e-6")
    options |= {"-vesicle_bending": repr(bending), "-time_step": repr(dt), "-time_end": repr(6 * dt)}
    options |= {"-mobility_type": mobility, "-coupled_ksp_initial_guess_nonzero": "false"}
    if mobility == "ilu":  # the fill of split's tension solve
        options |= {"-coupled_mobility_pc_factor_levels": "200", "-coupled_mobility_pc_factor_mat_ordering_type": "nd"}
    name = f"iterations_{box}_{'stiff' if stiff else 'soft'}_{mobility}_{n}"
    return Case(name, options, _measure_iterations, ranks=1, may_fail=True)


def _measure_work(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    later = np.s_[1:] if len(series["time"]) < 5 else np.s_[3:]  # after the first two steps, if there are more
    return {
        "nsolve": series["nsolve"][later].mean(),
        "seconds": float(np.median(series["wall"][later])),
        "its": (series["coupled_its"] + series["tension_its"])[later].mean(),
    }


def work(scheme: str, n: int, ranks: int) -> Case:
    """Return a timed run of a relaxing ellipse, dt = h: twelve steps, three with scheme direct."""
    steps = 3 if scheme == "direct" else 12
    options = ELLIPSE | _cells(n) | {"-time_step": repr(1 / n), "-time_end": repr(steps / n), "-scheme_type": scheme}
    if scheme != "split":
        options |= EULER
    return Case(f"work_{scheme}_{n}_{ranks}", options, _measure_work, ranks=ranks, may_fail=True)


def _measure_start(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
    length = np.abs(series["length_error"])
    return {
        "length_peak": length.max(),
        "length_end": length[-1],
        "edge_peak": series["edge_ratio"].max(),
        "edge_end": series["edge_ratio"][-1],
    }


SHEAR_RATE = 0.326116  # chi = 10 for area 1, V = 0.7, nu = 1, c_b = 0.01
START_SCENES = {
    "relaxing ellipse": ELLIPSE | _cells(64) | {"-time_step": repr(1 / 64), "-time_end": "1"},
    "shear": PAPER_MEMBRANE
    | {
        "-domain_box": "0,8,0,8",
        "-domain_cells": "128,128",
        "-flow_type": "shear",
        "-flow_rate": repr(SHEAR_RATE),
        "-flow_center_y": "4",
        "-vesicle_area": "1",
        "-vesicle_reduced_area": "0.7",
        "-vesicle_center": "4,4",
        "-vesicle_spacing": "1.5",
        "-time_step": repr(0.05 / SHEAR_RATE),
        "-time_end": repr(10 / SHEAR_RATE),
        "-output_every": "1000",
        "-checkpoint_every": "0",
    },
}


def start(scene: str, startup: str, rtol: str) -> Case:
    """Return a run that shows what the start-up leaves: scene is a key of START_SCENES."""
    options = START_SCENES[scene] | coupled(2, rtol) | {"-scheme_startup": startup}
    return Case(f"start_{scene.split()[0]}_{startup}_{rtol}", options, _measure_start, ranks=1)
