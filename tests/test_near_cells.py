"""Velocity and pressure in cells next to a membrane: the jump over a circle at rest, and a coarse grid against a fine one."""

import h5py
import numpy as np
import pytest
from conftest import run_petves

EXACT = "-scheme_type coupled -membrane_derivative spectral -delta_type cbs54 -coupling_near_field exact -scheme_order 2"
EXACT += " -scheme_area_target true -fluid_inertia none -vesicle_allow_close_markers -coupled_ksp_rtol 1e-10"


def fields(folder, options, ranks=1):
    """Last frame: u, v, p, markers and tension."""
    run_petves(folder, f"{EXACT} {options}", ranks)
    names = ("fluid/u", "fluid/v", "fluid/p", "vesicle/markers", "vesicle/tension")
    with h5py.File(folder / "run.h5") as file:
        return [file[name][-1] for name in names]


def centers(low, high, cells):
    """Cell centres as complex numbers, by rows."""
    x = low + (np.arange(cells) + 0.5) * (high - low) / cells
    return x[None, :] + 1j * x[:, None]


@pytest.mark.parametrize("inertia", ["none", "unsteady"])
@pytest.mark.parametrize("cells", [32, 48])
def test_jump_over_a_circle(cells, inertia, tmp_path):
    """Pressure is constant on both sides, in every cell; its jump is that of tension and bending, to 1 percent."""
    place = "-domain_box -1.5,1.5,-1.5,1.5 -vesicle_semi_axes .5,.5 -vesicle_center .013,-.021 -vesicle_bending .01"
    steps = f"-time_step .01 -time_end .03 -domain_cells {cells},{cells} -fluid_inertia {inertia}"
    *_, p, _, tension = fields(tmp_path / "out", f"{place} {steps}")
    inside = np.abs(centers(-1.5, 1.5, cells) - (0.013 - 0.021j)) < 0.5
    jump = tension.mean() / 0.5 + 0.01 / 0.5**3
    assert np.ptp(p[inside]) < 0.01 * abs(jump) and np.ptp(p[~inside]) < 0.01 * abs(jump)
    assert p[inside].mean() - p[~inside].mean() == pytest.approx(jump, rel=0.01)


@pytest.mark.parametrize("bc, ranks", [("wall", 1), ("periodic", 2)])
def test_coarse_grid_against_fine_one(bc, ranks, tmp_path):
    """V = .7 in shear, 48^2 cells and three times as many, whose every third is at the same place. Within 4 cells the
    smoothed pressure is 40 percent of its range off; now p is right to .2 percent of it and u to .2 percent of rate R0,
    as in the rest of the box. In the periodic box the vesicle lies across a corner."""
    scene = f"-domain_box -2,2,-2,2 -flow_type shear -vesicle_area 1 -vesicle_angle 20 -domain_bc_x {bc} -domain_bc_y {bc}"
    scene += f" -vesicle_markers 45 -time_step .01 -time_end .1 -vesicle_center {'0,0' if bc == 'wall' else '1.9,-1.8'}"
    coarse = fields(tmp_path / "coarse", f"{scene} -domain_cells 48,48", ranks)
    fine = fields(tmp_path / "fine", f"{scene} -domain_cells 144,144")
    u, v, p = (a - b[1::3, 1::3] for a, b in zip(coarse[:3], fine[:3]))
    assert np.abs(p - p.mean()).max() < 2.5e-3 * np.ptp(fine[2])
    assert np.hypot(u, v).max() < 5e-3 * 0.674
