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
  PetscBool solved; /* markers could be placed and the solve converged; else the other fields have no meaning */
  PetscBool first;  /* the first step of a run, by backward Euler: its error is not known */
  PetscInt order;   /* order of the differentiation formula; 0 counts as 2 */
  PetscReal dt;
  PetscReal error; /* max |X - X*|/R0, of this order in dt */
  PetscReal speed; /* largest speed of a marker relative to its vesicle's mean velocity (length/time) */
  PetscReal ratio; /* largest edge ratio of a vesicle; of one that stretches, its factor in the step */
  PetscReal loss;  /* largest loss of a film over the allowed loss; above 1: too much, or membranes cross */
} StepTrial;

/* What is planned for the next step. */
typedef struct {
  PetscInt level;   /* the next attempt has a step of base 2^(level/2), in adaptive runs */
  PetscReal before; /* error of the attempt rejected last in this step; PETSC_MAX_REAL: none was rejected */
  PetscInt order;   /* order of the next step, where enough states are known and its size allows it */
  PetscInt guess;   /* number of states that the first guess is extrapolated from, where they are known */
} StepPlan;

typedef enum { STEP_ACCEPT, STEP_REPEAT, STEP_GIVE_UP } StepVerdict;

/* StepPolicyCreate - the policy of a scene with so many vesicles and free bodies. Without, steps are fixed: the error
   estimate is theirs. Not collective. */
PETSC_EXTERN StepPolicy StepPolicyCreate(Scene scene, PetscInt bodies);

/* StepFirstLevel - the level of an adaptive run's first step. */
PETSC_EXTERN PetscInt StepFirstLevel(void);

/* StepDecimal - a time by its first 15 digits: 0.3 of 3 x 0.1. StepTime - the time at the end of a step of size dt from
   time t: `until` where it ends there; of a fixed step else as decimals, a multiple of the base where it is one, so
   that rounding does not add up. StepFinished - whether the time t is `until`, up to rounding. */
PETSC_EXTERN PetscReal StepDecimal(PetscReal t);
PETSC_EXTERN PetscReal StepTime(const StepPolicy *policy, PetscReal t, PetscReal dt, PetscReal until);
PETSC_EXTERN PetscBool StepFinished(const StepPolicy *policy, PetscReal t, PetscReal until);

/* StepFixed - the next step of a fixed policy from time t to `until` at most: the base, except that the last one or two
   steps are shortened to end exactly. A function of its arguments alone, so that a restart takes the same steps. */
PETSC_EXTERN PetscReal StepFixed(const StepPolicy *policy, PetscReal t, PetscReal until);

/* StepSize - the step of the next attempt of an adaptive policy: that of the plan's level, which is lowered to what
   max_step and the CFL limit `courant` (PETSC_MAX_REAL: none) allow, and at most twice the step `last` (0: none). The
   last ten steps of the time `most` that is left are equal, so that none is short; they may be a tenth above the size
   of the level, within the limits. */
PETSC_EXTERN PetscReal StepSize(const StepPolicy *policy, StepPlan *plan, PetscReal last, PetscReal courant,
                                PetscReal most);

/* StepJudge - the verdict on an attempt: accept it, repeat it with the smaller step of the plan's new level, or give up
   because no smaller step is left. An accepted attempt leaves the level of the next step in the plan. A function of its
   arguments alone. */
PETSC_EXTERN StepVerdict StepJudge(const StepPolicy *policy, const StepTrial *trial, StepPlan *plan);
