"""Many vesicles, whose dense problems are those of a few shapes (docs/suspensions.md, Many vesicles): iterations, ranks, restart."""

import numpy as np
import pytest
from conftest import read_series, run_petves

pytestmark = pytest.mark.xdist_group("patterns")  # its tests share a run

#: 7 vesicles at 30 % of a channel, in shear: 315 markers, more than one dense block takes.
SCENE = (
    "-scheme_type coupled -delta_type cbs54 -membrane_derivative spectral -coupling_near_field exact -scheme_area_target true"
    " -domain_box 0,6.4,0,3.2 -domain_cells 96,48 -domain_bc_x periodic -flow_type shear -fluid_inertia none -vesicle_count 7"
    " -vesicle_semi_axes 0.35,0.8 -vesicle_markers 45 -vesicle_bending 0.2 -vesicle_angle 70,60,65,60,70,75,65"
    " -vesicle_center 0.9,0.8,2.4,0.8,4.0,0.8,5.6,0.8,1.6,2.4,3.2,2.4,4.9,2.4 -time_step 0.05 -output_every 2"
)


@pytest.fixture(scope="module")
def straight(tmp_path_factory):
    return run_petves(tmp_path_factory.mktemp("patterns") / "run", f"{SCENE} -time_end 0.2").folder


def columns(folder):
    return {name: np.array(column) for name, column in read_series(folder / "series.csv").items() if name != "wall"}


def test_iterations(straight):
    """Few: the coarse grid knows what vesicles and walls do to one another. Blocks of each vesicle alone take 8.3 here."""
    its = columns(straight)["coupled_its"]
    assert its[2:].mean() <= 7


def test_viscosity_contrast(tmp_path):
    """Mixed ratios: vesicles know one another's double layer. Without it steps 2 to 4 take 8, 9 and 8 iterations."""
    ratios = "-time_end 0.2 -vesicle_viscosity_ratio .2,10,.2,10,.2,10,.2"
    one, three = (columns(run_petves(tmp_path / str(n), f"{SCENE} {ratios}", ranks=n).folder) for n in (1, 3))
    assert one["coupled_its"][2:].mean() <= 7.5
    np.testing.assert_array_equal(three["coupled_its"], one["coupled_its"])
    np.testing.assert_allclose(three["inclination"], one["inclination"], rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize("ranks", [3, 5])
def test_ranks(straight, tmp_path, ranks):
    """The same to rounding. The 16 rows of the coarse grid are shared by 3 ranks; of 5 each has all of them."""
    here = columns(straight)
    there = columns(run_petves(tmp_path / "run", f"{SCENE} -time_end 0.2", ranks=ranks).folder)
    for name in ("center_x", "center_y", "inclination", "energy_bending"):
        np.testing.assert_allclose(there[name], here[name], rtol=1e-10, atol=1e-11)
    np.testing.assert_array_equal(there["coupled_its"], here["coupled_its"])


def test_restart(straight, tmp_path):
    """The patterns are found again: the same bits."""
    folder = tmp_path / "run"
    run_petves(folder, f"{SCENE} -time_end 0.1")
    run_petves(folder, f"{SCENE} -time_end 0.2 -restart {folder}/checkpoint.h5")
    here, there = columns(straight), columns(folder)
    for name in here:
        np.testing.assert_array_equal(there[name], here[name], err_msg=name)
