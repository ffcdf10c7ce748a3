"""Check that README.md has the rows of ``petves -help options``; print what is missing, exit 1.

With ``--table``, print the README's table of options instead.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

README = Path(__file__).resolve().parent.parent / "README.md"

ENTRY = re.compile(r"^  (-\w+)(?: (\S+))?(?:  \[(.*)\])?\n((?:      .*\n?)+)", re.MULTILINE)


class Option(NamedTuple):
    """An option as ``-help options`` shows it."""

    name: str
    default: str
    what: str
    allowed: str
    group: str


def described(binary: str) -> list[Option]:
    """Return petves' own options, from its help."""
    text = subprocess.run([binary, "-help", "options"], capture_output=True, text=True, check=True).stdout
    options = []
    for group, entries in re.findall(r"^([A-Z].*)\n((?:  .*\n)+)", text, re.MULTILINE):
        for name, default, allowed, what in ENTRY.findall(entries):
            options.append(Option(name, default, " ".join(what.split()), allowed, group))
    return options


def table(binary: str) -> str:
    """Return the README's rows of options."""
    rows = []
    for option in described(binary):
        shown = f"`{option.default}`" if option.default else ""
        what = option.what.replace("|", chr(92) + "|")
        rows.append(f"| `{option.name}` | {shown} | {option.allowed.replace('|', ', ')} | {what} |")
    return "\n".join(rows)


def missing(binary: str, readme: str) -> list[str]:
    """Return a line for each row of four columns that the README lacks, or has too much."""
    shown = {row: None for row in re.findall(r"^\| `-\w+` \|.*\|$", readme, re.MULTILINE)}
    wanted = {row: None for row in table(binary).splitlines()}
    wrong = [f"README.md lacks {row}" for row in wanted if row not in shown]
    return wrong + [f"README.md has {row}" for row in shown if row not in wanted and row.count("|") > 4]


def main() -> int:
    """Check; return the exit status."""
    binary = os.environ.get("PETVES", "bin/petves")
    if "--table" in sys.argv[1:]:
        print(table(binary))
        return 0
    lines = missing(binary, README.read_text())
    print("\n".join(lines) or "README.md has every option")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
