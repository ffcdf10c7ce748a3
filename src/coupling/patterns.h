/* The membranes' problems inside the coupled preconditioner for many vesicles (docs/suspensions.md, Patterns). A
   vesicle's exact mobility in unbounded fluid is that of any other of its shape, turned, moved and with its labels
   shifted. So the dense problem (denseblock.h) is inverted for a few shapes only, and each vesicle takes that of the
   shape it is nearest to, in its own frame. For quasi-steady flow: with inertia the mobility of short steps depends on
   the place in the cells. What the others and the walls do to it is patterncross.h's. Shapes are chosen alike whatever
   the ranks. */
#pragma once
#include "coupling/coarse.h"
#include "coupling/coupling.h"
#include "coupling/curvepoints.h"
#include "coupling/doublelayer.h"
#include "coupling/packedmatrix.h"
#include "coupling/pose.h"

/* A shape: its curve, and on ranks that need them the matrices of its dense problem. */
typedef struct {
  PetscInt like;      /* vesicle whose markers' number and spacing it has */
  PetscReal treading; /* label speed (1/time) */
  PetscReal *X;       /* [2n] centred */
  PetscReal size[POSE_SIZES];
  PetscInt begin, end;  /* own vesicles that take it: a range of the order */
  PackedMatrix inverse; /* 3n x 3n: (r_V, r_s) to (V, sigma); without values: not made */
  PackedMatrix sources; /* 2n x 3n: to their forces F; with viscosity contrast 4n x 3n, to F and their jumps J */
  PetscReal *self;      /* [2q][2q]: forces at q coarse points to what they do to the vesicle itself there, times -1 */
  PetscInt weights;     /* which */
  PetscReal *points;    /* [2q] where they are */
} Pattern;

/* What membranes do to the fluid: forces F and, with viscosity contrast (else NULL), jumps J, [2n] of own vesicles. */
typedef struct {
  PetscScalar *force, *jump;
} PatternSources;

typedef struct _p_PatternCross *PatternCross; /* patterncross.h */
typedef struct _p_Patterns *Patterns;
struct _p_Patterns {
  Coupling coupling; /* borrowed */
  Coarse coarse;     /* NULL where no coarse cells fit */
  PetscReal a0;      /* that the matrices are for; 0: none yet */
  PetscInt count, room;
  Pattern *pattern;
  CurvePoints *weights; /* between n markers and q coarse points, one for each n and q */
  PetscInt kinds;
  PetscInt *of;         /* [vesicles] pattern of each, -1: none yet */
  PetscInt *order;      /* [own vesicles] by pattern */
  Pose *pose;           /* [own vesicles] in its pattern's frame */
  PetscReal *X;         /* [2 most markers of a vesicle] work */
  PetscReal *from, *to; /* columns of own vesicles: work */
  PatternSources alone; /* work */
  PatternCross cross;   /* NULL without coarse grid */
};

/* PatternsCreate - for the coupling's membranes, which have a near field, in the quasi-steady fluid that spec makes.
   Collective. */
PETSC_EXTERN PetscErrorCode PatternsCreate(const FluidSpec *spec, Coupling coupling, Patterns *patterns);
PETSC_EXTERN PetscErrorCode PatternsDestroy(Patterns *patterns);

/* PatternsFollow - a pattern for each vesicle where the coupling has been placed: its last one while that is within the
   tolerance, else the nearest, else a new one, of its own shape. All matrices are made anew where a0 has moved by more
   than 10 %. failed, on every rank, when a matrix is singular. Collective. */
PETSC_EXTERN PetscErrorCode PatternsFollow(Patterns patterns, PetscBool *failed);

/* PatternsSolve - from the own U[2n] and sigma[n] = r_s: V and sigma of each vesicle's dense problem, corrected by what
   the others and the walls do to it. Collective. */
PETSC_EXTERN PetscErrorCode PatternsSolve(Patterns patterns, PetscScalar U[], PetscScalar sigma[]);

/* PatternsGetMemory, PatternsSetMemory - the patterns as PatternsMemorySize numbers for a checkpoint, the same on every
   rank, and again from them; valid is false when they are not of these vesicles. Not collective. */
static inline PetscInt PatternsMemorySize(Layout layout) {
  return 1 + 2 * layout->M + 3 * layout->bodies;
}
PETSC_EXTERN void PatternsGetMemory(Patterns patterns, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode PatternsSetMemory(Patterns patterns, const PetscReal memory[], PetscBool *valid);
