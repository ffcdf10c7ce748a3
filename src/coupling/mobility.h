/* Mob, the membranes' mobility on the grid: an approximation of E A^-1 E^T, A^-1 the Stokes solution operator of the
   grid, by a periodic box of the same cells (docs/solver.md, Preconditioner). Near markers are exact there: the two
   kernels' weights are summed against the grid's Green's function, which is tabulated. With the near field, whose C
   takes what depends on the place in a cell off them, distant markers have a smooth table: the mean of these sums over
   the places in a cell, by whole cells between two markers, interpolated. Between walls, in quasi-steady flow with box
   part, it is that of the box (mobilitybox.h). */
#pragma once
#include "coupling/mobilitybox.h"
#include "coupling/mobilitytable.h"

typedef struct _p_Mobility *Mobility;
struct _p_Mobility {
  Coupling coupling;      /* borrowed */
  MobilityTable table;    /* NULL with */
  MobilityBox box;        /* between walls, in quasi-steady flow with box part */
  PetscReal near;         /* cells up to which a pair's stencils are summed */
  PetscReal part;         /* what the markers have of the grid's velocity, CouplingGridPart */
  PaddedStencil *stencil; /* [2M] work */
};

/* MobilityCreate - for the fluid's grid and the coupling's membranes and kernel, markers up to `reach` (length) apart.
 * Collective. */
PETSC_EXTERN PetscErrorCode MobilityCreate(const FluidSpec *spec, Coupling coupling, PetscReal reach,
                                           Mobility *mobility);
PETSC_EXTERN PetscErrorCode MobilityDestroy(Mobility *mobility);

/* MobilitySetUp - the tables for the fluid's coefficient alpha of H = alpha I - nu L_u (0 in quasi-steady flow: made
   once). Collective. */
PETSC_EXTERN PetscErrorCode MobilitySetUp(Mobility mobility, PetscReal alpha);

/* MobilityAssemble - Mob of the n markers from `first` on, where the markers have been placed: matrix [2n][2n], entries
   interlaced x, y. part p of `parts`: this call makes every parts-th row's pairs from p on and leaves zero elsewhere,
   so that the sum over all parts is Mob. Collective between walls. */
PETSC_EXTERN PetscErrorCode MobilityAssemble(Mobility mobility, PetscInt first, PetscInt n, PetscInt part,
                                             PetscInt parts, PetscReal Mob[]);

/* MobilityHasBoxPart - whether the near field's box part is in it already; false of NULL. Not collective. */
static inline PetscBool MobilityHasBoxPart(Mobility m) {
  return m && m->box ? PETSC_TRUE : PETSC_FALSE;
}

/* MobilityAssembleBetween - the same of the velocity of the markers in rows by forces on those in columns, [2 n of
   columns][2 n of rows]; a part has every parts-th column. Collective between walls. */
PETSC_EXTERN PetscErrorCode MobilityAssembleBetween(Mobility mobility, const MarkerRange *rows,
                                                    const MarkerRange *columns, PetscInt part, PetscInt parts,
                                                    PetscReal Mob[]);
