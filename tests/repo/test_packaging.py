"""What petves is packed into: the archive of make dist, pkg-config, a wheel, a conda recipe, a container file, a citation."""

import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest
import yaml
from harness import ENVIRONMENT, PETVES, PROGRAMS, ROOT, SANITIZE, SITE, mpirun

import petves

PACKAGING = ROOT / "packaging"
OWN = os.environ.get("PETSC_DIR")  # of another PETSc than Debian's, which pkg-config does not find by itself
VERSION = re.search(r'PETVES_VERSION "(.*)"', (ROOT / "src" / "base" / "version.h").read_text())[1]
PROGRAM = """#include <petves.h>
int main(int argc, char **argv) {
  Simulation simulation;
  const char *column;
  if (PetvesInitialize(&argc, &argv) || SimulationCreate(PETSC_COMM_WORLD, &simulation)) return 1;
  if (SimulationGetColumn(simulation, 2, &column)) return 1;
  printf("%s\\n", column);
  return SimulationDestroy(&simulation) || PetvesFinalize();
}
"""

INSTALLED = """
import petves
from petves.program import scene_file
with petves.Simulation(domain_cells=(24, 24), vesicle_semi_axes=(0.4, 0.5), time_end=0.01) as sim: sim.run()
print(petves.__file__, petves.library.library()._name, scene_file('stirring'))
"""


def run(words: list, folder: Path = ROOT, **environment: str) -> str:
    """Run a command without this test's own settings of where petves is; return what it prints."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("PETVES", "PYTHON"))}
    environment = {**kept, **ENVIRONMENT, **environment}
    how = dict(capture_output=True, text=True, timeout=300, cwd=folder)
    done = subprocess.run(list(map(str, words)), env=environment, **how)
    assert done.returncode == 0, f"{words}\n{done.stdout}{done.stderr}"
    return done.stdout


def test_one_version():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    project = re.search(r'^version = "(.*)"', (ROOT / "python" / "pyproject.toml").read_text(), re.MULTILINE)[1]
    latest = re.search(r"^## \[(\d+\.\d+\.\d+)\]", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[1]
    program = mpirun([PETVES, "-version"], 1).stdout.split(",")[0].split()[1]
    assert VERSION == str(citation["version"]) == project == latest == recipe()["context"]["version"]
    assert program == petves.__version__ == VERSION


def test_citation_has_what_its_format_asks_for():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert {"cff-version", "message", "title", "authors", "license"} <= set(citation)
    for work in [citation, *citation["references"]]:
        assert work["title"] and all(author.get("name") or author.get("family-names") for author in work["authors"])


RECIPE = PACKAGING / "conda" / "recipe.yaml"
RENDER = """
import sys
from rattler_build import PlatformConfig, RenderConfig, Stage0Recipe, VariantConfig
text, variants = sys.stdin.read(), VariantConfig.from_yaml("c_compiler: [gcc]")
for platform in ("linux-64", "linux-aarch64", "osx-arm64"):
    config = RenderConfig(platform=PlatformConfig(target_platform=platform))
    (found,) = Stage0Recipe.from_yaml(text).render(variants, config)
    print(platform, found.recipe.package.version, found.recipe.requirements.to_dict()["build"][0])
