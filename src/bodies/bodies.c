#include "bodies/bodies.h"

PetscErrorCode BodiesCreate(Membrane m, Obstacles obstacles, Bodies *out) {
  const PetscInt vesicles = m->layout->bodies;
  Bodies b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->layout = obstacles ? obstacles->all : m->layout;
  b->membrane = m;
  b->vesicles = vesicles;
  b->obstacles = obstacles;
  PetscCall(PetscCalloc4(b->layout->bodies, &b->ds, b->layout->bodies, &b->spectral, b->layout->bodies, &b->kind,
                         b->layout->bodies, &b->resting));
  PetscCall(PetscArraycpy(b->ds, m->ds, vesicles));
  PetscCall(PetscArraycpy(b->spectral, m->spectral, vesicles));
  if (obstacles) {
    PetscCall(PetscArraycpy(b->ds + vesicles, obstacles->ds, obstacles->layout->bodies));
    PetscCall(PetscArraycpy(b->spectral + vesicles, obstacles->spectral, obstacles->layout->bodies));
    PetscCall(PetscArraycpy(b->kind + vesicles, obstacles->kind, obstacles->layout->bodies));
    for (PetscInt v = vesicles; v < b->layout->bodies; v++) b->kind[v].around = obstacles->vesicle[v - vesicles] + 1;
    for (PetscInt v = vesicles; v < b->layout->bodies; v++) b->resting[v] = !obstacles->motion[v - vesicles].carried;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BodiesDestroy(Bodies *bodies) {
  PetscFunctionBeginUser;
  if (!*bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4((*bodies)->ds, (*bodies)->spectral, (*bodies)->kind, (*bodies)->resting));
  PetscCall(PetscFree(*bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BodiesSee(Bodies b, Instant at, const PetscReal X[], PetscReal all[]) {
  const PetscInt M = b->layout->start[b->vesicles];
  PetscFunctionBeginUser;
  if (X != all) PetscCall(PetscArraycpy(all, X, 2 * M));
  if (b->obstacles) ObstaclesCurves(b->obstacles, at, all + 2 * M);
  PetscFunctionReturn(PETSC_SUCCESS);
}
