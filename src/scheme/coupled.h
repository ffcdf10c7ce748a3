/* What schemes coupled and direct share: one unsplit step of backward Euler or BDF2 (DESIGN section 7). */
#pragma once
#include "coupling/saddle.h"
#include "fluid/convection.h"
#include "scheme/adapt.h"
#include "scheme/bdf.h"
#include "scheme/direct.h"
#include "scheme/scheme.h"

typedef struct {
  Saddle saddle;         /* scheme coupled: FGMRES */
  DirectSolver direct;   /* scheme direct: sparse LU */
  Convection convection; /* NULL unless the fluid has it */
  State old, next;       /* the state before, the one being made */
  PetscReal done;        /* of the step under way: parts of a graded start (time) */
  PetscInt order;
  PetscBool length_target, area_target;
  PetscBool warned; /* of edges put right */
  StepControl control;
  Vec made_at;        /* markers at which the saddle's dense blocks were made */
  Vec f;              /* momentum's right-hand side */
  Vec Xstar, Xhat, Y; /* extrapolated markers, BDF history of the markers, Xhat + u_inf/a0 */
} Coupled;

/* CoupledSpeed - max(|u| + |v|) of the state's flow, which bounds the step by -time_cfl_limit h over it; 0 without
   convection. */
PETSC_EXTERN PetscErrorCode CoupledSpeed(Scheme scheme, PetscReal *speed);

/* CoupledAttempt - solve one step of size dt from the state into next; false with report.failure when it cannot be. */
PETSC_EXTERN PetscErrorCode CoupledAttempt(Scheme scheme, PetscReal dt, PetscBool *solved);
