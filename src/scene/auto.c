/* -scheme_auto: the settings that reach a wanted error, by what was measured (docs/speed_accuracy/calibration.csv). */
#include "scene/auto.h"

/* By wanted error: the settings, and the worst error that each of them leaves by itself over the scenes of the
   calibration (tests/program/test_auto.py compares with the table). */
static const struct {
  PetscReal wanted;
  const char *adapt_tol;
  PetscReal of_steps; /* 32 scenes: tank-treading, turning, relaxing, a channel, pairs */
  const char *ksp_rtol;
  PetscReal of_solver; /* the same */
  PetscReal max_step;  /* over nu R0^3/c_b */
  PetscReal of_rest;   /* energy of shapes at rest */
} settings[] = {
    {1e-1, "1e-2", 3.1e-2, "1e-4", 3.6e-5, 4, 2.6e-7},
    {1e-2, "1e-3", 4.5e-3, "1e-4", 3.6e-5, 4, 2.6e-7},
    {1e-3, "3e-5", 1.6e-4, "1e-5", 6.3e-6, 4, 2.6e-7},
    {1e-4, "7e-6", 4.1e-5, "1e-6", 4.4e-7, 2, 2.9e-7},
};

static PetscInt Row(Scene scene) {
  const PetscInt last = (PetscInt)(sizeof(settings) / sizeof(settings[0])) - 1;
  PetscInt row = 0;
  while (row < last && settings[row].wanted > scene->scheme.wanted * (1 + 1e-9)) row++;
  return row;
}

PetscErrorCode SceneChooseByError(Draft scene) {
  PetscFunctionBeginUser;
  if (scene->scheme.wanted == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(scene->scheme.wanted >= 1e-4 && scene->scheme.wanted <= 0.1, scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_auto %g: outside of what was measured; allowed: 0, or 1e-4 to 0.1", (double)scene->scheme.wanted);
  PetscCheck(!strcmp(scene->scheme.type, "coupled"), scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_auto %g: with -scheme_type %s; allowed: coupled", (double)scene->scheme.wanted,
             scene->scheme.type);
  PetscCall(SceneChoose(scene, "-time_adapt", "error"));
  PetscCall(SceneChoose(scene, "-time_adapt_tol", settings[Row(scene)].adapt_tol));
  PetscCall(SceneChoose(scene, "-delta_type", "cbs54"));
  PetscCall(SceneChooseBoundaries(scene));
  scene->coupling.ksp_rtol = strtod(settings[Row(scene)].ksp_rtol, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the flow compresses a vesicle so fast that it wrinkles: a tolerance of a hundredth of the error wanted, whose
   steps leave up to a third of it, by the worst measured. */
#define OF_WRINKLES 100
#define WRINKLES_LEAVE 0.3

static PetscErrorCode ChooseForCompression(Draft scene) {
  char value[32];
  PetscFunctionBeginUser;
  if (!SceneIsSqueezed(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(value, sizeof(value), "%g", (double)(scene->scheme.wanted / OF_WRINKLES)));
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
  char why[128];
  PetscReal slow, fast;
  PetscFunctionBeginUser;
  SceneTimes(scene, &slow, &fast);
  PetscCall(PetvesSay(scene->comm, "petves: -scheme_auto %g, by the worst errors measured (docs/settings.md)\n",
                      (double)scene->scheme.wanted));
  PetscCall(SceneSaySetting(scene, "-scheme_type", "the membrane and the fluid in one solve"));
  PetscCall(SceneSaySetting(scene, "-scheme_order", "what was calibrated"));
  PetscCall(SceneSaySetting(scene, "-time_adapt", "finds the step of any scene"));
  PetscCall(
      SceneSaySetting(scene, "-time_step", timed ? "a twentieth of the fastest time of the scene" : "the default"));
  if (scene->time.adapt == ADAPT_ERROR) {
    PetscCall(PetscSNPrintf(why, sizeof(why), "steps leave up to %.1e", (double)settings[row].of_steps));
    if (SceneIsSqueezed(scene))
      PetscCall(PetscSNPrintf(why, sizeof(why), "a vesicle is compressed (chi = %.2g) and wrinkles: leaves up to %.1e",
                              (double)SceneSqueeze(scene), (double)(WRINKLES_LEAVE * scene->scheme.wanted)));
    PetscCall(SceneSaySetting(scene, "-time_adapt_tol", why));
    if (SceneFlowStep(scene) < settings[row].max_step * slow)
      PetscCall(PetscSNPrintf(why, sizeof(why), "what this flow bears"));
    else
      PetscCall(PetscSNPrintf(why, sizeof(why), "%g nu R0^3/c_b: leaves up to %.1e of the energy at rest",
                              (double)settings[row].max_step, (double)settings[row].of_rest));
    if (scene->membrane.bending > 0) PetscCall(SceneSaySetting(scene, "-time_adapt_max_step", why));
  }
  PetscCall(PetscSNPrintf(why, sizeof(why), "the solver leaves up to %.1e", (double)settings[row].of_solver));
  PetscCall(SceneSaySetting(scene, "-coupled_ksp_rtol", why));
  PetscCall(SceneSaySetting(scene, "-delta_type", "kernels differ by 1e-4 at most"));
  if (scene->vesicles.spacing > 0) PetscCall(SceneSaySetting(scene, "-vesicle_spacing", ""));
  if (scene->vesicles.markers > 0)
    PetscCall(SceneSaySetting(scene, "-vesicle_markers", "by the shapes, films and compression of the start"));
  PetscCall(SceneReportDomain(scene));
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

PetscErrorCode SceneReport(Scene scene) {
  PetscReal slow, fast;
  PetscFunctionBeginUser;
  if (scene->scheme.wanted > 0 && scene->shape.vesicles) {
    SceneTimes(scene, &slow, &fast);
    PetscCall(PrintChoice(scene, Row(scene), fast < PETSC_MAX_REAL ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(PrintFilm(scene));
    PetscCall(SceneReportGrid(scene));
  }
  if (*scene->warning) PetscCall(PetvesSay(scene->comm, "petves: warning: %s\n", scene->warning));
  PetscCall(ReportMarkers(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
