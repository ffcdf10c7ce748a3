"""Facts of a background flow given as a Python function."""

import sys

import numpy as np
import pytest
from petsc4py import PETSc

import petves

SMALL = dict(domain_cells=(32, 32), vesicle_semi_axes=(0.35, 0.5), time_step=0.02, time_end=0.1)


def same_as_built_in():
    """u_inf = (y, 0) gives the bits of -flow_type shear, fields included."""
    with petves.Simulation(flow=lambda x, y, t: (y, 0 * y), **SMALL) as own:
        with petves.Simulation(flow_type="shear", **SMALL) as shear:
            own.run(), shear.run()
            assert np.array_equal(own.markers, shear.markers)
            assert np.array_equal(own.tension, shear.tension)
            assert all(np.array_equal(a, b) for a, b in zip(own.cell_velocity(), shear.cell_velocity()))
            assert own.options["flow_type"] == "custom"


def drift(dt, **options):
    """Error of the centre carried by u_inf = (0.3 cos(3t), 0) up to t = 0.48: it should be 0.1 sin(3t)."""
    flow = lambda x, y, t: (0.3 * np.cos(3 * t), 0)
    with petves.Simulation(flow=flow, **{**SMALL, **options, "time_step": dt}) as sim:
        sim.run(until=0.48)
        return abs(sim.center[0] - 0.1 * np.sin(3 * sim.time))


def right_time():
    """The flow is asked at the times of the scheme: the error in time has the scheme's order."""
    second = [drift(dt, scheme_startup="graded") for dt in (0.08, 0.04)]
    assert 3.2 < second[0] / second[1] < 4.8, second
    first = [drift(dt, scheme_order=1) for dt in (0.08, 0.04)]
    assert 1.7 < first[0] / first[1] < 2.3, first
    split = [drift(dt, scheme_type="split") for dt in (0.08, 0.04)]
    assert 1.7 < split[0] / split[1] < 2.3, split


def failures():
    """An exception in the flow comes through; a value that is not finite is an error; so is using the simulation."""

    def stumble(x, y, t):
        if t > 0.03:
            raise KeyError("flow")
        return 0, 0

    with petves.Simulation(flow=stumble, **SMALL) as sim, pytest.raises(KeyError, match="^'flow'$"):
        sim.run()
    with pytest.raises(petves.Error, match=r"-flow_type custom: u_inf is \(nan\., 0\.\) at"):
        petves.Simulation(flow=lambda x, y, t: (np.nan, 0), **SMALL)
    with pytest.raises(petves.Error, match="-flow_type custom: u_inf has the divergence 3 at"):
        petves.Simulation(flow=lambda x, y, t: (2 * x, y), **SMALL)
    swirl = lambda x, y, t: (np.sin(9 * x) * np.cos(9 * y) + 50, -np.cos(9 * x) * np.sin(9 * y))
    petves.Simulation(flow=swirl, **SMALL).close()
    held = []

    def inside(x, y, t):
        if held:
            held[0].step()
        return 0, 0

    with petves.Simulation(flow=inside, **SMALL) as sim:
        held.append(sim)
        with pytest.raises(petves.Error, match="inside its own step"):
            sim.step()
        held.clear()


for fact in sys.argv[1:]:
    globals()[fact]()
if PETSc.COMM_WORLD.getRank() == 0:
    print("facts hold")
