"""Run the stability maps, resumably, and write their CSV files, tables and pictures."""

from __future__ import annotations

import csv
import math
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from studies.common.tables import csv_text, table, write_csv
from petves.views.plot import dress, new_figure, save_figure
from studies.common.engine import Kept
from studies.stability import bodies
from studies.stability.cells import MARKS, SCHEMES, Map, run_cell
from studies.stability.maps import MAPS, STEP_MAP

COLUMNS = "map scheme x y mark steps energy_rise area_error length_error drift edge_ratio its message options".split()
UNSETTLED = ("too slow", "no clean stop")  # run again by the next call: a busy machine may be to blame
MINUTES = 30
HALVINGS = 3  # of the octave in which the largest stable step lies


class Cells(Kept):
    """Cells that have run, rows of one CSV file. Column scheme: the panel."""

    def __init__(self, path: Path, minutes: float = MINUTES) -> None:
        super().__init__(path)
        self.until = time.monotonic() + 60 * minutes
        self.left_out = 0

    def parse(self, text: str) -> dict:
        """Return the rows of the file by map, scheme, x and y."""
        reader = csv.DictReader(text.splitlines())
        if reader.fieldnames != COLUMNS:
            raise ValueError("other columns than this version writes")
        return {tuple(row[name] for name in COLUMNS[:4]): row for row in reader}

    def text(self) -> str:
        """Return the file of the rows."""
        rows = sorted(self.entries.values(), key=lambda row: [row[name] for name in ("map", "scheme", "y", "x")])
        return csv_text(COLUMNS, [[row[name] for name in COLUMNS] for row in rows])

    def mark(self, name: str, scheme: str, x: object, y: object) -> str:
        """Return the mark of a cell, "" when it has not run."""
        return self.entries.get((name, scheme, _text(x), _text(y)), {}).get("mark", "")

    def run(self, one: Map, cells: list[tuple[str, object, object]]) -> None:
        """Run those cells of a map that are not there with the same options, two at a time, while time is left."""

        def work(cell: tuple[str, object, object]) -> None:
            stages = one.stages(*cell)
            place, options = (one.name, *map(_text, cell)), " + ".join(stages)
            known = self.entries.get(place)
            if known and known["options"] == options and known["mark"] not in UNSETTLED:
                return
            if time.monotonic() > self.until:
                self.left_out += 1
                return
            found = {name: _text(value) for name, value in run_cell(cell[0], stages).items()}
            self.keep(place, dict(zip(COLUMNS, place)) | {"options": options} | found)

        with ThreadPoolExecutor(2) as pool:
            list(pool.map(work, cells))


def _text(value: object) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


def write(folder: str | Path, quick: bool = False, maps: tuple[Map, ...] | None = None) -> list[Path]:
    """Run what is not there yet; write stability.csv, which keeps the cells that have run, tables.md, a picture a map
    and largest_step.csv, .png. Quick: only the corners of each map; `maps`: these in place of all."""
    folder = Path(folder)
    maps = MAPS + bodies.MAPS if maps is None else maps
    maps = tuple(one.quick() for one in maps) if quick else maps
    cells = Cells(folder / "stability.csv")
    paths, text = [cells.path], []
    for one in maps:
        print(f"map {one.name}: {len(one.cells())} cells", flush=True)
        cells.run(one, one.cells())
        paths.append(_picture(cells, one, folder))
        text += _lines(cells, one)
    if STEP_MAP in maps:
        paths += _largest_steps(cells, folder, text)
    if cells.left_out:
        text.append(f"{cells.left_out} cells did not run within {MINUTES} minutes; another call goes on with them.\n")
    tables = folder / "tables.md"
    tables.write_text("\n".join(_counts(cells, maps) + _stops(cells, maps) + text))
    return [*paths, tables]


def _ok(cells: Cells, one: Map, panel: str) -> str:
    """Return how many cells of a panel are ok."""
    marks = [cells.mark(one.name, *cell) for cell in one.cells() if cell[0] == panel]
    ran = [m for m in marks if m and m != "refused"]
    rest = f" ({len(marks) - len(ran)} refused or not run)" if len(ran) < len(marks) else ""
    return f"{ran.count('ok')} of {len(ran)}{rest}"


def _counts(cells: Cells, maps: tuple[Map, ...]) -> list[str]:
    """How many cells of each map are ok, a panel: those of schemes in one table, the others below."""
    schemes = [one for one in maps if tuple(one.panels) == SCHEMES]
    rows = [[one.name, one.title, *(_ok(cells, one, scheme) for scheme in SCHEMES)] for one in schemes]
    text = ["### Cells that are ok\n", *table(["map", "scene", *SCHEMES], rows)]
    rest = [
        [one.name, one.title, panel, _ok(cells, one, panel)]
        for one in maps
        if one not in schemes
        for panel in one.panels
    ]
    return text + (table(["map", "scene, scheme coupled", "panel", "ok"], rest) if rest else [])


