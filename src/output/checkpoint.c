#include "base/version.h"
#include "scheme/fields.h"
#include "output/checkpoint.h"
#include "output/gathered.h"
#include "scheme/bdf.h"
#include <sys/stat.h>
#include <unistd.h>

/* More names than -checkpoint_keep allows. */
#define CHECKPOINT_NAMES 100
#define CHECKPOINT_TEMPORARY "checkpoint.h5.tmp"

PetscErrorCode CheckpointEntry(H5File *file, PetscBool write, const char name[], PetscInt n, PetscInt each,
                               PetscReal values[]) {
  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  H5BeginEntry(file, write, name, each > 1 ? 2 : 1, (PetscInt[]){n, each});
  H5Transfer(file, write, name, 0, n * each, values);
  if (!write) PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)(n * each), MPIU_REAL, 0, file->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read `each` numbers in every row of a field. */
static PetscErrorCode CheckpointRows(H5File *file, PetscBool write, const char name[], Grid g, Field field,
                                     PetscInt each, PetscScalar values[]) {
  const PetscInt rows = g->all_rows[field];
  PetscScalar *all;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(g->rank ? 0 : rows * each, &all)); /* zero where nothing can be read */
  if (write) PetscCall(GatherRows(g, field, each, values, all));
  H5BeginEntry(file, write, name, 2, (PetscInt[]){rows, each});
  H5Transfer(file, write, name, 0, rows * each, all);
  if (!write) PetscCall(ScatterRows(g, field, each, all, values));
  PetscCall(PetscFree(all));
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

