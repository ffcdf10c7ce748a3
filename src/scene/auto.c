/* -scheme_auto: the settings that reach a wanted error, by what was measured (docs/speed_accuracy/calibration.csv). */
#include "scene/resolve.h"

/* By wanted error: the settings, and the worst error that each of them leaves by itself over the scenes of the
   calibration (tests/test_auto.py compares with the table). */
static const struct {
  PetscReal wanted;
  const char *adapt_tol;
  PetscReal of_steps; /* 14 scenes: tank-treading, turning, relaxing, a channel, a pair */
  const char *ksp_rtol;
  PetscReal of_solver; /* the same */
  PetscReal max_step;  /* over nu R0^3/c_b */
  PetscReal of_rest;   /* energy of shapes at rest */
} settings[] = {
    {1e-1, "3e-2", 1.1e-2, "1e-4", 3.1e-5, 4, 1.2e-4},   {1e-2, "3e-3", 2.5e-3, "1e-4", 3.1e-5, 4, 1.2e-4},
    {1e-3, "3e-4", 3.7e-4, "1e-5", 5.8e-6, 2, 6.3e-5},   {3e-4, "1e-4", 1.3e-4, "1e-6", 4.8e-7, 1, 3.7e-5},
    {1e-4, "3e-5", 4.0e-5, "1e-6", 4.8e-7, 0.5, 1.2e-5},
};

/* Worst error of angle and frequency in steady tank-treading (V = 0.5 to 0.9, chi = 1 and 10), by R0/h and finer, with
   markers 1.5 h apart: on coarse grids it is that of too few markers (an earlier calibration's, docs/settings.md). */
static const struct { PetscReal cells, error; } grids[] = {{12.8, 1.4e-4}, {7, 1.4e-4}, {5.3, 3.6e-4}, {3.9, 4.2e-2}};

static PetscInt Row(Scene scene) {
  const PetscInt last = (PetscInt)(sizeof(settings) / sizeof(settings[0])) - 1;
  PetscInt row = 0;
  while (row < last && settings[row].wanted > scene->scheme.wanted * (1 + 1e-9)) row++;
  return row;
}

