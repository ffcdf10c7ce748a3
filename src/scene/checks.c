#include "scene/checks.h"
#include "scene/properties.h"

static PetscErrorCode CheckBox(Scene scene) {
  const PetscReal *b = scene->domain.box.v;
  PetscFunctionBeginUser;
  PetscCheck(scene->domain.box.n == 4, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_box: %" PetscInt_FMT " numbers given; allowed: x_min,x_max,y_min,y_max", scene->domain.box.n);
  PetscCheck(scene->domain.cells.n == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_cells: %" PetscInt_FMT " numbers given; allowed: two, cells in x and in y",
             scene->domain.cells.n);
  PetscCheck(b[0] < b[1] && b[2] < b[3], scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_box %g,%g,%g,%g: empty; allowed: x_min < x_max and y_min < y_max", (double)b[0], (double)b[1],
             (double)b[2], (double)b[3]);
  PetscCheck(
      scene->fluid.bc[0] != BC_WALL || scene->fluid.bc[1] != BC_PERIODIC, scene->comm, PETSC_ERR_USER_INPUT,
      "-domain_bc_y periodic: with walls in x that is a channel along y; allowed: the scene turned by 90 degrees, "
      "-domain_bc_x periodic -domain_bc_y wall with x and y of box, cells, centres, angles and flow exchanged");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckCells(Scene scene) {
  const PetscReal *b = scene->domain.box.v;
  const PetscInt *n = scene->domain.cells.v;
  const PetscReal hx = (b[1] - b[0]) / n[0], hy = (b[3] - b[2]) / n[1];
  const PetscReal far = PetscMax(PetscMax(-b[0], b[1]), PetscMax(-b[2], b[3])) / hx;
  PetscFunctionBeginUser;
  PetscCheck(far * PETSC_MACHINE_EPSILON < 1e-6, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_box %g,%g,%g,%g: reaches %.2g cells from 0,0, where places are rounded to 1e-6 cells or more; "
             "allowed: a box nearer to 0,0",
             (double)b[0], (double)b[1], (double)b[2], (double)b[3], (double)far);
  PetscCheck(2. * n[0] * n[1] < (double)PETSC_MAX_INT, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_cells %" PetscInt_FMT ",%" PetscInt_FMT
             ": %.3g cells are more than this PETSc can number; allowed: at most %.3g in all",
             n[0], n[1], (double)n[0] * n[1], (double)PETSC_MAX_INT / 2);
  PetscCheck(PetscAbsReal(hx - hy) <= 1e-10 * hx, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_cells %" PetscInt_FMT ",%" PetscInt_FMT
             ": cells of %g x %g; allowed: square cells, for this -domain_box %g cells in y",
             n[0], n[1], (double)hx, (double)hy, (double)((b[3] - b[2]) / hx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckFlow(Scene scene) {
  const PetscBool x_periodic = scene->fluid.bc[0] == BC_PERIODIC, y_periodic = scene->fluid.bc[1] == BC_PERIODIC;
  const PetscInt type = scene->flow.type;
  PetscFunctionBeginUser;
  PetscCheck(
      scene->fluid.inertia != INERTIA_CONVECTIVE || type != FLOW_CUSTOM, scene->comm, PETSC_ERR_USER_INPUT,
      "-fluid_inertia convective: not with -flow_type custom, whose gradient is not known; allowed: none, unsteady");
  PetscCheck(scene->flow.velocity.n == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-flow_velocity: %" PetscInt_FMT " numbers given; allowed: two, u_x,u_y", scene->flow.velocity.n);
  for (int d = 0; d < 2; d++)
    PetscCheck(
        type != FLOW_UNIFORM || scene->flow.velocity.v[d] == 0 || scene->fluid.bc[d] != BC_WALL, scene->comm,
        PETSC_ERR_USER_INPUT,
        "-flow_velocity %g,%g: into the walls at %c_min and %c_max; allowed: along walls, which move with it, or "
        "-domain_bc_%c periodic",
        (double)scene->flow.velocity.v[0], (double)scene->flow.velocity.v[1], "xy"[d], "xy"[d], "xy"[d]);
  if (scene->fluid.form != FORM_TOTAL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(
      SceneIsProjection(scene), scene->comm, PETSC_ERR_USER_INPUT,
      "-flow_form total: not with -scheme_type %s, whose near field and fast solves have walls at rest; allowed: "
      "disturbance, or -scheme_type split or penalty",
      scene->scheme.type);
  if (type == FLOW_QUIESCENT) PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCheck(n == each * (PetscInt64)scene->vesicles.count || (shared && n == each), scene->comm, PETSC_ERR_USER_INPUT,
             "%s: %" PetscInt_FMT " numbers given; allowed: %" PetscInt_FMT " for each of -vesicle_count %" PetscInt_FMT
             " vesicles%s",
             name, n, each, scene->vesicles.count, shared ? ", or once for all" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A list that says what vesicles are has `each` numbers for all of them, a vesicle, or with a mixture a kind; packed
   vesicles have no numbers by which a list could name them. */
static PetscErrorCode CheckKinds(Scene scene, const char name[], PetscInt n, PetscInt each) {
  const PetscInt kinds = scene->vesicles.mixture.n;
  PetscFunctionBeginUser;
  if (scene->vesicles.shape == SHAPE_FILE) PetscFunctionReturn(PETSC_SUCCESS); /* their number is known later */
  PetscCheck(n == each || n == each * kinds || kinds == 1, scene->comm, PETSC_ERR_USER_INPUT,
             "%s: %" PetscInt_FMT " numbers given; allowed: %" PetscInt_FMT " for each of %" PetscInt_FMT
             " kinds (-vesicle_mixture), or once for all",
             name, n, each, kinds);
  PetscCheck(n == each || kinds > 1 || scene->vesicles.packing == 0, scene->comm, PETSC_ERR_USER_INPUT,
             "%s: %" PetscInt_FMT " numbers given with -vesicle_packing; allowed: %" PetscInt_FMT
             " for all, or an entry for each kind of -vesicle_mixture",
             name, n, each);
  if (kinds == 1) PetscCall(CheckList(scene, name, n, each, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckPacking(Scene scene) {
  const SceneVesicles *own = &scene->vesicles;
  const PetscBool sized = SceneGiven(scene, "-vesicle_area") || SceneGiven(scene, "-vesicle_semi_axes");
  PetscReal sum = 0;
  PetscFunctionBeginUser;
  PetscCheck(own->packing == 0 || own->shape != SHAPE_BICONCAVE, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_packing %g: not with -vesicle_shape biconcave; allowed: ellipses, the only shape that is packed",
             (double)own->packing);
  for (PetscInt k = 0; k < own->mixture.n; k++) sum += own->mixture.v[k];
  PetscCheck(PetscAbsReal(sum - 1) < 1e-6, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_mixture: its parts add up to %g; allowed: parts that add up to 1", (double)sum);
  PetscCheck(own->packing == 0 || !SceneGiven(scene, "-vesicle_count") || !sized, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_packing %g: given together with -vesicle_count %" PetscInt_FMT
             " and the vesicles' size; allowed: one of the two, the other follows from it",
             (double)own->packing, own->count);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckVesicle(Scene scene) {
  const SceneVesicles *own = &scene->vesicles;
  const PetscBool by_area = SceneGiven(scene, "-vesicle_area") || SceneGiven(scene, "-vesicle_reduced_area");
  PetscFunctionBeginUser;
  PetscCheck(!(by_area && SceneGiven(scene, "-vesicle_semi_axes")), scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_semi_axes: given together with -vesicle_area or -vesicle_reduced_area; allowed: one description "
             "of the ellipse");
  PetscCall(CheckPacking(scene));
  PetscCall(CheckKinds(scene, "-vesicle_semi_axes", scene->vesicles.axes.n, 2));
  PetscCall(CheckKinds(scene, "-vesicle_area", scene->vesicles.area.n, 1));
  PetscCall(CheckKinds(scene, "-vesicle_reduced_area", scene->vesicles.reduced_area.n, 1));
  PetscCall(CheckKinds(scene, "-vesicle_bending", scene->membrane.stiffness.n, 1));
  for (PetscInt k = 0; k < own->reduced_area.n; k++)
    PetscCheck(own->shape != SHAPE_BICONCAVE || (own->reduced_area.v[k] >= 0.35 && own->reduced_area.v[k] <= 0.9),
               scene->comm, PETSC_ERR_USER_INPUT,
               "-vesicle_reduced_area %g: no -vesicle_shape biconcave has it; allowed: 0.35 to 0.9",
               (double)own->reduced_area.v[k]);
  if (scene->vesicles.shape != SHAPE_FILE && scene->vesicles.packing == 0) {
    PetscCall(CheckList(scene, "-vesicle_center", scene->vesicles.center.n, 2, PETSC_FALSE));
    PetscCall(CheckList(scene, "-vesicle_angle", scene->vesicles.angle.n, 1, PETSC_TRUE));
  }
  PetscCheck(scene->vesicles.shape != SHAPE_FILE || *scene->vesicles.file, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_shape file: no -vesicle_file given; allowed: a text file with x y a line");
  PetscCheck(!*scene->vesicles.file || scene->vesicles.shape == SHAPE_FILE, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_file %s: not read; allowed: with -vesicle_shape file only", scene->vesicles.file);
  PetscCheck(scene->vesicles.shape == SHAPE_NONE || !scene->vesicles.markers || scene->vesicles.markers >= 8,
             scene->comm, PETSC_ERR_USER_INPUT, "-vesicle_markers %" PetscInt_FMT ": too few; allowed: at least 8",
             scene->vesicles.markers);
  PetscCheck(!(scene->vesicles.markers && scene->vesicles.spacing > 0), scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_markers %" PetscInt_FMT ": given together with -vesicle_spacing; allowed: one of them",
             scene->vesicles.markers);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* split and penalty are their papers' methods: one order, kernel ib6 and differences, none of the corrections of the
   coupled scheme. */
static PetscErrorCode CheckProjection(Scene scene) {
  const char *const name = scene->scheme.type;
  const PetscBool split = !strcmp(name, "split") ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCheck(scene->scheme.order == 1, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_order %" PetscInt_FMT ": the %s of -scheme_type %s is of first order; allowed: 1",
             scene->scheme.order, split ? "splitting error" : "forward step of the markers", name);
  PetscCheck(scene->membrane.derivative != DERIVATIVE_SPECTRAL, scene->comm, PETSC_ERR_USER_INPUT,
             "-membrane_derivative spectral: not with -scheme_type %s, whose %s; allowed: fd, bending, or -scheme_type "
             "coupled",
             name, split ? "preconditioner knows chords only" : "springs are chords");
  PetscCheck(scene->fluid.inertia != INERTIA_NONE, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_inertia none: not with -scheme_type %s, %s; allowed: unsteady, or -scheme_type coupled", name,
             split ? "whose projection stands on the inertia: it puts dt I in place of H^-1"
                   : "whose projection step starts from the velocity before it");
  PetscCheck(scene->fluid.inertia != INERTIA_CONVECTIVE, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_inertia convective: not with -scheme_type %s, %s for unsteady Stokes flow; allowed: unsteady, or "
             "-scheme_type coupled",
             name, split ? "the paper's method" : "here");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What penalty alone has. */
static PetscErrorCode CheckPenalty(Scene scene) {
  PetscFunctionBeginUser;
  PetscCheck(!strcmp(scene->scheme.type, "penalty") || scene->scheme.stiffness == 0, scene->comm, PETSC_ERR_USER_INPUT,
             "-penalty_stiffness %g: -scheme_type %s has no springs, its length is a constraint; allowed: 0, or "
             "-scheme_type penalty",
             (double)scene->scheme.stiffness, scene->scheme.type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The near field belongs to the unsplit step. */
static PetscErrorCode CheckNearField(Scene scene) {
  PetscFunctionBeginUser;
  PetscCheck(scene->coupling.near_field == NEAR_EXACT || !scene->coupling.box_part, scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_box_part true: stands on the exact near field; allowed: false, or -coupling_near_field exact");
  if (scene->coupling.near_field == NEAR_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!SceneIsProjection(scene), scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_near_field exact: not with -scheme_type %s, which is its paper's method; allowed: none, or "
             "-scheme_type coupled",
             scene->scheme.type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The unsplit steps solve for the velocity by the stream function. */
static PetscErrorCode CheckSolvers(Scene scene) {
  const struct {
    const char *option, *value;
  } all[] = {{"-helmholtz_type", scene->fluid.helmholtz}, {"-poisson_type", scene->fluid.poisson}};
  PetscFunctionBeginUser;
  for (int k = 0; k < 2 && !SceneIsProjection(scene); k++)
    PetscCheck(!strcmp(all[k].value, "fftw_tridiagonal"), scene->comm, PETSC_ERR_USER_INPUT,
               "%s %s: not with -scheme_type %s, which solves in the modes of fftw_tridiagonal; allowed: "
               "fftw_tridiagonal, or -scheme_type split or penalty",
               all[k].option, all[k].value, scene->scheme.type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckScheme(Scene scene) {
  PetscFunctionBeginUser;
  PetscCall(CheckSolvers(scene));
  PetscCall(CheckNearField(scene));
  if (SceneIsProjection(scene)) PetscCall(CheckProjection(scene));
  PetscCall(CheckPenalty(scene));
  PetscCheck(scene->time.adapt == ADAPT_NONE || scene->scheme.order > 1, scene->comm, PETSC_ERR_USER_INPUT,
             "-time_adapt error: with -scheme_type %s of order %" PetscInt_FMT
             "; allowed: coupled with -scheme_order 2 or 3",
             scene->scheme.type, scene->scheme.order);
  PetscCheck(scene->fluid.inertia != INERTIA_CONVECTIVE || scene->scheme.order > 1, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_inertia convective: with -scheme_order %" PetscInt_FMT
             " an explicit convection is unstable at any step that is not tiny; allowed: -scheme_order 2 or 3",
             scene->scheme.order);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheck(Scene scene) {
  PetscFunctionBeginUser;
  PetscCall(CheckScheme(scene));
  PetscCall(CheckBox(scene));
  PetscCall(CheckFlow(scene));
  PetscCall(CheckVesicle(scene));
  PetscCheck(scene->time.end / scene->time.dt < 1e9, scene->comm, PETSC_ERR_USER_INPUT,
             "-time_step %g: more than 1e9 steps to -time_end %g; allowed: a larger step", (double)scene->time.dt,
             (double)scene->time.end);
  PetscCheck(*scene->output.dir, scene->comm, PETSC_ERR_USER_INPUT, "-output_dir: empty; allowed: a folder's name");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step is dense work on the markers alone; there is no grid on which a fluid with inertia or a projection could
   be. */
static PetscErrorCode CheckFreeMethod(Scene scene) {
  PetscFunctionBeginUser;
  PetscCheck(!strcmp(scene->scheme.type, "coupled"), scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_type %s: not with -domain_bc_x free, where no fluid is solved for on a grid; allowed: coupled",
             scene->scheme.type);
  PetscCheck(scene->coupling.near_field == NEAR_EXACT, scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_near_field none: not with -domain_bc_x free, where it is all that moves the markers; allowed: "
             "exact");
  PetscCheck(scene->fluid.inertia == INERTIA_AUTO || scene->fluid.inertia == INERTIA_NONE, scene->comm,
             PETSC_ERR_USER_INPUT,
             "-fluid_inertia %s: not with -domain_bc_x free, which is quasi-steady; allowed: none",
             scene->fluid.inertia == INERTIA_UNSTEADY ? "unsteady" : "convective");
  PetscCheck(!scene->coupling.box_part, scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_box_part true: not with -domain_bc_x free, where there is no box; allowed: false");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckFree(Scene scene) {
  const PetscBool free = FluidSpecIsFree(&scene->fluid);
  PetscFunctionBeginUser;
  PetscCheck(free == (scene->fluid.bc[1] == BC_FREE), scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_bc_%c free: with a boundary in %c; allowed: free in x and y, or in neither", free ? 'x' : 'y',
             free ? 'y' : 'x');
  if (!free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckFreeMethod(scene));
  PetscCheck(scene->shape.vesicles <= SCENE_MOST_FREE, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_bc_x free: %" PetscInt_FMT " vesicles, every pair of which is summed; allowed: up to %d, or a "
             "large -domain_box with walls",
             scene->shape.vesicles, SCENE_MOST_FREE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckGravity(Scene scene) {
  const RealList *g = &scene->gravity.g, *density = &scene->gravity.density;
  const PetscInt entries = scene->vesicles.kind ? scene->vesicles.mixture.n : scene->shape.vesicles;
  PetscFunctionBeginUser;
  PetscCheck(g->n == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_gravity: %" PetscInt_FMT " numbers given; allowed: two, g_x,g_y", g->n);
  PetscCheck(density->n == 1 || density->n == entries, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_density_difference: %" PetscInt_FMT " numbers given for %" PetscInt_FMT
             " vesicles; allowed: one for all or one a vesicle",
             density->n, scene->shape.vesicles);
  PetscCheck(!SceneHasGravity(scene) || !FluidSpecIsFree(&scene->fluid), scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_gravity %g,%g: not with -domain_bc_x free, where a body under a force has no finite velocity in "
             "two dimensions; allowed: walls, or periodic boundaries",
             (double)g->v[0], (double)g->v[1]);
  PetscCheck(scene->fluid.drive != DRIVE_FLUX || !strcmp(scene->scheme.type, "coupled"), scene->comm,
             PETSC_ERR_USER_INPUT, "-flow_drive flux: not with -scheme_type %s; allowed: pressure, or coupled",
             scene->scheme.type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The double layer is of quasi-steady flow: with inertia the inner fluid's velocity obeys another equation than the
   outer one's. It stands on the unsplit step and its near field. */
static PetscErrorCode CheckContrastMethod(Scene scene, PetscReal ratio) {
  const PetscInt inertia = scene->fluid.inertia;
  PetscFunctionBeginUser;
  PetscCheck(!SceneIsProjection(scene), scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio %g: not with -scheme_type %s, which is its paper's method; allowed: 1, or "
             "-scheme_type coupled",
             (double)ratio, scene->scheme.type);
  PetscCheck(inertia == INERTIA_AUTO || inertia == INERTIA_NONE, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio %g: not with -fluid_inertia %s, because with inertia the fluid inside obeys "
             "another equation than the one outside; allowed: 1, or -fluid_inertia none",
             (double)ratio, inertia == INERTIA_UNSTEADY ? "unsteady" : "convective");
  PetscCheck(scene->coupling.near_field == NEAR_EXACT && !strcmp(scene->coupling.kernel, "cbs54"), scene->comm,
             PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio %g: not with -delta_type %s and this -coupling_near_field, whose sums are of "
             "cbs54 and exact; allowed: 1, or -delta_type cbs54 -coupling_near_field exact",
             (double)ratio, scene->coupling.kernel);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckContrast(Scene scene) {
  const RealList *ratio = &scene->membrane.viscosity_ratio;
  const PetscInt entries = scene->vesicles.kind ? scene->vesicles.mixture.n : scene->shape.vesicles;
  PetscReal other = 1;
  PetscFunctionBeginUser;
  if (!scene->shape.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(ratio->n == 1 || ratio->n == entries, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio: %" PetscInt_FMT " numbers given for %" PetscInt_FMT
             " vesicles; allowed: one for all or one a vesicle or kind",
             ratio->n, scene->shape.vesicles);
  for (PetscInt k = 0; k < ratio->n; k++)
    if (ratio->v[k] != 1) other = ratio->v[k];
  if (!SceneHasContrast(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckContrastMethod(scene, other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckBodies(Scene scene) {
  const FluidSpec *f = &scene->fluid;
  PetscFunctionBeginUser;
  PetscCall(CheckFree(scene));
  PetscCall(FlowCheckDivergence(scene->comm, &scene->flow, f->box, FluidSpecCellSize(f)));
  PetscCall(CheckGravity(scene));
  PetscCall(CheckContrast(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
