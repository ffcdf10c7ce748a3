/* First shapes in three dimensions: spheroids and ellipsoids by their options, any surfaces from a file. */
#include "scene/checks.h"
#include "scene/properties.h"
#include "scene/space.h"
#include "sphere/shape.h"

#define OFF 0.05      /* of R0: root mean square distance up to which points lie on the surface that fits them */
#define REVOLVED 1e-8 /* of R0: coefficients that a body of revolution has not, which are neglected */
#define SPREAD 1e-4   /* of points: worse spread ones leave coefficients open */

/* X[3][count] of a capsule, or of a spheroid whose grid has its poles on the axis. */
static PetscErrorCode SurfaceRevolved(Scene s, PetscInt v, const PetscReal axes[], PetscReal X[]) {
  const PetscReal reduced = ListEntry(&s->space.reduced_volume, 1, v, 0), R = ListEntry(&s->space.radius, 1, v, 0);
  Sphere revolved;
  PetscReal *c;
  PetscFunctionBeginUser;
  PetscCall(SphereCreate(s->space.degree, SPHERE_REVOLVED, &revolved));
  PetscCall(PetscMalloc1(revolved->size, &c));
  if (s->space.spheroid == SPHEROID_CAPSULE)
    PetscCall(ShapeCapsule(revolved, reduced, R, c));
  else
    SurfaceSpheroid(s->space.degree, axes[0], axes[1], c);
  SphereUnfold(revolved, 3, c, X);
  PetscCall(PetscFree(c));
  PetscCall(SphereDestroy(&revolved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficients and radius of a spheroid, a capsule or an ellipsoid. */
static PetscErrorCode SurfaceOfOptions(Scene s, PetscInt v, PetscReal X[], PetscReal *R0) {
  const SceneSpace *own = &s->space;
  const PetscInt count = HarmonicsCount(own->degree);
  PetscReal axes[3], axis[3], center[3];
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) {
    axes[d] = ListEntry(&own->half_axes, 3, v, d);
    axis[d] = ListEntry(&own->axis, 3, v, d);
    center[d] = ListEntry(&s->vesicles.center, 3, v, d);
  }
  *R0 = ListEntry(&own->radius, 1, v, 0);
  if (SceneGiven(s, "-vesicle_half_axes"))
    *R0 = PetscCbrtReal(axes[0] * axes[1] * axes[2]);
  else {
    ShapeSpheroid(ListEntry(&own->reduced_volume, 1, v, 0), (PetscBool)(own->spheroid == SPHEROID_OBLATE), *R0,
                  &axes[0], &axes[1]);
    axes[2] = axes[1];
  }
  if (s->dim == DIM_AXIAL || own->spheroid == SPHEROID_CAPSULE)
    PetscCall(SurfaceRevolved(s, v, axes, X));
  else
    SurfaceEllipsoid(own->degree, axes, X);
  if (s->dim == DIM_AXIAL)
    X[0] += center[0] * PetscSqrtReal(4 * PETSC_PI);
  else
    ShapeAlign(count, axis, center, X);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
/* Coefficients from the lines x[n][5] "l m c_x c_y c_z". */
static PetscErrorCode SurfaceOfCoefficients(Scene s, PetscInt v, PetscInt n, const PetscReal x[], PetscReal X[]) {
  const PetscInt p = s->space.degree, count = HarmonicsCount(p);
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(X, 3 * count));
  for (const PetscReal *line = x; line < x + 5 * n; line += 5) {
    const PetscReal l = line[0], m = line[1];
    PetscCall(SCENE_REFUSE_IF(s, l != PetscFloorReal(l) || m != PetscFloorReal(m) || PetscAbsReal(m) > l || l > p,
      "-vesicle_file {-vesicle_file}: surface %.0f has a coefficient of l = %g, m = %g; allowed: whole numbers |m| <= l <= %g, the -sphere_degree", {v + 1, l, m, p}));
    for (int d = 0; d < 3; d++) X[d * count + (PetscInt)(l * l + l + m)] = line[2 + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficients that fit the points x[n][3]; off: root mean square distance of the points from the surface. */
static PetscErrorCode SurfaceOfPoints(Scene s, PetscInt v, Sphere sphere, PetscInt n, const PetscReal x[],
                                      PetscReal X[], PetscReal *off) {
  PetscReal spread;
  PetscFunctionBeginUser;
  PetscCall(SCENE_REFUSE_IF(s, n < sphere->count,
    "-vesicle_file {-vesicle_file}: surface %.0f has %.0f points; allowed: %.0f or more, one a harmonic of -sphere_degree {-sphere_degree}", {v + 1, n, sphere->count}));
  PetscCall(ShapeFit(sphere, n, x, X, &spread, off));
  PetscFunctionReturn(SCENE_REFUSE_IF(s, spread < SPREAD,
    "-vesicle_file {-vesicle_file}: the points of surface %.0f leave parts of it open; allowed: points on all sides, or a lower -sphere_degree than {-sphere_degree}", {v + 1}));
}

/* That the coefficients X[3][count] are those of a body of revolution. */
static PetscErrorCode SurfaceCheckRevolved(Scene s, PetscInt v, PetscReal R0, const PetscReal X[]) {
  const PetscInt size = 3 * HarmonicsCount(s->space.degree);
  PetscReal *c, *again, off = 0;
  Sphere revolved;
  PetscFunctionBeginUser;
  PetscCall(SphereCreate(s->space.degree, SPHERE_REVOLVED, &revolved));
  PetscCall(PetscMalloc2(revolved->size, &c, size, &again));
  SphereFold(revolved, X, c);
  SphereUnfold(revolved, 3, c, again);
  for (PetscInt k = 0; k < size; k++) off = PetscMax(off, PetscAbsReal(again[k] - X[k]));
  const PetscBool outward = (PetscBool)(c[s->space.degree + 1] > 0); /* the distance from the axis is positive */
  PetscCall(PetscFree2(c, again));
  PetscCall(SphereDestroy(&revolved));
  PetscFunctionReturn(SCENE_REFUSE_IF(s, !(off <= REVOLVED * R0) || !outward,
    "-vesicle_file {-vesicle_file}: surface %.0f is no body of revolution about x; allowed with -dim axisymmetric: coefficients c_x of m = 0 and equal ones c_y of m = 1, c_z of m = -1, those of l = 1 positive", {v + 1}));
}

/* Coefficients and radius of surface v of a file: where the file has it, of its size unless -vesicle_radius is given,
   moved by -vesicle_center. */
static PetscErrorCode SurfaceOfFile(Scene s, const SurfaceRows *rows, PetscInt v, Surface at, PetscReal X[],
                                    PetscReal *R0) {
  const PetscInt first = v ? rows->end[v - 1] : 0, n = rows->end[v] - first, count = at->sphere->count;
  const PetscReal *x = rows->x + first * rows->columns, root = PetscSqrtReal(4 * PETSC_PI);
  PetscReal off = 0;
  ShapeMoments m;
  PetscFunctionBeginUser;
  if (rows->columns == 3)
    PetscCall(SurfaceOfPoints(s, v, at->sphere, n, x, X, &off));
  else
    PetscCall(SurfaceOfCoefficients(s, v, n, x, X));
  PetscCall(SurfacePlace(at, X, PETSC_FALSE));
  PetscCall(ShapeMeasure(at, &m));
  const PetscReal own = PetscCbrtReal(3 * at->volume / (4 * PETSC_PI));
  PetscCall(SCENE_REFUSE_IF(s, off > OFF * own,
    "-vesicle_file {-vesicle_file}: the points of surface %.0f are %.2g R0 from what degree {-sphere_degree} fits; allowed: %g, with a higher -sphere_degree or points of a surface that each ray from its centroid crosses once", {v + 1, off / own, OFF}));
  PetscCall(SCENE_REFUSE_IF(s, !ShapeIsStar(at, m.center),
    "-vesicle_file {-vesicle_file}: surface %.0f folds or crosses itself; allowed: a surface that each ray from its centroid crosses once, at a -sphere_degree that resolves it", {v + 1}));
  if (s->dim == DIM_AXIAL) PetscCall(SurfaceCheckRevolved(s, v, own, X));
  *R0 = SceneGiven(s, "-vesicle_radius") ? ListEntry(&s->space.radius, 1, v, 0) : own;
  for (PetscInt k = 0; k < 3 * count; k++) X[k] *= *R0 / own;
  for (int d = 0; d < 3; d++)
    X[d * count] += root * (ListEntry(&s->vesicles.center, 3, v, d) + (1 - *R0 / own) * m.center[d]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneReadSurfaces(Draft s, SurfaceRows *rows) {
  PetscFunctionBeginUser;
  if (!*s->vesicles.file) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SurfacesFromFile(s->comm, "-vesicle_file", s->vesicles.file, rows));
  PetscCall(SCENE_REFUSE_IF(s, SceneGiven(s, "-vesicle_count") && s->vesicles.count != rows->surfaces,
    "-vesicle_count {-vesicle_count}: -vesicle_file {-vesicle_file} has %.0f surfaces; allowed: the same number", {rows->surfaces}));
  s->vesicles.count = rows->surfaces;
  PetscCall(PetscStrncpy(s->shape.digest, rows->digest, DIGEST));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

PetscErrorCode SceneMakeSurfaces(Draft s, SurfaceRows *rows) {
  const PetscInt count = s->vesicles.count, size = 3 * HarmonicsCount(s->space.degree);
  Sphere sphere;
  Surface at;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(count * size, &s->space.X, count, &s->space.R0));
  for (PetscInt v = 0; v < count && !rows->surfaces; v++)
    PetscCall(SurfaceOfOptions(s, v, s->space.X + v * size, &s->space.R0[v]));
  if (!rows->surfaces) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphereCreate(s->space.degree, SPHERE_WHOLE, &sphere));
  PetscCall(SurfaceCreate(sphere, &at));
  for (PetscInt v = 0; v < count; v++) PetscCall(SurfaceOfFile(s, rows, v, at, s->space.X + v * size, &s->space.R0[v]));
  PetscCall(SurfaceDestroy(&at));
  PetscCall(SphereDestroy(&sphere));
  PetscCall(PetscFree(rows->end));
  PetscCall(PetscFree(rows->x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
