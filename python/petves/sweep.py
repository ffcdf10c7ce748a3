"""A grid of options, run several at a time on this machine, into one tidy table."""

from __future__ import annotations

import csv
import itertools
import json
import shutil
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path

from petves.errors import Error
from petves.program import program, run_program
from petves.progress import progress_bar

GOOD = ("finished", "steady")
FORBIDDEN = ("output_dir", "restart", "options_file")


def sweep(
    folder: str | Path,
    grid: dict[str, list[str]],
    options_file: str | Path | None = None,
    jobs: int = 1,
    ranks: int = 1,
    progress: bool | None = None,
) -> Path:
    """Run every combination of a grid of options.

    Parameters
    ----------
    folder : str or Path
        Where the runs go, a folder each, and sweep.csv: a row a run with the varied options, `folder`, `status` ("done",
        "stopped" when a step could not be taken, "refused" when the options were) and `message`, then the last row of the
        run's series.csv. A finished run is not run again and an interrupted one goes on from its checkpoint, so that a
        sweep goes on where it stopped, and a larger grid adds to it.
    grid : dict of str to list of str
        Values of each option, named without the dash.
    options_file : str or Path, optional
        Options that all runs share.
    jobs, ranks : int
        Runs at a time; MPI ranks of each.
    progress : bool, optional
        Show a progress bar; when left out, if standard error is a terminal.

    Returns
    -------
    Path
        sweep.csv.

    Raises
    ------
    Error
        When the grid is empty, or the folder holds runs of other shared options.
    """
    folder = Path(folder)
    _check(grid, jobs, ranks)
    base = Path(options_file).read_text() if options_file and Path(options_file).is_file() else ""
    if options_file and not base:
        raise Error(f"{options_file}: no such file, or nothing in it; allowed: a file of options")
    program()
    folder.mkdir(parents=True, exist_ok=True)
    shared = folder / "shared.opts"
    if shared.is_file() and shared.read_text() != base:
        raise Error(f"{folder}: holds a sweep with other shared options, see {shared}; choose another folder")
    shared.write_text(base)
    points = [dict(zip(grid, values)) for values in itertools.product(*grid.values())]
    with ThreadPoolExecutor(jobs) as pool, progress_bar(len(points), show=progress, unit="runs") as bar:
        waiting: list[Future[None]] = [pool.submit(_run_point, folder, point, ranks) for point in points]
        try:
            for done, future in enumerate(as_completed(waiting), 1):
                future.result()
                bar(done)
                _write(folder, grid, points)
        except BaseException:
            pool.shutdown(cancel_futures=True)  # what has been started still ends
            raise
    return _write(folder, grid, points)


def _check(grid: dict[str, list[str]], jobs: int, ranks: int) -> None:
    if not grid or not all(grid.values()):
        raise Error("sweep: nothing to vary; allowed: at least one option with values")
    for name in grid:
        if name in FORBIDDEN:
            raise Error(f"sweep: {name} cannot vary; allowed: any other option")
    if jobs < 1 or ranks < 1:
        raise Error(f"sweep: {jobs} jobs of {ranks} ranks; allowed: at least 1 each")


def _name(point: dict[str, str]) -> str:
    """Return the folder's name of one combination."""
    return ",".join(f"{name}={value}" for name, value in point.items()).replace("/", "_")


def _run_point(folder: Path, point: dict[str, str], ranks: int) -> None:
    """Run one combination unless that has been done, and leave status.json beside its files."""
    home = folder / _name(point)
    if (home / "status.json").is_file():
        return
    words = [word for name, value in point.items() for word in (f"-{name}", value)]
    words = ["-options_file", str(folder / "shared.opts"), *words, "-output_dir", str(home)]
    status, message = 1, ""
    if (home / "checkpoint.h5").is_file():  # of an interrupted run
        status, message = run_program([*words, "-restart", str(home / "checkpoint.h5")], ranks)
    if status == 1:
        shutil.rmtree(home, ignore_errors=True)
        status, message = run_program(words, ranks)
    if status < 0 or status > 2:
        raise Error(f"{home}: the program ended with status {status}: {message}")
    if status == 0 and json.loads((home / "summary.json").read_text())["reason"] not in GOOD:
        return  # asked to stop: the next call goes on
    home.mkdir(exist_ok=True)
    kind = ("done", "refused", "stopped")[status]
    temporary = home / "status.json.tmp"
    temporary.write_text(json.dumps({"status": kind, "message": message}) + "\n")
    temporary.replace(home / "status.json")


def _write(folder: Path, grid: dict[str, list[str]], points: list[dict[str, str]]) -> Path:
    """Write sweep.csv of the runs that have ended, in the grid's order."""
    rows: list[dict[str, object]] = []
    for point in points:
        home = folder / _name(point)
        if not (home / "status.json").is_file():
            continue
        row: dict[str, object] = {**point, "folder": home.name, **json.loads((home / "status.json").read_text())}
        if row["status"] != "refused":
            with (home / "series.csv").open(newline="") as file:
                *_, last = csv.DictReader(file)
            row |= last
        rows.append(row)
    names = list(dict.fromkeys(itertools.chain(grid, ("folder", "status", "message"), *rows)))
    path = folder / "sweep.csv"
    with path.with_suffix(".tmp").open("w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    path.with_suffix(".tmp").replace(path)
    return path
