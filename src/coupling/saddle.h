/* The coupled problem of one time step (DESIGN section 7), solved for velocity, pressure and tension together:
       [ H + B E/a0   G   S ] [u]       [ f  ]
       [ G^T          0   0 ] [p]     = [ -bc2 ]
       [ S^T          0   0 ] [sigma]   [ g  ]
   FGMRES under the prefix coupled_, row k of the third block scaled by SaddleScale. The
   preconditioner is two Stokes solves around a small Lagrangian solve. */
#pragma once
#include "coupling/dense.h"
#include "coupling/lagrangian.h"
#include "fluid/stokes.h"

typedef enum { MOBILITY_TABLE, MOBILITY_ILU, MOBILITY_NONE } MobilityType;

typedef struct _p_Saddle *Saddle;
struct _p_Saddle {
  Fluid fluid;       /* borrowed */
  Coupling coupling; /* borrowed; NULL without vesicles */
  Stokes stokes;
  MobilityType type;
  Mobility mobility;  /* table */
  DenseBlocks blocks; /* table */
  SelfMobility self;  /* borrowed; NULL without */
  PC ilu;             /* ilu: of the assembled Chat */
  Mat Chat;
  Mat A;
  KSP ksp;
  Vec x, b;              /* local part: velocity, pressure, and on rank 0 the tension */
  Vec w[2], p[2];        /* vectors without memory over parts of a block vector */
  Vec r, u1, p1;         /* work */
  Vec U, F, sigma, r_s;  /* work on markers and tensions */
  PetscReal factored_a0; /* of the dense blocks; 0: none yet */
  PetscInt fresh_its;    /* iterations right after they were made; -1: not known yet */
  PetscInt age, life;    /* solves that they have served, and will at most */
  PetscInt refreshed;    /* times that they were made */
  PetscInt its;
  KSPConvergedReason why;
  PetscReal residual;
};

/* SaddleCreate - for the scene's mobility type; self (NULL: none) corrects the markers' velocity. Collective. */
PETSC_EXTERN PetscErrorCode SaddleCreate(Scene scene, Fluid fluid, Coupling coupling, SelfMobility self,
                                         Saddle *saddle);
PETSC_EXTERN PetscErrorCode SaddleDestroy(Saddle *saddle);

/* SaddleSetUp - follow the fluid's a0 and the coupling's markers. The dense blocks are kept while a0 moves by less than
   10 % and iterations stay low: a solve that takes 2 more than the first one did makes them again and goes on from
   where it is. Collective. */
PETSC_EXTERN PetscErrorCode SaddleSetUp(Saddle saddle);

/* SaddleSolve - solve for w, p, sigma, which hold the initial guess; f and g the right-hand sides. its, why, residual
   say how it went. Collective. */
PETSC_EXTERN PetscErrorCode SaddleSolve(Saddle saddle, Vec f, Vec g, Vec w, Vec p, Vec sigma);

/* SaddleScale - factor of the third block's row k: h^2/ds makes it a surface divergence; 1 + h alpha weighs short
   steps, where the momentum's right-hand side u alpha would hide it. */
PETSC_EXTERN PetscReal SaddleScale(Saddle saddle, PetscInt k);

/* SaddlePrecondition (precondition.c) - PCSHELL's apply. */
PETSC_EXTERN PetscErrorCode SaddlePrecondition(PC pc, Vec r, Vec z);

/* A block vector taken apart: velocity and pressure share its memory, the tension is a copy that all ranks hold. */
PETSC_EXTERN PetscErrorCode SaddleSplit(Saddle saddle, int slot, PetscScalar block[], Vec sigma);
PETSC_EXTERN PetscErrorCode SaddleJoin(Saddle saddle, int slot, PetscScalar block[], Vec sigma);
