/* The initial markers of a scene: equal edges on ellipses or on curves from a file, each where it belongs. */
#include "scene/vesicles.h"
#include "curve/crossing.h"
#include "scene/checks.h"
#include "scene/properties.h"

/* Markers X on a kind's curve, turned and moved, as Y, which may be X. */
static void KindPlace(const Kind *kind, const Pose *at, PetscInt M, const PetscReal X[], PetscReal Y[]) {
  const PetscReal c = at->along[0], s = at->along[1], *about = kind->pivot;
  for (PetscInt k = 0; k < M; k++) {
    const PetscReal x = X[2 * k] - about[0], y = X[2 * k + 1] - about[1];
    Y[2 * k] = at->center[0] + about[0] + c * x - s * y;
    Y[2 * k + 1] = at->center[1] + about[1] + s * x + c * y;
  }
}

#define OUTLINE 256 /* points that stand for a curve */

void KindExtend(const Kind *kind, const Pose *at, PetscReal around[4]) {
  for (PetscInt k = 0; k < OUTLINE; k++) {
    PetscReal X[2];
    CurveEvaluate(&kind->curve, (PetscReal)k / OUTLINE, X);
    KindPlace(kind, at, 1, X, X);
    CurveBounds(1, X, around);
  }
}

/* Width of the narrowest channel that a vesicle fits into: of this area and length L, a rectangle with round ends,
   whose half width is R (1 - sqrt(1 - V)), R = L/(2 pi) and V the reduced area. */
static PetscReal KindLeastWidth(const Kind *kind) {
  const PetscReal L = CurveLength(&kind->curve), A = PetscAbsReal(CurveArea(&kind->curve));
  return (L - PetscSqrtReal(PetscMax(0, L * L - 4 * PETSC_PI * A))) / PETSC_PI;
}

/* Check that a curve, turned and moved, is between the walls and no longer than a period, before markers are fitted to
   the curve. */
