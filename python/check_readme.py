"""Check that README.md names every option of ``petves -help`` with its default; print what is missing, exit 1."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

README = Path(__file__).resolve().parent.parent / "README.md"


def options(binary: str) -> dict[str, str]:
    """Return petves' own options and their defaults, from its help."""
    text = subprocess.run([binary, "-help"], capture_output=True, text=True, check=True).stdout
    return dict(re.findall(r"^  (-\w+) <now (.*?) : formerly .*\(README\.md\)$", text, re.MULTILINE))


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
    lines = missing(os.environ.get("PETVES", "bin/petves"), README.read_text())
    print("\n".join(lines) or "README.md names every option")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
