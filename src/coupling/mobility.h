/* Mob, the membranes' mobility: an approximation of E A^-1 E^T, A^-1 the unsteady Stokes solution operator of the grid
   (DESIGN section 7). Pairs of markers closer than MOBILITY_NEAR cells are exact for a periodic box of the same cells:
   the kernels' weights are summed against the grid's Green's function. Farther pairs take it averaged over sub-cell
   positions, tabulated at whole cells and interpolated by cubics. Blocks between different vesicles are left out. */
#pragma once
#include "coupling/coupling.h"

#define MOBILITY_NEAR 12
#define MOBILITY_CACHE 4

/* Velocity per unit force between faces, by their offset in cells: uu, vv even in both directions, vu odd in both.
   Quarters [0..size[1]] x [0..size[0]] of the periodic functions, x fastest. */
typedef enum { GREEN_UU, GREEN_VV, GREEN_VU, GREEN_COUNT } GreenBlock;
typedef struct {
  PetscReal a0; /* coefficient that it was made for; 0: empty */
  PetscReal *grid[GREEN_COUNT];
  PetscReal *table[GREEN_COUNT]; /* kernels folded in, by displacement in whole cells */
} GreenTable;

typedef struct _p_Mobility *Mobility;
struct _p_Mobility {
  Coupling coupling; /* borrowed */
  Fluid periodic;    /* a periodic box of the same cells */
  struct _p_Scene scene;
  PetscInt size[2];                 /* largest offset held */
  GreenTable cache[MOBILITY_CACHE]; /* most recent first */
  PetscInt built;                   /* tables made so far */
};

/* MobilityCreate - for the scene's grid and the coupling's membranes and kernel. Collective. */
PETSC_EXTERN PetscErrorCode MobilityCreate(Scene scene, Coupling coupling, Mobility *mobility);
PETSC_EXTERN PetscErrorCode MobilityDestroy(Mobility *mobility);

/* MobilityGetTable - the table for a0, made if no cached one is within 10 %: six scalar solves in the periodic box.
   Collective; borrowed. */
PETSC_EXTERN PetscErrorCode MobilityGetTable(Mobility mobility, PetscReal a0, const GreenTable **table);

/* MobilityAssemble - Mob of one vesicle of n markers at the coupling's markers X[2M]: symmetric matrix [2n][2n],
   entries interlaced x, y. Not collective. */
PETSC_EXTERN PetscErrorCode MobilityAssemble(Mobility mobility, const GreenTable *table, const PetscScalar X[],
                                             PetscInt vesicle, PetscReal Mob[]);
