"""Checkpoints whose checksum is right and whose contents are not: each is refused with one line, on every rank, before
anything is made of it."""

import shutil

import h5py
import numpy as np
import pytest
from harness import run_petves, run_scenes
from refusals import one_line, seal

pytestmark = pytest.mark.xdist_group("forged")  # its tests share a run

SCENE = "-domain_cells 16,16 -domain_box -2,2,-2,2 -vesicle_semi_axes 0.8,1 -flow_type shear -time_step 0.02 "


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return run_petves(tmp_path_factory.mktemp("good") / "run", f"{SCENE} -time_end 0.06").folder / "checkpoint.h5"


def attribute(name, value):
    """Give an attribute another value, of the value's own type."""
    return lambda file, place: (file.attrs.__delitem__(name), file.attrs.__setitem__(name, value))


def dataset(name, change):
    """Put changed values in a dataset's place, in whatever way `change` stores them."""

    def forge(file, place):
        values = file[name][:]
        del file[name]
        change(file, name, values, place)

    return forge


def plain(values):
    """Stored as petves does."""
    return {"data": values, "chunks": values.shape, "maxshape": (None, *values.shape[1:])}


def with_entry(value, at=5):
    def change(file, name, values, place):
        values.flat[at] = value
        file.create_dataset(name, **plain(values))

    return change


def replaced(name, edit, **how):
    """Put other values in a dataset's place, stored as petves does but for what `how` says."""
    return dataset(name, lambda file, name, values, place: file.create_dataset(name, **plain(edit(values)), **how))


def external_link(file, name, values, place):
    with h5py.File(place / "other.h5", "w") as other:
        other.create_dataset("u", **plain(values))
    file[name] = h5py.ExternalLink(str(place / "other.h5"), "u")


def soft_link(file, name, values, place):
    file.create_dataset("/elsewhere", **plain(values))
    file[name] = h5py.SoftLink("/elsewhere")


def external_storage(file, name, values, place):
    (place / "raw").write_bytes(values.tobytes())
    file.create_dataset(name, shape=values.shape, dtype="f8", external=[(str(place / "raw"), 0, values.nbytes)])


def virtual(file, name, values, place):
    with h5py.File(place / "other.h5", "w") as other:
        other["u"] = values
    layout = h5py.VirtualLayout(values.shape, dtype="f8")
    layout[:] = h5py.VirtualSource(str(place / "other.h5"), "u", values.shape)
    file.create_virtual_dataset(name, layout)


FORGED = {
    "time is not a number": (attribute("time", np.nan), "its time is nan"),
    "time is infinite": (attribute("time", np.inf), "its time is "),
    "time before the start": (attribute("time", -1.0), "its time is -1"),
    "time of another step": (attribute("time", 7.0), "row of series.csv"),
    "step before the start": (attribute("step", np.int32(-1)), "its step is -1"),
    "step that overflows": (attribute("step", np.int32(2**31 - 1)), "its step is 2.14748e+09"),
    "step of 64 bits": (attribute("step", np.int64(2**62)), "its step is 2.14748e+09"),
    "step of another row": (attribute("step", np.int32(2)), "row of series.csv"),
    "step size that is not a number": (attribute("dt", np.nan), "its dt is nan"),
    "no last step": (attribute("dt_last", 0.0), "a last step of 0"),
    "negative frames": (attribute("frames", np.int32(-5)), "its frames is -5"),
    "more frames than steps": (attribute("frames", np.int32(100)), "it has 100. frames"),
    "level": (attribute("step_level", np.int32(2**31 - 1)), "its step_level is"),
    "none of one to six states": (attribute("past", np.int32(7)), "its past is 7"),
    "no order": (attribute("step_order", np.int32(0)), "its step_order is 0"),
    "an order that there is not": (attribute("step_order", np.int32(4)), "its step_order is 4"),
    "a guess that there is not": (attribute("step_guess", np.int32(9)), "its step_guess is 9"),
    "earlier steps of no length": (attribute("dt_earlier", np.zeros(5)), "its dt_earlier is 0"),
    "step that is a text": (attribute("step", np.bytes_("three")), "entries are missing"),
    "two steps": (attribute("step", np.array([3, 3], np.int32)), "entries are missing"),
    "row of words": (attribute("series_row", np.bytes_("a,b")), "row of series.csv"),
    "row with a line break": (attribute("series_row", np.bytes_("3,0.06\n4,")), "row of series.csv"),
    "velocity that is not a number": (dataset("fluid/u", with_entry(np.nan)), "its velocity is up to"),
    "flow that is not a number": (dataset("fluid/flow", with_entry(np.nan)), "its flow is up to"),
    "earlier flow that is infinite": (dataset("previous/fluid/flow", with_entry(np.inf)), "its flow is up to"),
    "flow of fewer modes": (replaced("fluid/flow", lambda v: v[:, :, 1:]), "size or storage"),
    "markers far away": (dataset("vesicle/markers", with_entry(1e300)), "its markers is up to 1e+300"),
    "pressure that is infinite": (dataset("fluid/p", with_entry(np.inf)), "its pressure is up to"),
    "solver's memory": (dataset("solver", with_entry(np.nan)), "entries are missing"),
    "link to another file": (dataset("fluid/u", external_link), "links to other names or files"),
    "link to another name": (dataset("fluid/u", soft_link), "links to other names or files"),
    "values in another file": (dataset("fluid/u", external_storage), "size or storage"),
    "values of another dataset": (dataset("fluid/u", virtual), "size or storage"),
    "more rows": (replaced("fluid/u", lambda v: np.concatenate([v, v], 1)), "size or storage"),
    "more entries": (replaced("fluid/u", lambda v: np.concatenate([v, v])), "size or storage"),
    "fewer markers": (replaced("vesicle/markers", lambda v: v[:, 1:]), "size or storage"),
    "compressed": (replaced("fluid/u", lambda v: v, compression="gzip"), "size or storage"),
    "no velocity": (lambda file, place: file.__delitem__("fluid/u"), "entries are missing"),
    "a group": (dataset("fluid/u", lambda f, n, v, _: f.create_group(n)), "size or storage"),
}


