#include "plane/gathered.h"

StatePart StatePartOf(Scheme s, const State *q, StatePartName name) {
  const Layout vesicles = s->membrane->layout;
  const Obstacles o = s->coupling->bodies->obstacles;
  const StatePart all[STATE_PARTS] = {{"vesicle/markers", 2, vesicles, q->X},
                                      {"vesicle/velocity", 2, vesicles, q->U},
                                      {"vesicle/tension", 1, vesicles, q->sigma},
                                      {"obstacle/force", 2, o ? o->layout : NULL, q->solid},
                                      {"obstacle/rate", 3, o ? o->free : NULL, q->solid},
                                      {"obstacle/place", 3, NULL, q->place}};
  StatePart part = all[name];
  if (part.vector) part.n = part.layout ? part.layout->M : o->free->M;
  if (name == STATE_RATES && o) part.first = 2 * o->layout->n;
  return part;
}

PetscErrorCode StateGather(const StatePart *p, PetscReal values[]) {
  const PetscScalar *own;
  PetscFunctionBeginUser;
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(p->vector, &own));
  if (p->layout)
    PetscCall(LayoutGather(p->layout, p->each, own + p->first, values));
  else
    PetscCall(PetscArraycpy(values, own, p->each * p->n));
  PetscCall(VecRestoreArrayRead(p->vector, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateStretch(Scheme s, PetscReal stretch[]) {
  const Membrane m = s->membrane;
  PetscReal *X, *tau;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * m->layout->M, &X, 2 * m->layout->M, &tau));
  PetscCall(LayoutGatherVec(m->layout, s->state.X, X));
  MembraneTangents(m, 0, m->layout->bodies, X, tau);
  for (PetscInt k = 0; k < m->layout->M; k++) stretch[k] = PetscHypotReal(tau[2 * k], tau[2 * k + 1]);
  PetscCall(PetscFree2(X, tau));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateShow(Scheme s, StatePartName name, PetscReal values[]) {
  const StatePart part = StatePartOf(s, &s->state, name);
  PetscReal *stretch;
  PetscFunctionBeginUser;
  PetscCall(StateGather(&part, values));
  if (name != STATE_TENSION || !s->membrane->stretches) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(part.n, &stretch));
  PetscCall(StateStretch(s, stretch));
  for (PetscInt k = 0; k < part.n; k++) values[k] *= stretch[k];
  PetscCall(PetscFree(stretch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateScatter(const StatePart *p, const PetscReal values[]) {
  const PetscInt first = p->layout ? p->layout->first : 0, n = p->layout ? p->layout->n : p->n;
  PetscScalar *own;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(p->vector, &own));
  PetscCall(PetscArraycpy(own + p->first, values + p->each * first, p->each * n));
  PetscCall(VecRestoreArray(p->vector, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowsLayout(Grid g, Field field, PetscInt each, Layout *rows) {
  const PetscInt n = g->all_rows[field];
  PetscInt *start, *first;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n + 1, &start, g->size + 1, &first));
  for (PetscInt j = 0; j <= n; j++) start[j] = j * each;
  for (PetscMPIInt r = 0; r <= g->size; r++) first[r] = PetscMin(r * g->block, n);
  PetscCall(LayoutCreate(g->comm, n, start, first, rows));
  PetscCall(PetscFree2(start, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}
