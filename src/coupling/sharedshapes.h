/* The membranes' problems inside the coupled preconditioner for many vesicles (docs/suspensions.md, Shared shapes). A
   vesicle's exact mobility in unbounded fluid is that of any other of its shape, turned, moved and with its labels
   shifted. So the dense problem (denseblock.h) is inverted for a few shapes only, and each vesicle takes that of the
   shape it is nearest to, in its own frame. For quasi-steady flow: with inertia the mobility of short steps depends on
   the place in the cells. What the others and the walls do to it is interactions.h's. Shapes are chosen alike whatever
   the ranks. */
#pragma once
#include "coupling/coarsegrid.h"
#include "coupling/coupling.h"
#include "coupling/curvepoints.h"
#include "coupling/doublelayer.h"
#include "coupling/packedmatrix.h"
#include "coupling/rigidfit.h"

/* A shape: its curve, and on ranks that need them the matrices of its dense problem. */
typedef struct {
  PetscInt like;      /* vesicle whose markers' number and spacing it has */
  PetscReal treading; /* label speed (1/time) */
  PetscReal *X;       /* [2n] centred */
  PetscReal size[RIGIDFIT_SIZES];
  PetscInt begin, end;  /* own vesicles that take it: a range of the order */
  PackedMatrix inverse; /* 3n x 3n: (r_V, r_s) to (V, sigma); without values: not made */
  PackedMatrix sources; /* 2n x 3n: to their forces F; with viscosity contrast 4n x 3n, to F and their jumps J */
  PetscReal *self;      /* [2q][2q]: forces at q coarse points to what they do to the vesicle itself there, times -1 */
  PetscInt weights;     /* which */
  PetscReal *points;    /* [2q] where they are */
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
  PetscReal a0;      /* that the matrices are for; 0: none yet */
  PetscInt count;
  size_t room;
  SharedShape *shape;
  CurvePoints *weights; /* between n markers and q coarse points, one for each n and q */
  PetscInt kinds;
  PetscInt *of;         /* [vesicles] shape of each, -1: none yet */
  PetscInt *order;      /* [own vesicles] by shape */
  RigidFit *fit;        /* [own vesicles] in its shape's frame */
  PetscReal *X;         /* [2 most markers of a vesicle] work */
  PetscReal *from, *to; /* columns of own vesicles: work */
  ShapeSources alone;   /* work */
  Interactions cross;   /* NULL without coarse grid */
};

/* SharedShapesCreate - for the coupling's membranes, which have a near field, in the quasi-steady fluid that spec
   makes. Collective. */
PETSC_EXTERN PetscErrorCode SharedShapesCreate(const FluidSpec *spec, Coupling coupling, SharedShapes *shapes);
PETSC_EXTERN PetscErrorCode SharedShapesDestroy(SharedShapes *shapes);

/* SharedShapesFollow - a shape for each vesicle where the coupling has been placed: its last one while that is within
   the tolerance, else the nearest, else a new one, of its own shape. All matrices are made anew where a0 has moved by
   more than 10 %. failed, on every rank, when a matrix is singular. Collective. */
PETSC_EXTERN PetscErrorCode SharedShapesFollow(SharedShapes shapes, PetscBool *failed);

/* SharedShapesSolve - from the own U[2n] and sigma[n] = r_s: V and sigma of each vesicle's dense problem, corrected by
   what the others and the walls do to it. Collective. */
PETSC_EXTERN PetscErrorCode SharedShapesSolve(SharedShapes shapes, PetscScalar U[], PetscScalar sigma[]);

/* SharedShapesGetMemory, SharedShapesSetMemory - the shapes as SharedShapesMemorySize numbers for a checkpoint, the
   same on every rank, and again from them; valid is false when they are not of these vesicles. Not collective. */
static inline PetscInt SharedShapesMemorySize(Layout layout) {
  return 1 + 2 * layout->M + 3 * layout->bodies;
}
PETSC_EXTERN void SharedShapesGetMemory(SharedShapes shapes, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode SharedShapesSetMemory(SharedShapes shapes, const PetscReal memory[], PetscBool *valid);
