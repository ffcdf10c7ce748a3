#include "plane/tracers.h"
#include "plane/pointvelocity.h"

#define MOST 1000000 /* points of a grid */

PetscErrorCode TracersCreate(Scene scene, Tracers *t) {
  const SceneTracers *own = &scene->tracers;
  const PetscReal *box = scene->fluid.box, side[2] = {box[1] - box[0], box[3] - box[2]};
  const PetscInt columns = own->grid.n == 2 ? own->grid.v[0] : -1, rows = own->grid.n == 2 ? own->grid.v[1] : 0;
  PetscReal *points = NULL;
  PetscInt listed = 0;
  PetscFunctionBeginUser;
  PetvesCheck((PetscReal)columns * (PetscReal)rows <= MOST && (columns == 0) == (rows == 0), scene->comm,
              "-tracer_grid: needs two numbers above 0; allowed: NX,NY of up to %d points, or 0,0 for none", MOST);
  if (*own->file) PetscCall(PointsFromFile(scene->comm, "-tracer_file", own->file, &listed, &points));
  *t = (Tracers){.n = listed + columns * rows};
  PetscCall(PetscCalloc2(2 * t->n, &t->X, 2 * t->n, &t->U));
  PetscCall(PetscArraycpy(t->X, points, 2 * listed));
  PetscCall(PetscFree(points));
  for (PetscInt k = 0; k < 2 * columns * rows; k++) {
    const PetscInt i = k % 2 ? k / 2 / columns : k / 2 % columns, n = k % 2 ? rows : columns;
    t->X[2 * listed + k] = box[2 * (k % 2)] + side[k % 2] * ((PetscReal)i + 0.5) / (PetscReal)n;
  }
  for (PetscInt k = 0; k < 2 * listed && !FluidSpecIsFree(&scene->fluid); k++)
    PetvesCheck(t->X[k] >= box[2 * (k % 2)] && t->X[k] <= box[2 * (k % 2) + 1], scene->comm,
                "-tracer_file %s: point %" PetscInt_FMT
                " (%g %g) is outside of the box; allowed: points in -domain_box",
                own->file, k / 2 + 1, (double)t->X[k - k % 2], (double)t->X[k - k % 2 + 1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TracersMove(Tracers *t, Scheme s) {
  const PetscReal dt = s->state.t - t->t;
  PetscReal *Y, *V;
  PointVelocity at;
  PetscFunctionBeginUser;
  if (!t->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(2 * t->n, &Y, 2 * t->n, &V));
  PetscCall(PointVelocityBegin(s, &at));
  if (!t->moving) PetscCall(PointVelocityAt(&at, t->n, t->X, t->U));
  for (PetscInt k = 0; k < 2 * t->n; k++) Y[k] = t->X[k] + dt * t->U[k];
  PetscCall(PointVelocityAt(&at, t->n, Y, V));
  for (PetscInt k = 0; k < 2 * t->n; k++) t->X[k] += 0.5 * dt * (t->U[k] + V[k]);
  PetscCall(PointVelocityAt(&at, t->n, t->X, t->U));
  PetscCall(PointVelocityEnd(&at));
  PetscCall(PetscFree2(Y, V));
  t->t = s->state.t;
  t->moving = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TracersDestroy(Tracers *t) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(t->X, t->U));
  PetscFunctionReturn(PETSC_SUCCESS);
}
