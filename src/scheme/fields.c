/* What unsplit steps have of velocity and pressure: which vectors their states hold, and fields that are made when they
   are asked for. */
#include "scheme/coupled.h"

/* The states before the present one have the velocity where it is a history: in fluid with inertia, of the older one
   for order 3. It is a flow where one is made, which convection needs on the grid as well. Of the next one both fields
   are needed unless the state's own are made when they are asked for, from the forcing that each of the two has then,
   and from the flow. */
PetscErrorCode CoupledCreateStates(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  const PetscBool later = ReducedNeedsNoPressure(d->solver->reduced);
  const PetscBool contrast = s->coupling->contrast ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool grid = !s->fluid->steady && (!later || d->convection) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (later && !s->fluid->steady) PetscCall(StreamFlowsCreateVec(CoupledFlows(d), &s->state.flow));
  for (int j = 0; j < SCHEME_PAST; j++) {
    PetscCall(StateDuplicate(&s->state, &s->old[j]));
    PetscCall(VecDestroy(&s->old[j].p));
    if (!grid || j >= s->scene->scheme.order - 1) PetscCall(VecDestroy(&s->old[j].w));
    if (j >= s->scene->scheme.order - 1) PetscCall(VecDestroy(&s->old[j].flow));
  }
  PetscCall(StateDuplicate(&s->state, &d->next));
  PetscCall(ForcingCreate(s->fluid->grid, contrast, &d->next.forcing));
  if (!later) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForcingCreate(s->fluid->grid, contrast, &s->state.forcing));
  PetscCall(VecDestroy(&d->next.p));
  if (!grid) PetscCall(VecDestroy(&d->next.w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledVelocity(Scheme s, const State *q, Vec w) {
  PetscFunctionBeginUser;
  PetscCall(StreamFlowsVelocity(CoupledFlows((Coupled *)s->data), q->flow, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Without a flow by the state's time coefficient, which a step that has failed may have changed. */
PetscErrorCode CoupledFields(Scheme s) {
  const State *q = &s->state;
  const Reduced r = ((Coupled *)s->data)->solver->reduced;
  const PetscReal now = s->fluid->a0;
  PetscFunctionBeginUser;
  if (q->flow) {
    PetscCall(ReducedPressure(r, &q->forcing, q->w, q->p));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (now != q->a0) PetscCall(FluidSetTimeCoefficient(s->fluid, q->a0));
  PetscCall(ReducedFields(r, &q->forcing, q->w, q->p));
  if (now != q->a0) PetscCall(FluidSetTimeCoefficient(s->fluid, now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledSquare(Scheme s, PetscReal *square) {
  PetscFunctionBeginUser;
  *square = s->report.measures.square;
  if (s->state.flow) PetscCall(StreamFlowsSquare(CoupledFlows((Coupled *)s->data), s->state.flow, square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledFlow(Scheme s, Vec w, Vec flow) {
  PetscFunctionBeginUser;
  PetscCall(StreamFlowsOf(CoupledFlows((Coupled *)s->data), w, flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}
