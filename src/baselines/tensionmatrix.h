/* The tension problem's approximate Schur complement Chat = S^T S + S^T G diag(L)^-1 G^T S, assembled. Each column of S
   is zero outside a small window of cells around its edge: entry (k, l) of Chat is the product of two windows where
   they overlap. One rank has the whole matrix. */
#pragma once
#include "problem/coupling.h"

/* TensionAssemble - Chat at the coupling's markers, a sequential matrix on rank root, NULL elsewhere.
   Not collective. */
PETSC_EXTERN PetscErrorCode TensionAssemble(Coupling coupling, PetscMPIInt root, Mat *Chat);
