/* Tensor dipoles of markers on the grid, for the double layer of a membrane between two viscosities (docs/contrast.md,
   Dipoles on the grid). A marker's symmetric tensor T goes to cells (xx, yy) and nodes (xy) with the kernel cbs54
   convolved by one cell along the derivatives that follow,

       T_xx: B6(x) B4(y),   T_yy: B4(x) B6(y)   cells,      T_xy: B5(x) B5(y)   nodes,

   so that the force -nu DIV T and the source of a closed curve moving as a rigid body give a smoothed rigid motion
   inside it and nothing outside. At a wall weights are folded smoothly (fold.h). */
#pragma once
#include "base/lanes.h"
#include "markers/markers.h"

typedef enum { DIPOLE_XX, DIPOLE_YY, DIPOLE_XY, DIPOLE_COUNT } DipolePart;

/* DipoleStencilsUnwrapped - of a marker at X: where its three parts are, entries beyond the grid as they are. Entry (i,
   j) of xy is the upper right corner of cell (i, j). Not collective. */
PETSC_EXTERN void DipoleStencilsUnwrapped(Grid grid, const PetscReal X[2], Stencil stencil[DIPOLE_COUNT]);

/* What a part of a marker's tensor adds to the entries of a field: value times a product of weights along x and y, zero
   from the n-th on. */
#define DIPOLE_POINTS (2 * LANES) /* one more than KERNEL_MAX_POINTS, in whole vectors */
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

/* DipoleSpots - of a marker at X with unit parts of a tensor (velocity times length): -nu DIV T/h^2 on the faces,
   -(T_xx
   + T_yy)/(2 h^2), which is G^T of the velocity, in cells. DipoleSpotsOf - from its unwrapped stencils, which are
   overwritten. DipoleEntry - row (direction 1) or column of entry k of a
   spot, of all ranks' rows. DipoleAddRow - value times the spot's weights along x, added to a row of the grid. Not
   collective. */
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

/* DipoleShortfall - as MarkersShortfall, of a dipole: nu T less the first moments of its force across the box along
   dir, of the x and the y component; and in the component across, what its source adds to the pressure in the rows next
   to the walls, times the box's length there (length^4/time^2). Not collective. */
PETSC_EXTERN void DipoleShortfall(Grid grid, PetscReal nu, const PetscReal X[2], const PetscReal T[DIPOLE_COUNT],
                                  int dir, PetscReal shortfall[2]);

/* DipolesSpread - of M markers with tensors T[3M], the same on every rank: their spots[DIPOLE_SPOTS M] added to w and
   source. Not collective. */
PETSC_EXTERN PetscErrorCode DipolesSpread(Grid grid, PetscInt M, const DipoleSpot spot[], const PetscReal T[], Vec w,
                                          Vec source);
