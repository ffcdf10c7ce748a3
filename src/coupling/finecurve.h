/* A curve at more points than its markers, by an interpolation P from n markers to f n points (curve/kind.h),
   trigonometric where the curve repeats. A matrix K between two curves becomes P_a^T K_fine P_b/(f_a f_b): symmetric
   under exchange of the curves where K is. */
#pragma once
#include "coupling/nearfield.h"

typedef struct {
  const CurveKind *kind; /* borrowed */
  PetscInt n, f;         /* markers, factor */
  PetscReal *weight;     /* closed and spanning: [f n] P by index difference: P_qk = weight[(q - f k) mod f n] */
  PetscReal *x;          /* [f n][2] the points (length) */
  PetscReal edge;        /* the longest distance from one point to the next */
  PetscInt *used;        /* [count] points in use */
  PetscInt count;
  PetscReal *P; /* [n][count] rows of P/f that are in use, columns one after another */
} FineCurve;

/* FineCurveCreate - of a body moved by shift (length). FineCurveReflect - its points mirrored at a wall whose normal
   is in `direction`. Not collective. */
PETSC_EXTERN PetscErrorCode FineCurveCreate(NearField near, PetscInt body, const PetscReal shift[2], PetscInt factor,
                                            FineCurve *curve);
PETSC_EXTERN PetscErrorCode FineCurveDestroy(FineCurve *curve);
PETSC_EXTERN void FineCurveReflect(FineCurve *curve, int direction, PetscReal wall);

/* FineCurveGap - least distance of the points of two curves. */
PETSC_EXTERN PetscReal FineCurveGap(const FineCurve *a, const FineCurve *b);

/* FineCurvePair - the two curves' points that lie within the window (length) of one another come into use. */
PETSC_EXTERN PetscErrorCode FineCurvePair(FineCurve *a, FineCurve *b, PetscReal window);

/* FineWindow - 1 up to a third of the window, smoothly to 0 at its end. */
static inline PetscReal FineWindow(PetscReal distance, PetscReal window) {
  const PetscReal t = PetscMin(1, PetscMax(0, (distance / window - 1. / 3) * 1.5));
  return 1 - t * t * (3 - 2 * t);
}

/* FineCurveProject - part[n_b][n_a] = P_a^T K P_b, columns of a block one after another, for K[count_b][count_a] of the
   points in use. Not collective. */
PETSC_EXTERN PetscErrorCode FineCurveProject(const FineCurve *a, const FineCurve *b, const PetscReal K[],
                                             PetscReal part[]);
