/* The parts of one unsplit step of backward Euler or BDF (docs/steps.md). */
#pragma once
#include "krylov/solver.h"
#include "fluid/stokes/convection.h"
#include "scheme/history.h"
#include "scheme/stepcommon.h"

typedef struct {
  CoupledSolver solver;
  Convection convection; /* NULL unless the fluid has it */
  State next;            /* the state being made */
  History history;       /* what it is made from */
  PetscInt order;        /* order of the step being made */
  StepPlan next_plan;    /* order and guess that the step being made plans for the next one */
  PetscBool start;       /* the first state is being solved */
  PetscBool graded;      /* the step being made is a graded start */
  PetscReal done;        /* the part of a graded start that is done (time) */
  PetscBool warned;      /* a warning of edges that were off has been given */
  Vec made_at;           /* markers at which the preconditioner's dense blocks were made */
  PetscReal *made_with;  /* [vesicles] label speeds with which these blocks were made */
  StreamPast past;       /* the states before, where their flows act as a force */
  Vec Xstar, Xhat;       /* extrapolated markers, BDF history of the markers */
  Adams adams;           /* weights of the velocities of free bodies in the step being made */
  Vec place;             /* of free bodies, extrapolated; NULL without */
  PetscReal *load;       /* [3 own free] known force and torque on them; NULL without */
  Vec all;               /* markers of all bodies, work */
  Vec moved;             /* known part of the fluid's motion at the vesicles' markers */
  Vec force;             /* minus the known part of the force on all bodies' markers */
  Vec V, known, Y;       /* solved part and known part of the markers' velocity, obstacles included; work */
  Vec P;                 /* the markers' velocity as the labels of the step see it */
} Coupled;

/* The flows of a scheme whose states have them. */
static inline StreamFlows CoupledFlows(const Coupled *d) {
  return d->solver->coupling->mobility->stream->flows;
}

/* Which fields a step makes. */
static inline StateFields CoupledMakes(const Coupled *d) {
  return d->next.w ? (d->next.p ? FIELDS_MADE : FIELDS_WITHOUT_P) : FIELDS_WITHOUT_BOTH;
}

/* CoupledAttempt - solve one step of size dt from the state into next, or say in report.failure why it cannot be.
   CoupledFixedAttempt - of a fixed step: a step whose motion stops within it is made again by backward Euler, from the
   state itself in place of an extrapolation. CoupledEstimate - error estimate of the step in next: max |X - X*|/R0, R0
   of the smallest vesicle or free body; not a number where an X is. Collective. */
PETSC_EXTERN PetscErrorCode CoupledAttempt(Scheme scheme, PetscReal dt);
PETSC_EXTERN PetscErrorCode CoupledFixedAttempt(Scheme scheme, PetscReal dt);
PETSC_EXTERN PetscErrorCode CoupledEstimate(Scheme scheme, PetscReal *error);

/* CoupledAdvance - next becomes the state and the state the old one; then the markers are moved to their area and
   edges. Collective. */
PETSC_EXTERN PetscErrorCode CoupledAdvance(Scheme scheme, PetscReal dt);

/* SchemeCreate_Coupled - give a scheme the operations of the unsplit step. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCreate_Coupled(Scheme scheme);
