/* The coupled problem of one time step (DESIGN section 7), solved for velocity, pressure and tension together:
       [ H + B R E/a0   G   S ] [u]       [ f    ]
       [ G^T            0   0 ] [p]     = [ -bc2 ]       V = R (E u - Theta Dm^T sigma), R = 1, Theta = 0 without
       [                      ]           [      ]       self-mobility;  S^T u = g reads Dm V/h^2 = g
   A Stokes solve gives u and p for any force, so the unknowns are V, sigma, and forces d on the faces next to walls,
   where the projection is not exact: with F = Dm^T sigma + (c_b ds/a0) D4 V
       (u, p) = Stokes(f - E^T F/h^2 + d, -bc2)
       V - E u + Theta F = 0,    Dm V/h^2 = g,    d + (what the projection leaves at the walls) = 0
   They are few, every rank holds them all, and an iteration costs one Stokes solve. FGMRES under the prefix coupled_;
   the preconditioner is a small dense problem on the markers. */
#pragma once
#include "coupling/dense.h"
#include "coupling/lagrangian.h"
#include "fluid/walls.h"

typedef enum { MOBILITY_TABLE, MOBILITY_ILU, MOBILITY_NONE } MobilityType;

/* Stokes solves of a step that are kept, to be combined instead of solved for once more. */
#define SADDLE_KEPT 6

typedef struct _p_Saddle *Saddle;
struct _p_Saddle {
  Fluid fluid;       /* borrowed */
  Coupling coupling; /* borrowed; NULL without vesicles */
  Stokes stokes;
  Walls walls;
  MobilityType type;
  Mobility mobility;  /* table */
  DenseBlocks blocks; /* table */
  SelfMobility self;  /* borrowed; NULL without */
  PC ilu;             /* ilu: of the assembled Chat */
  Mat Chat;
  PetscInt n_velocity, n_tension; /* unknowns V, sigma; d follows */
  Mat A;                          /* the residuals' derivative, scaled; one Stokes solve */
  KSP ksp;
  Vec x, b, change, rest;              /* [n] unknowns, residual, work; the same on every rank */
  Vec pending;                         /* part of x whose forces are not in the right-hand side f yet */
  Vec r;                               /* a force on the grid, */
  PetscInt dirty[2];                   /* zero but for these rows */
  Vec w[SADDLE_KEPT + 1];              /* velocities and pressures of kept products, the last for one that is not */
  Vec p[SADDLE_KEPT + 1];              /* made when first needed */
  Vec z[SADDLE_KEPT], Az[SADDLE_KEPT]; /* their unknowns, and what A makes of them */
  PetscInt products;                   /* of A in this solve */
  Vec U, F;                            /* work on markers */
  PetscScalar *tension;                /* [M] work */
  PetscReal reference;                 /* norm of the right-hand side, which the tolerance is relative to */
  PetscReal start;                     /* residual norm of the initial guess */
  PetscReal factored_a0;               /* of the dense blocks; 0: none yet */
  PetscInt fresh_its;                  /* iterations right after they were made; -1: not known yet */
  PetscInt age;                        /* solves that they have served */
  PetscReal waste;                     /* iterations that their age has cost */
  PetscInt life, refreshed;            /* solves that they may serve at most; times that they were made */
  PetscBool flexible;                  /* the KSP allows them to be made anew under way */
  PetscInt applied;                    /* times that they were applied in this solve */
  PetscInt renewed;                    /* and when they were made anew; 0: not */
  PetscBool guess;                     /* -coupled_ksp_initial_guess_nonzero: start from the guess */
  PetscInt its;
  KSPConvergedReason why;
  PetscReal residual;
};

/* SaddleCreate - for the scene's mobility type; self (NULL: none) corrects the markers' velocity. Collective. */
PETSC_EXTERN PetscErrorCode SaddleCreate(Scene scene, Fluid fluid, Coupling coupling, SelfMobility self,
                                         Saddle *saddle);
