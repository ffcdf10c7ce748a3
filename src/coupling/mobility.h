/* Mob, the membranes' mobility: an approximation of E A^-1 E^T, A^-1 the Stokes solution operator of the grid. Every
   pair of markers is exact for a periodic box of the same cells: the two kernels' weights are summed against the grid's
   Green's function, which is tabulated once per alpha of H = alpha I - nu L_u (once for all in quasi-steady flow).
   (Averaging over sub-cell positions, even for far pairs only, leaves noise from marker to marker that a stiff
   membrane's fourth derivative blows up.) */
#pragma once
#include "coupling/coupling.h"
#include "coupling/offsets.h"

#define MOBILITY_CACHE 4

/* The periodic box's Green's function for one coefficient, by offsets of faces. */
typedef struct {
  PetscReal alpha;    /* coefficient that it was made for */
  OffsetTable offset; /* without values: empty */
} GreenTable;

typedef struct _p_Mobility *Mobility;
struct _p_Mobility {
  Coupling coupling;                /* borrowed */
  Fluid periodic;                   /* a periodic box of the same cells */
  PetscInt size[2];                 /* half widths of the window of offsets */
  GreenTable cache[MOBILITY_CACHE]; /* most recent first */
  PetscInt built;                   /* tables made so far */
};

/* MobilityCreate - for the fluid's grid and the coupling's membranes and kernel. Collective. */
PETSC_EXTERN PetscErrorCode MobilityCreate(const FluidSpec *spec, Coupling coupling, Mobility *mobility);
PETSC_EXTERN PetscErrorCode MobilityDestroy(Mobility *mobility);

/* MobilitySetTables - fill the cache with the tables for these coefficients, negative: none. Collective.
   MobilityCoefficient - the coefficient of table k, negative without one. */
PETSC_EXTERN PetscErrorCode MobilitySetTables(Mobility mobility, const PetscReal alpha[MOBILITY_CACHE]);
static inline PetscReal MobilityCoefficient(Mobility mobility, PetscInt k) {
  return mobility->cache[k].offset.value[0] ? mobility->cache[k].alpha : -1;
}

/* MobilityForget - drop all tables. Not collective. */
PETSC_EXTERN PetscErrorCode MobilityForget(Mobility mobility);

/* MobilityGetTable - the table for alpha, made if no cached one is within 10 %: six scalar solves in the periodic box.
   Collective; borrowed. */
PETSC_EXTERN PetscErrorCode MobilityGetTable(Mobility mobility, PetscReal alpha, const GreenTable **table);

/* MobilityAssemble - Mob of the n markers from `first` on, where the markers have been placed: symmetric matrix
   [2n][2n], entries interlaced x, y. part p of `parts`: this call makes every parts-th row's pairs from p on and leaves
   zero elsewhere, so that the sum over all parts is Mob. Not collective. */
PETSC_EXTERN PetscErrorCode MobilityAssemble(Mobility mobility, const GreenTable *table, PetscInt first, PetscInt n,
                                             PetscInt part, PetscInt parts, PetscReal Mob[]);
