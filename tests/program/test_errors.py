"""A user's mistake stops the run before the first step, with one line that names the option, the value and what is
allowed. A step that cannot be taken stops it with the reason, and leaves checkpoint.h5 and summary.json."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from harness import PAPER, PETVES, ROOT, mpirun, run_petves, run_scenes, without_mpirun
from refusals import CELLS, SMALL, leaves_files, matches, stops_with


def circle(n: int, radius: float = 0.3, y: float = 0) -> list[str]:
    """Lines of a curve file."""
    t = 2 * np.pi * np.arange(n) / n
    return [f"{radius * np.cos(a):.15g} {radius * np.sin(a) + y:.15g}" for a in t]


def bump(height: float, waves: int = 1) -> list[str]:
    """Lines of a curve that stands on the wall y = -1 and comes back to it between its waves."""
    t = np.pi * np.arange(25) / 24
    return [f"{0.8 * np.cos(a):.15g} {-1 + height * abs(np.sin(waves * a)):.15g}" for a in t]


def around(n: int, radius: float = 1) -> list[str]:
    """Lines of n points on a sphere, a spiral from pole to pole."""
    z, turn = 1 - (2 * np.arange(n) + 1) / n, 2.4 * np.arange(n)
    across = np.sqrt(1 - z**2)
    return [
        f"{x:.15g} {y:.15g} {z:.15g}"
        for x, y, z in radius * np.stack([across * np.cos(turn), across * np.sin(turn), z], 1)
    ]


SPHERE = ["1 1 2 0 0", "1 -1 0 2 0", "1 0 0 0 2"]
AROUND = np.pi * np.arange(60) / 30
CIRCLE = circle(20)
CURVES = {
    "circle": CIRCLE,
    "nan": CIRCLE[:7] + ["nan 0.1"] + CIRCLE[7:],
    "infinite": CIRCLE[:7] + ["0.1 -inf"] + CIRCLE[7:],
    "three points": circle(3),
    "empty": ["# nothing"],
    "words": CIRCLE + ["x y"],
    "control character": CIRCLE[:2] + ["0.1\x1c 0.2"] + CIRCLE[2:],
    "three columns": ["0.1 0.2 0.3"] + CIRCLE,
    "repeated point": CIRCLE[:5] + CIRCLE[4:],
    "nearly the same point": [*CIRCLE[:3], "0.2427050983124842 0.1763355756877419", *CIRCLE[3:]],
    "long line": [CIRCLE[0], " " * 2000 + "0.1 0.2 0.3", *CIRCLE[1:]],
    "open": ["# open", *CIRCLE],
    "bump": ["# open", *bump(0.5)],
    "closed bump": bump(0.5),
    "low bump": ["# open", *bump(0.05)],
    "rising bump": ["# open", "# velocity 0 1", *bump(0.5)],
    "sliding bump": ["# open", "# velocity 1 0", *bump(0.5)],
    "half a velocity": ["# velocity 1", *CIRCLE],
    "infinite rotation": ["# rotation inf", *CIRCLE],
    "two bumps": ["# open", *bump(0.5, 2)],
    "corner": ["# open", *(f"{np.cos(a) - 1} {np.sin(a) - 1}" for a in np.pi * np.arange(13) / 24)],
    "line": [f"{0.1 * k - 1:.15g} 0" for k in range(21)],
    "above a line": [*(f"{0.1 * k - 1:.15g} 0" for k in range(21)), "", *circle(20, 0.2, 0.5)],
    "nested": [*circle(20)[::-1], "", *circle(20, 0.8)[::-1]],
    "sliding line": ["# velocity 1 0", *(f"{0.1 * k - 1:.15g} 0" for k in range(21))],
    "long ellipse": ["# rotation 30", *(f"{0.8 * np.cos(a):.15g} {0.2 * np.sin(a):.15g}" for a in AROUND)],
    "hook": [
        f"{r * np.cos(a):.15g} {r * np.sin(a):.15g}" for r, way in ((0.8, 1), (0.3, -1)) for a in 4 * AROUND[::way] / 6
    ],
    "flat": [f"{0.01 * k} 0" for k in range(20)],
    "two circles": [*CIRCLE, "", "", *CIRCLE],
    "far point": ["0 0", "3 0"],
    "few points in space": around(24),
    "points on a ring": [f"{np.cos(a):.15g} {np.sin(a):.15g} 0" for a in AROUND],
    "two spheres in one": around(40) + around(41, 1.5),
    "sphere": SPHERE,
    "half a harmonic": [*SPHERE, "1.5 0 0 0 0"],
    "surface that crosses itself": [*SPHERE, "3 1 5 0 0"],
}

OPTIONS = {
    "two values": b"-time_end 1\n-vesicle_angle 45 -30\n",
    "blank in a list": b"-domain_cells 32, 32 # cells\n",
    "no dash": b"# a comment\n\ntime_end 1\n",
    "equals": b"-time_step 0.1\n-time_end = 1\n",
    "mark, crlf": b"\xef\xbb\xbf-time_step 0.1\r\n-time_end=1\r\n",
    "cr": b"-time_step 0.1\r\r-time_end=1\r",
    "open quote": b'-output_dir "out\n',
    "zero": b"-time_step 0.1\n-time_end 1\0\n",
    "itself": b"-time_step 0.1\n-options_file itself.opts\n",
    "nothing there": b"-time_step 0.1\n-options_file no.opts\n",
    "a program": b'-time_end 1\n-Python "touch file.h5"\n',
    "a library": b"-dll_append ./evil.so\n",
    "a log": b"-log_view :file\n",
    "a monitor": b"-coupled_ksp_monitor ascii:file\n",
    "a solver": b"-coupled_pc_type python\n",
    "good": b"\xef\xbb\xbf# a comment\r\n-flow_rate 2\r\n\t-time_end\t0.02 # a comment\r\n",
}


#: Groups of rows that say why a scene is refused, however its options were given.
SCENES = ("options", "geometry")
MESSAGES = ROOT / "tests" / "repo" / "messages"


def rows() -> list[tuple[str, str, int, str]]:
    """Group, options, ranks and message of every row of tests/repo/messages that is made by options alone."""
    found = []
    for path in sorted(MESSAGES.glob("*.csv")):
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                if "options" in row:
                    found.append((path.stem, row["options"], int(row["ranks"]), row["message"]))
    return found


def with_files(options: str, folder: Path) -> str:
    """The page's scene and the options of a row, with the files that it names."""
    for kind, name in re.findall(r"\{(curve|opts): (.*?)\}", options):
        path = folder / f"{name.replace(' ', '_')}.{'txt' if kind == 'curve' else 'opts'}"
        path.write_bytes("\n".join([*CURVES[name], ""]).encode() if kind == "curve" else OPTIONS[name])
        options = options.replace(f"{{{kind}: {name}}}", str(path) if kind == "curve" else path.name)
    if options.startswith("-dim"):
        return options
    return f"{PAPER} {SMALL.removeprefix(CELLS) if options.startswith('-scheme_auto') else SMALL} {options}"


