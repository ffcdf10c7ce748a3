#include "output/record.h"
#include "output/obstaclerow.h"
#include "scheme/films.h"

const char *const SeriesColumns[] = {"step",
                                     "time",
                                     "dt",
                                     "energy_kinetic",
                                     "energy_bending",
                                     "area",
                                     "length",
                                     "area_error",
                                     "length_error",
                                     "edge_ratio",
                                     "div_max",
                                     "surface_div_max",
                                     "center_x",
                                     "center_y",
                                     "inclination",
                                     "frequency",
                                     "tension_its",
                                     "bending_its",
                                     "coupled_its",
                                     "nsolve",
                                     "wall",
                                     "area_shift",
                                     "normal_speed",
                                     "velocity_x",
                                     "velocity_y",
                                     "energy_gravity",
                                     "gap",
                                     "energy_contact",
                                     "viscosity_wall",
                                     "viscosity",
                                     "normal_stress_wall",
                                     "normal_stress",
                                     NULL};

const int RecordVesicleColumns[] = {COLUMN_BENDING,      COLUMN_AREA,       COLUMN_LENGTH,       COLUMN_AREA_ERROR,
                                    COLUMN_LENGTH_ERROR, COLUMN_EDGE_RATIO, COLUMN_CENTER_X,     COLUMN_CENTER_Y,
                                    COLUMN_INCLINATION,  COLUMN_FREQUENCY,  COLUMN_NORMAL_SPEED, COLUMN_VELOCITY_X,
                                    COLUMN_VELOCITY_Y,   COLUMN_GRAVITY,    COLUMN_GAP,          -1};

/* The columns that repeat with a suffix in series.csv: of several vesicles, but not of many. */
static int Repeated(const Record *r) {
  int n = 0;
  while (RecordVesicleColumns[n] >= 0) n++;
  return r->vesicles > 1 && r->vesicles <= RECORD_FEW ? n : 0;
}

/* Room for an entry of a line: 24 characters a number and the comma; the longest name and a vesicle's number. */
#define ENTRY 32

