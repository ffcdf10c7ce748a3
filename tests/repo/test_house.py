"""How the source is built: which folder may use which, without circles, and files, functions and structs of a size that
can be read at once. docs/source.md has the folders in their order."""

import re
import subprocess
from collections.abc import Iterable, Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from harness import PROGRAMS, ROOT

BUILD = PROGRAMS.parent
LINES, FUNCTION_LINES, FIELDS = 400, 45, 25
TREES = ("src", "include", "tests", "python", "studies", "bench")
CODE = {".c", ".h", ".py", ".html", ".sh", ".css", ".js"}
ELSEWHERE = "DE" + "SIGN"  # a document that readers of this repository do not have

Uses = dict[str, dict[str, str]]  # file to files that it uses, and one thing that it uses there


def layers(page: str) -> dict[str, int]:
    """Folder to layer, of the table in docs/source.md; the files of src itself are the highest."""
    found = {name: int(layer) for layer, name in re.findall(r"^\| (\d+) \| (?:src/)?`?(\w+)`? \|", page, re.M)}
    return found | {"": max(found.values()) + 1}


def linked(build: Path, sources: Iterable[str]) -> Uses:
    """Who calls whom, by the object files of these sources, whose names have no suffix: "fluid/grid"."""
    uses: Uses = {name: {} for name in sources}
    words = ["nm", "-g", "-A", *(f"{name}.o" for name in uses)]
    text = subprocess.run(words, cwd=build, capture_output=True, text=True, check=True).stdout
    table = [(line.split(".o:")[0], *line.split()[-2:]) for line in text.splitlines()]
    home = {symbol: name for name, kind, symbol in table if kind not in "Uw"}
    for name, kind, symbol in table:
        if kind in "Uw" and home.get(symbol, name) != name:
            uses[name].setdefault(home[symbol], symbol)
    return uses


def included(source: Path) -> Uses:
    """Which file includes which headers of src."""
    names = {str(path.relative_to(source)): path.read_text() for path in source.rglob("*.[ch]")}
    found = {name: re.findall(r'^#include "([\w/]+\.h)"', text, re.M) for name, text in names.items()}
    return {name: {other: "#include" for other in others if other in names} for name, others in found.items()}


def folder(name: str) -> str:
    return name.rpartition("/")[0]


def circle(uses: Uses) -> list[str]:
    """Files that use one another, in order, the first again at the end; empty without a circle."""
    try:
        TopologicalSorter(uses).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def folders(uses: Uses) -> Uses:
    found: Uses = {}
    for name, others in uses.items():
        for other, what in others.items():
            if folder(name) != folder(other):
                found.setdefault(folder(name), {})[folder(other)] = f"{name} uses {what} of {other}"
    return found


def upwards(uses: Uses, order: dict[str, int]) -> list[str]:
    """Uses of another folder of the same layer or a higher one."""
    return [
        f"{name} uses {what} of {other}"
        for name, others in uses.items()
        for other, what in others.items()
        if folder(name) != folder(other) and order[folder(other)] >= order[folder(name)]
    ]


def without_comments(text: str) -> str:
    """C source, comments left as their line breaks only."""
    blank = lambda match: "\n" * match[0].count("\n") if match[0].startswith("/") else match[0]  # noqa: E731
    return re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\])*"', blank, text, flags=re.S)


def functions(text: str) -> Iterator[tuple[str, int]]:
    """Name and lines, signature included, of every function of a file that clang-format has laid out: its first line and
    its last brace begin in the first column."""
    pattern = re.compile(r"^[A-Za-z][^;={}#]*?(\w+)\([^;{}]*\)\s*\{$.*?^\}", re.M | re.S)
    for match in pattern.finditer(without_comments(text)):
        yield match[1], match[0].count("\n") + 1


def members(body: str) -> int:
    """Fields between the braces of a struct; a struct in it counts as one of its fields."""
    flat, n = re.sub(r'"[^"]*"', "", body), 1
    while n:
        flat, n = re.subn(r"\{[^{}]*\}|\([^()]*\)|\[[^\[\]]*\]", "", flat)
    return sum(part.count(",") + 1 for part in flat.split(";") if part.strip())


def structs(text: str) -> Iterator[tuple[str, int]]:
    """First words and number of fields of every struct or union."""
    text = without_comments(text)
    for match in re.finditer(r"\b(struct|union)\b(\s+\w+)?\s*\{", text):
        depth, end = 1, match.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        name = match[2] or re.match(r"\s*(\w*)", text[end:])[1]
        yield name.strip(), members(text[match.end() : end - 1])


def too_large(path: Path) -> list[str]:
    """What a file has that is longer than it may be."""
    text = path.read_text()
    found = [f"{path}: {n} lines"] if (n := text.count("\n")) > LINES else []
    if path.suffix in (".c", ".h"):
        found += [f"{path}: {name} has {n} lines" for name, n in functions(text) if n > FUNCTION_LINES]
        found += [f"{path}: {name} has {n} fields" for name, n in structs(text) if n > FIELDS]
    return found


def code() -> list[Path]:
    return [
        p for tree in TREES for p in sorted((ROOT / tree).rglob("*")) if p.suffix in CODE and "build" not in p.parts
    ]


