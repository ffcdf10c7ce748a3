/* The option table: each option once, beside its default, range and unit. -help, resolved.opts, the checks and the
   "did you mean" of a misspelt option all come from it. */
#include "scene/scene.h"
#include <ctype.h>

typedef enum { OPT_REAL, OPT_INT, OPT_BOOL, OPT_ENUM, OPT_NAME, OPT_PATH, OPT_REALS, OPT_INTS } OptionType;

typedef struct {
  const char *name;
  OptionType type;
  size_t offset;
  const char *value; /* default */
  const char *range; /* ">0", ">=0", "(0,1)", "any"; for enums and names "a|b|c"; for lists the same for each entry */
  const char *help;
} Option;

#define AT(member) offsetof(struct _p_Scene, member)
/* clang-format off */
static const Option table[] = {
  {"-domain_box", OPT_REALS, AT(box), "-1,1,-1,1", "any", "x_min,x_max,y_min,y_max (length)"},
  {"-domain_cells", OPT_INTS, AT(cells), "128,128", ">=8", "cells in x and y; cells must be square"},
  {"-domain_bc_x", OPT_ENUM, AT(bc[0]), "wall", "wall|periodic", "boundaries at x_min and x_max"},
  {"-domain_bc_y", OPT_ENUM, AT(bc[1]), "wall", "wall|periodic", "boundaries at y_min and y_max"},
  {"-flow_type", OPT_ENUM, AT(flow.type), "quiescent", "quiescent|shear|poiseuille|extension|custom", "background flow; custom: a function given from Python or C"},
  {"-flow_rate", OPT_REAL, AT(flow.rate), "1", "any", "rate of shear or extension (1/time)"},
  {"-flow_peak_velocity", OPT_REAL, AT(flow.peak), "1", "any", "u_max of poiseuille (length/time)"},
  {"-flow_half_width", OPT_REAL, AT(flow.half_width), "3", ">0", "L_y of poiseuille: half the channel's height (length)"},
  {"-flow_center_x", OPT_REAL, AT(flow.center[0]), "0", "any", "x_c of the background flow (length)"},
  {"-flow_center_y", OPT_REAL, AT(flow.center[1]), "0", "any", "y_c of the background flow (length)"},
  {"-flow_form", OPT_ENUM, AT(flow.form), "disturbance", "disturbance|total", "solve for u - u_inf, or for u with moving walls as the paper"},
  {"-fluid_viscosity", OPT_REAL, AT(viscosity), "1", ">0", "nu (length^2/time; density is 1)"},
  {"-fluid_inertia", OPT_ENUM, AT(inertia), "auto", "auto|none|unsteady|convective", "inertia of the fluid: quasi-steady Stokes, unsteady Stokes, Navier-Stokes; auto goes by flow and Reynolds number"},
  {"-vesicle_shape", OPT_ENUM, AT(shape), "ellipse", "ellipse|file|none", "initial shape"},
  {"-vesicle_count", OPT_INT, AT(count), "1", "[1,16]", "number of ellipses; a file has its own number of curves"},
  {"-vesicle_semi_axes", OPT_REALS, AT(axes), "0.2,0.5", ">0", "semi-axes of the ellipse, two for all or two a vesicle (length)"},
  {"-vesicle_area", OPT_REALS, AT(area), "1", ">0", "area of the ellipse, with -vesicle_reduced_area; one for all or one a vesicle (length^2)"},
  {"-vesicle_reduced_area", OPT_REALS, AT(reduced_area), "0.7", "(0,1)", "V = area/(pi R0^2), R0 = perimeter/(2 pi); long axis along x"},
  {"-vesicle_center", OPT_REALS, AT(center), "0,0", "any", "x,y of the centre, a pair a vesicle (length)"},
  {"-vesicle_angle", OPT_REALS, AT(angle), "0", "any", "counter-clockwise turn of the shape, one for all or one a vesicle (degrees)"},
  {"-vesicle_file", OPT_PATH, AT(file), "", "", "closed curves: x y a line, an empty line between curves, for -vesicle_shape file"},
  {"-vesicle_bending", OPT_REAL, AT(bending), "0.01", ">=0", "c_b, bending stiffness; 0 leaves bending out"},
  {"-vesicle_spacing", OPT_REAL, AT(spacing), "0", ">=0", "marker spacing ds/h; 0 takes the kernel's (ib6 1.75, cbs32 1.25, others 1.5)"},
  {"-vesicle_markers", OPT_INT, AT(markers), "0", ">=0", "number of markers of each vesicle, instead of the spacing; 0 takes the spacing"},
  {"-vesicle_allow_close_markers", OPT_BOOL, AT(allow_close_markers), "false", "true|false", "accept spacings below 1.25 h (ib6) or 1 h (others)"},
  {"-delta_type", OPT_NAME, AT(delta), "cbs54", "ib6|cbs32|cbs43|cbs54|cbs65", "kernel between grid and markers; split, penalty: ib6"},
  {"-scheme_type", OPT_NAME, AT(scheme), "coupled", "split|penalty|coupled|direct", "time-stepping scheme: the paper's, stiff springs, unsplit, unsplit by sparse LU"},
  {"-scheme_order", OPT_INT, AT(order), "2", "[1,2]", "order in time: backward Euler or BDF2; split and penalty are of order 1"},
  {"-scheme_auto", OPT_REAL, AT(wanted), "0", ">=0", "relative error wanted, 1e-4 to 0.1: order, steps, tolerances, spacing and kernel by what was measured; 0 off"},
  {"-scheme_bending", OPT_ENUM, AT(bending_at), "implicit", "implicit|explicit", "bending at the new markers, or (split only) at the old ones; penalty: explicit"},
  {"-penalty_stiffness", OPT_REAL, AT(stiffness), "0", ">=0", "penalty: sigma_0 of the springs sigma = sigma_0 (|X_s| - 1) (length^3/time^2); 0 takes half of what the step bears"},
  {"-scheme_length_target", OPT_BOOL, AT(length_target), "true", "true|false", "coupled, direct: new edges get their first length"},
  {"-scheme_area_target", OPT_BOOL, AT(area_target), "true", "true|false", "coupled, direct: shift the markers to their first area after each step"},
  {"-coupling_self_mobility", OPT_ENUM, AT(self_mobility), "symbol", "none|local|symbol", "coupled, direct: give back the mobility that the kernel's smoothing takes from the membrane"},
  {"-membrane_derivative", OPT_ENUM, AT(derivative), "spectral", "fd|bending|spectral", "derivatives along the membrane: finite differences, spectral bending, spectral bending and edges; split, penalty: fd"},
  {"-scheme_startup", OPT_ENUM, AT(startup), "graded", "euler|graded", "first step of order 2: backward Euler, or five growing parts of a step"},
  {"-mobility_type", OPT_ENUM, AT(mobility), "table", "table|ilu|none", "Lagrangian part of coupled's preconditioner"},
  {"-time_step", OPT_REAL, AT(dt), "0.01", ">0", "dt (time)"},
  {"-time_end", OPT_REAL, AT(t_end), "1", ">=0", "end time"},
  {"-time_adapt", OPT_ENUM, AT(adapt), "none", "none|error", "step size: fixed, or from an error estimate (coupled, direct of order 2)"},
  {"-time_adapt_tol", OPT_REAL, AT(adapt_tol), "1e-4", ">0", "error estimate accepted a step, in units of R0"},
  {"-time_adapt_max_move", OPT_REAL, AT(adapt_max_move), "1", ">=0", "cells that a marker may move in a step relative to its vesicle; 0 no limit"},
  {"-time_adapt_max_step", OPT_REAL, AT(adapt_max_step), "0", ">=0", "largest step that -time_adapt error takes; 0 no limit (time)"},
  {"-time_cfl_limit", OPT_REAL, AT(cfl_limit), "0.5", ">0", "convective: largest dt max(|u| + |v|)/h; -time_adapt error stays below it, a fixed step above it stops the run"},
  {"-time_steady_tol", OPT_REAL, AT(steady_tol), "0", ">=0", "stop when max |u.n| on the membrane falls below it; 0 never (length/time)"},
  {"-helmholtz_type", OPT_NAME, AT(helmholtz), "fftw_tridiagonal", "fftw_tridiagonal|fftw|hypre", "fast solver of the velocity Helmholtz problems"},
  {"-poisson_type", OPT_NAME, AT(poisson), "fftw_tridiagonal", "fftw_tridiagonal|fftw|hypre", "fast solver of the pressure Poisson problems"},
  {"-fftw_plan", OPT_ENUM, AT(fftw_plan), "estimate", "estimate|measure|patient", "effort that FFTW spends on planning; estimate gives the same bits every run"},
  {"-fftw_wisdom", OPT_PATH, AT(fftw_wisdom), "", "", "file of FFTW's measurements: read if it is there, written when a run adds to it"},
  {"-output_dir", OPT_PATH, AT(output_dir), "out/run", "", "folder of every output file"},
  {"-output_overwrite", OPT_BOOL, AT(overwrite), "false", "true|false", "replace the results that -output_dir holds already"},
  {"-output_every", OPT_REAL, AT(output_every), "0.1", ">0", "time between saved fields"},
  {"-checkpoint_every", OPT_INT, AT(checkpoint_every), "100", ">=0", "steps between checkpoints; 0 writes one at the end only"},
  {"-checkpoint_keep", OPT_INT, AT(checkpoint_keep), "2", "[1,100]", "checkpoints kept: checkpoint.h5, the one before it checkpoint_1.h5, and so on"},
  {"-restart", OPT_PATH, AT(restart), "", "", "go on from this checkpoint, in its folder or in a new -output_dir"},
  {"-time_wall_limit", OPT_REAL, AT(wall_limit), "0", ">=0", "stop with a checkpoint before this much wall time has passed; 0 never (seconds)"},
  {"-limit_edge_ratio", OPT_REAL, AT(limit_edge_ratio), "5", ">=0", "stop when a vesicle's longest edge is more than this many times its shortest; 0 no limit"},
  {"-limit_area_error", OPT_REAL, AT(limit_area_error), "0.2", ">=0", "stop when a vesicle's area is off by more than this part of its first; 0 no limit"},
  {"-limit_length_error", OPT_REAL, AT(limit_length_error), "0.2", ">=0", "stop when a vesicle's length is off by more than this part of its first; 0 no limit"},
  {"-view", OPT_BOOL, AT(view), "false", "true|false", "print the model in force and the solvers"},
  {"-allow_unused_options", OPT_BOOL, AT(allow_unused), "false", "true|false", "go on when an option is misspelt or unused"},
};
/* clang-format on */
#define TABLE_SIZE ((PetscInt)(sizeof(table) / sizeof(table[0])))

