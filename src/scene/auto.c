/* -scheme_auto: the settings that reach a wanted error, by what was measured. A vesicle that the flow compresses along
   its length wrinkles, and errors of its steps grow with the wrinkles; thin shapes and thin films need more markers
   (docs/settings.md). */
#include "scene/auto.h"
#include "curve/contacts.h"
#include "numerics/spectral.h"
#include "scene/checks.h"
#include "scene/properties.h"
#include "scene/vesicles.h"

/* By wanted error: the settings, and the worst error that each of them leaves by itself over the scenes of the
   calibration, docs/speed_accuracy/calibration.csv (tests/program/test_auto.py compares with the table). */
typedef struct {
  PetscReal wanted;
  PetscReal adapt_tol, of_steps; /* 32 scenes: tank-treading, turning, relaxing, a channel, pairs */
  PetscReal ksp_rtol, of_solver; /* these 32 scenes */
  PetscReal max_step, of_rest;   /* over nu R0^3/c_b; energy of shapes at rest */
} Calibrated;

static const Calibrated calibrated[] = {{1e-1, 1e-2, 3.1e-2, 1e-4, 3.6e-5, 4, 2.6e-7},
                                        {1e-2, 1e-3, 4.5e-3, 1e-4, 3.6e-5, 4, 2.6e-7},
                                        {1e-3, 3e-5, 1.6e-4, 1e-5, 6.3e-6, 4, 2.6e-7},
                                        {1e-4, 7e-6, 4.1e-5, 1e-6, 4.4e-7, 2, 2.9e-7}};

static const Calibrated *CalibratedRow(Scene s) {
  const PetscInt last = (PetscInt)(sizeof(calibrated) / sizeof(calibrated[0])) - 1;
  PetscInt row = 0;
  while (row < last && calibrated[row].wanted > s->scheme.wanted * (1 + 1e-9)) row++;
  return &calibrated[row];
}

#define ALIGNED 1e-6 /* over the strain: a smaller rate of compression is rounding */
#define SQUEEZED 3   /* nu R0^3/c_b times the rate of compression from which on steps are those of wrinkles */
#define MOST_FINER 3 /* times the default's markers */
#define WIDE 2       /* spacings: wider films are resolved */
#define GROWTH 1.2   /* of the markers from one try to the next */

/* The tail of a shape that markers resolve for an error of 1e-3 and where none is given, and the largest: 0.31 left
   7e-4 of R0 in a pair pressed together. */
#define TAIL 0.15
#define MOST_TAIL 0.3

/* Error of a film over its thickness, by the number of marker spacings in the film (docs/settings.md, Films). */
static const struct {
  PetscReal spacings, error;
} films[] = {{WIDE, 1e-5}, {1.5, 2e-4}, {1, 4e-3}, {0.7, 1e-2}, {0.5, 4e-2}, {0.3, 1}};

/* Rate at which the flow shortens vesicle v along its length (1/time); 0 if the flow does not, or is not known. */
static PetscReal VesicleCompression(Scene scene, PetscInt v) {
  const Shape *s = &scene->shape;
  PetscReal mean[2], xx = 0, yy = 0, xy = 0, G[2][2];
  if (FlowIsCustom(&scene->flow)) return 0;
  ShapeMiddle(s, v, mean);
  for (PetscInt k = s->start[v]; k < s->start[v + 1]; k++) {
    const PetscReal x = s->X[2 * k] - mean[0], y = s->X[2 * k + 1] - mean[1];
    xx += x * x;
    yy += y * y;
    xy += x * y;
  }
  const PetscReal angle = 0.5 * PetscAtan2Real(2 * xy, xx - yy), c = PetscCosReal(angle), d = PetscSinReal(angle);
  FlowGradient(&scene->flow, mean[1], G);
  const PetscReal rate = -(G[0][0] * c * c + (G[0][1] + G[1][0]) * c * d + G[1][1] * d * d);
  return rate > ALIGNED * (PetscAbsReal(G[0][0]) + PetscAbsReal(G[0][1] + G[1][0])) ? rate : 0;
}

