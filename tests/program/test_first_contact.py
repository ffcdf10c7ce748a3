"""What a new user meets first: help, version, the manual page and completion, the words run and plot, the Makefile."""

import ast
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from harness import ENVIRONMENT, PETVES, PROGRAMS, ROOT, SANITIZE, mpirun, without_mpirun

sys.path.insert(0, str(ROOT / "python"))
from check_options import STUB, described, missing, stub  # noqa: E402
from make_manual import completion, manual  # noqa: E402

SMALL = "-domain_cells 24,24 -vesicle_semi_axes 0.4,0.5 -time_step 0.01 -time_end 0.01".split()


@pytest.mark.parametrize("word, ranks", [("-help", 1), ("--help", 1), ("-h", 1), ("-help", 2)])
def test_help_is_half_a_screen(word, ranks, here):
    """It names scenes and pages that are there."""
    done = mpirun([PETVES, *SMALL, word], ranks, PETSC_OPTIONS="")
    assert done.returncode == 0 and not done.stderr and not list(here.iterdir())
    assert done.stdout.count("usage:") == 1 and "README.md" in done.stdout
    lines = done.stdout.splitlines()
    assert len(lines) <= 25 and max(map(len, lines)) <= 110
    named = re.findall(r"\b(?:runs|docs)/\w+\.\w+|README\.md", done.stdout)
    named += [f"runs/{scene}.opts" for scene in re.findall(r"^  petves run (\w+)", done.stdout, re.MULTILINE)]
    assert len(set(named)) >= 4 and all((ROOT / name).is_file() for name in named)


def test_page_of_options_has_the_rows_of_the_table():
    page = (ROOT / "docs" / "options.md").read_text()
    assert len(described(PETVES)) > 60 and missing(PETVES, page) == []
    (row,) = re.findall(r"^\| `-time_step` .*$", page, re.MULTILINE)
    other = row.replace("0.01", "0.02")
    said = [f"docs/options.md lacks {row}", f"docs/options.md has {other}"]
    assert missing(PETVES, page.replace(row, other)) == said


def test_stub_has_the_options_of_the_table():
    """Editors complete their names in petves.Simulation(...): python/check_options.py --write writes the stub anew."""
    assert STUB.read_text() == stub(PETVES)
    body = ast.parse(STUB.read_text()).body[-1].body
    assert [entry.target.id for entry in body][: len(described(PETVES))] == [x.name[1:] for x in described(PETVES)]


def test_help_of_a_word():
    names = [option.name for option in described(PETVES)]
    text = mpirun([PETVES, "-help", "flow"], 1).stdout
    assert re.findall(r"^  (-\w+)", text, re.MULTILINE) == [name for name in names if "flow" in name]
    assert max(map(len, text.splitlines())) <= 110 and "Also in the help of -" in text


FOUND = {"kappa": "-vesicle_bending", "channel": "-flow_drive", "Pressure": "-flow_drive"}
FOUND |= {"stenosis": "-obstacle_shape", "reynolds": "-fluid_inertia", "GPU": "no graphics processors"}


@pytest.mark.parametrize("word, found", FOUND.items())
def test_help_of_a_word_that_no_name_has(word, found):
    """Help texts, what is allowed, and words for what there is or is not; case is ignored."""
    done = mpirun([PETVES, "help", word], 1)
    assert done.returncode == 0 and found in done.stdout and len(done.stdout.splitlines()) < 40
    assert max(map(len, done.stdout.splitlines())) <= 110


@pytest.mark.parametrize("words", [["help"], ["-help"], ["help", "plot"], ["-help", "plot"]])
def test_help_is_a_word_too(words):
    done = mpirun([PETVES, *words], 1)
    first = "usage: petves plot" if "plot" in words else "petves: vesicles and capsules"
    assert done.returncode == 0 and done.stdout.startswith(first)


@pytest.mark.parametrize("ranks", [1, 2])
def test_help_of_a_word_that_no_option_has(ranks, here):
    done = mpirun([PETVES, "-help", "cheese"], ranks)
    line = "petves: error: -help cheese: in no option's name or help; allowed: options, all, a tool, or a word"
    assert done.returncode == 1 and without_mpirun(done.stderr) == [line]


