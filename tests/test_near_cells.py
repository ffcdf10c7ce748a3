"""Velocity and pressure in cells next to a membrane: a coarse grid against a fine one (test_near_cells.c has the jump over
a circle)."""

import h5py
import numpy as np
import pytest
from conftest import run_petves

EXACT = (
    "-scheme_type coupled -membrane_derivative spectral -delta_type cbs54 -coupling_near_field exact -scheme_order 2"
)
EXACT += " -scheme_area_target true -fluid_inertia none -vesicle_allow_close_markers -coupled_ksp_rtol 1e-10"


def fields(folder, options, ranks=1):
    """Last frame: u, v, p, markers and tension."""
    run_petves(folder, f"{EXACT} {options}", ranks)
    names = ("fluid/u", "fluid/v", "fluid/p", "vesicle/markers", "vesicle/tension")
    with h5py.File(folder / "run.h5") as file:
        return [file[name][-1] for name in names]


@pytest.mark.parametrize("bc, ranks", [("wall", 1), ("periodic", 2)])
def test_coarse_grid_against_fine_one(bc, ranks, tmp_path):
    """V = .7 in shear, 48^2 cells and three times as many, whose every third is at the same place. Within 4 cells the
    smoothed pressure is 40 percent of its range off; now p is right to .2 percent of it and u to .2 percent of rate R0,
    as in the rest of the box. In the periodic box the vesicle lies across a corner."""
    scene = (
        f"-domain_box -2,2,-2,2 -flow_type shear -vesicle_area 1 -vesicle_angle 20 -domain_bc_x {bc} -domain_bc_y {bc}"
    )
    scene += f" -vesicle_markers 45 -time_step .01 -time_end .1 -vesicle_center {'0,0' if bc == 'wall' else '1.9,-1.8'}"
    coarse = fields(tmp_path / "coarse", f"{scene} -domain_cells 48,48", ranks)
    fine = fields(tmp_path / "fine", f"{scene} -domain_cells 144,144")
    u, v, p = (a - b[1::3, 1::3] for a, b in zip(coarse[:3], fine[:3]))
    assert np.abs(p - p.mean()).max() < 2.5e-3 * np.ptp(fine[2])
    assert np.hypot(u, v).max() < 5e-3 * 0.674
