#include "scheme/fields.h"
#include "scheme/coupled.h"

PetscErrorCode SchemeVelocityOf(Scheme s, const State *q, Vec w) {
  PetscFunctionBeginUser;
  PetscCall(StreamFlowsVelocity(CoupledFlows((Coupled *)s->data), q->flow, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeVelocity(Scheme s) {
  PetscFunctionBeginUser;
  if (s->state.fields != FIELDS_WITHOUT_BOTH) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->state.flow) {
    PetscCall(SchemeVelocityOf(s, &s->state, s->state.w));
    s->state.fields = FIELDS_WITHOUT_P;
  } else
    PetscCall(SchemeFields(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Without a flow by the state's time coefficient, which a step that has failed may have changed. */
PetscErrorCode SchemeFields(Scheme s) {
  State *q = &s->state;
  const PetscReal now = s->fluid->a0;
  PetscFunctionBeginUser;
  if (q->flow) PetscCall(SchemeVelocity(s));
  if (q->fields == FIELDS_MADE) PetscFunctionReturn(PETSC_SUCCESS);
  const Mobility m = s->coupling->mobility;
  q->fields = FIELDS_MADE;
  if (q->flow) {
    PetscCall(MobilityPressure(m, &q->forcing, q->w, q->p));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (now != q->a0) PetscCall(FluidSetTimeCoefficient(s->fluid, q->a0));
  PetscCall(MobilityFields(m, &q->forcing, q->w, q->p));
  if (now != q->a0) PetscCall(FluidSetTimeCoefficient(s->fluid, now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeSquare(Scheme s, PetscReal *square) {
  PetscFunctionBeginUser;
  *square = s->report.measures.square;
  if (s->state.flow) PetscCall(StreamFlowsSquare(CoupledFlows((Coupled *)s->data), s->state.flow, square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeFlowOf(Scheme s, Vec w, Vec flow) {
  PetscFunctionBeginUser;
  PetscCall(StreamFlowsOf(CoupledFlows((Coupled *)s->data), w, flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}
