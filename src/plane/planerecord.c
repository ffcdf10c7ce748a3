/* What a step in the plane amounts to in numbers: the columns of series.csv. */
#include "plane/plane.h"
#include "scheme/films.h"
#include "scheme/pressuredrop.h"

static const RecordColumn PlaneColumnList[COLUMN_COUNT] = {PLANE_COLUMNS(RECORD_COLUMN)};

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

static void ObstacleRowName(const SceneObstacles *o, PetscInt k, char name[RECORD_NAME]) {
  static const char *const totals[] = {"pressure_drop", "flux", "obstacle_force_x", "obstacle_force_y"};
  static const char *const names[] = {"force_x", "force_y",    "torque",     "center_x", "center_y",
                                      "angle",   "velocity_x", "velocity_y", "rotation"};
  if (k < OBSTACLE_TOTALS)
    (void)snprintf(name, RECORD_NAME, "%s", totals[k]);
  else
    (void)snprintf(name, RECORD_NAME, "obstacle_%s_%d", names[(k - OBSTACLE_TOTALS) % ObstacleEach(o)],
                   (int)((k - OBSTACLE_TOTALS) / ObstacleEach(o) + 1));
}

/* to += scale (force and torque, about c, of a load at a place). The nearest images count. */
static void ObstacleAddLoad(Grid g, PetscReal scale, const PetscReal from[3], const PetscReal place[2],
                            const PetscReal c[2], PetscReal to[3]) {
  PetscReal d[2];
  for (int k = 0; k < 2; k++) {
    const PetscReal period = g->hi[k] - g->lo[k];
    d[k] = place[k] - c[k];
    if (!g->wall[k]) d[k] -= period * PetscFloorReal(d[k] / period + 0.5);
    to[k] += scale * from[k];
  }
  to[2] += scale * (from[2] + d[0] * from[1] - d[1] * from[0]);
}

/* The forces of gravity and contact on each vesicle, whose sum over a vesicle need not be zero, those of the step made
   last, and their torque about the centroid: load[3 vesicles], and the centroids place[2 vesicles]. */
