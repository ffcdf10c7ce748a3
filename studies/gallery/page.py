"""Run the scenes of the gallery that have not run yet and write docs/gallery.md from page.md."""

from __future__ import annotations

import re
from pathlib import Path

from studies.common.engine import Results
from studies.common.tables import write_csv
from studies.gallery.bifurcation import SCENE as BIFURCATION
from studies.gallery.capillary import SCENE as CAPILLARY
from studies.gallery.capsule import SCENE as CAPSULE
from studies.gallery.cells import SCENE as CELLS
from studies.gallery.compound import SCENE as COMPOUND
from studies.gallery.constriction import SCENE as CONSTRICTION
from studies.gallery.couette import SCENE as COUETTE
from studies.gallery.doublet import SCENE as DOUBLET
from studies.gallery.hundred import SCENE as HUNDRED
from studies.gallery.jeffery import SCENE as JEFFERY
from studies.gallery.passing import SCENE as PASSING
from studies.gallery.posts import SCENE as POSTS
from studies.gallery.pressed import SCENE as PRESSED
from studies.gallery.reynolds import SCENE as REYNOLDS
from studies.gallery.revolved import SCENE as REVOLVED
from studies.gallery.scene import Scene
from studies.gallery.settling import SCENE as SETTLING
from studies.gallery.space import SCENE as SPACE
from studies.gallery.stenosis import SCENE as STENOSIS
from studies.gallery.suspension import SCENE as SUSPENSION
from studies.gallery.tumbling import SCENE as TUMBLING
from studies.gallery.vortices import SCENE as VORTICES

SCENES = (
    TUMBLING,
    SPACE,
    REVOLVED,
    PASSING,
    PRESSED,
    VORTICES,
    SETTLING,
    HUNDRED,
    COUETTE,
    POSTS,
    CONSTRICTION,
    STENOSIS,
    BIFURCATION,
    SUSPENSION,
    REYNOLDS,
    CAPILLARY,
    CAPSULE,
    CELLS,
    DOUBLET,
    COMPOUND,
    JEFFERY,
)
TEMPLATE = Path(__file__).with_name("page.md")
BLOCK = re.compile(r"^<!-- scene (\w+) -->\n", re.MULTILINE)
PLACE = re.compile(r"\{(\w+)\}")


def write(folder: str | Path, quick: bool = False, scenes: tuple[Scene, ...] = SCENES) -> list[Path]:
    """Run what is not there yet; write gallery.json, tables and pictures into the folder, and the page beside it.

    Quick: without the scenes that are long, which the page says.
    """
    folder = Path(folder)
    results = Results(folder / "gallery.json")
    head, *blocks = BLOCK.split(TEMPLATE.read_text())
    text = [head.replace("FOLDER", folder.name)]
    known = {scene.name: scene for scene in scenes}
    for name, block in zip(blocks[::2], blocks[1::2]):
        scene = known[name]
        if quick and scene.long and not scene_is_there(results, name):
            text.append(f"{block.splitlines()[0]}\n\nLeft out by QUICK=1.\n\n")
            continue
        values = scene.fill(results)
        for place, value in values.items():
            if isinstance(value, list):
                values[place] = write_csv(folder / f"{place}.csv", value[0], value[1:]).name
        text.append(filled(block.replace("FOLDER", folder.name), values))
    page = folder.with_suffix(".md")
    page.write_text("".join(text).rstrip() + "\n")
    return [page, results.path, *sorted(path for path in folder.iterdir() if path.suffix in (".png", ".gif", ".mp4"))]


def scene_is_there(results: Results, name: str) -> bool:
    """Return whether any run of a scene is among the results."""
    return any(entry.split("_")[0] == name for entry in results.entries)


def filled(block: str, values: dict[str, str]) -> str:
    """Return a block of the template with its places filled; each place has a value and each value a place."""
    places = set(PLACE.findall(block))
    if places != set(values):
        raise ValueError(f"page.md and the scene differ in {', '.join(sorted(places ^ set(values)))}")
    return PLACE.sub(lambda found: values[found[1]], block)
