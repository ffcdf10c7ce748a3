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
    "OMP_NUM_THREADS": "1",
}


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


def run_program(words: list[str], ranks: int) -> tuple[int, str]:
    """Run petves; return its exit status and, unless that is 0, the line that says why it stopped."""
    command = [str(program()), *words] if ranks == 1 else ["mpirun", "-n", str(ranks), str(program()), *words]
    try:
        done = subprocess.run(
            command, env=OPEN_MPI | os.environ, capture_output=True, text=True, stdin=subprocess.DEVNULL
        )
    except FileNotFoundError:
        raise RunError("mpirun: no such program; install openmpi-bin") from None
    lines = (done.stderr or done.stdout).strip().splitlines() or ["no message"]
    line = next((text for text in lines if "petves: error" in text), lines[-1])
    return done.returncode, line.replace("petves: error: ", "") if done.returncode else ""
