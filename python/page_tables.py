"""Pages that are read outside the repository: the site, of which mkdocs.yml makes this module a hook, and installed pages.

A line of a page that is nothing but a link to a CSV file stands for its table: ``[What it shows](evidence/steady.csv)``. Where the
repository is read the link opens the file; in the site and in the pages that ``make install`` puts under PREFIX the table follows
the link. ``python3 python/page_tables.py docs FOLDER`` writes the latter, with the pictures and pages that they link to.
"""

from __future__ import annotations

import csv
import logging
import re
import shutil
import sys
from pathlib import Path

LINK = re.compile(r"^\[([^\]]+)\]\(([\w./-]+\.csv)\)$", re.MULTILINE)
FILE = re.compile(r"\]\((\w[\w./-]*)[)#]")
#: Columns of what is typed, shown as code.
CODE = ("options", "command")
WIDE = 50  # letters of a piece of code
KATEX = Path("/usr/share/javascript/katex")  # of Debian's libjs-katex


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


def on_files(files, config):  # noqa: ANN001, ANN201 (types of MkDocs)
    """Add what lies outside docs/: README as the home page, the pages beside it, and KaTeX, which sets equations."""
    from mkdocs.structure.files import File

    logging.getLogger("traitlets").setLevel(logging.ERROR)  # pictures of notebooks have no alternative text
    root = Path(config.config_file_path).parent
    for name, place in (("README.md", "index.md"), ("CONTRIBUTING.md",) * 2, ("CHANGELOG.md",) * 2):
        files.append(File.generated(config, place, content=(root / name).read_text().replace("](docs/", "](")))
    for path in (KATEX / name for name in ("katex.min.css", "katex.min.js", "contrib/auto-render.js")):
        files.append(File.generated(config, f"katex/{path.relative_to(KATEX)}", abs_src_path=str(path)))
    for path in KATEX.glob("fonts/*.woff2"):
        files.append(File.generated(config, f"katex/fonts/{path.name}", abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, page, config, files) -> str:  # noqa: ANN001 (types of MkDocs)
    """Fill in the tables of a page of the site."""
    return filled(markdown, Path(page.file.abs_src_path).parent) if page.file.abs_src_path else markdown


def main(source: str, target: str) -> None:
    """Write the pages of a folder, with their tables, into another, and what they link to within the folder."""
    home = Path(source).resolve()
    for page in home.rglob("*.md"):
        text, made = page.read_text(), Path(target) / page.relative_to(home)
        made.parent.mkdir(parents=True, exist_ok=True)
        made.write_text(filled(text, page.parent))
        for link in FILE.findall(text):
            linked = (page.parent / link).resolve()
            if linked.suffix != ".md" and linked.is_relative_to(home) and linked.is_file():
                copy = Path(target) / linked.relative_to(home)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(linked, copy)


if __name__ == "__main__":
    main(*sys.argv[1:])
