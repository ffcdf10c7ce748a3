"""What the house rules find in the source: `python3 tests/repo/house.py` prints what is not excepted, and strikes from
house_exceptions.txt what is no longer broken. It never adds a line.

A room is a pair x.c and x.h, with each y.c beside them whose functions x.h declares. A broken rule is a line "rule where what" or
"rule what number"; rooms are named without their folder, so that moving a file leaves the list as it is."""

import os
import re
import subprocess
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("PETVES_TESTS", ROOT / "build" / "tests")).parent
LIST = Path(__file__).with_name("house_exceptions.txt")
LIMITS = {"lines": 400, "function": 60, "arguments": 7, "fields": 25, "rooms": 25}
TREES = ("src", "include", "tests", "python", "studies", "bench")
CODE = {".c", ".h", ".py", ".html", ".sh", ".css", ".js"}

Uses = dict[str, set[str]]  # a file or room, "fluid/grid", to those that it uses
Found = dict[str, int]  # what breaks a rule to its number, 0 where there is none


def layers(page: str) -> dict[str, int]:
    """Folder to layer, of the table in docs/source.md; the files of src itself are the highest."""
    found = {name: int(layer) for layer, name in re.findall(r"^\| (\d+) \| (?:src/)?`?([\w/]+)`? \|", page, re.M)}
    return found | {"": max(found.values()) + 1}


def linked(build: Path, sources: Iterable[str]) -> Uses:
    """Who calls whom, by the object files of these sources, whose names have no suffix."""
    uses: Uses = {name: set() for name in sources}
    words = ["nm", "-g", "-A", *(f"{name}.o" for name in uses)]
    text = subprocess.run(words, cwd=build, capture_output=True, text=True, check=True).stdout
    table = [(line.split(".o:")[0], *line.split()[-2:]) for line in text.splitlines()]
    home = {symbol: name for name, kind, symbol in table if kind not in "Uw"}
    for name, kind, symbol in table:
        if kind in "Uw" and home.get(symbol, name) != name:
            uses[name].add(home[symbol])
    return uses


def included(source: Path) -> Uses:
    """Who includes headers of whom."""
    uses: Uses = defaultdict(set)
    for path in source.rglob("*.[ch]"):
        others = re.findall(r'^#include "([\w/]+)\.h"', path.read_text(), re.M)
        uses[str(path.relative_to(source).with_suffix(""))] |= {x for x in others if (source / f"{x}.h").exists()}
    return uses


def rooms(source: Path) -> dict[str, str]:
    """The room of every file, both without suffix: a file without a header of its own stands in that which declares most of its
    functions."""
    declared, found = defaultdict(list), {}
    for path in source.rglob("*.h"):
        for name in re.findall(r"\b([A-Z]\w*)\(", without_comments(path.read_text())):
            declared[name].append(str(path.relative_to(source).with_suffix("")))
    for path in source.rglob("*.[ch]"):
        name = str(path.relative_to(source).with_suffix(""))
        named = [] if path.with_suffix(".h").exists() else functions(path.read_text())
        homes = [home for function in named for home in declared[function[1]]]
        found[name] = max(sorted(set(homes)), key=homes.count, default=name)
    return found


def joined(room: dict[str, str], *uses: Uses) -> Uses:
    """Uses among rooms, of uses among files."""
    found: Uses = {name: set() for name in room.values()}
    for files in uses:
        for name, others in files.items():
            found[room[name]] |= {room[other] for other in others} - {room[name]}
    return found


def folder(name: str) -> str:
    return name.rpartition("/")[0]


def folders(uses: Uses) -> Uses:
    found: Uses = defaultdict(set)
    for name, others in uses.items():
        found[folder(name)] |= {folder(other) for other in others} - {folder(name)}
    return found


def reached(uses: Uses, start: str) -> set[str]:
    """What a room uses, and what that uses, and so on."""
    found, left = set(), [start]
    while left:
        new = uses.get(left.pop(), set()) - found
        found |= new
        left += new
    return found


