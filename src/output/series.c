/* series.csv: a row a step. */
#include "output/output.h"

const char *const SeriesColumns[] = {"step",           "time",        "dt",          "energy_kinetic",
                                     "energy_bending", "area",        "length",      "area_error",
                                     "length_error",   "edge_ratio",  "div_max",     "surface_div_max",
                                     "center_x",       "center_y",    "inclination", "frequency",
                                     "tension_its",    "bending_its", "coupled_its", "nsolve",
                                     "wall",           "area_shift",  NULL};

/* Columns that repeat with a suffix when there are several vesicles. */
static const int per_vesicle[] = {COLUMN_BENDING,      COLUMN_AREA,       COLUMN_LENGTH,   COLUMN_AREA_ERROR,
                                  COLUMN_LENGTH_ERROR, COLUMN_EDGE_RATIO, COLUMN_CENTER_X, COLUMN_CENTER_Y,
                                  COLUMN_INCLINATION,  COLUMN_FREQUENCY};
#define PER_VESICLE ((int)(sizeof(per_vesicle) / sizeof(per_vesicle[0])))

PetscErrorCode SeriesCreate(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  const PetscInt vesicles = o->scheme->membrane->vesicles;
  PetscMPIInt failed = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(vesicles * COLUMN_COUNT, &o->each));
  PetscCall(OutputPath(o, "series.csv", path));
  if (!o->rank) {
    o->series = fopen(path, "w");
    failed = !o->series;
    for (int c = 0; c < COLUMN_COUNT && !failed; c++) fprintf(o->series, "%s%s", c ? "," : "", SeriesColumns[c]);
    for (PetscInt v = 1; v <= vesicles && vesicles > 1 && !failed; v++)
      for (int c = 0; c < PER_VESICLE; c++) fprintf(o->series, ",%s_%" PetscInt_FMT, SeriesColumns[per_vesicle[c]], v);
    if (!failed) fprintf(o->series, "\n");
  }
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_USER_INPUT,
             "-output_dir %s: series.csv cannot be written; allowed: a folder that can be written", o->folder);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vesicle columns of one vesicle. */
static PetscErrorCode VesicleRow(Output o, PetscInt v, const PetscScalar X[], const PetscScalar U[], PetscReal row[]) {
  Membrane m = o->scheme->membrane;
  Measures measures;
  PetscFunctionBeginUser;
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
  PetscCall(MembraneFrequency(m, v, X, U, &row[COLUMN_FREQUENCY]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Totals (energy, area, length), worst values (errors, edge ratio) or means (centre) of several vesicles. The
   inclination and the frequency of the first stand for all: neither a total nor a worst value of angles means anything.
 */
static void Combine(PetscInt vesicles, const PetscReal one[], PetscReal all[]) {
  const int total[] = {COLUMN_BENDING, COLUMN_AREA, COLUMN_LENGTH};
  const int worst[] = {COLUMN_AREA_ERROR, COLUMN_LENGTH_ERROR, COLUMN_EDGE_RATIO};
  const int mean[] = {COLUMN_CENTER_X, COLUMN_CENTER_Y};
  for (int c = 0; c < 3; c++) all[total[c]] += one[total[c]];
  for (int c = 0; c < 3; c++)
    if (PetscAbsReal(one[worst[c]]) > PetscAbsReal(all[worst[c]])) all[worst[c]] = one[worst[c]];
  for (int c = 0; c < 2; c++) all[mean[c]] += one[mean[c]] / vesicles;
}

static void PrintNumber(FILE *file, PetscReal x, PetscBool first) {
  if (PetscIsNanReal(x))
    fprintf(file, "%s", first ? "" : ",");
  else
    fprintf(file, "%s%.17g", first ? "" : ",", (double)x);
}

PetscErrorCode OutputSeries(Output o) {
  Scheme s = o->scheme;
  const StepReport *r = &s->report;
  const PetscInt vesicles = s->membrane->vesicles;
  PetscReal *row = o->last, *each = o->each;
  const PetscScalar *X, *U;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  for (int c = 0; c < COLUMN_COUNT; c++) row[c] = 0;
  row[COLUMN_STEP] = s->state.step;
  row[COLUMN_TIME] = s->state.t;
  row[COLUMN_DT] = s->state.dt;
  PetscCall(SchemeKineticEnergy(s, &row[COLUMN_KINETIC]));
  row[COLUMN_DIV] = r->div_max;
  row[COLUMN_SURFACE_DIV] = r->surface_div_max;
  row[COLUMN_TENSION_ITS] = r->tension_its;
  row[COLUMN_BENDING_ITS] = r->bending_its;
  row[COLUMN_COUPLED_ITS] = r->coupled_its;
  row[COLUMN_NSOLVE] = r->solves;
  row[COLUMN_WALL] = r->seconds;
  row[COLUMN_AREA_SHIFT] = r->area_shift;
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(VecGetArrayRead(s->state.U, &U));
  for (PetscInt v = 0; v < vesicles; v++) PetscCall(VesicleRow(o, v, X, U, each + v * COLUMN_COUNT));
  for (PetscInt v = 0; v < vesicles; v++) Combine(vesicles, each + v * COLUMN_COUNT, row);
  row[COLUMN_INCLINATION] = vesicles ? each[COLUMN_INCLINATION] : 0;
  row[COLUMN_FREQUENCY] = vesicles ? each[COLUMN_FREQUENCY] : NAN;
  PetscCall(VecRestoreArrayRead(s->state.U, &U));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  for (int c = 0; c < COLUMN_COUNT && o->series; c++) PrintNumber(o->series, row[c], !c ? PETSC_TRUE : PETSC_FALSE);
  for (PetscInt v = 0; v < vesicles && vesicles > 1 && o->series; v++)
    for (int c = 0; c < PER_VESICLE; c++) PrintNumber(o->series, each[v * COLUMN_COUNT + per_vesicle[c]], PETSC_FALSE);
  if (o->series) fprintf(o->series, "\n");
  o->total_solves += r->solves;
  o->total_tension += r->tension_its;
  o->total_bending += r->bending_its;
  o->total_coupled += r->coupled_its;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
