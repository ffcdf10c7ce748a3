#include "scene/auto.h"
#include "scene/autodomain.h"
#include "scene/autogrid.h"
#include "scene/autostart.h"
#include "scene/properties.h"

/* By wanted error: the settings, and the worst error that each of them leaves by itself over the scenes of the
   calibration, docs/speed_accuracy/calibration.csv (tests/program/test_auto.py compares with the table). */
typedef struct {
  PetscReal wanted;
  PetscReal adapt_tol, of_steps; /* 32 scenes: tank-treading, turning, relaxing, a channel, pairs */
  PetscReal ksp_rtol, of_solver; /* the same */
  PetscReal max_step, of_rest;   /* over nu R0^3/c_b; energy of shapes at rest */
} Calibrated;

static const Calibrated calibrated[] = {{1e-1, 1e-2, 3.1e-2, 1e-4, 3.6e-5, 4, 2.6e-7},
                                        {1e-2, 1e-3, 4.5e-3, 1e-4, 3.6e-5, 4, 2.6e-7},
                                        {1e-3, 3e-5, 1.6e-4, 1e-5, 6.3e-6, 4, 2.6e-7},
                                        {1e-4, 7e-6, 4.1e-5, 1e-6, 4.4e-7, 2, 2.9e-7}};

static const Calibrated *Row(Scene s) {
  const PetscInt last = (PetscInt)(sizeof(calibrated) / sizeof(calibrated[0])) - 1;
  PetscInt row = 0;
  while (row < last && calibrated[row].wanted > s->scheme.wanted * (1 + 1e-9)) row++;
  return &calibrated[row];
}

