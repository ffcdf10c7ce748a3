"""libpetves.so: where it is, what its functions take, and PETSc handles as petsc4py objects.

Errors come back as codes; `Simulation` turns them into `petves.Error` with the program's message. petsc4py starts
PETSc, and its objects and petves' are made by the same PETSc library.
"""

import ctypes
import functools
import os
import sys
import threading
from pathlib import Path
from typing import Any, Callable

import numpy as np

from petves.errors import Error
from petves.program import LIBRARY, candidates

try:
    import petsc4py
except ImportError:
    allowed = "python3-petsc4py, or that of the library's PETSc"
    raise Error(f"petsc4py is not installed, which simulating needs; allowed: {allowed}") from None

if "petsc4py.PETSc" not in sys.modules:  # else it has been started; a .petscrc of the current folder may be anybody's
    petsc4py.init(["petves", "-skip_petscrc"])
from petsc4py import PETSc  # noqa: E402

MAX_MESSAGE = 512  # PETVES_MAX_MESSAGE
MAX_PATH = 4096  # PETSC_MAX_PATH_LEN

PETSC_ERR_USER = 83
PETSC_ERR_USER_INPUT = 95
FlowFunction = Callable[..., "tuple[Any, ...]"]  # of the coordinates and the time

one_thread = threading.RLock()  # held while C runs: PETSc serves one thread at a time

Int = ctypes.c_int64 if np.dtype(PETSc.IntType).itemsize == 8 else ctypes.c_int32
Handle = ctypes.c_void_p

_pointer = ctypes.POINTER
_double = ctypes.c_double
_text = ctypes.c_char_p
#: int flow(time, n, X[2n], u[2n], context): petves' PetvesFlow.
Flow = ctypes.CFUNCTYPE(ctypes.c_int, _double, Int, _pointer(_double), _pointer(_double), ctypes.c_void_p)
# An MPI communicator is passed as the eight bytes where petsc4py keeps it: a pointer (Open MPI) or an int (MPICH).
_communicator = ctypes.c_void_p
_numbers = ctypes.c_void_p  # an array's place: array.ctypes

SIGNATURES = {
    "PetvesSetQuiet": (ctypes.c_int,),
    "PetvesEnter": (Handle, _text, _pointer(Int)),
    "PetvesLeave": (Int,),
    "PetvesAgree": (_communicator, Int, _pointer(Int)),
    "PetvesEndTogether": (_communicator, _text),
    "PetvesReadOptions": (_communicator, Handle, _text, Int, _pointer(_text)),
    "PetvesTemporaryFolder": (_communicator, _text),
    "SimulationCreateWithFlow": (_communicator, ctypes.c_void_p, ctypes.c_void_p, _pointer(Handle)),
    "SimulationDestroy": (_pointer(Handle),),
    "SimulationView": (Handle, Handle),
    "SimulationBegin": (Handle,),
    "SimulationStep": (Handle, _pointer(_text)),
    "SimulationAdvance": (Handle, _double, _pointer(ctypes.c_int), _pointer(_text)),
    "SimulationEnd": (Handle, _text),
    "SimulationGetReason": (Handle, _pointer(_text)),
    "SimulationCheckpoint": (Handle,),
    "SimulationGetWarning": (Handle, Int, _pointer(_text)),
    "SimulationGetTime": (Handle, _pointer(Int), _pointer(_double)),
    "SimulationGetObject": (Handle, _text, _pointer(Handle)),
    "SimulationGetSizes": (Handle, _pointer(Int), _pointer(Int), _pointer(Int)),
    "SimulationGetObstacles": (Handle, _pointer(Int), _pointer(Int), _numbers),
    "SimulationGetOption": (Handle, Int, _pointer(_text), _text, ctypes.c_size_t),
    "SimulationGetColumn": (Handle, Int, _pointer(_text)),
    "SimulationGetRow": (Handle, Int, _numbers),
    "SimulationGetCellVelocity": (Handle, _numbers, _numbers),
    "SimulationGetCellPressure": (Handle, _numbers),
    "PetscOptionsCreate": (_pointer(Handle),),
    "PetscOptionsDestroy": (_pointer(Handle),),
    "PetscOptionsSetValue": (Handle, _text, _text),
    "PetscOptionsGetInt": (Handle, _text, _text, _pointer(Int), _pointer(ctypes.c_int)),
    "PetscOptionsHasName": (Handle, _text, _text, _pointer(ctypes.c_int)),
}


@functools.lru_cache(maxsize=None)
def library() -> ctypes.CDLL:
    """Return libpetves.so, loaded once."""
    found = next(filter(Path.is_file, candidates()), None)
    if found is None:
        places = ", ".join(str(path.parent) for path in candidates())
        raise Error(f"{LIBRARY}: not found in {places}; run make, or set PETVES_LIBRARY")
    try:
        lib = ctypes.CDLL(str(found))
        for name, arguments in SIGNATURES.items():
            getattr(lib, name).argtypes = arguments
    except (OSError, AttributeError) as error:
        raise Error(f"{found}: cannot be used ({error})") from None
    return lib


@functools.lru_cache(maxsize=None)
def _petsc4py(name: str, result: type, *arguments: type):
    """Return a function of petsc4py's C interface."""
    api = ctypes.pythonapi
    api.PyCapsule_GetName.restype = ctypes.c_char_p
    api.PyCapsule_GetName.argtypes = [ctypes.py_object]
    api.PyCapsule_GetPointer.restype = ctypes.c_void_p
    api.PyCapsule_GetPointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    capsule = PETSc.__pyx_capi__[name]
    pointer = api.PyCapsule_GetPointer(capsule, api.PyCapsule_GetName(capsule))
    return ctypes.PYFUNCTYPE(result, *arguments)(pointer)


def wrap(kind: str, handle: int) -> PETSc.Object:
    """Return the petsc4py object of a class (Vec, DM, KSP, PC, Mat) for a PETSc object's address; it shares ownership."""
    return _petsc4py(f"PyPetsc{kind}_New", ctypes.py_object, ctypes.c_void_p)(handle)


def communicator(comm: PETSc.Comm) -> int:
    """Return a petsc4py communicator as C functions take it."""
    return ctypes.c_void_p.from_address(_petsc4py("PyPetscComm_GetPtr", ctypes.c_void_p, ctypes.py_object)(comm)).value


def flow_function(flow: FlowFunction, dim: int, failed: list[BaseException]) -> Flow:
    """Return a Python flow of points of `dim` coordinates as C calls it; an exception is kept for the caller of the step."""

    def call(time: float, n: int, positions: Any, velocities: Any, _context: Any) -> int:
        try:
            points = np.ctypeslib.as_array(positions, (n, dim))
            out = np.ctypeslib.as_array(velocities, (n, dim))
            for d, component in enumerate(flow(*points.T.copy(), time)):
                out[:, d] = component
        except BaseException as error:
            failed.append(error)
            return PETSC_ERR_USER
        return 0

    return Flow(call)


def option_text(value: Any) -> bytes | None:
    """Return a Python value as the program reads it: None stands for no value."""
    if value is True:
        return None
    if value is False:
        return b"false"
    if isinstance(value, (list, tuple, np.ndarray)):
        return b",".join(option_text(item) or b"true" for item in np.ravel(np.asarray(value, dtype=object)))
    if isinstance(value, (float, np.floating)):
        return repr(float(value)).encode()
    return os.fsencode(value) if isinstance(value, os.PathLike) else str(value).encode()