PETSC_EXTERN PetscErrorCode SaddleDestroy(Saddle *saddle);

/* SaddleCreateWallVec - a vector for the wall forces, zero; sequential, the same on every rank. */
PETSC_EXTERN PetscErrorCode SaddleCreateWallVec(Saddle saddle, Vec *d);

/* SaddleSetUp - follow the fluid's a0 and the coupling's markers. The dense blocks are kept while a0 moves by less than
   10 % and until the iterations beyond those that they took when new have cost as much as new ones would; a solve that
   suffers badly makes them anew and goes on. Collective. */
PETSC_EXTERN PetscErrorCode SaddleSetUp(Saddle saddle);

/* SaddleGetMemory, SaddleSetMemory - all that earlier solves have left for later ones, as numbers that a checkpoint can
   hold, and made again from them, with the coupling's markers and `self` where they were when the dense blocks were
   made and the fluid's a0 that of the blocks (memory[0]; 0: there were none). Whatever a saddle keeps belongs in here,
   or a restarted run would not have the bits of one that went on. Set is collective. */
#define SADDLE_MEMORY (6 + MOBILITY_CACHE)
PETSC_EXTERN PetscErrorCode SaddleGetMemory(Saddle saddle, PetscReal memory[SADDLE_MEMORY]);
PETSC_EXTERN PetscErrorCode SaddleSetMemory(Saddle saddle, const PetscReal memory[SADDLE_MEMORY]);

/* SaddleSolve - solve for w, p, sigma, the wall forces d and the markers' V; sigma, d and V (as E w) hold the initial
   guess; f and g are the right-hand sides, and the membrane's and the walls' forces are added to f. its, why, residual
   say how it went. Collective. */
PETSC_EXTERN PetscErrorCode SaddleSolve(Saddle saddle, Vec f, Vec g, Vec w, Vec p, Vec sigma, Vec d, Vec V);

/* SaddleForget - drop all that is kept from step to step, so that what follows depends on the state alone. Not
   collective. */
PETSC_EXTERN PetscErrorCode SaddleForget(Saddle saddle);

/* SaddleScale - factor of the residual of Dm V/h^2 = g in row k: h^2/ds makes it a surface divergence; 1 + h alpha
   weighs short steps, where the momentum's right-hand side u alpha would hide it. */
PETSC_EXTERN PetscReal SaddleScale(Saddle saddle, PetscInt k);

/* SaddleVelocityScale - factor of V's residual at marker k: over an edge it is a surface divergence, times the root of
   the force it means, bending over viscous (an energy norm). */
PETSC_EXTERN PetscReal SaddleVelocityScale(Saddle saddle, PetscInt k);

/* SaddleRefresh - make the dense blocks for the present markers. Collective. */
PETSC_EXTERN PetscErrorCode SaddleRefresh(Saddle saddle);

/* SaddlePrecondition (precondition.c) - PCSHELL's apply. */
PETSC_EXTERN PetscErrorCode SaddlePrecondition(PC pc, Vec r, Vec z);

/* SaddleMult (reduced.c) - product with A. SaddleResidual - the forces of `added` go
   into f; minus the scaled residuals at x with u, p = w, p by one Stokes solve of f, f holding the forces of x.
   SaddleCombine - the change of w, p and the residual that goes with a change of x made of the solve's products, added;
   x := what it is made of. False when they were too many to be kept.
 */
PETSC_EXTERN PetscErrorCode SaddleMult(Mat A, Vec x, Vec y);
PETSC_EXTERN PetscErrorCode SaddleResidual(Saddle saddle, Vec added, Vec f, Vec g, Vec x, Vec w, Vec p, Vec residual);
PETSC_EXTERN PetscErrorCode SaddleCombine(Saddle saddle, Vec x, Vec w, Vec p, Vec residual, PetscBool *combined);
