/* What goes with obstacles, and where they and the vesicles among them may be. */
#include "curve/crossing.h"
#include "kernel/kernel.h"
#include "scene/resolve.h"

#define LEAST_ACROSS 6 /* cells */

static PetscErrorCode CheckMethod(Scene scene) {
  PetscFunctionBeginUser;
  PetscCheck(!FluidSpecIsFree(&scene->fluid), scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: not with -domain_bc_x free, where a body held in a flow has no finite velocity in two "
             "dimensions; allowed: walls, or periodic boundaries");
  PetscCheck(!SceneIsProjection(scene), scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: not with -scheme_type %s; allowed: coupled, direct", scene->scheme.type);
  PetscCheck(scene->fluid.form != FORM_TOTAL, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: not with -flow_form total; allowed: disturbance");
  PetscCheck(scene->fluid.inertia == INERTIA_AUTO || scene->fluid.inertia == INERTIA_NONE, scene->comm,
             PETSC_ERR_USER_INPUT, "-obstacle_shape: not with -fluid_inertia %s; allowed: none",
             scene->fluid.inertia == INERTIA_UNSTEADY ? "unsteady" : "convective");
  PetscCheck(scene->coupling.near_field == NEAR_EXACT, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: not with -coupling_near_field none; allowed: exact");
  PetscCheck(SceneHasBoxPart(scene), scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: needs the box part of the near field, without which its forces are wrong by parts of a "
             "hundred; allowed: -coupling_box_part true in a box whose periods are at most %d times its other side",
             FLUID_LONGEST_PERIOD);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That a curve is large enough for the grid, fits into the box and is off its walls. */
static PetscErrorCode CheckPlace(Scene scene, PetscInt b) {
  const Shape *s = &scene->obstacles.outline;
  const FluidSpec *f = &scene->fluid;
  const PetscReal h = FluidSpecCellSize(f);
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) {
    PetscReal low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL;
    for (PetscInt k = s->start[b]; k < s->start[b + 1]; k++) {
      low = PetscMin(low, s->X[2 * k + d]);
      high = PetscMax(high, s->X[2 * k + d]);
    }
    PetscCheck(high - low >= LEAST_ACROSS * h * (1 - 1e-2), scene->comm, PETSC_ERR_USER_INPUT,
               "-obstacle_shape: obstacle %" PetscInt_FMT " is %.3g cells across in %c; allowed: at least %d, so finer "
               "-domain_cells or a larger one",
               b + 1, (double)((high - low) / h), "xy"[d], LEAST_ACROSS);
    PetscCheck(high - low < f->box[2 * d + 1] - f->box[2 * d], scene->comm, PETSC_ERR_USER_INPUT,
               "-obstacle_shape: obstacle %" PetscInt_FMT " is %g long in %c; allowed: one that fits into -domain_box",
               b + 1, (double)(high - low), "xy"[d]);
    const PetscReal room = PetscMin(low - f->box[2 * d], f->box[2 * d + 1] - high);
    PetscCheck(f->bc[d] != BC_WALL || room >= KERNEL_FOLDED_CELLS * h * (1 - 1e-12), scene->comm, PETSC_ERR_USER_INPUT,
               "-obstacle_shape: obstacle %" PetscInt_FMT " comes to %.3g cells of a wall in %c; allowed: at least %g",
               b + 1, (double)(room / h), "xy"[d], (double)KERNEL_FOLDED_CELLS);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether curve b, or an image of it, holds the point. */
static PetscBool Holds(const Shape *s, PetscInt b, const PetscReal X[2], const PetscReal period[2]) {
  for (int p = -1; p <= 1; p++)
    for (int q = -1; q <= 1; q++) {
      if ((p && period[0] == 0) || (q && period[1] == 0)) continue;
      if (ShapeHolds(s, b, X[0] + p * period[0], X[1] + q * period[1])) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* That no vesicle is in a solid, and no obstacle within another one's. */
static PetscErrorCode CheckInside(Scene scene, const PetscReal period[2]) {
  const SceneObstacles *own = &scene->obstacles;
  const Shape *s = &own->outline, *vesicles = &scene->shape;
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < s->vesicles; b++) {
    for (PetscInt v = 0; v < vesicles->vesicles; v++) {
      const PetscBool held = Holds(s, b, vesicles->X + 2 * vesicles->start[v], period);
      PetscCheck(held == own->container[b], scene->comm, PETSC_ERR_USER_INPUT,
                 "-vesicle_center: vesicle %" PetscInt_FMT " lies in the solid of obstacle %" PetscInt_FMT
                 "; allowed: vesicles in the fluid",
                 v + 1, b + 1);
    }
    for (PetscInt c = 0; c < s->vesicles; c++)
      PetscCheck(c == b || own->container[b] || !Holds(s, b, s->X + 2 * s->start[c], period), scene->comm,
                 PETSC_ERR_USER_INPUT,
                 "-obstacle_shape: obstacle %" PetscInt_FMT " lies within obstacle %" PetscInt_FMT
                 "; allowed: obstacles apart from one another",
                 c + 1, b + 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That no obstacle crosses another one, itself or a vesicle. */
static PetscErrorCode CheckCrossing(Scene scene, const PetscReal period[2]) {
  const Shape *s = &scene->obstacles.outline, *v = &scene->shape;
  const PetscInt n = v->vesicles, M = v->start[n], all = n + s->vesicles;
  PetscInt *start, pair[2];
  PetscReal *X;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(all + 1, &start, 2 * (M + s->start[s->vesicles]), &X));
  PetscCall(PetscArraycpy(start, v->start, n));
  for (PetscInt b = 0; b <= s->vesicles; b++) start[n + b] = M + s->start[b];
  PetscCall(PetscArraycpy(X, v->X, 2 * M));
  PetscCall(PetscArraycpy(X + 2 * M, s->X, 2 * s->start[s->vesicles]));
  PetscCall(CurvesCross(all, start, X, NULL, period, PETSC_TRUE, pair));
  PetscCall(PetscFree2(start, X));
  const PetscInt b = pair[1] - n + 1;
  PetscCheck(pair[0] < 0 || pair[0] >= n, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_center: vesicle %" PetscInt_FMT " crosses obstacle %" PetscInt_FMT
             "; allowed: vesicles in the fluid",
             pair[0] + 1, b);
  PetscCheck(pair[0] < 0, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: obstacles %" PetscInt_FMT " and %" PetscInt_FMT
             " cross; allowed: curves apart from one another, from themselves and from their images",
             pair[0] - n + 1, b);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckObstacles(Scene scene) {
  PetscReal period[2];
  PetscFunctionBeginUser;
  PetscCall(CheckMethod(scene));
  for (int d = 0; d < 2; d++)
    period[d] = scene->fluid.bc[d] == BC_PERIODIC ? scene->fluid.box[2 * d + 1] - scene->fluid.box[2 * d] : 0;
  for (PetscInt b = 0; b < scene->obstacles.outline.vesicles; b++) PetscCall(CheckPlace(scene, b));
  PetscCall(CheckCrossing(scene, period));
  PetscCall(CheckInside(scene, period));
  PetscFunctionReturn(PETSC_SUCCESS);
}
