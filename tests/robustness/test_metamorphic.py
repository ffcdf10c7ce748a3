"""Scenes from a fixed seed are the same mirrored, moved, in another order, in other units, on other ranks
(tests/robustness/metamorphic.py)."""

from collections import Counter
from dataclasses import replace

import metamorphic
import pytest
from drawn_scenes import Draw

SEED = 2025
SCENES = 40
RANKS = [1, 2, 3]
FEW = 3  # changes of a scene


@pytest.mark.parametrize("number", range(SCENES))
def test_scene_is_the_same_after_a_change(number, tmp_path):
    results = metamorphic.check(SEED, number, tmp_path, RANKS, few=FEW)
    wrong = [str(result) for result in results if result.wrong]
    assert not wrong, f"seed {SEED}: {wrong}"


def test_a_scene_that_differs_is_seen(tmp_path):
    draw = Draw(SEED, 0)
    scene = draw.scene()
    change = next(change for change in metamorphic.changes(scene, draw.random, RANKS) if change.name == "mirror")
    numbers = scene.numbers | {"vesicle_bending": scene.numbers["vesicle_bending"] * 1.001}
    for folder, drawn in (("0", scene), ("1", change.scene(replace(scene, numbers=numbers)))):
        assert metamorphic.run(drawn, tmp_path / folder)[0] == 0
    base = metamorphic.read(scene, metamorphic.Change(""), tmp_path / "0")
    apart, _ = metamorphic.difference(scene, base, metamorphic.read(scene, change, tmp_path / "1"), change)
    assert apart > metamorphic.bound(scene, change)


def test_every_kind_is_drawn():
    seen = Counter()
    for number in range(SCENES):
        draw = Draw(SEED, number)
        scene = draw.scene()
        if scene:
            seen.update(
                [scene.kind, *scene.text, *scene.text.values(), *scene.numbers, *scene.numbers["domain_bc"].tolist()]
            )
            seen.update(change.name for change in metamorphic.changes(scene, draw.random, RANKS))
    kinds = "posts obstacle_free closed container open spanning coupled split penalty free periodic wall convective unsteady"
    kinds += " shear poiseuille extension uniform flux error vesicle_viscosity_ratio fluid_gravity contact_adhesion"
    kinds += " hooke green neo_hookean helfrich circle membrane_viscosity membrane_memory membrane_permeability contact_potential"
    kinds += " shift mirror swap order time length both"
    assert not [kind for kind in kinds.split() if not seen[kind]]
    assert seen["2 ranks"] == seen["3 ranks"] > SCENES / 2
