"""Check that docs/options.md has the rows of ``petves -help options``, and python/petves/options.pyi the names; exit 1 if not.

What is missing is printed. With ``--write``, the page's tables and the stub are written anew instead.
"""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

PAGE = Path(__file__).resolve().parent.parent / "docs" / "options.md"
STUB = PAGE.parent.parent / "python" / "petves" / "options.pyi"
OF_SOLVERS = [
    f"{prefix}_ksp_{name}" for prefix in ("coupled", "tension", "bending") for name in ("rtol", "max_it", "monitor")
]
STUB_HEAD = '''# fmt: off
"""The program's options, for editors that complete names; python/check_options.py --write makes this file."""

from collections.abc import Sequence
from os import PathLike
from typing import Literal, TypedDict

import numpy as np

Value = str | float | bool | PathLike[str] | np.ndarray | Sequence[str | float | Sequence[float]] | None

class Options(TypedDict, total=False):
'''

ENTRY = re.compile(r"^  (-\w+)(?: (\S+))?(?:  \[(.*)\])?\n((?:      .*\n?)+)", re.MULTILINE)
BEGIN, END = "<!-- begin: python/check_options.py --write makes these tables -->\n", "<!-- end -->\n"


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


def row(option: Option) -> str:
    """Return an option's row of a table."""
    default = f"`{option.default}`" if option.default else ""
    what = re.sub(r"([|*])", r"\\\1", option.what)
    return f"| `{option.name}` | {default} | {option.allowed.replace('|', ', ')} | {what} |"


def tables(binary: str) -> str:
    """Return the page's tables: a heading and a table for each group of options."""
    parts = []
    for group, members in itertools.groupby(described(binary), lambda option: option.group):
        head = f"## {group}\n\n| option | default | allowed | what |\n|---|---|---|---|\n"
        parts.append(head + "\n".join(map(row, members)) + "\n")
    return "\n".join(parts)


def stub(binary: str) -> str:
    """Return the stub: each option with its words, or any value, and what it is."""
    lines = []
    for option in described(binary):
        words = option.allowed.split("|") if "|" in option.allowed and "one a vesicle" not in option.what else []
        kind = f"Literal[{', '.join(map(repr, words))}] | None" if words else "Value"
        lines.append(f"    {option.name[1:]}: {kind}  # {option.what}\n")
    return STUB_HEAD + "".join(lines) + "".join(f"    {name}: Value  # PETSc's, of the solver\n" for name in OF_SOLVERS)


def missing(binary: str, page: str) -> list[str]:
    """Return a line for each row that the page's tables lack, or have too much."""
    shown = dict.fromkeys(re.findall(r"^\| `-.*\|$", page.partition(BEGIN)[2].partition(END)[0], re.MULTILINE))
    wanted = dict.fromkeys(map(row, described(binary)))
    wrong = [f"docs/options.md lacks {line}" for line in wanted if line not in shown]
    return wrong + [f"docs/options.md has {line}" for line in shown if line not in wanted]


def main() -> int:
    """Check, or write; return the exit status."""
    binary = os.environ.get("PETVES", "bin/petves")
    page = PAGE.read_text()
    if "--write" in sys.argv[1:]:
        before, _, rest = page.partition(BEGIN)
        PAGE.write_text(before + BEGIN + "\n" + tables(binary) + "\n" + END + rest.partition(END)[2])
        STUB.write_text(stub(binary))
        return 0
    lines = missing(binary, page) + ([] if STUB.read_text() == stub(binary) else [f"{STUB} is not current"])
    print("\n".join(lines) or "docs/options.md has every option")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
