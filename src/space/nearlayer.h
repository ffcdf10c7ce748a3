/* The single and the double layer between two near surfaces, on grids that are fine only where the surfaces face one
   another. At the distance d from its source the Stokeslet, of viscosity 1, makes of a force f, and the stresslet of a
   velocity f on an area with the normal n,

       G f = a f + b d (d.f),                                        a = 1/(8 pi r),  b = 1/(8 pi r^3),
       D f = a (f (d.n) + n (d.f) + d (f.n)) + b d (d.f) (d.n),      a = 0,           b = -3/(4 pi r^5).

   Hasimoto's splitting writes the Stokeslet as a smooth part and a short one of width delta,

       8 pi L(delta) = (erfc(r/delta)/r) (I + d d/r^2) - (2/(delta root pi)) exp(-(r/delta)^2) (I - d d/r^2),

   so that, with widths delta_k = delta_0/2^k and L(delta_n) nothing over the gap of the surfaces,

       G = [G - L(delta_0)] + SUM_(k = 1..n) [L(delta_(k-1)) - L(delta_k)].

   The stresslet of a flow a, b without divergence has the factors -3b - r b_r and 2 b_r/r, b_r the slope of b: so D has
   such parts too, and they are as smooth. A term in brackets is as smooth as its smallest width, and all but G itself
   are short. The first one is summed on the grids of degree p, G by CrossLayerAdd and -L(delta_0) here; the k-th on
   grids 2^k times as fine, whose points are made only where the other surface is in reach. A grid of degree q has q + 1
   = 2^k (p + 1) latitudes, so that each of its points lies in a cell of the grid before, and near the poles it has
   fewer longitudes. */
#pragma once
#include "sphere/spheregrid.h"

#define NEAR_LEVELS 9

/* What is between two points. */
typedef enum { STOKESLET, STRESSLET, NEAR_KERNELS } NearKernel;

/* Some points of a grid on a surface. */
typedef struct {
  PetscInt n, *point;  /* [n] their numbers in the grid */
  SphereTable table;   /* of these points */
  PetscReal *X;        /* [3][n] */
  PetscReal *normal;   /* [3][n] n dA/domega, of stresslets */
  PetscReal *distance; /* [n] to the other patch */
} NearPatch;

/* A pair of points, i of the first surface and j of the second, and the factors of a kernel. */
typedef struct {
  PetscInt i, j;
  PetscReal a, b;
} NearEntry;

typedef struct {
  NearPatch patch[2];
  PetscReal reach; /* entries are the pairs of points nearer than this */
  PetscInt entries;
  NearEntry *entry[NEAR_KERNELS]; /* [entries] of each kernel; NULL: not made */
} NearLevel;

typedef struct _p_NearPair *NearPair;
struct _p_NearPair {
  Sphere sphere; /* borrowed */
  PetscInt levels;
  NearLevel level[NEAR_LEVELS];
};

/* What all near pairs of a degree share. */
typedef struct {
  PetscInt kernels;             /* that pairs have: the Stokeslet, or both */
  SphereGrid grid[NEAR_LEVELS]; /* n 0: not made */
  /* 8 pi r a and 8 pi r^3 b of L(1), at equal distances r; r^2 times as much of its stresslet */
  PetscReal *isotropic[NEAR_KERNELS], *along[NEAR_KERNELS];
} NearTables;

/* NearTablesCreate - of a degree; grids are made where they are first needed. Not collective. */
PETSC_EXTERN PetscErrorCode NearTablesCreate(PetscInt kernels, NearTables *tables);
PETSC_EXTERN PetscErrorCode NearTablesDestroy(NearTables *tables);

/* NearReach - surfaces farther apart than this have nothing short between them; spacing: the largest distance of
   neighbouring points of the grids of degree p. Not collective. */
PETSC_EXTERN PetscReal NearReach(PetscReal spacing);

/* NearPairCreate - of the surfaces c1[3][count] and c2[3][count].
   NearEntryDistance - of the two points. NearPairAdd - U[side][3][count] += the velocities by the forces or velocities
   F[side][3][count] on the other surface; U[side] NULL: not wanted. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode NearPairCreate(Sphere sphere, NearTables *tables, PetscReal spacing, const PetscReal c1[],
                                           const PetscReal c2[], NearPair *pair);
PETSC_EXTERN PetscReal NearEntryDistance(const NearLevel *level, const NearEntry *entry);
PETSC_EXTERN PetscErrorCode NearPairDestroy(NearPair *pair);
PETSC_EXTERN PetscErrorCode NearPairAdd(NearPair pair, NearKernel kernel, const PetscReal *const F[2],
                                        PetscReal *const U[2]);
