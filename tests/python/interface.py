"""Facts of petves.Simulation, on any number of ranks: state, measures, PETSc objects, creation and destruction."""

import gc
import sys
from pathlib import Path

import numpy as np
import petsc4py
import pytest

FOLDER, FACTS = Path(sys.argv[1]), sys.argv[2:]
DUMPED = [] if FACTS == ["memory"] else ["-malloc_dump"]  # these take time and memory of their own: the dump little,
CHECKED = ["-malloc_debug"] if "solvers" in FACTS else []  # writing beyond an array is looked for with each allocation
petsc4py.init(["interface", "-objects_dump", *DUMPED, *CHECKED])  # prints what is not freed at the end
from petsc4py import PETSc

import petves

SMALL = dict(domain_cells=(32, 32), vesicle_semi_axes=(0.35, 0.5), time_step=0.01, time_end=0.03, flow_type="shear")
RANKS, RANK = PETSc.COMM_WORLD.getSize(), PETSc.COMM_WORLD.getRank()


def refused(text, make):
    """The call raises petves.Error with this text, in one line."""
    with pytest.raises(petves.Error) as caught:
        make()
    assert text in str(caught.value) and "\n" not in str(caught.value), str(caught.value)


def state():
    """Arrays have the shapes documented, are views, and say the same as the Vecs and DMs."""
    with petves.Simulation(**SMALL) as sim:
        M = sim.start[-1]
        assert sim.vesicles == 1 and sim.markers.shape == (M, 2) == sim.marker_velocity.shape
        assert sim.tension.shape == (M,) and not sim.markers.flags.writeable
        assert np.shares_memory(sim.markers, sim.markers)
        assert np.shares_memory(sim.pressure, sim.vec("pressure").array_r)
        for name, form in (("pressure", (32, 32)), ("u", (31, 32)), ("v", (32, 31))):
            assert sim.dm(name).sizes == form, name
        u, v = sim.velocity
        assert u.shape[1] == 31 and v.shape[1] == 32 and u.size + v.size == sim.vec("velocity").getLocalSize()
        assert sim.vec("velocity").size == 2 * 31 * 32 and sim.dm("velocity").getType() == "composite"
        rows = sim.pressure.shape[0]
        x, y = sim.cell_centers()
        assert len(y) == rows and len(x) == 32 and np.isclose(x[0], -1 + 1 / 32)
        U, V = sim.cell_velocity()  # at rest, but for the background
        assert np.allclose(U, y[:, None]) and not V.any() and U.shape == sim.pressure.shape
        before = sim.markers.copy()
        sim.step()
        assert sim.steps == 1 and np.isclose(sim.time, 0.01) and not np.array_equal(sim.markers, before)
        Lp, p = sim.vec("pressure").duplicate(), sim.vec("pressure").copy()
        p.shift(-p.sum() / p.size)
        sim.mat("L").mult(p, Lp)
        back = Lp.duplicate()
        sim.pc("poisson").apply(Lp, back)
        assert (back - p).norm() <= 1e-10 * p.norm(), "the fast solver inverts L"
        refused("Mat Q", lambda: sim.mat("Q"))
        kept = sim.tension
    assert np.isfinite(kept).all(), "a view outlives its simulation"


def solids():
    """Curves of obstacles, as run.h5 has them: counter-clockwise around a solid, clockwise around fluid."""
    with petves.Simulation(**SMALL) as sim:
        assert sim.obstacles == []
    ring = dict(SMALL, flow_type="quiescent", vesicle_shape="none", domain_bc_x="periodic", domain_bc_y="periodic")
    ring |= dict(scheme_type="coupled", obstacle_shape="couette", obstacle_radius=(0.3, 0.8))
    ring.pop("vesicle_semi_axes", None)
    with petves.Simulation(**ring) as sim:
        for points, radius, turn in zip(sim.obstacles, (0.3, 0.8), (1, -1), strict=True):
            assert np.allclose(np.hypot(*points.T), radius)
            assert np.sign(np.cross(points[0], points[1])) == turn