/* nu R0^3/c_b times the rate at which the flow shortens a vesicle of the start along its length, the largest; 0 where
   it is so small that no vesicle wrinkles. */
static PetscReal VesicleSqueeze(Scene scene) {
  PetscReal largest = 0;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++)
    if (scene->membrane.material[v].bending > 0)
      largest = PetscMax(largest, VesicleCompression(scene, v) * SceneMembraneTime(scene, v));
  return largest > SQUEEZED ? largest : 0;
}

/* Error of a film over its thickness, interpolated between the rows of films. */
static PetscReal FilmError(PetscReal spacings) {
  const int n = (int)(sizeof(films) / sizeof(films[0]));
  int k = 1;
  while (k < n - 1 && spacings < films[k].spacings) k++;
  const PetscReal part = (spacings - films[k].spacings) / (films[k - 1].spacings - films[k].spacings);
  return PetscExpReal((1 - part) * PetscLogReal(films[k].error) + part * PetscLogReal(films[k - 1].error));
}

/* The thinnest film of the start, in marker spacings (2: none is thinner), and the error that it leaves, of its
   thickness over R0. */
static PetscErrorCode StartThinnestFilm(Scene scene, PetscReal *spacings, PetscReal *error) {
  const Shape *s = &scene->shape;
  const CurveRoom room = SceneRoom(scene);
  const PetscBool smooth = scene->membrane.derivative == DERIVATIVE_SPECTRAL;
  CurveFilm film;
  PetscReal *ds;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->vesicles, &ds));
  for (PetscInt v = 0; v < s->vesicles; v++) ds[v] = 2 * PETSC_PI * ShapeRadius(s, v) / (s->start[v + 1] - s->start[v]);
  const CurveSet set = {s->vesicles, s->vesicles, s->start, NULL, s->X, room.period, smooth};
  PetscCall(CurveThinnestFilm(&set, ds, &room, WIDE, &film));
  PetscCall(PetscFree(ds));
  *spacings = film.spacings;
  *error = film.spacings < WIDE ? FilmError(film.spacings) * film.thickness / SceneSmallestRadius(scene) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Print what the thinnest film of the start leaves. */