static PetscErrorCode WriteHeader(Record *r, const SceneObstacles *obstacles) {
  size_t used = 0;
  PetscFunctionBeginUser;
  for (int c = 0; c < COLUMN_COUNT; c++)
    used += (size_t)snprintf(r->header + used, r->room - used, "%s%s", c ? "," : "", SeriesColumns[c]);
  for (PetscInt v = 1; v <= r->vesicles; v++)
    for (int c = 0; c < Repeated(r); c++)
      used += (size_t)snprintf(r->header + used, r->room - used, ",%s_%d", SeriesColumns[RecordVesicleColumns[c]],
                               (int)v);
  for (PetscInt k = 0; k < r->solids; k++) {
    char name[OBSTACLE_ROW_NAME];
    ObstacleRowName(obstacles, k, name);
    used += (size_t)snprintf(r->header + used, r->room - used, ",%s", name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecordCreate(PetscInt vesicles, const SceneObstacles *obstacles, Record *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(r, sizeof(*r)));
  r->vesicles = vesicles;
  r->solids = ObstacleRowCount(obstacles);
  r->room = (size_t)(COLUMN_COUNT + vesicles * Repeated(r) + r->solids) * ENTRY;
  PetscCall(PetscCalloc4(vesicles * COLUMN_COUNT, &r->each, r->solids, &r->solid, (PetscInt)r->room, &r->header,
                         (PetscInt)r->room, &r->text));
  PetscCall(WriteHeader(r, obstacles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecordDestroy(Record *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(r->each, r->solid, r->header, r->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vesicle columns of one vesicle. */
static void VesicleRow(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[], PetscReal row[]) {
  Measures measures;
  MembraneMeasure(m, v, X, &measures);
  row[COLUMN_BENDING] = MembraneBendingEnergy(m, v, X);
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
  row[COLUMN_GRAVITY] = MembraneGravityEnergy(m, v, X);
}

static PetscErrorCode MeasureGaps(Record *r, Scheme s) {
  PetscReal *each;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(r->vesicles, &each));
  PetscCall(FilmsGaps(s, &r->last[COLUMN_GAP], each));
  for (PetscInt v = 0; v < r->vesicles; v++) r->each[v * COLUMN_COUNT + COLUMN_GAP] = each[v];
  PetscCall(PetscFree(each));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each owner measures its vesicles, all ranks get all rows. */
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
    VesicleRow(s->membrane, v, X + 2 * LayoutOffset(l, v), U + 2 * LayoutOffset(l, v), r->each + v * COLUMN_COUNT);
  PetscCall(VecRestoreArrayRead(s->state.U, &U));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->each, size, MPIU_REAL, MPI_SUM, l->comm));
  PetscCall(MeasureGaps(r, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Totals (energy, area, length), worst values (errors, edge ratio, normal speed) or means (centre) of several vesicles.
   The inclination and the frequency of the first stand for all: neither a total nor a worst value of angles means
   anything. */
static void Combine(PetscInt vesicles, const PetscReal one[], PetscReal all[]) {
  const int total[] = {COLUMN_BENDING, COLUMN_AREA, COLUMN_LENGTH, COLUMN_GRAVITY};
  const int worst[] = {COLUMN_AREA_ERROR, COLUMN_LENGTH_ERROR, COLUMN_EDGE_RATIO, COLUMN_NORMAL_SPEED};
  const int mean[] = {COLUMN_CENTER_X, COLUMN_CENTER_Y, COLUMN_VELOCITY_X, COLUMN_VELOCITY_Y};
  for (int c = 0; c < 4; c++) all[total[c]] += one[total[c]];
  for (int c = 0; c < 4; c++)
    if (PetscAbsReal(one[worst[c]]) > PetscAbsReal(all[worst[c]])) all[worst[c]] = one[worst[c]];
  for (int c = 0; c < 4; c++) all[mean[c]] += one[mean[c]] / vesicles;
}

/* The columns that are not of the vesicles, and the totals. */
static PetscErrorCode TakeStep(Record *r, Scheme s) {
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
  PetscCall(SchemeContactEnergy(s, &row[COLUMN_CONTACT]));
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

/* NaN is an empty entry. */
static void AddNumber(Record *r, size_t *used, PetscReal x) {
  const char *comma = *used ? "," : "";
  if (PetscIsNanReal(x))
    *used += (size_t)snprintf(r->text + *used, r->room - *used, "%s", comma);
  else
    *used += (size_t)snprintf(r->text + *used, r->room - *used, "%s%.17g", comma, (double)x);
}

PetscErrorCode RecordTake(Record *r, Scheme s) {
  PetscReal *row = r->last;
  size_t used = 0;
  PetscFunctionBeginUser;
  PetscCall(TakeStep(r, s));
  PetscCall(RecordMeasure(r, s));
  for (PetscInt v = 0; v < r->vesicles; v++) Combine(r->vesicles, r->each + v * COLUMN_COUNT, row);
  row[COLUMN_INCLINATION] = r->vesicles ? r->each[COLUMN_INCLINATION] : 0;
  row[COLUMN_FREQUENCY] = r->vesicles ? r->each[COLUMN_FREQUENCY] : NAN;
  for (int c = 0; c < COLUMN_COUNT; c++) AddNumber(r, &used, row[c]);
  for (PetscInt v = 0; v < r->vesicles; v++)
    for (int c = 0; c < Repeated(r); c++) AddNumber(r, &used, r->each[v * COLUMN_COUNT + RecordVesicleColumns[c]]);
  PetscCall(ObstacleRowTake(s, r->solid));
  for (PetscInt k = 0; k < r->solids; k++) AddNumber(r, &used, r->solid[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool RecordFits(const Record *r, PetscInt step, PetscReal t) {
  PetscInt more = 0;
  for (const char *c = r->header; *c; c++) more += *c == ',';
  for (const char *c = r->text; *c; c++) more -= *c == ',';
  return !more && !r->text[strspn(r->text, "0123456789+-.einf,")] && r->last[COLUMN_STEP] == step &&
                 r->last[COLUMN_TIME] == t
             ? PETSC_TRUE
             : PETSC_FALSE;
}

PetscErrorCode RecordParse(Record *r, const char text[]) {
  const char *p = r->text;
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(r->text, text, r->room));
  for (int c = 0; c < COLUMN_COUNT && p; c++) {
    char *end;
    const double x = strtod(p, &end);
    r->last[c] = end > p ? x : NAN; /* an empty entry, which the last may be */
    p = strchr(p, ',') ? strchr(p, ',') + 1 : NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
