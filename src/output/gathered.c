#include "output/gathered.h"

static Vec GatheredVector(const State *q, int part) {
  const Vec all[GATHERED_COUNT] = {q->X, q->U, q->sigma, q->solid};
  return all[part];
}

PetscErrorCode GatheredCreate(const State *q, Gathered *g) {
  PetscFunctionBeginUser;
  *g = (Gathered){{{"vesicle/markers", 2}, {"vesicle/velocity", 2}, {"vesicle/tension", 1}, {"obstacle/force", 2}}};
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
    const PetscInt *range;
    const PetscScalar *own;
    PetscMPIInt rank, size, *count, *at;
    if (!g->part[k].n) continue;
    const MPI_Comm comm = PetscObjectComm((PetscObject)vector);
    PetscCallMPI(MPI_Comm_rank(comm, &rank));
    PetscCallMPI(MPI_Comm_size(comm, &size));
    PetscCall(VecGetOwnershipRanges(vector, &range));
    PetscCall(PetscMalloc2(size, &count, size, &at));
    for (PetscMPIInt r = 0; r < size; r++) {
      PetscCall(PetscMPIIntCast(range[r], &at[r]));
      PetscCall(PetscMPIIntCast(range[r + 1] - range[r], &count[r]));
    }
    PetscCall(VecGetArrayRead(vector, &own));
    PetscCallMPI(MPI_Allgatherv(own, count[rank], MPIU_REAL, g->part[k].values, count, at, MPIU_REAL, comm));
    PetscCall(VecRestoreArrayRead(vector, &own));
    PetscCall(PetscFree2(count, at));
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
