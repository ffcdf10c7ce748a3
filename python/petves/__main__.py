"""Command line: ``petves`` of pip, ``python3 -m petves``: ``run|plot|movie|watch|report|compare|sweep|numbers|scenes ...``."""

import argparse
import difflib
import io
import os
import re
import signal
import sys
from pathlib import Path
from typing import Any

import petves
from petves import laboratory, sweeps
from petves.errors import Error
from petves.program import become, scene_file, scene_files, scenes

TOOLS = ("plot", "movie", "watch", "report", "compare", "sweep", "numbers", "scenes")
"""The commands; other words are the program's own."""
LEFT_OUT = {"argument_default": argparse.SUPPRESS}
"""Of parsers whose options, where they are left out, have the function's own defaults."""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    top = argparse.ArgumentParser(prog="petves", description="Run, draw, film, compare, sweep and report scenes.")
    commands = top.add_subparsers(dest="command", required=True)
    commands.add_parser("run", help="run a scene: run SCENE.opts -option value ...; run -help, run -help options")
    _add_pictures(commands)
    _add_tables(commands)
    return top


def _add_pictures(commands: argparse._SubParsersAction) -> None:
    run, seen = (argparse.ArgumentParser(add_help=False, **LEFT_OUT) for _ in range(2))
    run.add_argument("folder", metavar="DIR", help="the run's -output_dir")
    seen.add_argument("--cmap", metavar="NAME", help="matplotlib's colour map of the speed (viridis)")
    following = dict(nargs="?", const=1, metavar="VESICLE", help="follow a vesicle (1) in a periodic box")
    seen.add_argument("--follow", type=int, **following)
    both = dict(parents=[run, seen], **LEFT_OUT)
    plot = commands.add_parser("plot", **both, help="draw a run's folder into pictures in that folder")
    plot.add_argument("--format", metavar="FORMAT", help="png, pdf or svg (png)")
    plot.add_argument("--dpi", type=float, help="dots an inch (120)")
    plot.add_argument("--width", type=float, metavar="INCHES", help="width of each picture; letters keep their size")
    plot.add_argument("--time", type=float, help="field and tension, or --line, --walls, at the nearest saved time")
    names = dict(nargs="+", metavar="NAME")
    plot.add_argument("--column", dest="columns", **names, help="columns of series.csv over time")
    plot.add_argument("--field", dest="fields", **names, help="membranes over fields: vorticity, ...")
    point = dict(nargs=2, type=float, action="append", metavar=("X", "Y"))
    plot.add_argument("--point", dest="points", **point, help="u, v, p at a point over time; again for a further one")
    plot.add_argument("--line", nargs=4, type=float, metavar=("X", "Y", "X", "Y"), help="u, v, p along a line")
    plot.add_argument("--walls", action="store_true", help="the shear stress along the walls")
    film = commands.add_parser("movie", **both, help="film the membrane over the flow: mp4 (with ffmpeg) or gif")
    film.add_argument("--output", metavar="FILE", help="FILE.mp4 or FILE.gif (movie.mp4 or movie.gif in DIR)")
    film.add_argument("--field", metavar="NAME", help="under it: speed, pressure, ... (speed)")
    film.add_argument("--rate", type=float, help="pictures a second (15)")
    film.add_argument("--every", type=int, metavar="N", help="one saved time in N (1)")
    film.add_argument("--from", type=float, dest="begin", metavar="TIME", help="first time (the first saved)")
    film.add_argument("--to", type=float, dest="end", metavar="TIME", help="last time (the last saved)")
    film.add_argument("--width", type=int, metavar="PIXELS", help="width of the film (1080)")
    film.add_argument("--streamlines", action="store_true", help="streamlines too")
    told = "draw a run that goes on into watch.html, anew until it ends"
    live = commands.add_parser("watch", parents=[run], help=told)
    live.add_argument("--every", type=float, default=10, metavar="SECONDS", help="between two drawings (10)")
    told = "write one HTML file about a run that opens anywhere, offline"
    page = commands.add_parser("report", parents=[run], help=told)
    page.add_argument("--output", metavar="FILE", help="the file (report.html in DIR)")