def measures():
    """Properties are the series' columns; energies add up; of several vesicles each has its own."""
    two = dict(SMALL, vesicle_count=2, vesicle_center=(-0.45, 0.1, 0.45, -0.1), vesicle_semi_axes=(0.15, 0.3))
    with petves.Simulation(**two) as sim:
        sim.run()
        assert sim.energy == sim.energy_bending + sim.energy_kinetic
        assert np.isclose(sim.each("area").sum(), sim.area) and len(sim.each("inclination")) == 2
        assert sim.inclination == sim.each("inclination")[0] and np.allclose(sim.center, 0, atol=0.05)
        assert np.allclose(sim.history["time"], [0, 0.01, 0.02, 0.03]) and 0 < sim.reduced_area < 1
        assert sim.iterations["coupled"] > 0 and sim.options["vesicle_count"] == "2"


def running():
    """run stops at `until`, at the callback's wish, and at time_end; the files say so."""
    with petves.Simulation(output_dir=FOLDER / "running", **SMALL) as sim:
        seen = []
        assert sim.run(until=0.02, callback=lambda s: seen.append(s.time)) == "finished"
        assert np.allclose(seen, [0.01, 0.02])
        assert sim.run(callback=lambda s: True) == "callback" and sim.steps == 3
        assert not (FOLDER / "running/summary.json").exists() or RANKS > 1
        sim.run()
        assert sim.checkpoint() == FOLDER / "running/checkpoint.h5"
    with petves.Simulation(time_steady_tol=1e3, **SMALL) as sim:
        assert sim.run() == "steady" and sim.steps == 1
        temporary = sim.folder
        assert temporary.is_dir()
    with petves.Simulation(time_wall_limit=0.001, **SMALL) as sim:
        assert sim.run() == "stopped" and sim.steps == 0
    with petves.Simulation(time_wall_limit=1000, **SMALL) as sim:
        assert sim.run() == "finished"
    PETSc.COMM_WORLD.barrier()
    assert not temporary.exists(), "a temporary folder goes with its simulation"
    refused("closed", sim.step)


def restarting():
    """Half a run and its restart have the bits of a straight run; measures and series go on; another scene is refused."""
    flow = lambda x, y, t: (np.cos(t) * y, 0 * x)
    scene = {**SMALL, "time_step": 0.005, "flow_type": None, "flow": flow}
    with petves.Simulation(output_dir=FOLDER / "straight", **scene) as straight:
        straight.run()
        markers, tension, series = straight.markers.copy(), straight.tension.copy(), straight.history
    with petves.Simulation(output_dir=FOLDER / "halves", **{**scene, "time_end": 0.015}) as half:
        half.run()
        half.step()  # past the checkpoint
        checkpoint = FOLDER / "halves/checkpoint_1.h5"
        half.checkpoint()
    with petves.Simulation.restart(checkpoint, time_end=0.03, flow=flow) as again:
        assert again.steps == 3 and again.inclination == series["inclination"][3] == again.each("inclination")[0]
        again.run()
        assert np.array_equal(again.markers, markers) and np.array_equal(again.tension, tension)
        for name, values in again.history.items():
            assert name == "wall" or np.array_equal(values, series[name][3:], equal_nan=True), name
    PETSc.COMM_WORLD.barrier()
    rows = [(FOLDER / name / "series.csv").read_text().splitlines() for name in ("straight", "halves")]
    assert [row.split(",")[:20] for row in rows[0]] == [row.split(",")[:20] for row in rows[1]]
    for name in ("straight", "halves"):
        assert len(petves.Run.read(FOLDER / name).time) == 2
    other = lambda: petves.Simulation.restart(checkpoint, domain_cells=(48, 48), flow=flow)
    refused("-domain_cells 48,48: the checkpoint", other)
    refused("output_overwrite", lambda: petves.Simulation(output_dir=FOLDER / "straight", **SMALL))
    file = FOLDER / "straight/resolved.opts"  # has -vesicle_semi_axes, which a keyword's alternative replaces
    with petves.Simulation(file, flow_type="shear", vesicle_area=1, output_dir=FOLDER / "area") as sim:
        assert abs(sim.area - 1) < 1e-9
    refused("given together", lambda: petves.Simulation(vesicle_area=1, **SMALL))


def solvers():
    """The KSPs may be configured, and what they are told holds."""
    with petves.Simulation(**SMALL) as sim, petves.Simulation(coupled_ksp_rtol=1e-11, **SMALL) as sharp:
        assert list(sim.ksp) == ["coupled"]
        residuals = []
        sim.ksp["coupled"].setTolerances(rtol=1e-11)
        sim.ksp["coupled"].setMonitor(lambda ksp, its, norm: residuals.append(norm))
        sim.run(), sharp.run()
        assert len(residuals) > 3 and np.array_equal(sim.markers, sharp.markers)
    with petves.Simulation(scheme_type="split", tension_ksp_type="bcgs", **SMALL) as sim:
        assert set(sim.ksp) == {"tension", "bending"} and sim.ksp["tension"].getType() == "bcgs"


