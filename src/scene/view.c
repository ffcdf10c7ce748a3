/* -view: the model in force. */
#include "scene/scene.h"
#include "scene/checks.h"
#include "scene/properties.h"
#include "scene/space.h"
#include "scene/table.h"

/* "what = low", or "what = low to high". */
static PetscErrorCode ViewRange(PetscViewer v, const char what[], PetscReal low, PetscReal high) {
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(v, low < high ? "%s%g to %g\n" : "%s%g\n", what, (double)low, (double)high));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewFluid(Scene scene, PetscViewer v) {
  static const char *const forms[] = {"disturbance of the background flow", "total velocity with moving walls"};
  const PetscBool no_mean = scene->fluid.inertia == INERTIA_NONE && scene->fluid.bc[0] == BC_PERIODIC &&
                            scene->fluid.bc[1] == BC_PERIODIC;
  PetscReal low = PETSC_MAX_REAL, high = 0;
  char model[SCENE_MODEL];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < scene->shape.vesicles; k++) {
    low = PetscMin(low, SceneViscosityRatio(scene, k));
    high = PetscMax(high, SceneViscosityRatio(scene, k));
  }
  SceneModel(scene, model);
  PetscCall(PetscViewerASCIIPrintf(v, "fluid: %s, nu = %g, solved for the %s\n", model, (double)scene->fluid.nu,
                                   forms[scene->fluid.form]));
  PetscCall(PetscViewerASCIIPrintf(v, scene->reynolds >= 0 ? "Reynolds number: %.4g\n" : "Reynolds number: not known\n",
                                   (double)scene->reynolds));
  if (scene->shape.vesicles && SceneHasGravity(scene))
    PetscCall(PetscViewerASCIIPrintf(v, "gravity: %g,%g by the vesicles' density differences\n",
                                     (double)scene->gravity.g.v[0], (double)scene->gravity.g.v[1]));
  if (SceneHasContrast(scene)) PetscCall(ViewRange(v, "viscosity inside over outside: ", low, high));
  if (scene->fluid.drive == DRIVE_FLUX) PetscCall(PetscViewerASCIIPrintf(v, "channel: no flux of the disturbance\n"));
  if (no_mean) PetscCall(PetscViewerASCIIPrintf(v, "periodic box: the disturbance has no mean flow\n"));
  if (*scene->warning) PetscCall(PetscViewerASCIIPrintf(v, "warning: %s\n", scene->warning));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The background flow, and its dimensionless number where it has one. */
