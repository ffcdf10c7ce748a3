#include "output/gathered.h"

static Vec GatheredVector(const State *q, int part) {
  const Vec all[GATHERED_COUNT] = {q->X, q->U, q->sigma, q->solid};
  return all[part];
}

PetscErrorCode GatheredCreate(const State *q, Gathered *g) {
  PetscFunctionBeginUser;
  *g = (Gathered){{{"vesicle/markers", 2},
                   {"vesicle/velocity", 2},
                   {"vesicle/tension", 1},
                   {"obstacle/force", 2}}};
  for (int k = 0; k < GATHERED_COUNT; k++) {
    PetscInt size = 0;
    if (GatheredVector(q, k)) PetscCall(VecGetSize(GatheredVector(q, k), &size));
    g->part[k].n = size / g->part[k].each;
    PetscCall(PetscCalloc1(size, &g->part[k].values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherState(const State *q, Gathered *g) {
  PetscFunctionBeginUser;
  for (int k = 0; k < GATHERED_COUNT; k++) {
    const Vec vector = GatheredVector(q, k);
    const GatheredPart *p = &g->part[k];
    const PetscScalar *values;
    VecScatter scatter;
    Vec all;
    if (!p->n) continue;
    PetscCall(VecScatterCreateToAll(vector, &scatter, &all));
    PetscCall(VecScatterBegin(scatter, vector, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(scatter, vector, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecGetArrayRead(all, &values));
    PetscCall(PetscArraycpy(p->values, values, p->n * p->each));
    PetscCall(VecRestoreArrayRead(all, &values));
    PetscCall(VecScatterDestroy(&scatter));
    PetscCall(VecDestroy(&all));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScatterState(const Gathered *g, const State *q) {
  PetscFunctionBeginUser;
  for (int k = 0; k < GATHERED_COUNT; k++) {
    PetscInt first, end;
    PetscScalar *own;
    if (!g->part[k].n) continue;
    PetscCall(VecGetOwnershipRange(GatheredVector(q, k), &first, &end));
    PetscCall(VecGetArray(GatheredVector(q, k), &own));
    PetscCall(PetscArraycpy(own, g->part[k].values + first, end - first));
    PetscCall(VecRestoreArray(GatheredVector(q, k), &own));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatheredDestroy(Gathered *g) {
  PetscFunctionBeginUser;
  for (int k = 0; k < GATHERED_COUNT; k++) PetscCall(PetscFree(g->part[k].values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
