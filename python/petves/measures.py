"""The measures of a simulation's present state, as attributes: the columns of series.csv; and what follows from them."""

import ctypes
import difflib

import numpy as np

from petves.errors import Error

ENERGIES = ("bending", "kinetic", "gravity", "contact", "stretching", "potential")  # of the columns energy_NAME
ENERGY_COLUMNS = [f"energy_{name}" for name in ENERGIES]


def turned_angle(inclination: np.ndarray) -> np.ndarray:
    """Return how far a vesicle has turned (radians): the column inclination of series.csv without its jumps by pi.

    Between two steps a vesicle may turn by less than pi/2.
    """
    return np.unwrap(2 * np.asarray(inclination)) / 2


def deformation(markers: np.ndarray) -> np.ndarray:
    """Return Taylor's deformation (a - b)/(a + b) of closed curves, shape (..., n, 2); shape (...).

    a and b are the semi-axes of the ellipse with the curve's second moments of area.
    """
    z = markers[..., 0] + 1j * markers[..., 1]
    wave = 1j * np.fft.fftfreq(z.shape[-1], 1 / z.shape[-1])
    swept = (np.conj(z) * np.fft.ifft(wave * np.fft.fft(z))).imag  # twice the area
    z = z - 2 / 3 * np.sum(z * swept, -1, keepdims=True) / np.sum(swept, -1, keepdims=True)
    swept = (np.conj(z) * np.fft.ifft(wave * np.fft.fft(z))).imag
    sum_, difference = np.sum(abs(z) ** 2 * swept, -1), abs(np.sum(z**2 * swept, -1))
    axes = np.sqrt((sum_ - difference) / (sum_ + difference))
    return (1 - axes) / (1 + axes)


def half_periods(time: np.ndarray, inclination: np.ndarray) -> np.ndarray:
    """Return the times between passes of a tumbling vesicle's long axis through the vertical; empty for fewer than two.

    `time` and `inclination` are columns of series.csv. Each pass is found by a cubic through two steps before and two after it.
    """
    time, angle = np.asarray(time), turned_angle(inclination)
    half = np.floor(angle / np.pi - 0.5)
    passes = []
    for k in np.flatnonzero(np.diff(half)):
        near = slice(max(k - 1, 0), k + 3)
        vertical = np.pi * (max(half[k], half[k + 1]) + 0.5)
        fit = np.polyfit(angle[near] - vertical, time[near] - time[k], len(time[near]) - 1)
        passes.append(time[k] + fit[-1])
    return np.diff(passes)


class Measures:
    """Measures after the last step; with several vesicles totals, worst values or means, and `each` for one by one.

    Every column of series.csv is an attribute, such as

    Attributes
    ----------
    time, dt : float
        Time reached, and the last time step (the next one before the first).
    energy_kinetic, energy_bending, energy_gravity, energy_contact : float
        Energies (length^4/time^2): of the velocity minus the background; of bending; minus density difference times gravity
        times area times centroid; of repulsion and adhesion between membranes.
    area, length, edge_ratio : float
        Enclosed area (length^2), length of the membrane (length), longest over shortest edge.
    area_error, length_error : float
        Area and length over the initial ones, minus 1.
    inclination, frequency : float
        Angle of the long axis (radians in (-pi/2, pi/2]) and tank-treading frequency (radians/time) of the first vesicle;
        the frequency is NaN unless the membrane turns in one sense.
    normal_speed : float
        Largest |u.n| on a membrane (length/time): the speed of its outline.
    gap : float
        Least distance of two vesicles, or of one and a wall (length); NaN where there is none.
    viscosity, normal_stress : float
        Effective viscosity over nu and first normal stress difference (length^2/time^2) of a sheared channel, by the
        membranes' forces; NaN in other scenes.
    div_max, surface_div_max : float
        What the solver left of the velocity's divergence and of the membrane's inextensibility (1/time).
    """

    _row: ctypes.Array[ctypes.c_double]  # the last
    _rows: list[bytes]
    _columns: dict[str, int]

    def __getattr__(self, name: str) -> float:
        """Return a column of series.csv after the last step, as an attribute of its name."""
        if name.startswith("_") or name not in self._columns:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return self._row[self._columns[name]]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *getattr(self, "_columns", ())]

    def measure(self, name: str) -> float:
        """Return the column `name` of series.csv after the last step; `Error` names all that there are when it is none."""
        return self._row[self._place(name)]

    def _place(self, name: str) -> int:
        if name not in self._columns:
            near = difflib.get_close_matches(name, self._columns, 1)
            meant = f"{near[0]} is meant? " if near else ""
            raise Error(f"{name}: no such column; {meant}allowed: {', '.join(self._columns)}")
        return self._columns[name]

    def each(self, name: str) -> np.ndarray:
        """Return the column `name` of the single vesicles, shape (vesicles,); errors as of `measure`."""
        column = self._place(name)
        rows = np.empty((self.vesicles, len(self._columns)))
        for vesicle, row in enumerate(rows):
            self._lib.SimulationGetRow(self._open(), vesicle, row.ctypes)
        return rows[:, column]

    @property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of series.csv of this simulation's steps, step 0 first; an empty entry is NaN."""
        table = np.frombuffer(b"".join(self._rows)).reshape(len(self._rows), -1).copy()
        return {name: table[:, k] for name, k in self._columns.items()}

    @property
    def steps(self) -> int:
        """Steps taken."""
        return int(self.measure("step"))

    @property
    def energy(self) -> float:
        """Energy of all kinds (length^4/time^2): kinetic, bending, gravity, contact, stretching, potential."""
        return sum(self._row[self._columns[name]] for name in ENERGY_COLUMNS if name in self._columns)

    @property
    def reduced_area(self) -> float:
        """V = area/(pi R0^2), R0 = length/(2 pi), of the first vesicle."""
        return 4 * np.pi * self.each("area")[0] / self.each("length")[0] ** 2

    @property
    def center(self) -> np.ndarray:
        """Centroid of the enclosed area (length), shape (2,)."""
        return np.array([self.measure("center_x"), self.measure("center_y")])

    @property
    def center_velocity(self) -> np.ndarray:
        """Velocity of the centroid (length/time), shape (2,), the mean of several vesicles."""
        return np.array([self.measure("velocity_x"), self.measure("velocity_y")])

    @property
    def iterations(self) -> dict[str, int]:
        """Iterations of the last step's solves: coupled, tension, bending."""
        return {name: int(self.measure(f"{name}_its")) for name in ("coupled", "tension", "bending")}
