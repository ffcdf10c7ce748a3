"""Files that cannot be closed or written: one line on every rank, everything freed, and the last good state on disk. And
what a frame costs, at any time of a run."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import h5py
import numpy as np
import pytest
from harness import PAPER, PETVES, SANITIZE, attribute, mpirun, preloaded, run_petves, run_python, simulation
from harness import without_mpirun
from restarts import without_wall

pytestmark = pytest.mark.xdist_group("output_faults")  # its tests share runs

SCENE = "-domain_cells 24,24 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.02 -output_every 0.04"

#: fclose, and close of what is not a FILE, which fail for the file of a given name; the files are closed none the less.
FAULT = r"""
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int hit(int file) {
  char link[64], path[4096], *slash;
  const char *name = getenv("PETVES_FAULT");
  snprintf(link, sizeof(link), "/proc/self/fd/%d", file);
  const ssize_t n = readlink(link, path, sizeof(path) - 1);
  path[n > 0 ? n : 0] = 0;
  slash = strrchr(path, '/');
  return name && slash && !strcmp(slash + 1, name);
}

int fclose(FILE *file) {
  const int bad = hit(fileno(file)), error = REAL(fclose)(file);
  if (bad) errno = ENOSPC;
  return bad ? EOF : error;
}

int close(int file) {
  const int bad = hit(file), error = REAL(close)(file);
  if (bad) errno = ENOSPC;
  return bad ? -1 : error;
}
"""


@pytest.fixture(scope="module")
def fault(tmp_path_factory) -> str:
    return preloaded(tmp_path_factory.mktemp("fault"), FAULT)


@pytest.fixture(scope="module")
def straight(cached_run):
    """The run that no fault meets, on some ranks; one row longer than those that do."""
    return lambda ranks: cached_run(f"{SCENE} -time_end 0.12", ranks)


def meets(fault: str, name: str, folder: Path, end: float, ranks: int) -> None:
    """A run for which the file of this name cannot be closed: the line, status 1, nothing left in memory."""
    options = f"{SCENE} -time_end {end} -output_dir {folder} -malloc_debug -malloc_dump -objects_dump"
    done = mpirun([PETVES, *options.split()], ranks, 60, LD_PRELOAD=fault, PETVES_FAULT=name)
    file = folder / name.removesuffix(".tmp")
    said = f"petves: error: {file}: cannot be written; allowed: a folder with space that can be written"
    assert done.returncode == 1 and without_mpirun(done.stderr) == [said], done.stderr
    assert "never freed" not in done.stdout and " bytes " not in done.stdout, done.stdout


@pytest.mark.parametrize("name, ranks", [("series.csv", 1), ("series.csv", 3), ("run.xmf", 1), ("run.xmf", 3)])
def test_close_that_fails_at_the_end(name, ranks, fault, straight, tmp_path):
    """When all has been written: a checkpoint is left from which the run goes on as if nothing had been."""
    folder = tmp_path / "run"
    meets(fault, name, folder, 0.1, ranks)
    assert json.loads((folder / "summary.json").read_text())["reason"] == "finished"
    run_petves(folder, f"{SCENE} -time_end 0.12 -restart {folder}/checkpoint.h5", ranks)
    assert without_wall(folder) == without_wall(straight(ranks).folder)


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("name", ["series.csv", "resolved.opts", "run.xmf", "summary.json"])
def test_close_that_fails_on_the_way(name, ranks, fault, tmp_path):
    """Of a file that is written under a temporary name, before the first step or after the last one."""
    meets(fault, f"{name}.tmp", tmp_path / "run", 0.04, ranks)


#: No file may grow on rank 0 any more when a row is to be written: every rank has the same error, once.
FULL = """
import os, resource, signal, sys
import petves
from petsc4py import PETSc
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
sim = {simulation}
sim.step({steps})
if PETSc.COMM_WORLD.getRank() == 0:
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))
said = []
for _ in range(2):
    try:
        {call}
        sim.close()
    except petves.Error as error:
        said.append(str(error))
resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
assert len(said) == {times}, said
assert all("cannot be written" in line for line in said), said
"""


@pytest.mark.skipif(SANITIZE, reason="Python is not built with the sanitizers")
@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize(
    "call, times, steps",
    [("pass", 1, 3), ("sim._ended or sim.step(); sim._ended = True", 1, 2), ("sim.step()", 2, 3)],
    ids=["end", "destroy", "step"],
)
def test_disk_that_is_full_from_python(call, times, steps, ranks, tmp_path):
    """At the end, as the file is closed to which a row could not be written, and in a step; calls after it return.
    The checkpoint before it is good."""
    options = f"{SCENE} -time_end 0.2 -output_every {0.08 if times == 2 else 10} -checkpoint_every 2"
    folder = tmp_path / "run"
    made = simulation(options, output_dir=folder)
    done = run_python(FULL.format(simulation=made, call=call, times=times, steps=steps), ranks=ranks)
    assert not without_mpirun(done.stderr), done.stdout + done.stderr
    assert attribute(folder / "checkpoint.h5") == 2
    again = run_petves(tmp_path / "again", f"{SCENE} -time_end 0.08 -restart {folder}/checkpoint.h5", ranks)
    assert again.series["step"].tolist() == [2, 3, 4]


#: After each frame: bytes that the process has handed to the system and taken from it, and run.xmf as it is then.
COUNT = """
import json, os, sys
import petves
def counts():
    lines = dict(line.split(": ") for line in open("/proc/self/io").read().splitlines())
    return int(lines["wchar"]), int(lines["rchar"])
