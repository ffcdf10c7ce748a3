/* -scheme_auto in three dimensions: degree and steps of one spheroid in shear. The numbers are the worst errors of the
   angle, over the last one, of docs/speed_accuracy/calibration.csv (tests/program/test_auto.py compares). */
#include "scene/auto.h"
#include "scene/properties.h"

#define VOLUMES 4
static const PetscReal volumes[VOLUMES] = {0.95, 0.9, 0.8, 0.7}; /* the degree of one is that up to the one before */

/* By wanted error: the tolerance of steps and what it leaves; the degree by reduced volume, 0 where none has been
   measured to be enough, and what it leaves. */
static const struct {
  PetscReal wanted, tolerance, of_steps;
  PetscInt degree[VOLUMES];
  PetscReal of_degree[VOLUMES];
} measured[] = {{1e-1, 1e-2, 1.2e-2, {4, 6, 6, 8}, {2.2e-2, 2.6e-3, 1.8e-2, 8.6e-3}},
                {1e-2, 1e-3, 2.3e-3, {6, 6, 8, 10}, {2.1e-3, 2.6e-3, 3.9e-3, 4.3e-3}},
                {1e-3, 1e-4, 2.6e-4, {10, 8, 10, 16}, {2.6e-4, 4.9e-4, 3.3e-4, 1.5e-4}},
                {1e-4, 3e-5, 4.8e-5, {14, 12, 14, 0}, {3.4e-5, 2.6e-5, 4.6e-5, 0}}};

static int MeasuredRow(Scene s) {
  int row = 0;
  while (row < 3 && measured[row].wanted > s->scheme.wanted * (1 + 1e-9)) row++;
  return row;
}

/* Column of the reduced volume, VOLUMES below all of them. */
static int MeasuredVolume(Scene s) {
  int v = 0;
  while (v < VOLUMES && s->space.reduced_volume.v[0] < volumes[v]) v++;
  return v;
}

/* Rate of the shear and of the membrane's relaxation, kappa/(nu R0^3) (1/time). */
static void SpaceRates(Scene s, PetscReal *shear, PetscReal *membrane) {
  *membrane = s->membrane.stiffness.v[0] / (s->fluid.nu * PetscPowRealInt(s->space.radius.v[0], 3));
  *shear = PetscAbsReal(s->flow.chi != 0 ? s->flow.chi * *membrane : s->flow.rate);
}

PetscBool SceneSpaceMeasured(Scene s) {
  const int v = MeasuredVolume(s);
  PetscReal shear, membrane;
  SpaceRates(s, &shear, &membrane);
  return v < VOLUMES && measured[MeasuredRow(s)].degree[v] && s->vesicles.count == 1 && s->flow.type == FLOW_SHEAR &&
         shear >= membrane && shear <= 100 * membrane && !SceneHasContrast(s) && !SceneHasGravity(s) &&
         !*s->vesicles.file && !SceneGiven(s, "-vesicle_half_axes") && s->space.spheroid != SPHEROID_CAPSULE;
}

PetscErrorCode SceneSuggestDegree(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const int row = MeasuredRow(s), v = MeasuredVolume(s);
  (void)snprintf(value, AUTO_TEXT, "%d", (int)measured[row].degree[v]);
  (void)snprintf(why, AUTO_TEXT, "leaves up to %.1e of the angle from a reduced volume of %g on",
                 (double)measured[row].of_degree[v], (double)volumes[v]);
  return PETSC_SUCCESS;
}

PetscErrorCode SceneSuggestSpaceStep(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  PetscReal shear, membrane;
  SpaceRates(s, &shear, &membrane);
  (void)snprintf(value, AUTO_TEXT, "%.6g", (double)(0.05 / PetscMax(shear, membrane)));
  (void)snprintf(why, AUTO_TEXT, "a twentieth of the fastest time of the scene");
  return PETSC_SUCCESS;
}

PetscErrorCode SceneSuggestSpaceTolerance(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  (void)snprintf(value, AUTO_TEXT, "%g", (double)measured[MeasuredRow(s)].tolerance);
  if (s->time.adapt == ADAPT_ERROR)
    (void)snprintf(why, AUTO_TEXT, "steps leave up to %.1e", (double)measured[MeasuredRow(s)].of_steps);
  return PETSC_SUCCESS;
}

PetscErrorCode SceneSuggestSpaceMost(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  PetscReal shear, membrane;
  SpaceRates(s, &shear, &membrane);
  (void)snprintf(value, AUTO_TEXT, "%.6g", (double)(1 / shear));
  (void)snprintf(why, AUTO_TEXT, "what was calibrated");
  return PETSC_SUCCESS;
}
