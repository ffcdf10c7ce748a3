/* The fluid between closed curves that are close, and between curves and walls. */
#pragma once
#include "base/base.h"

/* A film: between two curves, a curve and its own periodic image (the same twice), or a curve and a wall. */
typedef struct {
  PetscReal spacings; /* its thickness over the larger of both curves' point spacings */
  PetscReal gap;      /* its thickness (length) */
  PetscInt pair[2];   /* the curves; the second one is -1 - 2 direction - side for a wall */
} Film;

/* CurvesFilm - the film that is thinnest against the points, of those thinner than `most` spacings; spacings is `most`
   if there is none. Curve v has the points start[v] .. start[v+1]-1 of X, interlaced, ds[v] apart (length); a period of
   0 is none; walls are at box[4] = x_min, x_max, y_min, y_max in the directions that have them. Thickness is that
   between points and the other curve's polygon: too large by ds^2/8 over the radius of curvature. In a time in
   proportion to the points. Not collective. */
PETSC_EXTERN PetscErrorCode CurvesFilm(PetscInt curves, const PetscInt start[], const PetscReal X[],
                                       const PetscReal ds[], const PetscReal period[2], const PetscReal box[4],
                                       const PetscBool wall[2], PetscReal most, Film *film);
