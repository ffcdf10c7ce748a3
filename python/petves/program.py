"""Running the program bin/petves."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from petves.run import RunError

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


def program() -> Path:
    """Return the program: ``PETVES``, the repository's bin/petves, or that of the prefix of ``make install``."""
    if os.environ.get("PETVES"):
        places = [Path(os.environ["PETVES"])]
    else:
        prefixes = [*Path(__file__).resolve().parents[2:7], Path("/usr/local")]
        places = [prefix / "bin" / "petves" for prefix in prefixes]
    found = next((place for place in places if place.is_file()), None)
    if found is None:
        raise RunError(f"{places[0]}: no such program; build it with make, or set PETVES")
    return found


def launch(words: list[str], ranks: int = 1, timeout: float | None = None) -> subprocess.CompletedProcess[str]:
    """Run petves; return what has ended: its status and what it has printed. subprocess.TimeoutExpired after `timeout`."""
    command = [*(["mpirun", "-n", str(ranks)] if ranks > 1 else []), str(program()), *words]
    kept = {"capture_output": True, "text": True, "errors": "replace", "stdin": subprocess.DEVNULL}
    try:
        done = subprocess.run(command, env=OPEN_MPI | os.environ, timeout=timeout, **kept)
    except FileNotFoundError:
        raise RunError("mpirun: no such program; install openmpi-bin") from None
    if ranks == 1 and "An error occurred in MPI_Init" in done.stderr:  # of two that start in the same moment
        done = subprocess.run(command, env=OPEN_MPI | os.environ, timeout=timeout, **kept)
    return done


def run_program(words: list[str], ranks: int) -> tuple[int, str]:
    """Run petves; return its exit status and, unless that is 0, the line that says why it stopped."""
    done = launch(words, ranks)
    lines = (done.stderr or done.stdout).strip().splitlines() or ["no message"]
    line = next((text for text in lines if "petves: error" in text), lines[-1])
    return done.returncode, line.replace("petves: error: ", "") if done.returncode else ""
