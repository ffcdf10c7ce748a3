#include "output/gathered.h"

PetscErrorCode GatheredWalls(const State *q, PetscInt *walls) {
  PetscFunctionBeginUser;
  *walls = 0;
  if (q->walls) PetscCall(VecGetSize(q->walls, walls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatheredCreate(const State *q, Gathered *g) {
  PetscFunctionBeginUser;
  g->M = 0;
  if (q->sigma) PetscCall(VecGetSize(q->sigma, &g->M));
  PetscCall(GatheredWalls(q, &g->walls));
  PetscCall(PetscCalloc4(2 * g->M, &g->markers, 2 * g->M, &g->velocity, g->M, &g->tension, g->walls, &g->wall_force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatheredDestroy(Gathered *g) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(g->markers, g->velocity, g->tension, g->wall_force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One vector to or from its array. */
static PetscErrorCode Copy(Vec vector, PetscBool gather, PetscInt n, PetscReal array[]) {
  const PetscScalar *from;
  PetscScalar *to;
  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  if (gather) {
    PetscCall(VecGetArrayRead(vector, &from));
    PetscCall(PetscArraycpy(array, from, n));
    PetscCall(VecRestoreArrayRead(vector, &from));
  } else {
    PetscCall(VecGetArray(vector, &to));
    PetscCall(PetscArraycpy(to, array, n));
    PetscCall(VecRestoreArray(vector, &to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyAll(const State *q, PetscBool gather, const Gathered *g) {
  PetscFunctionBeginUser;
  PetscCall(Copy(q->X, gather, 2 * g->M, g->markers));
  PetscCall(Copy(q->U, gather, 2 * g->M, g->velocity));
  PetscCall(Copy(q->sigma, gather, g->M, g->tension));
  PetscCall(Copy(q->walls, gather, g->walls, g->wall_force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherState(const State *q, Gathered *g) {
  return CopyAll(q, PETSC_TRUE, g);
}

PetscErrorCode ScatterState(const Gathered *g, const State *q) {
  return CopyAll(q, PETSC_FALSE, g);
}
