"""valgrind's memcheck finds no error with a petves function on the stack, and no leak. Its start takes seconds, so scenes run one
after another in one process (tests/support/scenes.c). `make memcheck` runs all of them, each test run those of SHORT."""

import os
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from harness import PETVES, PROGRAMS, SANITIZE, mpirun, run_petves, run_scenes

OPENMPI = Path("/usr/share/openmpi/openmpi-valgrind.supp")
OBJECTS = ("libpetves.so", "bin/petves", "tests/scenes")
BASE = "-domain_cells 16,16 -vesicle_semi_axes 0.3,0.5 -time_step 0.01 -time_end 0.03 -output_every 0.01"
SHEAR = f"{BASE} -flow_type shear"
TWO_STEPS = f"{SHEAR} -scheme_startup euler -time_end 0.02"
COUPLED = f"{SHEAR} -coupling_box_part false -checkpoint_every 1"
PERIODIC, FREE = (f"-domain_bc_x {bc} -domain_bc_y {bc}" for bc in ("periodic", "free"))
ROWS = ",".join(f"{x},{y}" for x in (-0.6, -0.2, 0.2, 0.6) for y in (-0.55, 0, 0.55))
TWELVE = f"-vesicle_count 12 -vesicle_center {ROWS} -vesicle_semi_axes 0.08,0.12 -vesicle_markers 16"
SOLID = "-obstacle_shape posts -obstacle_radius 0.2 -obstacle_center 0.7,0.7"
STRETCHING = "-membrane_law hooke -membrane_stretching 1 -membrane_viscosity 1 -membrane_permeability 0.1"
MOVING = f"{SOLID} -flow_type uniform -obstacle_moving -obstacle_velocity 1,0"
SPACE = "-dim 3 -sphere_degree 4 -flow_type shear -time_step 0.1 -time_end 0.2 -output_every 0.1"
POSTS = f"-domain_bc_x periodic -flow_type poiseuille -flow_half_width 1 {SOLID}"

#: Options and status. Restarts: one that goes on, one whose first step is refused, one of another scene.
SHORT = {
    "disturbance": (SHEAR, 0),
    "total": (f"{SHEAR} -flow_form total -scheme_type split", 0),
    "restart": (f"{COUPLED} -restart {{checkpoint}}", 0),
    "limit": (f"{COUPLED} -time_end 1 -limit_edge_ratio 1.0000000001 -restart {{checkpoint}}", 2),
    "another_scene": (f"{COUPLED} -fluid_viscosity 2 -restart {{checkpoint}}", 1),
    "images": (f"{TWO_STEPS} -domain_cells 32,32", 0),  # 17 cells between a marker and another's image
}
LONG = SHORT | {
    "twelve": (f"{TWO_STEPS} -domain_cells 32,32 {TWELVE}", 0),
    "convective": (f"{TWO_STEPS} -fluid_inertia convective", 0),
    "channel": (f"{TWO_STEPS} -domain_box 0,2,-1,1 -domain_bc_x periodic -vesicle_center 1.9,0.1", 0),
    "periodic": (f"{BASE} {PERIODIC} -vesicle_center 0.97,-0.95 -scheme_startup euler", 0),
    "free": (f"{SHEAR} {FREE}", 0),
    "free_twelve": (f"{TWO_STEPS} {FREE} -domain_cells 32,32 {TWELVE}", 0),
    "adaptive": (f"{SHEAR} -time_adapt error", 0),
    "penalty": (f"{SHEAR} -scheme_type penalty", 0),
    "split": (f"{SHEAR} -scheme_type split", 0),
    "hypre": (f"{SHEAR} -scheme_type split -helmholtz_type hypre -poisson_type hypre", 0),
    "contrast": (f"{TWO_STEPS} -domain_cells 32,32 -vesicle_viscosity_ratio 5", 0),
    "contrast_channel": (f"{TWO_STEPS} -domain_cells 32,32 -domain_bc_x periodic -vesicle_viscosity_ratio 5", 0),
    "contrast_posts": (f"{TWO_STEPS} {POSTS} -domain_cells 32,32 -vesicle_viscosity_ratio 5", 0),
    "contrast_moving_posts": (f"{BASE} -domain_cells 32,32 {MOVING} {PERIODIC} -vesicle_viscosity_ratio 5", 0),
    "inertial_post": (f"{TWO_STEPS} -domain_cells 32,32 {SOLID} -obstacle_free all -fluid_inertia convective", 0),
    "membranes": (f"{TWO_STEPS} {STRETCHING} -membrane_memory 1 -tracer_grid 2,2", 0),
    "auto": (f"{SHEAR} -scheme_auto 0.01", 0),
    "space": (f"{SPACE} -vesicle_count 2 -vesicle_center 0,0,0,2.8,0,0", 0),
    "space_contrast": (f"{SPACE} -vesicle_viscosity_ratio 5 -bending_newton 2", 0),
    "no_vesicle": ("-domain_cells 16,16 -vesicle_shape none -flow_type shear -time_end 0.03", 0),
}


