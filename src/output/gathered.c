#include "output/gathered.h"

PetscErrorCode GatheredCreate(const State *q, Gathered *g) {
  PetscFunctionBeginUser;
  g->M = 0;
  if (q->sigma) PetscCall(VecGetSize(q->sigma, &g->M));
  g->W = 0;
  if (q->solid) PetscCall(VecGetSize(q->solid, &g->W));
  g->W /= 2;
  PetscCall(PetscCalloc4(2 * g->M, &g->markers, 2 * g->M, &g->velocity, g->M, &g->tension, 2 * g->W, &g->solid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatheredDestroy(Gathered *g) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(g->markers, g->velocity, g->tension, g->solid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every rank's part of a vector to the array of every rank. */
static PetscErrorCode Gather(Vec vector, PetscReal array[]) {
  const MPI_Comm comm = PetscObjectComm((PetscObject)vector);
  const PetscInt *range;
  const PetscScalar *own;
  PetscMPIInt size, *count, *at;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(VecGetLocalSize(vector, &n));
  PetscCall(VecGetOwnershipRanges(vector, &range));
  PetscCall(PetscMalloc2(size, &count, size, &at));
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(range[r], &at[r]));
    PetscCall(PetscMPIIntCast(range[r + 1] - range[r], &count[r]));
  }
  PetscCall(VecGetArrayRead(vector, &own));
  PetscCallMPI(MPI_Allgatherv(own, (PetscMPIInt)n, MPIU_REAL, array, count, at, MPIU_REAL, comm));
  PetscCall(VecRestoreArrayRead(vector, &own));
  PetscCall(PetscFree2(count, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's part of an array into the vector. */
static PetscErrorCode Scatter(const PetscReal array[], Vec vector) {
  PetscScalar *own;
  PetscInt first, end;
  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(vector, &first, &end));
  PetscCall(VecGetArray(vector, &own));
  PetscCall(PetscArraycpy(own, array + first, end - first));
  PetscCall(VecRestoreArray(vector, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Copy(Vec vector, PetscBool gather, PetscInt n, PetscReal array[]) {
  PetscFunctionBeginUser;
  if (n) PetscCall(gather ? Gather(vector, array) : Scatter(array, vector));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyAll(const State *q, PetscBool gather, const Gathered *g) {
  PetscFunctionBeginUser;
  PetscCall(Copy(q->X, gather, 2 * g->M, g->markers));
  PetscCall(Copy(q->U, gather, 2 * g->M, g->velocity));
  PetscCall(Copy(q->sigma, gather, g->M, g->tension));
  PetscCall(Copy(q->solid, gather, 2 * g->W, g->solid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherState(const State *q, Gathered *g) {
  return CopyAll(q, PETSC_TRUE, g);
}

PetscErrorCode ScatterState(const Gathered *g, const State *q) {
  return CopyAll(q, PETSC_FALSE, g);
}
