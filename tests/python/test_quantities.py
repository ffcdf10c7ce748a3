"""Quantities of saved fields against flows known in closed form, and fields that are read when they are used."""

import tracemalloc

import h5py
import numpy as np
import pytest
from harness import run_petves

import petves
from petves.quantities import line, probe, stream_function, total_pressure, vorticity, wall_shear_stress
from petves.rheology import mean_square_displacement

xarray = pytest.importorskip("xarray")
pytestmark = pytest.mark.xdist_group("quantities")  # its tests share runs

CHANNEL = "-domain_box 0,2,0,1 -domain_cells 64,32 -domain_bc_x periodic -flow_type poiseuille -flow_half_width 0.5"
CHANNEL += " -flow_center_y 0.5 -flow_peak_velocity 3 -fluid_viscosity 2 -fluid_inertia none -time_step 0.01"
CHANNEL += " -time_end 0.02"


@pytest.fixture(scope="module")
def channel(cached_run):
    """Poiseuille flow without a vesicle: u = 3 (1 - 4 (y - 1/2)^2), nu = 2."""
    return petves.load(cached_run(CHANNEL + " -vesicle_shape none").folder, "xarray")


def test_channel_has_its_closed_forms(channel):
    y = channel["y"]
    for data in (channel, channel.isel(time=-1)):  # several times, and one
        omega, psi, walls = vorticity(data), stream_function(data), wall_shear_stress(data)
        assert omega.dims == data["u"].dims and omega.attrs["units"] == "1/time" and omega.name == "vorticity"
        assert float(abs(omega - 24 * (y - 0.5)).max()) < 1e-11
        flux = 3 * (y - 4 * (y - 0.5) ** 3 / 3)
        assert float(abs(psi - (flux - flux[0])).max()) < 1.2 * 24 / 12 * float(y[1] - y[0]) ** 2, "second order"
        assert set(walls) == {"bottom", "top"} and walls["top"].dims[-1:] == ("x",)
        assert all(float(abs(walls[side] - 2 * 12).max()) < 1e-10 for side in walls), "the fluid drags both along x"
        drop = total_pressure(data).isel(x=0) - total_pressure(data).isel(x=-1)
        assert float(abs(drop - 48 * (2 - 1 / 32)).max()) < 1e-10, "2 nu u_max/H^2 is 48"


def test_probes_are_bilinear_and_wrapped(channel):
    found = probe(channel, [(0.3, 0.5), (2.3, 0.5), (-1.7, 0.0)])
    assert found["u"].dims == ("time", "point") and float(found["x"][1]) == 2.3
    h = 1 / 32
    np.testing.assert_allclose(found["u"][-1], [3 * (1 - h**2)] * 2 + [9 * h**2], atol=1e-12)
    np.testing.assert_allclose(found["p"][-1], [48 * 0.7, -48 * 1.3, 48 * 2.7], atol=1e-9)
    along = line(channel.isel(time=-1), (0.5, 0), (0.5, 1), 65)
    assert along["u"].dims == ("point",) and float(along["distance"][-1]) == 1
    assert float(abs(along["u"] - 12 * along["y"] * (1 - along["y"])).max()) <= 3.001 * 3 * h**2
    with pytest.raises(petves.Error, match="outside of the box; allowed: y from 0 to 1"):
        probe(channel, [(0.5, 1.1)])


def test_pressure_falls_through_a_throat(cached_run):
    """The pressure that pictures show falls from one end of the period to the other by the column pressure_drop."""
    throat = "-obstacle_shape constriction -obstacle_throat 0.5 -obstacle_length 1 -obstacle_center 1,0"
    throat += " -flow_drive flux"
    run = petves.load(cached_run(f"{CHANNEL} -vesicle_shape none {throat}").folder, "numpy")
    data = petves.load(run.folder, "xarray")
    drop = run.series["pressure_drop"][-1]
    assert run.pressure_gradient[-1] == -drop / 2 and float(data["pressure_gradient"][-1]) == -drop / 2
    ends = probe(data.isel(time=-1), [(0.0, 0.5), (2.0, 0.5)])["p"].values
    assert ends[0] - ends[1] == pytest.approx(drop, rel=1e-12) and drop > 2 * 48


