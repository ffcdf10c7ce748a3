"""Warnings of what markers and steps do not resolve: each names its quantity and what to do, once, and what it says is enough."""

import re

import numpy as np
import pytest
from harness import read_series, run_petves

FREE = "-domain_box -4,4,-4,4 -domain_cells 32,32 -domain_bc_x free -domain_bc_y free -fluid_inertia none"
QUIET = "-output_every 1000 -checkpoint_every 0"


def warnings(folder, options: str, ranks: int = 1) -> list[str]:
    """Warnings of a run with the program's own defaults, as printed and as summary.json lists them."""
    run = run_petves(folder, f"{options} {QUIET}", ranks)
    listed = run.summary["warnings"]
    assert re.findall(r"petves: warning: (.*)", run.stdout) == listed
    return listed


def scene(kind: str, gap: float) -> str:
    """Ellipses (0.4, 0.8) with a gap (length), to another one, to a periodic image or to a wall."""
    shape = "-vesicle_semi_axes 0.4,0.8 -vesicle_angle 0 -vesicle_bending 0.05 -vesicle_allow_close_markers "
    shape += "-flow_type shear -flow_rate 1 -time_step 1e-4 -time_end 2e-4 "
    if kind == "pair":
        return f"{FREE} {shape} -vesicle_count 2 -vesicle_center {-0.4 - gap / 2},0,{0.4 + gap / 2},0"
    cell = (0.8 + gap) / 8
    if kind == "image":
        box = f"-domain_box 0,{8 * cell},0,{32 * cell} -domain_cells 8,32 -domain_bc_x periodic -fluid_inertia none"
        return f"{box} {shape} -vesicle_center 0.1,{16 * cell}"
    return f"-domain_box 0,2,-2,2 -domain_cells 16,32 -fluid_inertia none {shape} -vesicle_center {0.4 + gap},0"


@pytest.mark.parametrize("kind, ranks", [("pair", 2), ("image", 1), ("wall", 1)])
def test_film_that_markers_do_not_resolve(kind, ranks, tmp_path):
    """45 markers are 0.0861 apart: a gap of half of that is warned of, with markers that do; 0.7 of it is not."""
    who = dict(pair="vesicle 2", image="its periodic image", wall="the wall x_min")[kind]
    ds = 0.0861
    found = warnings(tmp_path / "thin", scene(kind, 0.5 * ds) + " -vesicle_markers 45", ranks)
    found = [text for text in found if "film" in text]
    assert len(found) == 1
    assert f"the film between vesicle 1 and {who} is 0.51 marker spacings thick after step 1," in found[0]
    wanted = int(re.search(r"try -vesicle_markers (\d+)$", found[0])[1])
    assert 89 <= wanted <= 95
    for name, gap, markers in (("wide", 0.7, 45), ("more", 0.5, wanted)):
        found = warnings(tmp_path / name, scene(kind, gap * ds) + f" -vesicle_markers {markers}")
        assert not [text for text in found if "film" in text]


@pytest.mark.parametrize(
    "shape",
    ["0.9 -vesicle_angle 70 -vesicle_bending 1", "0.7 -vesicle_angle -20 -vesicle_bending 0.1 -vesicle_markers 61"],
)
def test_step_too_large_for_what_moves(shape, tmp_path):
    """R0 = 1: markers are off by 3 to 8 % of it. With the step that is named there is no warning; nor with -time_adapt error."""
    reduced_area = float(shape.split()[0])
    options = f"{FREE} -flow_type shear -flow_rate 1 -vesicle_area {np.pi * reduced_area} -vesicle_reduced_area {shape} -time_end 4"
    found = warnings(tmp_path / "run", f"{options} -time_step 0.4", 2)
    assert len(found) == 1 and " R0 otherwise than the steps before foretold, in step " in found[0]
    assert float(re.search(r"a marker moved by (\S+) R0", found[0])[1]) > 0.02
    named = float(re.search(r"try -time_step (\S+),", found[0])[1])
    assert 0.1 < named < 0.4
    assert not warnings(tmp_path / "named", f"{options} -time_step {named}")
    assert not warnings(tmp_path / "adapt", f"{options} -time_step 0.1 -time_adapt error")


def test_wrinkles_that_markers_do_not_resolve(tmp_path):
    """A start in the compressing quadrant, V = 0.65, chi = 100, 64^2: 24 markers (1.5 h apart) and 45 are warned of; the
    default's 69 are not, and have the energy of 91 to 1e-3 (in free space; 45 to 2e-2)."""
    bending = (1 / (0.65 * np.pi)) ** 1.5 / 100
    box = "-domain_box -4,4,-4,4 -domain_cells 64,64 -fluid_inertia none"
    options = "-flow_type shear -vesicle_area 1 -vesicle_reduced_area 0.65 -vesicle_angle -20 -time_step 0.05 "
    options += f"-vesicle_bending {bending!r}"
    assert not warnings(tmp_path / "default", f"{box} {options} -time_end 0.1")
    for given in ("-vesicle_spacing 1.5", "-vesicle_markers 45"):
        found = warnings(tmp_path / given[9:12], f"{box} {options} {given} -time_end 0.1")
        assert len(found) == 1 and "markers do not resolve vesicle 1 after step 1," in found[0]
    energies = []
    for given in ("", "-vesicle_allow_close_markers -vesicle_markers 91"):
        folder = tmp_path / f"fine{given[-2:]}"
        assert not warnings(folder, f"{FREE} {options} {given} -time_end 1.5")
        energies.append(read_series(folder / "series.csv")["energy_bending"][-1])
    assert energies[0] == pytest.approx(energies[1], rel=1e-3)


def test_markers_that_do_not_resolve_one_shape_of_two(tmp_path):
    """Warned of once, on any number of ranks; as many as the warning says are enough."""
    scene = f"{FREE} -domain_box 0,8,0,8 -flow_type shear -vesicle_center 2.5,4,5.5,4 -vesicle_count 2 -vesicle_area 1"
    scene += " -vesicle_reduced_area .95,.7 -vesicle_allow_close_markers -time_step .05 -time_end .3 -vesicle_markers"
    (line,) = warnings(tmp_path / "run", f"{scene} 17", 2)
    assert "17 markers do not resolve vesicle 2 after step 1," in line
    wanted = line.split("try -vesicle_markers ")[1]
    assert not warnings(tmp_path / "more", f"{scene} {wanted}")


def test_many_markers_say_what_they_cost(tmp_path):
    options = "-domain_box -4,4,-4,4 -domain_cells 32,32 -fluid_inertia unsteady"  # not solved at time 0
    options += " -vesicle_semi_axes 0.5,0.9 -vesicle_allow_close_markers -time_end 0 -vesicle_markers"
    said = [run_petves(tmp_path / n, f"{options} {n}").stdout for n in ("601", "2001")]
    assert "warning" not in said[0]
    assert "petves: warning: 2001 markers on a vesicle: its dense block in the solve takes about 3e+01 s" in said[1]
