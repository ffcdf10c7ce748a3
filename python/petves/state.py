"""The state of a simulation as arrays and as PETSc objects."""

import ctypes
from pathlib import Path

import numpy as np

from petves.errors import Error
from petves.library import Handle, Int, PETSc, one_thread, wrap
from petves.measures import Measures

KSP_NAMES = ("coupled", "tension", "bending")
DM_NAMES = {"velocity": "dm_velocity", "u": "dm_u", "v": "dm_v", "pressure": "dm_pressure"}


class State(Measures):
    """What a simulation holds after the last step: options in force, arrays, PETSc objects and measures."""

    _dim: int
    _start: np.ndarray
    _sizes: list[int]
    _in_force: dict[str, str]
    _gathered: dict[str, np.ndarray]

    def __repr__(self) -> str:
        """Return the scene in a line: vesicles, flow, grid, time, folder."""
        if not getattr(self, "_in_force", None):
            return "<petves.Simulation>"
        o, count = self._in_force, self.vesicles
        said = {"quiescent": "fluid at rest", "custom": "a flow of the caller's", "formula": "a flow by formulas"}
        flow = said.get(o["flow_type"], o["flow_type"])
        cells, sides = (
            f"{o['domain_cells']} cells".replace(",", " x "),
            f"{o['domain_bc_x']} in x, {o['domain_bc_y']} in y",
        )
        if self._dim == 3:
            cells, sides = "three dimensions", f"degree {o['sphere_degree']}"
        vesicles = f"{count or 'no'} vesicle{'s' * (count != 1)}"
        time = "closed" if not self._handle else f"t = {self.time:.4g} of {float(o['time_end']):.4g}"
        return f"<petves.Simulation: {vesicles} in {flow}, {cells}, {sides}, {time}, {self.folder}>"

    def __setattr__(self, name: str, value: object) -> None:
        """Set an attribute of the package's own; others are refused, as they would change nothing."""
        if not name.startswith("_"):
            raise AttributeError(f"{name}: a simulation has no attribute to set; options are given when it is made")
        object.__setattr__(self, name, value)

    @property
    def folder(self) -> Path:
        """The run's output folder."""
        return Path(self._in_force["output_dir"])

    @property
    def options(self) -> dict[str, str]:
        """Every option of the program in force, as text, without the dash."""
        return dict(self._in_force)

    @property
    def warnings(self) -> list[str]:
        """What the run has warned of so far, also with ``quiet``."""
        text, found = ctypes.c_char_p(), []
        while not self._lib.SimulationGetWarning(self._open(), len(found), ctypes.byref(text)) and text.value:
            found.append(text.value.decode(errors="replace"))
        return found

    @property
    def vesicles(self) -> int:
        """Number of vesicles."""
        return len(self._start) - 1

    @property
    def start(self) -> np.ndarray:
        """First marker of each vesicle, then the number of markers M; shape (vesicles + 1,)."""
        return self._start

    @property
    def markers(self) -> np.ndarray:
        """Markers of all vesicles (length), shape (M, 2), the same on every rank; in three dimensions points of the surfaces,
        as run.h5 has them, shape (M, 3).

        A read-only view without copy: after the next step it has other values, so copy what is to be kept. So are the
        other arrays.
        """
        return self._gathered["markers"].reshape(-1, self._dim)

    @property
    def marker_velocity(self) -> np.ndarray:
        """Velocity of the markers, background included (length/time), of their shape, the same on every rank; a view."""
        return self._gathered["marker_velocity"].reshape(-1, self._dim)

    @property
    def tension(self) -> np.ndarray:
        """Tension (length^3/time^2), shape (M,), entry k at marker k; a view. With another ``membrane_derivative`` than
        spectral, the default, it is on the edge from marker k-1 to marker k."""
        return self._gathered["tension"]

    @property
    def obstacles(self) -> list[np.ndarray]:
        """Markers of each obstacle (length), new arrays (n, 2), the same on every rank: counter-clockwise around a solid,
        clockwise around fluid in one; the solid is on the left of curves that end on a wall or span a period. Where they
        move, those of the present time."""
        count, ask = Int(), self._lib.SimulationGetObstacles
        ask(self._open(), ctypes.byref(count), None, None)
        start = (Int * (count.value + 1))()
        ask(self._open(), ctypes.byref(count), start, None)
        markers = np.empty((start[-1], 2))
        ask(self._open(), ctypes.byref(count), start, markers.ctypes)
        return np.split(markers, start[1:-1]) if count.value else []

    @property
    def pressure(self) -> np.ndarray:
        """The solved pressure of this rank's rows at cell centres (length^2/time^2), shape (rows, cells in x); a view.
        Collective.

        Of the disturbance unless ``flow_form`` is total. In unbounded fluid it is zero: nothing is solved for on the
        grid, and `cell_pressure` has it.
        """
        return self.vec("pressure").array_r.reshape(self._sizes[5:7])

    @property
    def velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """The solved velocity of this rank's faces (length/time): u on vertical faces, v on horizontal ones; views.
        Collective.

        u has shape (rows, cells in x), one column less with walls in x; v (rows, cells in x), one row less in all with
        walls in y. Entry (j, i) lies on the right (u) or top (v) face of cell (j, i). It is the disturbance of the
        background flow unless ``flow_form`` is total; `cell_velocity` has the whole. In unbounded fluid it is zero: nothing
        is solved for on the grid, and `cell_velocity` has the flow.
        """
        values, (_, rows, columns, *_) = self.vec("velocity").array_r, self._sizes
        cut = rows * columns
        return values[:cut].reshape(rows, columns), values[cut:].reshape(self._sizes[3:5])

    def cell_velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the velocity, background included, at this rank's cell centres: u and v, new arrays (rows, cells in
        x). Collective."""
        u, v = (np.empty(self._sizes[5:7]) for _ in range(2))
        self._call("SimulationGetCellVelocity", self._open(), u.ctypes, v.ctypes)
        return u, v

    def cell_pressure(self) -> np.ndarray:
        """Return the pressure at this rank's cell centres, as run.h5 has it: a new array (rows, cells in x). In unbounded
        fluid it is zero far away. Collective."""
        p = np.empty(self._sizes[5:7])
        self._call("SimulationGetCellPressure", self._open(), p.ctypes)
        return p

    def cell_centers(self) -> tuple[np.ndarray, np.ndarray]:
        """Return x, shape (cells in x,), and y, shape (rows,), of this rank's cell centres."""
        box = [float(x) for x in self._in_force["domain_box"].split(",")]
        first, rows, columns = self._sizes[0], *self._sizes[5:7]
        h = (box[1] - box[0]) / columns
        return box[0] + h * (0.5 + np.arange(columns)), box[2] + h * (0.5 + first + np.arange(rows))

    def vec(self, name: str) -> PETSc.Vec:
        """Return the state's vector `name`: velocity, pressure (by rows over the ranks), markers, marker_velocity, tension (by
        vesicles over the ranks). After the next step ask again: the vectors change places."""
        return self._object("Vec", name, name)

    def dm(self, name: str) -> PETSc.DM:
        """Return the grid's DM `name`: velocity (a DMComposite of u and v), u, v, pressure (DMDAs)."""
        return self._object("DM", name, DM_NAMES.get(name, ""))

    def mat(self, name: str) -> PETSc.Mat:
        """Return the operator `name` of docs/method.md: G, D, L, H on the grid; E, S, B between grid and markers (as shells)."""
        return self._object("Mat", name, f"mat_{name}")

    def pc(self, name: str) -> PETSc.PC:
        """Return the fast solver `name`: helmholtz, the inverse of H, or poisson, of L."""
        return self._object("PC", name, f"pc_{name}")

    @property
    def ksp(self) -> dict[str, PETSc.KSP]:
        """The scheme's solvers by name: coupled, or tension and bending. They may be configured."""
        handles = {name: self._find(f"{name}_") for name in KSP_NAMES}
        return {name: wrap("KSP", handle) for name, handle in handles.items() if handle}

    def _find(self, name: str) -> int | None:
        found = Handle()
        with one_thread:
            self._lib.SimulationGetObject(self._open(), name.encode(), ctypes.byref(found))
        return found.value

    def _object(self, kind: str, asked: str, name: str) -> PETSc.Object:
        handle = self._find(name)
        if not handle:
            raise Error(f"{kind} {asked}: this simulation has none of that name")
        return wrap(kind, handle)
