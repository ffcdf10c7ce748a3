"""Run the study of the time step and write its tables."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np

from studies.common.tables import table, write_csv
from studies.common.engine import Results
from studies.stability.cells import run_cell
from studies.stability.maps import MAPS
from studies.time import runs as study

STEPS = (0.05, 0.1, 0.2, 0.4)
FIRST, BEST = study.WAYS
LOST = 10  # times the first energy
WANTED = 1e-2, 1e-3, 1e-4  # errors of markers


def write(folder: str | Path, quick: bool = False) -> list[Path]:
    """Run what is not there yet; write time_*.csv with every number, the tables of
    docs/evidence.md and tables.md with all tables. Quick: free space only, without references to wait for."""
    folder = Path(folder)
    results = Results(folder / "time.json")
    text = _steady(results, folder, ("free",) if quick else tuple(study.BOXES))
    if not quick:
        text += (
            _transients(results, folder)
            + _orders(results, folder)
            + _controlled(results, folder)
            + _maps(results, folder)
        )
    text += _large(results, folder) + _energy(results, folder)
    path = folder / "tables.md"
    path.write_text("\n".join(text))
    return [path, *sorted(folder.glob("time_*.csv"))]


def _percent(value: float) -> str:
    return "0" if abs(value) < 5e-5 else f"{value:+.4f}" if abs(value) < 0.01 else f"{value:+.2g}"


def _steady(results: Results, folder: Path, boxes: tuple[str, ...]) -> list[str]:
    """Angle and frequency against those of the smallest step."""
    rows, shown = [], []
    for box, (reduced_area, chi) in product(boxes, study.SHAPES):
        found = {dt: results.get(study.steady(box, reduced_area, chi, FIRST, dt)) for dt in STEPS}
        exact = found[STEPS[0]]
        errors = {dt: [100 * (found[dt][key] / exact[key] - 1) for key in ("angle", "frequency")] for dt in STEPS}
        rows += [[box, reduced_area, chi, dt, *errors[dt], found[dt]["its"]] for dt in STEPS]
        cells = [f"{_percent(a)}, {_percent(b)} ({found[dt]['its']:.1f})" for dt, (a, b) in errors.items()]
        shown.append([box, f"{reduced_area:g}, {chi:g}", *cells])
    header = ["box", "reduced_area", "chi", "dt", "angle_percent", "frequency_percent", "its"]
    write_csv(folder / "time_steady.csv", header, rows)
    title = "### Steady tank-treading: change of angle, frequency from dt = 0.05 in percent (iterations a step)\n"
    return [title, *table(["box", "V, chi", *(f"dt = {dt:g}" for dt in STEPS)], shown)]


def _markers(one: dict) -> np.ndarray:
    return np.array(one["markers"]).reshape(-1, 2)


def _distance(one: dict, other: dict) -> float:
    """Largest distance of markers; R0 = 1 in all scenes but two, where it counts as a length."""
    return float(np.hypot(*(_markers(one) - _markers(other)).T).max())


def fitted_order(points: list[tuple[float, float]], least: float) -> float:
    """Return the slope of log error over log dt of the three smallest steps whose error is above `least`."""
    used = sorted((dt, error) for dt, error in points if error > least)[:3]
    return float(np.polyfit(*np.log(np.array(used).T), 1)[0]) if len(used) == 3 else float("nan")


def _transients(results: Results, folder: Path) -> list[str]:
    """Markers at the end, and the order."""
    rows, shown = [], []
    for scene, (what, _, _, steps) in study.TRANSIENTS.items():
        finest = min(steps) / study.FINER
        fine = results.get(study.transient(scene, BEST, finest))
        doubt = _distance(fine, results.get(study.transient(scene, FIRST, finest)))
        for name in study.WAYS:
            found = {dt: results.get(study.transient(scene, name, dt)) for dt in steps}
            errors = {dt: _distance(one, fine) for dt, one in found.items()}
            order = fitted_order(list(errors.items()), 3 * doubt)
            rows += [[scene, name, dt, errors[dt], found[dt]["its"], found[dt]["steps"], doubt] for dt in steps]
            cells = [f"{dt:g}: {error:.1e} ({found[dt]['its']:.0f})" for dt, error in errors.items()]
            shown.append([what, name, ", ".join(cells), f"{order:.1f}"])
    header = ["scene", "way", "dt", "markers", "its", "steps", "references_differ"]
    write_csv(folder / "time_transients.csv", header, rows)
    columns = ["scene", "scheme", "step: error (iterations)", "order found"]
    write_csv(folder / "transients.csv", columns, shown)
    return [
        "### Transients: largest error of a marker at the end (iterations in all), by step\n",
        *table(columns, shown),
    ]


def step_for(errors: dict[float, float], wanted: float) -> float | None:
    """Return the step with the wanted error by log-log interpolation; the largest if its error is below, None if none."""
    steps = sorted(errors, reverse=True)
    if errors[steps[0]] <= wanted:
        return steps[0]
    for large, small in zip(steps, steps[1:]):
        if errors[small] <= wanted:
            part = np.log(wanted / errors[small]) / np.log(errors[large] / errors[small])
            return float(small * (large / small) ** part)
    return None


def _orders(results: Results, folder: Path) -> list[str]:
    """Which order pays: the step that each may take for an error, and what that costs."""
    rows, shown = [], []
    for scene, (what, _, _, steps) in study.TRANSIENTS.items():
        fine = results.get(study.transient(scene, BEST, min(steps) / study.FINER))
        found = {name: {dt: results.get(study.transient(scene, name, dt)) for dt in steps} for name in (FIRST, BEST)}
        errors = {name: {dt: _distance(one, fine) for dt, one in each.items()} for name, each in found.items()}
        line = [what]
        for wanted in WANTED:
            allowed = {name: step_for(each, wanted) for name, each in errors.items()}
            cell = []
            for name, dt in allowed.items():
                known = sorted(steps)
                its = np.interp(np.log(dt), np.log(known), [found[name][k]["its"] for k in known]) if dt else np.nan
                rows.append([scene, name, wanted, float(f"{dt or np.nan:.6g}"), round(float(its), 1)])
                mark = "> " if dt == max(steps) else ""
                cell.append(f"{mark}{dt:.2g} ({its:.0f})" if dt else f"< {min(steps):g}")
            line.append("; ".join(cell))
        better = [dt for dt in steps if errors[BEST][dt] <= errors[FIRST][dt]]
        worse = [dt for dt in steps if dt not in better]
        line.append(f"below {min(worse):g}" if worse else "all")
        shown.append(line)
    write_csv(folder / "time_orders.csv", ["scene", "way", "error", "dt", "its"], rows)
    title = "### Which order pays: the step (iterations in all) for an error of a marker, order 2; order 3\n"
    columns = ["scene", *(f"{wanted:.0e}" for wanted in WANTED), "steps at which order 3 is the better"]
    write_csv(folder / "orders.csv", columns, shown)
    return [title, *table(columns, shown)]


def _controlled(results: Results, folder: Path) -> list[str]:
    """Error control."""
    rows, shown = [], []
    for scene in study.CONTROLLED:
        fine = results.get(study.fine(scene, BEST))
        for name in study.WAYS:
            line = [scene, name]
            for tolerance in study.TOLERANCES:
                one = results.get(study.controlled(scene, name, tolerance))
                errors = _distance(one, fine), abs(one["angle"] - fine["angle"])
                rows.append([scene, name, tolerance, one["steps"], one["its"], *errors, one["largest"]])
                line.append(f"{one['steps']} ({one['its']:.0f}): {errors[0]:.1e}, {errors[1]:.0e}")
            shown.append(line)
    header = ["scene", "way", "tolerance", "steps", "its", "markers", "angle", "largest_step"]
    write_csv(folder / "time_controlled.csv", header, rows)
    title = "### Error control: steps (iterations): errors of markers, angle (rad), by tolerance\n"
    columns = ["scene", "scheme", *(f"{t:g}" for t in study.TOLERANCES)]
    write_csv(folder / "controlled.csv", columns, shown)
    return [title, *table(columns, shown)]


def _large(results: Results, folder: Path) -> list[str]:
    """Fifty large steps."""
    rows, shown = [], []
    for chi, name in product(study.CHIS, study.WAYS):
        line = [f"{chi:g}", name]
        for dt in study.LARGE:
            one = results.get(study.large(chi, name, dt))
            lost = one.get("energy", LOST) >= LOST
            rows.append([chi, name, dt, *(one.get(key, float("nan")) for key in ("angle", "frequency", "energy"))])
            line.append("lost" if lost else f"{one['angle']:.4f}, {one['frequency']:.4f}, {one['energy']:.2f}")
        shown.append(line)
    write_csv(folder / "time_large.csv", ["chi", "way", "dt", "angle", "frequency", "most_energy"], rows)
    title = "### 50 steps from an ellipse, V = 0.7: angle, frequency at the end, largest energy over the first\n"
    return [title, *table(["chi", "", *(f"dt = {dt:g}" for dt in study.LARGE)], shown)]


def _maps(results: Results, folder: Path) -> list[str]:
    """The maps of docs/evidence.md that have large steps, with orders 2 and 3."""
    rows, shown = [], []
    for one, order in product((each for each in MAPS if each.name in ("dt_cb", "dt_chi", "strong")), (2, 3)):
        marks = []
        for y, x in product(one.ys, one.xs):
            stages = tuple(f"-scheme_order {order} {stage}" for stage in one.options(x, y))
            name = f"map_{one.name}_{order}_{x:g}_{y:g}"
            found = results.derive(name, {"stages": " / ".join(stages)}, lambda stages=stages: _cell(stages))
            marks.append(found["mark"])
            rows.append([one.name, order, x, y, found["mark"], found["message"]])
        others = ", ".join(sorted(set(marks) - {"ok"}))
        shown.append([one.name, f"{order}", f"{marks.count('ok')} of {len(marks)}", others])
    write_csv(folder / "time_maps.csv", ["map", "order", "x", "y", "mark", "message"], rows)
    title = "### Cells of docs/evidence.md that are ok, coupled\n"
    return [title, *table(["map", "order", "ok", "others"], shown)]


def _cell(stages: tuple[str, ...]) -> dict[str, object]:
    found = run_cell("coupled", stages)
    return {key: found[key] for key in ("mark", "message")}


def _energy(results: Results, folder: Path) -> list[str]:
    """Rises of the bending energy in a quiescent fluid."""
    rows, shown = [], []
    for c_b, order in product(study.STIFF, (1, 2, 3)):
        line = [f"{c_b:g}", f"order {order}"]
        for dt in study.LONG:
            one = results.get(study.energy(c_b, order, dt))
            rows.append([c_b, order, dt, one["rise"], one["end"]])
            line.append(f"{one['rise']:.0e}, {one['end']:.4f}")
        shown.append(line)
    write_csv(folder / "time_energy.csv", ["c_b", "order", "dt", "rise", "end"], rows)
    title = "### Ellipse at rest, 40 steps: largest rise of the energy in a step (negative: none), its end, over E_0\n"
    return [title, *table(["c_b", "", *(f"dt = {dt:g}" for dt in study.LONG)], shown)]
