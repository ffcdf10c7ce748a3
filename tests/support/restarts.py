"""What the tests of restarts share: scenes, and what of two runs must be the same."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from harness import attribute, run_petves

BASE = "-domain_cells 32,32 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.02 -output_every 0.05"
TWO = "-domain_box -1.5,1.5,-1.5,1.5 -domain_cells 48,48 -vesicle_semi_axes 0.2,0.4"
TWO += " -vesicle_count 2 -vesicle_center -0.5,0.2,0.5,-0.2"
SCHEMES = {
    "split": f"{BASE} -scheme_type split",
    "penalty": f"{BASE} -scheme_type penalty",
    "order_1": f"{BASE} -scheme_order 1",
    "order_2": f"{BASE}",
    "order_3": f"{BASE} -scheme_order 3",  # unsteady: with the velocity of three states
    "stiff": f"{BASE} -vesicle_bending 100",  # edges are corrected after its steps
    "adaptive": f"{BASE} -scheme_order 3 -time_adapt error -time_adapt_tol 1e-3",
    "two_vesicles": f"{BASE} {TWO}",
    "total_form": f"{BASE} -flow_form total -scheme_type split",
}
N = 8  # steps to the checkpoint; twice as many in all


def without_wall(folder: Path) -> list[str]:
    """Lines of a run's series.csv, its names first, the column wall left out."""
    rows = [line.split(",") for line in (folder / "series.csv").read_text().splitlines()]
    wall = rows[0].index("wall")
    return [",".join(row[:wall] + row[wall + 1 :]) for row in rows]


def frames(folder: Path, name: str = "run.h5") -> dict[str, np.ndarray]:
    """Every dataset of run.h5, or of another file."""
    found = {}
    with h5py.File(folder / name) as file:
        file.visititems(lambda name, item: found.update({name: item[:]}) if isinstance(item, h5py.Dataset) else None)
    return found


def same_frames(one: Path, two: Path, within: float = 0) -> None:
    """Two run.h5 have the same datasets."""
    ours, theirs = frames(one), frames(two)
    assert ours.keys() == theirs.keys()
    for name in theirs:
        assert ours[name].dtype == theirs[name].dtype, name
        np.testing.assert_allclose(ours[name], theirs[name], rtol=0, atol=within, err_msg=name)


def same_columns(one: dict, two: dict, within: float = 0, without=("wall",)) -> None:
    """Two runs' columns are the same but for those left out."""
    assert one.keys() == two.keys()
    for name in one.keys() - without:
        np.testing.assert_allclose(two[name], one[name], rtol=0, atol=within, err_msg=name)


def last_state(folder) -> dict[str, np.ndarray]:
    """Markers, their velocity, tension and the fluid of a run's checkpoint."""
    with h5py.File(folder / "checkpoint.h5") as file:
        return {name: file[name][:] for name in (*STATE, "fluid/p")}


STATE = ("vesicle/markers", "vesicle/velocity", "vesicle/tension", "fluid/u", "fluid/v")


def same_state(one, two, tolerance, names=STATE):
    for name in names:
        assert one[name].shape == two[name].shape and np.isfinite(one[name]).all()
        assert np.abs(two[name] - one[name]).max() <= tolerance, f"{name}: {np.abs(two[name] - one[name]).max():.1e}"


def at_step(folder: Path, step: int) -> str:
    """The name of the checkpoint of a step."""
    for path in folder.glob("checkpoint*.h5"):
        if attribute(path) == step:
            return path.name
    raise AssertionError(f"no checkpoint of step {step} in {folder}")


def agree(folder: Path, options: str, half: float, end: float, names, ranks=(3,), exact=None, **near) -> dict:
    """Columns of other numbers of ranks are near, those of a run that goes on from `half` have the same bits (`exact`, or the
    same columns). Returns the runs "whole", of the ranks, "half" and "rest"."""
    found = {}

    def run(name, until, n=1, more=""):
        found[name] = run_petves(folder / str(name), f"{options} -time_end {until:g} {more}", n)
        return found[name].series

    whole = run("whole", end)
    for n in ranks:
        other = run(n, end, n)
        for name in names:
            assert other[name] == pytest.approx(whole[name], **{"rel": 1e-9, "nan_ok": True, **near}), (name, n)
    run("half", half)
    rest = run("rest", end, 1, f"-restart {folder / 'half' / 'checkpoint.h5'}")
    for name in exact or names:
        np.testing.assert_array_equal(rest[name], whole[name][-len(rest[name]) :], err_msg=name)
    return found
