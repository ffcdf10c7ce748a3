/* -time_adapt error: the step size from the difference between BDF2 and its predictor. */
#pragma once
#include "scheme/scheme.h"

typedef struct {
  PetscBool on;
  PetscReal tolerance; /* largest accepted error estimate, in units of R0 */
  PetscReal base;      /* steps are base times powers of sqrt(2), so that a0 and its tables come back */
  PetscReal max_move;  /* cells that a marker may move in a step relative to the vesicle's mean velocity; 0 no limit */
  PetscReal max_step;  /* no step is larger; 0 no limit */
  PetscInt level;      /* of the next step */
  PetscInt rejected;   /* steps tried again so far */
  PetscReal R0;        /* smallest vesicle's L/(2 pi) */
} StepControl;

PETSC_EXTERN PetscErrorCode StepControlCreate(Scene scene, Membrane membrane, StepControl *control);

/* StepControlStep - attempt steps until one is accepted: estimate max |X - X*|/R0 over the markers within the
   tolerance, no marker moving more than max_move cells, edge ratio at most 2. *dt: in the largest step allowed, out the
   step taken. */
PETSC_EXTERN PetscErrorCode StepControlStep(Scheme scheme, StepControl *control, Vec Xstar, const State *next,
                                            PetscReal *dt, PetscBool *solved);
