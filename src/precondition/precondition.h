/* The preconditioner of the reduced coupled problem (docs/solver.md, Preconditioner): block Jacobi of the bodies. Few
   vesicles share one dense block; many vesicles have blocks of shared shapes with a coarse grid; obstacles have a block
   of their own. It also decides how long a dense block serves before it is made again. */
#pragma once
#include "precondition/denseblocks.h"
#include "precondition/obstacleblock.h"
#include "precondition/sharedshapes.h"
#include "problem/unknowns.h"
#include "scene/scene.h"

/* The solve under way. */
typedef struct {
  PetscBool graded; /* it is of a part of a graded start */
  PetscInt applied; /* times that the preconditioner has been applied */
  PetscInt renewed; /* applications before the blocks were made anew; 0: they were not */
} Application;

typedef struct _p_Preconditioner *Preconditioner;
struct _p_Preconditioner {
  Unknowns unknowns;     /* borrowed */
  MeanMobility mobility; /* few vesicles */
  DenseBlocks blocks;    /* few vesicles */
  SharedShapes shapes;   /* many vesicles */
  ObstacleBlock solid;   /* NULL without obstacles */
  PetscReal step_ratio;  /* largest ratio of two steps that share dense blocks */
  Age age;               /* of the dense blocks; without any, of the solves */
  PetscReal *treading;   /* [vesicles] the label speeds for which the blocks were made */
  Application now;
  PetscBool flexible; /* blocks may be made anew under way */
  PetscBool failed;   /* a block could not be factored */
  PetscScalar *force; /* [2(n + w)] work */
};

/* PreconditionerCreate - for the scene; flexible: for a KSP that allows a changing preconditioner. Collective. */
PETSC_EXTERN PetscErrorCode PreconditionerCreate(Scene scene, Unknowns unknowns, PetscBool flexible,
                                                 Preconditioner *preconditioner);
PETSC_EXTERN PetscErrorCode PreconditionerDestroy(Preconditioner *preconditioner);

/* PreconditionerSetUp - follow the coupling's a0 and markers; a solve begins, graded: of a part of a graded start. The
   dense blocks are kept by their age (age.h), with a0 within step_ratio, and while I + (v/a0) d/dt of the labels'
   speeds v moves by less than 10 %; those that cost many iterations also while a0 moves by less than 2.2 within a
   graded start, and the labels' motion by less than half. A solve that needs many more iterations makes them anew and
   goes on. Collective. */
PETSC_EXTERN PetscErrorCode PreconditionerSetUp(Preconditioner preconditioner, PetscBool graded);

/* PreconditionerApply - z ~ A^-1 r, of residuals and unknowns. Collective. */
PETSC_EXTERN PetscErrorCode PreconditionerApply(Preconditioner preconditioner, Vec r, Vec z);

/* PreconditionerSolved - the solve has ended after `its` iterations. Not collective. */
PETSC_EXTERN void PreconditionerSolved(Preconditioner preconditioner, PetscInt its);

/* PreconditionerIsNew - whether the blocks were made for the last solve or in it. Not collective. */
PETSC_EXTERN PetscBool PreconditionerIsNew(Preconditioner preconditioner);

/* PreconditionerGetMemory, PreconditionerSetMemory - all that earlier solves have left for later ones, as numbers that
   a checkpoint can hold, and made again from them, with the coupling placed where and for the a0 (memory[0]; not
   positive: no blocks) and the label speeds for which the dense blocks were made, which are not among the numbers.
   Whatever is kept from solve to solve belongs in here, or a restarted run would not have the bits of one that went on.
   Set is collective. Shared shapes are all among numbers of their own (SharedShapesGetMemory). */
PETSC_EXTERN void PreconditionerGetMemory(Preconditioner preconditioner, PetscReal memory[AGE_MEMORY]);
PETSC_EXTERN PetscErrorCode PreconditionerSetMemory(Preconditioner preconditioner, const PetscReal memory[AGE_MEMORY]);
