/* Distances of curves from one another, from images, from other parts of themselves and from walls.

   Points are sorted into a list of cells, and each is compared with the edges at points within reach, so that the time
   is in proportion to the number of points. The inside of a curve is on its left: a closed curve runs
   counter-clockwise, and one that runs clockwise has its inside outside. Distances are negative inside. Ranks share a
   search by CurveSet.part; no function sends a message. */
#pragma once
#include "curve/kind.h"

/* What lies between a point and an edge: fluid between two curves or a curve and an image, or fluid inside or outside
   one curve whose parts are near. */
typedef enum { CONTACT_BETWEEN, CONTACT_INSIDE, CONTACT_OUTSIDE } ContactType;

/* A point and the edge of a curve that is nearest to the point. */
typedef struct {
  PetscInt point, edge[2]; /* numbers of the point and of the ends of the edge */
  PetscInt curve[2];       /* curve of the point, curve of the edge */
  ContactType type;
  PetscReal at;        /* nearest place on the edge: weight `at` of its second end, 1 - at of its first */
  PetscReal distance;  /* length; negative: the point is inside another curve */
  PetscReal normal[2]; /* unit, from the edge to the outside of another curve or into the fluid between two parts of one
                          curve: point = edge + distance normal */
} CurveContact;

/* CurveContacts - for each point, in order, and each other curve with an edge nearer than reach (length) the nearest
   edge; on the first `soft` curves, of point spacings ds[soft], also the nearest edges of the point's own curve across
   the inside and across the outside, of those that are twice the reach from the point along the curve. The caller frees
   contacts[n] (PetscFree). Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveContacts(const CurveSet *set, PetscReal reach, PetscInt soft, const PetscReal ds[],
                                          PetscInt *n, CurveContact **contacts);

/* The least distance of two curves; negative where a point of one is inside the other. */
typedef struct {
  PetscInt curve[2]; /* the first is not above the second; the same one twice: a curve and its image */
  PetscReal distance;
} CurveGap;

/* CurveGaps - the gaps of all pairs of curves nearer than reach, in order. Where smooth curves are nearer than half an
   edge the gap is found at eight times as many points. The caller frees gaps[n] (PetscFree). Not collective. Errors:
   memory. */
PETSC_EXTERN PetscErrorCode CurveGaps(const CurveSet *set, PetscReal reach, PetscInt *n, CurveGap **gaps);

/* CurveLeastGap - the least of all distances; NaN where no curve is within half a period of another one or of an image,
   or where there is one curve without images. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveLeastGap(const CurveSet *set, PetscReal *distance);

/* The box that curves lie in. */
typedef struct {
  PetscReal box[4];    /* x_min, x_max, y_min, y_max */
  PetscReal period[2]; /* 0: none */
  PetscBool wall[2];   /* walls at both sides in x, in y */
} CurveRoom;

/* CurveWallGap - least distance of n points X[2n] from a wall, which is the one at box[side]; PETSC_MAX_REAL and side
   -1 where there are no walls. Not collective. */
PETSC_EXTERN PetscReal CurveWallGap(PetscInt n, const PetscReal X[], const CurveRoom *room, PetscInt *side);

/* A film of fluid between two curves, a curve and its own image, or a curve and a wall. */
typedef struct {
  PetscReal thickness; /* length */
  PetscReal spacings;  /* thickness over the point spacing, the larger one of two curves */
  PetscInt pair[2];    /* the curves, the same one twice for an image; the second is -1 - side for a wall */
} CurveFilm;

/* CurveThinnestFilm - the film with the fewest spacings, of those with less than `most`; film.spacings is `most` where
   there is none. ds[v]: spacing of the points of curve v (length). Distances are those of CurveGaps and CurveWallGap;
   curves that overlap have no film. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveThinnestFilm(const CurveSet *set, const PetscReal ds[], const CurveRoom *room,
                                              PetscReal most, CurveFilm *film);
