"""What the house rules find in the source: `python3 tests/repo/house.py` prints what is not excepted, and strikes from
house_exceptions.txt what is no longer broken. It never adds a line.

A room is a pair x.c and x.h, with each y.c beside them whose functions x.h declares. A broken rule is a line "rule where what" or
"rule what number"; rooms are named without their folder, so that moving a file leaves the list as it is."""

import json
import os
import re
import subprocess
from collections import Counter, defaultdict
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
Tags = dict[str, list[dict]]  # by kind: function, prototype, struct, member, variable, typedef


def tags(tree: Path, folders: Iterable[str] = (".",)) -> Tags:
    """What ctags finds in the C files of some folders of a tree; a struct without a tag has the name of its typedef or variable."""
    words = "ctags -R --langmap=C:.c.h --languages=C --output-format=json --fields=+neSt --kinds-C=fpsumvt -f -".split()
    text = subprocess.run([*words, *folders], cwd=tree, capture_output=True, text=True, check=True).stdout
    typed = [(tag["name"], tag["typeref"]) for tag in map(json.loads, text.splitlines()) if "typeref" in tag]
    names = {part: name for name, kind in typed for part in re.findall(r"__anon\w+$|__anon\w+(?=\W*$)", kind)}
    found: Tags = defaultdict(list)
    for line in text.splitlines():
        tag = json.loads(re.sub(r"__anon\w+", lambda match: names.get(match[0], match[0]), line))
        found[tag["kind"]].append(tag | {"path": tag["path"].removeprefix("./")})
    return found


def stem(path: str) -> str:
    return path.rpartition(".")[0]


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


def rooms(source: Path, found: Tags) -> dict[str, str]:
    """The room of every file, both without suffix: a file without a header of its own stands in that which declares most of its
    functions."""
    declared, homes = defaultdict(list), defaultdict(list)
    for tag in found["prototype"]:
        declared[tag["name"]] += [stem(tag["path"])] if tag["path"].endswith(".h") else []
    for tag in found["function"]:
        homes[stem(tag["path"])] += declared[tag["name"]]
    rooms = {stem(str(path.relative_to(source))): "" for path in source.rglob("*.[ch]")}
    for name in rooms:
        likely = [] if (source / f"{name}.h").exists() else sorted(homes[name])
        rooms[name] = max(likely, key=likely.count, default=name)
    return rooms


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


def sizes(paths: Iterable[Path], found: Tags) -> Found:
    """What is longer than it may be; a struct in another one counts as one field."""
    sizes = [(f"lines {path.name}", path.read_text().count("\n")) for path in paths]
    for tag in found["function"]:
        arguments = re.sub(r"\([^()]*\)", "", tag["signature"][1:-1])
        sizes.append((f"function {tag['name']}", tag["end"] - tag["line"] + 1))
        sizes.append((f"arguments {tag['name']}", arguments.count(",") + 1))
    fields = Counter((tag["path"], tag["scope"]) for tag in found["member"])
    sizes += [(f"fields {scope.rpartition(':')[2]}", n) for (_, scope), n in fields.items()]
    return {line: n for line, n in sizes if n > LIMITS[line.split()[0]]}


def crowded(paths: Iterable[Path]) -> Found:
    """Folders with too many rooms."""
    rooms = defaultdict(set)
    for path in paths:
        rooms[str(path.parent.relative_to(ROOT))].add(path.stem)
    return {f"rooms {name}": len(stems) for name, stems in rooms.items() if len(stems) > LIMITS["rooms"]}


class Types:
    """Structs of a source's headers: the folder of each, and the type of each field."""

    def __init__(self, found: Tags):
        self.home: dict[str, str] = {}
        self.fields: dict[str, dict[str, str]] = defaultdict(dict)
        named = [tag for tag in found["typedef"] if tag.get("typeref", "").startswith("struct:_")]
        self.alias = {tag["name"]: self.kind(tag) for tag in named}
        for tag in found["member"]:
            if tag["path"].endswith(".h"):
                name = tag["scope"].rpartition(":")[2]
                self.home[name], self.fields[name][tag["name"]] = folder(tag["path"]), self.kind(tag)

    def kind(self, tag: dict) -> str:
        words = re.findall(r"\w+", tag["typeref"].rpartition(":")[2])
        return next((word for word in words if word not in ("const", "struct", "union")), "")

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


def writes(source: Path, found: Tags) -> Iterator[tuple[str, str]]:
    """A room that sets a field of a struct that another folder's header defines; struct variables of its own are arguments in the
    making."""
    types = Types(found)
    texts = {
        path: without_comments((source / path).read_text()).split("\n")
        for path in {t["path"] for t in found["function"]}
    }
    for tag in found["function"]:
        for kind, field in types.written("\n".join(texts[tag["path"]][tag["line"] - 1 : tag["end"]])):
            if types.home[kind] != folder(tag["path"]):
                yield Path(tag["path"]).stem, f"{kind.removeprefix('_p_')}.{field}"


def code() -> list[Path]:
    paths = [path for tree in TREES for path in sorted((ROOT / tree).rglob("*"))]
    return [path for path in paths if path.suffix in CODE and "build" not in path.parts]


def broken() -> Found:
    """Every line that the source gives."""
    source, order = ROOT / "src", layers((ROOT / "docs" / "source.md").read_text())
    files = [str(path.relative_to(source).with_suffix("")) for path in source.rglob("*.c")]
    tagged = tags(source)
    uses = joined(rooms(source, tagged), linked(BUILD, files), included(source))
    found = {f"circle {Path(room).name}": 0 for room in circles(uses)}
    found |= {f"circle {name}/": 0 for name in circles(folders(uses))}
    found |= {f"upwards {Path(a).name} {Path(b).name}": 0 for a, b in upwards(uses, order)}
    found |= {f"writes {room} {field}": 0 for room, field in writes(source, tagged)} | crowded(code())
    return found | sizes(code(), tags(ROOT, TREES))


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
