/* What a wall adds to the velocity of tensor dipoles (docs/contrast.md, Walls), seen from the
   wall: x along it, y across, tensor parts xx (along), yy (across), xy. Of the half-space lattice in a table, of the
   exact fluid in closed form, and what kernels and lattice take from that far away. h = 1; no viscosity. */
#pragma once
#include "base/lanes.h"
#include "coupling/imagefar.h"
#include "coupling/imagetable.h"
#include "coupling/latticedipole.h"

/* Velocity by part, component (along, across), row of the response (along at row + 1/2, across at row), row of the
   dipole (cells at row + 1/2, nodes at row) and entry of the response minus that of the part, as in LatticeDipoles. */
typedef struct {
  PetscReal value[DIPOLE_COUNT][2][IMAGE_ROWS][IMAGE_ROWS][IMAGE_WIDTH];
} DipoleImageTable;

/* DipoleImageFill - from the free lattice's tables (LatticeDipoles), of a reach of IMAGE_SHIFT at least. Not
   collective. */
PETSC_EXTERN PetscErrorCode DipoleImageFill(const OffsetTable lattice[2], DipoleImageTable *table);

/* Polynomials of the closed forms, by part and component. */
typedef struct {
  PetscReal exact[DIPOLE_COUNT][2][IMAGE_MONOMIALS], far[DIPOLE_COUNT][2][IMAGE_MONOMIALS];
} DipoleImageForms;

/* DipoleImageFormsMake - for responses with these second moments along and across. DipoleImageExact - K[component]
   [part] of the exact fluid's image. DipoleImageFar - that less the lattice's, to the order 1/R^3, R the distance from
   the image. DipoleImageFour - both, DipoleImageFourExact - the first alone, of four pairs. Not collective. */
PETSC_EXTERN void DipoleImageFormsMake(PetscReal along, PetscReal across, DipoleImageForms *forms);
PETSC_EXTERN void DipoleImageExact(const DipoleImageForms *forms, const ImagePair *pair, PetscReal K[2][DIPOLE_COUNT]);
PETSC_EXTERN void DipoleImageFar(const DipoleImageForms *forms, const ImagePair *pair, PetscReal K[2][DIPOLE_COUNT]);
PETSC_EXTERN void DipoleImageFour(const DipoleImageForms *forms, Lanes x, Lanes a, Lanes b,
                                  Lanes exact[2][DIPOLE_COUNT], Lanes far[2][DIPOLE_COUNT]);
PETSC_EXTERN void DipoleImageFourExact(const DipoleImageForms *forms, Lanes x, Lanes a, Lanes b,
                                       Lanes exact[2][DIPOLE_COUNT]);
