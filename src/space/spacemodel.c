#include "space/spacemodel.h"
#include "sphere/shape.h"
#include "space/fromscene.h"

#define ROUGH 0.01 /* spectrum_tail from which on a higher degree is due */
#define THIN 0.1   /* film over the spacing of latitudes below which a higher degree is due */

static const RecordColumn SpaceColumnList[SPACE_COUNT] = {SPACE_COLUMNS(RECORD_COLUMN)};

static PetscErrorCode SpaceModelStart(void *model) {
  PetscFunctionBeginUser;
  PetscCall(SpaceStart(((SpaceModel)model)->space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceModelStep(void *model, PetscReal until) {
  PetscFunctionBeginUser;
  PetscCall(SpaceStep(((SpaceModel)model)->space, until));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceModelView(void *model, PetscViewer viewer) {
  PetscFunctionBeginUser;
  PetscCall(KSPView(((SpaceModel)model)->space->ksp, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocity of the middle, rate of rotation about it in the x-y plane, largest normal speed, range of the tension. */
static PetscErrorCode SpaceMeasureMotion(Surface at, const ShapeMoments *m, const PetscReal U[],
                                         const PetscReal sigma[], PetscReal row[]) {
  const PetscInt n = at->n, count = at->sphere->count;
  PetscReal *u, *tension, turned = 0, inertia = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &u, n, &tension));
  PetscCall(SphereFieldValues(&at->sphere->fine, HARMONIC, U, u));
  PetscCall(SphereTableValues(&at->sphere->fine, HARMONIC, count, 1, sigma, tension));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal dA = at->sphere->fine.grid.weight[i] * at->J[i];
    PetscReal r[3], normal = 0;
    for (int d = 0; d < 3; d++) {
      r[d] = at->D[HARMONIC][d * n + i] - m->center[d];
      normal += u[d * n + i] * at->normal[d * n + i];
    }
    for (int d = 0; d < 3; d++) row[SPACE_VELOCITY_X + d] += dA * normal * r[d] / at->volume;
    turned += dA * (r[0] * u[n + i] - r[1] * u[i]);
    inertia += dA * (r[0] * r[0] + r[1] * r[1]);
    row[SPACE_NORMAL_SPEED] = PetscMax(row[SPACE_NORMAL_SPEED], PetscAbsReal(normal));
    row[SPACE_TENSION_MIN] = i ? PetscMin(row[SPACE_TENSION_MIN], tension[i]) : tension[i];
    row[SPACE_TENSION_MAX] = i ? PetscMax(row[SPACE_TENSION_MAX], tension[i]) : tension[i];
  }
  row[SPACE_ROTATION] = turned / inertia;
  if (at->sphere->symmetry == SPHERE_REVOLVED) row[SPACE_VELOCITY_Y] = row[SPACE_VELOCITY_Z] = row[SPACE_ROTATION] = 0;
  PetscCall(PetscFree2(u, tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The own columns of an own vesicle. */
static PetscErrorCode SpaceMeasureVesicle(Space s, PetscInt v, PetscReal row[]) {
  const Vesicle3 vesicle = s->vesicle[v];
  const Surface at = vesicle->about;
  const PetscReal *X = s->state.X + v * s->size;
  ShapeMoments m;
  PetscFunctionBeginUser;
  PetscCall(SurfacePlace(at, X, PETSC_FALSE));
  PetscCall(ShapeMeasure(at, &m));
  row[SPACE_BENDING] = vesicle->setting.bending * at->energy;
  row[SPACE_AREA] = at->area;
  row[SPACE_VOLUME] = at->volume;
  row[SPACE_AREA_ERROR] = at->area / vesicle->area - 1;
  row[SPACE_VOLUME_ERROR] = at->volume / vesicle->volume - 1;
  for (int d = 0; d < 3; d++) {
    row[SPACE_CENTER_X + d] = m.center[d];
    row[SPACE_AXIS_SHORT + d] = m.axis[d];
  }
  const PetscReal *axis = m.direction[2], side = axis[0] < 0 ? -1 : 1;
  row[SPACE_INCLINATION] = PetscAtan2Real(side * axis[1], side * axis[0]);
  row[SPACE_ELEVATION] = PetscAsinReal(PetscClipInterval(side * axis[2], -1, 1));
  row[SPACE_TAIL] = ShapeTail(s->sphere, X);
  PetscCall(SpaceMeasureMotion(at, &m, s->state.U + v * s->size, s->state.sigma + v * s->count, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceMeasure(void *model, PetscReal each[], PetscReal last[]) {
  const SpaceModel m = model;
  const Space s = m->space;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(SpaceMeasureVesicle(s, v, each + (s->share.first + v) * m->columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The film, the mean velocity in the tube, and the pressure drop by the membranes' forces, which are those of the last
   solve. */
static PetscErrorCode SpaceMeasureTube(SpaceModel m, PetscReal last[]) {
  const Space s = m->space;
  const PetscReal R = m->scene->space.tube.radius, P = m->scene->space.tube.period, nu = m->scene->fluid.nu;
  PetscFunctionBeginUser;
  PetscCall(SpaceMeasureFilm(s, s->state.X, &last[SPACE_FILM]));
  last[SPACE_FLOW] = s->tube.left * (s->setting.tube.mean + (P > 0 ? s->tube.thrust / (8 * PETSC_PI * nu * P) : 0));
  last[SPACE_PRESSURE] = -s->tube.thrust / (PETSC_PI * R * R);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceRow(void *model, PetscReal last[]) {
  const SpaceModel m = model;
  const Space s = m->space;
  PetscFunctionBeginUser;
  last[SPACE_STEP] = s->state.step;
  last[SPACE_TIME] = s->state.t;
  last[SPACE_DT] = s->report.dt;
  if (s->cross) PetscCall((m->scene->repulsion.stress > 0 ? CrossLayerPlace : CrossLayerMeasure)(s->cross, s->state.X));
  if (s->cross) PetscCall(CrossLayerEnergy(s->cross, &last[SPACE_CONTACT]));
  last[SPACE_GAP] = s->cross ? s->cross->gap : NAN;
  last[SPACE_ITS] = s->report.its;
  last[SPACE_WALL] = s->report.seconds;
  if (s->tube.tube) PetscCall(SpaceMeasureTube(m, last));
  m->its += s->report.its;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A warning, once: that harmonics do not resolve `what`, which `measure` says. */
static PetscErrorCode SpaceWarn(SpaceModel m, int which, const char what[], const char measure[], PetscReal value) {
  char *warning = m->warning[which];
  PetscFunctionBeginUser;
  if (*warning) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(warning, sizeof(m->warning[0]),
                          "the spherical harmonics do not resolve %s after step %" PetscInt_FMT
                          ", time %g: %s is %.2g; try -sphere_degree %" PetscInt_FMT,
                          what, m->space->state.step, (double)m->space->state.t, measure, (double)value,
                          m->space->sphere->p + 4));
  PetscCall(PetvesSay(m->scene->comm, "petves: warning: %s\n", warning));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceWatch(void *model, const PetscReal last[]) {
  const SpaceModel m = model;
  PetscFunctionBeginUser;
  if (last[SPACE_TAIL] >= ROUGH) PetscCall(SpaceWarn(m, 0, "a vesicle", "spectrum_tail", last[SPACE_TAIL]));
  if (m->space->tube.tube && last[SPACE_FILM] < THIN * m->space->tube.spacing)
    PetscCall(SpaceWarn(m, 1, "the film along the tube", "film", last[SPACE_FILM]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *SpaceWarning(const void *model, PetscInt i) {
  const SpaceModel m = (SpaceModel)model;
  for (int which = 0; which < 2; which++)
    if (*m->warning[which] && i-- == 0) return m->warning[which];
  return NULL;
}

/* Write or read the numbers of the run. */
static PetscErrorCode SpaceMoveNumbers(SpaceModel m, H5File *file, PetscBool write, PetscInt *frames) {
  const Space s = m->space;
  PetscInt solved = s->state.solved;
  PetscReal dt_last[BDF_MOST] = {s->state.dt_last}, age[AGE_MEMORY];
  PetscFunctionBeginUser;
  for (int j = 1; j < BDF_MOST; j++) dt_last[j] = s->old[j - 1].dt_last;
  AgeGetMemory(&s->age, age);
  const CheckpointNumber all[] = {{"step", 0, 1e9, &s->state.step},
                                  {"past", 0, BDF_MOST - 1, &s->past},
                                  {"step_order", 1, BDF_MOST, &s->order},
                                  {"step_level", -1000, 1000, &s->plan.level},
                                  {"solved", 0, 1, &solved},
                                  {"frames", 0, 1e9, frames},
                                  {"totals", 0, 0, &m->its},
                                  {"time", 0, 1e300, NULL, &s->state.t},
                                  {"factors_a0", 0, 1e300, NULL, &s->made.a0},
                                  {"dt_last", 0, 0, NULL, dt_last, BDF_MOST},
                                  {"factors_age", 0, 0, NULL, age, AGE_MEMORY}};
  PetscCall(CheckpointMoveNumbers(file, write, sizeof(all) / sizeof(all[0]), all));
  CheckpointFinite(file, BDF_MOST, dt_last);
  CheckpointFinite(file, AGE_MEMORY, age);
  s->state.solved = (PetscBool)solved;
  s->state.dt_last = dt_last[0];
  for (int j = 1; j < BDF_MOST; j++) s->old[j - 1].dt_last = dt_last[j];
  s->age = AgeSetMemory(age);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read the first `arrays` arrays of a state in a group, [vesicles][each] of all ranks. */
static PetscErrorCode SpaceMoveState(Space s, H5File *file, PetscBool write, const char group[], int arrays,
                                     const SpaceState *q) {
  const struct {
    const char *name;
    PetscInt each;
    PetscReal *own;
  } all[] = {{"shape", s->size, q->X}, {"tension", s->count, q->sigma}, {"velocity", s->size, q->U}};
  PetscFunctionBeginUser;
  for (int k = 0; k < arrays; k++) {
    const PetscInt each = all[k].each, n = s->share.vesicles * each;
    PetscReal *values;
    char name[32];
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/vesicle/%s", group, all[k].name));
    PetscCall(PetscCalloc1(n, &values));
    if (write) PetscCall(ShareGather(&s->share, each, all[k].own, values));
    PetscCall(CheckpointEntry(file, write, name, s->share.vesicles, each, values));
    CheckpointFinite(file, n, values);
    if (!write) PetscCall(PetscArraycpy(all[k].own, values + s->share.first * each, s->share.own * each));
    PetscCall(PetscFree(values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceCheckpoint(void *model, H5File *file, PetscBool write, PetscInt *frames) {
  static const char *const groups[BDF_MOST] = {"", "/previous", "/previous_1"};
  const SpaceModel m = model;
  const Space s = m->space;
  PetscFunctionBeginUser;
  PetscCall(SpaceMoveNumbers(m, file, write, frames));
  for (PetscInt j = 0; j <= s->past; j++)
    PetscCall(SpaceMoveState(s, file, write, groups[j], 3, j ? &s->old[j - 1] : &s->state));
  if (s->made.a0 > 0)
    PetscCall(SpaceMoveState(s, file, write, "/solver", 2, &(SpaceState){.X = s->made.X, .sigma = s->made.sigma}));
  if (write) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RestartEntries(m->scene, file));
  PetscCall(SpaceRecall(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void SpaceSummary(const void *model, FILE *f) {
  const SpaceModel m = (SpaceModel)model;
  fprintf(f, "  \"totals\": {\"steps\": %d, \"coupled_its\": %d},\n  \"dim\": 3,\n  \"degree\": %d,\n",
          (int)m->space->state.step, (int)m->its, (int)m->space->sphere->p);
  fprintf(f, "  \"vesicles\": %d,\n", (int)m->space->share.vesicles);
  if (m->space->tube.throat) fprintf(f, "  \"throat_pressure_drop\": %.17g,\n", (double)m->space->tube.drop);
}

static PetscErrorCode SpaceTable(const void *model, const PetscReal last[]) {
  const SpaceModel m = (SpaceModel)model;
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(m->scene->comm, "  iterations a step             coupled %.1f\n",
                      (double)m->its / (double)PetscMax(1, m->space->state.step)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceObject(void *model, const char name[], PetscObject *object) {
  const Space s = ((SpaceModel)model)->space;
  PetscFunctionBeginUser;
  *object = strcmp(name, "coupled_") ? NULL : (PetscObject)s->ksp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceModelDestroy(void *model) {
  SpaceModel m = model;
  PetscFunctionBeginUser;
  PetscCall(SpaceDestroy(&m->space));
  PetscCall(PetscFree2(m->Y, m->first));
  PetscCall(PetscFree(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const ModelOps SpaceOps = {.start = SpaceModelStart,
                                  .step = SpaceModelStep,
                                  .view = SpaceModelView,
                                  .destroy = SpaceModelDestroy,
                                  .row = SpaceRow,
                                  .measure = SpaceMeasure,
                                  .watch = SpaceWatch,
                                  .warning = SpaceWarning,
                                  .series = SpaceSeries,
                                  .describe = SpaceDescribe,
                                  .frame = SpaceFrame,
                                  .print = SpacePrint,
                                  .checkpoint = SpaceCheckpoint,
                                  .summary = SpaceSummary,
                                  .table = SpaceTable,
                                  .gather = SpaceGather,
                                  .object = SpaceObject};

PetscErrorCode SpaceModelCreate(Scene scene, Model *model) {
  SpaceModel m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *model = (Model){.ops = SpaceOps, .context = m};
  m->scene = scene;
  PetscCall(SpaceFromScene(scene, &m->space));
  m->columns = m->space->tube.tube ? SPACE_COUNT : SPACE_WITHOUT_TUBE;
  PetscCall(SpaceFramesPoints(m));
  const Space s = m->space;
  *model = (Model){.ops = SpaceOps,
                   .context = m,
                   .scene = scene,
                   .step = &s->state.step,
                   .t = &s->state.t,
                   .dt = &s->setting.policy.base,
                   .failure = s->report.failure,
                   .policy = &s->setting.policy,
                   .columns = {.vesicles = s->share.vesicles, .columns = m->columns, .column = SpaceColumnList},
                   .dim = 3,
                   .first = m->first};
  PetscFunctionReturn(PETSC_SUCCESS);
}