def circles(uses: Uses) -> list[str]:
    """Rooms that use themselves through others."""
    return sorted(name for name in uses if name in reached(uses, name))


def upwards(uses: Uses, order: dict[str, int]) -> Iterator[tuple[str, str]]:
    """Uses of another folder of the same layer or a higher one."""
    for name, others in uses.items():
        for other in others:
            if folder(name) != folder(other) and order[folder(other)] >= order[folder(name)]:
                yield name, other


def without_comments(text: str) -> str:
    """C source, comments left as their line breaks only."""
    blank = lambda match: "\n" * match[0].count("\n") if match[0].startswith("/") else match[0]  # noqa: E731
    return re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\])*"', blank, text, flags=re.S)


def flat(text: str) -> str:
    """C source without strings and what stands in brackets."""
    text, n = re.sub(r'"[^"]*"', "", text), 1
    while n:
        text, n = re.subn(r"\{[^{}]*\}|\([^()]*\)|\[[^\[\]]*\]", "", text)
    return text


def functions(text: str) -> Iterator[re.Match]:
    """Every function of a file that clang-format has laid out, its name and its arguments: its first line and its last brace
    begin in the first column."""
    pattern = re.compile(r"^[A-Za-z][^;={}#]*?(\w+)\(((?:[^;{}()]|\([^;{}()]*\))*)\)\s*\{$.*?^\}", re.M | re.S)
    return pattern.finditer(without_comments(text))


def structs(text: str) -> Iterator[tuple[list[str], list[str]]]:
    """The names of every struct or union (its tag, its typedef or its variable), and its fields as they are declared; a struct in
    it counts as one field."""
    text = without_comments(text)
    for match in re.finditer(r"\b(?:struct|union)\b\s*(\w+)?\s*\{", text):
        depth, end = 1, match.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        names = [match[1], re.match(r"\s*(\w*)", text[end:])[1]]
        declared = [" ".join(part.split()) for part in flat(text[match.end() : end - 1]).split(";") if part.strip()]
        yield [name for name in names if name], declared


def sizes(path: Path) -> Found:
    """What a file has that is longer than it may be."""
    text = path.read_text()
    found = {f"lines {path.name}": text.count("\n")}
    if path.suffix in (".c", ".h"):
        for match in functions(text):
            found[f"function {match[1]}"] = match[0].count("\n") + 1
            found[f"arguments {match[1]}"] = flat(match[2]).count(",") + 1
        for names, declared in structs(text):
            found[f"fields {''.join(names[-1:])}"] = sum(part.count(",") + 1 for part in declared)
    return {line: n for line, n in found.items() if n > LIMITS[line.split()[0]]}


def crowded(paths: Iterable[Path]) -> Found:
    """Folders with too many rooms."""
    rooms = defaultdict(set)
    for path in paths:
        rooms[str(path.parent.relative_to(ROOT))].add(path.stem)
    return {f"rooms {name}": len(stems) for name, stems in rooms.items() if len(stems) > LIMITS["rooms"]}


