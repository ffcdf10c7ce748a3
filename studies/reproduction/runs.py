"""The runs of sections 5.1 to 5.3 by the paper's method: what is kept of each."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from studies.common.engine import Case, Series
from studies.common.scenes import CELLS, ILU, TIGHT, TIGHT_SPLIT, ellipse, words

LENGTH = 2.3013  # of the ellipse (0.2, 0.5)
NEVER = "1e-50"  # relative tolerance that only an absolute test can meet first
NONE = words("-tension_pc_type none")
LEFT = words("-tension_ksp_pc_side left")  # PETSc's default test, which the paper's iterations are compared with
ENERGY_ROWS = 240  # rows kept of an energy curve


def iterations(kind: str, n: int) -> dict[str, Case]:
    """Return the runs behind one line of Table 4 (relax) or 8 (shear): our stopping tests by name."""
    dt = (0.5 if kind == "relax" else 0.25) / n
    base = ellipse(kind, n, n, dt) | LEFT
    ds, h2 = LENGTH / n, 1 / n**2
    # an l2 norm over edges times sqrt(ds) is the L2 norm along the membrane; a residual r leaves the surface
    # divergence h^2 dt r/ds
    tension, residual = h2 / ds**0.5, h2 / ds**0.5 * ds / (h2 * dt)
    tests = {
        "none": NONE | {"-tension_ksp_rtol": repr(h2)},
        "ilu": ILU | {"-tension_ksp_rtol": repr(h2)},
        "tight": ILU | {"-tension_ksp_rtol": TIGHT},
        "none_absolute": NONE | {"-tension_ksp_rtol": NEVER, "-tension_ksp_atol": repr(residual)},
        "ilu_absolute": ILU | {"-tension_ksp_rtol": NEVER, "-tension_ksp_atol": repr(tension)},
    }
    return {name: Case(f"{kind}_{n}_{name}", base | more, _measure, ranks=0) for name, more in tests.items()}


def energy(n: int) -> dict[str, Case]:
    """Return the runs of section 5.1 by time step; markers 1.75 h apart."""
    markers = 2 * round(LENGTH * n / 3.5)
    found = {}
    for name, dt in {"h": 1 / n, "h/2": 0.5 / n, "h^2": 1 / n**2}.items():
        options = ellipse("energy", n, markers, dt) | ILU | TIGHT_SPLIT
        found[name] = Case(f"energy_{n}_{name.replace('/', '_')}", options, decay, ranks=0)
    return found


def energy_start(n: int, name: str) -> Case:
    """Return the first t = 1/8 of a run of section 5.1, dt = h or h/2."""

    def measure(series: Series, folder: Path) -> dict[str, object]:
        total = relative_energy(series)
        rise = np.diff(total)
        found = {"rise": list(rise[:3]), "largest": rise.max(), "step": int(rise.argmax()) + 1}
        return found | {"peak": total.max(), "end": total[-1]}

    options = energy(n)[name].options | {"-time_end": "0.125"}
    return Case(f"energy_start_{n}_{name.replace('/', '_')}", options, measure)


def sizes(quick: bool) -> tuple[int, ...]:
    """Return the values of 1/h."""
    return CELLS[:2] if quick else CELLS


def relative_energy(series: Series) -> np.ndarray:
    """Return the energy over the first."""
    total = series["energy_kinetic"] + series["energy_bending"]
    return total / total[0]


def _measure(series: Series, folder: Path) -> dict[str, object]:
    """Return what the tables need of one run."""
    found = {"steps": len(series["time"]) - 1}
    found |= {name: series[name][-1] for name in ("area_error", "length_error")}
    found |= {name: series[name][1:].mean() for name in ("tension_its", "bending_its")}
    found |= {name: series[name].max() for name in ("div_max", "surface_div_max")}
    return found | {"step_seconds": series["wall"].sum()}


def decay(series: Series, folder: Path) -> dict[str, object]:
    """Return _measure, and the energy against time."""
    total = relative_energy(series)
    rise, every = np.diff(total), max(1, len(total) // ENERGY_ROWS)
    return _measure(series, folder) | {
        "rise_first_two": list(rise[:2]),
        "rise_later": rise[2:].max(),
        "time": [round(t, 6) for t in series["time"][::every]],
        "energy": [round(e, 6) for e in total[::every]],
    }
