"""petsc4py's PETSc, started without the options in .petscrc of the current folder, which may be anybody's."""

import sys

from petves.errors import Error

try:
    import petsc4py
except ImportError:
    raise Error(
        "petsc4py is not installed, which simulating needs; allowed: python3-petsc4py, or that of the library's PETSc"
    ) from None

if "petsc4py.PETSc" not in sys.modules:  # else it has been started
    petsc4py.init(["petves", "-skip_petscrc"])

from petsc4py import PETSc  # noqa: E402

__all__ = ["PETSc"]
