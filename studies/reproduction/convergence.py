"""Self-convergence of sections 5.2 and 5.3: differences from a run on a finer grid, and from a fine coupled run."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

import numpy as np

from studies.accuracy.runs import trigonometric
from studies.common.paper import CELLS
from petves.run import Run
from studies.common.engine import ILU, MARKERS_TABLE_7, Case, Results, scene

EULERIAN, LAGRANGIAN = ("u", "v", "p", "dp"), ("X", "Y", "sigma", "sigma_half")
QUICK_REFERENCE = {"relax": 256, "shear": 128}
"""1/h of the finer run in quick mode; 512 otherwise, as in the paper."""

State = dict[str, np.ndarray]


def split_options(kind: str, n: int) -> dict[str, str]:
    """Return section 5.2's run (relax, 1/h markers, dt = h/2) or 5.3's (shear, 1.5 h apart, dt = h/4) on h = 1/n.

    GMRES stops at h^2, split's default. The state before the last step is saved too.
    """
    markers = n if kind == "relax" else MARKERS_TABLE_7.get(n, 2 * MARKERS_TABLE_7[256])
    dt, end = (0.5, 1) if kind == "relax" else (0.25, 5)
    return scene(kind, n, markers, dt / n) | ILU | {"-output_every": repr(end - dt / n)}


def fine_options(kind: str) -> dict[str, str]:
    """Return the coupled run that stands for the truth: default corrections, small steps."""
    n, tolerance = {"relax": (128, "1e-6"), "shear": (96, "1e-5")}[kind]
    options = scene(kind, n, 0, 0.02)
    del options["-vesicle_markers"]
    adapt = {"-time_adapt": "error", "-time_adapt_tol": tolerance, "-time_step": "0.02", "-scheme_order": "2"}
    return options | {"-scheme_type": "coupled", "-fluid_inertia": "unsteady"} | adapt


def state(series: dict[str, np.ndarray], folder: Path) -> State:
    """Return what a run ends with: fields at cell centres, dp of the last two saved times, markers, tension, frequency."""
    run = Run.read(folder)
    u, v, p = run.fields(-1)
    last = {"markers": run.markers[-1], "tension": run.tension[-1], "omega": series["frequency"][-1]}
    last["dp"] = p - run.fields(-2)[2]
    last["dp"] -= last["dp"].mean()
    return {"u": u, "v": v, "p": p - p.mean()} | {key: np.asarray(value) for key, value in last.items()}


def at(values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return periodic values, shape (n, 2) at 0, 1/n, ..., at places in turns: trigonometric, then linear."""
    fine = trigonometric(values, 2**14)
    turns = np.arange(len(fine) + 1) / len(fine)
    return np.stack([np.interp(place % 1, turns, np.append(x, x[0])) for x in fine.T], axis=1)


def differences(coarse: State, fine: State, h: float) -> dict[str, float]:
    """Return L2 norms over the box (EULERIAN) and along the membrane (LAGRANGIAN), and |omega - omega_ref|.

    sigma_half: tension of edges beside the finer run's half an edge further on.
    """
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
    tension = [pairs[1][:, 0] - at(pairs[0], edges + shift / n)[:, 0] for shift in (0, 0.5)]
    for name, values in zip(LAGRANGIAN, (*position.T, *tension)):
        found[name] = np.sqrt((values**2).mean() * length)
    omega = abs(float(coarse["omega"] - fine["omega"]))
    return found | ({} if np.isnan(omega) else {"omega": omega})


def reference(results: Results, name: str, options: dict[str, str], keep: Callable = state) -> State:
    """Return what `keep` takes of a reference run, from fields/ beside the results; run it when it is not there."""
    path = results.path.parent / "fields" / f"{name}.npz"

    def measure(series: dict[str, np.ndarray], folder: Path) -> dict[str, object]:
        path.parent.mkdir(exist_ok=True)
        np.savez(path, **keep(series, folder))
        ends = {key: abs(series[key][-1]) for key in ("area_error", "length_error")}
        return {"steps": len(series["time"]) - 1} | ends | {"step_seconds": series["wall"].sum()}

    if not path.is_file():
        results.cases.pop(name, None)
    results.get(Case(name, options, measure, ranks=1))
    return dict(np.load(path))


def split_state(results: Results, kind: str, n: int) -> State:
    """Return the end of the paper's run on h = 1/n."""
    return reference(results, f"split_{kind}_{n}", split_options(kind, n))


def truth(results: Results, kind: str) -> State:
    """Return the end of the fine coupled run."""
    return reference(results, f"truth_{kind}", fine_options(kind))


def itself(results: Results, kind: str, n: int, finer: int) -> dict[str, object]:
    """Return the run on h = 1/n against the same method on h = 1/finer: differences, errors of area and length."""

    def measure() -> dict[str, object]:
        own, fine = (split_state(results, kind, cells) for cells in (n, finer))
        return {"itself": differences(own, fine, 1 / n)}

    options = split_options(kind, n)
    found = results.derive(f"convergence_{kind}_{n}_{finer}", options | {"finer": str(finer)}, measure)
    return found | results.cases[f"split_{kind}_{n}"]["measures"]


def finest(results: Results, kind: str, quick: bool) -> int:
    """Return 1/h of the finer run: 512; in quick mode the finest that is there, QUICK_REFERENCE at least."""
    there = [n for n in (512, 256) if f"split_{kind}_{n}" in results.cases] if quick else [512]
    return max([*there, QUICK_REFERENCE[kind]])
