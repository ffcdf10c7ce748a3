/* Tensor dipoles of markers on the grid, for the double layer of a membrane between two viscosities (docs/contrast.md,
   Dipoles on the grid).

   A marker's symmetric tensor T goes to cells (xx, yy) and nodes (xy) with the kernel cbs54 convolved by one cell along
   the derivatives that follow,

       T_xx: B6(x) B4(y),   T_yy: B4(x) B6(y)   cells,      T_xy: B5(x) B5(y)   nodes,

   so that the force -nu DIV T and the source of a closed curve that moves as a rigid body give a smoothed rigid motion
   inside the curve and nothing outside. At a wall weights are folded smoothly (wallfold.h). Every rank has all tensors
   and adds them to its own rows; nothing crosses ranks. */
#pragma once
#include "base/lanes.h"
#include "markers/markers.h"

typedef enum { DIPOLE_XX, DIPOLE_YY, DIPOLE_XY, DIPOLE_COUNT } DipolePart;

/* DipoleStencilsUnwrapped - stencils of the three parts of a tensor at X, with entries beyond the grid. Entry (i, j) of
   the part xy is the upper right corner of cell (i, j). Not collective. */
PETSC_EXTERN void DipoleStencilsUnwrapped(Grid grid, const PetscReal X[2], Stencil stencil[DIPOLE_COUNT]);

/* A spot is what one part of a marker's tensor adds to the entries of a field,

     value * line[0].weight_i * line[1].weight_j,   entries first + i, first + j along x and y.

   The weights of a line are zero from the n-th on. */
#define DIPOLE_POINTS (2 * LANES) /* KERNEL_MAX_POINTS + 1, rounded up to whole vectors */
typedef struct {
  PetscInt first, n;
  PetscReal weight[DIPOLE_POINTS];
} DipoleLine;
typedef struct {
  Field field;
  DipolePart part;
  PetscReal value;
  DipoleLine line[2];
} DipoleSpot;
#define DIPOLE_SPOTS 6

/* DipoleSpots - spots of a marker at X for unit parts of a tensor T (velocity times length): on the faces and in the
   cells

     -nu DIV T/h^2,      -(T_xx + T_yy)/(2 h^2) = G^T of the velocity.

   DipoleSpotsOf - spots from a marker's unwrapped stencils, which are overwritten. DipoleEntry - column (direction 0)
   or row (direction 1) of entry k of a spot, counted over all ranks' rows. DipoleAddRow - add value times the spot's
   weights along x to a row of the grid. Not collective. */
PETSC_EXTERN void DipoleSpots(Grid grid, PetscReal nu, const PetscReal X[2], DipoleSpot spot[DIPOLE_SPOTS]);
PETSC_EXTERN void DipoleSpotsOf(Grid grid, PetscReal nu, Stencil stencil[DIPOLE_COUNT], DipoleSpot spot[DIPOLE_SPOTS]);
static inline PetscInt DipoleEntry(Grid g, const DipoleSpot *s, int direction, PetscInt k) {
  const PetscInt entry = s->line[direction].first + k, n = g->n[direction];
  return g->wall[direction] ? entry : (entry + n) % n;
}

static inline void DipoleAddRow(Grid g, const DipoleSpot *s, PetscReal value, PetscScalar row[]) {
  const DipoleLine *x = &s->line[0];
  PetscScalar *at = row + x->first;
  if (x->first >= 0 && x->first + DIPOLE_POINTS <= g->columns[s->field]) {
    LanesPut(LanesAt(at) + value * LanesAt(x->weight), at);
    LanesPut(LanesAt(at + LANES) + value * LanesAt(x->weight + LANES), at + LANES);
  } else
    for (PetscInt k = 0; k < x->n; k++) row[DipoleEntry(g, s, 0, k)] += value * x->weight[k];
}

/* DipoleShortfall - nu T less the first moments along dir of the x and the y component of the dipole's force. The
   component along dir has the pressure that the dipole's source adds in the rows next to the walls, times the length of
   the walls, added to it (length^4/time^2). It is 0 far from walls along dir. Not collective. */
PETSC_EXTERN void DipoleShortfall(Grid grid, PetscReal nu, const PetscReal X[2], const PetscReal T[DIPOLE_COUNT],
                                  int dir, PetscReal shortfall[2]);
