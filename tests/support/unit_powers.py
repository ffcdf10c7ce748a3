"""Powers of length and of time: of a unit such as length^3/time^2, of options by their help, and of columns."""

import functools
import re
import subprocess

from harness import PETVES

from petves.dataset import UNITS


def powers(unit: str) -> tuple[int, int]:
    over, _, under = unit.partition("/")

    def power(word: str, part: str) -> int:
        found = re.fullmatch(rf"{word}(?:\^(\d+))?", part)
        return int(found[1] or 1) if found else 0

    return power("length", over) - power("length", under), power("time", over) - power("time", under)


@functools.cache
def option_powers() -> dict[str, tuple[int, int]]:
    """By option, those whose text in the help has a unit in parentheses."""
    text = subprocess.run([PETVES, "-help", "options"], capture_output=True, text=True, check=True).stdout
    found = {}
    for name, words in re.findall(r"^  (-\w+)[^\n]*\n((?:      [^\n]*\n)+)", text, re.M):
        for part in re.findall(r"\(([^()]*)\)", " ".join(words.split())):
            if any(powers(part.split(";")[0])):
                found[name] = powers(part.split(";")[0])
    return found


def option_power(name: str) -> tuple[int, int]:
    """Of an option, or of two that end in _x and _y, without the dash."""
    known = option_powers()
    return known.get(f"-{name}", known.get(f"-{name}_x", (0, 0)))


def column_power(name: str) -> tuple[int, int]:
    """Of a column, or of two that end in _x and _y."""
    return powers(UNITS.get(name, UNITS.get(f"{name}_x", "")))
