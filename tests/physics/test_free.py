"""Unbounded fluid: tank-treading of the boundary integral, any number of ranks, a restart, and the fields of the window."""

import numpy as np
import pytest
from boundary_integral import derivative
from harness import ROOT, run_petves
from petves.curves import trigonometric
from restarts import agree, frames

RATE = 0.326116
FREE = "-domain_bc_x free -domain_bc_y free -scheme_order 2 -output_overwrite"
THREE = f"{FREE} -domain_box -1,1,-1,1 -domain_cells 16,16 -flow_type shear -vesicle_count 3 -vesicle_markers 35"
THREE += " -vesicle_center -1.5,.2,0,0,2,-.3 -vesicle_area .5 -vesicle_reduced_area .7 -time_step .1"
THREE += " -vesicle_allow_close_markers -output_every .2"


def tank_treading(folder, options):
    """runs/free.opts, but for the options given."""
    return run_petves(folder, f"{FREE} -options_file {ROOT / 'runs' / 'free.opts'} -output_dir {folder} {options}")


def test_tank_treading_is_that_of_the_boundary_integral(tmp_path):
    """V = .7, chi = 10, to dt = 0: angle .122676 pi and frequency .319245 of the rate, both to 5e-5."""
    found = []
    for parts in (1, 2):
        dt = 0.05 / RATE / parts
        options = f"-time_step {dt!r} -time_end {14 / RATE!r} -output_every 99"
        series = tank_treading(tmp_path / str(parts), options).series
        assert not series["nsolve"].any() and not series["div_max"].any() and not series["energy_kinetic"].any()
        found.append(np.array([series["inclination"][-1] / np.pi, series["frequency"][-1] / RATE]))
    assert (4 * found[1] - found[0]) / 3 == pytest.approx([0.122676, 0.319245], rel=5e-5)


def test_ranks_and_restart(tmp_path):
    """Three vesicles, two outside of the window: the same on two ranks; a restart has the same bits."""
    agree(tmp_path, THREE, 0.5, 1, ("center_x_1", "inclination_2", "center_y_3", "frequency_3", "coupled_its"), (2,))


def fine(values, points):
    """Complex numbers round a curve, interpolated to more points."""
    return trigonometric(np.column_stack([values.real, values.imag]), points) @ [1, 1j]


def layer(X, F, z):
    """Velocity (nu = 1) and pressure at points z of forces F at points X, both complex."""
    u, p = np.zeros(len(z), complex), np.zeros(len(z))
    for k, at in enumerate(z):
        r = at - X
        along = (np.conj(F) * r).real / np.abs(r) ** 2
        u[k] = np.sum(r * along - np.log(np.abs(r)) * F) / (4 * np.pi)
        p[k] = along.sum() / (2 * np.pi)
    return u, p


def test_fields_are_those_of_the_layer(tmp_path):
    """Velocity and pressure at cells on both sides, some a hundredth of a cell from the membrane: against a sum of 40000
    points."""
    run = tank_treading(tmp_path / "out", "-domain_cells 32,32 -time_step .1 -time_end .3")
    last = {name: values[-1] for name, values in frames(run.folder).items()}
    u, v, p = (last[f"fluid/{name}"] for name in "uvp")
    X, tension = last["vesicle/markers"] @ [1, 1j], last["vesicle/tension"]
    n, D = len(X), derivative(len(X))
    ds = np.abs(D @ X).mean()
    F = D @ (D @ X / ds * tension) - 0.01 * ds**-3 * D @ D @ D @ D @ X
    x = -1 + (np.arange(32) + 0.5) / 16
    z = (x[None, :] + 1j * x[:, None]).ravel()
    velocity, pressure = layer(fine(X, 40000), fine(F, 40000) * n / 40000, z)
    assert np.ptp(p) > 1
    assert np.abs(pressure - p.ravel()).max() < 1e-4 * np.ptp(p)
    assert np.abs(velocity + RATE * z.imag - (u + 1j * v).ravel()).max() < 1e-4 * RATE
