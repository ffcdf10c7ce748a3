"""How the source is built: which folder may use which, without circles, no writes into other folders' structs, and files,
functions and structs of a size that can be read at once. docs/source.md has the folders in their order, house_exceptions.txt what is
still broken: its lines may only be struck, by ``python3 tests/repo/house.py``."""

import re
import subprocess
from pathlib import Path

import house
import pytest
from harness import ROOT
from house import LIMITS, Uses

ELSEWHERE = "DE" + "SIGN"  # a document that readers of this repository do not have


@pytest.fixture(scope="module")
def page() -> str:
    return (ROOT / "docs" / "source.md").read_text()


def test_every_folder_is_in_the_table(page):
    folders = {str(path.parent.relative_to(ROOT / "src")) for path in (ROOT / "src").rglob("*.c")}
    assert set(house.layers(page)) - {""} == folders


def test_names_of_the_page_are_in_the_source(page):
    """Functions by their CamelCase, and files."""
    source = "\n".join(path.read_text() for path in (ROOT / "src").rglob("*.[ch]"))
    names = set(re.findall(r"\b[A-Z][a-z]+(?:[A-Z][a-z]*)+\b", page)) - {"ParaView"}
    assert len(names) > 40
    assert not [name for name in names if not re.search(rf"\b{name}\b", source)]
    assert not [path for path in re.findall(r"\bsrc/[\w/]+\.[ch]\b", page) if not (ROOT / path).exists()]


def test_no_rule_is_broken_but_by_the_list():
    """The list is sorted, so that it merges, and has no line that nothing breaks."""
    assert len(house.tags(ROOT / "src")["function"]) > 1700, "they were found"
    new, struck, _ = house.judge(house.broken(), house.excepted())
    assert not new, house.text_of(new)
    assert not struck, f"run python3 tests/repo/house.py: {struck}"


def test_comments_and_pages_name_files_that_exist():
    names = {path.name for path in ROOT.rglob("*.[ch]")} | {"own.c"}  # of a reader of docs/install.md
    paths = [*(ROOT / "src").rglob("*.[ch]"), ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]
    texts = {path.name: re.sub(r"^#include.*", "", path.read_text(), flags=re.M) for path in paths}
    named = re.compile(r"(?<![\w.>&])\w{3,}\.[ch]\b(?!\[)")
    found = {(name, word) for name, text in texts.items() for word in named.findall(text)}
    assert len(found) > 100 and not {pair for pair in found if pair[1] not in names}


