#include "output/record.h"
#include "bodies/freebodies.h"
#include "scheme/pressuredrop.h"
#include "scheme/films.h"

#define RECORD_NAME(id, name, kind) name,
const char *const SeriesColumns[COLUMN_COUNT] = {RECORD_COLUMNS(RECORD_NAME)};

typedef enum { RUN, PAIRS, TOTAL, WORST, MEAN, FIRST, LEAST } RecordKind;
#define RECORD_KIND(id, name, kind) kind,
static const RecordKind RecordKinds[COLUMN_COUNT] = {RECORD_COLUMNS(RECORD_KIND)};

PetscBool RecordIsOwn(int column) {
  return RecordKinds[column] >= TOTAL;
}

/* Room for an entry of a line: 24 characters a number and the comma; the longest name and a vesicle's number. */
#define RECORD_ENTRY 32

#define OBSTACLE_TOTALS 4 /* columns of all obstacles together */

/* Number of columns of one obstacle. */
static PetscInt ObstacleEach(const SceneObstacles *o) {
  return o->free.count ? 9 : o->moving ? 6 : 3;
}

/* Number of columns of all obstacles; 0 without obstacles. */
static PetscInt ObstacleRowCount(const SceneObstacles *o) {
  const PetscInt obstacles = o->outline.vesicles;
  if (!obstacles) return 0;
  return OBSTACLE_TOTALS + (obstacles <= RECORD_FEW ? ObstacleEach(o) * obstacles : 0);
}

static void ObstacleRowName(const SceneObstacles *o, PetscInt k, char name[RECORD_ENTRY]) {
  static const char *const totals[] = {"pressure_drop", "flux", "obstacle_force_x", "obstacle_force_y"};
  static const char *const names[] = {"force_x", "force_y",    "torque",     "center_x", "center_y",
                                      "angle",   "velocity_x", "velocity_y", "rotation"};
  if (k < OBSTACLE_TOTALS)
    (void)snprintf(name, RECORD_ENTRY, "%s", totals[k]);
  else
    (void)snprintf(name, RECORD_ENTRY, "obstacle_%s_%d", names[(k - OBSTACLE_TOTALS) % ObstacleEach(o)],
                   (int)((k - OBSTACLE_TOTALS) / ObstacleEach(o) + 1));
}

/* to += scale (force and torque, about c, of a load at a place). The nearest images count. */
static void ObstacleAddLoad(Grid g, PetscReal scale, const ObstacleLoad *from, const PetscReal place[2],
                            const PetscReal c[2], ObstacleLoad *to) {
  PetscReal d[2];
  for (int k = 0; k < 2; k++) {
    const PetscReal period = g->hi[k] - g->lo[k];
    d[k] = place[k] - c[k];
    if (!g->wall[k]) d[k] -= period * PetscFloorReal(d[k] / period + 0.5);
  }
  ObstacleLoadAdd(to, scale, from, d);
}

/* The forces of gravity and contact on each vesicle, whose sum over a vesicle need not be zero, and its torque about
   the centroid: load[vesicles], and the centroids place[2 vesicles]. */
static PetscErrorCode VesicleLoads(Scheme s, ObstacleLoad load[], PetscReal place[]) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscScalar *X;
  PetscScalar *F;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * l->n, &F));
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(ForcesLaw(s->coupling->forces, FORCE_BETWEEN, FORCE_OUTSIDE, StateInstant(&s->state), X, F));
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v);
    Measures measures;
    MembraneMeasure(m, v, X + 2 * at, &measures);
    for (int c = 0; c < 2; c++) place[2 * v + c] = measures.center[c];
    for (PetscInt k = 2 * at; k < 2 * (at + LayoutCount(l, v)); k += 2)
      ObstacleLoadAdd(&load[v], 1, &(ObstacleLoad){{F[k], F[k + 1]}, 0},
                      (PetscReal[]){X[k] - measures.center[0], X[k + 1] - measures.center[1]});
  }
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCall(PetscFree(F));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, (PetscMPIInt)(3 * l->bodies), MPIU_REAL, MPI_SUM, l->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, place, (PetscMPIInt)(2 * l->bodies), MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The load on a container is that of the fluid inside, where load[] is that of the fluid on both sides. Without inertia
   the momentum of the fluid inside balances:
     load on the container = sum of the loads on vesicles inside - sum of the loads on posts inside.
   With inertia the load on a container that moves is not known. */
