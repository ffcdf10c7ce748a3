"""Run the study of accuracy per cell and write its tables and its picture."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from studies.common.tables import table, write_csv
from petves.views.plot import dress, new_figure, save_figure
from studies.accuracy import runs as study
from studies.common.curves import radius
from studies.common.engine import Case, Results
from studies.common.paper import REST, SHEAR, shear_errors
from studies.common.scenes import KERNELS

CELLS, FINE_CELLS = (32, 64, 128), (24, 32, 48, 64, 96, 128, 256)
PICTURE = {
    "uncorrected": (48, 64, 96, 128, 192),
    "cbs54, none": (48, 64, 96, 128, 192),
    "chords": (32, 48, 64, 128),
    "ib6": (24, 32, 48, 64, 96, 128),
    "default": (24, 32, 48, 64, 96, 128),
}
FINE = ((0.7, 10), (0.5, 1), (0.9, 10))
"""V and chi."""


def write(folder: str | Path, quick: bool = False) -> list[Path]:
    """Run what is not there yet; write accuracy_*.csv, accuracy.png and tables.md. Quick: without 128^2 where it can be."""
    folder = Path(folder)
    results = Results(folder / "accuracy.json")
    text = _steady(results, folder, CELLS[:2] if quick else CELLS) + _others(results, folder)
    text += _kernels(results, folder) + _chords(results, folder) + _rest(results, folder)
    if not quick:
        text += _fine(results, folder) + _cost(results, folder) + _fields(results, folder)
    text_path = folder / "tables.md"
    text_path.write_text("\n".join(text))
    return [text_path, _picture(results, folder)]


def _errors(found: dict, box: str, reduced_area: float, chi: float) -> tuple[float, float]:
    """Return the errors of angle and frequency, relative."""
    return shear_errors(found["theta"], found["omega"], reduced_area, chi, box)


def _percent(errors: tuple[float, float]) -> str:
    return ", ".join(f"{100 * e:+.2f}" for e in errors)


def _norm(name: str, norm: np.ndarray, labels: int) -> list[list[str]]:
    """Return the lines of a norm of the errors of angle and frequency by grid, and of its order between the grids."""
    orders = np.log2(norm[:-1] / norm[1:])
    blank = [""] * (labels - 1)
    return [
        [name, *blank, *(f"{a:.3f}, {b:.3f}" for a, b in norm)],
        ["its order", *blank, "", *(f"{a:.1f}, {b:.1f}" for a, b in orders)],
    ]


def _steady(results: Results, folder: Path, cells: tuple[int, ...]) -> list[str]:
    """The default combination in both boxes."""
    rows, shown, every = [], [], []
    for box, v, chi in product(SHEAR, study.REDUCED_AREAS, study.CHIS):
        errors = [_errors(results.get(study.steady(box, n, v, chi)), box, v, chi) for n in cells]
        rows += [["default", box, v, chi, n, *e] for n, e in zip(cells, errors)]
        shown.append([box, f"{v}", f"{chi}", *map(_percent, errors)])
        every.append(errors)
    write_csv(folder / "accuracy_steady.csv", ["combination", "box", "V", "chi", "cells", "angle", "frequency"], rows)
    every = 100 * np.array(every)  # scenes, grids, angle and frequency
    shown += _norm("root mean square", np.sqrt((every**2).mean(axis=0)), 3)
    shown += _norm("largest", np.abs(every).max(axis=0), 3)
    kept = [results.get(study.steady(b, n, v, c)) for b, n, v, c in _all(cells[:2])]
    worst = {key: max(one[key] for one in kept) for key in ("area", "length", "shift")}
    note = (
        f"Worst of the {cells[0]}^2 and {cells[1]}^2 runs from t = 1 on: area {worst['area']:.0e}, length {worst['length']:.0e}, "
        f"shift {worst['shift']:.0e} a step (length units; R0 is 0.6 to 0.8).\n"
    )
    header = ["box", "V", "chi", *(f"{n}^2" for n in cells)]
    return ["### Default combination: errors of angle, frequency in percent\n", *table(header, shown), note]


def _fine(results: Results, folder: Path) -> list[str]:
    """The grid's part: differences from the finest grid, V and chi of FINE in the box, and the order between grids."""
    rows, shown = [], []
    for v, chi in FINE:
        found = [results.get(study.fine(n, v, chi)) for n in FINE_CELLS]
        *errors, finest = [(one["theta"], one["omega"]) for one in found]
        errors = 100 * (np.array(errors) / finest - 1)
        rows += [[v, chi, n, *e] for n, e in zip(FINE_CELLS, errors)]
        shown.append([f"{v}", f"{chi}", "angle", *(f"{e:+.4f}" for e in errors[:, 0])])
        steps = np.log(np.array(FINE_CELLS[1:-1]) / FINE_CELLS[:-2])
        orders = np.log(np.abs(errors[:-1, 0] / errors[1:, 0])) / steps
        shown.append(["", "", "its order", "", *(f"{order:.1f}" for order in orders)])
        shown.append(["", "", "frequency", *(f"{e:+.4f}" for e in errors[:, 1])])
    write_csv(folder / "accuracy_fine.csv", ["V", "chi", "cells", "angle", "frequency"], rows)
    header = ["V", "chi", "", *(f"{n}^2" for n in FINE_CELLS[:-1])]
    title = (
        f"### The grid's part: percent of difference from {FINE_CELLS[-1]}^2, box, rate dt = 0.0125, solver to 1e-9\n"
    )
    return [title, *table(header, shown)]


