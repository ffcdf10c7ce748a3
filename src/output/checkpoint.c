/* checkpoint.h5: everything that a restart needs, and a checksum of all its bytes behind them (HDF5 does not read past
   its own end). */
#include "output/output.h"
#include <sys/stat.h>
#include <unistd.h>

PetscBool ChecksumOfFile(const char path[], long tail, unsigned *crc, char *end) {
  static unsigned table[256];
  unsigned char block[65536];
  FILE *f = fopen(path, "rb");
  long left;
  unsigned sum = 0xffffffffu;
  if (!f) return PETSC_FALSE;
  for (unsigned i = 0; i < 256 && !table[255]; i++) { /* the reflected polynomial of zlib's crc32 */
    unsigned c = i;
    for (int k = 0; k < 8; k++) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  left = fseek(f, 0, SEEK_END) ? -1 : ftell(f) - tail;
  rewind(f);
  while (left > 0) {
    const size_t want = PetscMin((size_t)left, sizeof(block)), got = fread(block, 1, want, f);
    if (got != want) break;
    for (size_t i = 0; i < got; i++) sum = table[(sum ^ block[i]) & 255] ^ (sum >> 8);
    left -= (long)got;
  }
  const PetscBool read = left == 0 && fread(end, 1, (size_t)tail, f) == (size_t)tail ? PETSC_TRUE : PETSC_FALSE;
  fclose(f);
  *crc = ~sum;
  return read;
}

/* The vectors of one state into the groups <prefix>/fluid and <prefix>/vesicle. */
static PetscErrorCode WriteVectors(Output o, H5File *file, const char prefix[], const State *q) {
  static const char *const fluid[3] = {"u", "v", "p"}, *const vesicle[3] = {"markers", "velocity", "tension"};
  const Grid g = o->scheme->fluid->grid;
  const PetscInt M = o->scheme->membrane->M, markers[2] = {M, 2};
  const Vec marker[3] = {q->X, q->U, q->sigma};
  char name[64];
  const PetscScalar *a[3], *x;
  PetscInt walls = 0;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(q->w, &a[0]));
  a[1] = a[0] + GridLocalU(g);
  PetscCall(VecGetArrayRead(q->p, &a[2]));
  for (int f = 0; f < 3; f++) {
    const PetscInt dims[2] = {g->all_rows[f], g->columns[f]};
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%s", prefix, fluid[f]));
    PetscCall(H5CreateSeries(file, name, 2, dims));
    PetscCall(H5WriteField(file, name, 0, g, (Field)f, a[f]));
  }
  PetscCall(VecRestoreArrayRead(q->p, &a[2]));
  PetscCall(VecRestoreArrayRead(q->w, &a[0]));
  for (int k = 0; k < 3 && M; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/vesicle/%s", prefix, vesicle[k]));
    PetscCall(H5CreateSeries(file, name, k < 2 ? 2 : 1, markers));
    PetscCall(VecGetArrayRead(marker[k], &x));
    PetscCall(H5WriteArray(file, name, 0, k < 2 ? 2 * M : M, x));
    PetscCall(VecRestoreArrayRead(marker[k], &x));
  }
  if (q->walls) PetscCall(VecGetSize(q->walls, &walls));
  if (!walls) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/walls", prefix));
  PetscCall(H5CreateSeries(file, name, 1, &walls));
  PetscCall(VecGetArrayRead(q->walls, &x));
  PetscCall(H5WriteArray(file, name, 0, walls, x));
  PetscCall(VecRestoreArrayRead(q->walls, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteState(Output o, H5File *file) {
  const Scheme s = o->scheme;
  const State *q = &s->state;
  const Membrane m = s->membrane;
  const PetscInt format = CHECKPOINT_FORMAT, has_old = s->has_old, level = s->level ? *s->level : 0;
  const PetscInt totals[4] = {o->total_solves, o->total_tension, o->total_bending, o->total_coupled};
  const PetscInt numbers = SchemeMemorySize(s);
  PetscInt walls = 0;
  PetscReal *memory;
  char value[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(H5PutInts(file, "format", 1, &format));
  PetscCall(H5PutInts(file, "step", 1, &q->step));
  PetscCall(H5PutReals(file, "time", 1, &q->t));
  PetscCall(H5PutReals(file, "dt", 1, &q->dt));
  PetscCall(H5PutReals(file, "dt_last", 1, &q->dt_last));
  PetscCall(H5PutInts(file, "has_previous", 1, &has_old));
  PetscCall(H5PutInts(file, "step_level", 1, &level));
  if (q->walls) PetscCall(VecGetSize(q->walls, &walls));
  PetscCall(H5PutInts(file, "walls", 1, &walls));
  PetscCall(H5PutInts(file, "frames", 1, &o->scheduled));
  PetscCall(H5PutInts(file, "totals", 4, totals));
  PetscCall(H5PutString(file, "series_row", o->row ? o->row : ""));
  PetscCall(H5PutString(file, "version", PETVES_VERSION));
  for (PetscInt i = 0; SceneOptionName(i); i++) {
    PetscCall(SceneOptionValue(o->scene, i, value, sizeof(value)));
    PetscCall(H5PutString(file, SceneOptionName(i), value));
  }
  if (m->vesicles) {
    PetscCall(H5PutInts(file, "vesicles", 1, &m->vesicles));
    PetscCall(H5PutInts(file, "vesicle_start", m->vesicles + 1, m->start));
    PetscCall(H5PutReals(file, "vesicle_ds", m->vesicles, m->ds));
    PetscCall(H5PutReals(file, "vesicle_area", m->vesicles, m->A0));
    PetscCall(H5PutReals(file, "vesicle_length", m->vesicles, m->L0));
  }
  PetscCall(WriteVectors(o, file, "", q));
  if (s->has_old) PetscCall(WriteVectors(o, file, "/previous", s->old));
  PetscCall(PetscMalloc1(numbers, &memory));
  PetscCall(SchemeRemember(s, memory));
  PetscCall(H5CreateSeries(file, "/solver", 1, &numbers));
  PetscCall(H5WriteArray(file, "/solver", 0, numbers, memory));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The name of the k-th newest checkpoint. */
static PetscErrorCode Name(Output o, PetscInt k, char path[PETSC_MAX_PATH_LEN]) {
  char file[64] = "checkpoint.h5";
  PetscFunctionBeginUser;
  if (k) PetscCall(PetscSNPrintf(file, sizeof(file), "checkpoint_%" PetscInt_FMT ".h5", k));
  PetscCall(OutputPath(o, file, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Older checkpoints move one name up, then the new one takes its own. There is a checkpoint.h5 at every moment, where
   the file system has links. */
static PetscErrorCode Rotate(Output o, const char temporary[], PetscBool *done) {
  char from[PETSC_MAX_PATH_LEN], to[PETSC_MAX_PATH_LEN];
  struct stat what;
  PetscFunctionBeginUser;
  for (PetscInt k = o->scene->output.checkpoint_keep - 1; k > 0; k--) {
    PetscCall(Name(o, k - 1, from));
    PetscCall(Name(o, k, to));
    if (stat(from, &what) || !S_ISREG(what.st_mode)) continue;
    (void)unlink(to);
    if (k > 1 || link(from, to)) (void)rename(from, to);
  }
  PetscCall(Name(o, 0, to));
  *done = !rename(temporary, to) && !OutputSync(o->folder) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointAdopt(Output o) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  struct stat chosen, other;
  PetscInt k = 0;
  PetscFunctionBeginUser;
  if (o->rank || stat(o->scene->output.restart, &chosen)) PetscFunctionReturn(PETSC_SUCCESS);
  for (; k < 100; k++) { /* which one it is */
    PetscCall(Name(o, k, path));
    if (!stat(path, &other) && other.st_ino == chosen.st_ino) break;
  }
  if (!k || k == 100) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OutputPath(o, "checkpoint.h5.tmp", temporary));
  PetscCall(Name(o, 0, path));
  (void)unlink(temporary);
  if (link(o->scene->output.restart, temporary) || rename(temporary, path)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 1; j < k; j++) {
    PetscCall(Name(o, j, path));
    (void)unlink(path);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The checksum behind the file's bytes. */
static PetscBool Seal(const char path[]) {
  unsigned crc;
  char none[1];
  FILE *f;
  if (!ChecksumOfFile(path, 0, &crc, none)) return PETSC_FALSE;
  f = fopen(path, "ab");
  if (!f) return PETSC_FALSE;
  const PetscBool printed = fprintf(f, CHECKPOINT_TAIL, crc) == CHECKPOINT_TAIL_LENGTH ? PETSC_TRUE : PETSC_FALSE;
  return !fclose(f) && printed ? PETSC_TRUE : PETSC_FALSE;
}

/* The rows and frames that belong to the checkpoint must be on the disk when it appears. */
static PetscErrorCode SyncOthers(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "series.csv", path));
  PetscCall(OutputCheck(o, !o->series || (!fflush(o->series) && !fsync(fileno(o->series))), path));
  PetscCall(H5FileFlush(&o->fields));
  PetscCall(H5FileCheck(&o->fields));
  PetscCall(OutputCheck(o, o->rank || (!OutputSync(o->fields.path) && !FramesSync(o)), o->fields.path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCheckpoint(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  H5File file;
  PetscBool done = PETSC_TRUE;
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  if (o->saved_step == o->scheme->state.step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(SyncOthers(o));
  PetscCall(OutputPath(o, "checkpoint.h5.tmp", path));
  PetscCall(H5FileCreate(o->comm, path, &file));
  PetscCall(WriteState(o, &file));
  PetscCall(H5FileClose(&file));
  if (!o->rank) {
    done = !file.failed && Seal(path) && !OutputSync(path) ? PETSC_TRUE : PETSC_FALSE;
    if (done) PetscCall(Rotate(o, path, &done));
    if (!done) (void)unlink(path);
  }
  PetscCall(Name(o, 0, path));
  PetscCall(OutputCheck(o, done, path));
  o->saved_step = o->scheme->state.step;
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  o->checkpoint_seconds = PetscMax(o->checkpoint_seconds, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}
