"""Running the program bin/petves, or where there is none (pip) the one that is in libpetves.so."""

import ctypes
import os
import re
import subprocess
import sys
from pathlib import Path

from petves.errors import Error

LIBRARY = "libpetves.so"

OPEN_MPI = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_ess_singleton_isolated": "1",
    "OMP_NUM_THREADS": "1",
}
"""What Open MPI needs as root, on more ranks than cores and in containers; one rank without mpirun starts no daemon."""

PACKAGE = Path(__file__).resolve().parent


def candidates() -> list[Path]:
    """Return where libpetves.so is looked for, in this order.

    ``PETVES_LIBRARY``; the package itself (pip); ``lib`` of the repository; ``lib`` of the prefix of ``make install``, where
    the package is or where a command ``petves`` on PATH is.
    """
    if os.environ.get("PETVES_LIBRARY"):
        return [Path(os.environ["PETVES_LIBRARY"])]
    prefixes = [*PACKAGE.parents[1:6], *_of_command(), Path("/usr/local")]
    return [PACKAGE / LIBRARY, *(prefix / "lib" / LIBRARY for prefix in prefixes)]


def _of_command() -> list[Path]:
    """Return the prefixes of commands called petves on PATH, where make install has put the library too."""
    folders = os.environ.get("PATH", "").split(os.pathsep)
    return [Path(folder).parent for folder in folders if folder and (Path(folder) / "petves").is_file()]


def _find() -> tuple[Path | None, Path | None]:
    """Return the program, or the library that has it: the package's own before a program of another installation.

    The program is ``PETVES``, or in ``bin`` of the repository or of the prefix of ``make install``.
    """
    asked, prefixes = os.environ.get("PETVES"), [*PACKAGE.parents[1:6], Path("/usr/local")]
    places = [Path(asked)] if asked else [prefix / "bin" / "petves" for prefix in prefixes]
    here = Path(sys.argv[0]).resolve()  # pip's own script of that name
    found = next((place for place in places if place.is_file() and place != here), None)
    library = next(filter(Path.is_file, candidates()), None)
    if asked or (found and library != PACKAGE / LIBRARY):
        library = None
    if not library and not found:
        raise Error(f"{asked or 'bin/petves'}: no such program; build it with make, or set PETVES")
    return (None, library) if library else (found, None)


def command() -> list[str]:
    """Return the words that start petves: the program, or this Python with the library that pip has brought."""
    found, _ = _find()
    return [str(found)] if found else [sys.executable, "-m", "petves", "run"]


def scene_files() -> dict[str, Path]:
    """Return the scenes that come with petves by name: of the package (pip), the repository, or where make install has put them."""
    prefixes = [PACKAGE, *PACKAGE.parents[1:6], *_of_command(), Path("/usr/local")]
    folders = [folder for prefix in prefixes for folder in (prefix / "runs", prefix / "share" / "petves" / "runs")]
    folder = next((folder for folder in folders if (folder / "default.opts").is_file()), PACKAGE)
    return {path.relative_to(folder).with_suffix("").as_posix(): path for path in sorted(folder.rglob("*.opts"))}


def scene_file(word: str) -> str:
    """Return the file of a scene by its name; a word that is a file, an option or no name as it is."""
    return str(scene_files().get(word, word)) if not (word.startswith("-") or os.path.isfile(word)) else word


def scenes() -> list[str]:
    """Return a line for each scene that comes with petves: its name and how its file begins."""
    first = {name: path.read_text().partition("# ")[2].partition("\n")[0] for name, path in scene_files().items()}
    return [f"{name:<23} {re.split(r'[:.;] ', text)[0]}" for name, text in first.items()]


def become(words: list[str]) -> int:
    """Run petves with these words in place of this process, or from the library; return its exit status."""
    found, library = _find()
    os.environ.update(OPEN_MPI | os.environ)
    if found:
        os.execv(found, [str(found), *words])
    try:
        main = ctypes.CDLL(str(library)).PetvesMain
    except (OSError, AttributeError) as error:
        raise Error(f"{library}: cannot be used ({error})") from None
    given = [word.encode("utf-8", "surrogateescape") for word in ("petves", *words)]
    return main(len(given), (ctypes.c_char_p * (len(given) + 1))(*given, None))


def launch(words: list[str], ranks: int = 1, timeout: float | None = None) -> subprocess.CompletedProcess[str]:
    """Run petves; return what has ended: its status and what it has printed. subprocess.TimeoutExpired after `timeout`."""
    started = [*(["mpirun", "-n", str(ranks)] if ranks > 1 else []), *command(), *words]
    path = os.pathsep.join(filter(None, (str(PACKAGE.parent), os.environ.get("PYTHONPATH"))))
    kept = {"capture_output": True, "text": True, "errors": "replace", "stdin": subprocess.DEVNULL}
    # a Python takes this package, and no module from the current folder
    kept["env"] = OPEN_MPI | os.environ | {"PYTHONPATH": path, "PYTHONSAFEPATH": "1"}
    try:
        done = subprocess.run(started, timeout=timeout, **kept)
    except FileNotFoundError:
        raise Error("mpirun: no such program; install openmpi-bin") from None
    if ranks == 1 and "An error occurred in MPI_Init" in done.stderr:  # of two that start in the same moment
        done = subprocess.run(started, timeout=timeout, **kept)
    return done


def run_program(words: list[str], ranks: int) -> tuple[int, str]:
    """Run petves; return its exit status and, unless that is 0, the line that says why it stopped."""
    done = launch(words, ranks)
    lines = (done.stderr or done.stdout).strip().splitlines() or ["no message"]
    line = next((text for text in lines if "petves: error" in text), lines[-1])
    return done.returncode, line.replace("petves: error: ", "") if done.returncode else ""
