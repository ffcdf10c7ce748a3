/* -scheme_auto in three dimensions: degree and steps of one spheroid in shear, and of one prolate spheroid in a tube.
   The numbers are the worst errors of docs/speed_accuracy/calibration.csv (tests/program/test_auto.py compares): in
   shear of the angle, over the last one, in a tube of speed and pressure drop, over the largest. */
#include "scene/auto.h"
#include "scene/properties.h"

#define VOLUMES 4
static const PetscReal volumes[VOLUMES] = {0.95, 0.9, 0.8, 0.7}; /* the degree of one is that up to the one before */

/* For a wanted error: the tolerance of steps and what it leaves; the degree by reduced volume, 0 where none has been
   measured to be enough, and what it leaves. */
#define WANTED 4
typedef struct {
  PetscReal wanted, tolerance, of_steps;
  PetscInt degree[VOLUMES];
  PetscReal of_degree[VOLUMES];
} Measured;

static const Measured in_shear[WANTED] = {{1e-1, 1e-2, 1.2e-2, {4, 6, 6, 8}, {2.2e-2, 2.6e-3, 1.8e-2, 8.6e-3}},
                                          {1e-2, 1e-3, 2.3e-3, {6, 6, 8, 10}, {2.1e-3, 2.6e-3, 3.9e-3, 4.3e-3}},
                                          {1e-3, 1e-4, 2.6e-4, {10, 8, 10, 16}, {2.6e-4, 4.9e-4, 3.3e-4, 1.5e-4}},
                                          {1e-4, 3e-5, 4.8e-5, {14, 12, 14, 0}, {3.4e-5, 2.6e-5, 4.6e-5, 0}}};
static const Measured in_tube[WANTED] = {{1e-1, 1e-2, 1.7e-2, {6, 6, 6, 6}, {2.2e-2, 1.4e-2, 3.2e-2, 4.4e-2}},
                                         {1e-2, 1e-3, 4.5e-3, {8, 10, 12, 20}, {4.3e-3, 1.9e-3, 1.5e-3, 1.0e-3}},
                                         {1e-3, 1e-4, 3.6e-4, {12, 14, 16, 0}, {3.5e-4, 4.5e-4, 3.8e-4, 0}},
                                         {1e-4, 3e-5, 0, {0}, {0}}};

static const Measured *MeasuredRow(Scene s) {
  const Measured *row = s->dim == DIM_AXIAL ? in_tube : in_shear, *last = row + WANTED - 1;
  while (row < last && row->wanted > s->scheme.wanted * (1 + 1e-9)) row++;
  return row;
}

/* Column of the reduced volume, VOLUMES below all of them. */
static int MeasuredVolume(Scene s) {
  int v = 0;
  while (v < VOLUMES && s->space.reduced_volume.v[0] < volumes[v]) v++;
  return v;
}

/* Rate of the flow, in a tube its mean velocity over R0, and of the membrane's relaxation, kappa/(nu R0^3) (1/time). */
static void SpaceRates(Scene s, PetscReal *flow, PetscReal *membrane) {
  const PetscReal R = s->space.radius.v[0];
  *membrane = s->membrane.stiffness.v[0] / (s->fluid.nu * PetscPowRealInt(R, 3));
  *flow = PetscAbsReal(s->flow.chi != 0 ? s->flow.chi * *membrane : s->flow.rate);
  if (s->dim != DIM_AXIAL) return;
  *flow = 0.5 * PetscAbsReal(s->flow.ca != 0 ? s->flow.ca * *membrane : s->flow.peak / R);
}

/* Whether the flow is one of those that were measured. */
static PetscBool SpaceFlowMeasured(Scene s) {
  const PetscReal R = s->space.tube.radius / s->space.radius.v[0];
  if (s->dim != DIM_AXIAL) return (PetscBool)(s->flow.type == FLOW_SHEAR && s->space.spheroid != SPHEROID_CAPSULE);
  return (PetscBool)(s->flow.type == FLOW_TUBE && R >= 1.1 && R <= 2 && s->space.tube.throat == 0 &&
                     s->space.spheroid == SPHEROID_PROLATE);
}

PetscBool SceneSpaceMeasured(Scene s) {
  const int v = MeasuredVolume(s);
  PetscReal flow, membrane;
  SpaceRates(s, &flow, &membrane);
  return v < VOLUMES && MeasuredRow(s)->degree[v] && s->vesicles.count == 1 && SpaceFlowMeasured(s) &&
         flow >= membrane * (1 - 1e-9) && flow <= (s->dim == DIM_AXIAL ? 10 : 100) * membrane * (1 + 1e-9) &&
         !SceneHasContrast(s) && !SceneHasGravity(s) && !*s->vesicles.file && !SceneGiven(s, "-vesicle_half_axes");
}

PetscErrorCode SceneSuggestDegree(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const Measured *row = MeasuredRow(s);
  const int v = MeasuredVolume(s);
  (void)snprintf(value, AUTO_TEXT, "%d", (int)row->degree[v]);
  (void)snprintf(why, AUTO_TEXT, "leaves up to %.1e of the %s from a reduced volume of %g on",
                 (double)row->of_degree[v], s->dim == DIM_AXIAL ? "pressure drop" : "angle", (double)volumes[v]);
  return PETSC_SUCCESS;
}

PetscErrorCode SceneSuggestSpaceStep(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  PetscReal flow, membrane;
  SpaceRates(s, &flow, &membrane);
  (void)snprintf(value, AUTO_TEXT, "%.6g", (double)(0.05 / PetscMax(flow, membrane)));
  (void)snprintf(why, AUTO_TEXT, "a twentieth of the fastest time of the scene");
  return PETSC_SUCCESS;
}

PetscErrorCode SceneSuggestSpaceTolerance(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  (void)snprintf(value, AUTO_TEXT, "%g", (double)MeasuredRow(s)->tolerance);
  if (s->time.adapt == ADAPT_ERROR)
    (void)snprintf(why, AUTO_TEXT, "steps leave up to %.1e", (double)MeasuredRow(s)->of_steps);
  return PETSC_SUCCESS;
}

PetscErrorCode SceneSuggestSpaceMost(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  PetscReal flow, membrane;
  SpaceRates(s, &flow, &membrane);
  (void)snprintf(value, AUTO_TEXT, "%.6g", (double)((s->dim == DIM_AXIAL ? 0.5 : 1) / flow));
  (void)snprintf(why, AUTO_TEXT, "what was calibrated");
  return PETSC_SUCCESS;
}
