"""Check that README.md names every option of ``petves -help`` with its default; print what is missing, exit 1.

With ``--table``, print the README's table of options instead.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

README = Path(__file__).resolve().parent.parent / "README.md"


LINE = re.compile(
    r"^  (-\w+) <now (.*?) : formerly .*?>: (.*?)(?: \[(\[[^\]\n]*\]|[^\]\n]*)\])? \(README\.md\)$", re.MULTILINE
)


def described(binary: str) -> list[tuple[str, str, str, str]]:
    """Return name, default, description and allowed values of petves' own options, from its help."""
    return LINE.findall(subprocess.run([binary, "-help"], capture_output=True, text=True, check=True).stdout)


def options(binary: str) -> dict[str, str]:
    """Return petves' own options and their defaults."""
    return {name: default for name, default, _, _ in described(binary)}


def table(binary: str) -> str:
    """Return the README's rows of options."""
    rows = []
    for name, default, what, allowed in described(binary):
        shown = f"`{default}`" if default.strip() else ""
        rows.append(f"| `{name}` | {shown} | {allowed.replace('|', ', ')} | {what.replace('|', chr(92) + '|')} |")
    return "\n".join(rows)


def missing(binary: str, readme: str) -> list[str]:
    """Return a line for each option that the README lacks, or gives another default."""
    rows = dict(re.findall(r"^\| `(-\w+)` \| ([^|]*?) \|", readme, re.MULTILINE))
    wrong = []
    for name, default in options(binary).items():
        shown = rows.get(name)
        if shown is None:
            wrong.append(f"README.md: {name} is missing")
        elif shown.strip("` ") != default.strip():
            wrong.append(f"README.md: {name} has the default {shown}; the program's is {default}")
    return wrong + [f"README.md: {name} is no option" for name in rows if name not in options(binary)]


def main() -> int:
    """Check; return the exit status."""
    binary = os.environ.get("PETVES", "bin/petves")
    if "--table" in sys.argv[1:]:
        print(table(binary))
        return 0
    lines = missing(binary, README.read_text())
    print("\n".join(lines) or "README.md names every option")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