static PetscErrorCode AutoReportFilm(Scene scene) {
  PetscReal spacings, error;
  PetscFunctionBeginUser;
  PetscCall(StartThinnestFilm(scene, &spacings, &error));
  if (error > 0)
    PetscCall(PetvesSay(scene->comm, "  thinnest film: %.2g marker spacings, which leaves up to %.1g of R0: %s\n",
                        (double)spacings, (double)error,
                        error <= scene->scheme.wanted ? "enough" : "TOO THIN, take more -vesicle_markers"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SceneRoughTail(Scene scene) {
  const PetscReal wanted = scene->scheme.wanted;
  return wanted > 0 ? PetscMin(MOST_TAIL, TAIL * PetscSqrtReal(wanted / 1e-3)) : TAIL;
}

/* Find out whether the markers resolve the shapes and the films of the start. */
static PetscErrorCode StartIsResolved(Scene scene, PetscBool *resolved) {
  const Shape *s = &scene->shape;
  PetscReal spacings, error;
  PetscFunctionBeginUser;
  PetscCall(StartThinnestFilm(scene, &spacings, &error));
  *resolved = error < 0.5 * scene->scheme.wanted && spacings > SCENE_FILM;
  for (PetscInt v = 0; v < s->vesicles && *resolved; v++) {
    Spectral spectral;
    PetscCall(SpectralCreate(s->start[v + 1] - s->start[v], &spectral));
    if (SpectralTail(spectral, 2. / 3, s->X + 2 * s->start[v]) > SceneRoughTail(scene)) *resolved = PETSC_FALSE;
    PetscCall(SpectralDestroy(&spectral));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneChooseMarkers(Draft scene) {
  const PetscReal h = FluidSpecCellSize(&scene->fluid);
  PetscBool resolved = PETSC_FALSE, stretches = PETSC_FALSE;
  PetscInt n = 0, most = PETSC_MAX_INT;
  PetscFunctionBeginUser;
  if (scene->scheme.wanted == 0 || !scene->shape.vesicles || SceneGiven(scene, "-vesicle_markers") ||
      scene->vesicles.spacing > 0 || scene->coupling.near_field != NEAR_EXACT ||
      scene->membrane.derivative != DERIVATIVE_SPECTRAL)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) {
    const PetscReal length = 2 * PETSC_PI * ShapeRadius(&scene->shape, v);
    n = PetscMax(n, scene->shape.start[v + 1] - scene->shape.start[v]);
    most = PetscMin(most, (PetscInt)(length / (NEAR_LEAST_SPACING * h)));
    if (scene->membrane.material[v].modulus > 0) stretches = PETSC_TRUE;
  }
  most = PetscMin(most, MOST_FINER * n);
  const PetscInt least = stretches || VesicleSqueeze(scene) > 0 ? PetscMin(most, 3 * n / 2) - 1 : 0;
  for (;;) {
    PetscCall(StartIsResolved(scene, &resolved));
    if ((resolved && n >= least) || n >= most - 1) break;
    n = PetscMin((PetscInt)(GROWTH * n), most);
    n -= 1 - n % 2;
    scene->vesicles.markers = n;
    PetscCall(SceneDropShape(scene));
    PetscCall(SceneMakeShape(scene));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SuggestStep(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const PetscReal rate = FlowShearRate(&s->flow), rest = SceneRestTime(s),
                  time = rate > 0 ? PetscMin(rest, 1 / rate) : rest;
  const PetscBool timed = time < PETSC_MAX_REAL;
  (void)snprintf(why, AUTO_TEXT, timed ? "a twentieth of the fastest time of the scene" : "the default");
  if (timed) (void)snprintf(value, AUTO_TEXT, "%.6g", (double)(0.05 * time));
  return PETSC_SUCCESS;
}

/* Where the flow compresses a vesicle so fast that it wrinkles, the tolerance is a hundredth of the error wanted, whose
   steps leave up to a third of that error by the worst measured. */
#define OF_WRINKLES 100
#define WRINKLES_LEAVE 0.3

static PetscErrorCode SuggestTolerance(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const PetscReal chi = VesicleSqueeze(s), wanted = s->scheme.wanted;
  if (s->time.adapt == ADAPT_ERROR && chi > 0)
    (void)snprintf(why, AUTO_TEXT, "a vesicle is compressed (chi = %.2g) and wrinkles: leaves up to %.1e", (double)chi,
                   (double)(WRINKLES_LEAVE * wanted));
  else if (s->time.adapt == ADAPT_ERROR)
    (void)snprintf(why, AUTO_TEXT, "steps leave up to %.1e", (double)CalibratedRow(s)->of_steps);
  (void)snprintf(value, AUTO_TEXT, "%g", (double)(chi > 0 ? wanted / OF_WRINKLES : CalibratedRow(s)->adapt_tol));
  return PETSC_SUCCESS;
}

/* The largest step is that for the error at rest, but not larger than the flow bears. */
static PetscErrorCode SuggestLargestStep(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const PetscReal rest = SceneRestTime(s), flow = SceneFlowStep(s), own = CalibratedRow(s)->max_step;
  const PetscBool bends = s->time.adapt == ADAPT_ERROR && s->membrane.bending > 0;
  if (bends && flow < own * rest)
    (void)snprintf(why, AUTO_TEXT, "what this flow bears");
  else if (bends)
    (void)snprintf(why, AUTO_TEXT, "%g nu R0^3/c_b: leaves up to %.1e of the energy at rest", (double)own,
                   (double)CalibratedRow(s)->of_rest);
  if (rest < PETSC_MAX_REAL) (void)snprintf(value, AUTO_TEXT, "%.6g", (double)PetscMin(own * rest, flow));
  return PETSC_SUCCESS;
}

static PetscErrorCode SuggestSolver(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  (void)snprintf(why, AUTO_TEXT, "the solver leaves up to %.1e", (double)CalibratedRow(s)->of_solver);
  return PETSC_SUCCESS;
}

/* The number of markers has been chosen by SceneChooseMarkers. */
static PetscErrorCode SuggestMarkers(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  if (s->vesicles.markers > 0)
    (void)snprintf(why, AUTO_TEXT, "by the shapes and films of the start, compression and stretching");
  return PETSC_SUCCESS;
}

/* All settings in the order in which they are printed. A setting has a value and a reason, or a function that writes
   them: without a value the default stays, and without a reason the setting is not worth a line unless it is the
   user's. The solver's tolerance is no option of the table. */
typedef struct {
  const char *name;
  AutoStage stage;
  const char *value, *why;
  PetscErrorCode (*suggest)(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
} Setting;

/* clang-format off */
static const Setting settings[AUTO_SETTINGS] = {
  {"-scheme_type", AUTO_FIRST, "", "the membrane and the fluid in one solve"},
  {"-scheme_order", AUTO_FIRST, "", "what was calibrated"},
  {"-time_adapt", AUTO_FIRST, "error", "finds the step of any scene"},
  {"-time_step", AUTO_STEPS, .suggest = SuggestStep},
  {"-time_adapt_tol", AUTO_STEPS, .suggest = SuggestTolerance},
  {"-time_adapt_max_step", AUTO_STEPS, .suggest = SuggestLargestStep},
  {"-coupled_ksp_rtol", AUTO_STEPS, .suggest = SuggestSolver},
  {"-delta_type", AUTO_FIRST, "cbs54", "kernels differ by 1e-4 at most"},
  {"-vesicle_spacing", AUTO_STEPS, "", ""},
  {"-vesicle_markers", AUTO_STEPS, .suggest = SuggestMarkers},
  {"-domain_bc_x", AUTO_FIRST, .suggest = SceneSuggestBoundaryX},
  {"-domain_bc_y", AUTO_FIRST, .suggest = SceneSuggestBoundaryY},
  {"-domain_box", AUTO_DOMAIN, .suggest = SceneSuggestBox},
  {"-domain_cells", AUTO_DOMAIN, .suggest = SceneSuggestCells},
  {"-sphere_degree", AUTO_SPACE, .suggest = SceneSuggestDegree},
  {"-scheme_order", AUTO_SPACE, "", "what was calibrated"},
  {"-bending_newton", AUTO_SPACE, "", "a second Newton step gains what smaller steps do"},
  {"-time_adapt", AUTO_SPACE, "error", "finds the step of any scene"},
  {"-time_step", AUTO_SPACE, .suggest = SceneSuggestSpaceStep},
  {"-time_adapt_tol", AUTO_SPACE, .suggest = SceneSuggestSpaceTolerance},
  {"-time_adapt_max_step", AUTO_SPACE, .suggest = SceneSuggestSpaceMost}};

PetscErrorCode SceneChooseByError(Draft s, AutoStage stage) {
  const SceneRule rules[] = {
    {s->scheme.wanted < 1e-4 || s->scheme.wanted > 0.1,
     "-scheme_auto {-scheme_auto}: outside of what was measured; allowed: 0, or 1e-4 to 0.1"},
    {SceneIsProjection(s), "-scheme_auto {-scheme_auto}: with -scheme_type {-scheme_type}; allowed: coupled"},
    {stage == AUTO_SPACE && s->dim == DIM_AXIAL && !SceneSpaceMeasured(s),
     "-scheme_auto {-scheme_auto}: outside of what was measured with -dim axisymmetric; allowed: 1e-3 to 0.1, one prolate spheroid of -vesicle_reduced_volume 0.7 or more, 0.8 below 1e-2, in a tube of 1.1 to 2 R0 without a throat, in -flow_type tube of a mean velocity of 1 to 10 kappa/(nu R0^2), without viscosity ratio or gravity"},
    {stage == AUTO_SPACE && !SceneSpaceMeasured(s),
     "-scheme_auto {-scheme_auto}: outside of what was measured with -dim 3; allowed: one spheroid of -vesicle_reduced_volume 0.7 or more, 0.8 below 1e-3, in -flow_type shear, rate nu R0^3/kappa 1 to 100, without viscosity ratio or gravity"}};
  /* clang-format on */
  PetscFunctionBeginUser;
  if (s->scheme.wanted == 0 || (stage == AUTO_STEPS && !s->shape.vesicles)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(REFUSE(s, rules));
  s->coupling.ksp_rtol = CalibratedRow(s)->ksp_rtol;
  for (int k = 0; k < AUTO_SETTINGS; k++) {
    const Setting *own = &settings[k];
    char value[AUTO_TEXT] = "", *why = s->scheme.reason[k];
    if (own->stage != stage || SceneGiven(s, own->name)) continue;
    if (own->suggest)
      PetscCall(own->suggest(s, value, why));
    else {
      PetscCall(PetscStrncpy(value, own->value, AUTO_TEXT));
      PetscCall(PetscStrncpy(why, own->why, AUTO_TEXT));
    }
    if (*value) PetscCall(OptionChoose(&s->options, s, own->name, value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers, with commas between them, to six digits. */
static void AutoShorten(char value[AUTO_TEXT]) {
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

/* A line for a setting: its name, value, and reason, or that it is the user's. */
static PetscErrorCode AutoReportSetting(Scene s, const char name[], const char why[]) {
  char value[AUTO_TEXT];
  PetscBool given = SceneGiven(s, name);
  const PetscInt i = OptionFind(&s->options, name);
  PetscFunctionBeginUser;
  if (i >= 0) {
    PetscCall(OptionValue(&s->options, s, i, value, sizeof(value)));
  } else {
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.0e", (double)s->coupling.ksp_rtol));
    PetscCall(PetscOptionsGetString(NULL, NULL, name, value, sizeof(value), &given));
  }
  if (!*why && !given) PetscFunctionReturn(PETSC_SUCCESS);
  AutoShorten(value);
  PetscCall(PetvesSay(s->comm, "  %-20s %-8s %s\n", name, value, given ? "yours" : why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MANY_MARKERS 700     /* from so many markers on the block of a vesicle takes a second and more */
#define BLOCK_SECONDS 3.5e-9 /* seconds of a block over the third power of the markers */

/* clang-format off */
/* Warn of vesicles whose dense blocks in the solve take long to make. */
static PetscErrorCode AutoReportMarkers(Scene scene) {
  const PetscInt *start = scene->shape.start;
  PetscInt most = 0;
  for (PetscInt v = 0; v < scene->shape.vesicles && !SceneIsProjection(scene); v++) most = PetscMax(most, start[v + 1] - start[v]);
  if (most < MANY_MARKERS) return PETSC_SUCCESS;
  return PetvesSay(scene->comm,
    "petves: warning: %" PetscInt_FMT " markers on a vesicle: its dense block in the solve takes about %.1g s to make, some five times in the first step, in proportion to markers^3; fewer -vesicle_markers or a larger -vesicle_spacing take less\n",
    most, BLOCK_SECONDS * PetscPowRealInt((PetscReal)most, 3));
}
/* clang-format on */

PetscErrorCode SceneReport(Scene s) {
  PetscFunctionBeginUser;
  const PetscBool space = s->dim != DIM_PLANE;
  if (s->scheme.wanted > 0 && (space || s->shape.vesicles)) {
    PetscCall(PetvesSay(s->comm, "petves: -scheme_auto %g, by the worst errors measured (docs/%s.md)\n",
                        (double)s->scheme.wanted,
                        s->dim == DIM_AXIAL ? "axisymmetric"
                        : space             ? "space"
                                            : "settings"));
    for (int k = 0; k < AUTO_SETTINGS; k++)
      if ((settings[k].stage == AUTO_SPACE) == space)
        PetscCall(AutoReportSetting(s, settings[k].name, s->scheme.reason[k]));
    if (!space) PetscCall(AutoReportFilm(s));
    if (!space) PetscCall(SceneReportGrid(s));
  }
  if (*s->warning) PetscCall(PetvesSay(s->comm, "petves: warning: %s\n", s->warning));
  PetscCall(AutoReportMarkers(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
