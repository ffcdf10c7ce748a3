"""Tables in Markdown and CSV."""

from __future__ import annotations

import csv
import io
from pathlib import Path


def table(header: list[str], rows: list[list[str]]) -> list[str]:
    """Return the lines of a Markdown table, and an empty one."""
    lines = [header, ["---"] * len(header), *rows]
    return ["| " + " | ".join(line) + " |" for line in lines] + [""]


def csv_text(header: list[str], rows: list[list[object]]) -> str:
    """Return the text of a CSV file."""
    file = io.StringIO(newline="")
    csv.writer(file, lineterminator="\n").writerows([header, *rows])
    return file.getvalue()


def write_csv(path: Path, header: list[str], rows: list[list[object]]) -> Path:
    """Write a CSV file; return its path."""
    path.write_text(csv_text(header, rows))
    return path
