#include "scene/checks.h"
#include "scene/properties.h"

/* The value in force of an option, numbers to six digits. */
static PetscErrorCode RuleValue(Scene scene, const char name[], size_t length, char text[]) {
  const PetscInt i = OptionFind(&scene->options, name);
  const OptionRow *row = &scene->options.row[i];
  const void *place = (const char *)scene + row->offset;
  const RealList one = {1, (PetscReal *)place}, *list = row->type == OPT_REALS ? (const RealList *)place : &one;
  size_t used = 0;
  PetscFunctionBeginUser;
  if (row->type != OPT_REAL && row->type != OPT_REALS) PetscCall(OptionValue(&scene->options, scene, i, text, length));
  for (PetscInt k = 0; k < list->n && (row->type == OPT_REAL || row->type == OPT_REALS); k++) {
    PetscCall(PetscSNPrintf(text + used, length - used, k ? ",%g" : "%g", (double)list->v[k]));
    used += strlen(text + used);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneText(Scene scene, size_t rules, const SceneRule rule[], char text[PETVES_MAX_MESSAGE]) {
  char part[PETVES_MAX_MESSAGE];
  size_t used = 0;
  PetscFunctionBeginUser;
  *text = 0;
  while (rules && !rule->holds) rule++, rules--;
  if (!rules) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal *number = rule->number;
  const char *const *word = rule->word;
  for (const char *p = rule->message; *p && used < PETVES_MAX_MESSAGE - 1; used += strlen(text + used)) {
    const PetscBool special = *p == '{' || *p == '%';
    const size_t n = strcspn(p, *p == '{' ? "}" : *p == '%' ? "gfcs" : "{%"), left = PETVES_MAX_MESSAGE - used;
    (void)snprintf(part, sizeof(part), "%.*s", (int)(n + (*p == '%')), p);
    if (*p == '{')
      PetscCall(RuleValue(scene, part + 1, left, text + used));
    else if (*p != '%')
      (void)snprintf(text + used, left, "%s", part);
    else if (part[n] == 's')
      (void)snprintf(text + used, left, part, *word++);
    else if (part[n] == 'c')
      (void)snprintf(text + used, left, part, (int)*number++);
    else
      PetscCall(PetscSNPrintf(text + used, left, part, (double)*number++)); /* PETSc writes 2 as 2. */
    p += n + special;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneRefuse(Scene scene, size_t rules, const SceneRule rule[]) {
  char text[PETVES_MAX_MESSAGE];
  PetscFunctionBeginUser;
  PetscCall(SceneText(scene, rules, rule, text));
  PetvesCheck(!*text, scene->comm, "%s", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many numbers a list of the options has. */
static PetscInt SceneListLength(Scene scene, const char name[]) {
  const OptionRow *row = &scene->options.row[OptionFind(&scene->options, name)];
  return *(const PetscInt *)((const char *)scene + row->offset); /* RealList and IntList begin with it */
}

PetscErrorCode SceneCheckList(Scene scene, const char name[], PetscInt each, PetscInt count, const char what[],
                              const char one[]) {
  const char *const number = each == 1 ? "one" : each == 2 ? "two" : "three";
  const PetscInt n = SceneListLength(scene, name);
  PetscFunctionBeginUser;
  PetvesCheck(n == each || n == each * count, scene->comm,
              "%s: %" PetscInt_FMT " number%s given for %" PetscInt_FMT " %.*s; allowed: %s for all or %s %s", name, n,
              n == 1 ? "" : "s", count, (int)strlen(what) - (count == 1), what, number, number, one);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
/* Lists of a fixed length. */
static PetscErrorCode SceneCheckLengths(Scene s) {
  const SceneRule rules[] = {
    {s->domain.box.n != 4, "-domain_box {-domain_box}: not four numbers; allowed: x_min,x_max,y_min,y_max"},
    {s->domain.cells.n != 2, "-domain_cells {-domain_cells}: not two numbers; allowed: cells in x and in y"},
    {s->flow.type == FLOW_AXIAL || s->flow.type == FLOW_TUBE, "-flow_type {-flow_type}: of three dimensions; allowed: -dim 3, or quiescent|shear|poiseuille|extension|uniform|custom|formula"},
    {s->flow.velocity.n != 2, "-flow_velocity {-flow_velocity}: not two numbers; allowed: u_x,u_y"},
    {s->gravity.g.n != 2, "-fluid_gravity {-fluid_gravity}: not two numbers; allowed: g_x,g_y"}};
  return REFUSE(s, rules);
}

PetscErrorCode SceneCheckCells(Scene s) {
  const PetscReal *b = s->domain.box.v, nx = s->domain.cells.v[0], ny = s->domain.cells.v[1];
  const PetscReal hx = (b[1] - b[0]) / nx, hy = (b[3] - b[2]) / ny;
  const PetscReal far = PetscMax(PetscMax(-b[0], b[1]), PetscMax(-b[2], b[3])) / hx, ratio = (b[3] - b[2]) / (b[1] - b[0]);
  PetscReal fit = nx; /* cells in x, at least as many, with which those in y are a whole number */
  while (fit < 4 * nx && PetscAbsReal(fit * ratio - PetscFloorReal(fit * ratio + 0.5)) > 1e-10 * fit) fit++;
  const SceneRule rules[] = {
    {far * PETSC_MACHINE_EPSILON >= 1e-6,
     "-domain_box {-domain_box}: reaches %.2g cells from 0,0, where places are rounded to 1e-6 cells or more; allowed: a box nearer to 0,0", {far}},
    {2 * nx * ny >= (PetscReal)PETSC_MAX_INT,
     "-domain_cells {-domain_cells}: %.3g cells are more than this PETSc can number; allowed: at most %.3g in all", {nx * ny, PETSC_MAX_INT / 2}},
    {PetscAbsReal(hx - hy) > 1e-10 * hx && fit >= 4 * nx,
     "-domain_cells {-domain_cells}: cells of %g x %g; allowed: square cells, so a -domain_box whose sides are in a simple ratio", {hx, hy}},
    {PetscAbsReal(hx - hy) > 1e-10 * hx,
     "-domain_cells {-domain_cells}: cells of %g x %g; allowed: square cells, in this -domain_box such as %.0f,%.0f", {hx, hy, fit, fit * ratio}}};
  return REFUSE(s, rules);
}

/* A list that says what vesicles are has `each` numbers for all of them, a vesicle, or with a mixture a kind; packed
   vesicles have no numbers by which a list could name them. */
static PetscErrorCode SceneCheckKinds(Scene s, const char name[], PetscInt each) {
  const PetscInt n = SceneListLength(s, name), kinds = s->vesicles.mixture.n;
  const PetscBool one = kinds == 1 && n != each;
  const char *const plural = n == 1 ? "" : "s";
  const SceneRule rules[] = {
    {kinds > 1 && n != each && n != each * kinds,
     "%s: %.0f number%s given; allowed: %.0f for each of %.0f kinds (-vesicle_mixture), or once for all", {n, each, kinds}, {name, plural}},
    {one && s->vesicles.packing > 0,
     "%s: %.0f numbers given with -vesicle_packing; allowed: %.0f for all, or an entry for each kind of -vesicle_mixture", {n, each}, {name}},
    {one && n != (PetscReal)each * s->vesicles.count,
     "%s: %.0f number%s given; allowed: %.0f for each of -vesicle_count {-vesicle_count} vesicles, or once for all", {n, each}, {name, plural}}};
  return REFUSE(s, rules);
}

/* split and penalty are their papers' methods: one order, kernel ib6 and differences, none of the corrections of the
   coupled scheme, whose near field needs no projection step. */
static PetscErrorCode SceneCheckScheme(Scene s) {
  const PetscBool split = !strcmp(s->scheme.type, "split"), penalty = !strcmp(s->scheme.type, "penalty"),
                  paper = split || penalty, spectral = s->membrane.derivative == DERIVATIVE_SPECTRAL,
                  exact = s->coupling.near_field == NEAR_EXACT;
  const PetscInt inertia = s->fluid.inertia;
  const SceneRule rules[] = {
    {!paper && strcmp(s->fluid.helmholtz, "fftw_tridiagonal"),
     "-helmholtz_type {-helmholtz_type}: not with -scheme_type {-scheme_type}, which solves in the modes of fftw_tridiagonal; allowed: fftw_tridiagonal, or -scheme_type split or penalty"},
    {!paper && strcmp(s->fluid.poisson, "fftw_tridiagonal"),
     "-poisson_type {-poisson_type}: not with -scheme_type {-scheme_type}, which solves in the modes of fftw_tridiagonal; allowed: fftw_tridiagonal, or -scheme_type split or penalty"},
    {s->coupling.box_part && !exact,
     "-coupling_box_part true: stands on the exact near field; allowed: false, or -coupling_near_field exact"},
    {paper && exact,
     "-coupling_near_field exact: not with -scheme_type {-scheme_type}, which is its paper's method; allowed: none, or -scheme_type coupled"},
    {split && s->scheme.order > 1,
     "-scheme_order {-scheme_order}: the splitting error of -scheme_type split is of first order; allowed: 1"},
    {penalty && s->scheme.order > 1,
     "-scheme_order {-scheme_order}: the forward step of the markers of -scheme_type penalty is of first order; allowed: 1"},
    {split && spectral,
     "-membrane_derivative spectral: not with -scheme_type split, whose preconditioner knows chords only; allowed: fd, bending, or -scheme_type coupled"},
    {penalty && spectral,
     "-membrane_derivative spectral: not with -scheme_type penalty, whose springs are chords; allowed: fd, bending, or -scheme_type coupled"},
    {split && inertia == INERTIA_NONE,
     "-fluid_inertia none: not with -scheme_type split, whose projection stands on the inertia: it puts dt I in place of H^-1; allowed: unsteady, or -scheme_type coupled"},
    {penalty && inertia == INERTIA_NONE,
     "-fluid_inertia none: not with -scheme_type penalty, whose projection step starts from the velocity before it; allowed: unsteady, or -scheme_type coupled"},
    {split && inertia == INERTIA_CONVECTIVE,
     "-fluid_inertia convective: not with -scheme_type split, the paper's method for unsteady Stokes flow; allowed: unsteady, or -scheme_type coupled"},
    {penalty && inertia == INERTIA_CONVECTIVE,
     "-fluid_inertia convective: not with -scheme_type penalty, here for unsteady Stokes flow; allowed: unsteady, or -scheme_type coupled"},
    {!penalty && s->scheme.stiffness != 0,
     "-penalty_stiffness {-penalty_stiffness}: -scheme_type {-scheme_type} has no springs, its length is a constraint; allowed: 0, or -scheme_type penalty"},
    {s->time.adapt != ADAPT_NONE && s->scheme.order == 1,
     "-time_adapt error: with -scheme_type {-scheme_type} of order {-scheme_order}; allowed: coupled with -scheme_order 2 or 3"},
    {inertia == INERTIA_CONVECTIVE && s->scheme.order == 1,
     "-fluid_inertia convective: with -scheme_order {-scheme_order} an explicit convection is unstable at any step that is not tiny; allowed: -scheme_order 2 or 3"}};
  return REFUSE(s, rules);
}

/* Membranes that stretch, remember, resist, let water through or draw one another: what each of them needs. */
static PetscErrorCode SceneCheckMembranes(Scene s) {
  const SceneMembrane *m = &s->membrane;
  const ScenePotential *p = &s->potential;
  const PetscBool paper = strcmp(s->scheme.type, "coupled");
  const PetscReal memory = ListLargest(&m->memory);
  const PetscBool bends = ListLargest(&m->stiffness) > 0;
  /* entries of the lists of laws and moduli; lists of unlike lengths are refused elsewhere */
  const PetscInt laws = m->law.n, moduli = m->stretching.n;
  const PetscInt entries = PetscMin(laws, moduli) > 1 ? PetscMin(laws, moduli) : PetscMax(laws, moduli);
  PetscBool stretches = PETSC_FALSE, viscous = PETSC_FALSE; /* viscous: of an entry that does not stretch */
  PetscInt without = 0;  /* laws without a modulus */
  PetscReal lawless = 0; /* a modulus without a law */
  for (PetscInt k = 0; k < entries; k++) {
    const PetscReal modulus = ListEntry(&m->stretching, 1, k, 0);
    const PetscBool law = m->law.v[laws > 1 ? k : 0] != LAW_INEXTENSIBLE;
    if (law) stretches = PETSC_TRUE;
    if (law && modulus == 0) without++;
    if (!law && modulus > 0) lawless = modulus;
    if (modulus == 0 && m->viscosity.n > 1 && ListEntry(&m->viscosity, 1, k, 0) > 0) viscous = PETSC_TRUE;
  }
  const SceneRule rules[] = {
    {lawless > 0,
     "-membrane_stretching %g: -membrane_law inextensible has no modulus; allowed: 0, or -membrane_law hooke, green or neo_hookean", {lawless}},
    {without > (laws > 1 ? 0 : entries - 1),
     "-membrane_law {-membrane_law}: its modulus E_s is 0; allowed: -membrane_stretching above 0, or inextensible"},
    {!stretches && m->moment != MOMENT_QUADRATIC,
     "-membrane_moment {-membrane_moment}: a membrane that does not stretch bends alike by all of them; allowed: quadratic, or -membrane_law hooke, green or neo_hookean"},
    {m->moment != MOMENT_QUADRATIC && m->derivative == DERIVATIVE_FD,
     "-membrane_moment {-membrane_moment}: not with -membrane_derivative fd; allowed: quadratic, or -membrane_derivative spectral or bending"},
    {m->moment != MOMENT_QUADRATIC && !bends,
     "-membrane_moment {-membrane_moment}: -vesicle_bending 0 leaves bending out; allowed: quadratic, or -vesicle_bending above 0"},
    {memory > 0 && !bends,
     "-membrane_memory {-membrane_memory}: -vesicle_bending 0 bends back to no shape; allowed: 0, or -vesicle_bending above 0"},
    {viscous || (!stretches && ListLargest(&m->viscosity) > 0),
     "-membrane_viscosity {-membrane_viscosity}: resists the stretching, which -membrane_law inextensible has none of; allowed: 0, or -membrane_law hooke, green or neo_hookean"},
    {m->osmotic.n != 2, "-membrane_osmotic {-membrane_osmotic}: not two numbers; allowed: inside, outside"},
    {m->permeability == 0 && (m->osmotic.v[0] != 0 || m->osmotic.v[1] != 0),
     "-membrane_osmotic: -membrane_permeability {-membrane_permeability} lets no water pass; allowed: with a permeability above 0"},
    {m->permeability > 0 && paper,
     "-membrane_permeability {-membrane_permeability}: needs -scheme_type coupled; allowed: 0, or that scheme"},
    {stretches && paper,
     "-membrane_law {-membrane_law}: not with -scheme_type {-scheme_type}, whose membranes keep their length; allowed: inextensible, or -scheme_type coupled"},
    {memory > 0 && (paper || m->derivative == DERIVATIVE_FD),
     "-membrane_memory {-membrane_memory}: needs -scheme_type coupled and curvatures by -membrane_derivative spectral or bending; allowed: 0, or these"},
    {!stretches && memory == 0 && strcmp(m->rest, "initial"),
     "-membrane_rest {-membrane_rest}: this membrane neither stretches nor remembers; allowed: initial, or with a -membrane_law that stretches or -membrane_memory 1"},
    {p->strength > 0 && p->distance == 0,
     "-contact_potential {-contact_potential}: no distance at which it is least; allowed: with -contact_potential_distance above 0"},
    {p->exponents.n != 2 || p->exponents.v[0] <= p->exponents.v[1],
     "-contact_potential_exponents {-contact_potential_exponents}: not m,n with m > n; allowed: such as 4,2 or 12,6"},
    {stretches && !s->scheme.length_target,
     "-scheme_length_target false: -membrane_law {-membrane_law} has its tension from the length that edges get; allowed: true, or -membrane_law inextensible"}};
  return REFUSE(s, rules);
}

/* The lists that the rules read have been checked for their lengths. */
static PetscErrorCode SceneCheckFlow(Scene s) {
  const PetscReal *b = s->domain.box.v, *u = s->flow.velocity.v;
  const PetscInt *bc = s->fluid.bc, type = s->flow.type;
  const PetscBool total = s->fluid.form == FORM_TOTAL, moved = total && type != FLOW_QUIESCENT;
  const SceneRule rules[] = {
    {b[0] >= b[1] || b[2] >= b[3], "-domain_box {-domain_box}: empty; allowed: x_min < x_max and y_min < y_max"},
    {bc[0] == BC_WALL && bc[1] == BC_PERIODIC,
     "-domain_bc_y periodic: with walls in x that is a channel along y; allowed: the scene turned by 90 degrees, -domain_bc_x periodic -domain_bc_y wall with x and y of box, cells, centres, angles and flow exchanged"},
    {s->fluid.inertia == INERTIA_CONVECTIVE && FlowIsCustom(&s->flow),
     "-fluid_inertia convective: not with -flow_type {-flow_type}, whose gradient is not known; allowed: none, unsteady"},
    {type == FLOW_FORMULA && !SceneGiven(s, "-flow_u") && !SceneGiven(s, "-flow_v"),
     "-flow_type formula: no formula given; allowed: with -flow_u or -flow_v"},
    {type == FLOW_UNIFORM && u[0] != 0 && bc[0] == BC_WALL,
     "-flow_velocity {-flow_velocity}: into the walls at x_min and x_max; allowed: along walls, which move with it, or -domain_bc_x periodic"},
    {type == FLOW_UNIFORM && u[1] != 0 && bc[1] == BC_WALL,
     "-flow_velocity {-flow_velocity}: into the walls at y_min and y_max; allowed: along walls, which move with it, or -domain_bc_y periodic"},
    {total && !SceneIsProjection(s),
     "-flow_form total: not with -scheme_type {-scheme_type}, whose near field and fast solves have walls at rest; allowed: disturbance, or -scheme_type split or penalty"},
    {moved && FlowIsCustom(&s->flow),
     "-flow_form total: not with -flow_type {-flow_type}; allowed: -flow_form disturbance"},
    {moved && bc[1] == BC_PERIODIC,
     "-flow_form total: the background flow is not periodic in y; allowed: -domain_bc_y wall or -flow_form disturbance"},
    {moved && type == FLOW_EXTENSION && bc[0] == BC_PERIODIC,
     "-flow_form total: extension is not periodic in x; allowed: -domain_bc_x wall or -flow_form disturbance"}};
  return REFUSE(s, rules);
}

static PetscErrorCode SceneCheckVesicles(Scene s) {
  static const char *const kinds[] = {"-vesicle_area", "-vesicle_reduced_area", "-vesicle_bending", "-membrane_law", "-membrane_stretching", "-membrane_viscosity", "-membrane_memory"};
  const SceneVesicles *own = &s->vesicles;
  const PetscInt count = own->count, centers = own->center.n, angles = own->angle.n;
  const PetscBool axes = SceneGiven(s, "-vesicle_semi_axes"), area = SceneGiven(s, "-vesicle_area"),
                  by_area = area || SceneGiven(s, "-vesicle_reduced_area"), file = own->shape == SHAPE_FILE, placed = !file && own->packing == 0;
  PetscReal parts = 0, outline = 0.5; /* a reduced area that no biconcave outline has, if there is one */
  for (PetscInt k = 0; k < own->mixture.n; k++) parts += own->mixture.v[k];
  for (PetscInt k = own->reduced_area.n - 1; k >= 0; k--)
    if (own->reduced_area.v[k] < 0.35 || own->reduced_area.v[k] > 0.9) outline = own->reduced_area.v[k];
  const SceneRule shapes[] = {
    {by_area && axes,
     "-vesicle_semi_axes: given together with -vesicle_area or -vesicle_reduced_area; allowed: one description of the ellipse"},
    {own->packing > 0 && own->shape == SHAPE_BICONCAVE,
     "-vesicle_packing {-vesicle_packing}: not with -vesicle_shape biconcave; allowed: ellipses, the only shape that is packed"},
    {own->packing > 0 && SceneGiven(s, "-vesicle_count") && (area || axes),
     "-vesicle_packing {-vesicle_packing}: given together with -vesicle_count {-vesicle_count} and the vesicles' size; allowed: one of the two, the other follows from it"},
    {PetscAbsReal(parts - 1) >= 1e-6,
     "-vesicle_mixture: its parts add up to %g; allowed: parts that add up to 1", {parts}}};
  const SceneRule markers[] = {
    {own->shape == SHAPE_BICONCAVE && (outline < 0.35 || outline > 0.9),
     "-vesicle_reduced_area %g: no -vesicle_shape biconcave has it; allowed: 0.35 to 0.9", {outline}},
    {placed && centers != 2. * count,
     "-vesicle_center: %.0f number%s given; allowed: 2 for each of -vesicle_count {-vesicle_count} vesicles", {centers}, {centers == 1 ? "" : "s"}},
    {placed && angles != 1 && angles != count,
     "-vesicle_angle: %.0f numbers given; allowed: 1 for each of -vesicle_count {-vesicle_count} vesicles, or once for all", {angles}},
    {file && !*own->file, "-vesicle_shape file: no -vesicle_file given; allowed: a text file with x y a line"},
    {*own->file && !file, "-vesicle_file {-vesicle_file}: not read; allowed: with -vesicle_shape file only"},
    {own->shape != SHAPE_NONE && own->markers && own->markers < 8,
     "-vesicle_markers {-vesicle_markers}: too few; allowed: at least 8"},
    {own->markers && own->spacing > 0,
     "-vesicle_markers {-vesicle_markers}: given together with -vesicle_spacing; allowed: one of them"},
    {s->time.end / s->time.dt >= 1e9,
     "-time_step {-time_step}: more than 1e9 steps to -time_end {-time_end}; allowed: a larger step"},
    {!*s->output.dir, "-output_dir: empty; allowed: a folder's name"}};
  PetscFunctionBeginUser;
  PetscCall(REFUSE(s, shapes));
  if (!file) PetscCall(SceneCheckKinds(s, "-vesicle_semi_axes", 2)); /* how many a file has is known later */
  for (size_t k = 0; k < sizeof(kinds) / sizeof(kinds[0]) && !file; k++) PetscCall(SceneCheckKinds(s, kinds[k], 1));
  PetscCall(REFUSE(s, markers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unbounded fluid: the step is dense work on the markers alone; there is no grid on which a fluid with inertia or a
   projection could be. Viscosities: the double layer is of quasi-steady flow, as with inertia the inner fluid's
   velocity obeys another equation than the outer one's; it stands on the unsplit step and its near field. */
PetscErrorCode SceneCheckBodies(Scene s) {
  const FluidSpec *f = &s->fluid;
  const PetscInt vesicles = s->shape.vesicles, entries = s->vesicles.kind ? s->vesicles.mixture.n : vesicles;
  const char *const what = s->vesicles.kind ? "kinds" : "vesicles";
  const PetscBool free = FluidSpecIsFree(f), coupled = !strcmp(s->scheme.type, "coupled"),
                  exact = s->coupling.near_field == NEAR_EXACT, contrast = vesicles && SceneHasContrast(s),
                  quasi = f->inertia == INERTIA_AUTO || f->inertia == INERTIA_NONE;
  PetscReal period[2];
  const SceneRule unbounded[] = {
    {free && f->bc[1] != BC_FREE, "-domain_bc_x free: with a boundary in y; allowed: free in x and y, or in neither"},
    {!free && f->bc[1] == BC_FREE, "-domain_bc_y free: with a boundary in x; allowed: free in x and y, or in neither"},
    {free && !coupled,
     "-scheme_type {-scheme_type}: not with -domain_bc_x free, where no fluid is solved for on a grid; allowed: coupled"},
    {free && !exact,
     "-coupling_near_field none: not with -domain_bc_x free, where it is all that moves the markers; allowed: exact"},
    {free && !quasi,
     "-fluid_inertia {-fluid_inertia}: not with -domain_bc_x free, which is quasi-steady; allowed: none"},
    {free && s->coupling.box_part,
     "-coupling_box_part true: not with -domain_bc_x free, where there is no box; allowed: false"},
    {free && vesicles > SCENE_MOST_FREE,
     "-domain_bc_x free: %.0f vesicles, every pair of which is summed; allowed: up to %.0f, or a large -domain_box with walls", {vesicles, SCENE_MOST_FREE}}};
  const SceneRule forces[] = {
    {free && SceneHasGravity(s),
     "-fluid_gravity {-fluid_gravity}: not with -domain_bc_x free, where a body under a force has no finite velocity in two dimensions; allowed: walls, or periodic boundaries"},
    {s->potential.strength > 0 && vesicles == 1,
     "-contact_potential {-contact_potential}: between the membranes of different vesicles, and there is one; allowed: 0, or -vesicle_count 2 and more"},
    {f->drive == DRIVE_FLUX && !coupled,
     "-flow_drive flux: not with -scheme_type {-scheme_type}; allowed: pressure, or coupled"}};
  const SceneRule viscosities[] = {
    {contrast && !coupled,
     "-vesicle_viscosity_ratio {-vesicle_viscosity_ratio}: not with -scheme_type {-scheme_type}, which is its paper's method; allowed: 1, or -scheme_type coupled"},
    {contrast && !quasi,
     "-vesicle_viscosity_ratio {-vesicle_viscosity_ratio}: not with -fluid_inertia {-fluid_inertia}, because with inertia the fluid inside obeys another equation than the one outside; allowed: 1, or -fluid_inertia none"},
    {contrast && (!exact || strcmp(s->coupling.kernel, "cbs54")),
     "-vesicle_viscosity_ratio {-vesicle_viscosity_ratio}: not with -delta_type {-delta_type} and this -coupling_near_field, whose sums are of cbs54 and exact; allowed: 1, or -delta_type cbs54 -coupling_near_field exact"}};
  PetscFunctionBeginUser;
  FluidSpecPeriods(f, period);
  PetscCall(REFUSE(s, unbounded));
  PetscCall(FlowCheck(s->comm, &s->flow, f->box, period, FluidSpecCellSize(f), s->time.end));
  PetscCall(SceneCheckList(s, "-vesicle_density_difference", 1, entries, what, "a vesicle"));
  PetscCall(REFUSE(s, forces));
  if (vesicles) PetscCall(SceneCheckList(s, "-vesicle_viscosity_ratio", 1, entries, what, "a vesicle or kind"));
  PetscCall(REFUSE(s, viscosities));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

PetscErrorCode SceneCheck(Scene scene) {
  PetscFunctionBeginUser;
  PetscCall(SceneCheckScheme(scene));
  PetscCall(SceneCheckMembranes(scene));
  PetscCall(SceneCheckLengths(scene));
  PetscCall(SceneCheckFlow(scene));
  PetscCall(SceneCheckVesicles(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
