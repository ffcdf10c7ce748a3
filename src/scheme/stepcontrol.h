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
  PetscReal ratio; /* largest edge ratio of a vesicle */
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

/* StepPolicyCreate - the policy of a scene. Without vesicles steps are fixed, as the error estimate is theirs. Not
   collective. */
PETSC_EXTERN StepPolicy StepPolicyCreate(Scene scene, PetscInt vesicles);

/* StepFirstLevel - the level of an adaptive run's first step. */
PETSC_EXTERN PetscInt StepFirstLevel(void);

/* StepFinished - whether the time t is `until`, up to the rounding of a sum of steps. */
PETSC_EXTERN PetscBool StepFinished(const StepPolicy *policy, PetscReal t, PetscReal until);

/* StepFixed - the next step of a fixed policy at time t with the time `most` left: the base, except that the last one
   or two steps are shortened to end exactly. A function of its arguments alone, so that a restart takes the same steps.
 */
PETSC_EXTERN PetscReal StepFixed(const StepPolicy *policy, PetscReal t, PetscReal most);

/* StepSize - the step of the next attempt of an adaptive policy: that of the plan's level, which is lowered to what
   max_step and the CFL limit `courant` (PETSC_MAX_REAL: none) allow. At most `most`, which the last two steps divide
   equally. */
PETSC_EXTERN PetscReal StepSize(const StepPolicy *policy, StepPlan *plan, PetscReal courant, PetscReal most);

/* StepJudge - the verdict on an attempt: accept it, repeat it with the smaller step of the plan's new level, or give up
   because no smaller step is left. An accepted attempt leaves the level of the next step in the plan. A function of its
   arguments alone. */
PETSC_EXTERN StepVerdict StepJudge(const StepPolicy *policy, const StepTrial *trial, StepPlan *plan);
