/* Real transforms along one grid row that diagonalise the second difference in x, by FFTW's vectorised
   real-to-complex transforms of the row's own length or shorter (its real-to-real ones are scalar code).

     periodic                 real Fourier transform
     wall half a cell off     cosines (c = 1) or sines (c = -1) of half samples, by Makhoul's reordering: even entries
                              up, odd entries down again, a Fourier transform, a twist by e^{-i pi k/2n}
     wall on an entry (c = 0) sines: odd wave numbers are the transpose of a half-sample sine transform of half the
                              length, even ones a transform of the same kind and half the length, and so on down

   Modes come in an order of the transform's own, which lambda follows. */
#pragma once
#include "fluid/grid.h"
#include <fftw3.h>

#define ROW_LEVELS 24

typedef struct {
  PetscInt n, half; /* length, and complex modes of its Fourier transform */
  double *twist;    /* [2 half] e^{-i pi k/2n}; NULL without */
  fftw_plan forward, backward;
} Fourier;

typedef struct _p_RowTransform *RowTransform;
struct _p_RowTransform {
  PetscInt n, width; /* entries of a row, and of its transform */
  PetscReal *lambda; /* [width] minus the eigenvalues of the second difference times h^2: 4 sin^2 */
  PetscReal *scale;  /* [width] what makes backward(scale forward) the identity */
  double *modes;     /* [width] where a transform comes from or goes to */
  double *line;      /* work */
  PetscReal sign;    /* 1 cosines, -1 sines of half samples, 0 others */
  PetscInt levels;   /* sines on the entries: halvings */
  Fourier f[ROW_LEVELS];
  PetscInt base; /* cells left after them, base - 1 entries; 0: not this kind */
  double *rest;  /* [n] work */
  fftw_plan base_forward, base_backward;
};

/* RowTransformCreate - for a field of the grid; plan: FFTW's flags. Not collective. */
PETSC_EXTERN PetscErrorCode RowTransformCreate(Grid grid, Field field, unsigned plan, RowTransform *t);
PETSC_EXTERN PetscErrorCode RowTransformDestroy(RowTransform *t);

/* RowTransformForward - modes[width] of x[n]. RowTransformBackward - x[n] from modes[width], which are destroyed. */
PETSC_EXTERN void RowTransformForward(RowTransform t, const PetscScalar x[]);
PETSC_EXTERN void RowTransformBackward(RowTransform t, PetscScalar x[]);
