"""Scenes drawn at random, run as they are and changed in a way that the equations do not see: moved over the seam of a
period, mirrored, with x and y exchanged, bodies in another order, in other units of length and time, on other ranks.
Every column of series.csv, the last markers and, where the cells stay, the last velocities, changed back, must be the same numbers.
A scene is drawn again from the seed and its number alone; `make fuzz` draws others, with all their changes."""

from __future__ import annotations

import os
import random
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from drawn_scenes import OF_FREE, OF_SOLIDS, OF_VESICLES, Draw, Scene
from harness import Run, read_series, run_scenes
from unit_powers import column_power, option_power

SEED, SCENES = int(os.environ.get("FUZZ_SEED", 2025)), int(os.environ.get("FUZZ_SCENES", 40))
FEW = int(os.environ.get("FUZZ_CHANGES", 3))  # changes of a scene


#: How numbers of a scene and columns turn with the axes (Change.turned), but for scalars.
KINDS = {"domain_box": "box", "domain_cells": "pair", "domain_bc": "pair", "inclination": "angle"}
KINDS |= dict.fromkeys(("flow_center", "obstacle_center", "center", "markers"), "place")
KINDS |= dict.fromkeys("fluid_gravity flow_velocity obstacle_velocity obstacle_force velocity field".split(), "vector")
KINDS |= dict.fromkeys(("obstacle_rotation", "obstacle_torque", "obstacle_angle"), "spin")
KINDS |= dict.fromkeys(("flow_peak_velocity", "pressure_drop", "flux"), "along-x")
#: Counts, and residuals of solvers: the same in other units only.
COUNTS = ("step", "tension_its", "bending_its", "coupled_its", "nsolve")
RESIDUALS = ("div_max", "surface_div_max")

#: Bounds of a difference over the scale of its column.
OF_UNITS = 1e-8  # powers of two change no digits, but the last ones of what is restored after a step
OF_ROUNDING = 1e-4  # what solves to 1e-11 leave of small torques, in films and where a membrane hardly turns
OF_TOLERANCE = 1e-3  # solves to the default, 1e-6, leave
OF_BUMPS = 2e-3  # polynomials through six markers, at spacings of half a cell: not the same from the left and right


@dataclass
class Change:
    """A place x becomes length (turn x + shift), a time t becomes time * t. Body k of the changed scene is number
    vesicles[k], or solids[k], of the scene."""

    name: str
    turn: np.ndarray = field(default_factory=lambda: np.eye(2))
    shift: np.ndarray = field(default_factory=lambda: np.zeros(2))
    box_shift: np.ndarray = field(default_factory=lambda: np.zeros(2))  # a box does not move along its periods
    length: float = 1
    time: float = 1
    vesicles: list | None = None
    solids: list | None = None
    ranks: int = 1

    @property
    def mirrors(self) -> bool:
        return np.linalg.det(self.turn) < 0

    @property
    def swaps(self) -> bool:
        return self.turn[0, 0] == 0

    @property
    def rescales(self) -> bool:
        return self.length != 1 or self.time != 1

    def turned(self, kind: str, x, back: bool = False):
        turn = self.turn.T if back else self.turn
        if kind == "place":
            return (x - self.shift) @ turn.T if back else x @ turn.T + self.shift
        if kind == "vector":
            return x @ turn.T
        if kind == "box":  # x_min, x_max, y_min, y_max
            return np.sort(turn @ x.reshape(2, 2) + self.box_shift[:, None]).ravel()
        if kind == "pair":
            return x[::-1] if self.swaps else x
        sign = {"spin": -1 if self.mirrors else 1, "strain": -1 if self.swaps else 1, "along-x": turn[0, 0]}
        return x * sign[kind] if kind in sign else x

    def scene(self, scene: Scene) -> Scene:
        numbers = {}
        rate = {"shear": "spin", "extension": "strain"}.get(scene.text["flow_type"], "scalar")
        for name, value in scene.numbers.items():
            length, time = option_power(name)
            value = self.turned(rate if name == "flow_rate" else KINDS.get(name, "scalar"), value)
            numbers[name] = value * (self.length**length * self.time**time) if length or time else value
            order = self.vesicles if name in OF_VESICLES else self.solids if name in OF_SOLIDS + OF_FREE else None
            numbers[name] = numbers[name] if order is None else numbers[name][order]

        def curves(which: list, order: list | None, reverse: bool) -> list:
            moved = [self.length * self.turned("place", points) for points in which]
            moved = [points[::-1] if reverse else points for points in moved]
            return [moved[k] for k in order] if order and moved else moved

        return replace(
            scene,
            numbers=numbers,
            vesicles=curves(scene.vesicles, self.vesicles, False),
            solids=curves(scene.solids, self.solids, self.mirrors),  # else solid and fluid would change sides
        )

    def back(self, stem: str, x: np.ndarray) -> np.ndarray:
        """A column of the changed run, [rows, components], as it is in the scene's frame and units."""
        kind, (length, time) = KINDS.get(stem, "scalar"), column_power("u" if stem == "field" else stem)
        if kind == "angle":  # of an axis: twice the angle has no jump
            axis = np.exp(1j * x[:, 0])
            axis = np.c_[axis.real, axis.imag] @ self.turn
            return np.c_[axis[:, 0] ** 2 - axis[:, 1] ** 2, 2 * axis[:, 0] * axis[:, 1]]
        return self.turned(kind, x / (self.length**length * self.time**time), back=True)


