/* Dipoles of markers in the rows of a solve by stream function (fluid/stokes/stream.h), whose velocity w has no
   divergence.

   A velocity b whose divergence is the dipoles' source is found row by row: along x by sums of the source less the mean
   of its row, which are zero on walls, along y by sums of these means,

       b_i - b_{i-1} = h (mean - source_i),      v_j - v_{j-1} = h (net - mean_j),      source = G^T of the velocity,

   net the mean of all rows: what sources do not add up to is taken off evenly in the whole box.

   Then u = w + b, where w is the flow of the forces + nu L_u b, and the mean flow of v adds to the pressure only
   (docs/fluid.md, Stream function). Every rank has the means of all rows; nothing crosses ranks.

   Order: DipoleRowsSet, then DipoleRowsAddForce and DipoleRowsAddVelocity for the rows of one solve. */
#pragma once
#include "markers/dipoles.h"

typedef struct _p_DipoleRows *DipoleRows;
struct _p_DipoleRows {
  Grid grid; /* borrowed */
  PetscReal nu;
  PetscBool own;         /* the dipoles' own forces are in `field` */
  PetscInt window[2];    /* local rows that are not zero */
  PetscScalar *field[3]; /* forces on u and v, and b along x, from the row below this rank's on */
  PetscScalar *mean;     /* [rows of v of all ranks] b along y and the mean flow along y; zero on walls */
  PetscScalar *flow;     /* [rows of u of all ranks] mean flow along x */
};

/* DipoleRowsCreate - rows without dipoles. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleRowsCreate(Grid grid, PetscReal nu, DipoleRows *rows);
PETSC_EXTERN PetscErrorCode DipoleRowsDestroy(DipoleRows *rows);

/* DipoleRowsSet - the dipoles of the list with tensors T[3M]. own: with their own forces;
   else their sources alone. The mean flow of u is mean[0] profile[rows of all ranks] or, where profile is NULL and the
   box is periodic both ways, that of u and v is mean[2]. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleRowsSet(DipoleRows rows, StencilRows list, const PetscReal T[], PetscBool own,
                                          const PetscReal profile[], const PetscReal mean[2]);

/* DipoleRowsAddForce - row += nu L_u b, and the dipoles' own force where `own` was set, in local row j of u or v; of u
   the row above the last, too. DipoleRowsAddVelocity - row += b along x, in local row j of u. Not collective. */
PETSC_EXTERN void DipoleRowsAddForce(DipoleRows rows, Field field, PetscInt j, PetscScalar row[]);
PETSC_EXTERN void DipoleRowsAddVelocity(DipoleRows rows, PetscInt j, PetscScalar row[]);
