/* Mob, the mobility of bodies' markers among themselves on the grid, approximately E A^-1 E^T with A^-1 the Stokes
   solution operator, for preconditioners (docs/solver.md, Preconditioner). There are two ways.

   Table: A^-1 is that of a periodic box of the grid's cells. Near markers are exact there: the weights of the two
   kernels are summed against the grid's Green's function, which is tabulated (mobilitytable.h). With the near field,
   whose C takes what depends on the place in a cell off them, distant markers have a smooth table: the mean of these
   sums over the places in a cell, by whole cells between two markers, interpolated.

   Box: between walls, in quasi-steady flow where the near field has a box part D (docs/nearfield.md, Box part),
       (E A^-1 E^T + D)/h^2 ~ W + B + L - C_image,
   B, L and C_image those of the nearest image, fading over a period: B the exact images of the Stokeslet in the walls,
   L the lattice's mobility, and W the smooth rest on the coarser one of the box part's grids. Near a wall W goes on
   along a straight line, which it can as B has what is singular there. With the near field's C that is the exact single
   layer with its images.

   Every rank makes a part of the entries; the sum of all parts is made on one rank. */
#pragma once
#include "problem/coupling.h"
#include "precondition/mobilitytable.h"

typedef struct _p_MeanMobility *MeanMobility;
struct _p_MeanMobility {
  Coupling coupling;      /* borrowed */
  MobilityTable table;    /* NULL with box, and in unbounded fluid, where the near field is all */
  BoxPart box;            /* W; NULL with table */
  PetscReal near;         /* cells up to which a pair's stencils are summed */
  PetscReal part;         /* part of the grid's velocity that markers have, MobilityGridPart */
  PaddedStencil *stencil; /* [2M] work */
};

/* MeanMobilityCreate - for the fluid's grid and the coupling's membranes and kernel, markers up to `reach` (length)
 * apart. Collective. */
PETSC_EXTERN PetscErrorCode MeanMobilityCreate(const FluidSpec *spec, Coupling coupling, PetscReal reach,
                                               MeanMobility *mobility);
PETSC_EXTERN PetscErrorCode MeanMobilityDestroy(MeanMobility *mobility);

/* MeanMobilitySetUp - the tables for the fluid's coefficient alpha of H = alpha I - nu L_u (0 in quasi-steady flow:
   made once). Collective. */
PETSC_EXTERN PetscErrorCode MeanMobilitySetUp(MeanMobility mobility, PetscReal alpha);

/* MeanMobilityAssemble - Mob of the velocity of the markers in rows by forces on those in columns, ranges of whole
   bodies where the markers have been placed: matrix [2 n of columns][2 n of rows], entries interlaced x, y. part p of
   `parts`: this call makes the pairs of every parts-th column from p on and leaves zero elsewhere, so that the sum over
   all parts is Mob; with a box every rank makes the rows of its own markers. Collective with a box. */
PETSC_EXTERN PetscErrorCode MeanMobilityAssemble(MeanMobility mobility, const MarkerRange *rows,
                                                 const MarkerRange *columns, PetscInt part, PetscInt parts,
                                                 PetscReal Mob[]);

/* MeanMobilityOnRoot - Mob + h^2 C, C the near field with its box part: the sum of all ranks' parts on rank root, what
   is left elsewhere has no meaning. Collective. */
PETSC_EXTERN PetscErrorCode MeanMobilityOnRoot(MeanMobility mobility, const MarkerRange *rows,
                                               const MarkerRange *columns, PetscMPIInt root, PetscReal Mob[]);