def forge(good, place, change):
    """A copy with the change, and with the checksum of its bytes behind them."""
    path = place / "checkpoint.h5"
    shutil.copy(good, path)
    with h5py.File(path, "r+") as file:
        change(file, place)
    seal(path)
    return path


@pytest.mark.parametrize("name", list(FORGED)[::6])
def test_forged_checkpoints_are_refused(name, good, tmp_path):
    change, needle = FORGED[name]
    path = forge(good, tmp_path, change)
    run = run_petves(tmp_path / "new", f"{SCENE} -time_end 0.1 -restart {path}", 2, good=False, timeout=60)
    one_line(run, f"-restart {path}: ", needle, "allowed: ")
    assert not (tmp_path / "new").exists()


def test_every_forged_checkpoint_is_refused(good, tmp_path):
    """One after another in one process, which is none the worse for it: at last it takes a copy without a change."""
    forged = FORGED | {"copy": (replaced("fluid/u", lambda v: v), "")}
    paths = {}
    for number, name in enumerate(forged):
        (tmp_path / f"{number}").mkdir()
        paths[name] = forge(good, tmp_path / f"{number}", forged[name][0])
    scenes = {name: f"{SCENE} -time_end 0.1 -restart {path}" for name, path in paths.items()}
    *runs, copy = run_scenes(tmp_path / "new", scenes, good=False).values()
    for (name, (_, needle)), run in zip(FORGED.items(), runs, strict=True):
        one_line(run, f"-restart {paths[name]}: ", needle, "allowed: ")
        assert not run.folder.exists(), name
    assert copy.series["step"].tolist() == [3, 4, 5]


@pytest.mark.parametrize("state", ["", "previous_2/"])
def test_numbers_of_the_last_rank_are_finite(state, tmp_path):
    """A largest number over ranks may lose one rank's NaN."""
    scene = f"{SCENE} -fluid_inertia none -vesicle_semi_axes 0.4,0.5 -vesicle_count 3 -vesicle_center -1,-1,1,-1,0,1 "
    good = run_petves(tmp_path / "run", f"{scene} -time_end 0.06").folder / "checkpoint.h5"
    path = forge(good, tmp_path, dataset(f"{state}vesicle/markers", with_entry(np.nan, -3)))
    run = run_petves(tmp_path / "new", f"{scene} -time_end 0.1 -restart {path}", 3, good=False, timeout=60)
    one_line(run, f"-restart {path}: ", "its markers is up to nan", "allowed: ")


def test_a_memory_of_another_time_is_refused(tmp_path):
    """Moving obstacles were where the preconditioner's factor was made at a time that the checkpoint has."""
    scene = "-vesicle_shape none -domain_cells 16,16 -domain_bc_x periodic -domain_bc_y periodic -time_step 0.01"
    scene += " -obstacle_shape posts -obstacle_radius .5 -obstacle_moving -obstacle_velocity 1,0"
    good = run_petves(tmp_path / "run", f"{scene} -time_end 0.02").folder / "checkpoint.h5"

    def later(file, name, values, place):
        assert 0 < values.flat[-7] < 0.02, "the time is the first of the seven last numbers"
        values.flat[-7] = 1e6
        file.create_dataset(name, **plain(values))

    path = forge(good, tmp_path, dataset("solver", later))
    run = run_petves(tmp_path / "new", f"{scene} -time_end 0.03 -restart {path}", 2, good=False, timeout=60)
    one_line(run, f"-restart {path}: ", "its solver's memory is of time 1e+06; allowed: a checkpoint.h5 of petves")