def _stops(cells: Cells, maps: tuple[Map, ...]) -> list[str]:
    """How often each mark was given, and what the program says in the first cell that has it, maps without schemes."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for one in maps:
        for panel, x, y in one.cells() if tuple(one.panels) != SCHEMES else []:
            row = cells.entries.get((one.name, panel, _text(x), _text(y)))
            if row and row["mark"] != "ok":
                found.setdefault((one.name, panel, row["mark"]), []).append(row["message"] or "(it ran to its end)")
    rows = [[*key, str(len(said)), said[0].replace("|", "\\|")] for key, said in found.items()]
    return (
        ["### What the program says\n", *table(["map", "panel", "mark", "cells", "message of the first"], rows)]
        if rows
        else []
    )


def _lines(cells: Cells, one: Map) -> list[str]:
    """A map as a table: for each y and panel the marks along x."""
    kind = "scheme" if tuple(one.panels) == SCHEMES else "panel"
    header = [one.y_label, kind, *(f"{one.x_label} = {_text(x)}" for x in one.xs)]
    marks = lambda panel, y: [cells.mark(one.name, panel, x, y) or "not run" for x in one.xs]  # noqa: E731
    rows = [[_text(y), panel, *marks(panel, y)] for y in one.ys for panel in one.panels]
    return [f"### {one.name}: {one.title}\n", *table(header, rows)]


def _picture(cells: Cells, one: Map, folder: Path) -> Path:
    """Draw a map, its panels side by side."""
    from matplotlib.patches import Patch, Rectangle

    height = 1.6 + 0.32 * len(one.ys)
    figure, axes = new_figure(11 if len(one.panels) < 4 else 14, height, columns=len(one.panels))
    seen = set()
    for panel, scheme in zip(axes, one.panels):
        for i, x in enumerate(one.xs):
            for j, y in enumerate(one.ys):
                name = cells.mark(one.name, scheme, x, y)
                seen.add(name)
                letter, color = MARKS.get(name, ("", "white"))
                panel.add_patch(Rectangle((i - 0.48, j - 0.48), 0.96, 0.96, color=color))
                panel.text(i, j, letter, ha="center", va="center", fontsize=8, color="white")
        panel.set(xlim=(-0.5, len(one.xs) - 0.5), ylim=(-0.5, len(one.ys) - 0.5), xlabel=one.x_label, title=scheme)
        panel.set_xticks(range(len(one.xs)), [_text(x) for x in one.xs], fontsize=7)
        panel.set_yticks(range(len(one.ys)), [_text(y) for y in one.ys], fontsize=7)
    axes[0].set_ylabel(one.y_label)
    handles = [Patch(color=color, label=f"{letter} {m}") for m, (letter, color) in MARKS.items() if m in seen]
    axes[-1].legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False, fontsize=8)
    figure.suptitle(one.title, fontsize=9)
    return save_figure(figure, folder / f"{one.name}.png")


def largest_step(cells: Cells, one: Map, scheme: str, n: int) -> tuple[float, bool]:
    """Return the largest step below which all are ok (0: none), bisected, and whether a larger one has failed."""
    good, bad = 0.0, 0.0
    for dt in sorted(one.ys):
        if cells.mark(one.name, scheme, n, dt) != "ok":
            bad = dt
            break
        good = dt
    if not good or not bad:
        return good, bool(bad)
    for _ in range(HALVINGS):
        middle = float(_text(math.sqrt(good * bad)))
        cells.run(one, [(scheme, n, middle)])
        good, bad = (middle, bad) if cells.mark(one.name, scheme, n, middle) == "ok" else (good, middle)
    return good, True


def _largest_steps(cells: Cells, folder: Path, text: list[str]) -> list[Path]:
    """Largest steps against h, their fitted powers, a CSV file and a picture."""
    one, rows, shown = STEP_MAP, [], []
    figure, (panel,) = new_figure(5.5, 4.2)
    for scheme, style in zip(SCHEMES, ("v", "s", "o")):
        found = [(2 / n, *largest_step(cells, one, scheme, n)) for n in one.xs]
        rows += [[scheme, h, dt, int(bounded)] for h, dt, bounded in found]
        bounded = [(h, dt) for h, dt, is_bound in found if is_bound and dt > 0]
        power = fitted_power(bounded)
        note = f"{power:.2f}" if len(bounded) > 2 else f"no bound up to {one.ys[0]:g}" if not bounded else "too few"
        shown.append([scheme, *(f"{dt:.3g}" + ("" if is_bound else " and more") for _, dt, is_bound in found), note])
        hs, dts, _ = zip(*found)
        (line,) = panel.loglog(hs, dts, f"{style}-", ms=5, lw=1, label=f"{scheme}: {note}")
        free = [(h, 1.15 * dt) for h, dt, is_bound in found if not is_bound]
        panel.loglog([r[0] for r in free], [r[1] for r in free], "^", color=line.get_color(), ms=8, mfc="none")
    dress(panel, grid="both", xlabel="cell size $h$", ylabel="largest step without a mark", title=one.title)
    panel.legend(frameon=False, fontsize=8, title="fitted power of $h$; triangles: no bound found", title_fontsize=7)
    write_csv(folder / "largest_step.csv", ["scheme", "h", "dt", "larger_failed"], rows)
    text += ["### Largest step without a mark, ellipse at rest, c_b = 1\n"]
    text += table(["scheme", *(f"h = 1/{n // 2}" for n in one.xs), "power of h"], shown)
    return [folder / "largest_step.csv", save_figure(figure, folder / "largest_step.png")]


def fitted_power(points: list[tuple[float, float]]) -> float:
    """Return the power of h in dt by least squares in logarithms; NaN with fewer than three points."""
    if len(points) < 3:
        return float("nan")
    return float(np.polyfit(*np.log(np.array(points)).T, 1)[0])