def changes(scene: Scene, draw: random.Random) -> list[Change]:
    """Those that the scene bears."""
    bc, flow = scene.numbers["domain_bc"], scene.text["flow_type"]
    h = (scene.numbers["domain_box"][1] - scene.numbers["domain_box"][0]) / scene.numbers["domain_cells"][0]
    shift = h * np.array([draw.randint(3, int(n) - 3) * draw.choice([1, -1]) for n in scene.numbers["domain_cells"]])
    found = [Change("shift", shift=shift, box_shift=np.where(bc == "periodic", 0, shift))]
    posts = scene.kind == "posts"  # their markers begin on the right: mirrored in y only they are the same
    found.append(Change("mirror", np.diag([1, -1] if posts or draw.random() < 0.5 else [-1, 1])))
    along_x = flow in ("shear", "poiseuille") or "flow_drive" in scene.text or bc[0] != bc[1]
    if not posts and not along_x:
        found.append(Change("swap", np.array([[0, 1], [1, 0]])))
    vesicles, solids = list(range(len(scene.vesicles))), list(range(len(scene.numbers.get("obstacle_rotation", ()))))
    if max(len(vesicles), len(solids)) > 1:
        found.append(Change("order", vesicles=vesicles[::-1], solids=solids[::-1]))
    length, time = (2.0 ** (draw.choice([-1, 1]) * draw.randint(1, 40)) for _ in range(2))
    found += [Change("time", time=time), Change("length", length=length), Change("both", length=length, time=time)]
    return found + [Change(f"{n} ranks", ranks=n) for n in (2, 3)]


def run(scenes: dict[str, Scene], folder: Path, ranks: int = 1) -> dict[str, Run]:
    """Runs by name; folder/scenes has their options."""
    lines = {}
    for number, (name, scene) in enumerate(scenes.items()):
        (folder / "curves" / f"{number}").mkdir(parents=True)
        lines[name] = " ".join(scene.words(folder / "curves" / f"{number}"))
    return run_scenes(folder, lines, ranks, good=False)


def read(scene: Scene, change: Change, folder: Path) -> dict:
    """Columns in the scene's frame, units and order by name and number of the body, 0: of all; and the last markers."""
    parts: dict[tuple, dict] = {}
    for name, column in read_series(folder / "series.csv").items():
        stem, component, body = re.fullmatch(r"(.+?)(?:_([xy]))?(?:_(\d+))?", name).groups()
        order = change.solids if stem.startswith("obstacle") else change.vesicles
        body = int(body or 0)
        parts.setdefault((stem, order[body - 1] + 1 if body and order else body), {})[component] = column
    found = {key: np.column_stack(list(columns.values())) for key, columns in parts.items()}
    with h5py.File(folder / "run.h5") as file:
        markers, start = file["vesicle/markers"][-1], file.attrs["vesicle_start"]
        if "fluid/u" in file:
            found["field", 0] = np.column_stack([file[f"fluid/{name}"][-1].ravel() for name in "uv"])
    for k, body in enumerate(change.vesicles or range(len(scene.vesicles))):
        own = markers[start[k] : start[k + 1]]  # turned counter-clockwise, the first stays
        found["markers", body + 1] = np.roll(own[::-1], 1, axis=0) if change.mirrors else own
    return {key: change.back(key[0], x) for key, x in found.items()}


def scale(scene: Scene, base: dict, stem: str) -> float:
    """What differences of a column are measured in: its largest value, places in cells, residuals in 1/step."""
    length, time = column_power("u" if stem == "field" else stem)
    box, dt = scene.numbers["domain_box"], scene.numbers["time_step"]
    h, nu = (box[1] - box[0]) / scene.numbers["domain_cells"][0], scene.numbers["fluid_viscosity"]
    natural = {1: dt, 0: h**length, -1: h**length / dt, -2: nu * h ** (length - 2) / dt}[time]
    if KINDS.get(stem) == "place" or stem in ("gap", "area_shift", "area_error", "length_error", *RESIDUALS):
        return natural
    values = np.abs(np.concatenate([x.ravel() for (name, _), x in base.items() if name == stem]))
    return max(np.nanmax(values, initial=0), 1e-2 * natural)