def test_nothing_refers_to_a_document_elsewhere():
    paths = [*house.code(), ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    assert not [str(path) for path in paths if re.search(rf"\b{ELSEWHERE}\b", path.read_text())]


# Each rule can fail:


def test_the_list_only_shrinks():
    listed = {"rooms src/a": 30, "circle b": 0, "function F": 70}
    new, struck, left = house.judge({"rooms src/a": 28, "circle b": 0, "circle c": 0}, listed)
    assert new == {"circle c": 0} and struck == ["function F"] and left == {"rooms src/a": 28, "circle b": 0}
    assert house.judge({"rooms src/a": 31}, listed)[0] == {"rooms src/a": 31}
    assert house.text_of(left) == ["circle b", "rooms src/a 28"]


def files(folder: Path, **texts: str) -> Path:
    """Sources by name, "low_one_c" for low/one.c."""
    for name, text in texts.items():
        path = folder / re.sub(r"/(\w)$", r".\1", name.replace("_", "/"))
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return folder


def test_calls_and_circles_are_found(tmp_path):
    files(
        tmp_path,
        low_one_c="int g(void); int f(void) { return g(); }",
        high_one_c="int f(void); int g(void) { return 1; } int k(void) { return f(); }",
        low_two_c="int h(void) { return 1; }",
    )
    names = ["low/one", "high/one", "low/two"]
    for name in names:
        subprocess.run(["cc", "-c", f"{name}.c", "-o", f"{name}.o"], check=True, cwd=tmp_path)
    uses = house.linked(tmp_path, names)
    assert uses == {"low/one": {"high/one"}, "high/one": {"low/one"}, "low/two": set()}
    assert house.circles(uses) == ["high/one", "low/one"] and house.circles(house.folders(uses)) == ["high", "low"]
    assert list(house.upwards(uses, {"low": 1, "high": 2})) == [("low/one", "high/one")]
    assert len(list(house.upwards(uses, {"low": 1, "high": 1}))) == 2, "folders of one layer do not use one another"


def test_a_circle_of_folders_without_one_of_files_is_found():
    uses: Uses = {"a/one": {"b/one"}, "b/two": {"a/two"}, "b/one": set(), "a/two": set()}
    assert not house.circles(uses) and house.circles(house.folders(uses)) == ["a", "b"]


def test_source_and_header_are_one_room(tmp_path):
    """The sources use headers only, in a line; the rooms are a circle. A source whose functions a header declares is of its room."""
    files(
        tmp_path,
        a_x_h="int X(void);\nint Y(void);\n",
        a_x_c='#include "a/z.h"\nint X(void) {\n  return 0;\n}\n',
        a_y_c='#include "a/x.h"\nint Y(void) {\n  return 0;\n}\n',
        a_z_h='#include "a/x.h"\n',
    )
    rooms, uses = house.rooms(tmp_path, house.tags(tmp_path)), house.included(tmp_path)
    assert rooms == {"a/x": "a/x", "a/y": "a/x", "a/z": "a/z"}
    assert house.circles(house.joined(rooms, uses)) == ["a/x", "a/z"]


def test_writes_into_structs_of_other_folders_are_found(tmp_path):
    files(
        tmp_path,
        low_part_h="typedef struct _p_Part *Part;\nstruct _p_Part {\n  int size, *list;\n};\ntypedef struct {\n  Part part;\n} Box;\n",
        low_part_c="void Own(Part p) {\n  p->size = 1;\n}\n",
        high_user_c="void Reads(Part p) {\n  int n = p->size;\n  if (p->size == n) return;\n}\n"
        "void Fills(void) {\n  Box box = {0};\n  box.part = 0;\n}\n",
    )
    writes = lambda: list(house.writes(tmp_path, house.tags(tmp_path)))
    assert not writes()
    for line in ("p->size = 1", "p->list[2] += 1", "p->size++", "b[3].part->size = 1", "b->part = 0"):
        files(tmp_path, high_bad_c=f"static int Bad(Part p, Box *b) {{\n  {line};\n}}\n")
        assert len(writes()) == 1, line


def test_the_table_is_read():
    table = "| layer | folder | what |\n|---|---|---|\n| 0 | `base` | x |\n| 1 | `fluid/grid` | y |\n| 1 | `options` | z |\n"
    assert house.layers(table) == {"base": 0, "fluid/grid": 1, "options": 1, "": 2}


def test_sizes_are_counted(tmp_path):
    most = LIMITS["function"]
    long = "static int Long(int a,\n     int (*b)(int, int)) {\n" + "  a++; /* } */\n" * (most - 2) + "}\n"
    short = long.replace("Long", "Short").replace("  a++; /* } */\n", "", 1)
    many = "int Many(int a, int b, int c, int d, int e,\n  int f, int g, int h[3]) {\n}\n"
    wide = "typedef struct {\n" + "  int a, *b[3]; /* one; two */\n" * 12 + "  int (*f)(int, int);\n  int z;\n} Wide;\n"
    nested = "struct Outer {\n  struct {\n    int a, b;\n  } in, other;\n  double x;\n};\n"
    path = tmp_path / "large.c"
    path.write_text(wide + nested + short + long + many)
    found = house.tags(tmp_path)
    assert house.sizes([path], found) == {f"function Long": most + 1, "fields Wide": 26, "arguments Many": 8}
    scopes = [tag["scope"].rpartition(":")[2] for tag in found["member"]]
    assert scopes.count("Outer") == 3 and scopes.count("in") + scopes.count("other") == 2
    path.write_text("\n" * (LIMITS["lines"] + 1))
    assert house.sizes([path], {"function": [], "member": []}) == {"lines large.c": LIMITS["lines"] + 1}
    names = [ROOT / "src" / "a" / f"{n}.{suffix}" for n in range(26) for suffix in "ch"]
    assert house.crowded(names) == {"rooms src/a": 26} and not house.crowded(names[:-2])
