#include "scheme/fields.h"
#include "scheme/coupled.h"

StreamFlows SchemeFlows(Scheme s) {
  return CoupledFlows((Coupled *)s->data);
}

PetscErrorCode SchemeVelocity(Scheme s) {
  PetscFunctionBeginUser;
  if (s->state.fields != FIELDS_WITHOUT_BOTH) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->state.flow) {
    PetscCall(StreamFlowsVelocity(SchemeFlows(s), s->state.flow, s->state.w));
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

PetscErrorCode SchemeFluidAtMarkers(Scheme s, Vec *U) {
  const State *q = &s->state;
  Vec F;
  PetscFunctionBeginUser;
  if (s->membrane->permeability == 0) {
    *U = q->U;
    PetscCall(PetscObjectReference((PetscObject)q->U));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecDuplicate(q->U, U));
  PetscCall(VecCopy(q->U, *U));
  PetscCall(VecDuplicate(q->X, &F));
  PetscCall(CouplingForces(s->coupling, StateInstant(q), q->sigma, q->X, F));
  PetscCall(VecScale(F, -1));
  PetscCall(CouplingSeep(s->coupling, -1, q->X, F, *U));
  PetscCall(VecDestroy(&F));
  PetscFunctionReturn(PETSC_SUCCESS);
}
