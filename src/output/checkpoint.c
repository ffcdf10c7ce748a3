#include "base/version.h"
#include "output/gathered.h"
#include "output/checkpoint.h"
#include "output/checksum.h"
#include "output/h5.h"
#include "output/lock.h"
#include <sys/stat.h>
#include <unistd.h>

/* Names that are looked at: more checkpoints than -checkpoint_keep allows. */
#define MOST 100
#define TEMPORARY "checkpoint.h5.tmp"

/* One entry that has no further ones behind it. */
static PetscErrorCode WriteOnly(H5File *file, const char prefix[], const char name[], int ndims, const PetscInt dims[],
                                const PetscReal values[]) {
  char path[64];
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", prefix, name));
  PetscCall(H5CreateSeries(file, path, ndims, dims));
  PetscCall(H5WriteArray(file, path, 0, dims[0] * (ndims > 1 ? dims[1] : 1), values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The velocity w of a state, and its pressure: of an older one no step needs that. */
static PetscErrorCode WriteFields(Scheme s, H5File *file, const char prefix[], const State *q, Vec w) {
  static const char *const names[3] = {"u", "v", "p"};
  const Grid g = s->fluid->grid;
  char name[64];
  const PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(w, &a[0]));
  a[1] = a[0] + GridLocalU(g);
  if (q->p) PetscCall(VecGetArrayRead(q->p, &a[2]));
  for (int f = 0; f < (q->p ? 3 : 2); f++) {
    const PetscInt dims[2] = {g->all_rows[f], g->columns[f]};
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%s", prefix, names[f]));
    PetscCall(H5CreateSeries(file, name, 2, dims));
    PetscCall(H5WriteField(file, name, 0, g, (Field)f, a[f]));
  }
  if (q->p) PetscCall(VecRestoreArrayRead(q->p, &a[2]));
  PetscCall(VecRestoreArrayRead(w, &a[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the state has: of most older ones no step needs the velocity. A flow is written as it is, so that a restart has
   its bits, beside the velocity, from which other solvers go on. */
static PetscErrorCode WriteFluid(Scheme s, H5File *file, const char prefix[], const State *q) {
  const Grid g = s->fluid->grid;
  const PetscScalar *a;
  char name[64];
  Vec w = q->w;
  PetscFunctionBeginUser;
  if (!w && !q->flow) PetscFunctionReturn(PETSC_SUCCESS);
  if (!w) {
    PetscCall(DMGetGlobalVector(g->velocity, &w));
    PetscCall(s->ops.velocity(s, q, w));
  }
  PetscCall(WriteFields(s, file, prefix, q, w));
  if (!q->w) PetscCall(DMRestoreGlobalVector(g->velocity, &w));
  if (!q->flow) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt dims[2] = {g->all_rows[FIELD_U], StateFlowWidth(q, g)};
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/flow", prefix));
  PetscCall(H5CreateSeries(file, name, 2, dims));
  PetscCall(VecGetArrayRead(q->flow, &a));
  PetscCall(H5WriteRows(file, name, 0, g, FIELD_U, dims[1], a));
  PetscCall(VecRestoreArrayRead(q->flow, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vectors of one state into the groups <prefix>/fluid and <prefix>/vesicle. */
static PetscErrorCode WriteVectors(Scheme s, H5File *file, const char prefix[], const State *q) {
  Gathered now;
  PetscFunctionBeginUser;
  PetscCall(WriteFluid(s, file, prefix, q));
  PetscCall(GatheredCreate(q, &now));
  PetscCall(GatherState(q, &now));
  const PetscInt markers[2] = {now.M, 2};
  if (now.M) {
    PetscCall(WriteOnly(file, prefix, "vesicle/markers", 2, markers, now.markers));
    PetscCall(WriteOnly(file, prefix, "vesicle/velocity", 2, markers, now.velocity));
    PetscCall(WriteOnly(file, prefix, "vesicle/tension", 1, markers, now.tension));
  }
  if (now.W) PetscCall(WriteOnly(file, prefix, "obstacle/force", 2, (const PetscInt[]){now.W, 2}, now.solid));
  PetscCall(GatheredDestroy(&now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The scene's options and digests of its files, by which a restart knows the scene, and what the vesicles are. */
static PetscErrorCode WriteScene(Scheme s, H5File *file) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  PetscCall(H5PutString(file, "version", PETVES_VERSION));
  for (PetscInt i = 0; SceneOptionName(i); i++) {
    char *value;
    PetscCall(SceneOptionText(s->scene, i, &value));
    PetscCall(H5PutText(file, SceneOptionName(i), value));
    PetscCall(PetscFree(value));
  }
  PetscCall(H5PutString(file, "vesicle_digest", s->scene->shape.digest));
  PetscCall(H5PutString(file, "obstacle_digest", s->scene->obstacles.outline.digest));
  if (!l->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(H5PutInts(file, "vesicles", 1, &l->bodies));
  PetscCall(H5PutInts(file, "vesicle_start", l->bodies + 1, l->start));
  PetscCall(H5PutReals(file, "vesicle_ds", l->bodies, m->ds));
  PetscCall(H5PutReals(file, "vesicle_area", l->bodies, m->A0));
  PetscCall(H5PutReals(file, "vesicle_length", l->bodies, m->L0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The numbers that stand for time, step and what has been written so far. */
static PetscErrorCode WriteNumbers(Scheme s, H5File *file, const Record *record, PetscInt frames) {
  const State *q = &s->state;
  const PetscInt format = CHECKPOINT_FORMAT, past = s->past, level = s->policy.adaptive ? s->plan.level : 0;
  const PetscInt totals[4] = {record->solves, record->tension, record->bending, record->coupled};
  PetscReal earlier[SCHEME_PAST] = {0};
  const PetscInt flow = StateFlowWidth(q, s->fluid->grid);
  PetscFunctionBeginUser;
  PetscCall(H5PutInts(file, "format", 1, &format));
  PetscCall(H5PutInts(file, "step", 1, &q->step));
  PetscCall(H5PutReals(file, "time", 1, &q->t));
  PetscCall(H5PutReals(file, "dt", 1, &q->dt));
  PetscCall(H5PutReals(file, "dt_last", 1, &q->dt_last));
  PetscCall(H5PutInts(file, "past", 1, &past));
  for (PetscInt j = 0; j < past; j++) earlier[j] = s->old[j].dt_last;
  PetscCall(H5PutReals(file, "dt_earlier", SCHEME_PAST, earlier));
  PetscCall(H5PutInts(file, "step_level", 1, &level));
  PetscCall(H5PutInts(file, "step_order", 1, &s->plan.order));
  PetscCall(H5PutInts(file, "step_guess", 1, &s->plan.guess));
  PetscCall(H5PutInts(file, "flow", 1, &flow));
  PetscCall(H5PutInts(file, "frames", 1, &frames));
  PetscCall(H5PutInts(file, "totals", 4, totals));
  PetscCall(H5PutText(file, "series_row", record->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the solvers have kept from earlier steps. */
static PetscErrorCode WriteMemory(Scheme s, H5File *file) {
  const PetscInt numbers = SchemeMemorySize(s);
  PetscReal *memory;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(numbers, &memory));
  PetscCall(SchemeRemember(s, memory));
  PetscCall(WriteOnly(file, "", "solver", 1, &numbers, memory));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The name of the k-th newest checkpoint. */
static PetscErrorCode Name(Folder *folder, PetscInt k, char path[PETSC_MAX_PATH_LEN]) {
  char file[64] = "checkpoint.h5";
  PetscFunctionBeginUser;
  if (k) PetscCall(PetscSNPrintf(file, sizeof(file), "checkpoint_%" PetscInt_FMT ".h5", k));
  PetscCall(FolderPath(folder, file, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Older checkpoints move one name up, then the new one takes its own. There is a checkpoint.h5 at every moment, where
   the file system has links. */
static PetscErrorCode Rotate(const Checkpoint *c, const char temporary[], PetscBool *done) {
  char from[PETSC_MAX_PATH_LEN], to[PETSC_MAX_PATH_LEN];
  struct stat what;
  PetscFunctionBeginUser;
  for (PetscInt k = c->keep - 1; k > 0; k--) {
    PetscCall(Name(c->folder, k - 1, from));
    PetscCall(Name(c->folder, k, to));
    if (stat(from, &what) || !S_ISREG(what.st_mode)) continue;
    (void)unlink(to);
    if (k > 1 || link(from, to)) (void)rename(from, to);
  }
  PetscCall(Name(c->folder, 0, to));
  *done = !rename(temporary, to) && !FileSync(c->folder->path) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The place of a file among the checkpoints, by its inode; MOST when it is none of them. */
static PetscErrorCode PlaceOf(Folder *folder, const char file[], PetscInt *k) {
  char path[PETSC_MAX_PATH_LEN];
  struct stat chosen, other;
  PetscFunctionBeginUser;
  *k = MOST;
  if (stat(file, &chosen)) PetscFunctionReturn(PETSC_SUCCESS);
  for (*k = 0; *k < MOST; ++*k) {
    PetscCall(Name(folder, *k, path));
    if (!stat(path, &other) && other.st_ino == chosen.st_ino) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointAdopt(const Checkpoint *c, const char restart[]) {
  char newest[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscInt k = 0;
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(FolderPath(c->folder, TEMPORARY, temporary));
  PetscCall(Name(c->folder, 0, newest));
  if (!c->folder->rank) PetscCall(PlaceOf(c->folder, restart, &k));
  if (k && k < MOST) {
    (void)unlink(temporary);
    if (link(restart, temporary) || rename(temporary, newest)) /* no links here: it leaves its old name */
      done = !rename(restart, newest) ? PETSC_TRUE : PETSC_FALSE;
    for (PetscInt j = 1; j < k && done; j++) {
      PetscCall(Name(c->folder, j, path));
      (void)unlink(path);
    }
  }
  PetscCall(FolderCheck(c->folder, done, newest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointClear(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < MOST && !folder->rank; k++) {
    PetscCall(Name(folder, k, path));
    (void)unlink(path);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointCreate(Checkpoint *c, Folder *folder, PetscInt keep) {
  PetscFunctionBeginUser;
  c->folder = folder;
  c->keep = keep;
  c->step = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWrite(Checkpoint *c, Scheme s, const Record *record, PetscInt frames) {
  char path[PETSC_MAX_PATH_LEN];
  H5File file;
  PetscBool done = PETSC_TRUE;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  PetscCall(SchemeFields(s));
  PetscCall(FolderPath(c->folder, TEMPORARY, path));
  PetscCall(H5FileCreate(c->folder->comm, path, &file));
  PetscCall(WriteNumbers(s, &file, record, frames));
  PetscCall(WriteScene(s, &file));
  PetscCall(WriteVectors(s, &file, "", &s->state));
  for (PetscInt j = 0; j < s->past; j++) PetscCall(WriteVectors(s, &file, CheckpointGroup(j), &s->old[j]));
  PetscCall(WriteMemory(s, &file));
  PetscCall(H5FileClose(&file));
  if (!c->folder->rank) done = !file.failed && ChecksumAppend(path) && !FileSync(path) ? PETSC_TRUE : PETSC_FALSE;
  error = FolderCheckOwn(c->folder); /* once more: that took time */
  if (!c->folder->rank) {
    if (done && !error) PetscCall(Rotate(c, path, &done));
    if (!done || error) (void)unlink(path);
  }
  PetscCall(error);
  PetscCall(Name(c->folder, 0, path));
  PetscCall(FolderCheck(c->folder, done, path));
  c->step = s->state.step;
  PetscFunctionReturn(PETSC_SUCCESS);
}
