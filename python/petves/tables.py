"""Tables in Markdown and CSV."""

from __future__ import annotations

import csv
from pathlib import Path


def table(header: list[str], rows: list[list[str]]) -> list[str]:
    """Return the lines of a Markdown table, and an empty one."""
    lines = [header, ["---"] * len(header), *rows]
    return ["| " + " | ".join(line) + " |" for line in lines] + [""]


def write_csv(path: Path, header: list[str], rows: list[list[object]]) -> None:
    """Write a CSV file."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)