static PetscErrorCode ContainerLoads(Scheme s, ObstacleLoad load[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const SceneObstacles *own = &s->scene->obstacles;
  const PetscInt vesicles = s->membrane->layout->bodies, curves = o->layout->bodies;
  ObstacleLoad *inner;
  PetscReal *place;
  PetscFunctionBeginUser;
  if (!s->state.solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(vesicles + curves, &inner, 2 * (vesicles + curves), &place));
  PetscCall(VesicleLoads(s, inner, place));
  for (PetscInt b = 0; b < curves; b++) {
    const BodyPose pose = MotionPose(&o->motion[b], StateInstant(&s->state));
    for (int c = 0; c < 2; c++) place[2 * (vesicles + b) + c] = pose.center[c];
    inner[vesicles + b] = load[b];
  }
  for (PetscInt b = 0; b < curves; b++) {
    const BodyMotion *m = &o->motion[b];
    const PetscBool moves = m->velocity[0] != 0 || m->velocity[1] != 0 || m->rotation != 0;
    if (!o->container[b] || (!s->fluid->steady && !moves)) continue;
    load[b] = s->fluid->steady ? (ObstacleLoad){{0, 0}, 0} : (ObstacleLoad){{NAN, NAN}, NAN};
    for (PetscInt k = 0; k < vesicles + curves; k++)
      if (own->holder[k] == b)
        ObstacleAddLoad(s->fluid->grid, k < vesicles ? 1 : -1, &inner[k], place + 2 * k, place + 2 * (vesicles + b),
                        &load[b]);
  }
  PetscCall(PetscFree2(inner, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ObstacleRowTake(Scheme s, PetscReal values[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscScalar *F;
  ObstacleLoad *load;
  PetscReal *q;
  Drive drive;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt curves = o->layout->bodies, count = ObstacleRowCount(&s->scene->obstacles);
  PetscCall(PetscMalloc2(curves, &load, 3 * o->free->M, &q));
  PetscCall(FreeBodiesRates(o, s->state.solid, q));
  PetscCall(VecGetArrayRead(s->state.solid, &F));
  PetscCall(ObstaclesLoads(o, StateInstant(&s->state), F, load));
  PetscCall(VecRestoreArrayRead(s->state.solid, &F));
  PetscCall(ContainerLoads(s, load));
  PetscCall(PetscArrayzero(values, count));
  PetscCall(DriveMeasure(s, &drive));
  values[0] = drive.pressure_drop;
  values[1] = drive.flux;
  for (PetscInt b = 0; b < curves; b++) {
    const BodyPose pose = MotionPose(&o->motion[b], StateInstant(&s->state));
    const PetscInt free = 3 * (o->motion[b].free - 1);
    const PetscReal own[] = {load[b].force[0],
                             load[b].force[1],
                             load[b].torque,
                             pose.center[0], /* from here on where obstacles move */
                             pose.center[1],
                             pose.angle,
                             free < 0 ? NAN : q[free], /* from here on where one moves freely */
                             free < 0 ? NAN : q[free + 1],
                             free < 0 ? NAN : q[free + 2]};
    const PetscInt each = ObstacleEach(&s->scene->obstacles);
    for (int c = 0; c < 2; c++) values[2 + c] += own[c];
    if (count > OBSTACLE_TOTALS) PetscCall(PetscArraycpy(values + OBSTACLE_TOTALS + each * b, own, each));
  }
  PetscCall(PetscFree2(load, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether series.csv has a column of its own of each vesicle: not of one vesicle, nor of many. */
static PetscBool RecordRepeats(const Record *r, int column) {
  return r->vesicles > 1 && r->vesicles <= RECORD_FEW && RecordIsOwn(column);
}

static void RecordAddName(Record *r, size_t *used, const char name[]) {
  *used += (size_t)snprintf(r->header + *used, r->room - *used, "%s%s", *used ? "," : "", name);
}

static void RecordWriteHeader(Record *r, const SceneObstacles *obstacles) {
  char name[RECORD_ENTRY];
  size_t used = 0;
  for (int c = 0; c < COLUMN_COUNT; c++) RecordAddName(r, &used, SeriesColumns[c]);
  for (PetscInt v = 1; v <= r->vesicles; v++)
    for (int c = 0; c < COLUMN_COUNT; c++) {
      (void)snprintf(name, RECORD_ENTRY, "%s_%d", SeriesColumns[c], (int)v);
      if (RecordRepeats(r, c)) RecordAddName(r, &used, name);
    }
  for (PetscInt k = 0; k < r->solids; k++) {
    ObstacleRowName(obstacles, k, name);
    RecordAddName(r, &used, name);
  }
  for (PetscInt k = 0; k < r->forces->n; k++)
    if (r->column[k] == RECORD_LAST) {
      (void)snprintf(name, RECORD_ENTRY, "energy_%s", r->forces->force[k].name);
      RecordAddName(r, &used, name);
    }
}

PetscErrorCode RecordCreate(PetscInt vesicles, const SceneObstacles *obstacles, Forces forces, Record *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(r, sizeof(*r)));
  r->vesicles = vesicles;
  r->forces = forces;
  r->solids = ObstacleRowCount(obstacles);
  r->room = (size_t)(COLUMN_COUNT * (1 + PetscMin(vesicles, RECORD_FEW)) + r->solids + FORCES_MOST) * RECORD_ENTRY;
  PetscCall(PetscCalloc5(vesicles * COLUMN_COUNT, &r->each, r->solids, &r->solid, vesicles, &r->work, (PetscInt)r->room,
                         &r->header, (PetscInt)r->room, &r->text));
  for (PetscInt k = 0; k < forces->n; k++) { /* where its energy goes, by the name energy_NAME */
    char name[RECORD_ENTRY];
    int c = COLUMN_COUNT - 1;
    (void)snprintf(name, RECORD_ENTRY, "energy_%s", forces->force[k].name);
    while (c >= 0 && strcmp(SeriesColumns[c], name)) c--;
    r->column[k] = !forces->force[k].energy ? RECORD_NOWHERE : c < 0 ? RECORD_LAST : c;
    r->others += r->column[k] == RECORD_LAST;
  }
  RecordWriteHeader(r, obstacles);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecordDestroy(Record *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(r->each, r->solid, r->work, r->header, r->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The own columns of one vesicle. */
static void RecordVesicle(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[], PetscReal row[]) {
  Measures measures;
  MembraneMeasure(m, v, X, &measures);
  row[COLUMN_AREA] = measures.area;
  row[COLUMN_LENGTH] = measures.length;
  row[COLUMN_AREA_ERROR] = measures.area / m->A0[v] - 1;
  row[COLUMN_LENGTH_ERROR] = measures.length / m->L0[v] - 1;
  row[COLUMN_EDGE_RATIO] = measures.edge_ratio;
  row[COLUMN_CENTER_X] = measures.center[0];
  row[COLUMN_CENTER_Y] = measures.center[1];
  row[COLUMN_INCLINATION] = measures.inclination;
  row[COLUMN_FREQUENCY] = MembraneFrequency(m, v, X, U);
  row[COLUMN_NORMAL_SPEED] = MembraneNormalSpeed(m, v, X, U);
  MembraneCentroidVelocity(m, v, X, U, &row[COLUMN_VELOCITY_X]);
}

/* The energies of the forces: in the columns of the own vesicles, or as sums over all vesicles. */
static PetscErrorCode RecordEnergies(Record *r, Scheme s, const PetscScalar X[]) {
  const Layout l = s->membrane->layout;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < r->forces->n; k++) {
    const Force *force = &r->forces->force[k];
    const int column = r->column[k];
    r->energy[k] = 0;
    if (column == RECORD_NOWHERE) continue;
    PetscCall(PetscArrayzero(r->work, l->bodies));
    PetscCall(force->energy(force->context, StateInstant(&s->state), X, r->work));
    for (PetscInt v = l->own; v < l->end; v++)
      *(column < 0 ? &r->energy[k] : &r->each[v * COLUMN_COUNT + column]) += r->work[v];
  }
  if (r->others)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->energy, (PetscMPIInt)r->forces->n, MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecordMeasure(Record *r, Scheme s) {
  const Layout l = s->membrane->layout;
  const PetscScalar *X, *U;
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(r->vesicles * COLUMN_COUNT, &size));
  PetscCall(PetscArrayzero(r->each, size));
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(VecGetArrayRead(s->state.U, &U));
  for (PetscInt v = l->own; v < l->end; v++)
    RecordVesicle(s->membrane, v, X + 2 * LayoutOffset(l, v), U + 2 * LayoutOffset(l, v), r->each + v * COLUMN_COUNT);
  PetscCall(RecordEnergies(r, s, X));
  PetscCall(VecRestoreArrayRead(s->state.U, &U));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->each, size, MPIU_REAL, MPI_SUM, l->comm));
  PetscCall(FilmsGaps(s, &r->last[COLUMN_GAP], r->work));
  for (PetscInt v = 0; v < r->vesicles; v++) r->each[v * COLUMN_COUNT + COLUMN_GAP] = r->work[v];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The columns of all vesicles from those of each. RecordMeasure finds the least gap. */
static void RecordCombine(Record *r) {
  for (PetscInt v = 0; v < r->vesicles; v++)
    for (int c = 0; c < COLUMN_COUNT; c++) {
      const RecordKind kind = RecordKinds[c];
      const PetscReal one = r->each[v * COLUMN_COUNT + c];
      PetscReal *all = &r->last[c];
      if (kind == TOTAL || kind == PAIRS) *all += one;
      if (kind == MEAN) *all += one / r->vesicles;
      if (kind == WORST && PetscAbsReal(one) > PetscAbsReal(*all)) *all = one;
      if (kind == FIRST && !v) *all = one;
    }
  if (!r->vesicles) r->last[COLUMN_FREQUENCY] = NAN;
}

/* The columns that vesicles do not have, and the totals of the run. */
static PetscErrorCode RecordStep(Record *r, Scheme s) {
  const StepReport *report = &s->report;
  PetscReal *row = r->last;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(row, COLUMN_COUNT));
  row[COLUMN_STEP] = s->state.step;
  row[COLUMN_TIME] = s->state.t;
  row[COLUMN_DT] = s->state.dt;
  PetscCall(SchemeKineticEnergy(s, &row[COLUMN_KINETIC]));
  row[COLUMN_DIV] = report->div_max;
  row[COLUMN_SURFACE_DIV] = report->surface_div_max;
  row[COLUMN_TENSION_ITS] = report->tension_its;
  row[COLUMN_BENDING_ITS] = report->bending_its;
  row[COLUMN_COUPLED_ITS] = report->coupled_its;
  row[COLUMN_NSOLVE] = report->solves;
  row[COLUMN_WALL] = report->seconds;
  row[COLUMN_AREA_SHIFT] = report->area_shift;
  for (int k = 0; k < 2; k++) {
    row[COLUMN_VISCOSITY_WALL + k] = report->stress.known ? report->stress.viscosity[k] : NAN;
    row[COLUMN_NORMAL_WALL + k] = report->stress.known ? report->stress.normal[k] : NAN;
  }
  r->solves += report->solves;
  r->tension += report->tension_its;
  r->bending += report->bending_its;
  r->coupled += report->coupled_its;
  r->cfl_max = PetscMax(r->cfl_max, report->cfl);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add a number to the text. NaN is an empty entry. */
static void RecordAddNumber(Record *r, size_t *used, PetscReal x) {
  *used += (size_t)snprintf(r->text + *used, r->room - *used, "%s", *used ? "," : "");
  if (!PetscIsNanReal(x)) *used += (size_t)snprintf(r->text + *used, r->room - *used, "%.17g", (double)x);
}

PetscErrorCode RecordTake(Record *r, Scheme s) {
  size_t used = 0;
  PetscFunctionBeginUser;
  PetscCall(RecordStep(r, s));
  PetscCall(RecordMeasure(r, s));
  RecordCombine(r);
  for (int c = 0; c < COLUMN_COUNT; c++) RecordAddNumber(r, &used, r->last[c]);
  for (PetscInt v = 0; v < r->vesicles; v++)
    for (int c = 0; c < COLUMN_COUNT; c++)
      if (RecordRepeats(r, c)) RecordAddNumber(r, &used, r->each[v * COLUMN_COUNT + c]);
  PetscCall(ObstacleRowTake(s, r->solid));
  for (PetscInt k = 0; k < r->solids; k++) RecordAddNumber(r, &used, r->solid[k]);
  for (PetscInt k = 0; k < r->forces->n; k++)
    if (r->column[k] == RECORD_LAST) RecordAddNumber(r, &used, r->energy[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool RecordFits(const Record *r, PetscInt step, PetscReal t) {
  PetscInt more = 0;
  for (const char *c = r->header; *c; c++) more += *c == ',';
  for (const char *c = r->text; *c; c++) more -= *c == ',';
  return !more && !r->text[strspn(r->text, "0123456789+-.einf,")] && r->last[COLUMN_STEP] == step &&
         r->last[COLUMN_TIME] == t;
}

void RecordParse(Record *r, const char text[]) {
  const char *p = r->text;
  (void)PetscStrncpy(r->text, text, r->room);
  for (int c = 0; c < COLUMN_COUNT && p; c++) {
    char *end;
    const double x = strtod(p, &end);
    r->last[c] = end > p ? x : NAN; /* an empty entry, which the last may be */
    p = strchr(p, ',') ? strchr(p, ',') + 1 : NULL;
  }
}
