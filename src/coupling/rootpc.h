/* A PC of PETSc's sequential kinds (PCILU) for an edge vector of all vesicles: the matrix and its factors are on one
   rank, the vectors travel there and back. */
#pragma once
#include "markers/layout.h"

typedef struct _p_RootPC *RootPC;
struct _p_RootPC {
  Layout layout;    /* borrowed */
  PetscMPIInt root; /* the owner of the first body */
  PC pc;            /* on every rank, so that a bad option is everybody's error; used on root */
  Vec x, y;         /* on root: all edges */
};

/* RootPCCreate - PCILU of `levels` levels in nested dissection, unless options with this prefix
   say otherwise. Collective. */
PETSC_EXTERN PetscErrorCode RootPCCreate(Layout layout, const char prefix[], PetscInt levels, RootPC *pc);
PETSC_EXTERN PetscErrorCode RootPCDestroy(RootPC *pc);

/* RootPCIsNone - whether the options want no preconditioner. Not collective. */
PETSC_EXTERN PetscErrorCode RootPCIsNone(RootPC pc, PetscBool *none);

/* RootPCSetMatrix - the sequential matrix on root (referenced), NULL elsewhere; failed: it could not be factored, the
   same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode RootPCSetMatrix(RootPC pc, Mat A, PetscBool *failed);

/* RootPCApply - y = P^-1 x for edge vectors. Collective. */
PETSC_EXTERN PetscErrorCode RootPCApply(RootPC pc, Vec x, Vec y);
