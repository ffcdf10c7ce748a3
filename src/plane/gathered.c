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

/* The numbers of each rank's rows, and where they begin; the caller frees both (PetscFree2). */
static PetscErrorCode RowsOfRanks(Grid g, Field field, PetscInt each, PetscMPIInt **count, PetscMPIInt **first) {
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(g->size, count, g->size, first));
  for (PetscMPIInt r = 0; r < g->size; r++) {
    const PetscInt rows = r < g->size - 1 ? g->block : g->all_rows[field] - r * g->block;
    PetscCall(PetscMPIIntCast(each * rows, *count + r));
    PetscCall(PetscMPIIntCast(each * r * g->block, *first + r));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherRows(Grid g, Field field, PetscInt each, const PetscScalar own[], PetscScalar all[]) {
  PetscMPIInt *count, *first;
  PetscFunctionBeginUser;
  PetscCall(RowsOfRanks(g, field, each, &count, &first));
  PetscCallMPI(MPI_Gatherv(own, count[g->rank], MPIU_SCALAR, all, count, first, MPIU_SCALAR, 0, g->comm));
  PetscCall(PetscFree2(count, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScatterRows(Grid g, Field field, PetscInt each, const PetscScalar all[], PetscScalar own[]) {
  PetscMPIInt *count, *first;
  PetscFunctionBeginUser;
  PetscCall(RowsOfRanks(g, field, each, &count, &first));
  PetscCallMPI(MPI_Scatterv(all, count, first, MPIU_SCALAR, own, count[g->rank], MPIU_SCALAR, 0, g->comm));
  PetscCall(PetscFree2(count, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}