def _all(cells: tuple[int, ...]) -> product:
    return product(SHEAR, cells, study.REDUCED_AREAS, study.CHIS)


def _others(results: Results, folder: Path) -> list[str]:
    """Uncorrected beside the default, chi = 10."""
    rows, shown = [], []
    for box, v in product(SHEAR, study.REDUCED_AREAS):
        line = [box, f"{v}"]
        for n in (64, 128):
            for name, case in (
                ("uncorrected", study.shear("uncorrected", box, n, v, 10)),
                ("default", study.steady(box, n, v, 10)),
            ):
                errors = _errors(results.get(case), box, v, 10)
                rows.append([name, box, v, 10, n, *errors])
                line.append(_percent(errors))
        shown.append(line)
    write_csv(folder / "accuracy_others.csv", ["combination", "box", "V", "chi", "cells", "angle", "frequency"], rows)
    header = ["box", "V", *(f"{n}^2 {name}" for n, name in product((64, 128), ("uncorrected", "default")))]
    return ["### Uncorrected and default: the same errors, chi = 10\n", *table(header, shown)]


def _seconds(one: dict) -> float:
    return one.get("seconds_least", one["seconds"])


def _kernels(results: Results, folder: Path) -> list[str]:
    """Kernels and numbers of markers at 64^2 and 128^2."""
    rows, shown = [], []
    base = {n: results.get(study.kernel_and_markers("cbs54", 45, n)) for n in (64, 128)}
    for kernel, count in product(KERNELS, study.MARKERS):
        line = [kernel, f"{count}"]
        for n in (64, 128):
            one = results.get(study.kernel_and_markers(kernel, count, n))
            errors, ratio = _errors(one, "box", 0.7, 10), _seconds(one) / _seconds(base[n])
            rows.append([kernel, count, n, *errors, one["length"], one["its"], ratio])
            line += [_percent(errors), f"{one['length']:.0e}", f"{one['its']:.1f}", f"{ratio:.2f}"]
        shown.append(line)
    header = ["kernel", "markers", "cells", "angle", "frequency", "length", "its", "seconds_over_default"]
    write_csv(folder / "accuracy_kernels.csv", header, rows)
    columns = [f"{n}^2 {name}" for n in (64, 128) for name in ("errors, %", "length", "its", "time")]
    title = "### Kernels and numbers of markers: V = 0.7, chi = 10, box, rate dt = 0.025; time over cbs54 with 45\n"
    return [title, *table(["kernel", "markers", *columns], shown)]


def _chords(results: Results, folder: Path) -> list[str]:
    """Spectral edges against chords."""
    shown = []
    for v in (0.5, 0.7):
        for name in ("chords", "default"):
            found = [results.get(study.steady("box", n, v, 10, name)) for n in (64, 128)]
            texts = [_percent(_errors(one, "box", v, 10)) for one in found]
            kept = [f"{one['length']:.0e}, {one['shift']:.0e}" for one in found]
            shown.append([f"{v}", "chords" if name == "chords" else "spectral edges", *texts, *kept])
    header = ["V", "", "64^2 errors, %", "128^2 errors, %", "64^2 length, shift", "128^2 length, shift"]
    return ["### Chords and spectral edges: chi = 10, box\n", *table(header, shown)]


def _rest(results: Results, folder: Path) -> list[str]:
    """Equilibrium in fluid at rest."""
    rows, shown = [], []
    for name, v in [("default", v) for v in REST] + [("uncorrected", v) for v in study.REDUCED_AREAS]:
        one = results.get(study.rest(name, 128, v))
        got = one["energy"] * radius(v), one["width"] / radius(v), one["mid_height"] / radius(v)
        errors = [100 * (a / b - 1) for a, b in zip(got, REST[v])]
        rows.append([name, v, *got, *errors, one["drift"]])
        shown.append([name, f"{v}", *(f"{a:.4f} ({e:+.3f} %)" for a, e in zip(got, errors)), f"{one['drift']:.0e}"])
    keys = ["energy", "width", "mid_height"]
    write_csv(folder / "accuracy_rest.csv", ["combination", "V", *keys, *(k + "_percent" for k in keys), "drift"], rows)
    header = ["", "V", "E_B R0/c_b", "width/R0", "mid height/R0", "energy still changes by"]
    return ["### At rest: 4 x 4 box, 128^2, unit area, t = 5\n", *table(header, shown)]


