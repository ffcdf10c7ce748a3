"""Run the work-precision diagrams, resumably, and write their CSV files, tables and pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from statistics import median

from studies.common.tables import table, write_csv
from studies.common.engine import Case, Results
from studies.common.scenes import option_text
from studies.speed_accuracy import bodies
from studies.speed_accuracy.claim import claim
from studies.speed_accuracy.pictures import picture
from studies.speed_accuracy.scenes import DEFAULT, ERRORS, EXACT, SCENES, SCHEMES, Point, Scene

ROUNDS = 5  # runs of a point, one of each in a round; the median counts
FEWER = 3  # of one without the exact near field: these schemes have not changed since the older chart
ONCE = 3.0  # CPU seconds above which a point runs once
QUICK_WORK = 2e5  # cells times steps of the largest run of a quick call
LEVELS = (1e-2, 1e-3, 1e-4)
LEVEL_COLUMNS = ["scheme", *(f"{100 * level:g} %" for level in LEVELS), "least error of all points"]
COLUMNS = (
    "scene scheme cells h dt tolerance".split()
    + list(ERRORS)
    + "cpu_seconds step_seconds solves steps runs commit message".split()
)

ALL = SCENES + bodies.SCENES

Row = dict[str, object]


def write(
    folder: str | Path, quick: bool = False, scenes: tuple[Scene, ...] = ALL, finest: int | None = None
) -> list[Path]:
    """Run what is not there yet; write chart.csv, recommended.csv, levels.csv, claim.csv, tables.md and the pictures.

    Quick: only the points of little work, once each. `scenes` stand in place of all; `finest`: 1/h of the paper's
    settings that the last section compares with (256, quick 64).
    """
    folder = Path(folder)
    results = Results(folder / "chart.json")
    if quick:
        scenes = tuple(replace(one, reference=one.reference | one.quick) for one in scenes)
    points = {one.name: tuple(p for p in one.points if not quick or one.work(p) < QUICK_WORK) for one in scenes}
    for repeat in range(1 if quick else ROUNDS):  # all scenes once before any is run again
        for one in scenes:
            before = results.added
            run_points(results, one, points[one.name], repeat)
            if results.added > before:
                write_rows(folder / "chart.csv", results, scenes, points)
    write_rows(folder / "chart.csv", results, scenes, points)
    paths, text = [folder / "chart.csv", folder / "recommended.csv"], []
    best: list[Row] = []
    for one in scenes:
        floor, rows = converged(results, one, quick), rows_of(results, one, points[one.name])
        start = start_seconds(results, one)
        costs = [cost for cost in ("cpu_seconds", "solves") if any(row[cost] for row in rows)]  # unbounded: no solves
        paths += [picture(folder, one, rows, cost, floor, start) for cost in costs]
        text += _lines(one, rows, floor, start)
        best += [row | {"level": level} for level in LEVELS if (row := cheapest(rows, EXACT, level))]
    levels = [[one.name, *line] for one in scenes for line in costs_of(rows_of(results, one, points[one.name]))]
    paths.append(write_csv(folder / "levels.csv", ["scene", *LEVEL_COLUMNS], levels))
    names = ["level", *COLUMNS[:-1]]
    write_csv(paths[1], names, [[row[name] for name in names] for row in best])
    text += claim(Results(folder / "claim.json"), folder, finest or (64 if quick else 256))
    tables = folder / "tables.md"
    tables.write_text("\n".join(text))
    return [*paths, folder / "claim.csv", tables]


def write_rows(path: Path, results: Results, scenes: tuple[Scene, ...], points: dict[str, tuple[Point, ...]]) -> None:
    """Write what has run."""
    rows = [row for one in scenes for row in rows_of(results, one, points[one.name])]
    write_csv(path, [*COLUMNS, "options"], [[row[name] for name in (*COLUMNS, "options")] for row in rows])


def start_seconds(results: Results, one: Scene) -> float:
    """Return the CPU seconds of the program's start: the median of five runs of the scene that take no step."""
    case = one.case(Point(DEFAULT, min(p.cells for p in one.points), dt=0.02), 0, {})
    options = case.options | {"-time_end": "0"}
    runs = results.in_turn({"start": Case(f"{one.name}_start", options, lambda series, folder: {})}, ROUNDS)["start"]
    return median(run["cpu_seconds"] for run in runs)


def converged(results: Results, one: Scene, quick: bool) -> dict[str, float]:
    """Return the errors of the reference against another fine run; quick, or without reference: nothing."""
    if quick or not one.reference or not one.other:
        return {}
    errors = one.errors(results.get(one.fine()), results.get(one.fine(other=True)))
    return errors | {"largest": one.largest(errors)}


def run_points(results: Results, one: Scene, points: tuple[Point, ...], repeat: int) -> None:
    """Run the points of a scene in one round."""
    fine = results.get(one.fine()) if one.reference else {}
    for point in points:
        if repeat >= FEWER and point.scheme not in EXACT:
            continue
        if not repeat or results.get(one.case(point, 0, fine))["cpu_seconds"] <= ONCE:
            results.get(one.case(point, repeat, fine))


def rows_of(results: Results, one: Scene, points: tuple[Point, ...]) -> list[Row]:
    """Return a row for each point that has run."""
    return [_row(results, one, point) for point in points if results.has(one.case(point, 0, {}))]


