/* Closed shapes to begin with, and what a shape amounts to: its middle, axes and spectrum. */
#pragma once
#include "sphere/surface.h"

/* ShapeSpheroid - half axes along and across the axis of revolution of a prolate spheroid of this reduced volume v =
   6 sqrt(pi) V/A^(3/2), or of an oblate one, with the volume 4 pi R^3/3; v = 1: R, R. Not collective. */
PETSC_EXTERN void ShapeSpheroid(PetscReal v, PetscBool oblate, PetscReal R, PetscReal *along, PetscReal *across);

/* ShapeCapsule - c[size], a body of revolution of this reduced volume and the volume 4 pi R^3/3: the axial coordinate
   is proportional to cos(theta), the distance from the axis to sin(theta) (1 + cos(theta)^2/2), which is flat at the
   equator. Its radius is at most 1.05 times that of a cylinder with round ends of the same area and volume where v is
   between 0.6 and 0.97. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode ShapeCapsule(Sphere revolved, PetscReal v, PetscReal R, PetscReal c[]);

/* ShapeAlign - turn c[3][count] so that what was along x is along `axis`, any length, and move it by center (NULL:
   not). Not collective. */
PETSC_EXTERN void ShapeAlign(PetscInt count, const PetscReal axis[3], const PetscReal center[3], PetscReal c[]);

/* Moments of the volume, about its middle: those of the ellipsoid with the same second moments. */
typedef struct {
  PetscReal center[3];
  PetscReal axis[3];         /* half axes, ascending */
  PetscReal direction[3][3]; /* unit vectors along them */
} ShapeMoments;

/* ShapeMeasure - where the surface has been placed. ShapeTail - of the field c[size]: the root mean square of the
   coefficients from three quarters of the degree on over that of all but the mean. Not collective. */
PETSC_EXTERN PetscErrorCode ShapeMeasure(Surface surface, ShapeMoments *moments);
PETSC_EXTERN PetscReal ShapeTail(Sphere sphere, const PetscReal c[]);

/* ShapeFit - c[3][count] of the surface nearest to n >= count points x[n][3] by least squares, for points about a
   middle that sees all of them. A point belongs to the direction in which it lies from the middle, after the map that
   makes a sphere of the ellipsoid with the surface's moments: points of an ellipsoid give this ellipsoid. spread: the
   least singular value of the harmonics at the points over the largest. off: root mean square distance of the points
   from the surface. ShapeIsStar - whether each ray from a center crosses the surface once, where it has been placed.
   Not collective. */
PETSC_EXTERN PetscErrorCode ShapeFit(Sphere sphere, PetscInt n, const PetscReal x[], PetscReal c[], PetscReal *spread,
                                     PetscReal *off);
PETSC_EXTERN PetscBool ShapeIsStar(Surface surface, const PetscReal center[3]);
