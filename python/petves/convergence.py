"""Self-convergence of sections 5.2 and 5.3: differences from a run on a finer grid, and from a fine coupled run."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

import numpy as np

from petves.accuracy_studies import trigonometric
from petves.paper import CELLS
from petves.run import Run
from petves.studies import ILU, MARKERS_TABLE_7, TIGHT, Case, Results, scene

EULERIAN, LAGRANGIAN = ("u", "v", "p"), ("X", "Y", "sigma")
QUICK_REFERENCE = {"relax": 256, "shear": 128}
"""1/h of the finer run in quick mode; 512 otherwise, as in the paper."""

State = dict[str, np.ndarray]


def split_options(kind: str, n: int) -> dict[str, str]:
    """Return section 5.2's run (relax, 1/h markers, dt = h/2) or 5.3's (shear, 1.5 h apart, dt = h/4) on h = 1/n."""
    markers = n if kind == "relax" else MARKERS_TABLE_7.get(n, 2 * MARKERS_TABLE_7[256])
    tight = {"-tension_ksp_rtol": TIGHT, "-bending_ksp_rtol": TIGHT}
    return scene(kind, n, markers, (0.5 if kind == "relax" else 0.25) / n) | ILU | tight


def fine_options(kind: str) -> dict[str, str]:
    """Return the coupled run that stands for the truth: default corrections, small steps."""
    n, tolerance = {"relax": (128, "1e-6"), "shear": (96, "1e-5")}[kind]
    options = scene(kind, n, 0, 0.02)
    del options["-vesicle_markers"]
    adapt = {"-time_adapt": "error", "-time_adapt_tol": tolerance, "-time_step": "0.02", "-scheme_order": "2"}
    return options | {"-scheme_type": "coupled", "-fluid_inertia": "unsteady"} | adapt


def state(series: dict[str, np.ndarray], folder: Path) -> State:
    """Return the fields at cell centres, markers, tension and frequency at the end of a run."""
    run = Run.read(folder)
    u, v, p = run.fields(-1)
    last = {"markers": run.markers[-1], "tension": run.tension[-1], "omega": series["frequency"][-1]}
    return {"u": u, "v": v, "p": p - p.mean()} | {key: np.asarray(value) for key, value in last.items()}


def at(values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return periodic values, shape (n, 2) at 0, 1/n, ..., at places in turns: trigonometric, then linear."""
    fine = trigonometric(values, 2**14)
    turns = np.arange(len(fine) + 1) / len(fine)
    return np.stack([np.interp(place % 1, turns, np.append(x, x[0])) for x in fine.T], axis=1)


def differences(coarse: State, fine: State, h: float) -> dict[str, float]:
    """Return L2 norms over the box (u, v, p) and along the membrane (X, Y, sigma), and |omega - omega_ref|."""
    found = {}
    for name in EULERIAN:
        ratio, half = len(fine[name]) // len(coarse[name]), len(fine[name]) // len(coarse[name]) // 2
        if ratio * len(coarse[name]) == len(fine[name]) and ratio % 2 == 0:  # centres of coarse cells are fine corners
            near = [fine[name][half - a :: ratio, half - b :: ratio] for a in (0, 1) for b in (0, 1)]
            found[name] = h * np.sqrt(((coarse[name] - sum(near) / 4) ** 2).sum())
    n, m = len(coarse["markers"]), len(fine["markers"])
    length = np.hypot(*(np.roll(coarse["markers"], 1, axis=0) - coarse["markers"]).T).sum()
    position = coarse["markers"] - at(fine["markers"], np.arange(n) / n)
    edges = (np.arange(n) - 0.5) / n + 0.5 / m  # edge k lies before marker k
    pairs = [np.stack([x, 0 * x], axis=1) for x in (fine["tension"], coarse["tension"])]
    tension = pairs[1][:, 0] - at(pairs[0], edges)[:, 0]
    for name, values in zip(LAGRANGIAN, (*position.T, tension)):
        found[name] = np.sqrt((values**2).mean() * length)
    omega = abs(float(coarse["omega"] - fine["omega"]))
    return found | ({} if np.isnan(omega) else {"omega": omega})


def reference(results: Results, name: str, options: dict[str, str]) -> State:
    """Return the state of a reference run, kept in the folder fields/ beside the results; run it when it is not there."""
    path = results.path.parent / "fields" / f"{name}.npz"

    def measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
        path.parent.mkdir(exist_ok=True)
        np.savez(path, **state(series, folder))
        return {"steps": len(series["time"]) - 1, "step_seconds": series["wall"].sum()}

    if not path.is_file():
        results.cases.pop(name, None)
    results.get(Case(name, options, measure, ranks=1))
    return dict(np.load(path))


def split_case(results: Results, kind: str, n: int, finer: int) -> Case:
    """Return the run on h = 1/n, measured against the same method on h = 1/finer and against the fine coupled run."""

    def measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
        own = state(series, folder)
        itself = reference(results, f"finest_{kind}_{finer}", split_options(kind, finer))
        found = {"itself": differences(own, itself, 1 / n), "steps": len(series["time"]) - 1}
        found["truth"] = differences(own, reference(results, f"truth_{kind}", fine_options(kind)), 1 / n)
        ends = {key: abs(series[key][-1]) for key in ("area_error", "length_error")}
        return found | ends | {"step_seconds": series["wall"].sum()}

    return Case(f"convergence_{kind}_{n}_{finer}", split_options(kind, n), measure, ranks=1)


def ours(results: Results, kind: str, options: dict[str, str], name: str) -> Case:
    """Return a run of the default scheme, measured against the fine coupled run."""

    def measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
        run, own = Run.read(folder), state(series, folder)
        truth = differences(own, reference(results, f"truth_{kind}", fine_options(kind)), run.h)
        ends = {key: abs(series[key][-1]) for key in ("area_error", "length_error")}
        return {"truth": truth, "steps": len(series["time"]) - 1} | ends | {"step_seconds": series["wall"].sum()}

    return Case(f"ours_{kind}_{name}", options, measure, ranks=1)


def finest(results: Results, kind: str, quick: bool) -> int:
    """Return 1/h of the finer run: 512; in quick mode the finest whose comparisons are there, or QUICK_REFERENCE."""
    if not quick:
        return 512
    case: Callable[[int, int], Case] = lambda n, finer: split_case(results, kind, n, finer)
    whole = [finer for finer in (512, 256) if all(results.has(case(n, finer)) for n in CELLS if n < finer)]
    return max([*whole, QUICK_REFERENCE[kind]])
