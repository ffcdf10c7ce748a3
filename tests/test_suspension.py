"""Suspensions: packed vesicles, mixtures, and the files of many vesicles."""

import numpy as np
import pytest
from conftest import run_petves

from petves.run import Run as Files

METHOD = "-scheme_type coupled -coupling_near_field exact -delta_type cbs54 -membrane_derivative spectral -scheme_area_target true"
PACKED = (
    f"{METHOD} "
    "-domain_box 0,6,0,3 -domain_cells 96,48 -domain_bc_x periodic -fluid_inertia none -flow_type shear -vesicle_markers 24 "
    "-vesicle_packing .4 -time_step .05 -time_end 0 -vesicle_mixture .75,.25 -vesicle_area .3,.15 "
    "-vesicle_reduced_area .7,.9 -vesicle_bending .01,.04"
)


def test_packing_is_the_same_on_all_ranks(tmp_path):
    """Number, kinds and fraction are those asked for, on any number of ranks and when resolved.opts is fed back."""
    first = run_petves(tmp_path / "a", PACKED)
    run = Files.read(first.folder)
    count = run.vesicles
    small = [area < 0.2 for area in (run.series[f"area_{v + 1}"][0] for v in range(count))]
    assert count == round(0.4 * 18 / (0.75 * 0.3 + 0.25 * 0.15))
    assert sum(small) == pytest.approx(count / 4, abs=1)
    assert run.series["area"][0] / 18 == pytest.approx(0.4, abs=0.01)
    again = run_petves(tmp_path / "b", f"{METHOD} -options_file {first.folder}/resolved.opts", ranks=3)
    other = run_petves(tmp_path / "c", f"{PACKED} -vesicle_packing_seed 2")
    assert np.array_equal(Files.read(again.folder).markers, run.markers)
    assert np.abs(Files.read(other.folder).markers[0] - run.markers[0]).max() > 0.1


def test_number_and_fraction_give_the_area(tmp_path):
    """With -vesicle_count the area of the vesicles follows from the fraction."""
    run = run_petves(
        tmp_path, "-scheme_type coupled -vesicle_packing .3 -vesicle_count 5 -vesicle_reduced_area .8 -time_end 0"
    )
    assert run.series["area_3"][0] == pytest.approx(0.3 * 4 / 5, rel=1e-2)  # a polygon's


def test_bending_of_each(tmp_path):
    """Energies go by each vesicle's own c_b; a pair with its stiffnesses exchanged is the mirror image."""
    pair = (
        "-scheme_type coupled -fluid_inertia none -vesicle_count 2 -vesicle_semi_axes .2,.4 -vesicle_center -.5,0,.5,0 "
        "-time_step .1 -time_end .3 -vesicle_bending "
    )
    one, two = (run_petves(tmp_path / name, pair + c).series for name, c in (("a", ".01,.1"), ("b", ".1,.01")))
    assert one["energy_bending_2"][0] / one["energy_bending_1"][0] == pytest.approx(10, rel=1e-12)
    assert one["energy_bending_2"][-1] / one["energy_bending_1"][-1] < 9.97  # and so do the forces
    assert one["energy_bending_1"] == pytest.approx(two["energy_bending_2"], rel=1e-8)
    assert one["center_x_1"] == pytest.approx(-two["center_x_2"], abs=1e-9)
