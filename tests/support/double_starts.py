"""Two runs that want the same folder: one of them gets it, the other is told by whom it is used, and no row is lost."""

import json
import random
import subprocess
import time
from pathlib import Path

import h5py
import harness
import numpy as np
from harness import read_series, wait_for

SCENE = "-domain_cells 24,24 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.02 -output_every 0.1"
STEPS = 300
END = f"-time_end {0.02 * STEPS} -checkpoint_every 10"


def start(folder: Path, options: str) -> subprocess.Popen:
    return harness.start(folder, f"{SCENE} {END} {options}", **harness.QUIET)


def whole(folder: Path) -> None:
    """Every row, every frame, the last checkpoint and an end, and no lock left behind."""
    assert read_series(folder / "series.csv")["step"].tolist() == list(range(STEPS + 1))
    with h5py.File(folder / "run.h5") as file:
        np.testing.assert_allclose(file["time"][:], 0.1 * np.arange(STEPS // 5 + 1), atol=1e-12)
        assert len(file["fluid/u"]) == len(file["time"]) and np.isfinite(file["vesicle/markers"][:]).all()
    assert harness.attribute(folder / "checkpoint.h5") == STEPS
    assert json.loads((folder / "summary.json").read_text())["reason"] == "finished"
    assert not (folder / "run.lock").exists()


def two(folder: Path, kind: str, draw: random.Random) -> list[subprocess.Popen]:
    """The two runs of a kind; the first may be live already, or both begin in the same moment."""
    restart = f"-restart {folder}/checkpoint.h5"
    if kind in ("restart twice", "overwrite and restart"):
        assert start(folder, f"-time_end {0.02 * (STEPS // 3)}").wait() == 0
        first = start(folder, "-output_overwrite" if kind == "overwrite and restart" else restart)
        return [first, start(folder, restart)]
    first = start(folder, "")
    if kind == "fresh":
        time.sleep(draw.choice((0, 0, draw.uniform(0, 0.3))))
        return [first, start(folder, "")]
    wait_for((folder / "checkpoint.h5").exists)
    return [first, start(folder, restart if kind == "restart" else "-output_overwrite")]


KINDS = ("fresh", "overwrite", "restart", "restart twice", "overwrite and restart")


def double_start(folder: Path, kind: str, draw: random.Random) -> None:
    """Start two runs. Those that are not refused end well, and the folder is whole."""
    runs = two(folder, kind, draw)
    said = [run.communicate(timeout=120)[1] for run in runs]
    for run, text in zip(runs, said):
        assert run.returncode in (0, 1), text
        if run.returncode:
            assert text.count("\n") == 1 and text.startswith("petves: error: -output_dir"), text
            assert "in use by process" in text or "holds" in text, text
    assert sum(run.returncode for run in runs) < 2, said
    whole(folder)