static PetscErrorCode VesicleLoads(Scheme s, PetscReal load[], PetscReal place[]) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscScalar *X, *step;
  PetscScalar *F;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * l->n, &F));
  PetscCall(VecGetArrayRead(s->coupling->mobility->F, &step));
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(ForcesLaw(s->coupling->forces, FORCE_BETWEEN, FORCE_OUTSIDE, StateInstant(&s->state), X, F));
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v);
    Measures measures;
    MembraneMeasure(m, v, X + 2 * at, &measures);
    for (int c = 0; c < 2; c++) place[2 * v + c] = measures.center[c];
    MotionSum(measures.center, LayoutCount(l, v), X + 2 * at, F + 2 * at, load + 3 * v);
    for (int c = 0; c < 2; c++) load[3 * v + c] = 0;
    for (PetscInt k = 2 * at; k < 2 * (at + LayoutCount(l, v)); k++) load[3 * v + k % 2] -= step[k];
  }
  PetscCall(VecRestoreArrayRead(s->coupling->mobility->F, &step));
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
static PetscErrorCode ContainerLoads(Scheme s, PetscReal load[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const SceneObstacles *own = &s->scene->obstacles;
  const PetscInt vesicles = s->membrane->layout->bodies, curves = o->layout->bodies;
  PetscReal *inner, *place;
  PetscFunctionBeginUser;
  if (!s->state.solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(3 * (vesicles + curves), &inner, 2 * (vesicles + curves), &place));
  PetscCall(VesicleLoads(s, inner, place));
  PetscCall(PetscArraycpy(inner + 3 * vesicles, load, 3 * curves));
  for (PetscInt b = 0; b < curves; b++) {
    const BodyPose pose = MotionPose(&o->motion[b], StateInstant(&s->state));
    for (int c = 0; c < 2; c++) place[2 * (vesicles + b) + c] = pose.center[c];
  }
  for (PetscInt b = 0; b < curves; b++) {
    const BodyMotion *m = &o->motion[b];
    const PetscBool moves = m->velocity[0] != 0 || m->velocity[1] != 0 || m->rotation != 0;
    if (!o->container[b] || (!s->fluid->steady && !moves)) continue;
    for (int c = 0; c < 3; c++) load[3 * b + c] = s->fluid->steady ? 0 : NAN;
    for (PetscInt k = 0; k < vesicles + curves; k++)
      if (own->holder[k] == b)
        ObstacleAddLoad(s->fluid->grid, k < vesicles ? 1 : -1, inner + 3 * k, place + 2 * k, place + 2 * (vesicles + b),
                        load + 3 * b);
  }
  PetscCall(PetscFree2(inner, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The columns of obstacles, which are zero. */
static PetscErrorCode ObstaclesRow(Scheme s, PetscReal values[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscScalar *F;
  PetscReal *load, *q;
  Drive drive;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt curves = o->layout->bodies, count = ObstacleRowCount(&s->scene->obstacles);
  PetscCall(PetscMalloc2(3 * curves, &load, 3 * o->free->M, &q));
  PetscCall(VecGetArrayRead(s->state.solid, &F));
  PetscCall(LayoutGather(o->free, 3, F + 2 * o->layout->n, q));
  PetscCall(ObstaclesLoads(o, StateInstant(&s->state), F, load));
  PetscCall(VecRestoreArrayRead(s->state.solid, &F));
  PetscCall(ContainerLoads(s, load));
  PetscCall(DriveMeasure(s, &drive));
  values[0] = drive.pressure_drop;
  values[1] = drive.flux;
  for (PetscInt b = 0; b < curves; b++) {
    const BodyPose pose = MotionPose(&o->motion[b], StateInstant(&s->state));
    const PetscInt free = 3 * (o->motion[b].free - 1);
    const PetscReal own[] = {load[3 * b],
                             load[3 * b + 1],
                             load[3 * b + 2],
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

/* Where the energy of a force goes: a column of PLANE_COLUMNS; PLANE_EXTRA, a column of its own behind all others; or
   nowhere. */
enum { PLANE_EXTRA = -1, PLANE_NOWHERE = -2 };

static int EnergyColumn(const Force *force) {
  char name[RECORD_NAME];
  int c = COLUMN_COUNT - 1;
  if (!force->energy) return PLANE_NOWHERE;
  (void)snprintf(name, sizeof(name), "energy_%s", force->name);
  while (c >= 0 && strcmp(PlaneColumnList[c].name, name)) c--;
  return c < 0 ? PLANE_EXTRA : c;
}

PetscErrorCode PlaneColumns(Plane p, RecordSetting *columns) {
  const Forces forces = p->coupling->forces;
  PetscInt extras = ObstacleRowCount(&p->scene->obstacles);
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(extras + forces->n, &p->extra));
  PetscCall(PetscCalloc1(p->membrane->layout->bodies, &p->work));
  for (PetscInt k = 0; k < extras; k++) ObstacleRowName(&p->scene->obstacles, k, p->extra[k]);
  for (PetscInt k = 0; k < forces->n; k++)
    if (EnergyColumn(&forces->force[k]) == PLANE_EXTRA)
      (void)snprintf(p->extra[extras++], RECORD_NAME, "energy_%s", forces->force[k].name);
  *columns = (RecordSetting){.vesicles = p->membrane->layout->bodies,
                             .columns = COLUMN_COUNT,
                             .column = PlaneColumnList,
                             .extras = extras,
                             .extra = (const char(*)[RECORD_NAME])p->extra};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The own columns of one vesicle. */
static void PlaneMeasureVesicle(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[], PetscReal row[]) {
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

/* The energy of a force, of each own vesicle, into p->work. */
static PetscErrorCode ForceEnergy(Plane p, const Force *force, const PetscScalar X[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(p->work, p->membrane->layout->bodies));
  PetscCall(force->energy(force->context, StateInstant(&p->scheme->state), X, NULL, p->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlaneMeasure(void *plane, PetscReal each[], PetscReal last[]) {
  const Plane p = plane;
  const Scheme s = p->scheme;
  const Forces forces = p->coupling->forces;
  const Layout l = s->membrane->layout;
  const PetscScalar *X, *U;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(VecGetArrayRead(s->state.U, &U));
  for (PetscInt v = l->own; v < l->end; v++)
    PlaneMeasureVesicle(s->membrane, v, X + 2 * LayoutOffset(l, v), U + 2 * LayoutOffset(l, v),
                        each + v * COLUMN_COUNT);
  for (PetscInt k = 0; k < forces->n; k++) {
    const int column = EnergyColumn(&forces->force[k]);
    if (column < 0) continue;
    PetscCall(ForceEnergy(p, &forces->force[k], X));
    for (PetscInt v = l->own; v < l->end; v++) each[v * COLUMN_COUNT + column] += p->work[v];
  }
  PetscCall(VecRestoreArrayRead(s->state.U, &U));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCall(FilmsGaps(s, &last[COLUMN_GAP], p->work));
  for (PetscInt v = l->own; v < l->end; v++) each[v * COLUMN_COUNT + COLUMN_GAP] = p->work[v];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energies that have columns of their own, of all vesicles. */
static PetscErrorCode EnergiesRow(Plane p, PetscReal *next) {
  const Layout l = p->membrane->layout;
  const Forces forces = p->coupling->forces;
  const PetscScalar *X;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(p->scheme->state.X, &X));
  for (PetscInt k = 0; k < forces->n; k++) {
    if (EnergyColumn(&forces->force[k]) != PLANE_EXTRA) continue;
    PetscCall(ForceEnergy(p, &forces->force[k], X));
    for (PetscInt v = l->own; v < l->end; v++) *next += p->work[v];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, next++, 1, MPIU_REAL, MPI_SUM, l->comm));
  }
  PetscCall(VecRestoreArrayRead(p->scheme->state.X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlaneRow(void *plane, PetscReal row[]) {
  const Plane p = plane;
  const Scheme s = p->scheme;
  const StepReport *report = &s->report;
  PetscFunctionBeginUser;
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
  if (!s->membrane->layout->bodies) row[COLUMN_FREQUENCY] = NAN;
  PetscCall(ObstaclesRow(s, row + COLUMN_COUNT));
  PetscCall(EnergiesRow(p, row + COLUMN_COUNT + ObstacleRowCount(&p->scene->obstacles)));
  p->totals[TOTAL_SOLVES] += report->solves;
  p->totals[TOTAL_TENSION] += report->tension_its;
  p->totals[TOTAL_BENDING] += report->bending_its;
  p->totals[TOTAL_COUPLED] += report->coupled_its;
  p->cfl_max = PetscMax(p->cfl_max, report->cfl);
  PetscFunctionReturn(PETSC_SUCCESS);
}