@pytest.mark.skipif(SANITIZE, reason="PETSc 3.18 frees the value of its -help before it copies it")
def test_help_all_sets_the_scene_up_and_has_the_solvers(here):
    done = mpirun([PETVES, *SMALL, "-help", "all"], 1)
    assert done.returncode == 0 and not list(here.iterdir())
    assert "-coupled_ksp_rtol" in done.stdout and "-domain_box" in done.stdout
    done = mpirun([PETVES, *SMALL, "-no_such", "1", "-help", "all"], 1)
    assert done.returncode == 1 and "-no_such 1: no such option" in done.stderr


@pytest.mark.parametrize("word, ranks", [("-version", 1), ("--version", 2)])
def test_version_is_one_line(word, ranks):
    done = mpirun([PETVES, word], ranks)
    pattern = r"petves \d+\.\d+\.\d+, commit \S+, with PETSc 3\.\d+\.\d+, for \w+( -m(arch|cpu)=\S+)?\n"
    assert done.returncode == 0 and not done.stderr and re.fullmatch(pattern, done.stdout), done.stdout


def test_run_takes_a_file(here):
    Path("my.opts").write_text("\n".join(" ".join(SMALL[k : k + 2]) for k in range(0, len(SMALL), 2)) + "\n")
    done = mpirun([PETVES, "run", "my.opts", "-output_dir", "one"], 2)
    assert done.returncode == 0, done.stderr
    done = mpirun([PETVES, "run", *SMALL, "-output_dir", "two"], 1)
    assert done.returncode == 0 and Path("one/run.h5").is_file() and Path("two/run.h5").is_file()
    done = mpirun([PETVES, "run", "none.opts"], 1)
    assert done.returncode == 1 and done.stderr.startswith("petves: error: -options_file none.opts: cannot be opened")
    assert mpirun([PETVES, "run"], 1, PETSC_OPTIONS="").returncode == 1


@pytest.mark.parametrize("words, ranks", [("run stirring", 2), ("stirring", 1), (f"{ROOT}/runs/stirring.opts", 1)])
def test_scene_by_name_with_the_file_beside_it(words, ranks, here):
    """A scene that comes with petves runs from anywhere, with or without run; its curve lies beside it."""
    done = mpirun([PETVES, *words.split(), "-time_end", "0", "-output_dir", "out"], ranks)
    assert done.returncode == 0, done.stderr
    (line,) = re.findall(r"^-obstacle_file (.*)", Path("out/resolved.opts").read_text(), re.MULTILINE)
    assert Path(line).resolve() == ROOT / "runs" / "stirring.txt"


def test_file_beside_an_options_file(here):
    """What a file names is looked for where the program was started first, then beside the file, included files too."""
    Path("scenes").mkdir()
    Path("scenes/inner.opts").write_text("-domain_cells 24,24\n-vesicle_shape file\n-vesicle_file curve.txt\n")
    Path("scenes/outer.opts").write_text("-options_file inner.opts\n-time_end 0\n")
    circle = [f"{0.5 * math.cos(k / 5):.9f} {0.5 * math.sin(k / 5):.9f}" for k in range(31)]
    Path("scenes/curve.txt").write_text("\n".join(circle) + "\n")
    assert mpirun([PETVES, "scenes/outer.opts", "-output_dir", "a"], 2).returncode == 0
    Path("curve.txt").write_text("\n".join(circle[:-1]) + "\n")
    assert mpirun([PETVES, "scenes/outer.opts", "-output_dir", "b"], 1).returncode == 0
    for folder, file in (("a", "scenes/curve.txt"), ("b", "curve.txt")):
        assert f"-vesicle_file {file}\n" in Path(folder, "resolved.opts").read_text()