/* clang-format off */
static PetscErrorCode VesicleCheckRoom(Scene scene, const Kind *kind, const Pose *at, PetscInt v) {
  const FluidSpec *f = &scene->fluid;
  const PetscReal *size = kind->given;
  const PetscBool file = scene->vesicles.shape == SHAPE_FILE, by_area = SceneByArea(scene);
  PetscReal around[4] = CURVE_NOWHERE;
  PetscFunctionBeginUser;
  KindExtend(kind, at, around);
  for (int d = 0; d < 2 && f->bc[d] != BC_FREE; d++) {
    const PetscReal *wall = f->box + 2 * d, width = wall[1] - wall[0], low = around[2 * d], high = around[2 * d + 1];
    const PetscBool too_long = high - low > width, walls = f->bc[d] != BC_PERIODIC;
    const PetscReal least = walls && f->bc[!d] == BC_PERIODIC ? KindLeastWidth(kind) : 0; /* of a channel */
    const SceneRule rules[] = {
      {width < least,
       "-domain_box: vesicle %.0f fits into no channel as narrow as %g, that in %c; allowed: above %g, twice R (1 - sqrt(1 - V)), R its length over 2 pi, V its reduced area", {v + 1, width, "xy"[d], least}},
      {too_long && file,
       "-vesicle_file {-vesicle_file}: vesicle %.0f is %g long in %c, -domain_box %g; allowed: one that fits in", {v + 1, high - low, "xy"[d], width}},
      {too_long && by_area,
       "-vesicle_area %g -vesicle_reduced_area %g: vesicle %.0f is %g long in %c, -domain_box %g; allowed: one that fits in", {size[0], size[1], v + 1, high - low, "xy"[d], width}},
      {too_long,
       "-vesicle_semi_axes %g,%g: vesicle %.0f is %g long in %c, -domain_box %g; allowed: one that fits in", {size[0], size[1], v + 1, high - low, "xy"[d], width}},
      {walls && high > wall[1],
       "-vesicle_center %g,%g: vesicle %.0f reaches %c = %g, beyond the wall %c_max = %g; allowed: a vesicle inside -domain_box", {at->center[0], at->center[1], v + 1, "xy"[d], high, "xy"[d], wall[1]}},
      {walls && low < wall[0],
       "-vesicle_center %g,%g: vesicle %.0f reaches %c = %g, beyond the wall %c_min = %g; allowed: a vesicle inside -domain_box", {at->center[0], at->center[1], v + 1, "xy"[d], low, "xy"[d], wall[0]}}};
    PetscCall(REFUSE(scene, rules));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

/* A search for a vesicle whose first marker, or an image of it, lies within another vesicle. */
typedef struct {
  const Shape *shape;
  const PetscReal *period;
  PetscInt *pair;
} WithinSearch;

/* Vesicle i has point i, its middle, and point vesicles + i, its first marker. */
static PetscBool VesicleIsWithin(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  const WithinSearch *w = (const WithinSearch *)context;
  const Shape *s = w->shape;
  const PetscInt within = j - s->vesicles;
  if (within < 0 || within == i || !ShapeHolds(s, i, s->X + 2 * s->start[within], w->period)) return PETSC_FALSE;
  w->pair[0] = PetscMin(i, within);
  w->pair[1] = PetscMax(i, within);
  return PETSC_TRUE;
}

/* Two vesicles of which one, or an image of it, lies within the other, given that no vesicles cross; -1: none. A point
   within a vesicle is nearer to the middle than half its length. */
static PetscErrorCode VesiclesFindWithin(const Shape *s, const PetscReal period[2], PetscInt pair[2]) {
  const PetscInt n = s->vesicles, middles[2] = {0, n};
  WithinSearch search = {s, period, pair};
  PetscReal *X;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * n, &X));
  for (PetscInt v = 0; v < n; v++) {
    ShapeMiddle(s, v, X + 2 * v);
    PetscCall(PetscArraycpy(X + 2 * (n + v), s->X + 2 * s->start[v], 2));
  }
  PetscCall(PairsWithin(2 * n, X, middles, period, s->longest / 2, VesicleIsWithin, &search));
  PetscCall(PetscFree(X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
/* No vesicle crosses another, an image of one or itself, nor lies within another. */
static PetscErrorCode VesiclesCheckOverlap(Scene scene, const Shape *s) {
  const PetscBool smooth = scene->membrane.derivative == DERIVATIVE_SPECTRAL;
  PetscReal period[2];
  PetscInt pair[2];
  PetscFunctionBeginUser;
  FluidSpecPeriods(&scene->fluid, period);
  const CurveSet set = {s->vesicles, s->vesicles, s->start, NULL, s->X, period, smooth};
  PetscCall(CurvesCross(&set, pair));
  if (pair[0] < 0) PetscCall(VesiclesFindWithin(s, period, pair));
  const PetscBool itself = pair[0] >= 0 && pair[0] == pair[1];
  const SceneRule rules[] = {
    {itself && scene->vesicles.shape == SHAPE_FILE,
     "-vesicle_file: vesicle %.0f crosses itself or its periodic image; allowed: curves that do not, in a box that holds them", {pair[0] + 1}},
    {itself,
     "-domain_box: vesicle %.0f crosses itself or its periodic image; allowed: curves that do not, in a box that holds them", {pair[0] + 1}},
    {pair[0] >= 0,
     "-vesicle_center: vesicles %.0f and %.0f overlap; allowed: vesicles apart from one another", {pair[0] + 1, pair[1] + 1}}};
  PetscCall(REFUSE(scene, rules));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

/* Fit the kinds, and make the shape with the numbers of their markers. */
static PetscErrorCode VesiclesCreateShape(Scene scene, Kinds *kinds, Shape *shape) {
  PetscInt *markers, all = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(kinds->vesicles, &markers));
  for (PetscInt v = 0; v < kinds->vesicles; v++) {
    Kind *kind = &kinds->kind[kinds->of[v]];
    if (!kind->M) PetscCall(KindFit(scene, kind));
    PetvesCheck(all < PETSC_MAX_INT / 8 - kind->M, scene->comm,
                "-vesicle_count %" PetscInt_FMT ": more markers than this PETSc can number; allowed: fewer vesicles",
                kinds->vesicles);
    markers[v] = kind->M;
    all += kind->M;
  }
  PetscCall(ShapeCreate(kinds->vesicles, markers, NULL, shape));
  PetscCall(PetscFree(markers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneMakeShape(Draft scene) {
  Shape *shape = &scene->shape;
  Kinds kinds;
  Pose *pose;
  PetscFunctionBeginUser;
  PetscCall(KindsCreate(scene, &kinds));
  if (kinds.kinds) PetscCall(PetscStrncpy(shape->digest, kinds.kind[0].curve.digest, DIGEST));
  PetscCall(PetscMalloc1(kinds.vesicles, &pose));
  PetscCall(PetscMalloc1(kinds.vesicles, &scene->membrane.material));
  PetscCall(ScenePlace(scene, &kinds, pose));
  for (PetscInt v = 0; v < kinds.vesicles; v++)
    PetscCall(VesicleCheckRoom(scene, &kinds.kind[kinds.of[v]], &pose[v], v));
  PetscCall(VesiclesCreateShape(scene, &kinds, shape));
  for (PetscInt v = 0; v < kinds.vesicles; v++) {
    const Kind *kind = &kinds.kind[kinds.of[v]];
    KindPlace(kind, &pose[v], kind->M, kind->X, shape->X + 2 * shape->start[v]);
    if (kind->rest && !scene->membrane.rest_X)
      PetscCall(PetscMalloc1(2 * shape->start[kinds.vesicles], &scene->membrane.rest_X));
    if (kind->rest) PetscCall(PetscArraycpy(scene->membrane.rest_X + 2 * shape->start[v], kind->rest, 2 * kind->M));
    scene->membrane.material[v] = kind->material;
  }
  PetscCall(PetscFree(pose));
  PetscCall(KindsDestroy(&kinds));
  PetscCall(VesiclesCheckOverlap(scene, shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDropShape(Draft scene) {
  PetscFunctionBeginUser;
  PetscCall(ShapeDestroy(&scene->shape));
  PetscCall(PetscFree(scene->vesicles.kind));
  PetscCall(PetscFree(scene->membrane.rest_X));
  PetscCall(PetscFree(scene->membrane.material));
  PetscFunctionReturn(PETSC_SUCCESS);
}
