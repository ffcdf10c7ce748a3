/* The initial markers of a scene: equal edges on an ellipse or on a curve from a file. */
#include "curve/crossing.h"
#include "kernel/kernel.h"
#include "scene/resolve.h"

#define MAX_NEWTON 20 /* of the first markers; four are usual */
#define MANY 100      /* markers, from which on it matters that Fourier transforms of them are fast */
#define LEEWAY 0.04   /* by which their number may differ for it */

/* The odd number with prime factors up to 13 that is nearest to M, if one is near. */
static PetscInt FastOdd(PetscInt M) {
  for (PetscInt away = 0; away <= LEEWAY * M; away += 2)
    for (int side = -1; side <= 1; side += 2) {
      PetscInt left = M + side * away;
      for (PetscInt p = 3; p <= 13; p += 2)
        while (left % p == 0) left /= p;
      if (left == 1) return M + side * away;
    }
  return M;
}

/* lambda_t rate of the flow with a vesicle of radius R0; 0 where either is zero. */
static PetscReal Chi(Scene scene, PetscReal R0) {
  const Flow *flow = &scene->flow;
  PetscReal rate = 0;
  if (flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION) rate = PetscAbsReal(flow->rate);
  if (flow->type == FLOW_POISEUILLE) rate = 2 * PetscAbsReal(flow->peak) / flow->half_width;
  if (scene->membrane.bending == 0) return 0;
  return rate * scene->fluid.nu * PetscPowRealInt(R0, 3) / scene->membrane.bending;
}

#define THINNEST 8 /* times the markers of a round vesicle, at most */

/* With the exact near field markers have to resolve the shape, not the grid: 45 for a reduced area of 0.6 and more, in
   proportion more for thinner ones, half as many more where the flow is so strong that membranes wrinkle; and no edge
   longer than two cells, so that the kernel leaks nothing. */
static PetscReal WantedByShape(Scene scene, PetscReal length, PetscReal area) {
  const PetscReal V = 4 * PETSC_PI * area / PetscSqr(length), thin = PetscMin(THINNEST, PetscMax(1, 0.6 / V));
  const PetscReal strong = Chi(scene, length / (2 * PETSC_PI)) >= 100 ? 1.5 : 1;
  return PetscMax(45 * thin * strong, length / (2 * FluidSpecCellSize(&scene->fluid)));
}

/* Dense matrices of a vesicle grow with the square of its markers: 3 GB and more above it, and 32-bit sizes end soon.
 */
#define MOST_MARKERS 10000

/* Number of markers of a curve: the user's own; by the shape; or the even (for spectral edges odd) number nearest to
   length/(spacing h). */