/* A number that the scene has, to be chosen as a text. */
static PetscErrorCode Write(const char format[], PetscReal number, char value[AUTO_TEXT]) {
  PetscFunctionBeginUser;
  if (number < PETSC_MAX_REAL) PetscCall(PetscSNPrintf(value, AUTO_TEXT, format, (double)number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ChooseStep(Draft s, char value[AUTO_TEXT]) {
  const PetscReal time = SceneFastestTime(s);
  return Write("%.6g", time < PETSC_MAX_REAL ? 0.05 * time : time, value);
}

static PetscBool ExplainStep(Scene s, char why[AUTO_TEXT]) {
  const PetscBool timed = SceneFastestTime(s) < PETSC_MAX_REAL ? PETSC_TRUE : PETSC_FALSE;
  (void)snprintf(why, AUTO_TEXT, timed ? "a twentieth of the fastest time of the scene" : "the default");
  return PETSC_TRUE;
}

/* Where the flow compresses a vesicle so fast that it wrinkles: a tolerance of a hundredth of the error wanted, whose
   steps leave up to a third of it, by the worst measured. */
#define OF_WRINKLES 100
#define WRINKLES_LEAVE 0.3

static PetscErrorCode ChooseTolerance(Draft s, char value[AUTO_TEXT]) {
  return Write("%g", SceneSqueeze(s) > 0 ? s->scheme.wanted / OF_WRINKLES : Row(s)->adapt_tol, value);
}

static PetscBool ExplainTolerance(Scene s, char why[AUTO_TEXT]) {
  const PetscReal chi = SceneSqueeze(s);
  if (chi > 0)
    (void)snprintf(why, AUTO_TEXT, "a vesicle is compressed (chi = %.2g) and wrinkles: leaves up to %.1e", (double)chi,
                   (double)(WRINKLES_LEAVE * s->scheme.wanted));
  else
    (void)snprintf(why, AUTO_TEXT, "steps leave up to %.1e", (double)Row(s)->of_steps);
  return s->time.adapt == ADAPT_ERROR ? PETSC_TRUE : PETSC_FALSE;
}

/* For the error at rest, and no more than the flow bears. */
static PetscErrorCode ChooseLargestStep(Draft s, char value[AUTO_TEXT]) {
  const PetscReal rest = SceneRestTime(s);
  return Write("%.6g", rest < PETSC_MAX_REAL ? PetscMin(Row(s)->max_step * rest, SceneFlowStep(s)) : rest, value);
}

static PetscBool ExplainLargestStep(Scene s, char why[AUTO_TEXT]) {
  if (SceneFlowStep(s) < Row(s)->max_step * SceneRestTime(s))
    (void)snprintf(why, AUTO_TEXT, "what this flow bears");
  else
    (void)snprintf(why, AUTO_TEXT, "%g nu R0^3/c_b: leaves up to %.1e of the energy at rest", (double)Row(s)->max_step,
                   (double)Row(s)->of_rest);
  return s->time.adapt == ADAPT_ERROR && s->membrane.bending > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool ExplainSolver(Scene s, char why[AUTO_TEXT]) {
  (void)snprintf(why, AUTO_TEXT, "the solver leaves up to %.1e", (double)Row(s)->of_solver);
  return PETSC_TRUE;
}

static PetscBool ExplainSpacing(Scene s, char why[AUTO_TEXT]) {
  return s->vesicles.spacing > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool ExplainMarkers(Scene s, char why[AUTO_TEXT]) {
  (void)snprintf(why, AUTO_TEXT, "by the shapes, films and compression of the start");
  return s->vesicles.markers > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* All settings in the order in which they are printed: their values, or what finds them, and their reasons. Markers are
   chosen by SceneChooseMarkers, the solver's tolerance is no option of the table. */
typedef struct {
  const char *name;
  AutoStage stage;
  const char *value;
  PetscErrorCode (*choose)(Draft scene, char value[AUTO_TEXT]);
  const char *why;
  PetscBool (*explain)(Scene scene, char why[AUTO_TEXT]);
} Setting;

/* clang-format off */
static const Setting settings[] = {
  {"-scheme_type", AUTO_NEVER, .why = "the membrane and the fluid in one solve"},
  {"-scheme_order", AUTO_NEVER, .why = "what was calibrated"},
  {"-time_adapt", AUTO_FIRST, .value = "error", .why = "finds the step of any scene"},
  {"-time_step", AUTO_STEPS, .choose = ChooseStep, .explain = ExplainStep},
  {"-time_adapt_tol", AUTO_STEPS, .choose = ChooseTolerance, .explain = ExplainTolerance},
  {"-time_adapt_max_step", AUTO_STEPS, .choose = ChooseLargestStep, .explain = ExplainLargestStep},
  {"-coupled_ksp_rtol", AUTO_NEVER, .explain = ExplainSolver},
  {"-delta_type", AUTO_FIRST, .value = "cbs54", .why = "kernels differ by 1e-4 at most"},
  {"-vesicle_spacing", AUTO_NEVER, .explain = ExplainSpacing},
  {"-vesicle_markers", AUTO_NEVER, .explain = ExplainMarkers},
  {"-domain_bc_x", AUTO_FIRST, .choose = SceneChooseBoundaryX, .explain = SceneExplainBoundaryX},
  {"-domain_bc_y", AUTO_FIRST, .choose = SceneChooseBoundaryY, .explain = SceneExplainBoundaryY},
  {"-domain_box", AUTO_DOMAIN, .choose = SceneChooseBox, .explain = SceneExplainBox},
  {"-domain_cells", AUTO_DOMAIN, .choose = SceneChooseCells, .explain = SceneExplainCells}};
/* clang-format on */
#define SETTINGS (sizeof(settings) / sizeof(settings[0]))

static PetscErrorCode CheckWanted(Scene s) {
  const PetscReal wanted = s->scheme.wanted;
  PetscFunctionBeginUser;
  PetscCheck(wanted >= 1e-4 && wanted <= 0.1, s->comm, PETSC_ERR_USER_INPUT,
             "-scheme_auto %g: outside of what was measured; allowed: 0, or 1e-4 to 0.1", (double)wanted);
  PetscCheck(!SceneIsProjection(s), s->comm, PETSC_ERR_USER_INPUT,
             "-scheme_auto %g: with -scheme_type %s; allowed: coupled", (double)wanted, s->scheme.type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneChooseByError(Draft s, AutoStage stage) {
  PetscFunctionBeginUser;
  if (s->scheme.wanted == 0 || (stage == AUTO_STEPS && !s->shape.vesicles)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckWanted(s));
  s->coupling.ksp_rtol = Row(s)->ksp_rtol;
  for (size_t k = 0; k < SETTINGS; k++) {
    const Setting *own = &settings[k];
    char value[AUTO_TEXT] = "";
    if (own->stage != stage || SceneGiven(s, own->name)) continue;
    if (own->value) PetscCall(PetscStrncpy(value, own->value, AUTO_TEXT));
    if (own->choose) PetscCall(own->choose(s, value));
    if (*value) PetscCall(OptionChoose(&s->options, s, own->name, value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers, with commas between them, to six digits. */
static void Shorten(char value[AUTO_TEXT]) {
  char text[AUTO_TEXT];
  size_t used = 0;
  if (!strchr(value, '.')) return;
  (void)snprintf(text, sizeof(text), "%s", value);
  for (char *at = text, *end = NULL; *at; at = *end ? end + 1 : end) {
    const double number = strtod(at, &end);
    if (end == at || (*end && *end != ',')) return;
    used += (size_t)snprintf(value + used, AUTO_TEXT - used, "%s%.6g", used ? "," : "", number);
  }
}

/* One setting: its name, value, and why, or that it is the user's. */
static PetscErrorCode Say(Scene s, const Setting *own) {
  char value[AUTO_TEXT], why[AUTO_TEXT] = "";
  PetscBool given = SceneGiven(s, own->name);
  const PetscInt i = OptionFind(&s->options, own->name);
  PetscFunctionBeginUser;
  if (own->why) PetscCall(PetscStrncpy(why, own->why, sizeof(why)));
  if (own->explain && !own->explain(s, why)) PetscFunctionReturn(PETSC_SUCCESS);
  if (i >= 0) {
    PetscCall(OptionValue(&s->options, s, i, value, sizeof(value)));
  } else {
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.0e", (double)s->coupling.ksp_rtol));
    PetscCall(PetscOptionsGetString(NULL, NULL, own->name, value, sizeof(value), &given));
  }
  Shorten(value);
  PetscCall(PetvesSay(s->comm, "  %-20s %-8s %s\n", own->name, value, given ? "yours" : why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MANY_MARKERS 700     /* from which on the block of a vesicle takes a second and more, */
#define BLOCK_SECONDS 3.5e-9 /* times the third power of the markers */

/* That the dense blocks of the solve take long. */
static PetscErrorCode ReportMarkers(Scene scene) {
  PetscInt most = 0;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < scene->shape.vesicles && !SceneIsProjection(scene); v++)
    most = PetscMax(most, scene->shape.start[v + 1] - scene->shape.start[v]);
  if (most < MANY_MARKERS) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetvesSay(scene->comm,
                      "petves: warning: %" PetscInt_FMT
                      " markers on a vesicle: its dense block in the solve takes about "
                      "%.1g s to make, some five times in the first step, in proportion to markers^3; fewer "
                      "-vesicle_markers or a larger -vesicle_spacing take less\n",
                      most, BLOCK_SECONDS * PetscPowRealInt((PetscReal)most, 3)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneReport(Scene s) {
  PetscFunctionBeginUser;
  if (s->scheme.wanted > 0 && s->shape.vesicles) {
    PetscCall(PetvesSay(s->comm, "petves: -scheme_auto %g, by the worst errors measured (docs/settings.md)\n",
                        (double)s->scheme.wanted));
    for (size_t k = 0; k < SETTINGS; k++) PetscCall(Say(s, &settings[k]));
    PetscCall(SceneReportFilm(s));
    PetscCall(SceneReportGrid(s));
  }
  if (*s->warning) PetscCall(PetvesSay(s->comm, "petves: warning: %s\n", s->warning));
  PetscCall(ReportMarkers(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