@pytest.mark.parametrize("drive", ["pressure", "flux"])
def test_walls_hold_what_the_pressure_gradient_drives(cached_run, drive):
    """Past a vesicle, at every saved time: the shear stresses of both walls add up to -dp/dx H; more is needed for the flux of the
    channel without it."""
    vesicle = "-vesicle_area 0.15 -vesicle_reduced_area 0.7 -vesicle_center 1,0.3 -vesicle_bending 0.1"
    vesicle += " -output_every 0.01"
    data = petves.load(cached_run(f"{CHANNEL} {vesicle} -flow_drive {drive}").folder, "xarray")
    walls = wall_shear_stress(data).mean("x")
    np.testing.assert_allclose(walls["bottom"] + walls["top"], -data["pressure_gradient"], rtol=2e-4)
    more = -data["pressure_gradient"] / 48 - 1
    assert (more > 0.004).all() if drive == "flux" else (abs(more) < 1e-12).all()


def test_fields_are_read_when_they_are_used(tmp_path):
    """A run of 200 frames and 79 MB: loaded, and one frame of it used, within the memory of a few frames."""
    run = run_petves(tmp_path / "run", "-domain_cells 128,128 -time_step 0.01 -time_end 0.02 -output_every 0.01")
    path = run.folder / "run.h5"
    frame = 8 * 128**2
    with h5py.File(path, "a") as file:
        grown = [x for x in (*file["fluid"].values(), *file["vesicle"].values(), file["time"]) if x.chunks]
        for dataset in grown:
            values = dataset[-1]
            dataset.resize(200, axis=0)
            dataset[:] = values
        file["time"][:] = np.arange(200) * 0.01
    tracemalloc.start()
    data = petves.load(run.folder, "xarray")
    assert data["u"].shape == (200, 128, 128) and "lazy" not in data["u"].attrs
    speed = float(np.hypot(data["u"].isel(time=-1), data["v"].isel(time=-1)).max())
    omega = vorticity(data.isel(time=[3, 150]))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 30 * frame, f"{peak / frame:.1f} frames of one field in memory, of 600"
    assert omega.shape == (2, 128, 128) and speed > 0
    with h5py.File(path) as file:
        u = file["fluid/u"][:]
    for part in ((-1,), (slice(5, None, 7), 3), (slice(None, None, -50), slice(2, 9)), ([4, 2], slice(None), 1)):
        np.testing.assert_array_equal(data["u"][part].values, u[part])


def test_rows_that_are_not_there_yet_are_nan(tmp_path):
    from petves.lazy import FileArray, lazy_array

    with h5py.File(tmp_path / "some.h5", "w") as file:
        file["x"] = np.arange(6.0).reshape(3, 2)
    values = xarray.Variable(("step", "member"), lazy_array(tmp_path / "some.h5", "x", 5))
    np.testing.assert_array_equal(values.values, [[0, 1], [2, 3], [4, 5], [np.nan] * 2, [np.nan] * 2])
    np.testing.assert_array_equal(values[4].values, [np.nan] * 2)
    np.testing.assert_array_equal(values[::-2, 1].values, [np.nan, 5, 1])
    assert FileArray(tmp_path / "some.h5", "x", 5).shape == (5, 2)


def test_displacements_need_even_times(cached_run):
    """Their lags are differences of saved times."""
    options = "-domain_cells 24,24 -time_step 0.01 -time_end 0.03 -output_every 0.01"
    run = petves.load(cached_run(options).folder, "numpy")
    assert len(mean_square_displacement(run)[0]) == 4
    run.time[2] += 0.002
    with pytest.raises(petves.Error, match="saved times are not even, 0.008 to 0.012 apart"):
        mean_square_displacement(run)