static PetscErrorCode MarkerCount(Scene scene, PetscReal length, PetscReal area, PetscInt *M) {
  const Kernel *kernel = KernelFind(scene->coupling.kernel);
  const SceneVesicles *own = &scene->vesicles;
  const PetscBool exact = scene->coupling.near_field == NEAR_EXACT ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool spectral = scene->membrane.derivative == DERIVATIVE_SPECTRAL ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal spacing = own->spacing > 0 ? own->spacing : kernel->default_spacing;
  const PetscReal h = FluidSpecCellSize(&scene->fluid), pairs = length / (2 * spacing * h);
  const PetscBool by_shape = exact && !own->markers && own->spacing == 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal wanted = own->markers ? own->markers : (by_shape ? WantedByShape(scene, length, area) : 2 * pairs);
  PetscFunctionBeginUser;
  PetscCheck(own->markers <= MOST_MARKERS, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_markers %" PetscInt_FMT ": more than the dense matrices of a vesicle hold; allowed: at most %d",
             own->markers, MOST_MARKERS);
  PetscCheck(
      wanted <= MOST_MARKERS, scene->comm, PETSC_ERR_USER_INPUT,
      "-vesicle_spacing %g: %.3g markers on a membrane of length %g at h = %g; allowed: at most %d a vesicle, so "
      "a smaller vesicle, a larger spacing or coarser -domain_cells",
      (double)own->spacing, (double)wanted, (double)length, (double)h, MOST_MARKERS);
  if (own->markers)
    *M = own->markers;
  else if (by_shape)
    *M = 2 * (PetscInt)PetscCeilReal((wanted - 1) / 2 * (1 - 1e-12)) + 1;
  else /* odd: no Nyquist mode */
    *M = spectral ? 2 * (PetscInt)PetscFloorReal(pairs) + 1 : 2 * (PetscInt)PetscFloorReal(pairs + 0.5);
  if (!own->markers && !by_shape && spectral && *M > MANY) *M = FastOdd(*M);
  PetscCheck(*M >= 8, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_spacing %g: %" PetscInt_FMT
             " markers on a membrane of length %g at h = %g; allowed: at least 8, so a finer -domain_cells",
             (double)spacing, *M, (double)length, (double)h);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That M markers on a curve are as far apart as kernel and near field need. */
static PetscErrorCode CheckSpacing(Scene scene, PetscReal length, PetscInt M) {
  const Kernel *kernel = KernelFind(scene->coupling.kernel);
  const SceneVesicles *own = &scene->vesicles;
  const PetscReal h = FluidSpecCellSize(&scene->fluid);
  const PetscReal least = scene->coupling.near_field == NEAR_EXACT ? NEAR_LEAST_SPACING : kernel->least_spacing;
  /* rounding to a number of markers may go just below the limit */
  const PetscReal s = own->spacing > 0 ? own->spacing : length / (M * h);
  PetscFunctionBeginUser;
  PetscCheck(own->allow_close_markers || (!own->markers && !own->spacing) || s >= least * (1 - 1e-12), scene->comm,
             PETSC_ERR_USER_INPUT,
             "-vesicle_%s %g: markers %g h apart with -delta_type %s; allowed: at least %g h "
             "(-vesicle_allow_close_markers goes on)",
             own->markers ? "markers" : "spacing", own->markers ? (double)own->markers : (double)own->spacing,
             (double)s, scene->coupling.kernel, (double)least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entry k of a list that has one entry for all or one a vesicle. */
static PetscReal Entry(const RealList *list, PetscInt each, PetscInt vesicle, PetscInt component) {
  return list->v[list->n > each ? each * vesicle + component : component];
}

/* The scene's curves about the origin. */
static PetscErrorCode MakeCurves(Scene scene, PetscInt *count, Curve **out) {
  Curve *curve;
  PetscFunctionBeginUser;
  *count = scene->vesicles.shape < SHAPE_FILE ? scene->vesicles.count : 0;
  PetscCall(PetscCalloc1(*count, &curve));
  *out = curve;
  for (PetscInt k = 0; k < *count; k++) {
    const PetscReal area = Entry(&scene->vesicles.area, 1, k, 0), V = Entry(&scene->vesicles.reduced_area, 1, k, 0);
    if (scene->vesicles.shape == SHAPE_BICONCAVE)
      PetscCall(BiconcaveCurve(area, V, &curve[k]));
    else if (SceneByArea(scene))
      PetscCall(EllipseAxes(area, V, curve[k].axes));
    else
      for (int c = 0; c < 2; c++) curve[k].axes[c] = Entry(&scene->vesicles.axes, 2, k, c);
  }
  if (scene->vesicles.shape != SHAPE_FILE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CurvesFromFile(scene->comm, scene->vesicles.file, count, out));
  PetscCheck(!SceneGiven(scene, "-vesicle_count") || scene->vesicles.count == *count, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_count %" PetscInt_FMT ": -vesicle_file %s has %" PetscInt_FMT
             " curves; allowed: the same number",
             scene->vesicles.count, scene->vesicles.file, *count);
  PetscCheck(scene->vesicles.center.n == 2 || scene->vesicles.center.n == 2 * *count, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_center: %" PetscInt_FMT " numbers given for %" PetscInt_FMT
             " curves; allowed: two for all or two a curve",
             scene->vesicles.center.n, *count);
  PetscCheck(scene->vesicles.angle.n == 1 || scene->vesicles.angle.n == *count, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_angle: %" PetscInt_FMT " numbers given for %" PetscInt_FMT
             " curves; allowed: one for all or one a curve",
             scene->vesicles.angle.n, *count);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turn and move markers of vesicle v. What is no file's is about the origin. */
static void Place(Scene scene, const Curve *curve, PetscInt v, PetscInt M, PetscReal X[]) {
  PetscReal about[2] = {0, 0};
  const PetscReal turn = Entry(&scene->vesicles.angle, 1, v, 0) * PETSC_PI / 180, c = PetscCosReal(turn),
                  s = PetscSinReal(turn);
  if (scene->vesicles.shape == SHAPE_FILE && turn != 0) CurveCentroid(curve, about);
  for (PetscInt k = 0; k < M; k++) {
    const PetscReal x = X[2 * k] - about[0], y = X[2 * k + 1] - about[1];
    X[2 * k] = Entry(&scene->vesicles.center, 2, v, 0) + about[0] + c * x - s * y;
    X[2 * k + 1] = Entry(&scene->vesicles.center, 2, v, 1) + about[1] + s * x + c * y;
  }
}

#define OUTLINE 256 /* points that stand for a curve */

/* The options that a vesicle's size comes from. */
static PetscErrorCode SizeOptions(Scene scene, PetscInt v, char text[], size_t length) {
  const SceneVesicles *own = &scene->vesicles;
  PetscFunctionBeginUser;
  if (own->shape == SHAPE_FILE)
    PetscCall(PetscSNPrintf(text, length, "-vesicle_file %s", own->file));
  else if (SceneByArea(scene))
    PetscCall(PetscSNPrintf(text, length, "-vesicle_area %g -vesicle_reduced_area %g",
                            (double)Entry(&own->area, 1, v, 0), (double)Entry(&own->reduced_area, 1, v, 0)));
  else
    PetscCall(PetscSNPrintf(text, length, "-vesicle_semi_axes %g,%g", (double)Entry(&own->axes, 2, v, 0),
                            (double)Entry(&own->axes, 2, v, 1)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That a curve, turned and moved, is between the walls and no longer than a period: before markers are fitted to it. */
static PetscErrorCode CheckRoom(Scene scene, const Curve *curve, PetscInt v) {
  const FluidSpec *f = &scene->fluid;
  PetscReal X[2 * OUTLINE];
  char size[256];
  PetscFunctionBeginUser;
  PetscCall(SizeOptions(scene, v, size, sizeof(size)));
  for (PetscInt k = 0; k < OUTLINE; k++) CurveEvaluate(curve, (PetscReal)k / OUTLINE, X + 2 * k);
  Place(scene, curve, v, OUTLINE, X);
  for (int dir = 0; dir < 2 && f->bc[dir] != BC_FREE; dir++) {
    const PetscReal *wall = f->box + 2 * dir, width = wall[1] - wall[0];
    PetscReal low = X[dir], high = X[dir];
    for (PetscInt k = 1; k < OUTLINE; k++) {
      low = PetscMin(low, X[2 * k + dir]);
      high = PetscMax(high, X[2 * k + dir]);
    }
    PetscCheck(high - low <= width, scene->comm, PETSC_ERR_USER_INPUT,
               "%s: vesicle %" PetscInt_FMT " is %g long in %c, -domain_box %g; allowed: one that fits in", size, v + 1,
               (double)(high - low), dir ? 'y' : 'x', (double)width);
    const int side = high > wall[1] ? 1 : 0;
    PetscCheck(f->bc[dir] == BC_PERIODIC || (low >= wall[0] && high <= wall[1]), scene->comm, PETSC_ERR_USER_INPUT,
               "-vesicle_center %g,%g: vesicle %" PetscInt_FMT
               " reaches %c = %g, beyond the wall %c_%s = %g; allowed: a vesicle inside -domain_box",
               (double)Entry(&scene->vesicles.center, 2, v, 0), (double)Entry(&scene->vesicles.center, 2, v, 1), v + 1,
               dir ? 'y' : 'x', (double)(side ? high : low), dir ? 'y' : 'x', side ? "max" : "min", (double)wall[side]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether (x, y) is inside the polygon X[2M]: crossings of a ray. */
static PetscBool Inside(PetscInt M, const PetscReal X[], PetscReal x, PetscReal y) {
  PetscBool inside = PETSC_FALSE;
  for (PetscInt k = 0, p = M - 1; k < M; p = k++)
    if ((X[2 * k + 1] > y) != (X[2 * p + 1] > y) &&
        x < (X[2 * p] - X[2 * k]) * (y - X[2 * k + 1]) / (X[2 * p + 1] - X[2 * k + 1]) + X[2 * k])
      inside = !inside;
  return inside;
}

static void Bounds(const Shape *s, PetscInt v, PetscReal box[2][2]) {
  for (int d = 0; d < 2; d++) {
    box[d][0] = PETSC_MAX_REAL;
    box[d][1] = -PETSC_MAX_REAL;
    for (PetscInt k = s->start[v]; k < s->start[v + 1]; k++) {
      box[d][0] = PetscMin(box[d][0], s->X[2 * k + d]);
      box[d][1] = PetscMax(box[d][1], s->X[2 * k + d]);
    }
  }
}

/* Whether vesicle b, or an image of it, lies inside vesicle a, given that they do not cross. box[2][2] holds a. */
static PetscBool Encloses(const Shape *s, PetscInt a, PetscInt b, PetscReal box[2][2], const PetscReal period[2]) {
  const PetscReal *X = s->X + 2 * s->start[a], *at = s->X + 2 * s->start[b];
  for (int p = -1; p <= 1; p++)
    for (int q = -1; q <= 1; q++) {
      if ((p && period[0] == 0) || (q && period[1] == 0)) continue;
      const PetscReal x = at[0] + p * period[0], y = at[1] + q * period[1];
      if (x < box[0][0] || x > box[0][1] || y < box[1][0] || y > box[1][1]) continue;
      if (Inside(s->start[a + 1] - s->start[a], X, x, y)) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* No vesicle crosses another, an image of one or itself, nor lies within another. */
static PetscErrorCode CheckOverlap(Scene scene, const Shape *s) {
  const PetscBool smooth = scene->membrane.derivative == DERIVATIVE_SPECTRAL ? PETSC_TRUE : PETSC_FALSE;
  PetscReal period[2];
  PetscInt pair[2];
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++)
    period[d] = scene->fluid.bc[d] == BC_PERIODIC ? scene->fluid.box[2 * d + 1] - scene->fluid.box[2 * d] : 0;
  PetscCall(CurvesCross(s->vesicles, s->start, s->X, period, smooth, pair));
  PetscCheck(pair[0] < 0 || pair[0] != pair[1], scene->comm, PETSC_ERR_USER_INPUT,
             "%s: vesicle %" PetscInt_FMT
             " crosses itself or its periodic image; allowed: curves that do not, in a box that holds them",
             scene->vesicles.shape == SHAPE_FILE ? "-vesicle_file" : "-domain_box", pair[0] + 1);
  for (PetscInt a = 0; a < s->vesicles && pair[0] < 0; a++) {
    PetscReal box[2][2];
    Bounds(s, a, box);
    for (PetscInt b = 0; b < s->vesicles && pair[0] < 0; b++)
      if (a != b && Encloses(s, a, b, box, period)) {
        pair[0] = PetscMin(a, b);
        pair[1] = PetscMax(a, b);
      }
  }
  PetscCheck(pair[0] < 0, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_center: vesicles %" PetscInt_FMT " and %" PetscInt_FMT
             " overlap; allowed: vesicles apart from one another",
             pair[0] + 1, pair[1] + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneLargestRadius(Scene scene, PetscReal *R0) {
  PetscInt n;
  Curve *curve;
  PetscFunctionBeginUser;
  *R0 = 0;
  PetscCall(MakeCurves(scene, &n, &curve));
  for (PetscInt v = 0; v < n; v++) {
    *R0 = PetscMax(*R0, CurveLength(&curve[v]) / (2 * PETSC_PI));
    PetscCall(CurveDestroy(&curve[v]));
  }
  PetscCall(PetscFree(curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneMakeShape(Scene scene, Shape *shape) {
  Curve *curve;
  PetscFunctionBeginUser;
  shape->X = NULL;
  shape->longest = 0;
  PetscCall(MakeCurves(scene, &shape->vesicles, &curve));
  PetscCall(PetscCalloc1(shape->vesicles + 1, &shape->start));
  for (PetscInt v = 0; v < shape->vesicles; v++) {
    PetscInt M;
    PetscCall(CheckRoom(scene, &curve[v], v));
    PetscCall(MarkerCount(scene, CurveLength(&curve[v]), CurveArea(&curve[v]), &M));
    PetscCall(CheckSpacing(scene, CurveLength(&curve[v]), M));
    PetscCheck(shape->start[v] < PETSC_MAX_INT / 8 - M, scene->comm, PETSC_ERR_USER_INPUT,
               "-vesicle_count %" PetscInt_FMT ": more markers than this PETSc can number; allowed: fewer vesicles",
               shape->vesicles);
    shape->start[v + 1] = shape->start[v] + M;
    shape->longest = PetscMax(shape->longest, CurveLength(&curve[v]));
  }
  PetscCall(PetscMalloc1(2 * shape->start[shape->vesicles], &shape->X));
  for (PetscInt v = 0; v < shape->vesicles; v++) {
    PetscReal *X = shape->X + 2 * shape->start[v], left;
    const PetscInt M = shape->start[v + 1] - shape->start[v];
    if (scene->membrane.derivative == DERIVATIVE_SPECTRAL) {
      PetscCall(CurveEqualArcs(&curve[v], M, X));
      /* what M markers sample of a curve with sharper tips than they resolve has neither its length nor its area */
      PetscCall(CurveFit(M, PETSC_TRUE, CurveLength(&curve[v]), CurveArea(&curve[v]), X, MAX_NEWTON, &left));
    } else
      PetscCall(CurveEqualChords(&curve[v], M, X));
    Place(scene, &curve[v], v, M, X);
    PetscCall(CurveDestroy(&curve[v]));
  }
  PetscCall(PetscFree(curve));
  PetscCall(CheckOverlap(scene, shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}