def checked(words: list[str], folder: Path, ranks: int, leaks: bool = True):
    """Run under memcheck, or as it is when the sanitizers are built in; fails at an error of ours on any rank."""
    reports, wrapper = folder / "reports", ()
    reports.mkdir()
    if not SANITIZE:  # the two do not go together
        assert shutil.which("valgrind")
        wrapper = ("valgrind", "--xml=yes", f"--xml-file={reports}/%p.xml", "--leak-check=no", "--num-callers=40")
        wrapper += (f"--suppressions={OPENMPI}",) if OPENMPI.exists() else ()
    done = mpirun(words, ranks, 3000, wrapper)
    found = sorted(reports.glob("*.xml"))
    assert len(found) >= (0 if SANITIZE else ranks)
    errors = [error for report in found for error in ET.parse(report).getroot().iter("error")]
    ours = [describe(error) for error in errors if is_ours(error) and (leaks or not is_leak(error))]
    assert not ours, "\n\n".join(ours)
    assert "runtime error" not in done.stderr and "Sanitizer" not in done.stderr, done.stderr
    return done


def is_leak(error) -> bool:
    return error.findtext("kind", "").startswith("Leak_")


def is_ours(error) -> bool:
    """Some frame lies in petves; for a leak, some frame beyond those that start and end PETSc and MPI."""
    names = [f.findtext("fn", "") for f in error.iter("frame") if f.findtext("obj", "").endswith(OBJECTS)]
    if is_leak(error):
        names = [name for name in names if name not in ("main", "PetvesInitialize", "PetvesFinalize")]
    return bool(names)


def describe(error) -> str:
    frames = [f"{f.findtext('fn')} ({f.findtext('file')}:{f.findtext('line')})" for f in error.iter("frame")]
    return "\n  ".join([error.findtext("what", error.findtext("xwhat/text", "?")), *frames])


@pytest.fixture
def checkpoint(tmp_path) -> Path:
    return run_petves(tmp_path / "first", f"{COUPLED} -time_end 0.02").folder / "checkpoint.h5"


@pytest.mark.parametrize("ranks", [1, 2] if os.environ.get("MEMCHECK") else [2])
def test_memory_of_scenes(ranks, checkpoint, tmp_path):
    scenes = LONG if os.environ.get("MEMCHECK") else SHORT
    lines = [f"-output_dir {tmp_path}/{name} {options}" for name, (options, _) in scenes.items()]
    (tmp_path / "scenes").write_text("\n".join(lines).format(checkpoint=checkpoint) + "\n")
    done = checked([str(PROGRAMS / "scenes"), str(tmp_path / "scenes")], tmp_path, ranks)
    ended = [line[:1] for line in done.stdout.splitlines() if line[:2] in ("0 ", "1 ", "2 ")]
    assert ended == [str(status) for _, status in scenes.values()], done.stdout + done.stderr
    assert done.returncode == 0, done.stderr


def test_bits_do_not_depend_on_what_memory_held(tmp_path):
    """The C library fills what malloc gives with a byte: numbers of 0, of 32.5, and not a number. 47 markers leave
    a lane of the last vector without one."""
    boxes = {"walls": "", "channel": "-domain_bc_x periodic", "periodic": PERIODIC, "free": FREE, "posts": POSTS}
    few = f"{TWO_STEPS} -domain_cells 32,32 -vesicle_markers 47"
    scenes = {f"{box} {k}": f"{few} {boxes[box]} -vesicle_viscosity_ratio {k}" for box in boxes for k in (1, 5)}
    every = {"GLIBC_TUNABLES": "glibc.malloc.tcache_count=0"}  # small pieces too
    bytes_ = (255, 255 - 0x40, 255 - 0xFF)
    found = [run_scenes(tmp_path / f"{b}", scenes, MALLOC_PERTURB_=f"{b}", **every) for b in bytes_]
    for name in scenes:
        runs = [run[name] for run in found]
        assert len({run.saved("vesicle/markers").tobytes() for run in runs}) == 1, name
        first = [{column: f"{x[0]}" for column, x in run.series.items() if column != "wall"} for run in runs]
        assert first[0] == first[1] == first[2], name
    assert 0 < found[0]["posts 1"].series["flux"][0] < 4 / 3  # less than the background's, by the post


def test_memory_of_the_program(checkpoint, tmp_path):
    """From the words of the command line to the refusal of a checkpoint that was cut off."""
    checkpoint.write_bytes(checkpoint.read_bytes()[:5000])
    words = [PETVES, *f"{COUPLED} -output_dir {tmp_path}/out -restart {checkpoint}".split()]
    done = checked(words, tmp_path, 1, leaks=False)  # a refused run ends as it is
    assert done.returncode == 1 and "checksum" in done.stderr, done.stderr