class Types:
    """Structs of a source's headers: the folder of each, and the type of each field."""

    def __init__(self, source: Path):
        self.home: dict[str, str] = {}
        self.fields: dict[str, dict[str, str]] = {}
        self.alias: dict[str, str] = {}
        for path in sorted(source.rglob("*.h")):
            text = path.read_text()
            for names, declared in structs(text):
                fields = {}
                for part in declared:
                    first, *others = part.split(",")
                    words = re.findall(r"\w+", first)
                    kind = next((word for word in words if word not in ("const", "struct", "union")), "")
                    named = [re.findall(r"\w+", name) for name in [first, *others]]
                    fields |= {words[-1]: kind for words in named if words}
                for name in names:
                    self.home[name], self.fields[name] = folder(str(path.relative_to(source))), fields
            aliases = re.findall(r"^typedef struct (\w+) \*?(\w+);", text, re.M)
            self.alias |= {new: old for old, new in aliases if old != new}

    def struct(self, kind: str) -> str:
        return self.alias.get(kind, kind)

    def written(self, function: str) -> Iterator[tuple[str, str]]:
        """Struct and field of each assignment through a pointer whose type the function or a header tells; what lies in a struct by
        value is its own."""
        known = {name: kind for kind, name in re.findall(r"\b(\w+)\s+\**(?:const )?\**(\w+)(?=[,;)\[]| =)", function)}
        target = r"\b(\w+)((?:\[[^\]]*\])?(?:(?:->|\.)\w+(?:\[[^\]]*\])*)*?(?:->|\.)\w+)(?:\[[^\]]*\])*\s*(?:[-+*/|&]?=(?!=)|\+\+|--)"
        for name, path in re.findall(target, function):
            *way, last = path.rsplit("->", 1)
            kind = self.struct(known.get(name, ""))
            for step in re.findall(r"\w+", re.sub(r"\[.*?\]", "", "".join(way))):
                kind = self.struct(self.fields.get(kind, {}).get(step, ""))
            field = re.findall(r"\w+", last)[0]
            if way and field in self.fields.get(kind, {}):
                yield kind, field


def writes(source: Path) -> Iterator[tuple[str, str]]:
    """A room that sets a field of a struct that another folder's header defines; struct variables of its own are arguments in the
    making."""
    types = Types(source)
    for path in source.rglob("*.[ch]"):
        here = str(path.relative_to(source))
        for function in functions(path.read_text()):
            for kind, field in types.written(function[0]):
                if types.home[kind] != folder(here):
                    yield path.stem, f"{kind.removeprefix('_p_')}.{field}"


def code() -> list[Path]:
    paths = [path for tree in TREES for path in sorted((ROOT / tree).rglob("*"))]
    return [path for path in paths if path.suffix in CODE and "build" not in path.parts]


def broken() -> Found:
    """Every line that the source gives."""
    source, order = ROOT / "src", layers((ROOT / "docs" / "source.md").read_text())
    files = [str(path.relative_to(source).with_suffix("")) for path in source.rglob("*.c")]
    uses = joined(rooms(source), linked(BUILD, files), included(source))
    found = {f"circle {Path(room).name}": 0 for room in circles(uses)}
    found |= {f"circle {name}/": 0 for name in circles(folders(uses))}
    found |= {f"upwards {Path(a).name} {Path(b).name}": 0 for a, b in upwards(uses, order)}
    found |= {f"writes {room} {field}": 0 for room, field in writes(source)} | crowded(code())
    for path in code():
        found |= sizes(path)
    return found


def excepted() -> Found:
    """The list: lines, with the number at the end of those that have one."""
    lines = [line for line in LIST.read_text().splitlines() if not line.startswith("#")]
    return {re.sub(r" \d+$", "", line): int((re.findall(r" (\d+)$", line) or [0])[0]) for line in lines}


def judge(found: Found, listed: Found) -> tuple[Found, list[str], Found]:
    """What is new, lines that are to be struck, and the list that is left: never longer, its numbers never higher."""
    new = {line: n for line, n in found.items() if n > listed.get(line, -1)}
    left = {line: min(n, found[line]) for line, n in listed.items() if line in found}
    return new, [line for line in listed if line not in found], left


def text_of(lines: Found) -> list[str]:
    return sorted(f"{line} {n}" if n else line for line, n in lines.items())


if __name__ == "__main__":
    fresh, _, remaining = judge(broken(), excepted())
    head = [line for line in LIST.read_text().splitlines() if line.startswith("#")]
    LIST.write_text("\n".join([*head, *text_of(remaining)]) + "\n")
    print("\n".join(text_of(fresh)) or "nothing is broken but what house_exceptions.txt lists")
