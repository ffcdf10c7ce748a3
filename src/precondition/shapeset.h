/* The shared shapes of vesicles and what the preconditioner keeps for them (sharedshapes.h): the matrices of one shape,
   and their products with the columns of all own vesicles that take it, each in the shape's frame. */
#pragma once
#include "precondition/coarsegrid.h"
#include "problem/coupling.h"
#include "precondition/curvepoints.h"
#include "numerics/rigidfit.h"

/* A shape: its curve, and on ranks that need them the matrices of its dense problem. */
typedef struct {
  PetscInt like;      /* vesicle whose markers' number and spacing it has */
  PetscReal treading; /* label speed (1/time) */
  PetscReal *X;       /* [2n] centred */
  PetscReal size[RIGIDFIT_SIZES];
  PetscInt begin, end; /* own vesicles that take it: a range of the order */
  PetscReal *inverse;  /* 3n x 3n: (r_V, r_s) to (V, sigma); NULL: not made */
  PetscReal *sources;  /* rows x 3n: to their forces F or, with viscosity contrast, to F and their jumps J */
  PetscInt rows;       /* of sources: 2n, or 4n */
  PetscReal *self;     /* [2q][2q]: forces at q coarse points to what they do to the vesicle itself there, times -1 */
  CurvePoints curve;   /* its coarse points */
  PetscReal *points;   /* [2q] their places */
} SharedShape;

/* What membranes do to the fluid: forces F and, with viscosity contrast (else NULL), jumps J, [2n] of own vesicles. */
typedef struct {
  PetscScalar *force, *jump;
} ShapeSources;

typedef struct _p_Interactions *Interactions; /* interactions.h */
typedef struct _p_SharedShapes *SharedShapes;
struct _p_SharedShapes {
  Coupling coupling; /* borrowed */
  CoarseGrid coarse; /* NULL where no coarse cells fit */
  PetscReal a0;      /* of the time step that the matrices are for; 0: none yet */
  PetscInt count;
  size_t room;
  SharedShape *shape;
  PetscInt *of;         /* [vesicles] shape of each, -1: none yet */
  PetscInt *order;      /* [own vesicles] by shape */
  RigidFit *fit;        /* [own vesicles] in its shape's frame */
  PetscReal *X;         /* [2 most markers of a vesicle] work */
  PetscReal *from, *to; /* columns of own vesicles: work */
  Interactions cross;   /* NULL without coarse grid */
};

/* SharedShapeMake - inverse, forces, and with a coarse grid self, weight and points, for the shapes' a0 and tables.
   good is false when a matrix is singular. Not collective. */
PETSC_EXTERN PetscErrorCode SharedShapeMake(SharedShapes shapes, SharedShape *shape, PetscBool *good);

/* SharedShapeSources - the sources of the answers of each vesicle's dense problem to its own parts of U[2n] and
   sigma[n] = r_s; sigma NULL: 0. SharedShapeSolve - U and sigma become these answers, V and sigma. Entries of vesicles
   of other shapes stay as they are. Not collective. */
PETSC_EXTERN PetscErrorCode SharedShapeSources(SharedShapes shapes, const SharedShape *shape, const PetscScalar U[],
                                               const PetscScalar sigma[], const ShapeSources *sources);
PETSC_EXTERN PetscErrorCode SharedShapeSolve(SharedShapes shapes, const SharedShape *shape, PetscScalar U[],
                                             PetscScalar sigma[]);
