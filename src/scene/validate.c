/* Checks that involve more than one option, and -view. */
#include "scene/scene.h"

PetscReal SceneCellSize(Scene scene) {
  return (scene->box.v[1] - scene->box.v[0]) / scene->cells.v[0];
}

static PetscErrorCode CheckDomain(Scene scene) {
  const PetscReal *b = scene->box.v;
  const PetscInt *n = scene->cells.v;
  PetscReal hx, hy;
  PetscFunctionBeginUser;
  PetscCheck(scene->box.n == 4, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_box: %" PetscInt_FMT " numbers given; allowed: x_min,x_max,y_min,y_max", scene->box.n);
  PetscCheck(scene->cells.n == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_cells: %" PetscInt_FMT " numbers given; allowed: two, cells in x and in y", scene->cells.n);
  PetscCheck(b[0] < b[1] && b[2] < b[3], scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_box %g,%g,%g,%g: empty; allowed: x_min < x_max and y_min < y_max", (double)b[0], (double)b[1],
             (double)b[2], (double)b[3]);
  hx = (b[1] - b[0]) / n[0];
  hy = (b[3] - b[2]) / n[1];
  PetscCheck(PetscAbsReal(hx - hy) <= 1e-10 * hx, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_cells %" PetscInt_FMT ",%" PetscInt_FMT
             ": cells of %g x %g; allowed: square cells, for this -domain_box %g cells in y",
             n[0], n[1], (double)hx, (double)hy, (double)((b[3] - b[2]) / hx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckFlow(Scene scene) {
  const PetscBool x_periodic = scene->bc[0] == BC_PERIODIC, y_periodic = scene->bc[1] == BC_PERIODIC;
  const PetscInt type = scene->flow.type;
  PetscFunctionBeginUser;
  PetscCheck(
      scene->inertia != INERTIA_CONVECTIVE || type != FLOW_CUSTOM, scene->comm, PETSC_ERR_USER_INPUT,
      "-fluid_inertia convective: not with -flow_type custom, whose gradient is not known; allowed: none, unsteady");
  if (scene->flow.form != FORM_TOTAL || type == FLOW_QUIESCENT) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(type != FLOW_CUSTOM, scene->comm, PETSC_ERR_USER_INPUT,
             "-flow_form total: not with -flow_type custom; allowed: -flow_form disturbance");
  PetscCheck(!y_periodic, scene->comm, PETSC_ERR_USER_INPUT,
             "-flow_form total: the background flow is not periodic in y; allowed: -domain_bc_y wall or -flow_form "
             "disturbance");
  PetscCheck(type != FLOW_EXTENSION || !x_periodic, scene->comm, PETSC_ERR_USER_INPUT,
             "-flow_form total: extension is not periodic in x; allowed: -domain_bc_x wall or -flow_form disturbance");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A list has `each` numbers a vesicle, or (shared) `each` for all of them. */
static PetscErrorCode CheckList(Scene scene, const char name[], PetscInt n, PetscInt each, PetscBool shared) {
  PetscFunctionBeginUser;
  PetscCheck(n == each * scene->count || (shared && n == each), scene->comm, PETSC_ERR_USER_INPUT,
             "%s: %" PetscInt_FMT " numbers given; allowed: %" PetscInt_FMT " for each of -vesicle_count %" PetscInt_FMT
             " vesicles%s",
             name, n, each, scene->count, shared ? ", or once for all" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckVesicle(Scene scene) {
  const PetscBool by_area = SceneGiven(scene, "-vesicle_area") || SceneGiven(scene, "-vesicle_reduced_area");
  PetscFunctionBeginUser;
  PetscCheck(!(by_area && SceneGiven(scene, "-vesicle_semi_axes")), scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_semi_axes: given together with -vesicle_area or -vesicle_reduced_area; allowed: one description "
             "of the ellipse");
  PetscCall(CheckList(scene, "-vesicle_semi_axes", scene->axes.n, 2, PETSC_TRUE));
  PetscCall(CheckList(scene, "-vesicle_area", scene->area.n, 1, PETSC_TRUE));
  PetscCall(CheckList(scene, "-vesicle_reduced_area", scene->reduced_area.n, 1, PETSC_TRUE));
  if (scene->shape != SHAPE_FILE) { /* the number of curves is known later */
    PetscCall(CheckList(scene, "-vesicle_center", scene->center.n, 2, PETSC_FALSE));
    PetscCall(CheckList(scene, "-vesicle_angle", scene->angle.n, 1, PETSC_TRUE));
  }
  PetscCheck(scene->shape != SHAPE_FILE || *scene->file, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_shape file: no -vesicle_file given; allowed: a text file with x y a line");
  PetscCheck(!*scene->file || scene->shape == SHAPE_FILE, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_file %s: not read; allowed: with -vesicle_shape file only", scene->file);
  PetscCheck(scene->shape == SHAPE_NONE || !scene->markers || scene->markers >= 8, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_markers %" PetscInt_FMT ": too few; allowed: at least 8", scene->markers);
  PetscCheck(!(scene->markers && scene->spacing > 0), scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_markers %" PetscInt_FMT ": given together with -vesicle_spacing; allowed: one of them",
             scene->markers);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SceneIsProjection(Scene scene) {
  return !strcmp(scene->scheme, "split") || !strcmp(scene->scheme, "penalty") ? PETSC_TRUE : PETSC_FALSE;
}

/* split and penalty are their papers' methods: one order, kernel ib6 and differences, none of the corrections of the
   coupled scheme. Options that were not given follow; given ones that they do not have are mistakes. */
static PetscErrorCode CheckProjection(Scene scene) {
  const char *const name = scene->scheme;
  const PetscBool split = !strcmp(name, "split") ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (!SceneGiven(scene, "-scheme_order")) scene->order = 1;
  if (!SceneGiven(scene, "-delta_type")) PetscCall(PetscStrncpy(scene->delta, "ib6", sizeof(scene->delta)));
  if (!SceneGiven(scene, "-membrane_derivative")) scene->derivative = DERIVATIVE_FD;
  if (!SceneGiven(scene, "-coupling_self_mobility")) scene->self_mobility = SELF_NONE;
  if (!SceneGiven(scene, "-scheme_area_target")) scene->area_target = PETSC_FALSE;
  PetscCheck(scene->order == 1, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_order %" PetscInt_FMT ": the %s of -scheme_type %s is of first order; allowed: 1", scene->order,
             split ? "splitting error" : "forward step of the markers", name);
  PetscCheck(scene->derivative != DERIVATIVE_SPECTRAL, scene->comm, PETSC_ERR_USER_INPUT,
             "-membrane_derivative spectral: not with -scheme_type %s, whose %s; allowed: fd, bending, or -scheme_type "
             "coupled or direct",
             name, split ? "preconditioner knows chords only" : "springs are chords");
  PetscCheck(!scene->area_target, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_area_target true: not with -scheme_type %s; allowed: false, or -scheme_type coupled or direct",
             name);
  PetscCheck(scene->inertia != INERTIA_NONE, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_inertia none: not with -scheme_type %s, %s; allowed: unsteady, or -scheme_type coupled or direct",
             name,
             split ? "whose projection stands on the inertia: it puts dt I in place of H^-1"
                   : "whose projection step starts from the velocity before it");
  PetscCheck(scene->inertia != INERTIA_CONVECTIVE, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_inertia convective: not with -scheme_type %s, %s for unsteady Stokes flow; allowed: unsteady, or "
             "-scheme_type coupled or direct",
             name, split ? "the paper's method" : "here");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What penalty alone has or lacks. */
static PetscErrorCode CheckPenalty(Scene scene, PetscBool split) {
  PetscBool penalty;
  PetscFunctionBeginUser;
  PetscCall(PetscStrcmp(scene->scheme, "penalty", &penalty));
  if (penalty && !SceneGiven(scene, "-scheme_bending")) scene->bending_at = BENDING_EXPLICIT;
  PetscCheck(!penalty || scene->bending_at == BENDING_EXPLICIT, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_bending implicit: -scheme_type penalty has all membrane forces at the old markers; allowed: "
             "explicit, or -scheme_type split, coupled or direct");
  PetscCheck(penalty || split || scene->bending_at == BENDING_IMPLICIT, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_bending explicit: not with -scheme_type %s, whose stability stands on implicit bending; allowed: "
             "implicit, or -scheme_type split or penalty",
             scene->scheme);
  PetscCheck(!penalty || scene->self_mobility == SELF_NONE, scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_self_mobility: not with -scheme_type penalty, whose forces are explicit; allowed: none, or "
             "-scheme_type coupled or direct");
  PetscCheck(penalty || scene->stiffness == 0, scene->comm, PETSC_ERR_USER_INPUT,
             "-penalty_stiffness %g: -scheme_type %s has no springs, its length is a constraint; allowed: 0, or "
             "-scheme_type penalty",
             (double)scene->stiffness, scene->scheme);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckScheme(Scene scene) {
  PetscBool split;
  PetscFunctionBeginUser;
  PetscCall(PetscStrcmp(scene->scheme, "split", &split));
  if (SceneIsProjection(scene)) PetscCall(CheckProjection(scene));
  PetscCall(CheckPenalty(scene, split));
  PetscCheck(scene->adapt == ADAPT_NONE || scene->order == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-time_adapt error: with -scheme_type %s of order %" PetscInt_FMT
             "; allowed: coupled or direct with -scheme_order 2",
             scene->scheme, scene->order);
  PetscCheck(scene->inertia != INERTIA_CONVECTIVE || scene->order == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_inertia convective: with -scheme_order %" PetscInt_FMT
             " an explicit convection is unstable at any step that is not tiny; allowed: -scheme_order 2",
             scene->order);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneValidate(Scene scene) {
  PetscFunctionBeginUser;
  PetscCall(CheckScheme(scene));
  PetscCall(CheckDomain(scene));
  PetscCall(CheckFlow(scene));
  PetscCall(CheckVesicle(scene));
  PetscCheck(scene->t_end / scene->dt < 1e9, scene->comm, PETSC_ERR_USER_INPUT,
             "-time_step %g: more than 1e9 steps to -time_end %g; allowed: a larger step", (double)scene->dt,
             (double)scene->t_end);
  PetscCheck(*scene->output_dir, scene->comm, PETSC_ERR_USER_INPUT, "-output_dir: empty; allowed: a folder's name");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewFluid(Scene scene, PetscViewer v) {
  static const char *const forms[] = {"disturbance of the background flow", "total velocity with moving walls"};
  static const char *const inertia[] = {"unsteady Stokes", "quasi-steady Stokes", "unsteady Stokes",
                                        "Navier-Stokes, convection explicit"};
  const PetscBool no_mean = scene->inertia == INERTIA_NONE && scene->bc[0] == BC_PERIODIC && scene->bc[1] == BC_PERIODIC
                                ? PETSC_TRUE
                                : PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(v, "fluid: %s%s, nu = %g, solved for the %s\n", inertia[scene->inertia],
                                   SceneGiven(scene, "-fluid_inertia") ? "" : " (default for this scene)",
                                   (double)scene->viscosity, forms[scene->flow.form]));
  PetscCall(PetscViewerASCIIPrintf(v, "Reynolds number: %.4g\n", (double)scene->reynolds));
  if (no_mean) PetscCall(PetscViewerASCIIPrintf(v, "periodic box: the disturbance has no mean flow\n"));
  if (*scene->warning) PetscCall(PetscViewerASCIIPrintf(v, "warning: %s\n", scene->warning));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneView(Scene scene, const Shape *shape, PetscViewer v) {
  static const char *const derivatives[] = {"finite differences", "spectral bending", "spectral bending and edges"};
  static const char *const self[] = {"none", "local", "symbol"};
  static const char *const bc[] = {"wall", "periodic"};
  static const char *const flows[] = {"quiescent", "shear", "poiseuille", "extension", "custom"};
  const PetscReal *b = scene->box.v, h = SceneCellSize(scene);
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(v, "Model in force\n"));
  PetscCall(PetscViewerASCIIPushTab(v));
  PetscCall(PetscViewerASCIIPrintf(
      v, "domain: [%g,%g] x [%g,%g], %" PetscInt_FMT " x %" PetscInt_FMT " cells, h = %g, %s in x, %s in y\n",
      (double)b[0], (double)b[1], (double)b[2], (double)b[3], scene->cells.v[0], scene->cells.v[1], (double)h,
      bc[scene->bc[0]], bc[scene->bc[1]]));
  PetscCall(ViewFluid(scene, v));
  PetscCall(PetscViewerASCIIPrintf(v, "background flow: %s\n", flows[scene->flow.type]));
  if (!shape->vesicles) PetscCall(PetscViewerASCIIPrintf(v, "vesicle: none (no tension solve, no bending solve)\n"));
  for (PetscInt k = 0; k < shape->vesicles; k++)
    PetscCall(PetscViewerASCIIPrintf(v, "vesicle %" PetscInt_FMT ": %" PetscInt_FMT " markers, tension on\n", k + 1,
                                     shape->start[k + 1] - shape->start[k]));
  if (shape->vesicles && scene->bending > 0)
    PetscCall(PetscViewerASCIIPrintf(v, "bending: on, c_b = %g\n", (double)scene->bending));
  else
    PetscCall(PetscViewerASCIIPrintf(v, "bending: off (no bending solve)\n"));
  if (shape->vesicles)
    PetscCall(PetscViewerASCIIPrintf(v, "membrane: kernel %s, %s, self-mobility %s, area target %s\n", scene->delta,
                                     derivatives[scene->derivative], self[scene->self_mobility],
                                     scene->area_target ? "on" : "off"));
  PetscCall(PetscViewerASCIIPrintf(v, "scheme: %s, order %" PetscInt_FMT ", dt = %g to t = %g\n", scene->scheme,
                                   scene->order, (double)scene->dt, (double)scene->t_end));
  PetscCall(PetscViewerASCIIPrintf(v, "fast solves: helmholtz %s, poisson %s\n", scene->helmholtz, scene->poisson));
  PetscCall(PetscViewerASCIIPopTab(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
