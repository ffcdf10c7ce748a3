/* Decisions and messages that all ranks must have alike: what one rank has found is told to all before the next
   collective call. Each function is one reduction over the ranks. */
#pragma once
#include "base/base.h"

/* AgreeFlag - whether `mine` is true on any rank. Collective. */
PETSC_EXTERN PetscErrorCode AgreeFlag(MPI_Comm comm, PetscBool mine, PetscBool *any);

/* AgreeFinite - whether all numbers of a vector are finite, on every rank: a norm over ranks may drop a NaN of one
   rank. Collective. */
PETSC_EXTERN PetscErrorCode AgreeFinite(Vec x, PetscBool *finite);

/* AgreeMessage - the message of the lowest rank that has one; empty when none has. message[PETVES_MAX_MESSAGE].
   Collective. */
PETSC_EXTERN PetscErrorCode AgreeMessage(MPI_Comm comm, char message[PETVES_MAX_MESSAGE]);

/* AgreeLargest - the largest of all ranks' values, and the lowest rank that has it (NULL: not wanted). Collective. */
PETSC_EXTERN PetscErrorCode AgreeLargest(MPI_Comm comm, PetscReal *value, PetscMPIInt *rank);
