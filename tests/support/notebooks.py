"""Run the notebooks of docs/ and write today's outputs into them: python3 tests/support/notebooks.py [tutorial study].

tests/repo/test_newcomer.py compares what the notebooks have with what they print.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

DOCS = Path(__file__).resolve().parents[2] / "docs"
NAMES = ("tutorial", "study")


def executed(name: str, folder: str | Path) -> nbformat.NotebookNode:
    """Return a notebook with the outputs that it makes now; its files go to a folder."""
    notebook = nbformat.read(DOCS / f"{name}.ipynb", as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.update(outputs=[], execution_count=None)
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


def main() -> None:
    """Run the notebooks named, or all."""
    for name in sys.argv[1:] or NAMES:
        with tempfile.TemporaryDirectory() as folder:
            notebook = executed(name, folder)
        for cell in notebook.cells:
            cell.metadata.pop("execution", None)
        nbformat.write(notebook, DOCS / f"{name}.ipynb")


if __name__ == "__main__":
    main()