static PetscErrorCode ViewFlow(Scene scene, PetscViewer v) {
  static const char *const names[] = {"quiescent", "shear", "poiseuille", "extension", "uniform", "custom", "formula"};
  const PetscInt type = scene->flow.type;
  const PetscBool channel = type == FLOW_POISEUILLE;
  const PetscReal R0 = scene->shape.longest / (2 * PETSC_PI), c_b = scene->membrane.bending;
  const PetscReal time = c_b > 0 ? scene->fluid.nu * PetscPowRealInt(R0, 3) / c_b : 0;
  const PetscReal value = channel ? scene->flow.peak : scene->flow.rate;
  char of[256] = "", number[256] = "";
  PetscFunctionBeginUser;
  if (channel || type == FLOW_SHEAR || type == FLOW_EXTENSION)
    PetscCall(PetscSNPrintf(of, sizeof(of), ", %s = %g", channel ? "u_max" : "rate", (double)value));
  if (*of && time > 0)
    PetscCall(PetscSNPrintf(number, sizeof(number), ": %s = %g with R0 = %g, nu R0^3/c_b = %g",
                            channel ? "Ca = u_max nu R0^2/c_b" : "chi = rate nu R0^3/c_b",
                            (double)(channel ? value * time / R0 : value * time), (double)R0, (double)time));
  if (type == FLOW_FORMULA)
    PetscCall(
        PetscSNPrintf(of, sizeof(of), ", u = %.100s, v = %.100s", scene->flow.formula[0], scene->flow.formula[1]));
  PetscCall(PetscViewerASCIIPrintf(v, "background flow: %s%s%s\n", names[type], of, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *ViewNearField(Scene scene) {
  if (scene->coupling.near_field == NEAR_NONE) return "none";
  if (SceneHasBoxPart(scene)) return "exact with box part";
  return scene->coupling.box_part ? "exact without box part (a period is longer than 4 times the other side)" : "exact";
}

#define FEW 8 /* vesicles that get a line each */

/* Area of the polygons of all markers. */
static PetscReal ShapePolygonArea(const Shape *s) {
  PetscReal area = 0;
  for (PetscInt v = 0; v < s->vesicles; v++)
    for (PetscInt k = s->start[v], p = s->start[v + 1] - 1; k < s->start[v + 1]; p = k++)
      area += 0.5 * (s->X[2 * p] * s->X[2 * k + 1] - s->X[2 * k] * s->X[2 * p + 1]);
  return area;
}

static PetscErrorCode ViewVesicles(Scene scene, PetscViewer v) {
  const Shape *shape = &scene->shape;
  const PetscReal *b = scene->fluid.box;
  PetscReal soft = PETSC_MAX_REAL;
  PetscInt few = PETSC_MAX_INT, many = 0;
  char least[32] = "";
  PetscFunctionBeginUser;
  if (!shape->vesicles) PetscCall(PetscViewerASCIIPrintf(v, "vesicle: none (no tension solve, no bending solve)\n"));
  for (PetscInt k = 0; k < shape->vesicles; k++) {
    const PetscInt M = shape->start[k + 1] - shape->start[k];
    few = PetscMin(few, M);
    many = PetscMax(many, M);
    soft = PetscMin(soft, scene->membrane.material[k].bending);
    if (shape->vesicles > FEW) continue;
    PetscCall(
        PetscViewerASCIIPrintf(v, "vesicle %" PetscInt_FMT ": %" PetscInt_FMT " markers, tension on\n", k + 1, M));
  }
  if (few < many) PetscCall(PetscSNPrintf(least, sizeof(least), "%" PetscInt_FMT " to ", few));
  if (shape->vesicles > FEW)
    PetscCall(PetscViewerASCIIPrintf(
        v, "vesicles: %" PetscInt_FMT " of %s%" PetscInt_FMT " markers, area fraction %.4g%s\n", shape->vesicles, least,
        many, (double)(ShapePolygonArea(shape) / ((b[1] - b[0]) * (b[3] - b[2]))),
        scene->vesicles.packing > 0 ? ", packed" : ""));
  if (!shape->vesicles || scene->membrane.bending == 0)
    PetscCall(PetscViewerASCIIPrintf(v, "bending: off (no bending solve)\n"));
  else
    PetscCall(ViewRange(v, "bending: on, c_b = ", soft, scene->membrane.bending));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The defaults that depend on the scene, where one is in force. */
static PetscErrorCode ViewDefaults(Scene scene, PetscViewer v) {
  char value[OPTION_MAX_NAME];
  PetscFunctionBeginUser;
  for (const OptionDefault *d = scene_defaults; d->name; d++) {
    const OptionRow *row = &scene->options.row[OptionFind(&scene->options, d->name)];
    if (!OptionMissing(&scene->options, row, scene) && OptionDepends(&scene->options, scene, d, value))
      PetscCall(PetscViewerASCIIPrintf(v, "default of this scene: %s %s, %s\n", d->name, value, d->why));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneView(Scene scene, PetscViewer v) {
  static const char *const derivatives[] = {"finite differences", "spectral bending", "spectral bending and edges"};
  static const char *const bc[] = {"wall", "periodic", "free"};
  const PetscReal *b = scene->fluid.box, h = FluidSpecCellSize(&scene->fluid);
  const Shape *shape = &scene->shape;
  PetscFunctionBeginUser;
  if (scene->dim != DIM_PLANE) {
    PetscCall(SceneViewSpace(scene, v));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscViewerASCIIPrintf(v, "Model in force\n"));
  PetscCall(PetscViewerASCIIPushTab(v));
  PetscCall(PetscViewerASCIIPrintf(
      v, "domain: [%g,%g] x [%g,%g], %" PetscInt_FMT " x %" PetscInt_FMT " cells, h = %g, %s in x, %s in y\n",
      (double)b[0], (double)b[1], (double)b[2], (double)b[3], scene->fluid.cells[0], scene->fluid.cells[1], (double)h,
      bc[scene->fluid.bc[0]], bc[scene->fluid.bc[1]]));
  PetscCall(ViewFluid(scene, v));
  PetscCall(ViewFlow(scene, v));
  PetscCall(ViewVesicles(scene, v));
  if (shape->vesicles)
    PetscCall(PetscViewerASCIIPrintf(v, "membrane: kernel %s, %s, near field %s, area target %s\n",
                                     scene->coupling.kernel, derivatives[scene->membrane.derivative],
                                     ViewNearField(scene), SceneHasAreaTarget(scene) ? "on" : "off"));
  PetscCall(PetscViewerASCIIPrintf(v, "scheme: %s, order %" PetscInt_FMT ", dt = %g%s to t = %g\n", scene->scheme.type,
                                   scene->scheme.order, (double)scene->time.dt,
                                   scene->time.adapt == ADAPT_NONE ? "" : " at first, then by -time_adapt error,",
                                   (double)scene->time.end));
  if (FluidSpecIsFree(&scene->fluid))
    PetscCall(PetscViewerASCIIPrintf(v, "unbounded fluid: no Stokes solve, the box is the window of the fields\n"));
  else
    PetscCall(PetscViewerASCIIPrintf(v, "fast solves: helmholtz %s, poisson %s\n", scene->fluid.helmholtz,
                                     scene->fluid.poisson));
  PetscCall(ViewDefaults(scene, v));
  PetscCall(PetscViewerASCIIPopTab(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneSayModel(Scene s) {
  const char *steps = s->time.adapt == ADAPT_NONE ? "fixed steps of" : "adaptive steps from";
  char model[SCENE_MODEL], reynolds[64] = "";
  PetscFunctionBeginUser;
  if (s->dim != DIM_PLANE) {
    PetscCall(PetvesSay(s->comm, "petves: quasi-steady flow %s, %s, degree %" PetscInt_FMT ", %s %g\n",
                        s->space.tube.radius > 0 ? "in a tube" : "without bounds",
                        s->dim == DIM_AXIAL ? "axisymmetric" : "three dimensions", s->space.degree, steps,
                        (double)s->time.dt));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SceneModel(s, model);
  if (s->reynolds > 0) PetscCall(PetscSNPrintf(reynolds, sizeof(reynolds), ", Re = %.3g", (double)s->reynolds));
  PetscCall(PetvesSay(s->comm, "petves: %s%s, %s %g\n", model, s->reynolds >= 0 ? reynolds : ", Re not known", steps,
                      (double)s->time.dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}
