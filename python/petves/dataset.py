"""Reading a run's folder with units: into xarray, or into NumPy arrays."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from petves.run import Run, RunError, RunFolder, SurfaceRun

if TYPE_CHECKING:
    import xarray

#: Units of what a run has, in the user's lengths and times; "1" is a number, "" not a physical quantity.
_HAVE = {
    "1": "stretch volume_error spectrum_tail viscosity_wall viscosity step area_error length_error edge_ratio tension_its bending_its coupled_its nsolve",
    "s": "wall",
    "time": "time dt step_time",
    "length": "gap length axis_short axis_middle axis_long center_x center_y center_z points coefficients area_shift markers tracers obstacles obstacle_center_x obstacle_center_y x y h",
    "length^2": "area",
    "length^3": "volume",
    "length/time": "u v velocity normal_speed velocity_x velocity_y velocity_z obstacle_velocity_x obstacle_velocity_y",
    "length^2/time": "nu flux stream_function",
    "length^2/time^2": "p normal_stress_wall normal_stress pressure_drop wall_shear_stress",
    "length^3/time^2": "tension tension_min tension_max obstacle_force obstacle_force_x obstacle_force_y",
    "length^4/time^2": "energy_kinetic energy_bending energy_gravity energy_contact energy_stretching energy_potential obstacle_torque",
    "length^5/time^2": "c_b",
    "1/time": "rotation_z div_max surface_div_max vorticity obstacle_rotation",
    "length/time^2": "pressure_gradient",
    "radian": "inclination elevation obstacle_angle",
    "radian/time": "frequency",
}
UNITS = {name: unit for unit, names in _HAVE.items() for name in names.split()}


def unit(name: str, run: RunFolder | None = None) -> str:
    """Return the unit of a column or field of a run; columns of single vesicles (``area_1``) have their column's."""
    is_energy = isinstance(run, SurfaceRun) and name.startswith("energy_")
    return "length^5/time^2" if is_energy else UNITS.get(re.sub(r"^each_|_\d+$", "", name), "")


def load(folder: str | Path, kind: str = "auto") -> Run | SurfaceRun | xarray.Dataset:
    """Read a run's folder.

    Parameters
    ----------
    folder : str or Path
        The run's ``-output_dir``; the run may still be going on, or have been killed: whole rows and frames are read.
    kind : str
        "xarray"; "numpy", a `petves.Run`; or "auto", xarray where it is installed.

    Returns
    -------
    xarray.Dataset or Run
        Dataset: variables of the steps (dimension step) are the columns of series.csv, with the coordinate step_time;
        variables of the saved times (dimension time) are u, v, p (time, y, x), markers and
        velocity (time, marker, xy), tension and stretch (time, marker), with the coordinate vesicle of each marker, 1 for the first, and tracers (time, tracer, xy);
        obstacles (obstacle_marker, xy), where they move (time, obstacle_marker, xy), and obstacle_force (time,
        obstacle_marker, xy), where there are any, with the coordinate obstacle. p is without the mean gradient along x,
        which is pressure_gradient (time): `petves.quantities.total_pressure` has both. Above 40 vesicles each_area, ...
        (step, member) are those of vesicles.h5. Every variable has ``attrs["units"]``; the dataset's attributes are h,
        nu, c_b, box, periodic and walls ("x", "y", "xy" or ""), folder and reason. u, v, p and each_area, ... are read from
        their files when they are used, a frame at a time where a frame is asked for; ``.chunk(time=1)`` makes dask's
        arrays of them. Run: see there, and `unit`. Of a run in three dimensions: points, velocity (time, vesicle, point,
        xyz), tension (time, vesicle, point), coefficients (time, vesicle, xyz, harmonic), triangles (triangle, corner),
        or a `petves.run.SurfaceRun`.

    Raises
    ------
    RunError
        When the folder or one of its files is missing or broken, or has no row or saved time yet.
    """
    if kind not in ("auto", "xarray", "numpy"):
        raise RunError(f"kind {kind}: unknown; allowed: auto, xarray, numpy")
    run = Run.read(folder)
    if kind == "numpy":
        return run
    try:
        import xarray
    except ImportError:
        if kind == "auto":
            return run
        raise RunError("xarray is not installed; install python3-xarray, or use kind='numpy'") from None
    values, coordinates, attributes = _plane(run) if isinstance(run, Run) else _space(run)
    columns = {name: ("step", column) for name, column in run.series.items() if name not in ("step", "time")}
    coordinates["step"], coordinates["step_time"] = run.series["step"].astype(int), ("step", run.series["time"])
    attributes |= {"folder": str(run.folder), "nu": run.nu, "reason": run.summary.get("reason", "")}
    data = xarray.Dataset(columns | values, coordinates | {"time": run.time}, attributes)
    for name, variable in data.variables.items():
        variable.attrs["units"] = unit(name, run)
    return data


def _plane(run: Run) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    """Return variables, coordinates and attributes that the dataset of a run in the plane has besides its series."""
    from petves.lazy import lazy_array

    frames, steps, member = len(run.time), len(run.series["step"]), np.arange(1, run.vesicles + 1)
    at_marker, at_obstacle = ("time", "marker"), ("time", "obstacle_marker", "xy")
    values: dict[str, Any] = {
        "pressure_gradient": ("time", run.pressure_gradient),
        "markers": ((*at_marker, "xy"), run.markers),
        "velocity": ((*at_marker, "xy"), run.velocity),
        "tension": (at_marker, run.tension),
        "stretch": (at_marker, run.stretch),
    }
    for name in "uvp":
        values[name] = ("time", "y", "x"), lazy_array(run.folder / "run.h5", f"fluid/{name}", frames)
    x, y = run.cell_centers()
    coordinates = {"x": x, "y": y, "xy": ["x", "y"], "vesicle": ("marker", np.repeat(member, np.diff(run.start)))}
    for name in run.columns_of_each():
        values[f"each_{name}"] = ("step", "member"), lazy_array(run.folder / "vesicles.h5", name, steps)
        coordinates["member"] = member
    if run.tracers.size:
        values["tracers"] = ("time", "tracer", "xy"), run.tracers
    if run.obstacles:
        moving = len(run.obstacle_markers) > 0
        places = run.obstacle_markers if moving else np.concatenate(run.obstacles)
        values["obstacles"] = at_obstacle[not moving :], places
        values["obstacle_force"] = at_obstacle, run.obstacle_force
        sizes = [len(points) for points in run.obstacles]
        coordinates["obstacle"] = ("obstacle_marker", np.repeat(np.arange(1, len(sizes) + 1), sizes))
    periodic = "".join(name for name, period in zip("xy", run.periods) if period)
    attributes = {"h": run.h, "c_b": run.c_b, "box": run.box, "periodic": periodic, "walls": run.walls}
    return values, coordinates, attributes


def _space(run: SurfaceRun) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    """Return variables, coordinates and attributes that the dataset of a run in three dimensions has besides its series."""
    at_point = ("time", "vesicle", "point")
    values = {
        "points": ((*at_point, "xyz"), run.points),
        "velocity": ((*at_point, "xyz"), run.velocity),
        "tension": (at_point, run.tension),
        "coefficients": (("time", "vesicle", "xyz", "harmonic"), run.coefficients),
        "triangles": (("triangle", "corner"), run.triangles),
    }
    return values, {"xyz": ["x", "y", "z"], "vesicle": np.arange(1, run.vesicles + 1)}, {"degree": run.degree}
