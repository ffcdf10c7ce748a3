"""Command line: ``python3 -m petves plot|reproduce|accuracy|inertia DIR``."""

from __future__ import annotations

import argparse
import os
import sys


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    top = argparse.ArgumentParser(prog="petves", description="Draw petves runs, and repeat the studies.")
    commands = top.add_subparsers(dest="command", required=True)
    plot = commands.add_parser("plot", help="draw a run's folder into PNG files in that folder")
    plot.add_argument("folder", metavar="DIR", help="the run's -output_dir")
    again = commands.add_parser("reproduce", help="run the studies: the paper's tables and the coupled scheme's")
    again.add_argument("folder", metavar="DIR", help="where the tables and pictures go")
    again.add_argument("--quick", action="store_true", help="coarse grids only (also QUICK=1)")
    again.add_argument("--only", choices=("paper", "coupled"), help="the paper's studies, or the coupled scheme's")
    again.add_argument("--ranks", type=int, default=2, help="MPI ranks of every run (2)")
    cells = commands.add_parser("accuracy", help="run the study of accuracy per cell: docs/accuracy.md's tables")
    cells.add_argument("folder", metavar="DIR", help="where the tables and the picture go")
    cells.add_argument("--quick", action="store_true", help="leave out 256^2")
    inertia = commands.add_parser("inertia", help="run the study of the fluid's inertia: docs/inertia.md's tables")
    inertia.add_argument("folder", metavar="DIR", help="where the tables and the pictures go")
    inertia.add_argument("--quick", action="store_true", help="leave out the channels")
    return top


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
    from petves.run import RunError

    try:
        if options.command == "plot":
            from petves.plot import plot_run

            for path in plot_run(options.folder):
                print(path)
        elif options.command == "accuracy":
            from petves.accuracy import accuracy

            for path in accuracy(options.folder, quick=options.quick):
                print(path)
        elif options.command == "inertia":
            from petves.inertia import inertia

            for path in inertia(options.folder, quick=options.quick):
                print(path)
        else:
            from petves.reproduce import reproduce

            quick = options.quick or os.environ.get("QUICK", "") not in ("", "0")
            for path in reproduce(options.folder, quick=quick, ranks=options.ranks, only=options.only):
                print(path)
    except RunError as error:
        print(f"petves: error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
