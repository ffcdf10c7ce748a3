/* What a wall of the grid adds to C = D - L of a pair of markers in the double layer (docs/contrast.md, Walls):

       C_wall = D_image - L_half + L,

   D_image the exact fluid's image of a tensor dipole in the wall, L_half what the lattice of a half space makes of the
   dipole as the grid has it, folded at the wall, L the same without a wall. L_half is summed over stencils next to the
   wall, else the difference has a closed form (dipoleimage.h). Walls are added one by one. Nothing crosses ranks. */
#pragma once
#include "layers/dipoleimage.h"
#include "layers/nearimage.h"

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
  ImageForms forms;
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

/* Responses of the markers i .. i + n - 1 to J of marker j, whose normal times its length is N (DipoleContract: x and y
   of J_x, then of J_y), arrays of n numbers with room for whole vectors behind them. */
typedef struct {
  PetscInt i, n, j;
  PetscReal near[4];    /* least distance of the row's markers from each wall (cells) */
  PetscReal N[2], over; /* 1 over the length that N has */
  PetscReal *d[2];      /* X_i - X_j, in periodic directions to the image meant (length) */
  PetscBool lattice;    /* whether the lattice is meant too, or the exact fluid only */
  PetscReal *free[4];   /* what the lattice without walls gives */
  PetscReal *wall[4];   /* what walls add to the exact fluid's response, less what they add to the lattice's */
  PetscReal *flux[2];   /* what walls add to the lattice's response to J = n */
} DoubleColumn;

/* DoubleImageRange - the least distances of a column's row from walls. DoubleImageAddColumn - with these, all walls'
   parts, added to `wall` and `flux`; reach: of images (cells). Not collective. */
PETSC_EXTERN void DoubleImageRange(DoubleImage image, DoubleColumn *column);
PETSC_EXTERN void DoubleImageAddColumn(DoubleImage image, PetscReal reach, const DoubleColumn *column);

/* DoubleImageAdd - of one pair, to unit tensor parts: exact +=, and lattice += image, which holds the free lattice's.
   DoubleImageFourExact - M[4] as DipoleContract, of four points and a source with N, whose exact image in one wall, 2
   times the direction of its normal plus its side, it is, as they are seen from there (NearImageSeen). Not
   collective. */
PETSC_EXTERN void DoubleImageAdd(DoubleImage image, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal reach,
                                 PetscReal exact[2][DIPOLE_COUNT], PetscReal lattice[2][DIPOLE_COUNT]);
PETSC_EXTERN void DoubleImageFourExact(DoubleImage image, int wall, const PetscReal N[2], const Lanes seen[3],
                                       Lanes M[4]);