def several():
    """Several simulations exist at the same time, each with its own options, and give the same bits as alone."""
    with petves.Simulation(**SMALL) as alone:
        alone.run()
        expected = alone.markers.copy()
    a, b = petves.Simulation(**SMALL), petves.Simulation(fluid_viscosity=2, **SMALL)
    for _ in range(3):
        b.step()
        a.step()
    assert np.array_equal(a.markers, expected) and not np.array_equal(b.markers, expected)
    assert b.options["fluid_viscosity"] == "2" and a.options["fluid_viscosity"] == "1"
    if RANK == 0:
        with petves.Simulation(comm=PETSc.COMM_SELF, **SMALL) as own:
            own.run()
            assert np.allclose(own.markers, expected, rtol=0, atol=1e-7)  # other rank count: to the solver's tolerance
    a.close(), b.close()
    a.close()


def mistakes():
    """Every mistake is a petves.Error with the program's line; a monitor's exception comes through."""
    bad = [
        ("-flow_rat 1: no such option; -flow_rate is meant?", dict(flow_rat=1)),
        ("square cells", dict(domain_cells=(32, 33))),
        ("-coupled_ksp_type foo: Unable to find", dict(coupled_ksp_type="foo")),
        ("beyond the wall x_max", dict(vesicle_center=(0.9, 0))),
        ("-output_dir /proc/no: cannot be made", dict(output_dir="/proc/no")),
        ("-flow_type custom: no function given", dict(flow_type="custom")),
        ("-time_step 0: out of range", dict(time_step=0)),
        ("-vesicle_file /none: cannot be opened", dict(vesicle_shape="file", vesicle_file="/none")),
    ]
    for text, options in bad:
        refused(text, lambda: petves.Simulation(**{**SMALL, **options}))
    refused("-options_file /none: cannot be opened", lambda: petves.Simulation("/none"))
    with petves.Simulation(time_adapt="error", time_adapt_tol=1e-14, **SMALL) as sim:
        refused("the last good state is in", lambda: sim.run(until=1))
        assert sim.time < 1
    with petves.Simulation(coupled_ksp_max_it=1, **SMALL) as sim:
        refused("the solve with prefix coupled_ failed in step", sim.run)
        assert sim.steps == 0 and np.isfinite(sim.markers).all()
    with petves.Simulation(**SMALL) as sim:

        def stumble(ksp, its, norm):
            raise ZeroDivisionError("monitor")

        sim.ksp["coupled"].setMonitor(stumble)
        with pytest.raises(ZeroDivisionError, match="^monitor$"):
            sim.step()


def quiet():
    """Nothing is printed that was not asked for, and warnings are kept; columns that there are not are named."""
    scene = {**SMALL, "flow_rate": 5, "time_step": 0.1, "time_end": 0.2}
    with petves.Simulation(**scene) as sim:
        sim.run()
        assert any("-time_step" in text for text in sim.warnings), sim.warnings
        meant = "inclinaton: no such column; inclination is meant? allowed: step, time, dt,"
        refused(meant, lambda: sim.measure("inclinaton"))
        refused("foo: no such column; allowed: step, time, dt,", lambda: sim.each("foo"))


def memory():
    """Making, running and freeing 50 simulations of four kinds takes no memory that is not given back."""
    small, start = {**SMALL, "domain_cells": (16, 16)}, dict(scheme_startup="euler")
    free = dict(start, domain_bc_x="free", domain_bc_y="free")
    kinds = [start, dict(scheme_type="split"), dict(scheme_type="penalty"), free]

    def once(kind):
        with petves.Simulation(**small, **kind) as sim:
            sim.step()
            solvers = sim.ksp  # outlive their simulation: petsc4py keeps them until a later one is closed
            for ksp in solvers.values():
                ksp.setMonitor(lambda ksp, its, norm: None)
            return sim.markers[0, 0]

    def resident():
        gc.collect()
        return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

    def many(count):
        for k in range(count):
            once(kinds[k % 4])
        return resident()

    before, after = many(8), many(50)
    assert after - before < 2e6, f"{after - before} bytes in 50 runs"  # a simulation has about 1e6


for fact in FACTS:
    globals()[fact]()
    gc.collect()
if RANK == 0:
    print("facts hold")
