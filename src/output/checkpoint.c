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
  const PetscInt dims[2] = {n, each};
  const int ndims = each > 1 ? 2 : 1;
  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  if (write) {
    H5CreateSeries(file, name, PETSC_FALSE, ndims, dims);
    H5WriteArray(file, name, 0, n * each, values);
  } else {
    H5CheckEntry(file, name, ndims, dims);
    PetscCall(H5ReadArray(file, name, 0, n * each, values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read `each` numbers in every row of a field. */
static PetscErrorCode CheckpointRows(H5File *file, PetscBool write, const char name[], Grid g, Field field,
                                     PetscInt each, PetscScalar values[]) {
  const PetscInt dims[2] = {g->all_rows[field], each};
  PetscFunctionBeginUser;
  if (write)
    H5CreateSeries(file, name, PETSC_FALSE, 2, dims);
  else
    H5CheckEntry(file, name, 2, dims);
  PetscCall(H5TransferRows(file, write, &(H5Entry){name, 0}, g, field, each, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read the velocity w of a state, and its pressure where it has one: no step needs the pressure of an older
   state. */
static PetscErrorCode CheckpointFields(H5File *file, PetscBool write, Grid g, const char group[], const State *q,
                                       Vec w) {
  char name[64];
  PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a[0]));
  a[1] = a[0] + GridLocalU(g);
  if (q->p) PetscCall(VecGetArray(q->p, &a[2]));
  for (int f = 0; f < (q->p ? 3 : 2); f++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%c", group, "uvp"[f]));
    PetscCall(CheckpointRows(file, write, name, g, (Field)f, g->columns[f], a[f]));
  }
  if (q->p) PetscCall(VecRestoreArray(q->p, &a[2]));
  PetscCall(VecRestoreArray(w, &a[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read a state's flow, bit by bit. A file of solvers without such a flow gives it by its velocity w. */
static PetscErrorCode CheckpointFlow(H5File *file, PetscBool write, Scheme s, const char group[], const State *q,
                                     Vec w) {
  const Grid g = s->fluid->grid;
  PetscInt width = StateFlowWidth(q, g), there = width;
  PetscScalar *a;
  char name[64];
  PetscFunctionBeginUser;
  if (!write) PetscCall(H5GetInts(file, "flow", 1, &there));
  if (there != width) {
    PetscCall(StreamFlowsOf(SchemeFlows(s), w, q->flow));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/flow", group));
  PetscCall(VecGetArray(q->flow, &a));
  PetscCall(CheckpointRows(file, write, name, g, FIELD_U, width, a));
  PetscCall(VecRestoreArray(q->flow, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read what a state has of the fluid: no step needs the velocity of most older states. */
static PetscErrorCode CheckpointFluid(H5File *file, PetscBool write, Scheme s, const char group[], const State *q) {
  const DM velocity = s->fluid->grid->velocity;
  Vec w = q->w;
  PetscFunctionBeginUser;
  if (!w && !q->flow) PetscFunctionReturn(PETSC_SUCCESS);
  if (!w) PetscCall(DMGetGlobalVector(velocity, &w));
  if (write && !q->w) PetscCall(StreamFlowsVelocity(SchemeFlows(s), q->flow, w));
  PetscCall(CheckpointFields(file, write, s->fluid->grid, group, q, w));
  if (q->flow) PetscCall(CheckpointFlow(file, write, s, group, q, w));
  if (!q->w) PetscCall(DMRestoreGlobalVector(velocity, &w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointVectors(H5File *file, PetscBool write, Scheme s, PetscInt j, State *q) {
  static const char *const groups[] = {"", "/previous", "/previous_1", "/previous_2", "/previous_3", "/previous_4"};
  Gathered all;
  PetscFunctionBeginUser;
  PetscCall(CheckpointFluid(file, write, s, groups[j], q));
  PetscCall(GatheredCreate(q, &all));
  if (write) PetscCall(GatherState(q, &all));
  for (int k = 0; k < GATHERED_COUNT; k++) {
    GatheredPart *p = &all.part[k];
    char name[64];
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", groups[j], p->name));
    PetscCall(CheckpointEntry(file, write, name, p->n, p->each, p->values));
  }
  if (!write) PetscCall(ScatterState(&all, q));
  PetscCall(GatheredDestroy(&all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointMoveNumbers(H5File *file, PetscBool write, CheckpointNumbers *n) {
  const struct {
    const char *name;
    PetscReal least, most; /* allowed; most 0: all */
    PetscInt *whole;
    PetscReal *real;
    PetscInt count; /* 0: one number */
  } all[] = {{"step", 0, 1e9, &n->step},
             {"past", 0, SCHEME_PAST, &n->past},
             {"step_level", -1000, 1000, &n->step_level},
             {"frames", 0, 1e9, &n->frames},
             {"time", 0, 1e300, NULL, &n->time},
             {"dt", 0, 1e300, NULL, &n->dt},
             {"dt_last", 0, 1e300, NULL, &n->dt_last},
             {"step_order", 0, BDF_MOST, &n->step_order},
             {"step_guess", 0, BDF_STATES, &n->step_guess},
             {"flow", 0, 0, &n->flow},
             {"totals", 0, 0, n->totals, NULL, 4},
             {"dt_earlier", 0, 0, NULL, n->dt_earlier, SCHEME_PAST}};
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) {
    const PetscInt count = PetscMax(1, all[k].count);
    if (write && all[k].whole)
      H5PutInts(file, all[k].name, count, all[k].whole);
    else if (write)
      H5PutReals(file, all[k].name, count, all[k].real);
    else
      PetscCall(all[k].whole ? H5GetInts(file, all[k].name, count, all[k].whole)
                             : H5GetReals(file, all[k].name, count, all[k].real));
    const PetscReal value = all[k].whole ? *all[k].whole : *all[k].real;
    PetvesCheck(write || all[k].most == 0 || (value >= all[k].least && value <= all[k].most), file->comm,
                "-restart %s: its %s is %g; allowed: %g to %g, as petves writes it", file->path, all[k].name,
                (double)value, (double)all[k].least, (double)all[k].most);
  }
  PetvesCheck(write || (n->frames <= n->step + 1 && (n->step == 0 || n->dt_last > 0)), file->comm,
              "-restart %s: it has %g frames and a last step of %g at step %g; allowed: a checkpoint.h5 of petves",
              file->path, (double)n->frames, (double)n->dt_last, (double)n->step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write the scene's options and the digests of its files, by which a restart knows the scene, and the vesicles. */
static PetscErrorCode CheckpointWriteScene(Scheme s, H5File *file) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  H5PutText(file, "version", PETVES_VERSION);
  for (PetscInt i = 0; SceneOptionRow(i); i++) {
    char *value;
    PetscCall(OptionText(&s->scene->options, s->scene, i, &value));
    H5PutText(file, SceneOptionRow(i)->name, value);
    PetscCall(PetscFree(value));
  }
  H5PutText(file, "vesicle_digest", s->scene->shape.digest);
  H5PutText(file, "obstacle_digest", s->scene->obstacles.outline.digest);
  if (!l->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  H5PutInts(file, "vesicles", 1, &l->bodies);
  H5PutInts(file, "vesicle_start", l->bodies + 1, l->start);
  H5PutReals(file, "vesicle_ds", l->bodies, m->ds);
  H5PutReals(file, "vesicle_area", l->bodies, m->A0);
  H5PutReals(file, "vesicle_length", l->bodies, m->L0);
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
  const PetscBool read = left == 0 && fread(end, 1, (size_t)tail, f) == (size_t)tail ? PETSC_TRUE : PETSC_FALSE;
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
  const PetscBool printed = fprintf(f, CHECKPOINT_TAIL, crc) == CHECKPOINT_TAIL_LENGTH ? PETSC_TRUE : PETSC_FALSE;
  return !fclose(f) && printed ? PETSC_TRUE : PETSC_FALSE;
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
  return !rename(temporary, to) && !FileSync(c->folder->path) ? PETSC_TRUE : PETSC_FALSE;
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
      done = !rename(restart, newest) ? PETSC_TRUE : PETSC_FALSE;
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

/* Write all of a checkpoint into the open file. /solver is what the solvers have kept from earlier steps. */
static PetscErrorCode CheckpointWriteAll(H5File *file, Scheme s, const Record *r, PetscInt frames) {
  const PetscInt format = CHECKPOINT_FORMAT, numbers = SchemeMemorySize(s);
  const State *q = &s->state;
  CheckpointNumbers n = {.step = q->step,
                         .past = s->past,
                         .step_level = s->policy.adaptive ? s->plan.level : 0,
                         .step_order = s->plan.order,
                         .step_guess = s->plan.guess,
                         .flow = StateFlowWidth(q, s->fluid->grid),
                         .frames = frames,
                         .totals = {r->solves, r->tension, r->bending, r->coupled},
                         .time = q->t,
                         .dt = q->dt,
                         .dt_last = q->dt_last};
  PetscReal *memory;
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < s->past; j++) n.dt_earlier[j] = s->old[j].dt_last;
  H5PutInts(file, "format", 1, &format);
  PetscCall(CheckpointMoveNumbers(file, PETSC_TRUE, &n));
  H5PutText(file, "series_row", r->text);
  PetscCall(CheckpointWriteScene(s, file));
  PetscCall(CheckpointVectors(file, PETSC_TRUE, s, 0, &s->state));
  for (PetscInt j = 0; j < s->past; j++) PetscCall(CheckpointVectors(file, PETSC_TRUE, s, j + 1, &s->old[j]));
  PetscCall(PetscMalloc1(numbers, &memory));
  PetscCall(SchemeRemember(s, memory));
  PetscCall(CheckpointEntry(file, PETSC_TRUE, "/solver", numbers, 1, memory));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWrite(Checkpoint *c, Scheme s, const Record *record, PetscInt frames) {
  char path[PETSC_MAX_PATH_LEN];
  H5File file;
  PetscBool done = PETSC_TRUE;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  PetscCall(SchemeFields(s));
  FolderPath(c->folder, CHECKPOINT_TEMPORARY, path);
  PetscCall(H5FileCreate(c->folder->comm, path, &file));
  PetscCall(CheckpointWriteAll(&file, s, record, frames));
  H5FileClose(&file);
  if (!c->folder->rank) done = !file.failed && ChecksumAppend(path) && !FileSync(path) ? PETSC_TRUE : PETSC_FALSE;
  error = FolderCheckOwn(c->folder); /* once more: writing took time */
  if (!c->folder->rank) {
    if (done && !error) done = CheckpointRotate(c, path);
    if (!done || error) (void)unlink(path);
  }
  PetscCall(error);
  PetscCall(FolderCheck(c->folder, done, "checkpoint.h5"));
  c->step = s->state.step;
  PetscFunctionReturn(PETSC_SUCCESS);
}
