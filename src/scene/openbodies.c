#include "scene/openbodies.h"
#include "kernel/kernel.h"
#include "scene/properties.h"

#define SAMPLES 4000 /* of a curve, where it is looked for its places off a wall */
#define HALVINGS 50  /* of a sample, to find the place */
#define LEAST_RISE 2 /* cells off its wall, in its middle */
#define BUMP_POINTS 257

/* Distance (length) of X from a wall, negative behind it. */
static PetscReal ArcOff(const FluidSpec *f, PetscInt wall, const PetscReal X[2]) {
  return (wall % 2 ? -1 : 1) * (X[wall / 2] - f->box[wall]);
}

/* The wall that X is nearest to, and how far that is. */
static PetscInt ArcNearestWall(const FluidSpec *f, const PetscReal X[2], PetscReal *off) {
  PetscInt nearest = -1;
  *off = PETSC_MAX_REAL;
  for (PetscInt wall = 0; wall < 4; wall++) {
    if (f->bc[wall / 2] != BC_WALL || PetscAbsReal(ArcOff(f, wall, X)) >= PetscAbsReal(*off)) continue;
    *off = ArcOff(f, wall, X);
    nearest = wall;
  }
  return nearest;
}

/* The parameter between two at which the curve leaves the height, low below it and high above. */
static PetscReal ArcLeave(const FluidSpec *f, const Curve *c, PetscInt wall, PetscReal height, PetscReal low,
                          PetscReal high) {
  for (int it = 0; it < HALVINGS; it++) {
    const PetscReal middle = 0.5 * (low + high);
    PetscReal X[2];
    CurveEvaluate(c, middle, X);
    if (ArcOff(f, wall, X) < height)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* Both ends are on one wall, which is returned. */
static PetscErrorCode ArcCheckEnds(Scene scene, PetscInt b, const Curve *c, PetscReal height, PetscInt *wall) {
  const FluidSpec *f = &scene->fluid;
  PetscInt at[2];
  PetscFunctionBeginUser;
  for (int end = 0; end < 2; end++) {
    PetscReal X[2], off;
    CurveEvaluate(c, end, X);
    at[end] = ArcNearestWall(f, X, &off);
    PetscCheck(at[end] >= 0 && off <= height, scene->comm, PETSC_ERR_USER_INPUT,
               "-obstacle_shape: obstacle %" PetscInt_FMT " is open and ends at (%g, %g), on no wall; allowed: both "
               "ends on one wall of the box, closed curves, and ones whose last point is the first but for a period",
               b + 1, (double)X[0], (double)X[1]);
  }
  PetscCheck(at[0] == at[1], scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: obstacle %" PetscInt_FMT " is open and ends on two walls; allowed: both ends on one",
             b + 1);
  *wall = at[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArcCut(Scene scene, PetscInt b, const Curve *c, PetscReal part[2], PetscInt *wall) {
  const FluidSpec *f = &scene->fluid;
  const PetscReal h = FluidSpecCellSize(f);
  const PetscReal height = PetscMax(0.5 * scene->obstacles.spacing, KERNEL_FOLDED_CELLS) * h;
  PetscReal least = PETSC_MAX_REAL, most = 0;
  PetscFunctionBeginUser;
  PetscCall(ArcCheckEnds(scene, b, c, height, wall));
  for (int end = 0; end < 2; end++) {
    const PetscReal step = (end ? -1. : 1.) / SAMPLES;
    PetscReal t = end, X[2];
    for (PetscInt k = 0; k < SAMPLES; k++, t += step) {
      CurveEvaluate(c, t + step, X);
      if (ArcOff(f, *wall, X) > height) break;
    }
    part[end] = ArcLeave(f, c, *wall, height, t, t + step);
  }
  for (PetscInt k = 0; k <= SAMPLES; k++) {
    PetscReal X[2];
    CurveEvaluate(c, part[0] + (part[1] - part[0]) * (PetscReal)k / SAMPLES, X);
    least = PetscMin(least, ArcOff(f, *wall, X));
    most = PetscMax(most, ArcOff(f, *wall, X));
  }
  PetscCheck(part[0] < part[1] && most >= LEAST_RISE * h, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: obstacle %" PetscInt_FMT " rises %.3g cells from its wall; allowed: at least %d", b + 1,
             (double)(most / h), LEAST_RISE);
  PetscCheck(least >= height * (1 - 1e-6), scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape: obstacle %" PetscInt_FMT " comes back to its wall between its ends; allowed: a curve of "
             "its own for each bump",
             b + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArcBump(Scene scene, int side, Curve *curve) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscReal *box = scene->fluid.box, width = box[3] - box[2], middle = ListEntry(&own->center, 2, 0, 0);
  const PetscReal length = own->length > 0 ? own->length : width, height = 0.5 * (1 - own->throat) * width;
  const CurveKind open = {.type = CURVE_OPEN};
  PetscReal xy[2 * BUMP_POINTS];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < BUMP_POINTS; k++) { /* the solid on the left */
    const PetscReal t = (PetscReal)k / (BUMP_POINTS - 1) - 0.5;
    const PetscReal rise = 0.5 * height * (1 + PetscCosReal(2 * PETSC_PI * t));
    xy[2 * k] = middle + (side ? t : -t) * length;
    xy[2 * k + 1] = side ? box[3] - rise : box[2] + rise;
  }
  PetscCall(CurveFromPoints(&open, BUMP_POINTS, xy, curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}
