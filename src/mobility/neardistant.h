/* C of two closed obstacles that rest far from one another. It is smooth along both, so a few polynomials of the place
   on each curve hold it (docs/nearfield.md, Distant obstacles):

       C ~ P_v B P_w^T,     B = P_v^T C P_w,

   P orthonormal polynomials of a degree of at most 7 at the markers, which are 15 on a circle, in each of the two
   components. A rank has the pairs of its own bodies; a product reads the forces of all, which the caller has gathered.

   Add all pairs, Make, Fill each from its C, then Apply. */
#pragma once
#include "base/lanes.h"
#include "markers/layout.h"

/* The polynomials of a curve. */
typedef struct {
  PetscInt stride; /* numbers of two components, whole vectors: x of all polynomials, y of all, zeros */
  PetscReal *P;    /* [stride][2n]; NULL: not made yet */
} NearFunctions;

/* B of an own curve and one far from it, [stride of the row][stride of the column] in single precision. */
typedef struct {
  PetscInt row, column;
  PetscReal shift[2];
  size_t at;
} NearDistantPair;

typedef struct _p_NearDistant *NearDistant;
struct _p_NearDistant {
  Layout layout;           /* borrowed, of all bodies */
  NearFunctions *function; /* [bodies] */
  NearDistantPair *pair;
  PetscInt pairs;
  size_t room;
  float *value;
  size_t values;
  PetscInt *start;               /* [bodies + 1] first number of each body */
  PetscReal *amplitude, *answer; /* [numbers] of forces, of velocities: work */
};

PETSC_EXTERN PetscErrorCode NearDistantCreate(Layout layout, NearDistant *distant);
PETSC_EXTERN PetscErrorCode NearDistantDestroy(NearDistant *distant);

/* NearDistantAdd - the pair of own body v and body w moved by shift, where fewer numbers do than their C has; X[2M]
   markers of all bodies. Not collective. */
PETSC_EXTERN PetscErrorCode NearDistantAdd(NearDistant distant, const PetscReal X[], PetscInt v, PetscInt w,
                                           const PetscReal shift[2], PetscBool *added);

/* NearDistantMake - room for the values of all pairs. NearDistantFill - B of a pair from its C, C[2 n_row][stride] with
   rows and columns interlaced. NearDistantExpand - and back. Not collective. */
PETSC_EXTERN PetscErrorCode NearDistantMake(NearDistant distant);
PETSC_EXTERN PetscErrorCode NearDistantFill(NearDistant distant, PetscInt pair, PetscInt stride, const PetscReal C[]);
PETSC_EXTERN PetscErrorCode NearDistantExpand(NearDistant distant, PetscInt pair, PetscInt stride, PetscReal C[]);

/* NearDistantApply - velocity[2n] of own markers += alpha C force[2M] of all pairs. Not collective. */
PETSC_EXTERN PetscErrorCode NearDistantApply(NearDistant distant, PetscReal alpha, const PetscScalar force[],
                                             PetscScalar velocity[]);
