/* Tensor dipoles of markers on the grid, for the double layer of a membrane between two viscosities (docs/contrast.md,
   Dipoles on the grid).

   A marker's symmetric tensor T goes to cells (xx, yy) and nodes (xy) with the kernel cbs54 convolved by one cell along
   the derivatives that follow,

       T_xx: B6(x) B4(y),   T_yy: B4(x) B6(y)   cells,      T_xy: B5(x) B5(y)   nodes,

   so that the force -nu DIV T and the source of a closed curve that moves as a rigid body give a smoothed rigid motion
   inside the curve and nothing outside. At a wall weights are folded smoothly (wallfold.h). Every rank has all tensors
   and adds them to its own rows; nothing crosses ranks. */
#pragma once
#include "markers/markers.h"

typedef enum { DIPOLE_XX, DIPOLE_YY, DIPOLE_XY, DIPOLE_COUNT } DipolePart;

/* DipoleStencilsUnwrapped - stencils of the three parts of a tensor at X, with entries beyond the grid. Entry (i, j) of
   the part xy is the upper right corner of cell (i, j). Not collective. */
PETSC_EXTERN void DipoleStencilsUnwrapped(Grid grid, const PetscReal X[2], Stencil stencil[DIPOLE_COUNT]);

/* A spot is the stencil by which one part of a marker's tensor adds to the entries of a field. */
#define DIPOLE_SPOTS 6
PETSC_EXTERN const StencilForm dipole_form; /* of the spots of a marker */

/* DipoleSpots - spots of a marker at X for unit parts of a tensor T (velocity times length): on the faces and in the
   cells

     -nu DIV T/h^2,      -(T_xx + T_yy)/(2 h^2) = G^T of the velocity.

   DipoleSpotsOf - spots from a marker's unwrapped stencils, which are overwritten. Not collective. */
PETSC_EXTERN void DipoleSpots(Grid grid, PetscReal nu, const PetscReal X[2], Stencil spot[DIPOLE_SPOTS]);
PETSC_EXTERN void DipoleSpotsOf(Grid grid, PetscReal nu, Stencil stencil[DIPOLE_COUNT], Stencil spot[DIPOLE_SPOTS]);

/* The spots of all dipoles by rows, with the rows next to this rank's that forces on the row above it need. */
#define DIPOLE_BELOW 1
#define DIPOLE_ABOVE 2
static inline PetscErrorCode DipoleListCreate(Grid grid, StencilRows *list) {
  return StencilRowsCreate(grid, &dipole_form, DIPOLE_BELOW, DIPOLE_ABOVE, list);
}

/* DipoleListWindow - local rows that spots reach, those next to this rank's included. DipoleListSpread - add what the
   tensors T[DIPOLE_COUNT M] give to the own rows of the velocity w and of source. Not collective. */
PETSC_EXTERN void DipoleListWindow(StencilRows list, PetscInt window[2]);
PETSC_EXTERN PetscErrorCode DipoleListSpread(StencilRows list, const PetscReal T[], Vec w, Vec source);

/* DipoleShortfall - nu T less the first moments along dir of the x and the y component of the dipole's force. The
   component along dir has the pressure that the dipole's source adds in the rows next to the walls, times the length of
   the walls, added to it (length^4/time^2). It is 0 far from walls along dir. Not collective. */
PETSC_EXTERN void DipoleShortfall(Grid grid, PetscReal nu, const PetscReal X[2], const PetscReal T[DIPOLE_COUNT],
                                  int dir, PetscReal shortfall[2]);
