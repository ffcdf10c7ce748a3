"""The measures of a simulation's present state, as properties: the columns of series.csv."""

from __future__ import annotations

import ctypes

import numpy as np


class Measures:
    """Measures after the last step; with several vesicles totals, worst values or means, and `each` for one by one."""

    _rows: list[tuple[float, ...]]
    _columns: dict[str, int]

    def measure(self, name: str) -> float:
        """Return the value of a column of series.csv after the last step."""
        return self._rows[-1][self._columns[name]]

    def each(self, name: str) -> np.ndarray:
        """Return a vesicle column's values of the single vesicles, shape (vesicles,)."""
        values, row = [], np.empty(len(self._columns))
        pointer = row.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        for vesicle in range(self.vesicles):
            self._lib.SimulationGetRow(self._open(), vesicle, pointer)
            values.append(row[self._columns[name]])
        return np.array(values)

    @property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of series.csv of this simulation's steps, step 0 first; an empty entry is NaN."""
        table = np.array(self._rows)
        return {name: table[:, k] for name, k in self._columns.items()}

    @property
    def steps(self) -> int:
        """Steps taken."""
        return int(self.measure("step"))

    @property
    def time(self) -> float:
        """Time reached."""
        return self.measure("time")

    @property
    def dt(self) -> float:
        """The last time step (the next one before the first)."""
        return self.measure("dt")

    @property
    def energy(self) -> float:
        """Kinetic and bending energy (length^4/time^2)."""
        return self.energy_kinetic + self.energy_bending

    @property
    def energy_kinetic(self) -> float:
        """Kinetic energy of the velocity minus the background (length^4/time^2)."""
        return self.measure("energy_kinetic")

    @property
    def energy_bending(self) -> float:
        """Bending energy (length^4/time^2)."""
        return self.measure("energy_bending")

    @property
    def area(self) -> float:
        """Enclosed area (length^2)."""
        return self.measure("area")

    @property
    def length(self) -> float:
        """Length of the membrane (length)."""
        return self.measure("length")

    @property
    def reduced_area(self) -> float:
        """V = area/(pi R0^2), R0 = length/(2 pi), of the first vesicle."""
        return 4 * np.pi * self.each("area")[0] / self.each("length")[0] ** 2

    @property
    def area_error(self) -> float:
        """Area over the initial one, minus 1."""
        return self.measure("area_error")

    @property
    def length_error(self) -> float:
        """Length over the initial one, minus 1."""
        return self.measure("length_error")

    @property
    def edge_ratio(self) -> float:
        """Longest over shortest edge."""
        return self.measure("edge_ratio")

    @property
    def center(self) -> np.ndarray:
        """Centroid of the enclosed area (length), shape (2,)."""
        return np.array([self.measure("center_x"), self.measure("center_y")])

    @property
    def inclination(self) -> float:
        """Angle of the long axis (radians in (-pi/2, pi/2]), of the first vesicle."""
        return self.measure("inclination")

    @property
    def frequency(self) -> float:
        """Tank-treading frequency (radians/time) of the first vesicle; NaN unless the membrane turns in one sense."""
        return self.measure("frequency")

    @property
    def div_max(self) -> float:
        """What the solver left of the velocity's divergence (1/time)."""
        return self.measure("div_max")

    @property
    def surface_div_max(self) -> float:
        """What the solver left of the membrane's inextensibility (1/time)."""
        return self.measure("surface_div_max")

    @property
    def iterations(self) -> dict[str, int]:
        """Iterations of the last step's solves: coupled, tension, bending."""
        return {name: int(self.measure(f"{name}_its")) for name in ("coupled", "tension", "bending")}
