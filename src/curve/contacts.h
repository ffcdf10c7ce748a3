/* How near curves are to one another, images of themselves among them, by a list of cells, in a time in proportion to
   their points. A curve's inside is on its left: closed curves run counter-clockwise, one that runs clockwise has its
   inside outside. */
#pragma once
#include "curve/kind.h"

/* A point and the edge of another curve that is nearest to it. Distances are negative for a point inside. */
typedef struct {
  PetscInt point, edge[2]; /* the edge's two ends */
  PetscInt curve[2];       /* the point's and the edge's; the same twice: the edge is of an image */
  PetscReal at;            /* where on the edge: weight `at` of its second end, 1 - at of its first */
  PetscReal distance;      /* length */
  PetscReal normal[2];     /* unit, from the edge to the outside of its curve: point = edge + distance normal */
} CurveContact;

/* CurveContacts - for each point, in order, and each other curve that has an edge nearer than reach (length) the
   nearest edge; contacts[n] is the caller's to free (PetscFree). Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveContacts(const CurveSet *set, PetscReal reach, PetscInt *n, CurveContact **contacts);

/* The least distance of two curves, negative where a point of one is inside of the other. */
typedef struct {
  PetscInt curve[2]; /* the first not above the second; the same twice: of a curve and its image */
  PetscReal distance;
} CurveGap;

/* CurveGaps - of every two curves nearer than reach, in order; gaps[n] is the caller's to free. Of smooth curves what
   is nearer than half an edge is found at eight times the points. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveGaps(const CurveSet *set, PetscReal reach, PetscInt *n, CurveGap **gaps);

/* CurveLeastGap - the least of all distances, of any size; not a number where nothing is within half a period, or where
   one curve is alone. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveLeastGap(const CurveSet *set, PetscReal *distance);

/* Where curves lie: walls at the sides of the box in the directions that have them, images in those with a period. */
typedef struct {
  PetscReal box[4]; /* x_min, x_max, y_min, y_max */
  PetscReal period[2];
  PetscBool wall[2];
} CurveRoom;

/* CurveWallGap - least distance of n points X[2n] from a wall, the one at box[side]; PETSC_MAX_REAL, side -1: none. Not
   collective. */
PETSC_EXTERN PetscReal CurveWallGap(PetscInt n, const PetscReal X[], const CurveRoom *room, PetscInt *side);

/* A film of fluid: between two curves, a curve and its own image (the same twice), or a curve and a wall. */
typedef struct {
  PetscReal thickness; /* length */
  PetscReal spacings;  /* the same over the larger of both curves' point spacings */
  PetscInt pair[2];    /* the curves; -1 - side for a wall */
} CurveFilm;

/* CurveThinnestFilm - the film that is thinnest against the points, which are ds[v] apart (length) on curve v, of those
   thinner than `most` spacings; spacings is `most` where there is none. Distances are those of CurveGaps and
   CurveWallGap; curves that overlap have no film. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveThinnestFilm(const CurveSet *set, const PetscReal ds[], const CurveRoom *room,
                                              PetscReal most, CurveFilm *film);