def _row(results: Results, one: Scene, point: Point) -> Row:
    """Return what chart.csv says of a point, with the medians of its runs' seconds."""
    cases = [one.case(point, repeat, {}) for repeat in range(ROUNDS)]
    ran = [case for case in cases if results.has(case)]
    runs = [results.get(case) for case in ran]
    found = runs[0]
    row: Row = {"scene": one.name, "scheme": point.scheme, "cells": point.cells, "h": f"{one.width / point.cells:.6g}"}
    row |= {"dt": f"{point.dt:.6g}", "tolerance": f"{point.tolerance:.6g}"}
    errors = found.get("errors", {})
    row |= {name: errors.get(name, "") for name in ERRORS} | ({"largest": one.largest(errors)} if errors else {})
    row |= {name: found.get(name, "") for name in ("solves", "steps")}
    steps = [run["step_seconds"] for run in runs if "step_seconds" in run]
    row |= {"cpu_seconds": median(run["cpu_seconds"] for run in runs), "runs": len(runs)}
    row |= {"step_seconds": median(steps) if steps else "", "commit": results.entries[ran[0].name]["commit"]}
    row["message"] = found.get("failed", "").split("; the last good state")[0]
    return row | {"options": option_text(ran[0].options)}


def finer(row: Row, other: Row) -> bool:
    """Return whether the other run is of the same scheme, and neither its grid nor its step is coarser."""
    step, smaller = (tuple(float(x[name]) for name in ("dt", "tolerance")) for x in (row, other))
    same = row["scheme"] == other["scheme"] and (step[0] > 0) == (smaller[0] > 0)
    return same and other["cells"] >= row["cells"] and smaller[0] <= step[0] and smaller[1] <= step[1]


def cheapest(rows: list[Row], schemes: tuple[str, ...], level: float) -> Row | None:
    """Return the run of some schemes that keeps every error below a level in the least CPU time, None if none does.

    Every finer run must keep it too: errors that happen to cancel do not count. Between equal tenths of a second the
    work of the solves decides.
    """
    keeps = lambda row: not row["message"] and row["largest"] <= level  # noqa: E731
    ours = [row for row in rows if row["scheme"] in schemes]
    good = [row for row in ours if all(keeps(other) for other in rows if finer(row, other))]
    cost = lambda row: (round(row["cpu_seconds"], 1), row["solves"] * row["cells"] ** 2)  # noqa: E731
    return min(good, key=cost, default=None)


def _percent(value: object) -> str:
    return f"{100 * value:.2g}" if value != "" else ""


def _lines(one: Scene, rows: list[Row], floor: dict[str, float], start: float) -> list[str]:
    """Return a scene's tables."""
    text = [f"## {one.name}: {one.title}\n"]
    if floor:
        shown = ", ".join(f"{name} {floor[name]:.1e}" for name in one.wanted)
        text.append(f"The reference differs from another fine run by: {shown}.\n")
    text.append(f"The program's start takes {start:.2f} CPU seconds of those below.\n")
    text += ["### CPU seconds (scalar solves) for a level of every error\n", *table(LEVEL_COLUMNS, costs_of(rows))]
    return text + _settings(one, rows) + _failures(rows)


def costs_of(rows: list[Row]) -> list[list[str]]:
    """Return a line for each scheme: CPU seconds (scalar solves) of a level of every error, and the least error."""
    lines = []
    for scheme in dict.fromkeys(row["scheme"] for row in rows):
        line = [scheme]
        for level in LEVELS:
            row = cheapest(rows, (scheme,), level)
            line.append(f"{row['cpu_seconds']:.2f} ({row['solves']:.0f})" if row else "not reached")
        worst = [row["largest"] for row in rows if row["scheme"] == scheme and not row["message"]]
        lines.append([*line, f"{_percent(min(worst))} %" if worst else "none ran"])
    return lines


def _settings(one: Scene, rows: list[Row]) -> list[str]:
    """Return the cheapest settings with the exact near field for each level."""
    measure = "markers" if one.name == "free" else "cells"
    header = ["error", measure, "scheme", "step", "steps", "scalar solves", "CPU seconds", "of them steps"]
    header += [f"{name}, %" for name in one.wanted]
    lines = []
    for level in LEVELS:
        line, row = [f"{100 * level:g} %", "not reached"], cheapest(rows, EXACT, level)
        if row:
            step = f"tolerance {row['tolerance']}" if row["tolerance"] != "0" else f"dt {row['dt']}"
            line = [line[0], str(row["cells"]), row["scheme"], step, str(row["steps"]), f"{row['solves']:.0f}"]
            line += [f"{row['cpu_seconds']:.2f}", f"{row['step_seconds']:.3f}"]
            line += [_percent(row[name]) for name in one.wanted]
        lines.append(line + [""] * (len(header) - len(line)))
    return ["### Settings: coupled with the exact near field\n", *table(header, lines)]


def _failures(rows: list[Row]) -> list[str]:
    """Return the points that stopped, and their messages."""
    failed = [[row["scheme"], str(row["cells"]), row["dt"], row["message"]] for row in rows if row["message"]]
    text = [f"### Failed: {len(failed)} of {len(rows)} points\n"]
    return text + (table(["scheme", "cells", "dt", "message"], failed) if failed else [])
