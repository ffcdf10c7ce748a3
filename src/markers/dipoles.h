/* Tensor dipoles of markers on the grid, for the double layer of a membrane between two viscosities (docs/method.md,
   Viscosity contrast). A marker's symmetric tensor T goes to cells (xx, yy) and nodes (xy) with the kernel cbs54
   convolved by one cell along the derivatives that follow,

       T_xx: B6(x) B4(y),   T_yy: B4(x) B6(y)   cells,      T_xy: B5(x) B5(y)   nodes,

   so that the force -nu DIV T and the source of a closed curve moving as a rigid body give a smoothed rigid motion
   inside it and nothing outside. Markers keep DIPOLE_WALL_CELLS from walls. */
#pragma once
#include "markers/markers.h"

typedef enum { DIPOLE_XX, DIPOLE_YY, DIPOLE_XY, DIPOLE_COUNT } DipolePart;
#define DIPOLE_WALL_CELLS 4

/* DipoleStencils - of a marker at X: where its three parts are. Entry (i, j) of xy is the upper right corner of cell
   (i, j). Not collective. */
PETSC_EXTERN void DipoleStencils(Grid grid, const PetscReal X[2], Stencil stencil[DIPOLE_COUNT]);

/* DipolesSpread - of the M markers X[2M] of all bodies with tensors T[3M] (xx, yy, xy; velocity times length), the same
   on every rank: w += -nu DIV T/h^2, source += -(T_xx + T_yy)/(2 h^2), which is G^T of the velocity. Not collective. */
PETSC_EXTERN PetscErrorCode DipolesSpread(Markers markers, PetscReal nu, const PetscReal T[], Vec w, Vec source);
