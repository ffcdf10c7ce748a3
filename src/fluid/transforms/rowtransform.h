/* Real transforms along one grid row that diagonalise the second difference in x. All are made of FFTW's
   real-to-complex transforms, of the row's own length or shorter, because those use vector instructions and FFTW's sine
   and cosine transforms do not.

     periodic                 real Fourier transform
     wall half a cell off     cosines (p) or sines (v): the row reordered, a Fourier transform, each mode times a phase
     wall on an entry (u)     sines: the odd wave numbers by a half-sample sine transform of half the length, the even
                              ones by a transform of the same kind and half the length, and so on down

   Modes come in an order of the transform's own, and lambda is in that order, unless they are sorted. rowtransform.c
   has the formulas. */
#pragma once
#include "fluid/grid/grid.h"
#include <fftw3.h>

#define ROW_LEVELS 24 /* halvings of a row, at most: 4 2^24 cells */

/* One real-to-complex transform and its inverse. */
typedef struct {
  PetscInt n, half; /* length, and number of complex modes, n/2 + 1 */
  double *twist;    /* [2 half] e^{-i pi k/2n}; NULL where modes are used as they are */
  fftw_plan forward, backward;
} Fourier;

typedef struct _p_RowTransform *RowTransform;
struct _p_RowTransform {
  PetscInt n, width; /* entries of a row, and of its transform */
  PetscReal *lambda; /* [width] minus the eigenvalues of the second difference times h^2: 4 sin^2 */
  PetscReal *scale;  /* [width] what makes backward(scale forward) the identity */
  double *modes;     /* [width] what Forward makes and Backward takes */
  double *line;      /* work, the other end of the Fourier transforms */
  PetscReal sign;    /* 1 cosines, -1 sines of half samples, 0 others */
  PetscInt levels;   /* sines on the entries: halvings */
  Fourier f[ROW_LEVELS];
  PetscInt base;    /* sines on the entries: cells left after the halvings, base - 1 entries; 0: another kind */
  double *rest;     /* [n] work: the row, then what the halvings leave of it */
  PetscInt *order;  /* [width] where a mode is among those of the transforms; NULL: they are as they come */
  double *unsorted; /* [width] then these */
  fftw_plan base_forward, base_backward;
};

/* RowTransformCreate - for a field of the grid. Not collective. */
PETSC_EXTERN PetscErrorCode RowTransformCreate(Grid grid, Field field, RowTransform *t);
PETSC_EXTERN PetscErrorCode RowTransformDestroy(RowTransform *t);

/* RowTransformSort - from here on modes come by their wave numbers. Not collective. */
PETSC_EXTERN PetscErrorCode RowTransformSort(RowTransform t);

/* RowTransformForward - modes[width] of x[n]. RowTransformBackward - x[n] from modes[width], which are destroyed. Not
   collective. */
PETSC_EXTERN void RowTransformForward(RowTransform t, const PetscScalar x[]);
PETSC_EXTERN void RowTransformBackward(RowTransform t, PetscScalar x[]);

/* RowTransformNorms - norm[width]: the sum of squares of the row that Backward makes of a 1 in each mode, periodic or
   of sorted modes with walls on the entries. RowTransformEnds - of the latter first[width], last[width]: what Forward
   makes of a 1 in the first entry, and in the last, to rounding each. Not collective. */
PETSC_EXTERN PetscErrorCode RowTransformNorms(RowTransform t, PetscReal norm[]);
PETSC_EXTERN PetscErrorCode RowTransformEnds(RowTransform t, PetscReal first[], PetscReal last[]);