PetscErrorCode CheckpointVectors(H5File *file, PetscBool write, Scheme s, PetscInt j, State *q) {
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

PetscErrorCode CheckpointTracers(H5File *file, PetscBool write, Scheme s, Tracers *t) {
  PetscFunctionBeginUser;
  PetscCall(CheckpointEntry(file, write, "/tracers/points", t->n, 2, t->X));
  PetscCall(CheckpointEntry(file, write, "/tracers/velocity", t->n, 2, t->U));
  for (PetscInt k = 0; k < 2 * t->n; k++)
    if (PetscIsInfOrNanReal(t->X[k]) || PetscIsInfOrNanReal(t->U[k])) file->failed = PETSC_TRUE;
  t->t = s->state.t;
  t->moving = s->state.step > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointMoveNumbers(H5File *file, PetscBool write, CheckpointNumbers *n) {
  SchemeTimes *times = &n->times;
  const struct {
    const char *name;
    PetscReal least, most; /* allowed; most 0: all */
    PetscInt *whole;
    PetscReal *real;
    PetscInt count; /* 0: one number */
  } all[] = {{"step", 0, 1e9, &times->step},
             {"past", 0, SCHEME_PAST, &times->past},
             {"step_level", -1000, 1000, &times->plan.level},
             {"frames", 0, 1e9, &n->frames},
             {"time", 0, 1e300, NULL, &times->t},
             {"dt", 0, 1e300, NULL, &times->dt},
             {"dt_last", 0, 1e300, NULL, &times->dt_last},
             {"step_order", 1, BDF_MOST, &times->plan.order},
             {"step_guess", 1, BDF_STATES, &times->plan.guess},
             {"totals", 0, 0, n->totals, NULL, 4},
             {"dt_earlier", 0, 0, NULL, times->dt_earlier, SCHEME_PAST}};
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) {
    const PetscInt count = PetscMax(1, all[k].count);
    const hid_t type = all[k].whole ? H5_INT : H5_REAL;
    void *const values = all[k].whole ? (void *)all[k].whole : (void *)all[k].real;
    if (write)
      H5Put(file, all[k].name, type, count, values);
    else
      PetscCall(H5Get(file, all[k].name, type, count, values));
    const PetscReal value = all[k].whole ? *all[k].whole : *all[k].real;
    PetvesCheck(write || all[k].most == 0 || (value >= all[k].least && value <= all[k].most), file->comm,
                "-restart %s: its %s is %g; allowed: %g to %g, as petves writes it", file->path, all[k].name,
                (double)value, (double)all[k].least, (double)all[k].most);
  }
  PetvesCheck(write || (n->frames <= times->step + 1 && (times->step == 0 || times->dt_last > 0)), file->comm,
              "-restart %s: it has %g frames and a last step of %g at step %g; allowed: a checkpoint.h5 of petves",
              file->path, (double)n->frames, (double)times->dt_last, (double)times->step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write the scene's options and the digests of its files, by which a restart knows the scene, and the vesicles. */
PetscErrorCode CheckpointPutScene(H5File *file, Scene scene) {
  const PetscInt format = CHECKPOINT_FORMAT;
  PetscFunctionBeginUser;
  H5Put(file, "format", H5_INT, 1, &format);
  H5PutText(file, "version", PETVES_VERSION);
  for (PetscInt i = 0; SceneOptionRow(i); i++) {
    char *value;
    PetscCall(OptionText(&scene->options, scene, i, &value));
    H5PutText(file, SceneOptionRow(i)->name, value);
    PetscCall(PetscFree(value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckpointWriteScene(Scheme s, H5File *file) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  PetscCall(CheckpointPutScene(file, s->scene));
  H5PutText(file, "vesicle_digest", s->scene->shape.digest);
  H5PutText(file, "obstacle_digest", s->scene->obstacles.outline.digest);
  if (!l->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  H5Put(file, "vesicles", H5_INT, 1, &l->bodies);
  H5Put(file, "vesicle_start", H5_INT, l->bodies + 1, l->start);
  H5Put(file, "vesicle_ds", H5_REAL, l->bodies, m->ds);
  H5Put(file, "vesicle_area", H5_REAL, l->bodies, m->A0);
  H5Put(file, "vesicle_length", H5_REAL, l->bodies, m->L0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool CheckpointChecksum(const char path[], long tail, unsigned *crc, char *end) {
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
  const PetscBool read = left == 0 && fread(end, 1, (size_t)tail, f) == (size_t)tail;
  fclose(f);
  *crc = ~sum;
  return read;
}

/* Put the checksum behind the bytes of a file; false when that fails. */
static PetscBool ChecksumAppend(const char path[]) {
  unsigned crc;
  char none[1];
  FILE *f;
  if (!CheckpointChecksum(path, 0, &crc, none)) return PETSC_FALSE;
  f = fopen(path, "ab");
  if (!f) return PETSC_FALSE;
  const PetscBool printed = fprintf(f, CHECKPOINT_TAIL, crc) == CHECKPOINT_TAIL_LENGTH;
  return !fclose(f) && printed;
}

/* Path of the k-th newest checkpoint. */
static void CheckpointPath(Folder *folder, PetscInt k, char path[PETSC_MAX_PATH_LEN]) {
  char file[64] = "checkpoint.h5";
  if (k) (void)PetscSNPrintf(file, sizeof(file), "checkpoint_%" PetscInt_FMT ".h5", k);
  FolderPath(folder, file, path);
}

/* Older checkpoints move one name up, then the new one takes the name checkpoint.h5. Where the file system has links a
   file of this name exists at every moment. */
static PetscBool CheckpointRotate(const Checkpoint *c, const char temporary[]) {
  char from[PETSC_MAX_PATH_LEN], to[PETSC_MAX_PATH_LEN];
  struct stat what;
  for (PetscInt k = c->keep - 1; k > 0; k--) {
    CheckpointPath(c->folder, k - 1, from);
    CheckpointPath(c->folder, k, to);
    if (stat(from, &what) || !S_ISREG(what.st_mode)) continue;
    (void)unlink(to);
    if (k > 1 || link(from, to)) (void)rename(from, to);
  }
  CheckpointPath(c->folder, 0, to);
  return !rename(temporary, to) && !FileSync(c->folder->path);
}

/* k, if the file is the k-th newest checkpoint, as its inode tells; CHECKPOINT_NAMES when it is none of them. */
static PetscInt CheckpointNumber(Folder *folder, const char file[]) {
  char path[PETSC_MAX_PATH_LEN];
  struct stat chosen, other;
  for (PetscInt k = 0; k < CHECKPOINT_NAMES && !stat(file, &chosen); k++) {
    CheckpointPath(folder, k, path);
    if (!stat(path, &other) && other.st_ino == chosen.st_ino) return k;
  }
  return CHECKPOINT_NAMES;
}

PetscErrorCode CheckpointAdopt(const Checkpoint *c, const char restart[]) {
  char newest[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscInt k = 0;
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  FolderPath(c->folder, CHECKPOINT_TEMPORARY, temporary);
  CheckpointPath(c->folder, 0, newest);
  if (!c->folder->rank) k = CheckpointNumber(c->folder, restart);
  if (k && k < CHECKPOINT_NAMES) {
    (void)unlink(temporary);
    if (link(restart, temporary) || rename(temporary, newest)) /* without links the file loses its old name */
      done = !rename(restart, newest);
    for (PetscInt j = 1; j < k && done; j++) {
      CheckpointPath(c->folder, j, path);
      (void)unlink(path);
    }
  }
  PetscCall(FolderCheck(c->folder, done, "checkpoint.h5"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CheckpointClear(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN];
  for (PetscInt k = 0; k < CHECKPOINT_NAMES && !folder->rank; k++) {
    CheckpointPath(folder, k, path);
    (void)unlink(path);
  }
}

/* What a checkpoint is written from. */
typedef struct {
  Scheme scheme;
  const Record *record;
  Tracers *tracers;
  PetscInt frames;
} CheckpointContent;

/* Write all of a checkpoint into the open file. /solver is what the solvers have kept from earlier steps. */
static PetscErrorCode CheckpointWriteAll(void *context, H5File *file) {
  const CheckpointContent *content = context;
  const Scheme s = content->scheme;
  const Record *r = content->record;
  const PetscInt numbers = SchemeMemorySize(s);
  const State *q = &s->state;
  CheckpointNumbers n = {.times = {.step = q->step, .past = s->past, .t = q->t, .dt = q->dt, .dt_last = q->dt_last},
                         .frames = content->frames,
                         .totals = {r->solves, r->tension, r->bending, r->coupled}};
  PetscReal *memory;
  PetscFunctionBeginUser;
  n.times.plan = (StepPlan){
      .level = s->policy.adaptive ? s->plan.level : 0, .order = s->plan.order, .guess = s->plan.guess};
  for (PetscInt j = 0; j < s->past; j++) n.times.dt_earlier[j] = s->old[j].dt_last;
  PetscCall(CheckpointMoveNumbers(file, PETSC_TRUE, &n));
  H5PutText(file, "series_row", r->text);
  PetscCall(CheckpointWriteScene(s, file));
  PetscCall(CheckpointVectors(file, PETSC_TRUE, s, 0, &s->state));
  for (PetscInt j = 0; j < s->past; j++) PetscCall(CheckpointVectors(file, PETSC_TRUE, s, j + 1, &s->old[j]));
  PetscCall(CheckpointTracers(file, PETSC_TRUE, s, content->tracers));
  PetscCall(PetscMalloc1(numbers, &memory));
  PetscCall(SchemeRemember(s, memory));
  PetscCall(CheckpointEntry(file, PETSC_TRUE, "/solver", numbers, 1, memory));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointStore(Checkpoint *c, PetscInt step, PetscErrorCode (*write)(void *, H5File *), void *context) {
  char path[PETSC_MAX_PATH_LEN];
  H5File file;
  PetscBool done = PETSC_TRUE;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  FolderPath(c->folder, CHECKPOINT_TEMPORARY, path);
  PetscCall(H5FileOpen(c->folder->comm, path, H5_NEW, &file));
  PetscCall(write(context, &file));
  H5FileClose(&file);
  if (!c->folder->rank) done = !file.failed && ChecksumAppend(path) && !FileSync(path);
  error = FolderCheckOwn(c->folder); /* once more: writing took time */
  if (!c->folder->rank) {
    if (done && !error) done = CheckpointRotate(c, path);
    if (!done || error) (void)unlink(path);
  }
  PetscCall(error);
  PetscCall(FolderCheck(c->folder, done, "checkpoint.h5"));
  c->step = step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWrite(Checkpoint *c, Scheme s, const Record *record, Tracers *tracers, PetscInt frames) {
  CheckpointContent content = {.scheme = s, .record = record, .tracers = tracers, .frames = frames};
  PetscFunctionBeginUser;
  PetscCall(SchemeFields(s));
  PetscCall(CheckpointStore(c, s->state.step, CheckpointWriteAll, &content));
  PetscFunctionReturn(PETSC_SUCCESS);
}