static void *Member(Scene scene, const Option *o) {
  return (char *)scene + o->offset;
}

/* One number from text; the whole text must be used up and finite. */
static PetscBool ParseReal(const char *text, PetscReal *value) {
  char *end;
  while (isspace((unsigned char)*text)) text++;
  if (!*text) return PETSC_FALSE;
  *value = strtod(text, &end);
  while (isspace((unsigned char)*end)) end++;
  return !*end && !PetscIsInfOrNanReal(*value) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool InRange(const char *range, PetscReal x) {
  double a, b;
  if (!strcmp(range, ">0")) return x > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (sscanf(range, ">=%lf", &a) == 1) return x >= a ? PETSC_TRUE : PETSC_FALSE;
  if (sscanf(range, "(%lf,%lf)", &a, &b) == 2) return x > a && x < b ? PETSC_TRUE : PETSC_FALSE;
  if (sscanf(range, "[%lf,%lf]", &a, &b) == 2) return x >= a && x <= b ? PETSC_TRUE : PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscErrorCode ParseNumber(MPI_Comm comm, const Option *o, const char *text, PetscBool integer, PetscReal *x) {
  const char *what = integer ? "an integer" : "a number";
  PetscFunctionBeginUser;
  PetscCheck(ParseReal(text, x) && (!integer || (*x == PetscFloorReal(*x) && PetscAbsReal(*x) < 2e9)), comm,
             PETSC_ERR_USER_INPUT, "%s %s: not %s; allowed: %s%s%s", o->name, text, what, what,
             strcmp(o->range, "any") ? ", " : "", strcmp(o->range, "any") ? o->range : "");
  PetscCheck(InRange(o->range, *x), comm, PETSC_ERR_USER_INPUT, "%s %s: out of range; allowed: %s %s", o->name, text,
             what, o->range);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Index of text in "a|b|c", or -1. */
static PetscInt IndexInList(const char *list, const char *text) {
  const size_t length = strlen(text);
  PetscInt index = 0;
  for (const char *p = list; *p; index++) {
    const size_t n = strcspn(p, "|");
    if (n == length && !strncmp(p, text, n)) return index;
    p += n + (p[n] == '|');
  }
  return -1;
}

static PetscErrorCode ParseList(Scene scene, const Option *o, const char *text) {
  RealList *reals = (RealList *)Member(scene, o);
  IntList *ints = (IntList *)Member(scene, o);
  const PetscBool integer = o->type == OPT_INTS ? PETSC_TRUE : PETSC_FALSE;
  PetscInt n = 0;
  PetscFunctionBeginUser;
  for (const char *p = text;; n++) {
    char item[64];
    const size_t length = strcspn(p, ",");
    PetscReal x = 0;
    PetscCheck(n < SCENE_MAX_LIST && length < sizeof(item), scene->comm, PETSC_ERR_USER_INPUT,
               "%s %s: list too long; allowed: at most %d numbers", o->name, text, SCENE_MAX_LIST);
    PetscCall(PetscStrncpy(item, p, length + 1));
    PetscCall(ParseNumber(scene->comm, o, item, integer, &x));
    if (integer)
      ints->v[n] = (PetscInt)x;
    else
      reals->v[n] = x;
    if (!p[length]) break;
    p += length + 1;
  }
  if (integer)
    ints->n = n + 1;
  else
    reals->n = n + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ParseOption(Scene scene, const Option *o, const char *text) {
  void *member = Member(scene, o);
  PetscReal x = 0;
  PetscFunctionBeginUser;
  switch (o->type) {
  case OPT_REAL:
    PetscCall(ParseNumber(scene->comm, o, text, PETSC_FALSE, &x));
    *(PetscReal *)member = x;
    break;
  case OPT_INT:
    PetscCall(ParseNumber(scene->comm, o, text, PETSC_TRUE, &x));
    *(PetscInt *)member = (PetscInt)x;
    break;
  case OPT_BOOL: {
    const PetscInt yes = IndexInList("|true|yes|on|1", text), no = IndexInList("false|no|off|0", text);
    PetscCheck(yes >= 0 || no >= 0 || !*text, scene->comm, PETSC_ERR_USER_INPUT, "%s %s: allowed: true or false",
               o->name, text);
    *(PetscBool *)member = no >= 0 ? PETSC_FALSE : PETSC_TRUE;
    break;
  }
  case OPT_ENUM:
    *(PetscInt *)member = IndexInList(o->range, text);
    PetscCheck(*(PetscInt *)member >= 0, scene->comm, PETSC_ERR_USER_INPUT, "%s %s: unknown; allowed: %s", o->name,
               text, o->range);
    break;
  case OPT_NAME:
    PetscCheck(IndexInList(o->range, text) >= 0, scene->comm, PETSC_ERR_USER_INPUT, "%s %s: unknown; allowed: %s",
               o->name, text, o->range);
    PetscCall(PetscStrncpy((char *)member, text, SCENE_MAX_NAME));
    break;
  case OPT_PATH:
    PetscCall(PetscStrncpy((char *)member, text, PETSC_MAX_PATH_LEN));
    break;
  default:
    PetscCall(ParseList(scene, o, text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCreate(MPI_Comm comm, Scene *out) {
  Scene scene;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&scene));
  *out = scene;
  scene->comm = comm;
  PetscCall(PetscCalloc1(TABLE_SIZE, &scene->given));
  PetscOptionsBegin(comm, NULL, "petves: inextensible vesicles in two-dimensional viscous flow", NULL);
  for (PetscInt i = 0; i < TABLE_SIZE; i++) {
    const Option *o = &table[i];
    char text[PETSC_MAX_PATH_LEN], help[512];
    const PetscBool ranged = *o->range && strcmp(o->range, "any") ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(PetscSNPrintf(help, sizeof(help), "%s%s%s%s", o->help, ranged ? " [" : "", ranged ? o->range : "",
                            ranged ? "]" : ""));
    PetscCall(PetscOptionsString(o->name, help, "README.md", o->value, text, sizeof(text), &scene->given[i]));
    PetscCheck(!scene->given[i] || *text || o->type == OPT_BOOL, comm, PETSC_ERR_USER_INPUT,
               "%s: given without a value; allowed: %s", o->name, ranged ? o->range : o->help);
    PetscCall(ParseOption(scene, o, scene->given[i] ? text : o->value));
  }
  PetscOptionsEnd();
  scene->ksp_rtol = 1e-6;
  PetscCall(SceneAuto(scene));
  PetscCall(SceneValidate(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDestroy(Scene *scene) {
  PetscFunctionBeginUser;
  if (!*scene) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*scene)->given));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SceneGiven(Scene scene, const char name[]) {
  for (PetscInt i = 0; i < TABLE_SIZE; i++)
    if (!strcmp(table[i].name, name)) return scene->given[i];
  return PETSC_FALSE;
}

PetscErrorCode SceneChoose(Scene scene, const char name[], const char value[]) {
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < TABLE_SIZE; i++)
    if (!strcmp(table[i].name, name) && !scene->given[i]) PetscCall(ParseOption(scene, &table[i], value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SceneOptionName(PetscInt i) {
  return i < TABLE_SIZE ? table[i].name : NULL;
}

PetscBool SceneOptionMayChange(const char name[]) {
  const char *const free[] = {"-scheme_auto",
                              "-time_end",
                              "-time_step",
                              "-time_adapt_tol",
                              "-time_adapt_max_move",
                              "-time_adapt_max_step",
                              "-time_steady_tol",
                              "-time_wall_limit",
                              "-helmholtz_type",
                              "-poisson_type",
                              "-fftw_plan",
                              "-mobility_type",
                              "-vesicle_file",
                              "-vesicle_allow_close_markers",
                              "-restart",
                              "-view",
                              "-allow_unused_options"};
  const char *const groups[] = {"-output_", "-checkpoint_", "-limit_"};
  for (size_t i = 0; i < sizeof(free) / sizeof(free[0]); i++)
    if (!strcmp(name, free[i])) return PETSC_TRUE;
  for (size_t i = 0; i < sizeof(groups) / sizeof(groups[0]); i++)
    if (!strncmp(name, groups[i], strlen(groups[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SceneOptionValue(Scene scene, PetscInt i, char value[], size_t length) {
  const Option *o = &table[i];
  const void *member = Member(scene, o);
  PetscFunctionBeginUser;
  value[0] = 0;
  switch (o->type) {
  case OPT_REAL:
    PetscCall(PetscSNPrintf(value, length, "%.17g", (double)*(const PetscReal *)member));
    break;
  case OPT_INT:
    PetscCall(PetscSNPrintf(value, length, "%" PetscInt_FMT, *(const PetscInt *)member));
    break;
  case OPT_BOOL:
    PetscCall(PetscStrncpy(value, *(const PetscBool *)member ? "true" : "false", length));
    break;
  case OPT_ENUM: {
    const char *p = o->range;
    for (PetscInt k = *(const PetscInt *)member; k > 0; k--) p = strchr(p, '|') + 1;
    PetscCall(PetscStrncpy(value, p, PetscMin(length, strcspn(p, "|") + 1)));
    break;
  }
  case OPT_REALS:
  case OPT_INTS: {
    const RealList *reals = (const RealList *)member;
    const IntList *ints = (const IntList *)member;
    const PetscInt n = o->type == OPT_REALS ? reals->n : ints->n;
    for (PetscInt k = 0; k < n; k++) {
      const size_t used = strlen(value);
      const char *comma = k ? "," : "";
      if (o->type == OPT_REALS)
        PetscCall(PetscSNPrintf(value + used, length - used, "%s%.17g", comma, (double)reals->v[k]));
      else
        PetscCall(PetscSNPrintf(value + used, length - used, "%s%" PetscInt_FMT, comma, ints->v[k]));
    }
    break;
  }
  default:
    PetscCall(PetscStrncpy(value, (const char *)member, length));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneWriteOptions(Scene scene, FILE *file) {
  char value[PETSC_MAX_PATH_LEN];
  const PetscBool by_area = SceneGiven(scene, "-vesicle_area") || SceneGiven(scene, "-vesicle_reduced_area");
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < TABLE_SIZE; i++) {
    /* the ellipse is described in one of two ways: writing both would be refused when read back */
    if (!strcmp(table[i].name, "-vesicle_semi_axes") && by_area) continue;
    if ((!strcmp(table[i].name, "-vesicle_area") || !strcmp(table[i].name, "-vesicle_reduced_area")) && !by_area)
      continue;
    /* what one launch was asked to do with an earlier run's files is no part of the run */
    if (!strcmp(table[i].name, "-restart") || !strcmp(table[i].name, "-output_overwrite")) continue;
    PetscCall(SceneOptionValue(scene, i, value, sizeof(value)));
    if (*value) fprintf(file, "%s %s\n", table[i].name, value);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
