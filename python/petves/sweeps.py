"""A grid of options, run several at a time on this machine, into one tidy table."""

import contextlib
import csv
import fcntl
import hashlib
import io
import itertools
import json
import re
import shlex
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path
from urllib.parse import quote

from petves.errors import Error, RunError
from petves.files import read_file, read_summary, write_text
from petves.program import command, run_program
from petves.progress import progress_bar

GOOD = ("finished", "steady")
REMEMBERED = ("done", "stopped", "refused")
FORBIDDEN = "output_dir|restart|options_.*|python.*|dll_.*|.*debugger.*|on_error_.*|history|log_.*|malloc_.*|info.*"
"""Options that the sweep sets, and those of PETSc that run programs or write any file; PETSc takes either case."""
SAFE = " !$&'()*+,-.:;<>?@[]^_`{|}~"  # what a folder's name has as it is: no slash, =, # nor %
LONGEST = 200  # characters of a folder's name

Grid = Mapping[str, Iterable[object]]  # values of each option
Ended = tuple[str, str]  # status and message of a run


def sweep(
    folder: str | Path,
    grid: Grid,
    options_file: str | Path | None = None,
    jobs: int = 1,
    ranks: int = 1,
    progress: bool | None = None,
) -> Path:
    """Run every combination of a grid of options; return sweep.csv, of which `failures` says what is not done.

    Parameters
    ----------
    folder : str or Path
        Where the runs go, a folder each, and sweep.csv: a row a run with the varied options, `folder`, `status` and
        `message`, then the last row of the run's series.csv. "done", "stopped" (a step could not be taken) and
        "refused" (the options were) are remembered: such a run is not run again. "failed" (a full disk, no slots, a
        kill) and "interrupted" (a signal, ``time_wall_limit``) are not: the next call goes on from the run's checkpoint.
        A larger grid adds to the sweep. Nothing that a run has left is deleted; what was left without a checkpoint is
        moved aside to the folder's name with ``~1``, ``~2``.
    grid : mapping of str to iterable
        Values of each option, named without the dash: text or numbers.
    options_file : str or Path, optional
        Options that all runs share.
    jobs, ranks : int
        Runs at a time; MPI ranks of each.
    progress : bool, optional
        Show a progress bar; when left out, if standard error is a terminal.

    Raises
    ------
    Error
        When the grid is empty, the folder holds runs of other shared options, or a file of the sweep cannot be written.
    """
    folder, points = Path(folder), _combinations(grid, jobs, ranks)
    base = _options_of(Path(options_file)) if options_file and Path(options_file).is_file() else ""
    if options_file and not base:
        raise Error(f"{options_file}: no such file, or nothing in it; allowed: a file of options")
    command()
    shared = folder / "shared.opts"
    if not shared.is_file():
        write_text(shared, base)
    elif shared.read_text() != base:
        raise Error(f"{folder}: holds a sweep with other shared options, see {shared}; choose another folder")
    ended: dict[str, Ended] = {}
    with ThreadPoolExecutor(jobs) as pool, progress_bar(len(points), show=progress, unit="runs") as bar:
        waiting: dict[Future[Ended], str] = {pool.submit(_run_point, folder, x, ranks): _name(x) for x in points}
        try:
            for done, future in enumerate(as_completed(waiting), 1):
                ended[waiting[future]] = future.result()
                bar(done)
                _write(folder, points, ended)
        except BaseException:
            pool.shutdown(cancel_futures=True)  # what has been started still ends
            raise
    return _write(folder, points, ended)


def submit(
    folder: str | Path, grid: Grid, options_file: str | Path | None = None, ranks: int = 1, slurm: str = ""
) -> str:
    """Submit a grid as a job array of Slurm, one combination a task; return what sbatch answers.

    `slurm` has further words for sbatch; `folder`, `grid`, `options_file` and `ranks` are as for `sweep`, which makes the
    table when the tasks have ended.
    """
    folder, points = Path(folder).resolve(), _combinations(grid, 1, ranks)
    task = [sys.executable, "-m", "petves", "sweep", str(folder), "--ranks", str(ranks), "--jobs", "1"]
    task += ["--options-file", str(Path(options_file).resolve())] if options_file else []
    varied = ([word for name, value in point.items() for word in ("--vary", name, value)] for point in points)
    write_text(folder / "tasks", "".join(f"{shlex.join([*task, *words])}\n" for words in varied))
    wrapped = f'eval "$(sed -n "$SLURM_ARRAY_TASK_ID p" {shlex.quote(str(folder / "tasks"))})"'
    words = [f"--array=1-{len(points)}", f"--ntasks={ranks}", "--job-name=petves", *shlex.split(slurm)]
    try:
        done = subprocess.run(["sbatch", *words, "--wrap", wrapped], capture_output=True, text=True)
    except FileNotFoundError:
        raise Error("sbatch: no such program; allowed: --slurm where Slurm is") from None
    if done.returncode:
        raise Error(f"sbatch: {(done.stderr or done.stdout).strip()}")
    return done.stdout.strip()


