/* -view: the model in force. */
#include "scene/scene.h"
#include "scene/checks.h"
#include "scene/properties.h"
#include "scene/table.h"

/* Print the texts of the rows whose conditions hold, a line each. */
static PetscErrorCode ViewRows(Scene scene, PetscViewer v, size_t rows, const SceneRule row[]) {
  char text[PETVES_MAX_MESSAGE];
  PetscFunctionBeginUser;
  for (size_t k = 0; k < rows; k++) {
    if (!row[k].holds) continue;
    PetscCall(SceneText(scene, 1, &row[k], text));
    PetscCall(PetscViewerASCIIPrintf(v, "%s\n", text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
#define VIEW(scene, viewer, rows) ViewRows(scene, viewer, sizeof(rows) / sizeof((rows)[0]), rows)

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

/* clang-format off */
static PetscErrorCode ViewFluid(Scene s, PetscViewer v) {
  const FluidSpec *f = &s->fluid;
  const PetscBool contrast = SceneHasContrast(s);
  PetscReal low = PETSC_MAX_REAL, high = 0;
  char model[SCENE_MODEL];
  for (PetscInt k = 0; k < s->shape.vesicles; k++) {
    low = PetscMin(low, SceneViscosityRatio(s, k));
    high = PetscMax(high, SceneViscosityRatio(s, k));
  }
  SceneModel(s, model);
  const SceneRule rows[] = {
    {f->form == FORM_DISTURBANCE, "fluid: %s, nu = {-fluid_viscosity}, solved for the disturbance of the background flow", .word = {model}},
    {f->form == FORM_TOTAL, "fluid: %s, nu = {-fluid_viscosity}, solved for the total velocity with moving walls", .word = {model}},
    {s->reynolds >= 0, "Reynolds number: %.4g", {s->reynolds}},
    {!(s->reynolds >= 0), "Reynolds number: not known"},
    {s->shape.vesicles && SceneHasGravity(s), "gravity: {-fluid_gravity} by the vesicles' density differences"},
    {contrast && low >= high, "viscosity inside over outside: %g", {low}},
    {contrast && low < high, "viscosity inside over outside: %g to %g", {low, high}},
    {f->drive == DRIVE_FLUX, "channel: no flux of the disturbance"},
    {f->inertia == INERTIA_NONE && f->bc[0] == BC_PERIODIC && f->bc[1] == BC_PERIODIC, "periodic box: the disturbance has no mean flow"},
    {*s->warning, "warning: %s", .word = {s->warning}}};
  return VIEW(s, v, rows);
}

/* The background flow, and its dimensionless number where it has one. */
static PetscErrorCode ViewFlow(Scene s, PetscViewer v) {
  const Flow *flow = &s->flow;
  const PetscReal R0 = s->shape.longest / (2 * PETSC_PI), c_b = s->membrane.bending;
  const PetscReal time = c_b > 0 ? s->fluid.nu * PetscPowRealInt(R0, 3) / c_b : 0;
  const PetscBool channel = flow->type == FLOW_POISEUILLE, strain = flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION;
  const SceneRule rows[] = {
    {channel && time > 0, "background flow: {-flow_type}, u_max = %g: Ca = u_max nu R0^2/c_b = %g with R0 = %g, nu R0^3/c_b = %g", {flow->peak, flow->peak * time / R0, R0, time}},
    {strain && time > 0, "background flow: {-flow_type}, rate = %g: chi = rate nu R0^3/c_b = %g with R0 = %g, nu R0^3/c_b = %g", {flow->rate, flow->rate * time, R0, time}},
    {channel && time == 0, "background flow: {-flow_type}, u_max = %g", {flow->peak}},
    {strain && time == 0, "background flow: {-flow_type}, rate = %g", {flow->rate}},
    {flow->type == FLOW_FORMULA, "background flow: {-flow_type}, u = %.100s, v = %.100s", .word = {flow->formula[0], flow->formula[1]}},
    {!channel && !strain && flow->type != FLOW_FORMULA, "background flow: {-flow_type}"}};
  return VIEW(s, v, rows);
}

static PetscErrorCode ViewVesicles(Scene s, PetscViewer v) {
  static const char *const derivatives[] = {"finite differences", "spectral bending", "spectral bending and edges"};
  const PetscInt n = s->shape.vesicles, *start = s->shape.start;
  const PetscReal *b = s->fluid.box, part = ShapePolygonArea(&s->shape) / ((b[1] - b[0]) * (b[3] - b[2])), hard = s->membrane.bending;
  const char *const packed = s->vesicles.packing > 0 ? ", packed" : "";
  PetscReal soft = PETSC_MAX_REAL, few = PETSC_MAX_REAL, many = 0;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal M = start[k + 1] - start[k];
    few = PetscMin(few, M);
    many = PetscMax(many, M);
    soft = PetscMin(soft, s->membrane.material[k].bending);
    const SceneRule one[] = {{n <= FEW, "vesicle %.0f: %.0f markers, tension on", {k + 1, M}}};
    PetscCall(VIEW(s, v, one));
  }
  const SceneRule rows[] = {
    {!n, "vesicle: none (no tension solve, no bending solve)"},
    {n > FEW && few < many, "vesicles: %.0f of %.0f to %.0f markers, area fraction %.4g%s", {n, few, many, part}, {packed}},
    {n > FEW && few == many, "vesicles: %.0f of %.0f markers, area fraction %.4g%s", {n, many, part}, {packed}},
    {!n || hard == 0, "bending: off (no bending solve)"},
    {n && hard > 0 && soft >= hard, "bending: on, c_b = %g", {soft}},
    {n && hard > 0 && soft < hard, "bending: on, c_b = %g to %g", {soft, hard}},
    {n, "membrane: kernel {-delta_type}, %s, near field %s, area target %s", .word = {derivatives[s->membrane.derivative], ViewNearField(s), SceneHasAreaTarget(s) ? "on" : "off"}}};
  PetscCall(VIEW(s, v, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewPlane(Scene s, PetscViewer v) {
  const PetscReal *b = s->fluid.box, h = FluidSpecCellSize(&s->fluid);
  const PetscBool free = FluidSpecIsFree(&s->fluid), fixed = s->time.adapt == ADAPT_NONE;
  const SceneRule domain[] = {
    {1, "domain: [%g,%g] x [%g,%g], %.0f x %.0f cells, h = %g, {-domain_bc_x} in x, {-domain_bc_y} in y", {b[0], b[1], b[2], b[3], s->fluid.cells[0], s->fluid.cells[1], h}}};
  const SceneRule scheme[] = {
    {fixed, "scheme: {-scheme_type}, order {-scheme_order}, dt = {-time_step} to t = {-time_end}"},
    {!fixed, "scheme: {-scheme_type}, order {-scheme_order}, dt = {-time_step} at first, then by -time_adapt error, to t = {-time_end}"},
    {free, "unbounded fluid: no Stokes solve, the box is the window of the fields"},
    {!free, "fast solves: helmholtz {-helmholtz_type}, poisson {-poisson_type}"}};
  PetscFunctionBeginUser;
  PetscCall(VIEW(s, v, domain));
  PetscCall(ViewFluid(s, v));
  PetscCall(ViewFlow(s, v));
  PetscCall(ViewVesicles(s, v));
  PetscCall(VIEW(s, v, scheme));
  PetscCall(ViewDefaults(s, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewSpace(Scene s, PetscViewer v) {
  const PetscBool axial = (PetscBool)(s->dim == DIM_AXIAL), in_tube = (PetscBool)(s->space.tube.radius > 0);
  const PetscInt p = s->space.degree, n = axial ? 3 * p + 2 : 4 * PetscSqr(p + 1);
  const char *const about = axial ? ", axisymmetric about x" : "", *const throat = s->space.tube.throat > 0 ? " with a throat" : "";
  const SceneRule rows[] = {
    {!in_tube, "fluid: quasi-steady flow without bounds in three dimensions%s, nu = {-fluid_viscosity}", .word = {about}},
    {in_tube, "fluid: quasi-steady flow in a tube of radius {-tube_radius}%s in three dimensions%s, nu = {-fluid_viscosity}", .word = {throat, about}},
    {1, "vesicles: {-vesicle_count} of %.0f unknowns, spherical harmonics of degree {-sphere_degree}", {n}},
    {1, "scheme: order {-scheme_order}, dt = {-time_step} to t = {-time_end}, labels at the rate {-sphere_label_rate}"}};
  return VIEW(s, v, rows);
}
PetscErrorCode SceneSayModel(Scene s) {
  char model[SCENE_MODEL] = "", text[PETVES_MAX_MESSAGE];
  const char *const steps = s->time.adapt == ADAPT_NONE ? "fixed steps of" : "adaptive steps from";
  const char *const where = s->space.tube.radius > 0 ? "in a tube" : "without bounds";
  PetscFunctionBeginUser;
  if (s->dim == DIM_PLANE) SceneModel(s, model);
  const SceneRule rows[] = {
    {s->dim == DIM_AXIAL, "quasi-steady flow %s, axisymmetric, degree {-sphere_degree}, %s {-time_step}", .word = {where, steps}},
    {s->dim == DIM_SPACE, "quasi-steady flow %s, three dimensions, degree {-sphere_degree}, %s {-time_step}", .word = {where, steps}},
    {s->reynolds > 0, "%s, Re = %.3g, %s {-time_step}", {s->reynolds}, {model, steps}},
    {s->reynolds == 0, "%s, %s {-time_step}", .word = {model, steps}},
    {1, "%s, Re not known, %s {-time_step}", .word = {model, steps}}};
  PetscCall(SCENE_TEXT(s, rows, text));
  PetscCall(PetvesSay(s->comm, "petves: %s\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

PetscErrorCode SceneView(Scene scene, PetscViewer v) {
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(v, "Model in force\n"));
  PetscCall(PetscViewerASCIIPushTab(v));
  PetscCall(scene->dim == DIM_PLANE ? ViewPlane(scene, v) : ViewSpace(scene, v));
  PetscCall(PetscViewerASCIIPopTab(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
