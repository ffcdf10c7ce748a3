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

static PetscErrorCode Header(Output o, char line[], size_t length) {
  const PetscInt vesicles = o->scheme->membrane->vesicles;
  size_t used = 0;
  PetscFunctionBeginUser;
  for (int c = 0; c < COLUMN_COUNT; c++, used = strlen(line))
    PetscCall(PetscSNPrintf(line + used, length - used, "%s%s", c ? "," : "", SeriesColumns[c]));
  for (PetscInt v = 1; v <= vesicles && vesicles > 1; v++)
    for (int c = 0; c < PER_VESICLE; c++, used = strlen(line))
      PetscCall(PetscSNPrintf(line + used, length - used, ",%s_%" PetscInt_FMT, SeriesColumns[per_vesicle[c]], v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* series.csv of an earlier run up to the row of `step`, under a temporary name; what is wrong with it, or NULL. */
static const char *CopyRows(const char path[], const char temporary[], const char header[], PetscInt step) {
  FILE *in = fopen(path, "r"), *out = in ? fopen(temporary, "w") : NULL;
  char *line = NULL;
  const char *wrong = !in ? "cannot be read" : (!out ? "cannot be written" : NULL);
  size_t room = 0;
  PetscInt last = -1;
  for (PetscInt n = 0; !wrong && last < step; n++) {
    const ssize_t length = getline(&line, &room, in);
    if (length <= 0 || line[length - 1] != '\n')
      wrong = "ends before the checkpoint's step";
    else if (!n && (strncmp(line, header, strlen(header)) || (size_t)length != strlen(header) + 1))
      wrong = "has other columns";
    else if (n && atol(line) > step)
      wrong = "lacks the checkpoint's step";
    else if (fputs(line, out) < 0)
      wrong = "cannot be written";
    if (n) last = wrong ? last : (PetscInt)atol(line);
  }
  free(line);
  if (in) fclose(in);
  if (out && fclose(out) && !wrong) wrong = "cannot be written";
  if (!wrong && OutputSync(temporary)) wrong = "cannot be written";
  if (wrong) (void)remove(temporary);
  return wrong;
}

PetscErrorCode SeriesPrepare(Output o) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN], wrong[64] = "", *header;
  const PetscBool row = *o->scene->output.restart && !o->go_on ? PETSC_TRUE : PETSC_FALSE;
  PetscBool written = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(o->scheme->membrane->vesicles * COLUMN_COUNT, &o->each));
  PetscCall(OutputPath(o, "series.csv", path));
  PetscCall(OutputPath(o, "series.csv.tmp", temporary));
  if (!o->row) PetscCall(PetscCalloc1(SERIES_ROW_LENGTH, &o->row));
  PetscCall(PetscCalloc1(SERIES_ROW_LENGTH, &header));
  PetscCall(Header(o, header, SERIES_ROW_LENGTH));
  if (!o->rank && o->go_on) {
    const char *text = CopyRows(path, temporary, header, o->scheme->state.step);
    if (text) PetscCall(PetscStrncpy(wrong, text, sizeof(wrong)));
  } else if (!o->rank) {
    FILE *f = fopen(temporary, "w");
    if (f) fprintf(f, row ? "%s\n%s\n" : "%s\n", header, o->row);
    written = f && !fclose(f) ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscFree(header));
  PetscCallMPI(MPI_Bcast(wrong, sizeof(wrong), MPI_CHAR, 0, o->comm));
  PetscCheck(!*wrong, o->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: %s %s (step %" PetscInt_FMT "); allowed: the file as the run left it, or a new -output_dir",
             o->scene->output.restart, path, wrong, o->scheme->state.step);
  PetscCall(OutputCheck(o, written, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesOpen(Output o) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "series.csv", path));
  PetscCall(OutputPath(o, "series.csv.tmp", temporary));
  if (!o->rank && !rename(temporary, path)) o->series = fopen(path, "a");
  PetscCall(OutputCheck(o, o->series ? PETSC_TRUE : PETSC_FALSE, path));
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

static PetscErrorCode AddNumber(char line[], size_t *used, PetscReal x) {
  const char *comma = *used ? "," : "";
  PetscFunctionBeginUser;
  if (PetscIsNanReal(x))
    *used += (size_t)snprintf(line + *used, SERIES_ROW_LENGTH - *used, "%s", comma);
  else
    *used += (size_t)snprintf(line + *used, SERIES_ROW_LENGTH - *used, "%s%.17g", comma, (double)x);
  PetscCheck(*used < SERIES_ROW_LENGTH, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a row of series.csv is too long");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputMeasureVesicles(Output o) {
  const State *q = &o->scheme->state;
  const PetscScalar *X, *U;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(q->X, &X));
  PetscCall(VecGetArrayRead(q->U, &U));
  for (PetscInt v = 0; v < o->scheme->membrane->vesicles; v++)
    PetscCall(VesicleRow(o, v, X, U, o->each + v * COLUMN_COUNT));
  PetscCall(VecRestoreArrayRead(q->U, &U));
  PetscCall(VecRestoreArrayRead(q->X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSeries(Output o) {
  Scheme s = o->scheme;
  const StepReport *r = &s->report;
  const PetscInt vesicles = s->membrane->vesicles;
  PetscReal *row = o->last;
  size_t used = 0;
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
  PetscCall(OutputMeasureVesicles(o));
  for (PetscInt v = 0; v < vesicles; v++) Combine(vesicles, o->each + v * COLUMN_COUNT, row);
  row[COLUMN_INCLINATION] = vesicles ? o->each[COLUMN_INCLINATION] : 0;
  row[COLUMN_FREQUENCY] = vesicles ? o->each[COLUMN_FREQUENCY] : NAN;
  for (int c = 0; c < COLUMN_COUNT; c++) PetscCall(AddNumber(o->row, &used, row[c]));
  for (PetscInt v = 0; v < vesicles && vesicles > 1; v++)
    for (int c = 0; c < PER_VESICLE; c++)
      PetscCall(AddNumber(o->row, &used, o->each[v * COLUMN_COUNT + per_vesicle[c]]));
  if (o->series) fprintf(o->series, "%s\n", o->row);
  o->total_solves += r->solves;
  o->total_tension += r->tension_its;
  o->total_bending += r->bending_its;
  o->total_coupled += r->coupled_its;
  o->cfl_max = PetscMax(o->cfl_max, r->cfl);
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