@pytest.mark.parametrize("ranks", [1, 2])
def test_scene_is_refused(ranks, tmp_path):
    """Rows whose scene is refused, one after another in one process: this line and no other."""
    table = [(options, message) for group, options, n, message in rows() if group in SCENES and n == ranks]
    scenes = {k: with_files(options, tmp_path) for k, (options, _) in enumerate(table)}
    found = list(run_scenes(tmp_path / "out", scenes, ranks, good=False).values())
    assert len(found) > 30 and not [run for run in found if run.status != 1 or run.folder.exists()]
    assert not [case for case in zip(table, found) if not matches(f"petves: error: {case[0][1]}", case[1].errors[0])]


def sample() -> list[tuple[str, int, str]]:
    """Options, ranks and message of six rows of each group of SCENES, spread over its table."""
    tables = ([row[1:] for row in rows() if row[0] == group] for group in SCENES)
    return [table[k * len(table) // 6] for table in tables for k in range(6)]


@pytest.mark.parametrize("options, ranks, message", sample(), ids=lambda value: str(value)[:40])
def test_program_refuses_scene(options, ranks, message, tmp_path):
    """As the process of many scenes does, and in the program: exit status, one line, nothing on disk."""
    run = run_petves(tmp_path / "out", with_files(options, tmp_path), ranks, good=False, timeout=60)
    stops_with(run, [])
    assert matches(f"petves: error: {message}", run.errors[0]) and not run.folder.exists(), run.errors


@pytest.mark.parametrize(
    "group, options, ranks, message", [row for row in rows() if row[0] not in SCENES], ids=lambda value: str(value)[:40]
)
def test_mistake_is_named(group, options, ranks, message, here):
    """A row of tests/repo/messages, in a run: this line and no other; bad input before any step, a failed step with the last
    good state."""
    run = run_petves(here / "out", with_files(options, here), ranks, good=False, timeout=60)
    assert matches(f"petves: error: {message}", "\n".join(run.errors)), run.errors
    if group == "steps":
        leaves_files(run, "")
    else:
        stops_with(run, [])


def test_there_are_rows_of_every_kind_and_the_page_shows_them():
    assert len(rows()) >= 300
    groups = {"words", "options", "geometry", "ranks", "files", "solvers", "steps"}
    assert {group for group, *_ in rows()} == groups
    shown = re.findall(r"messages/(\w+)\.csv", (ROOT / "docs" / "errors.md").read_text())
    assert sorted(shown) == sorted(path.stem for path in MESSAGES.glob("*.csv"))


@pytest.mark.parametrize("ranks", [1, 2])
def test_no_option_prints_the_usage(ranks, here):
    done = mpirun([PETVES], ranks, PETSC_OPTIONS="")
    assert done.returncode == 1 and "usage:" in done.stderr and done.stdout == "" and not list(here.iterdir())
    assert done.stderr.count("usage:") == 1 and "petves run shear" in done.stderr


def test_stray_word_alone(here):
    """No file, scene or tool: the default scene is not run."""
    done = mpirun([PETVES, "my.opts"], 2)
    line = '"my.opts": no option, file, scene or command; allowed: -name value, or what petves help lists'
    assert done.returncode == 1 and without_mpirun(done.stderr) == [f"petves: error: {line}"]
    assert not (here / "out").exists()


@pytest.mark.parametrize(
    "typed, needle",
    [
        ("stray", 'PETSC_OPTIONS: "stray": no option'),
        ("-time_end = 1", "PETSC_OPTIONS: -time_end = 1: an equals sign"),
        ("-domain_cells 32, 32", "PETSC_OPTIONS: -domain_cells 32, 32: two values"),
        ("-options_file no.opts", "PETSC_OPTIONS: -options_file no.opts: cannot be opened"),
        ("-time_ende 1", "-time_ende 1: no such option; -time_end is meant?"),
        ("-log_view gmres", "-log_view gmres: no viewer"),
    ],
)
def test_environment_is_read_alike(typed, needle, here):
    done = mpirun([PETVES, *SMALL.split()], 2, PETSC_OPTIONS=typed)
    lines = without_mpirun(done.stderr)
    assert done.returncode == 1 and len(lines) == 1 and needle in lines[0], done.stderr


def test_only_the_users_own_words_start_programs_or_write_elsewhere(tmp_path, monkeypatch):
    """No .petscrc of the folder is read, that of the home is; the command line may write a log, which resolved.opts leaves out."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    for name in (".petscrc", "petscrc"):
        Path(name).write_text("-python 'touch touched;'\n-nosuch 1\n")
    (tmp_path / ".petscrc").write_text("-log_view :home\n")
    done = mpirun([PETVES, *SMALL.split(), "-info", "info", "-coupled_ksp_monitor", ":monitor"], 1, HOME=str(tmp_path))
    assert done.returncode == 0, done.stderr
    found = {path.name for path in Path().iterdir()}
    assert found == {".petscrc", "petscrc", "home", "info.0", "monitor", "out"}
    assert not {"-log_view", "-info", "-coupled_ksp_monitor"} & set(Path("out/run/resolved.opts").read_text().split())


def test_command_line_wins_over_files_over_environment(here):
    """In whatever order they are given; a value in quotes may hold blanks and #."""
    (here / "inner.opts").write_text("-vesicle_angle 3\n-output_dir 'out/a # b'  # a comment\n")
    (here / "outer.opts").write_text("-options_file inner.opts\n-fluid_viscosity 2\n-vesicle_bending 0.02\n")
    words = "-time_end 0.01 -vesicle_bending 0.03 -options_file outer.opts -domain_cells 16,16".split()
    surroundings = "-fluid_viscosity 3 -time_end 9 -vesicle_angle 4 -time_step 0.01"
    done = mpirun([PETVES, *words], 1, PETSC_OPTIONS=surroundings)
    assert done.returncode == 0, done.stderr
    read = (here / "out" / "a # b" / "resolved.opts").read_text().splitlines()
    options = dict(line.split(maxsplit=1) for line in read if line.startswith("-"))
    wanted = dict(time_end=0.01, vesicle_bending=0.03, fluid_viscosity=2, vesicle_angle=3, time_step=0.01)
    assert {name: float(options[f"-{name}"]) for name in wanted} == wanted


@pytest.mark.parametrize("name", ["series.csv", "run.h5", "run.xmf", "resolved.opts", "checkpoint.h5", "summary.json"])
def test_file_that_cannot_be_written_is_named(name, tmp_path):
    """A folder is in the file's place; every rank stops."""
    (tmp_path / "out" / name / "in the way").mkdir(parents=True)
    run = run_petves(tmp_path / "out", f"{SMALL} -output_overwrite", ranks=2, good=False, timeout=60)
    assert run.status == 1
    assert len(run.errors) == 1 and run.errors[0].startswith("petves: error: "), "\n".join(run.errors)
    assert name in run.errors[0] and "cannot be written" in run.errors[0] and "allowed" in run.errors[0]


@pytest.mark.parametrize(
    "options", ["-vesicle_spacing 1.2 -vesicle_allow_close_markers", "-bendin 1 -allow_unused_options"]
)
def test_what_is_allowed_goes_on(options, tmp_path):
    assert len(run_petves(tmp_path / "out", f"{SMALL} {options} -time_end 0.01").series["step"]) == 2


FAILING = [("tension_", PAPER), ("bending_", PAPER)]
FAILING += [("coupled_", f"-scheme_startup {start}") for start in ("euler", "graded")]


@pytest.mark.parametrize("prefix, scheme", FAILING)
def test_failed_solve_stops_the_run(prefix, scheme, tmp_path):
    """Prefix, step, time and residual in the message; the state left is the one before the step, whose first one may have parts."""
    options = f"{scheme} {SMALL} -{prefix}ksp_max_it 1 -{prefix}ksp_rtol 1e-12"
    run = run_petves(tmp_path / "out", options, ranks=2, good=False)
    reason = rf"prefix {prefix} failed in step \d+ at time [\d.e-]+: DIVERGED_ITS after 1 iterations, residual [\d.]+"
    summary, series = leaves_files(run, reason)
    step = int(re.search(r"in step (\d+)", summary["reason"])[1])
    time = float(re.search(r"at time ([\d.e-]+):", summary["reason"])[1])
    assert step == series["step"][-1] + 1 and series["time"][-1] < time
    assert "graded" in scheme or time == pytest.approx(series["time"][-1] + 0.01)


def test_vesicle_carried_into_a_wall_stops_the_run(tmp_path):
    """Extension carries the vesicle away from the centre of the flow, to the wall at x_max."""
    options = f"{PAPER} -domain_cells 48,48 -flow_type extension -vesicle_center 0.4,0 -time_step 0.02 -time_end 5"
    run = run_petves(tmp_path / "out", options, ranks=2, good=False)
    reason = r"vesicle 1.*wall x_max = 1.*needs 3 after step \d+, time [\d.]+; try a larger -domain_box"
    summary, series = leaves_files(run, reason)
    step, time = re.search(r"after step (\d+), time ([\d.]+);", summary["reason"]).groups()
    assert int(step) == series["step"][-1] + 1 and float(time) == pytest.approx(series["time"][-1] + 0.02, rel=1e-5)
    assert 2 <= series["step"][-1] < 100
    assert 3 <= (1 - run.saved("vesicle/markers")[0, :, 0].max()) / (2 / 48) < 4, "the state before is the good one"
