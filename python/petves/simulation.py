"""`Simulation`: petves driven from Python."""

from __future__ import annotations

import atexit
import ctypes
import gc
import os
import shutil
import sys
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

from petves.errors import Error
from petves.library import MAX_MESSAGE, MAX_PATH, PETSC_ERR_USER_INPUT, Flow, FlowFunction, Handle, Int, PETSc
from petves.library import communicator, flow_function, library, one_thread, option_text
from petves.progress import progress_bar
from petves.state import State

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from petves.options import Options

Callback = Callable[["Simulation"], Any]

GO_ON, STOP, FAILED = range(3)  # what a callback wants; the largest of all ranks' wishes counts

_alive: dict[int, weakref.ref] = {}  # in the order of creation, which is the same on every rank


class Simulation(State):
    """One simulation of vesicles in a viscous fluid.

    Options are the program's, without the dash: ``Simulation(domain_cells=(64, 64), flow_type="shear")``. Lists and
    tuples become comma-separated, True gives an option without value, None leaves it out. Unknown and unused options
    are errors, as on the command line. Every simulation has its own options: those of ``petsc4py.init`` do not count.

    Making, stepping, running, writing and closing are collective over ``comm``; so is the garbage collection of a
    simulation that was not closed: under ``mpirun``, use ``with`` or `close`.

    Parameters
    ----------
    options_file : str or Path, optional
        A file of options, as ``-options_file``; keyword options win over it.
    comm : petsc4py.PETSc.Comm, optional
        The ranks that work on it, default ``PETSc.COMM_WORLD``.
    flow : callable, optional
        Background flow ``flow(x, y, t) -> (u, v)`` of arrays x, y, shape (n,), and a time; with ``dim=3`` ``flow(x, y,
        z, t) -> (u, v, w)``. It stands in place of
        ``flow_type`` and is called on every rank, for other points and other numbers of times, so it must not
        communicate; nor may it use the simulation. A part of it that is no Stokes flow for this viscosity (du/dt -
        nu Lap u + grad p not zero for any p) acts as if a body force held it; its divergence must be zero.
    quiet : bool, optional
        Print nothing that was not asked for (default): no progress, final table, reasons or warnings. `warnings` has the last.
    **options
        The program's options. Without ``output_dir`` the files go to a temporary folder that `close` removes.

    Raises
    ------
    Error
        With the program's one-line message.

    Examples
    --------
    >>> with petves.Simulation(domain_cells=(64, 64), flow_type="shear", time_end=0.5) as sim:
    ...     sim.run()
    ...     print(sim.inclination, sim.markers.shape)
    """

    def __init__(
        self,
        options_file: str | Path | None = None,
        *,
        comm: PETSc.Comm | None = None,
        flow: FlowFunction | None = None,
        quiet: bool = True,
        **options: Unpack[Options],
    ) -> None:
        self._lib = library()
        self._handle = Handle()
        self._options = Handle()
        self._message = ctypes.create_string_buffer(MAX_MESSAGE)
        self._inside = False
        self._quiet = quiet
        self._ended = True  # nothing to write yet
        self._temporary: Path | None = None  # folder
        self._failed: list[BaseException] = []  # by the flow
        self._rows: list[bytes] = []
        self._gathered: dict[str, np.ndarray] = {}
        self._comm = comm or PETSc.COMM_WORLD
        self._communicator = communicator(self._comm)
        dim, given = Int(2), ctypes.c_int()
        if flow is not None:
            options["flow_type"] = "custom"
        with one_thread:
            try:
                self._lib.PetscOptionsCreate(ctypes.byref(self._options))
                self._set_options(options_file, options)
                self._lib.PetscOptionsGetInt(self._options, None, b"-dim", ctypes.byref(dim), ctypes.byref(given))
                self._dim = dim.value
                self._flow = Flow(0) if flow is None else flow_function(flow, self._dim, self._failed)
                self._call("SimulationCreateWithFlow", self._communicator, self._flow, None, ctypes.byref(self._handle))
                self._learn()
                self._call("SimulationBegin", self._handle)
            except BaseException:
                self._free()
                raise
        self._record()
        self._ended = False
        _alive[id(self)] = weakref.ref(self)

    @classmethod
    def restart(cls, path: str | Path, **options: Any) -> Simulation:
        """Return a simulation that goes on from a checkpoint.

        Parameters
        ----------
        path : str or Path
            A run's checkpoint.h5. The run's options are those of resolved.opts beside it, when it is there; the series
            and the saved fields go on in the run's folder unless ``output_dir`` says another.
        **options
            As of `Simulation`: what changes, such as ``time_end``, and ``flow`` when the run had one.

        Raises
        ------
        Error
            When the checkpoint cannot be read or belongs to another scene.
        """
        beside = Path(path).parent / "resolved.opts"
        if "options_file" not in options and beside.is_file():
            options["options_file"] = beside
        return cls(restart=path, **options)

    def _set_options(self, options_file: str | Path | None, options: dict[str, Any]) -> None:
        """Fill the simulation's own options database."""
        comm = self._communicator
        path = None if options_file is None else os.fsencode(options_file)
        given = [(f"-{name}".encode(), option_text(value)) for name, value in options.items() if value is not None]
        words = (ctypes.c_char_p * (2 * len(given)))(*sum(given, ()))
        self._call("PetvesReadOptions", comm, self._options, path, len(given), words)
        has = ctypes.c_int()
        self._call("PetscOptionsHasName", self._options, None, b"-output_dir", ctypes.byref(has))
        if not has.value:
            path = ctypes.create_string_buffer(MAX_PATH)
            self._call("PetvesTemporaryFolder", comm, path)
            self._temporary = Path(os.fsdecode(path.value))
            self._call("PetscOptionsSetValue", self._options, b"-output_dir", path.value)

    def _learn(self) -> None:
        """Ask the simulation what does not change: sizes, options in force, columns."""
        count, sizes, name = Int(), (Int * 7)(), ctypes.c_char_p()
        self._lib.SimulationGetSizes(self._handle, ctypes.byref(count), None, sizes)
        start = (Int * (count.value + 1))()
        self._lib.SimulationGetSizes(self._handle, ctypes.byref(count), start, sizes)
        self._start = np.array(start)
        self._sizes = list(sizes)
        value = ctypes.create_string_buffer(MAX_PATH)
        self._in_force: dict[str, str] = {}
        while True:  # by _call: it writes numbers with points
            self._call("SimulationGetOption", self._handle, len(self._in_force), ctypes.byref(name), value, MAX_PATH)
            if not name.value:
                break
            self._in_force[name.value.decode()[1:]] = os.fsdecode(value.value)
        self._columns: dict[str, int] = {}
        while not self._lib.SimulationGetColumn(self._handle, len(self._columns), ctypes.byref(name)) and name.value:
            self._columns[name.value.decode()] = len(self._columns)
        self._row = (ctypes.c_double * len(self._columns))()
        self._places: list[int | None] | None = None  # where the gathered markers are, which C says in:
        self._found = [ctypes.c_void_p() for _ in range(3)]
        self._found_by = [ctypes.byref(place) for place in self._found]

    def _call(self, function: str, *arguments: Any) -> None:
        """Call a C function with this simulation's options database; raise what went wrong."""
        self._call_all((function, arguments))

    def _call_all(self, *calls: tuple[str, Any]) -> None:
        """Call C functions one after another, as `_call` does one: entered and left once, which a step feels."""
        with one_thread:
            if self._inside:
                raise Error("a simulation cannot be used inside its own step; copy what the flow needs beforehand")
            depth, code, cause = Int(), 0, None
            self._lib.PetvesEnter(self._options, self._message, ctypes.byref(depth))
            if self._quiet:
                self._lib.PetvesSetQuiet(1)
            own = self.__dict__  # in each step: without the check of __setattr__
            own["_inside"] = True
            try:
                for function, arguments in calls:
                    code = getattr(self._lib, function)(*arguments)
                    if code:
                        break
            except SystemError as error:  # an exception in a Python callback of petsc4py, a KSP monitor for instance
                cause = error.__cause__ or error
            finally:
                own["_inside"] = False
                if self._quiet:
                    self._lib.PetvesSetQuiet(0)
                self._lib.PetvesLeave(depth)
            if cause is not None or code not in (0, PETSC_ERR_USER_INPUT):  # all ranks have agreed on that one
                self._lib.PetvesEndTogether(self._communicator, self._message.value or str(cause).encode())
        if code and self._failed:  # without a code all ranks have agreed that the step failed: _stop_on raises it
            cause = self._failed.pop()
        if cause is not None or code:
            self._ended = True  # the state is not to be trusted: no files are written from it
            self._failed.clear()
        if cause is not None:
            raise cause
        if code:
            raise Error(self._message.value.decode(errors="replace") or f"PETSc error {code} in {function}")

    def _open(self) -> Handle:
        if not self._handle:
            raise Error("the simulation is closed")
        return self._handle

    def _record(self) -> None:
        """Keep the row and show the markers of the state that has just been reached. Collective."""
        self._call("SimulationGatherMarkers", self._open(), *self._found_by)
        self._keep()

    def _keep(self) -> None:
        """Keep the row and show the markers that have been gathered. Not collective."""
        found = self._found
        places = [found[0].value, found[1].value, found[2].value]
        if places != self._places:  # they stay where they are: making arrays of them each time is dear
            self._places = places
            count = int(self._start[-1])
            for name, place, each in zip(("markers", "marker_velocity", "tension"), found, (self._dim, self._dim, 1)):
                pointer = ctypes.cast(place, ctypes.POINTER(ctypes.c_double))
                array = np.ctypeslib.as_array(pointer, (each * count,)) if count else np.empty(0)
                array.flags.writeable = False
                self._gathered[name] = array
        self._lib.SimulationGetRow(self._handle, -1, self._row)
        self._rows.append(bytes(self._row))  # cheaper than a tuple

    def step(self, steps: int = 1) -> None:
        """Take so many time `steps`, with their rows of series.csv and the files that are due.

        Raises
        ------
        Error
            When a step cannot be taken; checkpoint.h5 then holds the last good state.
        """
        failure = ctypes.c_char_p()
        for _ in range(steps):
            self._ended = False
            self._call("SimulationStep", self._open(), ctypes.byref(failure))
            self._stop_on(failure)
            self._record()

    def run(
        self,
        until: float | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
        live: bool = False,
    ) -> str:
        """Step to a time, the steady state of ``time_steady_tol``, or where the callback says so.

        Returns why it stopped: "finished", "steady", "stopped" (``time_wall_limit``) or "callback".

        Parameters
        ----------
        until : float, optional
            Time, reached exactly: the last steps are shortened. The option ``time_end`` when left out, and then the run
            ends as the program's does: with the end state, checkpoint.h5 and summary.json on disk. With `until` they are
            written by `close`.
        callback : callable, optional
            ``callback(simulation)`` after every step, on every rank. The run stops when it returns True on any of
            them. An exception in it, on any of them, ends the run on all, with the last good state on disk: it comes
            through where it was raised, the other ranks raise `Error`.
        progress : bool, optional
            Show a progress bar; when left out, if standard error is a terminal.
        live : bool
            Draw membranes, bending energy and inclination in a notebook, anew every second.

        Raises
        ------
        Error
            When a step cannot be taken; checkpoint.h5 then holds the last good state.
        """
        end = float(self._in_force["time_end"]) if until is None else until
        stepped, failure, word = ctypes.c_int(), ctypes.c_char_p(), ctypes.c_char_p()
        first = self._comm.getRank() == 0
        if live and first:
            from petves.views.watch import Live

            callback = Live(self, callback)
        with progress_bar(end, self.time, progress if first else False) as bar:
            handle = self._open()
            advance = ("SimulationAdvance", (handle, end, ctypes.byref(stepped), ctypes.byref(failure)))
            gather = ("SimulationGatherMarkers", (handle, *self._found_by))
            while True:
                self._open()  # a callback may have closed it
                self._call_all(advance, gather)
                if not stepped.value:
                    self._lib.SimulationGetReason(self._handle, ctypes.byref(word))
                    reason = word.value.decode()
                    break
                self.__dict__["_ended"] = False
                self._stop_on(failure)
                self._keep()
                bar(self.time)
                if self._wants_to_stop(callback):
                    reason = "callback"
                    break
        if until is None and reason != "callback":
            self._end(None)
        return reason

    def _wants_to_stop(self, callback: Callback | None) -> bool:
        """Call the callback; return what all ranks have agreed on. It may have been given on some of them only."""
        wish, agreed, cause = GO_ON, Int(GO_ON), None
        try:
            wish = STOP if callback is not None and callback(self) is True else GO_ON
        except BaseException as error:
            wish, cause = FAILED, error
        with one_thread:
            self._lib.PetvesAgree(self._communicator, wish, ctypes.byref(agreed))
        if agreed.value == FAILED:
            self._end(b"a callback raised an exception")
            raise cause or Error("the callback raised an exception on another rank")
        return agreed.value == STOP

    def _end(self, failure: bytes | None) -> None:
        self._call("SimulationEnd", self._open(), failure)
        self._ended = True

    def _stop_on(self, failure: ctypes.c_char_p) -> None:
        if failure.value is None:
            return
        text, cause = failure.value, self._failed.pop() if self._failed else None
        self._failed.clear()
        self._end(text)
        if cause is not None:
            raise cause
        raise Error(f"{text.decode(errors='replace')}; the last good state is in {self.folder}/checkpoint.h5")

    def checkpoint(self) -> Path:
        """Write checkpoint.h5; return its path."""
        self._call("SimulationCheckpoint", self._open())
        return self.folder / "checkpoint.h5"

    def view(self) -> None:
        """Print the model in force and the solvers, as ``-view``."""
        self._call("SimulationView", self._open(), PETSc.Viewer.STDOUT(self._comm).handle)

    def close(self) -> None:
        """Write the end state and summary.json if that has not been done, free everything. Later calls do nothing."""
        if not self._handle:
            return
        try:
            if not self._ended:
                self._end(None)
        finally:
            self._free()

    def _free(self) -> None:
        gc.collect()  # what Python has dropped, a KSP of an exception's frames, goes before, on every rank
        with one_thread:
            try:
                if self._handle:
                    self._call("SimulationDestroy", ctypes.byref(self._handle))
            finally:
                self._handle = Handle()
                # petsc4py keeps objects that Python has dropped, such as a KSP of a simulation closed before, until all ranks say so
                PETSc.garbage_cleanup(self._comm)
                if self._options:
                    self._lib.PetscOptionsDestroy(ctypes.byref(self._options))
                if self._temporary and self._comm.getRank() == 0:
                    shutil.rmtree(self._temporary, ignore_errors=True)
                _alive.pop(id(self), None)

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: object) -> None:
        if error is not None and self._handle:
            self._ended = True
            self._lib.PetvesEndTogether(self._communicator, f"{type(error).__name__}: {error}".encode())
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_handle", None) and not sys.is_finalizing():
            self.close()


@atexit.register
def _close_all() -> None:
    """Close what is still open before petsc4py ends PETSc; after an error without writing."""
    for reference in list(_alive.values()):
        simulation = reference()
        if simulation is not None:
            simulation.__exit__(None, getattr(sys, "last_value", None), None)