PetscErrorCode SceneChooseByError(Draft scene) {
  PetscBool coupled, direct;
  PetscFunctionBeginUser;
  if (scene->scheme.wanted == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(scene->scheme.wanted >= 1e-4 && scene->scheme.wanted <= 0.1, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_auto %g: outside of what was measured; allowed: 0, or 1e-4 to 0.1", (double)scene->scheme.wanted);
  PetscCall(PetscStrcmp(scene->scheme.type, "coupled", &coupled));
  PetscCall(PetscStrcmp(scene->scheme.type, "direct", &direct));
  PetscCheck(coupled || direct, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_auto %g: with -scheme_type %s; allowed: coupled or direct", (double)scene->scheme.wanted,
             scene->scheme.type);
  PetscCall(SceneChoose(scene, "-scheme_order", "2"));
  PetscCall(SceneChoose(scene, "-time_adapt", "error"));
  PetscCall(SceneChoose(scene, "-time_adapt_tol", settings[Row(scene)].adapt_tol));
  PetscCall(SceneChoose(scene, "-delta_type", "cbs54"));
  scene->coupling.ksp_rtol = strtod(settings[Row(scene)].ksp_rtol, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the flow compresses a vesicle and it wrinkles: order 3, and a tolerance of a hundredth of the error wanted,
   whose steps leave up to a third of it (docs/settings.md). */
#define OF_WRINKLES 100

#define OF_TURNING 10 /* where it is compressed without that: a third of the table's */

static PetscErrorCode ChooseForCompression(Draft scene) {
  const PetscBool squeezed = SceneIsSqueezed(scene);
  char value[32];
  PetscFunctionBeginUser;
  if (SceneSqueeze(scene) == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(value, sizeof(value), "%g",
                          (double)(scene->scheme.wanted / (squeezed ? OF_WRINKLES : OF_TURNING))));
  if (squeezed) PetscCall(SceneChoose(scene, "-scheme_order", "3"));
  PetscCall(SceneChoose(scene, "-time_adapt_tol", value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For the error at rest, and no more than the flow bears. */
static PetscReal LargestStep(Scene scene, PetscReal slow) {
  return PetscMin(settings[Row(scene)].max_step * slow, SceneFlowStep(scene));
}

PetscErrorCode SceneChooseSteps(Draft scene) {
  PetscReal slow, fast;
  char value[64];
  PetscFunctionBeginUser;
  if (scene->scheme.wanted == 0 || !scene->shape.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ChooseForCompression(scene));
  SceneTimes(scene, &slow, &fast);
  if (slow < PETSC_MAX_REAL) {
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.6g", (double)LargestStep(scene, slow)));
    PetscCall(SceneChoose(scene, "-time_adapt_max_step", value));
  }
  if (fast < PETSC_MAX_REAL) {
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.6g", (double)(0.05 * fast)));
    PetscCall(SceneChoose(scene, "-time_step", value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One setting: its name, value, and why, or that it is the user's. */
static PetscErrorCode PrintSetting(Scene scene, const char name[], const char why[]) {
  char value[64] = "";
  PetscBool given = SceneGiven(scene, name);
  const PetscInt i = OptionFind(&scene->options, name);
  PetscFunctionBeginUser;
  if (i >= 0) PetscCall(SceneOptionValue(scene, i, value, sizeof(value)));
  if (!strcmp(name, "-coupled_ksp_rtol")) {
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.0e", (double)scene->coupling.ksp_rtol));
    PetscCall(PetscOptionsGetString(NULL, NULL, name, value, sizeof(value), &given));
  }
  if (strlen(value) > 10 && strchr(value, '.'))
    PetscCall(PetscSNPrintf(value, sizeof(value), "%g", strtod(value, NULL)));
  PetscCall(PetvesSay(scene->comm, "  %-20s %-8s %s\n", name, value, given ? "yours" : why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With 45 markers or more a vesicle: of second order in h until distant pairs' closed form is seen, measured from R0/h
   = 2.3 on (docs/accuracy.md). */
#define MARKERS 45
#define LEAST_CELLS 2.3
static PetscReal ErrorWithMarkers(PetscReal cells) {
  return cells < LEAST_CELLS ? PETSC_MAX_REAL : PetscMax(1.2e-4, 1.6e-3 * PetscSqr(LEAST_CELLS / cells));
}

static PetscInt FewestMarkers(const Shape *shape) {
  PetscInt fewest = PETSC_MAX_INT;
  for (PetscInt v = 0; v < shape->vesicles; v++) fewest = PetscMin(fewest, shape->start[v + 1] - shape->start[v]);
  return fewest;
}

/* Whether n has no prime factor above 5: what Fourier transforms like. */
static PetscBool IsSmooth(PetscInt n) {
  for (PetscInt prime = 2; prime <= 5; prime++)
    while (n % prime == 0) n /= prime;
  return n == 1 ? PETSC_TRUE : PETSC_FALSE;
}

/* The fewest cells that make the grid finer by a factor, square as they are. */
static void FinerCells(const FluidSpec *spec, PetscReal factor, PetscInt cells[2]) {
  PetscInt common = spec->cells[0], rest = spec->cells[1];
  while (rest > 0) {
    const PetscInt next = common % rest;
    common = rest;
    rest = next;
  }
  PetscInt finer = (PetscInt)PetscCeilReal(common * factor * (1 - 1e-9));
  while (!IsSmooth(finer)) finer++;
  for (int d = 0; d < 2; d++) cells[d] = spec->cells[d] / common * finer;
}

/* What the grid leaves, and what it would take. */
static PetscErrorCode PrintGrid(Scene scene, PetscReal cells) {
  const PetscInt n = (PetscInt)(sizeof(grids) / sizeof(grids[0]));
  const PetscBool many = FewestMarkers(&scene->shape) >= MARKERS ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal wanted = scene->scheme.wanted * (1 + 1e-9);
  PetscInt here = 0, enough = n - 1;
  PetscReal error;
  PetscFunctionBeginUser;
  while (here < n && cells < grids[here].cells) here++;
  while (enough >= 0 && grids[enough].error > wanted) enough--;
  error = here < n ? grids[here].error : PETSC_MAX_REAL;
  if (many) error = PetscMin(error, ErrorWithMarkers(cells));
  PetscCall(PetvesSay(scene->comm, "  grid: R0/h = %.3g", (double)cells));
  if (error < PETSC_MAX_REAL)
    PetscCall(PetvesSay(scene->comm, ", which leaves up to %.2g in steady tank-treading", (double)error));
  else
    PetscCall(PetvesSay(scene->comm, ", coarser than any that was measured"));
  if (error <= wanted)
    PetscCall(PetvesSay(scene->comm, ": enough\n"));
  else if (enough >= 0) {
    PetscInt finer[2];
    FinerCells(&scene->fluid, grids[enough].cells / cells, finer);
    PetscCall(PetvesSay(scene->comm,
                        ": TOO COARSE for %g, take R0/h = %g, -domain_cells %" PetscInt_FMT ",%" PetscInt_FMT "%s\n",
                        (double)scene->scheme.wanted, (double)grids[enough].cells, finer[0], finer[1],
                        !many && ErrorWithMarkers(cells) <= wanted ? ", or this grid and -vesicle_markers 45" : ""));
  } else
    PetscCall(PetvesSay(scene->comm, ": no grid up to R0/h = %g reached %g\n", (double)grids[0].cells,
                        (double)scene->scheme.wanted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the thinnest film of the start leaves. */
static PetscErrorCode PrintFilm(Scene scene) {
  PetscReal spacings, error;
  PetscFunctionBeginUser;
  PetscCall(SceneThinnestFilm(scene, &spacings, &error));
  if (error > 0)
    PetscCall(PetvesSay(scene->comm, "  thinnest film: %.2g marker spacings, which leaves up to %.1g of R0: %s\n",
                        (double)spacings, (double)error,
                        error <= scene->scheme.wanted ? "enough" : "TOO THIN, take more -vesicle_markers"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintChoice(Scene scene, PetscInt row, PetscBool timed) {
  const PetscBool squeezed = SceneIsSqueezed(scene);
  char why[128];
  PetscReal slow, fast;
  PetscFunctionBeginUser;
  SceneTimes(scene, &slow, &fast);
  PetscCall(PetvesSay(scene->comm, "petves: -scheme_auto %g, by the worst errors measured (docs/settings.md)\n",
                      (double)scene->scheme.wanted));
  PetscCall(PrintSetting(scene, "-scheme_type", "the membrane and the fluid in one solve"));
  PetscCall(PrintSetting(scene, "-scheme_order", squeezed ? "better where a vesicle wrinkles" : "what was calibrated"));
  PetscCall(PrintSetting(scene, "-time_adapt", "finds the step of any scene"));
  PetscCall(PrintSetting(scene, "-time_step", timed ? "a twentieth of the fastest time of the scene" : "the default"));
  if (scene->time.adapt == ADAPT_ERROR) {
    PetscCall(PetscSNPrintf(why, sizeof(why), "steps leave up to %.1e", (double)settings[row].of_steps));
    if (SceneSqueeze(scene) > 0)
      PetscCall(PetscSNPrintf(why, sizeof(why), "a vesicle is compressed (chi = %.2g) and %s: leaves up to %.1e",
                              (double)SceneSqueeze(scene), squeezed ? "wrinkles" : "turns",
                              (double)(scene->scheme.wanted / 3)));
    PetscCall(PrintSetting(scene, "-time_adapt_tol", why));
    if (SceneFlowStep(scene) < settings[row].max_step * slow)
      PetscCall(PetscSNPrintf(why, sizeof(why), "what this flow bears"));
    else
      PetscCall(PetscSNPrintf(why, sizeof(why), "%g nu R0^3/c_b: leaves up to %.1e of the energy at rest",
                              (double)settings[row].max_step, (double)settings[row].of_rest));
    if (scene->membrane.bending > 0) PetscCall(PrintSetting(scene, "-time_adapt_max_step", why));
  }
  PetscCall(PetscSNPrintf(why, sizeof(why), "the solver leaves up to %.1e", (double)settings[row].of_solver));
  if (!strcmp(scene->scheme.type, "coupled")) PetscCall(PrintSetting(scene, "-coupled_ksp_rtol", why));
  PetscCall(PrintSetting(scene, "-delta_type", "kernels differ by 1e-4 at most"));
  if (scene->vesicles.spacing > 0) PetscCall(PrintSetting(scene, "-vesicle_spacing", ""));
  if (scene->vesicles.markers > 0)
    PetscCall(PrintSetting(scene, "-vesicle_markers", "by the shapes, films and compression of the start"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneReport(Scene scene) {
  PetscReal slow, fast;
  PetscFunctionBeginUser;
  if (scene->scheme.wanted > 0 && scene->shape.vesicles) {
    SceneTimes(scene, &slow, &fast);
    PetscCall(PrintChoice(scene, Row(scene), fast < PETSC_MAX_REAL ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(PrintFilm(scene));
    if (FluidSpecIsFree(&scene->fluid))
      PetscCall(PetvesSay(scene->comm, "  grid: none, unbounded fluid: enough\n"));
    else
      PetscCall(PrintGrid(scene, SceneSmallestRadius(scene) / FluidSpecCellSize(&scene->fluid)));
  }
  if (*scene->warning) PetscCall(PetvesSay(scene->comm, "petves: warning: %s\n", scene->warning));
  PetscFunctionReturn(PETSC_SUCCESS);
}
