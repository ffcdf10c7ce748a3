/* What ranks must hold alike: an error or a message of one becomes everybody's before the next collective call. */
#pragma once
#include "base/base.h"

/* AgreeFlag - whether `mine` is true on any rank. Collective. */
PETSC_EXTERN PetscErrorCode AgreeFlag(MPI_Comm comm, PetscBool mine, PetscBool *any);

/* AgreeFinite - whether all numbers of a vector, of every rank, are finite: norms over ranks may drop a NaN of one.
   Collective. */
PETSC_EXTERN PetscErrorCode AgreeFinite(Vec x, PetscBool *finite);

/* AgreeMessage - the message of the lowest rank that has one; empty when none has. message[PETVES_MAX_MESSAGE].
   Collective. */
PETSC_EXTERN PetscErrorCode AgreeMessage(MPI_Comm comm, char message[PETVES_MAX_MESSAGE]);

/* AgreeLargest - the largest of all ranks' values, and the lowest rank that has it (NULL: not wanted). Collective. */
PETSC_EXTERN PetscErrorCode AgreeLargest(MPI_Comm comm, PetscReal *value, PetscMPIInt *rank);