def _add_tables(commands: argparse._SubParsersAction) -> None:
    both = commands.add_parser("compare", help="options, series and membranes of two runs, side by side")
    both.add_argument("first", metavar="RUN", help="a run's -output_dir")
    both.add_argument("second", metavar="RUN", help="another's")
    both.add_argument("--output", metavar="FILE", help="the picture (compare.png in the first)")
    grid = commands.add_parser("sweep", help="run a grid of options, several at a time, into one table")
    grid.add_argument("folder", metavar="DIR", help="where the runs and sweep.csv go; a second call goes on")
    grid.add_argument("--options-file", metavar="FILE", help="options that all runs share")
    varied = dict(nargs="+", action="append", required=True, metavar=("OPTION", "VALUE"))
    each = "an option without its dash and its values; again for each further option"
    grid.add_argument("--vary", **varied, help=each)
    grid.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time (one a core)")
    grid.add_argument("--ranks", type=int, default=1, help="MPI ranks of each run (1)")
    words = dict(nargs="?", const="", metavar="WORDS")
    grid.add_argument("--slurm", **words, help="submit it as a job array, one run a task, with these words for sbatch")
    told = "options of a scene, and chi and Re, from numbers in SI units"
    cell = commands.add_parser("numbers", help=told, **LEFT_OUT)
    for name, needed, what in (
        ("radius", True, "perimeter/(2 pi), m"),
        ("bending", True, "bending modulus, J"),
        ("viscosity", True, "dynamic viscosity outside, Pa s"),
        ("inside", False, "dynamic viscosity inside, Pa s (the same)"),
        ("rate", False, "rate of shear or extension, 1/s"),
        ("reduced-area", False, "area/(pi radius^2) (0.7)"),
        ("density", False, "of both fluids, kg/m^3 (1000)"),
    ):
        cell.add_argument(f"--{name}", type=float, required=needed, metavar="X", help=what)
    cell.add_argument("--flow", choices=("shear", "extension"), help="shear")
    commands.add_parser("scenes", help="list the scenes that run takes by name: petves run shear")


def _run(command: str, words: dict[str, Any]) -> list[object]:
    """Run one command with its arguments; return the lines to print."""
    if command in ("plot", "movie"):
        from petves.views.figures import Look

        own = ("format", "dpi", "width", "cmap", "follow") if command == "plot" else ("cmap", "follow")
        words["look"] = Look(**{name: words.pop(name) for name in own if name in words})
    if command == "scenes":
        return scenes()
    if command == "numbers":
        return laboratory.lines(**words)
    if command == "sweep":
        words["grid"] = {option.lstrip("-"): values for option, *values in words.pop("vary")}
        if words["slurm"] is not None:
            del words["jobs"]
            return [sweeps.submit(**words)]
        del words["slurm"]
    found = getattr(petves, command)(**words)
    if command == "compare":
        return [*found[0], found[1]]
    return found if isinstance(found, list) else [found]


def main(arguments: list[str] | None = None) -> int:
    """Run one command, that of the process when it is left out; return the exit status.

    0: done. 1: something is missing or failed, and one line on stderr says what, of a sweep one a run.
    """
    given = sys.argv[1:] if arguments is None else arguments
    try:
        first = given[0] if given else ""
        if first and first not in (*TOOLS, "-h", "--help"):  # the program's own words
            at = int(first == "run")
            own = [*given[:at], *map(scene_file, given[at : at + 1]), *given[at + 1 :]]
            if not at and first != "help" and first[0] != "-" and not os.path.exists(own[0]):
                near = difflib.get_close_matches(first, [*TOOLS, *scene_files()], 1)
                allowed = f"petves {near[0]} is meant?" if near else "allowed: -name value, or what petves help lists"
                raise Error(f'"{first}": no option, file, scene or command; {allowed}')
            return become(own)
        dashed = re.compile("-[a-z][a-z_-]+")  # an option with one dash, as those of runs have
        given = [f"-{word.replace('_', '-')}" if dashed.fullmatch(word) else word for word in given]
        words = vars(parser().parse_args(given))
        command = words.pop("command")
        if isinstance(sys.stdout, io.TextIOWrapper):
            sys.stdout.reconfigure(errors="surrogateescape")  # names of folders may be any bytes
        lines = _run(command, words)
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader may have seen enough: petves scenes | head
        for line in lines:
            print(line)
        left = sweeps.failures(lines[0]) if command == "sweep" and isinstance(lines[0], Path) else []
        for line in left:
            print(f"petves: error: {line}", file=sys.stderr)
        return 1 if left else 0
    except Error as error:
        print(f"petves: error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("petves: stopped; the same command goes on", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
