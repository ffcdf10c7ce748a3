"""Command line, in the repository: ``PYTHONPATH=python:. python3 -m studies STUDY DIR [--quick]``."""

from __future__ import annotations

import argparse
import os
import sys
from importlib import import_module

from petves.errors import Error

STUDIES = {
    "reproduce": ("reproduction.page", "the paper's tables and figures, and the coupled scheme's: docs/reproduction"),
    "chart": ("speed_accuracy.page", "error against CPU time of every scheme: docs/speed_accuracy"),
    "calibrate": ("speed_accuracy.calibration", "what -scheme_auto chooses by: docs/speed_accuracy/calibration.csv"),
    "unseen": (
        "speed_accuracy.unseen",
        "-scheme_auto on scenes it was not calibrated by: docs/speed_accuracy/unseen.csv",
    ),
    "stability": ("stability.page", "where each scheme fails: docs/stability"),
    "accuracy": ("accuracy.page", "accuracy per cell: docs/accuracy"),
    "inertia": ("inertia.page", "the fluid's inertia: docs/inertia"),
    "gallery": ("gallery.page", "what the field runs, beside published results: docs/gallery.md"),
    "narrow": (
        "gallery.narrow",
        "vesicles that nearly fill a tube, beside lubrication theory: docs/gallery/narrow.csv",
    ),
    "time": ("time.page", "what the time step leaves, by order and frame of the labels: docs/time"),
}
"""The module whose `write` makes each study's files, and what it studies."""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    top = argparse.ArgumentParser(prog="studies", description="Run what is not there yet of a study; write its pages.")
    commands = top.add_subparsers(dest="study", required=True)
    for name, (_, what) in STUDIES.items():
        one = commands.add_parser(name, help=what)
        one.add_argument("folder", metavar="DIR", help="where the tables and the pictures go; a second call goes on")
        one.add_argument("--quick", action="store_true", help="leave out the long runs (also QUICK=1)")
        if name == "reproduce":
            one.add_argument("--only", choices=("paper", "coupled"), help="the paper's part, or the coupled scheme's")
            one.add_argument("--write-only", action="store_false", dest="run", help="run nothing of the paper's part")
            one.add_argument("--ranks", type=int, default=2, help="MPI ranks of the paper's part (2)")
    return top


def main(arguments: list[str] | None = None) -> int:
    """Run one study; return the exit status: 1 when something is missing or failed, which one line on stderr says."""
    words = vars(parser().parse_args(arguments))
    words["quick"] |= os.environ.get("QUICK", "") not in ("", "0")
    try:
        for path in import_module(f"studies.{STUDIES[words.pop('study')][0]}").write(**words):
            print(path)
    except Error as error:
        print(f"studies: error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("studies: stopped; the same command goes on", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
