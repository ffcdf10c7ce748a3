"""What a refused or failed run must leave: one line, or the last good state."""

import re
import zlib

import h5py
import numpy as np
from harness import run_petves

#: Options of every row, before its own; without cells where -scheme_auto may choose them.
CELLS = "-domain_cells 32,32 "
SMALL = f"{CELLS}-time_step 0.01 -time_end 0.05"


def matches(pattern: str, line: str) -> bool:
    """Whether a line is the pattern, "..." standing for anything."""
    return re.fullmatch(".*".join(re.escape(part) for part in pattern.split("...")), line) is not None


def stops_with(run, needles):
    """One line on standard error, with every needle; exit status 1; no step taken."""
    one_line(run, *needles)
    assert not (run.folder / "series.csv").exists() or len(run.series["step"]) <= 1
    assert "step 1 " not in run.stdout


def leaves_files(run, reason):
    """checkpoint.h5 and summary.json of the last good state, the reason in both the line and the summary."""
    assert run.status == 2, run.stdout
    lines = [line for line in run.errors if line.startswith("petves: error: ")]
    assert len(lines) == 1 and len(run.errors) == 1, "\n".join(run.errors)
    summary, series = run.summary, run.series
    assert summary["reason"] in lines[0]
    assert re.search(reason, summary["reason"]), summary["reason"]
    assert summary["totals"]["steps"] == series["step"][-1]
    with h5py.File(run.folder / "checkpoint.h5") as file:
        assert file.attrs["step"] == series["step"][-1] and file.attrs["time"] == series["time"][-1]
        assert np.isfinite(file["vesicle/markers"][:]).all()
    return summary, series


def seal(path) -> None:
    """Give a checkpoint that was edited the checksum of its bytes."""
    data = path.read_bytes()
    path.write_bytes(data + b"petves checkpoint, crc32 %08x\n" % zlib.crc32(data))


def refused(folder, options, *needles, ranks=1):
    one_line(run_petves(folder, options, ranks, good=False), *needles)


def one_line(run, *needles):
    """The run was refused with one line that holds every needle."""
    assert run.status == 1 and len(run.errors) == 1, "\n".join(run.errors)
    assert run.errors[0].startswith("petves: error: ")
    for needle in needles:
        assert needle in run.errors[0]
