/* The tension problem's approximate Schur complement Chat = S^T S + S^T G diag(L)^-1 G^T S, assembled from the stencils
   of the markers. Every rank has the whole matrix. */
#pragma once
#include "problem/coupling.h"

/* TensionAssemble - Chat at the coupling's markers, a sequential matrix on every rank. Not collective. */
PETSC_EXTERN PetscErrorCode TensionAssemble(Coupling coupling, Mat *Chat);
