"""The path of a new user: every command of README and of the how-to pages is run, and prints what the page says.
The notebooks of docs/ run, and the outputs stored in them are those that they have today.

A page's blocks run in order in one folder. `opts` is a file, whose name is its first comment. `console` has commands
behind `$ ` and what each prints: `...` is any lines, seconds are free, numbers agree to a thousandth. `python` is a
script, `sh` lines for the shell; a `text` block behind them is what they print. A comment "not run: why" stands before a
block that is not run.
"""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Iterator, NamedTuple

import nbformat
import notebooks
import pytest
from harness import ENVIRONMENT, PACKAGE, PETVES, ROOT, SANITIZE

INDEX = (ROOT / "docs" / "pages.md").read_text()
HOW_TO = re.findall(r"\((\w+\.md)\)", INDEX.split("## How to")[1].split("\n## ")[0])
BLOCK = re.compile(r"(<!-- not run: .*? -->\n)?^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
KINDS = ("opts", "console", "python", "sh", "text")
RELATIVE, SMALL = 1e-3, 1e-6


class Command(NamedTuple):
    """What to start, and the lines that it should print."""

    words: list[str]
    expected: list[str]


def blocks(page: str) -> list[tuple[str, str]]:
    """Return kind and text of the blocks of a page that are run."""
    found = [(kind, text) for skipped, kind, text in BLOCK.findall(page) if not skipped]
    assert all(kind in KINDS for kind, _ in found), "each block says what it is"
    return found


def commands(page: str, folder: Path) -> Iterator[Command]:
    """Yield the commands of a page in order; files are written when their turn comes."""
    found = blocks(page)
    for (kind, text), (after, printed) in zip(found, found[1:] + [("", "")]):
        if kind == "opts":
            (folder / re.match(r"# (\S+)\n", text)[1]).write_text(text)
        elif kind == "console":
            for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
                line, *expected = part.splitlines()
                yield Command(["bash", "-c", line], expected)
        elif kind in ("python", "sh"):
            start = [sys.executable, "-c"] if kind == "python" else ["bash", "-ec"]
            yield Command([*start, text], printed.splitlines() if after == "text" else ["..."])


def number(word: str) -> float | None:
    try:
        return float(word.strip(",:()"))
    except ValueError:
        return None


def alike(expected: str, printed: str) -> bool:
    """Return whether two lines say the same: seconds are free, numbers agree to RELATIVE or are both SMALL."""
    one, two = expected.split(), printed.split()
    if len(one) != len(two):
        return False
    for a, b, unit in zip(one, two, one[1:] + [""]):
        x, y = number(a), number(b)
        if a == b or (x is not None and y is not None and unit == "s"):
            continue
        if x is None or y is None or (abs(x - y) > RELATIVE * abs(x) and max(abs(x), abs(y)) > SMALL):
            return False
    return True


def prints(expected: list[str], printed: list[str]) -> bool:
    """Return whether the lines are those expected, where ... stands for any, none too."""
    if not expected:
        return not printed
    if expected[0] == "...":
        return any(prints(expected[1:], printed[k:]) for k in range(len(printed) + 1))
    return bool(printed) and alike(expected[0], printed[0]) and prints(expected[1:], printed[1:])


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A folder with the scenes and the program of a clone, and petves on the path as after make install."""
    (tmp_path / "runs").symlink_to(ROOT / "runs")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "petves").symlink_to(Path(PETVES).resolve())
    for name, value in {**ENVIRONMENT, **PACKAGE}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.skipif(SANITIZE, reason="a sanitized library cannot be loaded into Python")
@pytest.mark.parametrize("name", ["README.md", *(f"docs/{page}" for page in HOW_TO)])
def test_page_prints_what_it_says(name, clone):
    for command in commands((ROOT / name).read_text(), clone):
        done = subprocess.run(command.words, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
        wrong = any(line.startswith("petves: error") for line in command.expected)
        said = f"{command.words[-1]}\n{done.stdout}{done.stderr}"
        assert (done.returncode != 0) == wrong, said
        assert prints(command.expected, (done.stderr if wrong else done.stdout).splitlines()), said


def printed_by(cell: nbformat.NotebookNode) -> list[str]:
    """Return the lines that a cell has printed."""
    return "".join(out.text for out in cell.get("outputs", []) if out.output_type == "stream").splitlines()


def shown(cell: nbformat.NotebookNode) -> int:
    """Return how many pictures a cell shows."""
    return sum(out.output_type == "display_data" and "image/png" in out.data for out in cell.get("outputs", []))


@pytest.mark.skipif(SANITIZE, reason="a sanitized library cannot be loaded into Python")
@pytest.mark.parametrize("name", notebooks.NAMES)
def test_stored_outputs_are_todays(name, tmp_path, monkeypatch):
    for variable, value in {**ENVIRONMENT, **PACKAGE, "PETVES": PETVES}.items():
        monkeypatch.setenv(variable, value)
    stored = nbformat.read(ROOT / "docs" / f"{name}.ipynb", as_version=4).cells
    today = notebooks.executed(name, tmp_path).cells
    assert sum(bool(printed_by(cell)) for cell in stored) >= 2 and sum(map(shown, stored)) >= 1
    for old, new in zip(stored, today):
        said = printed_by(old), printed_by(new)
        assert prints(*said), (f"python3 tests/support/notebooks.py {name}", *said)
        assert shown(old) == shown(new), old.source


def test_pages_have_blocks_that_run():
    pages = [ROOT / "README.md", *(ROOT / "docs" / page for page in HOW_TO)]
    assert sum(len(blocks(page.read_text())) for page in pages) >= 18


def test_wrong_lines_are_found():
    assert alike("angle 0.387785, 0.8 s", "angle 0.387786, 1.3 s") and not alike("angle 0.3877", "angle 0.3900")
    assert not prints(["angle 0.416 rad"], ["angle 0.418 rad"]) and prints(["angle 0.4160 rad"], ["angle 0.4161 rad"])
    assert alike("left 2.6e-15", "left 1.0e-14") and not alike("left 2.6e-15", "left 1.0e-3")
    assert prints(["...", "b", "..."], ["a", "b"]) and not prints(["...", "b"], ["a", "b", "c"])
    assert not prints([], ["a"]) and not prints(["a"], [])
