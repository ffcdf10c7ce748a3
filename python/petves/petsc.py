"""petsc4py's PETSc, started without the options in .petscrc of the current folder, which may be anybody's."""

import sys

import petsc4py

if "petsc4py.PETSc" not in sys.modules:  # else it has been started
    petsc4py.init(["petves", "-skip_petscrc"])

from petsc4py import PETSc  # noqa: E402

__all__ = ["PETSc"]
