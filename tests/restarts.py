"""What the tests of restarts share: scenes, and what of two runs must be the same."""

from pathlib import Path

import h5py
import numpy as np
from conftest import COLUMNS

BASE = "-domain_cells 32,32 -vesicle_semi_axes 0.3,0.5 -flow_type shear -time_step 0.02 -output_every 0.05"
DEFAULTS = "-delta_type cbs54 -membrane_derivative spectral -coupling_near_field exact -scheme_area_target true"
TWO = (
    "-domain_box -1.5,1.5,-1.5,1.5 -domain_cells 48,48 -vesicle_semi_axes 0.2,0.4 -vesicle_count 2 "
    "-vesicle_center -0.5,0.2,0.5,-0.2"
)
SCHEMES = {
    "split": f"{BASE} -scheme_type split",
    "penalty": f"{BASE} -scheme_type penalty",
    "order_1": f"{BASE} -scheme_type coupled -scheme_order 1",
    "order_2": f"{BASE} -scheme_type coupled {DEFAULTS}",
    "order_3": f"{BASE} -scheme_type coupled {DEFAULTS} -scheme_order 3",  # unsteady: with the velocity of three states
    "stiff": f"{BASE} -scheme_type coupled {DEFAULTS} -vesicle_bending 100",  # edges are corrected after its steps
    "adaptive": f"{BASE} -scheme_type coupled {DEFAULTS} -scheme_order 3 -time_adapt error -time_adapt_tol 1e-3",
    "two_vesicles": f"{BASE} {TWO} -scheme_type coupled {DEFAULTS}",
    "total_form": f"{BASE} -flow_form total -scheme_type coupled -scheme_order 1",
}
N = 8  # steps to the checkpoint; twice as many in all


def without_wall(path: Path, first: int = 0) -> list[str]:
    """Rows of a series.csv as text from a step on, the column wall left out."""
    rows = [line.split(",") for line in path.read_text().splitlines()[1:]]
    wall = COLUMNS.index("wall")
    return [",".join(row[:wall] + row[wall + 1 :]) for row in rows if int(row[0]) >= first]


def frames(folder: Path) -> dict[str, np.ndarray]:
    """Every dataset of run.h5."""
    found = {}
    with h5py.File(folder / "run.h5") as file:
        file.visititems(lambda name, item: found.update({name: item[:]}) if isinstance(item, h5py.Dataset) else None)
    return found


def one_line(run, *needles):
    """The run was refused with one line that holds every needle."""
    assert run.status == 1 and len(run.errors) == 1, "\n".join(run.errors)
    assert run.errors[0].startswith("petves: error: ")
    for needle in needles:
        assert needle in run.errors[0]
