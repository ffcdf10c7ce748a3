/* Step sizes: fixed, or (-time_adapt error) judged after each attempt. Sizes are a base times powers of sqrt(2), so
   that the coefficient a0 and the tables made for it come back. */
#pragma once
#include "scene/scene.h"

typedef struct {
  PetscBool adaptive;
  PetscReal base;      /* -time_step: the fixed step, or what powers of sqrt(2) multiply (time) */
  PetscReal tolerance; /* largest accepted error estimate, in units of R0 */
  PetscReal max_move;  /* length that a marker may move in a step relative to its vesicle's mean velocity; 0 no limit */
  PetscReal max_step;  /* no step is larger; 0 no limit (time) */
} StepPolicy;

/* What an attempt of size dt showed. */
typedef struct {
  PetscBool solved; /* markers could be placed, the solve converged; else the rest has no meaning */
  PetscBool first;  /* the first step of a run, backward Euler: its error is not known */
  PetscInt order;   /* of its differentiation formula; 0 counts as 2 */
  PetscReal dt;
  PetscReal error; /* max |X - X*|/R0, of this order in dt */
  PetscReal speed; /* largest of a marker relative to its vesicle's mean (length/time) */
  PetscReal ratio; /* worst edge ratio */
  PetscReal loss;  /* of a film between vesicles, over what is allowed; above 1 too much, or membranes cross */
} StepTrial;

typedef struct {
  PetscInt level;   /* step-size control: of the next attempt, a step of base 2^(level/2) */
  PetscReal before; /* likewise: error of the attempt rejected last in this step; PETSC_MAX_REAL without */
  PetscInt order;   /* of the next step, as far as states are known and its size allows it */
  PetscInt guess;   /* states that its first guess goes by, as far as they are known */
} StepPlan;

typedef enum { STEP_ACCEPT, STEP_REPEAT, STEP_GIVE_UP } StepVerdict;

/* StepPolicyCreate - of the scene; steps are judged by vesicles' errors, so without vesicles they are fixed. */
PETSC_EXTERN StepPolicy StepPolicyCreate(Scene scene, PetscInt vesicles);

/* StepFirstLevel - of an adaptive run's first step. */
PETSC_EXTERN PetscInt StepFirstLevel(void);

/* StepFinished - whether the time t counts as `until`: it is, but for what rounding leaves of a sum of steps. */
PETSC_EXTERN PetscBool StepFinished(const StepPolicy *policy, PetscReal t, PetscReal until);

/* StepFixed - of a policy that is not adaptive, at time t with `most` left: the base, and two equal steps or a single
   one at the end where `most` is no multiple of it. A function of these alone: a restart goes the same way. */
PETSC_EXTERN PetscReal StepFixed(const StepPolicy *policy, PetscReal t, PetscReal most);

/* StepSize - of the next attempt: of the plan's level, which is lowered to what max_step and the CFL limit `courant`
   (PETSC_MAX_REAL: none) allow; at most `most`, and towards it two equal steps. Adaptive policies only. */
PETSC_EXTERN PetscReal StepSize(const StepPolicy *policy, StepPlan *plan, PetscReal courant, PetscReal most);

/* StepJudge - whether an attempt is accepted, tried again with the smaller step of the plan's new level, or nothing
   smaller is left to try; accepted ones leave the level of the next step in the plan. A pure function. */
PETSC_EXTERN StepVerdict StepJudge(const StepPolicy *policy, const StepTrial *trial, StepPlan *plan);