def is_compared(scene: Scene, change: Change, stem: str, body: int) -> bool:
    if stem == "field" and (change.shift.any() or change.mirrors or change.swaps):  # cells lie elsewhere
        return False
    if stem == "wall" or (stem in COUNTS + RESIDUALS and not change.rescales):
        return False
    if stem in COUNTS[1:] and scene.text.get("coupled_ksp_rtol") == "1e-11":  # rounding decides on the last iterations
        return False
    if body == 0 and stem in ("inclination", "frequency") and change.vesicles:  # those of the first vesicle
        return False
    leaks = "membrane_permeability" in scene.numbers or scene.text.get("membrane_derivative") == "fd"
    if stem == "energy_gravity" and change.shift.any() and leaks:
        return False  # a weight that changes has a height from somewhere
    if stem == "obstacle_torque" and scene.kind == "spanning" and change.mirrors:  # its markers begin elsewhere
        return False
    if stem.startswith("normal_stress") and change.shift.any():  # SUM f x of a net force goes by where x = 0 is
        return not (scene.kind != "none" or "fluid_gravity" in scene.numbers)
    return not (KINDS.get(stem) == "along-x" and change.swaps)


def difference(scene: Scene, base: dict, changed: dict, change: Change) -> tuple[float, str]:
    """The largest over the column's scale, and where it is."""
    worst = (0.0, "")
    for (stem, body), a in base.items():
        b = changed[stem, body]
        if a.shape != b.shape:
            return np.inf, f"{len(a)} rows, {len(b)} after"
        if not is_compared(scene, change, stem, body):
            continue
        if stem == "energy_gravity":  # from any height
            a, b = a - a[0], b - b[0]
        if stem == "frequency":  # empty where the sense of turning is rounding
            a, b = np.nan_to_num(a), np.nan_to_num(b)
        apart = np.abs(a - b) / (1 if stem in COUNTS else scale(scene, base, stem))
        apart = np.nan_to_num(np.where(np.isnan(a) & np.isnan(b), 0, apart), nan=np.inf)
        k = np.unravel_index(np.argmax(apart), apart.shape)
        if apart[k] > worst[0]:
            worst = apart[k], f"{stem} {body or ''} row {k[0]}: {a[k]:.9g}, {b[k]:.9g} after"
    return worst


def bound(scene: Scene, change: Change) -> float:
    if change.rescales:
        return OF_UNITS
    if scene.kind == "open":
        return OF_BUMPS
    loose = scene.text["scheme_type"] == "coupled" and "coupled_ksp_rtol" not in scene.text
    return OF_TOLERANCE if loose else OF_ROUNDING


@pytest.mark.parametrize("number", range(SCENES))
def test_scene_is_the_same_after_a_change(number, tmp_path):
    """The scene, and a few of its changes."""
    draw = Draw(SEED, number)
    scene = draw.scene()
    if not scene:
        return
    todo = changes(scene, draw.random)
    todo = [Change("0"), *draw.random.sample(todo, min(FEW, len(todo)))]
    runs = {}
    for ranks in sorted({change.ranks for change in todo}):
        changed = {change.name: change.scene(scene) for change in todo if change.ranks == ranks}
        runs |= run(changed, tmp_path / str(ranks), ranks)
    first = runs["0"]
    assert first.status in (0, 2), first
    base = read(scene, todo[0], first.folder) if first.status == 0 else {}
    for change in todo[1:]:
        assert runs[change.name].status == first.status, (change.name, runs[change.name])
        if first.status == 0:
            apart, where = difference(scene, base, read(scene, change, runs[change.name].folder), change)
            assert apart <= bound(scene, change), (change.name, where, runs[change.name])


def test_a_scene_that_differs_is_seen(tmp_path):
    draw = Draw(2025, 0)
    scene = draw.scene()
    change = next(change for change in changes(scene, draw.random) if change.name == "mirror")
    numbers = scene.numbers | {"vesicle_bending": scene.numbers["vesicle_bending"] * 1.001}
    runs = run({"0": scene, "1": change.scene(replace(scene, numbers=numbers))}, tmp_path)
    assert not any(run.status for run in runs.values())
    base = read(scene, Change(""), runs["0"].folder)
    apart, _ = difference(scene, base, read(scene, change, runs["1"].folder), change)
    assert apart > bound(scene, change)


def test_every_kind_is_drawn():
    seen = Counter()
    for number in range(40):
        draw = Draw(2025, number)
        scene = draw.scene()
        if scene:
            seen.update([scene.kind, *scene.text, *scene.text.values()])
            seen.update([*scene.numbers, *scene.numbers["domain_bc"].tolist()])
            seen.update(change.name for change in changes(scene, draw.random))
    kinds = "posts obstacle_free closed container open spanning coupled split penalty free periodic wall convective unsteady"
    kinds += " shear poiseuille extension uniform flux error vesicle_viscosity_ratio fluid_gravity contact_adhesion"
    kinds += " hooke green neo_hookean helfrich circle membrane_viscosity membrane_memory membrane_permeability contact_potential"
    kinds += " shift mirror swap order time length both"
    assert not [kind for kind in kinds.split() if not seen[kind]]
    assert seen["2 ranks"] == seen["3 ranks"] > 20
