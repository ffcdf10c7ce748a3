/* What a wall of the grid adds to the double layer's C = D - L of a pair of markers, as nearimage.h of the single one:
   the exact fluid's image of a tensor dipole in the wall, less the image that kernels and lattice make of the dipole as
   the grid has it, folded (docs/contrast.md, Walls). */
#pragma once
#include "coupling/dipoleimage.h"
#include "coupling/nearimage.h"

#define DOUBLE_IMAGE_REACH 300 /* cells from a marker to another's image: beyond, none without a box part */

/* A dipole's rows at a wall, folded. */
typedef struct {
  PetscInt first[DIPOLE_COUNT], n[DIPOLE_COUNT];
  PetscReal weight[DIPOLE_COUNT][KERNEL_MAX_POINTS];
} DipoleEnd;

typedef struct _p_DoubleImage *DoubleImage;
struct _p_DoubleImage {
  NearImage single; /* borrowed: where the markers see the walls, and the stencils of their velocities */
  DipoleImageTable *table;
  DipoleImageForms forms;
  DipoleEnd *end[2][2];        /* [M] by direction of the normal and side; NULL without a wall */
  const PaddedStencil *dipole; /* [DIPOLE_COUNT M] unfolded, borrowed */
};

/* DoubleImageCreate - at the walls that the single layer's images have; lattice: the free lattice's tables
   (LatticeDipoles), used here only. Collective. */
PETSC_EXTERN PetscErrorCode DoubleImageCreate(NearImage single, const OffsetTable lattice[2], DoubleImage *image);
PETSC_EXTERN PetscErrorCode DoubleImageDestroy(DoubleImage *image);

/* DoubleImagePlace - where the single layer's images have been placed; dipole[DIPOLE_COUNT M]: the dipoles' unfolded
   stencils (kept by the caller). Not collective. */
PETSC_EXTERN void DoubleImagePlace(DoubleImage image, const PaddedStencil dipole[]);

/* Responses of the markers i .. i + n - 1 to unit tensor parts of marker j, arrays [component][part] of n numbers
   (1/length) with room for whole vectors behind them. */
typedef struct {
  PetscInt i, n, j;
  PetscReal *d[2];                   /* X_i - X_j, in periodic directions to the image meant (length) */
  PetscBool lattice;                 /* whether `free` and `image` are wanted */
  PetscReal *free[2][DIPOLE_COUNT];  /* what the lattice without walls gives */
  PetscReal *image[2][DIPOLE_COUNT]; /* what walls add to that */
  PetscReal *exact[2][DIPOLE_COUNT]; /* what walls add in the exact fluid */
} DoubleColumn;

/* DoubleImageAddColumn - all walls' parts, added to image and exact; reach: of images (cells). DoubleImageAdd - of one
   pair: exact +=, and lattice += image, which holds the free lattice's. DoubleImageExact - exact += that of two points
   and one wall. Not collective. */
PETSC_EXTERN void DoubleImageAddColumn(DoubleImage image, PetscReal reach, const DoubleColumn *column);
PETSC_EXTERN void DoubleImageAdd(DoubleImage image, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal reach,
                                 PetscReal exact[2][DIPOLE_COUNT], PetscReal lattice[2][DIPOLE_COUNT]);
PETSC_EXTERN void DoubleImageExact(DoubleImage image, int direction, int side, const ImagePair *pair,
                                   PetscReal exact[2][DIPOLE_COUNT]);