"""


def recipe() -> dict:
    return yaml.safe_load(RECIPE.read_text())


def test_conda_recipe_is_whole():
    """Its parts are there, what it needs at run time is what the Python package needs, and its script is good shell."""
    found = recipe()
    assert set(found) == {"context", "package", "source", "build", "requirements", "tests", "about"}
    assert {"build", "host", "run"} == set(found["requirements"])
    needed = {entry.split()[0] for entry in found["requirements"]["run"]}
    project = (ROOT / "python" / "pyproject.toml").read_text()
    wanted = set(re.findall(r'"([\w-]+)"', re.search(r"^dependencies = (.*)$", project, re.MULTILINE)[1]))
    assert {name.replace("matplotlib-base", "matplotlib") for name in needed} >= wanted
    assert (RECIPE.parent / found["source"]["path"] / "Makefile").resolve() == ROOT / "Makefile"
    build = (RECIPE.parent / found["build"]["script"]).read_text()
    makefile = (ROOT / "Makefile").read_text()
    names = re.findall(r"\b([A-Z_]+)=", build.split("words=(")[1])
    assert len(names) > 5 and not [name for name in names if not re.search(rf"^{name} [:?]?=", makefile, re.MULTILINE)]
    run(["shellcheck", RECIPE.parent / found["build"]["script"]])


def rendered(text: str) -> subprocess.CompletedProcess:
    """Render a recipe as rattler-build does, for three platforms: its schema, expressions, versions and licence."""
    words, environment = [sys.executable, "-c", RENDER], {**os.environ, "PYTHONPATH": str(SITE)}
    return subprocess.run(words, input=text, env=environment, capture_output=True, text=True, timeout=60)


@pytest.mark.skipif(not (SITE / "rattler_build").is_dir(), reason="rattler-build could not be installed from PyPI")
def test_conda_recipe_is_taken_by_rattler_build():
    text = RECIPE.read_text()
    done = rendered(text)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n")[0] == f"linux-64 {VERSION} gcc_linux-64"
    mistakes = {
        ("host:", "hosts:"): "unknown field",
        ("BSD-2-Clause", "BSD-2"): "SPDX",
        ("{{ version", "{{ release"): "undefined value",
        ("* real*", "=*=real*"): "build string",
    }
    for (right, wrong), complaint in mistakes.items():
        refused = rendered(text.replace(right, wrong))
        assert refused.returncode and complaint in refused.stderr, (wrong, refused.stderr)


@pytest.mark.skipif(not shutil.which("rattler-build"), reason="rattler-build is not installed")
def test_conda_package_is_built(tmp_path):
    run(["rattler-build", "build", "--recipe", RECIPE.parent, "-c", "conda-forge", "--output-dir", tmp_path])
    assert list(tmp_path.rglob("petves-*.conda"))


def instructions() -> list[tuple[str, str]]:
    text = re.sub(r"\\\n", " ", (PACKAGING / "Containerfile").read_text())
    return re.findall(r"^([A-Z]+) (.*)$", text, re.MULTILINE)


def test_container_file_is_sound(tmp_path):
    """Not built here unless podman is at hand: known instructions, good shell, packages that Debian has."""
    found = instructions()
    assert [name for name, _ in found].count("FROM") == 2 and found[0][0] == "FROM"
    assert {name for name, _ in found} <= {"FROM", "RUN", "COPY", "WORKDIR", "ENV", "ENTRYPOINT", "CMD"}
    script = tmp_path / "run.sh"
    script.write_text("#!/bin/sh\nset -e\n" + "\n".join(text for name, text in found if name == "RUN") + "\n")
    run(["shellcheck", script])
    listed = re.findall(r"--no-install-recommends (.*?) &&", script.read_text())
    packages = [word for line in listed for word in line.split()]
    assert len(packages) > 10
    if Path("/etc/debian_version").exists() and Path("/etc/debian_version").read_text().startswith("12"):
        run(["dpkg-query", "-W", *(name for name in packages if name != "ca-certificates")])


HADOLINT = SITE / "bin" / "hadolint"


@pytest.mark.skipif(not HADOLINT.is_file(), reason="hadolint could not be installed from PyPI")
def test_container_file_has_no_lint():
    """But that Debian's packages are not pinned (DL3008): a release's security updates are wanted."""
    run([HADOLINT, "--ignore", "DL3008", PACKAGING / "Containerfile"])


@pytest.mark.skipif(not shutil.which("podman"), reason="podman is not installed")
def test_container_is_built():
    run(["podman", "build", "-f", PACKAGING / "Containerfile", "-t", "petves-test", ROOT])
    assert f"petves {VERSION}" in run(["podman", "run", "--rm", "petves-test", "-version"])
    run(
        "podman run --rm --entrypoint python3 petves-test -c".split() + ["import petves; petves.Simulation"]
    )  # with petsc4py


if not SANITIZE and not OWN:

    @pytest.fixture(scope="module")
    def prefix(tmp_path_factory):
        """petves after make install into a folder that had nothing: ~/.local, where Debian's Python looks too."""
        folder = tmp_path_factory.mktemp("home") / ".local"
        run(["make", "-s", "install", f"PREFIX={folder}", "BIN=bin", "LIBDIR=lib"])
        return folder

    @pytest.mark.xdist_group("prefix")
    def test_pkg_config_builds_a_program(prefix, tmp_path):
        (tmp_path / "own.c").write_text(PROGRAM)
        paths = dict(PKG_CONFIG_PATH=str(prefix / "lib" / "pkgconfig"))
        assert run(["pkg-config", "--modversion", "petves"], **paths).strip() == VERSION
        flags = run(["pkg-config", "--cflags", "--libs", "petves"], **paths).split()
        run(["mpicc", "own.c", "-o", "own", *flags], tmp_path)
        assert run(["./own", "-domain_cells", "16,16"], tmp_path) == "dt\n"

    @pytest.mark.xdist_group("prefix")
    def test_wheel_finds_an_installed_library(prefix, tmp_path):
        """A wheel made where nothing was built, installed elsewhere: the command on PATH leads to the library."""
        shutil.copytree(ROOT / "python", tmp_path / "python", ignore=shutil.ignore_patterns("__pycache__", "build"))
        pip = [sys.executable, "-m", "pip", "-q"]
        run([*pip, "wheel", "--no-build-isolation", "--no-deps", "--no-index", "-w", tmp_path, tmp_path / "python"])
        (wheel,) = tmp_path.glob(f"petves-{VERSION}-*.whl")
        site = tmp_path / "site"
        run([*pip, "install", "--no-deps", "--no-index", "--root-user-action=ignore", "--target", site, wheel])
        assert not list(site.rglob("*.so"))
        code = "from petves.library import library; import petves; print(library()._name, petves.__file__)"
        path = f"{prefix / 'bin'}:{os.environ['PATH']}"
        found = run([sys.executable, "-c", code], tmp_path, PATH=path, PYTHONPATH=str(site)).split()
        assert found == [str(prefix / "lib" / "libpetves.so"), str(site / "petves" / "__init__.py")]

    @pytest.mark.xdist_group("prefix")
    def test_an_installed_package_runs_and_is_removed(prefix):
        (site,) = prefix.glob("lib/python3*/site-packages")
        assert (site / "petves" / "py.typed").is_file() and (site / "petves" / "__init__.pyi").is_file()
        python = lambda *words: run(["/usr/bin/python3", *words], HOME=str(prefix.parent))
        found = [str(site / "petves" / "__init__.py"), str(prefix / "lib" / "libpetves.so")]
        assert python("-c", INSTALLED).split() == [*found, f"{prefix}/share/petves/runs/stirring.opts"]
        assert "\nstirring " in python("-m", "petves", "scenes")
        # the tools find bin/petves under the prefix, and the program finds them
        python("-m", "petves", "sweep", str(prefix / "s"), "--vary", "time_end", "0")
        run([prefix / "bin" / "petves", "compare", prefix / "s" / "time_end=0", prefix / "s" / "time_end=0"], prefix)
        assert (prefix / "s" / "time_end=0" / "compare.png").is_file()
        left = "man/man1/petves.1 bash-completion/completions/petves petves/runs/shear.opts doc/petves/README.md"
        left += " doc/petves/docs/options.md doc/petves/docs/gallery/capillary.png"
        assert all((prefix / "share" / name).is_file() for name in left.split())
        run(["make", "-s", "uninstall", f"PREFIX={prefix}"])
        assert not [path for path in prefix.rglob("*petves*") if path.is_file()]

    @pytest.mark.xdist_group("prefix")
    def test_archive_is_what_the_repository_has_and_builds(tmp_path):
        """make dist has every file and the commit, and make builds the program in it without git.

        The objects of this build stand in for compiling all of it again: their sources are the archive's.
        """
        if not (ROOT / ".git").exists():
            pytest.skip("not in a clone")
        run(["make", "-s", "dist", f"BUILD={tmp_path}"])
        with tarfile.open(tmp_path / f"petves-{VERSION}.tar.gz") as archive:
            archive.extractall(tmp_path)
        tree = tmp_path / f"petves-{VERSION}"
        listed = run(["git", "ls-tree", "-r", "--name-only", "HEAD"]).split("\n")[:-1]
        packed = {str(path.relative_to(tree)) for path in tree.rglob("*") if path.is_file()}
        assert packed == {*listed, ".commit"} and "Makefile" in packed
        for source in [path for path in PROGRAMS.parent.rglob("*.o") if "tests" not in path.parts]:
            copy = tree / "build" / source.relative_to(PROGRAMS.parent)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
        shutil.copy(PROGRAMS.parent / ".arch", tree / "build")
        os.utime(tree / "build" / ".arch", (0, 0))
        said = run(["make", f"ARCH={arch()}"], tree)
        assert said.count("link lib/libpetves.so") == 1 and (tree / "bin" / "petves").is_file()
        commit = (tree / ".commit").read_text().strip()
        assert f"petves {VERSION}, commit {commit}, with" in run([tree / "bin" / "petves", "-version"])


def arch() -> str:
    """Return the ARCH= that this build has."""
    built = (PROGRAMS.parent / ".arch").read_text().strip()
    return built.partition("=")[2]
