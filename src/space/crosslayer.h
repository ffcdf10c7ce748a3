/* What vesicles do to one another: the single layer between different surfaces, by Stokeslets between points.

   The kernel is smooth there, and a grid on each of two surfaces integrates it; the nearer two surfaces are, the finer
   the grid. With ds = sqrt(area/points) the mean spacing on the grid of degree p, grids of degree

       2.5 p ds/gap,   p at least,

   leave 1e-4 to 1e-3 of the velocity. Both surfaces of a pair have the same degree, so that the matrix between their
   coefficients is the transpose of that the other way. Every rank knows all surfaces and sums for its own. */
#pragma once
#include "sphere/spheregrid.h"

/* Which vesicles a rank owns. */
typedef struct {
  MPI_Comm comm;
  PetscInt vesicles, first, own; /* number of all, first own one, number of own ones */
} VesicleShare;

/* ShareGather - all[vesicles][each] on every rank of own[own][each]; collective. ShareScatter - own[own][each] of
   all[vesicles][each]; not collective. */
PETSC_EXTERN PetscErrorCode ShareGather(const VesicleShare *share, PetscInt each, const PetscReal own[],
                                        PetscReal all[]);
PETSC_EXTERN PetscErrorCode ShareScatter(const VesicleShare *share, PetscInt each, const PetscReal all[],
                                         PetscReal own[]);

#define CROSS_LEVELS 7 /* of grids, of degree p times 1, 1.5, 2, 3, 4, 6, 9 */

/* An own vesicle beside another one. */
typedef struct {
  PetscInt own, other; /* own: number among the own vesicles; other: among all */
  PetscInt level;
} CrossPair;

typedef struct _p_CrossLayer *CrossLayer;
struct _p_CrossLayer {
  Sphere sphere; /* borrowed */
  VesicleShare share;
  PetscReal nu;
  SphereTable table[CROSS_LEVELS]; /* part[0] NULL: not made */
  PetscReal *X;                    /* [vesicles][3 count] of all */
  PetscReal *points[CROSS_LEVELS]; /* [vesicles][3][n]; NULL: no pair has this level */
  PetscInt pairs;
  CrossPair *pair; /* [own (vesicles - 1)] */
  PetscReal gap;   /* least of all; negative where surfaces overlap */
  PetscInt nearest[2];
};

PETSC_EXTERN PetscErrorCode CrossLayerCreate(Sphere sphere, VesicleShare share, PetscReal nu, CrossLayer *cross);
PETSC_EXTERN PetscErrorCode CrossLayerDestroy(CrossLayer *cross);

/* CrossLayerPlace - the own surfaces are at X[own][3 count]: gaps and grids. CrossLayerAdd - U[own][3 count] += the
   velocities by forces F[own][3 count] on the other vesicles. Collective. */
PETSC_EXTERN PetscErrorCode CrossLayerPlace(CrossLayer cross, const PetscReal X[]);
PETSC_EXTERN PetscErrorCode CrossLayerAdd(CrossLayer cross, const PetscReal F[], PetscReal U[]);
