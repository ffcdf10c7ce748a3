/* -restart: a checkpoint checked, compared with the scene, and read into the scheme. */
#include "output/output.h"
#include <errno.h>
#include <unistd.h>

static PetscErrorCode CheckFormat(Output o) {
  H5File file;
  PetscInt format = 0;
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5FileOpen(o->comm, o->scene->output.restart, PETSC_FALSE, &file));
  PetscCall(H5GetInts(&file, "format", 1, &format));
  PetscCall(H5FileFailed(&file, &failed));
  PetscCall(H5FileClose(&file));
  PetscCheck(failed || format == CHECKPOINT_FORMAT, o->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: its format is %" PetscInt_FMT "; allowed: %d, which petves %s writes",
             o->scene->output.restart, format, CHECKPOINT_FORMAT, PETVES_VERSION);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is wrong with the file as such, found on rank 0 and told to all. The checksum covers every byte, so that HDF5
   reads what it wrote. Without one the file may be of a format that has none, or has it elsewhere. */
static PetscErrorCode CheckFile(Output o) {
  const char *path = o->scene->output.restart;
  char message[PETVES_MAX_MESSAGE] = "", tail[CHECKPOINT_TAIL_LENGTH + 1] = "";
  unsigned crc = 0, stored = 0;
  PetscMPIInt sealed = 1;
  PetscFunctionBeginUser;
  if (!o->rank && access(path, R_OK))
    PetscCall(PetscSNPrintf(message, sizeof(message), "cannot be opened (%s)", strerror(errno)));
  else if (!o->rank) {
    const PetscBool read = ChecksumOfFile(path, CHECKPOINT_TAIL_LENGTH, &crc, tail);
    sealed = read && sscanf(tail, CHECKPOINT_TAIL, &stored) == 1;
    if (!sealed)
      PetscCall(
          PetscSNPrintf(message, sizeof(message), "no checkpoint, or cut off: the checksum at its end is missing"));
    else if (crc != stored)
      PetscCall(
          PetscSNPrintf(message, sizeof(message), "damaged: its checksum is %08x, its bytes have %08x", stored, crc));
  }
  PetscCallMPI(MPI_Bcast(&sealed, 1, MPI_INT, 0, o->comm));
  PetscCallMPI(MPI_Bcast(message, sizeof(message), MPI_CHAR, 0, o->comm));
  if (!sealed || !*message) PetscCall(CheckFormat(o));
  PetscCheck(!*message, o->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: %s; allowed: a checkpoint.h5 of petves, or the one before it, checkpoint_1.h5", path,
             message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CompareOptions(Output o, H5File *file) {
  char here[PETSC_MAX_PATH_LEN], there[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  for (PetscInt i = 0; SceneOptionName(i); i++) {
    const char *name = SceneOptionName(i);
    if (SceneOptionMayChange(name)) continue;
    PetscCall(SceneOptionValue(o->scene, i, here, sizeof(here)));
    PetscCall(H5GetString(file, name, sizeof(there), there));
    PetscCheck(!*there || !strcmp(here, there), o->comm, PETSC_ERR_USER_INPUT,
               "%s %s: the checkpoint of -restart %s has %s; allowed: the same value", name, here,
               o->scene->output.restart, there);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vesicles from a curve file that has changed since would have the same options. */
static PetscErrorCode CompareVesicles(Output o, H5File *file) {
  const Membrane m = o->scheme->membrane;
  PetscInt vesicles = 0, *start;
  PetscReal *length;
  PetscFunctionBeginUser;
  if (!m->vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(H5GetInts(file, "vesicles", 1, &vesicles));
  PetscCheck(vesicles == m->vesicles, o->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_file %s: %" PetscInt_FMT " curves, the checkpoint of -restart %s has %" PetscInt_FMT
             " vesicles; allowed: the same curves",
             o->scene->vesicles.file, m->vesicles, o->scene->output.restart, vesicles);
  PetscCall(PetscCalloc2(vesicles + 1, &start, vesicles, &length));
  PetscCall(H5GetInts(file, "vesicle_start", vesicles + 1, start));
  PetscCall(H5GetReals(file, "vesicle_length", vesicles, length));
  for (PetscInt v = 0; v < vesicles; v++) {
    const PetscInt n = start[v + 1] - start[v], have = m->start[v + 1] - m->start[v];
    PetscCheck(n == have && PetscAbsReal(length[v] / m->L0[v] - 1) < 1e-10, o->comm, PETSC_ERR_USER_INPUT,
               "vesicle %" PetscInt_FMT " has %" PetscInt_FMT " markers and the length %.12g, the checkpoint of "
               "-restart %s %" PetscInt_FMT " and %.12g; allowed: the same vesicles",
               v + 1, have, (double)m->L0[v], o->scene->output.restart, n, (double)length[v]);
  }
  PetscCall(PetscFree2(start, length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wall forces are a guess that the next step starts from. Other back ends may have none, or others: zero then. */
static PetscErrorCode ReadWalls(H5File *file, const char prefix[], Vec walls) {
  PetscInt n, there = 0;
  PetscScalar *x;
  char name[64];
  PetscFunctionBeginUser;
  if (!walls) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetSize(walls, &n));
  PetscCall(H5GetInts(file, "walls", 1, &there));
  if (!n || n != there) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/walls", prefix));
  PetscCall(VecGetArray(walls, &x));
  PetscCall(H5ReadArray(file, name, 0, n, x));
  PetscCall(VecRestoreArray(walls, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadVectors(Output o, H5File *file, const char prefix[], State *q) {
  static const char *const fluid[3] = {"u", "v", "p"}, *const vesicle[3] = {"markers", "velocity", "tension"};
  const Grid g = o->scheme->fluid->grid;
  const PetscInt M = o->scheme->membrane->M;
  const Vec marker[3] = {q->X, q->U, q->sigma};
  char name[64];
  PetscScalar *a[3], *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(q->w, &a[0]));
  a[1] = a[0] + GridLocalU(g);
  PetscCall(VecGetArray(q->p, &a[2]));
  for (int f = 0; f < 3; f++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%s", prefix, fluid[f]));
    PetscCall(H5ReadField(file, name, 0, g, (Field)f, a[f]));
  }
  PetscCall(VecRestoreArray(q->p, &a[2]));
  PetscCall(VecRestoreArray(q->w, &a[0]));
  for (int k = 0; k < 3 && M; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/vesicle/%s", prefix, vesicle[k]));
    PetscCall(VecGetArray(marker[k], &x));
    PetscCall(H5ReadArray(file, name, 0, k < 2 ? 2 * M : M, x));
    PetscCall(VecRestoreArray(marker[k], &x));
  }
  PetscCall(ReadWalls(file, prefix, q->walls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level of step-size control counts from -time_step, which may have changed. */
static PetscErrorCode ReadLevel(Output o, H5File *file) {
  PetscInt level = 0;
  char base[64];
  PetscFunctionBeginUser;
  PetscCall(H5GetInts(file, "step_level", 1, &level));
  PetscCall(H5GetString(file, "-time_step", sizeof(base), base));
  if (*base)
    level += (PetscInt)PetscFloorReal(2 * PetscLog2Real((PetscReal)strtod(base, NULL) / o->scene->time.dt) + 1e-9);
  if (o->scheme->level) *o->scheme->level = level;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last row of series.csv, as text and as numbers. */
static PetscErrorCode ReadRow(Output o, H5File *file) {
  const char *p;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(SERIES_ROW_LENGTH, &o->row));
  PetscCall(H5GetString(file, "series_row", SERIES_ROW_LENGTH, o->row));
  p = o->row;
  for (int c = 0; c < COLUMN_COUNT && *p; c++) {
    char *end;
    const double x = strtod(p, &end);
    o->last[c] = end > p ? x : NAN; /* an empty entry */
    p = strchr(p, ',') ? strchr(p, ',') + 1 : "";
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RestartRead(Output o) {
  const Scheme s = o->scheme;
  State *q = &s->state;
  PetscInt has_old = 0, totals[4] = {0};
  PetscReal *memory;
  PetscBool failed;
  H5File file;
  PetscFunctionBeginUser;
  PetscCall(CheckFile(o));
  PetscCall(H5FileOpen(o->comm, o->scene->output.restart, PETSC_FALSE, &file));
  PetscCall(CompareOptions(o, &file));
  PetscCall(CompareVesicles(o, &file));
  PetscCall(H5GetInts(&file, "step", 1, &q->step));
  PetscCall(H5GetReals(&file, "time", 1, &q->t));
  PetscCall(H5GetReals(&file, "dt", 1, &q->dt));
  PetscCall(H5GetReals(&file, "dt_last", 1, &q->dt_last));
  PetscCall(H5GetInts(&file, "has_previous", 1, &has_old));
  PetscCall(ReadLevel(o, &file));
  PetscCall(H5GetInts(&file, "frames", 1, &o->scheduled));
  PetscCall(H5GetInts(&file, "totals", 4, totals));
  PetscCall(ReadRow(o, &file));
  PetscCall(ReadVectors(o, &file, "", q));
  s->has_old = has_old && s->old ? PETSC_TRUE : PETSC_FALSE;
  if (s->has_old) PetscCall(ReadVectors(o, &file, "/previous", s->old));
  PetscCall(PetscMalloc1(SchemeMemorySize(s), &memory));
  PetscCall(H5ReadArray(&file, "/solver", 0, SchemeMemorySize(s), memory));
  PetscCall(H5FileFailed(&file, &failed));
  PetscCall(H5FileClose(&file));
  PetscCheck(!failed, o->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: entries are missing or have another size; allowed: a checkpoint.h5 of petves",
             o->scene->output.restart);
  o->total_solves = totals[0];
  o->total_tension = totals[1];
  o->total_bending = totals[2];
  o->total_coupled = totals[3];
  PetscCall(SchemeRecall(s, memory));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}