def test_tools_are_python_s(here):
    """petves plot and the others start the package, whose commands are these and no others."""
    source = (ROOT / "src" / "app" / "program.c").read_text()
    tools = re.findall(r'"(\w+)"', re.search(r"tools\[\] = \{(.*?)\}", source, re.DOTALL)[1])
    done = mpirun([PETVES, tools[0], "--help"], 1)
    assert done.returncode == 0 and done.stdout.startswith(f"usage: petves {tools[0]}"), done.stderr
    words, paths = [sys.executable, "-m", "petves", "--help"], os.environ | {"PYTHONPATH": str(ROOT / "python")}
    top = subprocess.run(words, env=paths, capture_output=True, text=True, check=True).stdout
    assert re.search(r"\{([\w,]+)\}", top)[1].split(",") == ["run", *tools]


def test_a_tool_needs_no_python_path_and_takes_options_of_one_dash(here):
    """As runs have them: the answer is of the folder, not of the option."""
    done = mpirun([PETVES, "plot", "nowhere", "-width", "3.4"], 1, PYTHONPATH="")
    line = "petves: error: nowhere: no such folder; give the -output_dir of a run\n"
    assert done.returncode == 1 and done.stderr == line


def test_manual_has_every_option(tmp_path):
    options = described(PETVES)
    usage = mpirun([PETVES, "-help"], 1).stdout
    page = manual(options, usage, "petves 0")
    (tmp_path / "petves.1").write_text(page)
    names = re.findall(r"^\.B (\S+)$", page.replace("\\", ""), re.MULTILINE)
    assert names == [option.name for option in options]
    if shutil.which("groff"):
        words = ["groff", "-man", "-Tutf8", "-ww", str(tmp_path / "petves.1")]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        assert not done.stderr and "cells in x and y" in done.stdout


OFFERED = {"mov": "movie", "-time_e": "-time_end", "-view -scheme_type s": "split", "run my": "my.opts"}
OFFERED |= {"-output_dir o": "out", "-view pl": ""}


@pytest.mark.parametrize("words, offered", OFFERED.items())
def test_completion(words, offered, here):
    Path("my.opts").touch()
    Path("out").mkdir()
    Path("petves.bash").write_text(completion(described(PETVES)))
    script = f"source petves.bash; COMP_WORDS=(petves {words}); COMP_CWORD={len(words.split())}; _petves"
    script += '; echo "${COMPREPLY[@]}"'
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == offered.split() and not done.stderr


def make_arch(*words: str, **environment: str) -> str:
    command = ["make", "-s", "-C", str(ROOT), "arch", *words]
    environment = {**ENVIRONMENT, "PATH": "/usr/bin:/bin", **environment}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()


V2 = "cx16 lahf_lm popcnt sse4_1 sse4_2 ssse3"
V3 = f"{V2} abm avx avx2 bmi1 bmi2 f16c fma movbe"


@pytest.mark.parametrize(
    "words, chosen",
    [
        (["MACHINE=x86_64", f"CPU_FLAGS={V3} other"], "x86_64 -march=x86-64-v3"),
        (["MACHINE=x86_64", f"CPU_FLAGS={V3.replace('fma', '')}"], "x86_64 -march=x86-64-v2"),
        (["MACHINE=x86_64", "CPU_FLAGS=sse2"], "x86_64"),
        (["MACHINE=x86_64", f"CPU_FLAGS={V3}", "CC=false"], "x86_64"),
        (["MACHINE=aarch64", "CPU_FLAGS=", "CC=true"], "aarch64 -mcpu=native"),
        (["MACHINE=aarch64", "CPU_FLAGS=", "CC=false"], "aarch64"),
        (["MACHINE=riscv64", "CPU_FLAGS="], "riscv64"),
        (["MACHINE=x86_64", "ARCH=haswell"], "x86_64 -march=haswell"),
        (["MACHINE=x86_64", "ARCH="], "x86_64"),
    ],
)
def test_makefile_builds_for_the_processor(words, chosen):
    """Also one whose compiler does not know the name (CC=false)."""
    assert make_arch(*words) == chosen


if not SANITIZE:

    def test_the_program_says_what_it_was_built_for():
        """As make would build it now, or as another ARCH was given then."""
        built = (PROGRAMS.parent / ".arch").read_text().strip()
        assert mpirun([PETVES, "-version"], 1).stdout.strip().endswith(f"for {built}")
        assert make_arch(ARCH="nonsense") == make_arch(), "what the environment calls ARCH is another thing"
