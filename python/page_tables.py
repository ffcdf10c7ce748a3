"""Tables of pages, from CSV files.

A line of a page that is nothing but a link to a CSV file stands for its table: ``[What it shows](evidence/steady.csv)``. Where the
repository is read the link opens the file; in the site, of which mkdocs.yml makes this module a hook, and in the pages that
``make install`` puts under PREFIX the table follows the link. ``python3 python/page_tables.py docs FOLDER`` writes the latter.
"""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path

LINK = re.compile(r"^\[([^\]]+)\]\(([\w./-]+\.csv)\)$", re.MULTILINE)
#: Columns of what is typed, shown as code.
CODE = ("options", "command")
WIDE = 50  # letters of a piece of code


def code(text: str) -> str:
    """Return options as code, each with its value in a piece of its own, so that a line of the table may end behind it."""
    pieces = []
    for option in re.split(r" (?=-[A-Za-z])", text):
        while len(option) > WIDE and "," in option[:WIDE]:
            end = option[:WIDE].rindex(",") + 1
            pieces.append(option[:end])
            option = option[end:]
        pieces.append(option)
    return " ".join(f"`{piece}`" for piece in pieces)


def cell(column: str, text: str) -> str:
    """Return the Markdown of a cell."""
    text = text.replace("|", "\\|")
    return code(text) if column in CODE and text else text


def table(path: Path) -> str:
    """Return the Markdown table of a CSV file."""
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    lines = [[cell("", name) for name in header], ["---"] * len(header)]
    lines += [[cell(name, text) for name, text in zip(header, row, strict=True)] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def filled(markdown: str, folder: Path) -> str:
    """Return a page with its tables in place; links lead from its folder. A file outside that folder is not linked."""

    def place(found: re.Match) -> str:
        caption = f"**{found[1]}**" if found[2].startswith("..") else found[0]
        return f"{caption}\n\n{table(folder / found[2])}"

    return LINK.sub(place, markdown)


def on_page_markdown(markdown: str, page, config, files) -> str:  # noqa: ANN001 (types of MkDocs)
    """Fill in the tables of a page of the site."""
    return filled(markdown, Path(page.file.abs_src_path).parent)


def main(source: str, target: str) -> None:
    """Write the pages of a folder, with their tables, into another."""
    Path(target).mkdir(parents=True, exist_ok=True)
    for page in sorted(Path(source).glob("*.md")):
        (Path(target) / page.name).write_text(filled(page.read_text(), page.parent))


if __name__ == "__main__":
    main(*sys.argv[1:])
