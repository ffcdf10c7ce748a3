/* The parts of one unsplit step of backward Euler or BDF (docs/membrane.md). */
#pragma once
#include "coupling/solver.h"
#include "fluid/convection.h"
#include "scheme/history.h"
#include "scheme/stepcommon.h"

typedef struct {
  CoupledSolver solver;
  Convection convection; /* NULL unless the fluid has it */
  State next;            /* the state being made */
  History history;       /* what it is made from */
  PetscInt order;        /* of the step being made, */
  StepPlan next_plan;    /* and what it says for the next one: order and guess */
  PetscBool graded;      /* the step under way is a graded start, */
  PetscReal done;        /* of which this much is done (time) */
  PetscBool warned;      /* of edges that were off */
  Vec made_at;           /* markers at which the preconditioner's dense blocks were made, */
  PetscReal *made_with;  /* [vesicles] and the label speeds */
  StreamPast past;       /* the states before, where they are a force as flows */
  Vec Xstar, Xhat;       /* extrapolated markers, BDF history of the markers */
  Vec moved;             /* viscosity contrast: known part of the markers' motion */
  Vec force;             /* minus what is known of the force on all bodies' markers */
  Vec V, known, Y;       /* solved part of the markers' velocity, what is known of it, and of obstacles; work */
  Vec P;                 /* the markers' velocity as the labels of the step see it */
  PetscScalar *edges;    /* [2n] work */
} Coupled;

/* What makes and reads flows, of a scheme whose states have them. */
static inline StreamFlows CoupledFlows(const Coupled *d) {
  return StreamGetFlows(d->solver->reduced->stream);
}

/* CoupledAttempt - solve one step of size dt from the state into next; false with report.failure when it cannot be.
   Collective. */
PETSC_EXTERN PetscErrorCode CoupledAttempt(Scheme scheme, PetscReal dt, PetscBool *solved);

/* CoupledFixedAttempt - the same; a step whose motion stops within it is made again by backward Euler, from the state
   itself in place of an extrapolation. Collective. */
PETSC_EXTERN PetscErrorCode CoupledFixedAttempt(Scheme scheme, PetscReal dt, PetscBool *solved);

/* CoupledAdvance - next becomes the state and the state the old one; then the markers are moved to their area and
   edges. Collective. */
PETSC_EXTERN PetscErrorCode CoupledAdvance(Scheme scheme, PetscReal dt);

/* CoupledRemember, CoupledRecall - remember and recall of SchemeOps. Collective. */
PETSC_EXTERN PetscErrorCode CoupledRemember(Scheme scheme, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode CoupledRecall(Scheme scheme, const PetscReal memory[]);

/* CoupledCreateStates - the vectors of the states before the present one and of the next one. CoupledFields,
   CoupledVelocity, CoupledFlow, CoupledSquare - fields, velocity, flow and square of SchemeOps. Collective. */
PETSC_EXTERN PetscErrorCode CoupledCreateStates(Scheme scheme);
PETSC_EXTERN PetscErrorCode CoupledFields(Scheme scheme);
PETSC_EXTERN PetscErrorCode CoupledVelocity(Scheme scheme, const State *state, Vec w);
PETSC_EXTERN PetscErrorCode CoupledFlow(Scheme scheme, Vec w, Vec flow);
PETSC_EXTERN PetscErrorCode CoupledSquare(Scheme scheme, PetscReal *square);
