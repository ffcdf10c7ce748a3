/* What a wall adds to the velocity of tensor dipoles (docs/contrast.md, Walls), seen from the wall: x along it, y
   across, tensor parts xx (along), yy (across), xy; h = 1, of any viscosity. Three answers: of the half-space lattice,
   in a table; of the exact fluid, in closed form; and what lattice and regularised delta functions take from that far
   away, in closed form (imageform.h). Nothing crosses ranks. */
#pragma once
#include "base/lanes.h"
#include "layers/imagefar.h"
#include "layers/imagetable.h"
#include "layers/latticegreen.h"

/* Velocity by part, component (along, across), row of the response (along at row + 1/2, across at row), row of the
   dipole (cells at row + 1/2, nodes at row) and entry of the response minus that of the part, as in LatticeDipoles. */
typedef struct {
  PetscReal value[DIPOLE_COUNT][2][IMAGE_ROWS][IMAGE_ROWS][IMAGE_WIDTH];
} DipoleImageTable;

/* DipoleImageFill - from the free lattice's tables (LatticeDipoles), of a reach of IMAGE_SHIFT at least. Not
   collective. */
PETSC_EXTERN PetscErrorCode DipoleImageFill(const OffsetTable lattice[2], DipoleImageTable *table);

/* DipoleImageFormsMake - by component and part, for responses with a kernel of these moments along and across.
   DipoleImageExact - K[component][part] of the exact fluid's image. DipoleImageFar - that less the lattice's, to the
   order 1/R^7 up to IMAGE_THIRD cells, 1/R^5 up to IMAGE_SECOND and 1/R^3 beyond, R the distance from the image. Not
   collective. */
PETSC_EXTERN void DipoleImageFormsMake(const ImageMoments kernel[2], ImageForms *forms);
PETSC_EXTERN void DipoleImageExact(const ImageForms *forms, const ImagePair *pair, PetscReal K[2][DIPOLE_COUNT]);
PETSC_EXTERN void DipoleImageFar(const ImageForms *forms, const ImagePair *pair, PetscReal K[2][DIPOLE_COUNT]);

/* One marker's dipoles seen from a wall, with the polynomials of the exact image of J = n. */
typedef struct {
  const ImageForms *forms;
  PetscReal N[2], unit[2];           /* times the factor; over the length */
  Lanes flux[2][2][IMAGE_MONOMIALS]; /* component, real and imaginary part, monomial */
} DipoleImageSource;

/* DipoleImageSourceMake - N = n times the marker's length, over: 1 over that; factor: of all answers. DipoleImageFour -
   of four pairs with this source, the exact image less the lattice's, as DipoleContract, M[4], and the lattice's answer
   to J = n, L[2]. DipoleImageFourExact - the exact image alone, M[4]. Not collective. */
PETSC_EXTERN void DipoleImageSourceMake(const ImageForms *forms, const PetscReal N[2], PetscReal factor, PetscReal over,
                                        DipoleImageSource *source);
PETSC_EXTERN void DipoleImageFour(const DipoleImageSource *source, Lanes x, Lanes a, Lanes b, Lanes M[4], Lanes L[2]);
PETSC_EXTERN void DipoleImageFourExact(const DipoleImageSource *source, Lanes x, Lanes a, Lanes b, Lanes M[4]);
