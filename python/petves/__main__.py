"""Command line: ``python3 -m petves plot|movie|compare|sweep|report|reproduce|accuracy|inertia|stability ...``."""

from __future__ import annotations

import argparse
import os
import sys
from typing import Iterable


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    top = argparse.ArgumentParser(prog="petves", description="Draw, film, compare, sweep and report petves runs.")
    commands = top.add_subparsers(dest="command", required=True)
    _add_pictures(commands)
    _add_tables(commands)
    _add_studies(commands)
    return top


def _add_pictures(commands: argparse._SubParsersAction) -> None:
    plot = commands.add_parser("plot", help="draw a run's folder into PNG files in that folder")
    plot.add_argument("folder", metavar="DIR", help="the run's -output_dir")
    film = commands.add_parser("movie", help="film the membrane over the flow: mp4 (with ffmpeg) or gif")
    film.add_argument("folder", metavar="DIR", help="the run's -output_dir")
    film.add_argument("--output", metavar="FILE", help="FILE.mp4 or FILE.gif (movie.mp4 or movie.gif in DIR)")
    film.add_argument("--field", choices=("speed", "pressure"), default="speed", help="under the membrane (speed)")
    film.add_argument("--rate", type=float, default=15, help="pictures a second (15)")
    page = commands.add_parser("report", help="write one HTML file about a run that opens anywhere, offline")
    page.add_argument("folder", metavar="DIR", help="the run's -output_dir")
    page.add_argument("--output", metavar="FILE", help="the file (report.html in DIR)")


def _add_tables(commands: argparse._SubParsersAction) -> None:
    both = commands.add_parser("compare", help="options, series and membranes of two runs, side by side")
    both.add_argument("first", metavar="RUN", help="a run's -output_dir")
    both.add_argument("second", metavar="RUN", help="another's")
    both.add_argument("--output", metavar="FILE", default="compare.png", help="the picture (compare.png)")
    grid = commands.add_parser("sweep", help="run a grid of options, several at a time, into one table")
    grid.add_argument("folder", metavar="DIR", help="where the runs and sweep.csv go; a second call goes on")
    grid.add_argument("--options-file", metavar="FILE", help="options that all runs share")
    grid.add_argument(
        "--vary",
        nargs="+",
        action="append",
        required=True,
        metavar=("OPTION", "VALUE"),
        help="an option without its dash and its values; again for each further option",
    )
    grid.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time (one a core)")
    grid.add_argument("--ranks", type=int, default=1, help="MPI ranks of each run (1)")


def _add_studies(commands: argparse._SubParsersAction) -> None:
    again = commands.add_parser("reproduce", help="run the studies: the paper's tables and the coupled scheme's")
    again.add_argument("folder", metavar="DIR", help="where the tables and pictures go")
    again.add_argument("--quick", action="store_true", help="coarse grids only (also QUICK=1)")
    again.add_argument("--only", choices=("paper", "coupled"), help="the paper's studies, or the coupled scheme's")
    again.add_argument(
        "--write-only", action="store_true", help="with --only paper: the page from the runs that are there"
    )
    again.add_argument("--ranks", type=int, default=2, help="MPI ranks of every run (2)")
    cells = commands.add_parser("accuracy", help="run the study of accuracy per cell: docs/accuracy.md's tables")
    cells.add_argument("folder", metavar="DIR", help="where the tables and the picture go")
    cells.add_argument("--quick", action="store_true", help="leave out 256^2")
    inertia = commands.add_parser("inertia", help="run the study of the fluid's inertia: docs/inertia.md's tables")
    inertia.add_argument("folder", metavar="DIR", help="where the tables and the pictures go")
    inertia.add_argument("--quick", action="store_true", help="leave out the channels")
    automatic = commands.add_parser("calibrate", help="measure what -scheme_auto chooses by: calibration.csv")
    automatic.add_argument("folder", metavar="DIR", help="where the table goes")
    maps = commands.add_parser("stability", help="run the stability maps: docs/stability.md's tables and pictures")
    maps.add_argument("folder", metavar="DIR", help="where the tables and the pictures go")
    maps.add_argument("--quick", action="store_true", help="only the corners of each map (also QUICK=1)")


def _run(options: argparse.Namespace) -> Iterable[object]:
    """Run one command; return the lines to print."""
    if options.command == "plot":
        from petves.plot import plot_run

        return plot_run(options.folder)
    if options.command == "movie":
        from petves.movie import movie

        return [movie(options.folder, options.output, options.field, options.rate)]
    if options.command == "report":
        from petves.report import report

        return [report(options.folder, options.output)]
    if options.command == "compare":
        from petves.compare import compare

        lines, picture = compare(options.first, options.second, options.output)
        return [*lines, picture]
    if options.command == "sweep":
        from petves.sweep import sweep

        grid = {words[0].lstrip("-"): words[1:] for words in options.vary}
        return [sweep(options.folder, grid, options.options_file, options.jobs, options.ranks)]
    if options.command == "accuracy":
        from petves.accuracy import accuracy

        return accuracy(options.folder, quick=options.quick)
    if options.command == "inertia":
        from petves.inertia import inertia

        return inertia(options.folder, quick=options.quick)
    if options.command == "calibrate":
        from petves.calibration import calibrate

        return calibrate(options.folder)
    quick = options.quick or os.environ.get("QUICK", "") not in ("", "0")
    if options.command == "stability":
        from petves.stability import stability

        return stability(options.folder, quick=quick)
    from petves.reproduce import reproduce

    return reproduce(options.folder, quick=quick, ranks=options.ranks, only=options.only, run=not options.write_only)


def main(arguments: list[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : list of str, optional
        Words of the command line; those of the process when left out.

    Returns
    -------
    int
        Exit status: 0 done, 1 something is missing or failed (one line on stderr says what).
    """
    options = parser().parse_args(arguments)
    from petves.errors import Error

    try:
        for line in _run(options):
            print(line)
    except Error as error:
        print(f"petves: error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("petves: stopped; the same command goes on", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