def _cost(results: Results, folder: Path) -> list[str]:
    """Seconds a step at 256^2."""
    names = ("uncorrected", "cbs54, none", "default")
    taken = results.in_turn({name: study.cost(name) for name in names}, 3)
    seconds = {name: np.median([one["seconds_least"] for one in runs]) for name, runs in taken.items()}
    shown = []
    for name, (first, *_) in taken.items():
        over = [f"{seconds[name] / seconds[base]:.2f}" for base in ("cbs54, none", "uncorrected")]
        shown.append([name, f"{first['its_all']:.1f}", *over])
    write_csv(folder / "accuracy_cost.csv", ["combination", "its", "over_cbs54_none", "over_uncorrected"], shown)
    header = ["", "iterations", "time over cbs54, none", "time over uncorrected"]
    title = "### Time a step at 256^2: V = 0.7, chi = 10, 25 steps, three runs each in turn\n"
    return [title, *table(header, shown)]


def _fields(results: Results, folder: Path) -> list[str]:
    """Velocity, pressure outside the membrane and tension, against the default at 256^2."""
    reference = results.get(study.fields("default", 256, None))
    rows = []
    scale = np.sqrt(2 * np.mean(np.square(reference[f"velocity_{study.DISTANCES[0]}"])))
    pressure_range = np.ptp(reference[f"pressure_{study.DISTANCES[0]}"])
    for n, name in product((64, 128), ("uncorrected", "cbs54, none", "default")):
        one = results.get(study.fields(name, n, reference))
        line = [f"{n}^2", name]
        for distance in study.DISTANCES:
            key = f"velocity_{distance}"
            apart = np.reshape(np.subtract(one[key], reference[key]), (2, -1))
            line.append(f"{100 * np.sqrt((apart**2).sum(0).mean()) / scale:.2f}")
        for distance in study.DISTANCES:  # pressure is known up to a constant
            apart = np.subtract(one[f"pressure_{distance}"], reference[f"pressure_{distance}"])
            line.append(f"{100 * np.std(apart) / pressure_range:.2f}")
        tension = _tension(one, name) - _tension(reference, "default")
        line.append(f"{100 * np.sqrt(np.mean(tension**2)) / np.ptp(_tension(reference, 'default')):.2f}")
        rows.append(line)
    columns = [f"{what} {d:g}" for what in ("velocity", "pressure") for d in study.DISTANCES]
    write_csv(folder / "accuracy_fields.csv", ["cells", "combination", *columns, "tension"], rows)
    title = (
        "### Velocity and pressure outside the membrane and tension: V = 0.7, chi = 10, box, t = 10, percent\n\n"
        "Root mean square difference from the default at 256^2 at three distances, in percent of the velocity's root mean\n"
        "square at 0.125, of the pressure's range at 0.125 and of the range of the tension. h = 0.125 at 64^2: 0.125, 0.25\n"
        "and 0.5 are 1, 2 and 4 h there, 2, 4 and 8 h at 128^2.\n"
    )
    return [title, *table(["", "", *columns, "tension"], rows)]


def _tension(one: dict, name: str) -> np.ndarray:
    """Return the tension at 256 phase angles about the centre: at the markers, or at the middle of chords."""
    points = np.reshape(one["markers"], (-1, 2))
    if study.COMBINATIONS[name][1] != "spectral":
        points = 0.5 * (points + np.roll(points, 1, axis=0))
    points = points - points.mean(axis=0)
    phase = np.arctan2(points[:, 1], points[:, 0])
    order = np.argsort(phase)
    grid = 2 * np.pi * np.arange(256) / 256 - np.pi
    return np.interp(grid, phase[order], np.array(one["tension"])[order], period=2 * np.pi)


def _picture_case(name: str, n: int) -> Case:
    exact = study.COMBINATIONS[name][2] == "exact"
    return study.steady("box", n, 0.7, 10, name) if exact else study.shear(name, "box", n, 0.7, 10)


def _picture(results: Results, folder: Path) -> Path:
    """Draw errors of angle and frequency against h, V = 0.7, chi = 10, box."""
    figure, axes = new_figure(11, 4.4, columns=2)
    rows = []
    for (name, cells), style in zip(PICTURE.items(), ("s-", "v-", "D--", "x--", "o-")):
        cases = [_picture_case(name, n) for n in cells]
        errors = [_errors(results.get(case), "box", 0.7, 10) for case in cases]
        rows += [[name, n, *e] for n, e in zip(cells, errors)]
        for panel, values in zip(axes, np.abs(errors).T):
            panel.loglog(8 / np.array(cells), 100 * values, style, ms=4, lw=1.2, label=name)
    h = np.array([8 / 192, 8 / 24])
    for panel, what in zip(axes, ("inclination", "frequency")):
        panel.loglog(h, 2 * h / h[-1], "k:", lw=0.8, label="slopes 1 and 2")
        panel.loglog(h, 0.7 * (h / h[-1]) ** 2, "k:", lw=0.8)
        label = "cell size $h$ (length; vesicle of unit area)"
        dress(panel, grid="both", xlabel=label, ylabel=f"error of the {what} (%)")
    axes[1].legend(frameon=False, fontsize=7, loc="lower left")
    write_csv(folder / "accuracy_picture.csv", ["combination", "cells", "angle", "frequency"], rows)
    return save_figure(figure, folder / "accuracy.png")
