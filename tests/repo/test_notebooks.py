"""The notebooks of docs/: they run, and the outputs stored in them are those that they have today."""


import nbformat
import notebooks
import pytest
from harness import ENVIRONMENT, PACKAGE, PETVES, ROOT, SANITIZE
from test_newcomer import prints


def printed(cell: nbformat.NotebookNode) -> list[str]:
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
    assert sum(bool(printed(cell)) for cell in stored) >= 2 and sum(map(shown, stored)) >= 1
    for old, new in zip(stored, today):
        said = printed(old), printed(new)
        assert prints(*said), (f"python3 tests/support/notebooks.py {name}", *said)
        assert shown(old) == shown(new), old.source


def test_a_changed_number_is_found():
    assert not prints(["angle 0.416 rad"], ["angle 0.418 rad"]) and prints(["angle 0.4160 rad"], ["angle 0.4161 rad"])