def failures(path: str | Path) -> list[str]:
    """Return a line for each run of a sweep.csv that is not done: its folder, status and message."""
    with Path(path).open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [f"{row['folder']}: {row['status']}: {row['message']}" for row in rows if row["status"] != "done"]


def _options_of(path: Path) -> str:
    """Return the text of an options file; a file that it names and that lies beside it is then found from here."""

    def found(line: re.Match[str]) -> str:
        beside = path.parent / line[2]
        return f"{line[1]}{line[2] if Path(line[2]).exists() or not beside.exists() else beside}"

    return re.sub(r"^(\s*-\w+_file\s+)([^\s#\"']+)", found, path.read_text(), flags=re.MULTILINE)


def _combinations(grid: Grid, jobs: int, ranks: int) -> list[dict[str, str]]:
    """Return every combination of a grid's values as text, each once."""
    grid = {name: [str(value) for value in values] for name, values in grid.items()}
    if not grid or not all(grid.values()):
        raise Error("sweep: nothing to vary; allowed: at least one option with values")
    for name in grid:
        if re.fullmatch(FORBIDDEN, name.lower().lstrip("-")):
            raise Error(f"sweep: {name} cannot vary; allowed: any other option")
    if jobs < 1 or ranks < 1:
        raise Error(f"sweep: {jobs} jobs of {ranks} ranks; allowed: at least 1 each")
    points = [dict(zip(grid, values)) for values in itertools.product(*grid.values())]
    return list({_name(point): point for point in points}.values())


def _name(point: dict[str, str]) -> str:
    """Return the folder's name of one combination: another for any other, and no longer than file systems allow."""
    name = ",".join(f"{option}={quote(value, safe=SAFE)}" for option, value in point.items())
    if len(name) <= LONGEST:
        return name
    return f"{name[: LONGEST - 20]}~{hashlib.sha256(name.encode()).hexdigest()[:16]}"


def _run_point(folder: Path, point: dict[str, str], ranks: int) -> Ended:
    """Run one combination unless that has been done; leave status.json beside its files where there is no more to do."""
    home = folder / _name(point)
    with contextlib.suppress(FileNotFoundError, ValueError, LookupError, TypeError):
        known = json.loads((home / "status.json").read_text())
        return known["status"], known["message"]
    words = [word for name, value in point.items() for word in (f"-{name}", value)]
    try:
        kind, message = _launch(home, ["-options_file", str(folder / "shared.opts"), *words], ranks)
        if kind in REMEMBERED:
            write_text(home / "status.json", json.dumps({"status": kind, "message": message}) + "\n")
    except RunError as error:  # of what has ended well the next call finds the end state
        kind, message = "failed", str(error)
    except OSError as error:
        kind, message = "failed", f"{home}: cannot be written ({error.strerror})"
    return kind, message


def _launch(home: Path, words: list[str], ranks: int) -> Ended:
    """Run one combination from its checkpoint, or from the start; return how it has ended."""
    begin = [*words, "-output_dir", str(home)]
    if (home / "checkpoint.h5").is_file():
        begin += ["-restart", str(home / "checkpoint.h5")]
    else:
        _move_aside(home)
    status, message = run_program(begin, ranks)
    if status == 0:
        reason = read_file(home / "summary.json", read_summary)["reason"]
        return ("done", "") if reason in GOOD else ("interrupted", reason)
    if status == 2:
        return "stopped", message
    if status == 1 and "-restart" not in begin:  # are the options what is wrong? This sets all up and writes nothing:
        status, asked = run_program([*words, "-help", "all"], ranks)
        if status == 1 and asked.startswith("-"):
            return "refused", message
    return "failed", message


def _move_aside(home: Path) -> None:
    """Rename a folder in which a run has begun, which was killed before its first checkpoint; not that of a live one."""
    if not any((home / name).exists() for name in ("series.csv", "run.h5")):
        return
    with (home / "run.lock").open("a") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return  # the program says by whom it is used
        aside = next(name for k in itertools.count(1) if not (name := home.with_name(f"{home.name}~{k}")).exists())
        home.rename(aside)
        (aside / "run.lock").unlink()


def _row(home: Path, ended: Ended) -> dict[str, object]:
    """Return what sweep.csv says of a run besides its options; the last row of its series when it has one."""
    row: dict[str, object] = {"folder": home.name, "status": ended[0], "message": ended[1]}
    with contextlib.suppress(FileNotFoundError, ValueError):
        text = (home / "series.csv").read_text()
        *_, last = csv.DictReader(text[: text.rfind("\n") + 1].splitlines())
        row |= last
    return row


def _write(folder: Path, points: list[dict[str, str]], ended: dict[str, Ended]) -> Path:
    """Write sweep.csv of the runs that have ended, in the grid's order."""
    rows = [{**point, **_row(folder / _name(point), ended[_name(point)])} for point in points if _name(point) in ended]
    names = list(dict.fromkeys(itertools.chain(points[0], ("folder", "status", "message"), *rows)))
    text = io.StringIO()
    writer = csv.DictWriter(text, names, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return write_text(folder / "sweep.csv", text.getvalue())
