/* Checkpoints of runs in the plane. The ranks send rank 0 their rows of the grid and gather the markers. */
#include "base/agree.h"
#include "plane/gathered.h"
#include "plane/plane.h"
#include "scheme/bdf.h"
#include "scheme/fields.h"
#include <stdlib.h>

/* Write or read `each` numbers in every row of a field. */
static PetscErrorCode CheckpointRows(H5File *file, PetscBool write, const char name[], Grid g, Field field,
                                     PetscInt each, PetscScalar values[]) {
  PetscScalar *all;
  Layout rows;
  PetscFunctionBeginUser;
  PetscCall(RowsLayout(g, field, each, &rows));
  PetscCall(PetscCalloc1(g->rank ? 0 : rows->M, &all)); /* zero where nothing can be read */
  if (write) PetscCall(LayoutToRank(rows, 0, 1, values, all));
  H5BeginEntry(file, write, name, 2, (PetscInt[]){rows->bodies, each});
  H5Transfer(file, write, name, 0, rows->M, all);
  if (!write) PetscCall(LayoutFromRank(rows, 0, 1, all, values));
  PetscCall(PetscFree(all));
  PetscCall(LayoutDestroy(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read what a state has of the fluid: steps need neither the pressure nor, most of them, the velocity of older
   states. */
static PetscErrorCode CheckpointFluid(H5File *file, PetscBool write, Grid g, const char group[], const State *q) {
  const struct {
    const char *name;
    Vec vector;
    Field field;
    PetscInt each, first; /* numbers in a row; where the field begins in the local array */
  } all[] = {{"u", q->w, FIELD_U, g->columns[FIELD_U], 0},
             {"v", q->w, FIELD_V, g->columns[FIELD_V], GridLocalU(g)},
             {"p", q->p, FIELD_P, g->columns[FIELD_P], 0},
             {"flow", q->flow, FIELD_U, StateFlowWidth(q, g), 0}};
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) {
    PetscScalar *a;
    char name[64];
    if (!all[k].vector) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%s", group, all[k].name));
    PetscCall(VecGetArray(all[k].vector, &a));
    PetscCall(CheckpointRows(file, write, name, g, all[k].field, all[k].each, a + all[k].first));
    PetscCall(VecRestoreArray(all[k].vector, &a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read the vectors of one state: 0 the present one, then those before it. */
static PetscErrorCode CheckpointVectors(H5File *file, PetscBool write, Scheme s, PetscInt j) {
  State *const q = j ? &s->old[j - 1] : &s->state;
  static const char *const groups[] = {"", "/previous", "/previous_1", "/previous_2", "/previous_3", "/previous_4"};
  PetscFunctionBeginUser;
  PetscCall(CheckpointFluid(file, write, s->fluid->grid, groups[j], q));
  for (int k = 0; k < STATE_PARTS; k++) {
    const StatePart part = StatePartOf(s, q, (StatePartName)k);
    PetscReal *values;
    char name[64];
    if (!part.n) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", groups[j], part.name));
    PetscCall(PetscCalloc1(part.n * part.each, &values));
    if (write) PetscCall(StateGather(&part, values));
    PetscCall(CheckpointEntry(file, write, name, part.n, part.each, values));
    if (!write) PetscCall(StateScatter(&part, values));
    PetscCall(PetscFree(values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckpointTracers(H5File *file, PetscBool write, Plane p) {
  Tracers *t = &p->tracers;
  PetscFunctionBeginUser;
  PetscCall(CheckpointEntry(file, write, "/tracers/points", t->n, 2, t->X));
  PetscCall(CheckpointEntry(file, write, "/tracers/velocity", t->n, 2, t->U));
  CheckpointFinite(file, 2 * t->n, t->X);
  CheckpointFinite(file, 2 * t->n, t->U);
  t->t = p->scheme->state.t;
  t->moving = p->scheme->state.step > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read the numbers of the run. */
static PetscErrorCode CheckpointNumbers(H5File *file, PetscBool write, SchemeTimes *times, PetscInt totals[],
                                        PetscInt *frames) {
  const CheckpointNumber all[] = {{"step", 0, 1e9, &times->step},
                                  {"past", 0, SCHEME_PAST, &times->past},
                                  {"step_level", -1000, 1000, &times->plan.level},
                                  {"frames", 0, 1e9, frames},
                                  {"time", 0, 1e300, NULL, &times->t},
                                  {"dt", 0, 1e300, NULL, &times->dt},
                                  {"dt_last", 0, 1e300, NULL, &times->dt_last},
                                  {"step_order", 1, BDF_MOST, &times->plan.order},
                                  {"step_guess", 1, BDF_STATES, &times->plan.guess},
                                  {"totals", 0, 0, totals, NULL, TOTAL_COUNT},
                                  {"dt_earlier", 0, 0, NULL, times->dt_earlier, SCHEME_PAST}};
  PetscFunctionBeginUser;
  PetscCall(CheckpointMoveNumbers(file, write, sizeof(all) / sizeof(all[0]), all));
  PetvesCheck(write || (*frames <= times->step + 1 && (times->step == 0 || times->dt_last > 0)), file->comm,
              "-restart %s: it has %g frames and a last step of %g at step %g; allowed: a checkpoint.h5 of petves",
              file->path, (double)*frames, (double)times->dt_last, (double)times->step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write the vesicles. */
static PetscErrorCode CheckpointPutVesicles(Scheme s, H5File *file) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  if (!l->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  H5Put(file, "vesicles", H5_INT, 1, &l->bodies);
  H5Put(file, "vesicle_start", H5_INT, l->bodies + 1, l->start);
  H5Put(file, "vesicle_ds", H5_REAL, l->bodies, m->ds);
  H5Put(file, "vesicle_area", H5_REAL, l->bodies, m->A0);
  H5Put(file, "vesicle_length", H5_REAL, l->bodies, m->L0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuse vectors with values that a run cannot have had. */
static PetscErrorCode RestartVectors(Scheme s, const State *q) {
  const struct {
    const char *name;
    Vec vector;
    PetscReal most;
  } all[] = {{"velocity", q->w, PETSC_MAX_REAL},
             {"flow", q->flow, PETSC_MAX_REAL},
             {"pressure", q->p, PETSC_MAX_REAL},
             {"markers", q->X, 1e9 * s->fluid->grid->h},
             {"marker velocity", q->U, PETSC_MAX_REAL},
             {"tension", q->sigma, PETSC_MAX_REAL},
             {"force on obstacles", q->solid, PETSC_MAX_REAL},
             {"place of obstacles", q->place, 1e9 * s->fluid->grid->h}};
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) {
    PetscReal largest = 0;
    PetscBool finite = PETSC_TRUE;
    if (!all[k].vector) continue;
    PetscCall(AgreeFinite(all[k].vector, &finite));
    PetscCall(VecNorm(all[k].vector, NORM_INFINITY, &largest));
    PetvesCheck(finite && largest <= all[k].most, s->scene->comm,
                "-restart %s: its %s is up to %g; allowed: a checkpoint.h5 of petves", s->scene->output.restart,
                all[k].name, finite ? (double)largest : (double)NAN);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level of step-size control counts from -time_step, which may differ from that of the checkpoint. */
static PetscErrorCode RestartLevel(Scheme s, H5File *file, PetscInt *level) {
  char base[64];
  PetscFunctionBeginUser;
  PetscCall(H5GetString(file, "-time_step", sizeof(base), base));
  if (*base && strtod(base, NULL) > 0 && strtod(base, NULL) < 1e300)
    *level += (PetscInt)PetscFloorReal(2 * PetscLog2Real((PetscReal)strtod(base, NULL) / s->scene->time.dt) + 1e-9);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Take the times of the states. dt_earlier: the steps that led to the earlier ones; to each but the first state of a
   run there was one. */
static PetscErrorCode RestartTimes(Scheme s, H5File *file, SchemeTimes *times) {
  PetscFunctionBeginUser;
  PetscCall(RestartLevel(s, file, &times->plan.level));
  SchemeSetTimes(s, times);
  for (PetscInt j = 0; j < s->past; j++) {
    const PetscReal dt = times->dt_earlier[j];
    PetvesCheck(dt >= 0 && dt <= 1e300 && (j == s->past - 1 || dt > 0), s->scene->comm,
                "-restart %s: its dt_earlier is %g; allowed: a step above 0, as petves writes it",
                s->scene->output.restart, (double)dt);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SchemeTimes CheckpointTimes(Scheme s) {
  const State *q = &s->state;
  SchemeTimes times = {.step = q->step, .past = s->past, .t = q->t, .dt = q->dt, .dt_last = q->dt_last};
  times.plan = (StepPlan){
      .level = s->policy.adaptive ? s->plan.level : 0, .order = s->plan.order, .guess = s->plan.guess};
  for (PetscInt j = 0; j < s->past; j++) times.dt_earlier[j] = s->old[j].dt_last;
  return times;
}

/* Write or read everything; memory[]: what the solvers have kept from earlier steps. */
static PetscErrorCode CheckpointMoveAll(Plane p, H5File *file, PetscBool write, PetscInt *frames, PetscReal memory[]) {
  const Scheme s = p->scheme;
  const PetscInt numbers = SchemeMemorySize(s);
  SchemeTimes times = {.plan = {.order = 1, .guess = 1}}; /* allowed, where nothing can be read */
  PetscFunctionBeginUser;
  if (write) {
    PetscCall(SchemeFields(s));
    PetscCall(SchemeRemember(s, memory));
    PetscCall(CheckpointPutVesicles(s, file));
    times = CheckpointTimes(s);
  }
  PetscCall(CheckpointNumbers(file, write, &times, p->totals, frames));
  if (!write) {
    PetscCall(RestartEntries(s->scene, file));
    PetscCall(RestartTimes(s, file, &times));
  }
  for (PetscInt j = 0; j <= s->past; j++) {
    PetscCall(CheckpointVectors(file, write, s, j));
    if (!write) PetscCall(RestartVectors(s, j ? &s->old[j - 1] : &s->state));
  }
  PetscCall(CheckpointTracers(file, write, p));
  PetscCall(CheckpointEntry(file, write, "/solver", numbers, 1, memory));
  if (write) PetscFunctionReturn(PETSC_SUCCESS);
  CheckpointFinite(file, numbers, memory);
  PetscCall(RestartEntries(s->scene, file));
  PetscCall(SchemeRecall(s, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlaneCheckpoint(void *plane, H5File *file, PetscBool write, PetscInt *frames) {
  const Plane p = plane;
  PetscReal *memory;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(SchemeMemorySize(p->scheme), &memory));
  error = CheckpointMoveAll(p, file, write, frames, memory);
  PetscCall(PetscFree(memory));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}