sim = {simulation}
found = []
for _ in range({frames}):
    before = counts()
    sim.step()
    after = counts()
    with open(sim.folder / "run.xmf", "rb") as file:
        found.append((after[0] - before[0], after[1] - before[1], os.fstat(file.fileno()).st_ino, file.read().decode()))
json.dump(found, open({out!r}, "w"))
sim.close()
"""


@pytest.mark.skipif(SANITIZE, reason="Python is not built with the sanitizers")
def test_a_frame_costs_the_same_at_any_time(tmp_path):
    """The bytes written and read for a frame do not grow with the frames before it; run.xmf is one file that grows, what
    was there stays, and it is a whole document after each frame."""
    frames, out = 300, str(tmp_path / "counts.json")
    options = f"{PAPER} {SCENE} -domain_cells 16,16 -vesicle_semi_axes 0.4,0.4 -time_step 1e-3 -output_every 1e-3"
    call = simulation(f"{options} -time_end 10 -checkpoint_every 0 -vesicle_spacing 1.75", output_dir=tmp_path / "run")
    run_python(COUNT.format(simulation=call, frames=frames, out=out))
    written, read, inodes, texts = zip(*json.loads(Path(out).read_text()))
    early, late = slice(100, 160), slice(240, 300)  # HDF5's trees of frames get their second level before frame 100
    assert np.mean(written[late]) < 1.05 * np.mean(written[early]), (written[early], written[late])
    assert np.mean(read[late]) < 1.1 * np.mean(read[early]) + 100, (read[early], read[late])
    assert len(set(inodes)) == 1
    for k, text in [*enumerate(texts)][::20]:
        names = [grid.get("Name").split()[1] for grid in ET.fromstring(text).findall("Domain/Grid/Grid")]
        assert names == [str(n) for n in range(k + 2)]
    head, foot = texts[0].index("<Xdmf"), texts[0][texts[0].rindex("</Grid>") :]
    for one, two in zip(texts, texts[1:]):
        end = one.rindex("</Grid>")
        assert one[head:end] == two[head:end] and two.endswith(foot)
        assert 0 < len(two) - len(one) < 2 * (len(texts[1]) - len(texts[0]))


def times_of(folder: Path) -> tuple[list[float], list[float]]:
    """Times of run.xmf, and of run.h5."""
    root = ET.parse(folder / "run.xmf").getroot()
    for item in root.iter("DataItem"):
        if item.get("Format") == "HDF":
            with h5py.File(folder / "run.h5") as file:
                shape = file[item.text.split(":")[1]].shape
            assert shape == tuple(int(n) for n in item.get("Dimensions").split())
    with h5py.File(folder / "run.h5") as file:
        return [float(item.get("Value")) for item in root.iter("Time")], file["time"][:].tolist()


def test_run_xmf_after_a_restart(straight, tmp_path):
    """A last frame goes when the restarted run passes its time, and so do frames past the checkpoint and what a killed run left
    half written; the rest is as the run had been one."""
    folder = tmp_path / "run"
    run_petves(folder, f"{SCENE} -time_end 0.06")
    assert times_of(folder)[0] == pytest.approx([0, 0.04, 0.06])
    text = (folder / "run.xmf").read_text()
    (folder / "run.xmf").write_text(text[: text.rindex("</Attribute>")])  # killed in the middle of a write
    run_petves(folder, f"{SCENE} -time_end 0.12 -restart {folder}/checkpoint.h5")
    ours, theirs = times_of(folder)
    assert ours == theirs == pytest.approx([0, 0.04, 0.08, 0.12])
    assert (folder / "run.xmf").read_text() == (straight(1).folder / "run.xmf").read_text()


@pytest.mark.skipif(SANITIZE, reason="Python is not built with the sanitizers")
def test_run_xmf_when_a_run_goes_on_after_its_end(straight, tmp_path):
    """From Python: the last frame of run.xmf is written over, also by a shorter text."""
    call = simulation(f"{SCENE} -time_end 0.06", output_dir=tmp_path / "run")
    run_python(f"import petves\nsim = {call}\nsim.run()\nsim.run(until=0.12)\nsim.close()\n")
    ours, theirs = times_of(tmp_path / "run")
    assert ours == theirs == pytest.approx([0, 0.04, 0.08, 0.12])
    assert (tmp_path / "run" / "run.xmf").read_text() == (straight(1).folder / "run.xmf").read_text()
