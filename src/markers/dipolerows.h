/* Dipoles of markers in the rows of a solve by stream function (fluid/stream.h), whose velocity w has no divergence.
   A velocity b whose divergence is the dipoles' source is found row by row: along x by sums of the source less its
   row's mean, which are zero on walls, along y by sums of these means,

       b_i - b_{i-1} = h (mean - source_i),      v_j - v_{j-1} = -h mean_j,

   source = G^T of the velocity. Then u = w + b, w being the flow of the forces + nu L_u b, and v's mean flow adds to
   the pressure only (docs/fluid.md, Stream function). */
#pragma once
#include "markers/dipolelist.h"

typedef struct _p_DipoleRows *DipoleRows;
struct _p_DipoleRows {
  Grid grid; /* borrowed */
  PetscReal nu;
  PetscBool own;         /* their own forces are in the rows, */
  PetscInt window[2];    /* of which all but these local ones are zero */
  PetscScalar *field[3]; /* forces on u (with the row above) and v, b along x: from the row below on */
  PetscScalar *mean;     /* [all rows of v] b along y, with the mean flow; zero on walls */
  PetscScalar *flow;     /* [all rows of u] mean flow along x */
};

/* DipoleRowsCreate - none yet. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleRowsCreate(Grid grid, PetscReal nu, DipoleRows *rows);
PETSC_EXTERN PetscErrorCode DipoleRowsDestroy(DipoleRows *rows);

/* DipoleRowsSet - those of the list with tensors T[3M], which add up to a source of zero, with their own forces if
   `own`, else of the source alone; u has the mean flow mean[0] times the profile[rows of all], or, NULL, in a box that
   is periodic both ways u and v have mean[2]. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleRowsSet(DipoleRows rows, const DipoleList list, const PetscReal T[], PetscBool own,
                                          const PetscReal profile[], const PetscReal mean[2]);

/* DipoleRowsAddForce - row += nu L_u b and, where they have them, the dipoles' own force, in local row j of u or v; of
   u the row above the last, too. DipoleRowsAddVelocity - local row j of u += b along x. Not collective. */
PETSC_EXTERN void DipoleRowsAddForce(DipoleRows rows, Field field, PetscInt j, PetscScalar row[]);
PETSC_EXTERN void DipoleRowsAddVelocity(DipoleRows rows, PetscInt j, PetscScalar row[]);