@pytest.fixture(scope="module")
def calls() -> Uses:
    sources = [path.relative_to(ROOT / "src") for path in (ROOT / "src").rglob("*.c")]
    return linked(BUILD, [str(path.with_suffix("")) for path in sources])


@pytest.fixture(scope="module")
def order() -> dict[str, int]:
    return layers((ROOT / "docs" / "source.md").read_text())


def test_every_folder_is_in_the_table(order):
    assert set(order) - {""} == {path.name for path in (ROOT / "src").iterdir() if path.is_dir()}


def test_names_of_the_page_are_in_the_source():
    """Functions by their CamelCase, and files."""
    page = (ROOT / "docs" / "source.md").read_text()
    source = "\n".join(path.read_text() for path in (ROOT / "src").rglob("*.[ch]"))
    names = set(re.findall(r"\b[A-Z][a-z]+(?:[A-Z][a-z]*)+\b", page)) - {"ParaView"}
    assert len(names) > 40
    assert not [name for name in names if not re.search(rf"\b{name}\b", source)]
    assert not [path for path in re.findall(r"\bsrc/[\w/]+\.[ch]\b", page) if not (ROOT / path).exists()]


def test_no_circle_among_files(calls):
    assert sum(map(len, calls.values())) > 200, "calls were found"
    assert not circle(calls)
    assert not circle(included(ROOT / "src"))


def test_no_circle_among_folders(calls):
    assert not circle(folders(calls))


def test_folders_use_lower_ones_only(calls, order):
    assert not upwards(calls, order)
    assert not upwards(included(ROOT / "src"), order)


def test_all_can_be_read_at_once():
    paths = code()
    assert len(paths) > 200
    assert sum(len(list(functions(path.read_text()))) for path in paths if path.suffix == ".c") > 700, "they were found"
    assert sum(len(list(structs(path.read_text()))) for path in paths if path.suffix in (".c", ".h")) > 60
    assert not [line for path in paths for line in too_large(path)]


def test_nothing_refers_to_a_document_elsewhere():
    paths = [*code(), ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    assert not [str(path) for path in paths if re.search(rf"\b{ELSEWHERE}\b", path.read_text())]


# Each rule can fail:


def compile_files(tmp_path: Path, **texts: str) -> Uses:
    for name, text in texts.items():
        path = tmp_path / f"{name.replace('_', '/')}.c"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        subprocess.run(["cc", "-c", str(path), "-o", str(path.with_suffix(".o"))], check=True)
    return linked(tmp_path, [name.replace("_", "/") for name in texts])


def test_a_circle_is_found(tmp_path):
    uses = compile_files(
        tmp_path,
        low_one="int g(void); int f(void) { return g(); }",
        high_one="int f(void); int g(void) { return 1; } int k(void) { return f(); }",
        low_two="int h(void) { return 1; }",
    )
    assert uses == {"low/one": {"high/one": "g"}, "high/one": {"low/one": "f"}, "low/two": {}}
    assert sorted(circle(uses)[1:]) == ["high/one", "low/one"] and sorted(circle(folders(uses))[1:]) == ["high", "low"]
    assert upwards(uses, {"low": 1, "high": 2}) == ["low/one uses g of high/one"]
    assert len(upwards(uses, {"low": 1, "high": 1})) == 2, "folders of one layer do not use one another"


def test_a_circle_of_folders_without_one_of_files_is_found():
    uses: Uses = {"a/one": {"b/one": "f"}, "b/two": {"a/two": "g"}, "b/one": {}, "a/two": {}}
    assert not circle(uses) and sorted(circle(folders(uses))[1:]) == ["a", "b"]


def test_the_table_is_read():
    page = "| layer | folder | what |\n|---|---|---|\n| 0 | `base` | x |\n| 1 | `kernel` | y |\n| 1 | `options` | z |\n"
    assert layers(page) == {"base": 0, "kernel": 1, "options": 1, "": 2}


def test_sizes_are_counted(tmp_path):
    long = "static int\nLong(int a,\n     int b) {\n" + "  a++; /* } */\n" * (FUNCTION_LINES - 3) + "}\n"
    short = long.replace("Long", "Short").replace("  a++; /* } */\n", "", 1)
    assert list(functions(short + long)) == [("Short", FUNCTION_LINES), ("Long", FUNCTION_LINES + 1)]
    wide = "typedef struct {\n" + "  int a, *b[3]; /* one; two */\n" * 12 + "  int (*f)(int, int);\n  int z;\n} Wide;\n"
    nested = "struct Outer {\n  struct {\n    int a, b;\n  } in, other;\n  double x;\n};\n"
    assert list(structs(wide + nested)) == [("Wide", 26), ("Outer", 3), ("in", 2)]
    path = tmp_path / "large.c"
    path.write_text(wide + nested + short + long)
    assert [line.split(": ")[1] for line in too_large(path)] == ["Long has 46 lines", "Wide has 26 fields"]
    path.write_text("\n" * (LINES + 1))
    assert too_large(path) == [f"{path}: {LINES + 1} lines"]
