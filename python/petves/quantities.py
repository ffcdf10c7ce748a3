"""Quantities that follow from saved fields: vorticity, stream function, shear stress on walls, values at points.

The functions take what `petves.load` returns, of all saved times or of some, such as ``data.isel(time=-1)``, and return
xarray's arrays with units. The functions of arrays behind them have names that end in ``_of``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from petves.dataset import unit
from petves.errors import RunError

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike

SIDES = {"bottom": ("u", "y", 0), "top": ("u", "y", -1), "left": ("v", "x", 0), "right": ("v", "x", -1)}
"""Of each side: the velocity along it, the direction across it, and its cell."""


def vorticity_of(u: np.ndarray, v: np.ndarray, h: float, periodic: Sequence[bool]) -> np.ndarray:
    """Return dv/dx - du/dy by central differences, one-sided ones at walls; `periodic` says whether x and y are."""
    slopes = []
    for values, axis, wrapped in ((v, -1, periodic[0]), (u, -2, periodic[1])):
        around = (np.roll(values, -1, axis) - np.roll(values, 1, axis)) / (2 * h)
        slopes.append(around if wrapped else np.gradient(values, h, axis=axis, edge_order=2))
    return slopes[0] - slopes[1]


def stream_function_of(u: np.ndarray, v: np.ndarray, h: float) -> np.ndarray:
    """Return the stream function, shape (..., ny, nx), zero in the first cell, by the trapezoidal rule along x and y."""
    across = np.zeros_like(u)
    across[..., 1:, :] = np.cumsum(0.5 * h * (u[..., 1:, :] + u[..., :-1, :]), axis=-2)
    along = np.zeros_like(v[..., 0, :])
    along[..., 1:] = np.cumsum(0.5 * h * (v[..., 0, 1:] + v[..., 0, :-1]), axis=-1)
    return across - along[..., None, :]


def interpolate_of(
    values: np.ndarray, points: np.ndarray, box: np.ndarray, h: float, periodic: Sequence[bool]
) -> np.ndarray:
    """Return bilinear values at points (n, 2), shape (..., n): wrapped where the box is periodic, continued to its walls."""
    cells = []
    for d in range(2):
        n, place = values.shape[-1 - d], (points[:, d] - box[2 * d]) / h - 0.5
        if not periodic[d] and not np.all((place >= -0.5 - 1e-9) & (place <= n - 0.5 + 1e-9)):
            raise RunError(f"a point lies outside of the box; allowed: {'xy'[d]} from {box[2*d]:g} to {box[2*d+1]:g}")
        low = np.floor(place).astype(int) if periodic[d] else np.clip(np.floor(place).astype(int), 0, n - 2)
        cells.append((low % n, (low + 1) % n, place - low))
    (i, i1, x), (j, j1, y) = cells
    below = (1 - x) * values[..., j, i] + x * values[..., j, i1]
    above = (1 - x) * values[..., j1, i] + x * values[..., j1, i1]
    return (1 - y) * below + y * above


def vorticity(data: xarray.Dataset) -> xarray.DataArray:
    """Return the vorticity dv/dx - du/dy of the data at cell centres (1/time), dimensions (time, y, x)."""
    periodic = [name in data.attrs["periodic"] for name in "xy"]
    make = lambda one: vorticity_of(one["u"].values, one["v"].values, data.attrs["h"], periodic)
    return _array(data, "vorticity", make, ("y", "x"))


def stream_function(data: xarray.Dataset) -> xarray.DataArray:
    """Return psi of the data, u = d psi/dy and v = -d psi/dx (length^2/time), zero in the first cell, (time, y, x)."""
    make = lambda one: stream_function_of(one["u"].values, one["v"].values, data.attrs["h"])
    return _array(data, "stream_function", make, ("y", "x"))


def wall_shear_stress(data: xarray.Dataset) -> xarray.Dataset:
    """Return the shear stress of the data on each wall of the box (length^2/time^2, for a density of 1).

    It is nu times the derivative of the velocity along the wall by the distance from it: bottom and top, dimensions
    (time, x), and left and right, (time, y), where they are walls. The parabola through the values f_0, f_1, f_2 of the
    next cells, at h/2, 3 h/2 and 5 h/2, has the slope (-2 f_0 + 3 f_1 - f_2)/h at the wall.
    """
    import xarray

    sides, h, nu = {}, data.attrs["h"], data.attrs["nu"]
    for side, (name, across, cell) in SIDES.items():
        if across in data.attrs["walls"]:
            near = [data[name].isel({across: cell - k if cell else k}, drop=True) for k in range(3)]
            stress = nu * (-2 * near[0] + 3 * near[1] - near[2]) / h
            sides[side] = stress.assign_attrs(units=unit("wall_shear_stress"))
    return xarray.Dataset(sides)


def total_pressure(data: xarray.Dataset) -> xarray.DataArray:
    """Return p of the data with its mean gradient along x (length^2/time^2), which p itself is without."""
    total = data["p"] + data["pressure_gradient"] * (data["x"] - data["x"].mean())
    return total.transpose(*data["p"].dims).rename("total_pressure").assign_attrs(units=unit("p"))


def probe(data: xarray.Dataset, points: ArrayLike) -> xarray.Dataset:
    """Return u, v and the total pressure p at points, dimensions (time, point), with the coordinates x and y.

    Values are bilinear between cell centres.

    Parameters
    ----------
    data : xarray.Dataset
        What `petves.load` returns, or some times of it.
    points : array_like, shape (n, 2)
        Places in the box; along a periodic direction any.
    """
    import xarray

    places = np.reshape(np.asarray(points, float), (-1, 2))
    periodic = [name in data.attrs["periodic"] for name in "xy"]
    box, h = data.attrs["box"], data.attrs["h"]
    make = lambda name: lambda one: interpolate_of(one[name].values, places, box, h, periodic)
    found = {name: _array(data, name, make(name), ("point",)) for name in "uvp"}
    added = data["pressure_gradient"] * xarray.DataArray(places[:, 0] - np.mean(box[:2]), dims="point")
    found["p"] = (found["p"] + added).transpose(*found["p"].dims).assign_attrs(found["p"].attrs)
    places = {name: ("point", places[:, d], {"units": "length"}) for d, name in enumerate("xy")}
    return xarray.Dataset(found).assign_coords(places)


def line(data: xarray.Dataset, begin: ArrayLike, end: ArrayLike, count: int = 200) -> xarray.Dataset:
    """Return `probe` at evenly spaced points of a line, with the coordinate distance from its begin (length).

    Parameters
    ----------
    data : xarray.Dataset
        What `petves.load` returns, or some times of it.
    begin, end : array_like, shape (2,)
        Its ends.
    count : int
        How many points.
    """
    points = np.linspace(begin, end, count)
    distance = np.linalg.norm(points - points[0], axis=1)
    return probe(data, points).assign_coords(distance=("point", distance, {"units": "length"}))


def _array(
    data: xarray.Dataset, name: str, make: Callable[[xarray.Dataset], np.ndarray], dims: tuple[str, ...]
) -> xarray.DataArray:
    """Return what `make` makes of each time of the data, a frame in memory at a time, with its unit and coordinates."""
    import xarray

    one = "time" not in data["u"].dims
    values = make(data) if one else np.stack([make(data.isel(time=k)) for k in range(data.sizes["time"])])
    dims = dims if one else ("time", *dims)
    coordinates = {key: data[key] for key in ("time", *dims) if key in data.coords}
    return xarray.DataArray(values, coordinates, dims, name, {"units": unit(name)})
