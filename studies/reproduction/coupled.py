"""Run the coupled scheme's study and write its tables and pictures."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from studies.common.tables import table, write_csv
from petves.views.plot import dress, new_figure, save_figure
from studies.common.engine import Results
from studies.reproduction import coupled_runs as study

PROTOTYPE_COLUMNS = ("split", "1", "2_euler", "1_target", "2_target_euler")
PROTOTYPE = {
    (0.01, 1 / 32): (6.9e-4, -1.1e-3, -1e-3, -1.1e-3, -9.9e-4),
    (0.01, 1 / 8): (0.047, -1.2e-5, -3.6e-6, -1.2e-5, -3.5e-6),
    (0.01, 1 / 2): (0.39, -3.6e-6, 3.8e-4, -3.4e-6, -3.4e-6),
    (0.01, 2.0): (1.7, -1.5e-5, 8.2e-3, -1.4e-5, 1.6e-3),
    (1.0, 1 / 32): (1.6, -2.4e-5, 9.6e-3, -2.1e-5, 2e-3),
    (1.0, 1 / 8): (6.0, -9.6e-5, 0.012, -8.5e-5, 1.1e-3),
    (1.0, 1 / 2): (9.0, -3.8e-4, 0.013, -3.4e-4, 1.7e-4),
    (1.0, 2.0): (9.5, -1.5e-3, 0.011, -1.3e-3, -1.2e-3),
    (100.0, 1 / 32): (21.0, -2.3e-3, 0.01, -2e-3, -2e-3),
    (100.0, 1 / 8): (16.0, -8.2e-3, 6.9e-4, -7.4e-3, -7.5e-3),
    (100.0, 1 / 2): (11.0, 1.1e-8, 2.4e-3, 5.7e-10, 8.1e-4),
    (100.0, 2.0): (9.9, 1e-8, 6.2e-3, 1.5e-7, 3.8e-3),
}
"""Largest rise of the energy in a step of an independent NumPy prototype, by (c_b, dt)."""

ENERGY_LABELS = {
    "split": "split",
    "1": "order 1, off",
    "1_loose": "order 1, off, rtol 1e-6",
    "2": "order 2, off",
    "2_euler": "order 2, off, euler start",
    "1_target": "order 1, on",
    "2_target": "order 2, on",
    "2_target_euler": "order 2, on, euler start",
}
FIGURE_STYLES = ("s-", "o-", "^:", "v--")


def coupled_results(folder: Path, quick: bool) -> Path:
    """Run what is not there yet; write coupled_*.csv, a picture and coupled.md. Quick: no iterations at h = 1/256."""
    results = Results(folder / "coupled.json")
    text = [_head(quick), *_energy(results, folder), *_temporal(results, folder)]
    text += _iterations(results, folder, (32, 64, 128) if quick else (32, 64, 128, 256))
    text += _work(results, folder, (64, 128, 256))
    text += _start(results, folder)
    path = folder / "coupled.md"
    path.write_text("\n".join(text))
    return path


def _head(quick: bool) -> str:
    command = "make reproduce QUICK=1" if quick else "make reproduce"
    return (
        "# The coupled scheme, measured\n\n"
        "Ellipse with semi-axes 0.2 and 0.5 in [-1,1]^2, nu = 1, c_b = 0.01 unless given, walls unless given; the paper's\n"
        "membrane (kernel ib6, finite differences, no near field, no area target).\n"
        f"Written by `{command}` (`python3 -m studies reproduce DIR --only coupled`); coupled.json holds every run's options.\n"
    )


def _energy(results: Results, folder: Path) -> list[str]:
    """The energy sweep: tables of largest rises, one of final energies."""
    cells = list(product(study.STIFFNESS, study.ENERGY_STEPS))
    found = {(name, *cell): results.get(study.energy_sweep(name, *cell)) for name in ENERGY_LABELS for cell in cells}
    keys = ("ratio", "rise", "rise_later", "length", "area", "coupled_its")
    rows = [
        [c, dt, name, *(found[name, c, dt].get(k, "failed") for k in keys)] for c, dt in cells for name in ENERGY_LABELS
    ]
    write_csv(folder / "coupled_energy.csv", ["c_b", "dt", "scheme", *keys], rows)

    def shown(key: str, name: str, cell: tuple[float, float], form: str) -> str:
        measures = found[(name, *cell)]
        text = "stopped" if "failed" in measures else format(measures[key], form)
        if name in PROTOTYPE_COLUMNS and key == "rise":
            text += f" ({format(PROTOTYPE[cell][PROTOTYPE_COLUMNS.index(name)], form)})"
        return text

    def block(key: str, names: tuple[str, ...], form: str) -> list[str]:
        body = [[f"{c:g}", f"{dt:g}", *(shown(key, name, (c, dt), form) for name in names)] for c, dt in cells]
        return table(["c_b", "dt", *(ENERGY_LABELS[name] for name in names)], body)

    about = (
        f"h = 1/32, 36 markers, {study.STEPS_OF_ENERGY_RUN} steps, tolerances 1e-12 unless given. On and off: the length target. In brackets an\n"
        "independent NumPy prototype (its coupled runs stop at 1e-8 or so). `stopped`: a solve failed, or the membrane crossed itself. Runs of split that blow up depend on\n"
        "rounding. With order 2 the energy that never rises is the G-norm's ([steps.md](../steps.md#energy)), not this one.\n"
        "coupled_energy.csv also has lengths and areas.\n\n"
        "Largest change of E/E_0 in a step (negative: it fell in every step):\n"
    )
    return [
        "## Energy\n",
        about,
        *block("rise", ("split", "1_loose", "1", "1_target"), "+.1e"),
        *block("rise", ("2", "2_euler", "2_target", "2_target_euler"), "+.1e"),
        "Where dt is far above the membrane's own time, a step of order 2 extrapolates a motion that has ended within it. Such steps are made\n"
        "again by backward Euler ([steps.md](../steps.md#which-order)); the prototype does not do that.\n",
        "E/E_0 after the last step:\n",
        *block("ratio", ("split", "1", "1_target", "2", "2_target"), ".3g"),
    ]


def _distance(a: dict, b: dict) -> float:
    """Root mean square distance of markers."""
    difference = np.reshape(a["markers"], (-1, 2)) - np.reshape(b["markers"], (-1, 2))
    return float(np.sqrt((difference**2).sum(1).mean()))


def _temporal(results: Results, folder: Path) -> list[str]:
    exact = results.get(study.reference())
    rows, shown, curves = [], [], {}
    for scheme in study.TEMPORAL_SCHEMES:
        found = [results.get(study.temporal(scheme, k)) for k in study.STEPS]
        errors = [_distance(one, exact) for one in found]
        orders = [np.log2(a / b) for a, b in zip(errors, errors[1:])]
        curves[scheme] = errors
        rows += [[scheme, 1 / k, e, one["nsolve"]] for k, e, one in zip(study.STEPS, errors, found)]
        shown.append([scheme, *(f"{e:.2e}" for e in errors), ", ".join(f"{q:.2f}" for q in orders)])
    lines = table(["", *(f"dt = 1/{k}" for k in study.STEPS), "observed order"], shown)
    adaptive = [results.get(study.adaptive(tolerance)) for tolerance in study.TOLERANCES]
    errors = [_distance(one, exact) for one in adaptive]
    steps, solves = ([one[key] for one in adaptive] for key in ("steps", "nsolve"))
    write_csv(folder / "coupled_temporal.csv", ["scheme", "dt", "error", "nsolve"], rows)
    numbers = list(zip(study.TOLERANCES, errors, steps, solves))
    write_csv(folder / "coupled_adaptive.csv", ["tolerance", "error", "steps", "nsolve"], numbers)
    factors = ["", *(f"{a / b:.2f}" for a, b in zip(errors, errors[1:]))]
    adapted = [[f"{t:.3g}", f"{e:.2e}", f, str(n), f"{s:.0f}"] for (t, e, n, s), f in zip(numbers, factors)]
    _draw_temporal(folder, curves, errors, solves, rows)
    about = (
        "h = 1/32, 36 markers, t = 0.25, length target off, tolerances 1e-12: root mean square distance of markers from those of\n"
        "coupled, order 2 with dt = 1/1024.\n"
    )
    control = (
        "Step-size control (`-time_adapt error`), the same error; `-coupled_ksp_rtol 1e-10`, `-time_step 1/32`. From row to row the\n"
        "tolerance is halved (the last row: about a tenth), and `factor` is what the error is divided by. The reference's own\n"
        "error is about 2e-8, by extrapolation of the table above.\n"
    )
    return [
        "## Error in time\n",
        about,
        *lines,
        control,
        *table(["`-time_adapt_tol`", "error", "factor", "steps", "fast solves"], adapted),
        "![Error against step, against tolerance and against work](coupled_temporal.png)\n",
    ]


def _draw_temporal(
    folder: Path, curves: dict[str, list[float]], errors: list[float], solves: list[float], rows: list[list]
) -> None:
    """Draw the errors against the step, against the tolerance and against the fast solves."""
    tolerances = study.TOLERANCES
    figure, axes = new_figure(13, 4.2, columns=3)
    steps = np.array([1 / k for k in study.STEPS])
    for (name, values), style in zip(curves.items(), FIGURE_STYLES):
        axes[0].loglog(steps, values, style, ms=4, lw=1.2, label=name)
        work = [row[3] for row in rows if row[0] == name]
        axes[2].loglog(work, values, style, ms=4, lw=1.2, label=name)
    axes[0].loglog(steps, 1.6e-4 * steps * 32, "k:", lw=0.8, label="slopes 1 and 2")
    axes[0].loglog(steps, 1.2e-5 * (steps * 32) ** 2, "k:", lw=0.8)
    axes[1].loglog(tolerances, errors, "o-", ms=4, lw=1.2, label="coupled, order 2, adaptive")
    axes[1].loglog(tolerances, np.array(tolerances) * errors[0] / tolerances[0], "k:", lw=0.8, label="slope 1")
    axes[2].loglog(solves, errors, "k.-", lw=1.2, label="coupled, order 2, adaptive")
    for panel, label in zip(axes, (r"time step $\Delta t$", "-time_adapt_tol", "scalar fast solves in the run")):
        dress(panel, 7, "both", xlabel=label, ylabel="rms marker distance (length)")
    save_figure(figure, folder / "coupled_temporal.png")


def _iterations(results: Results, folder: Path, sizes: tuple[int, ...]) -> list[str]:
    rows, lines = [], []
    for stiff, name in study.STIFF.items():
        shown = []
        for box in study.BOXES:
            found = [results.get(study.iterations(box, stiff, n)) for n in sizes]
            rows += [
                [name, box, f"1/{n}", *(one.get(key, "> 200") for key in ("mean", "min", "max"))]
                for n, one in zip(sizes, found)
            ]
            texts = [
                "> 200" if "failed" in one else f"{one['mean']:.1f} ({one['min']:.0f} to {one['max']:.0f})"
                for one in found
            ]
            shown.append([box, *texts])
        lines += [f"{name}:\n", *table(["box", *(f"h = 1/{n}" for n in sizes)], shown)]
    write_csv(folder / "coupled_iterations.csv", ["case", "box", "h", "mean", "least", "largest"], rows)
    about = (
        "FGMRES to 1e-6 from a zero guess (`-coupled_ksp_initial_guess_nonzero false`), order 2, markers 1.75 h apart, six\n"
        "steps: mean, least and largest of steps 2 to 6. The dense factors are kept over steps until the\n"
        "iterations that they cost more than new ones add up to the price of new ones. A step made again by backward Euler has the\n"
        "iterations of both. `> 200`: a solve did not end in 200 (restart 60).\n"
    )
    return ["## Iterations\n", about, *lines]


def _work(results: Results, folder: Path, sizes: tuple[int, ...]) -> list[str]:
    """Return the cost of a step."""
    rows, shown = [], []
    for n, ranks in product(sizes, (1, 2)):
        split = results.get(study.work("split", n, ranks))
        for scheme in ("split", "coupled"):
            one = results.get(study.work(scheme, n, ranks))
            if "failed" in one:
                shown.append([f"{2 * n}^2", str(ranks), scheme, "stopped", "", ""])
                continue
            ratio = one["seconds"] / split["seconds"]
            rows.append([2 * n, ranks, scheme, one["nsolve"], one["its"], one["seconds"], ratio])
            shown.append(
                [f"{2 * n}^2", str(ranks), scheme, f"{one['nsolve']:.1f}", f"{one['its']:.1f}", f"{ratio:.2f}"]
            )
    write_csv(folder / "coupled_work.csv", ["cells", "ranks", "scheme", "nsolve", "its", "seconds", "over_split"], rows)
    about = (
        "Relaxing ellipse, dt = h, default tolerances (split h^2, coupled 1e-6), order 2 with the extrapolated guess; twelve steps,\n"
        "median of those after the second. Scalar fast solves in a step, iterations (split: of the tension\n"
        "solve), and seconds a step over split's on the same grid and ranks. The Green's table (six solves once) is not counted.\n"
    )
    header = ["cells", "ranks", "scheme", "fast solves", "iterations", "time over split"]
    return ["## Work\n", about, *table(header, shown)]


def _start(results: Results, folder: Path) -> list[str]:
    rows, shown = [], []
    for scene, startup, rtol in product(study.START_SCENES, ("euler", "graded"), ("1e-6", "1e-10")):
        one = results.get(study.start(scene, startup, rtol))
        values = [one["length_peak"], one["length_end"], one["edge_peak"] - 1, one["edge_end"] - 1]
        rows.append([scene, startup, rtol, *values])
        shown.append([scene, startup, rtol, *(f"{x:.1e}" for x in values)])
    keys = ["length_error_peak", "length_error_end", "edge_ratio_peak_minus_1", "edge_ratio_end_minus_1"]
    write_csv(folder / "coupled_start.csv", ["scene", "startup", "rtol", *keys], rows)
    about = (
        "Order 2, length target on. Relaxing ellipse: h = 1/64, dt = h, t = 1. Shear: 8 x 8 box, 128^2, V = 0.7, chi = 10,\n"
        "rate dt = 0.05, ten shear times, markers 1.5 h apart. |L - L_0|/L_0, and longest over shortest edge minus 1.\n"
    )
    header = ["scene", "`-scheme_startup`", "rtol", "length, peak", "length, end", "edges, peak", "edges, end"]
    return ["## Start\n", about, *table(header, shown)]
