#include "base/version.h"
#include "output/checkpoint.h"
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

void CheckpointFinite(H5File *file, PetscInt n, const PetscReal values[]) {
  for (PetscInt k = 0; k < n && !file->rank; k++)
    if (PetscIsInfOrNanReal(values[k])) file->failed = PETSC_TRUE;
}

PetscErrorCode CheckpointMoveNumbers(H5File *file, PetscBool write, PetscInt numbers, const CheckpointNumber number[]) {
  PetscFunctionBeginUser;
  for (const CheckpointNumber *n = number; n < number + numbers; n++) {
    const PetscInt count = PetscMax(1, n->count);
    const hid_t type = n->whole ? H5_INT : H5_REAL;
    void *const values = n->whole ? (void *)n->whole : (void *)n->real;
    if (write)
      H5Put(file, n->name, type, count, values);
    else
      PetscCall(H5Get(file, n->name, type, count, values));
    const PetscReal value = n->whole ? *n->whole : *n->real;
    PetvesCheck(write || n->most == 0 || (value >= n->least && value <= n->most), file->comm,
                "-restart %s: its %s is %g; allowed: %g to %g, as petves writes it", file->path, n->name, (double)value,
                (double)n->least, (double)n->most);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write the scene's options and the digests of its files, by which a restart knows the scene. */
static PetscErrorCode CheckpointPutScene(H5File *file, Scene scene) {
  const PetscInt format = CHECKPOINT_FORMAT;
  PetscFunctionBeginUser;
  H5Put(file, "format", H5_INT, 1, &format);
  H5PutText(file, "version", PETVES_VERSION);
  H5PutText(file, "vesicle_digest", scene->shape.digest);
  H5PutText(file, "obstacle_digest", scene->obstacles.outline.digest);
  for (PetscInt i = 0; SceneOptionRow(i); i++) {
    char *value;
    PetscCall(OptionText(&scene->options, scene, i, &value));
    H5PutText(file, SceneOptionRow(i)->name, value);
    PetscCall(PetscFree(value));
  }
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
static PetscInt CheckpointPlace(Folder *folder, const char file[]) {
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
  if (!c->folder->rank) k = CheckpointPlace(c->folder, restart);
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

PetscErrorCode CheckpointWrite(Checkpoint *c, const Model *m, const char row[], PetscInt frames) {
  char path[PETSC_MAX_PATH_LEN];
  H5File file;
  PetscBool done = PETSC_TRUE;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  FolderPath(c->folder, CHECKPOINT_TEMPORARY, path);
  PetscCall(H5FileOpen(c->folder->comm, path, H5_NEW, &file));
  error = CheckpointPutScene(&file, m->scene);
  H5PutText(&file, "series_row", row);
  if (!error) error = m->ops.checkpoint(m->context, &file, PETSC_TRUE, &frames);
  H5FileClose(&file);
  if (!c->folder->rank) done = !file.failed && ChecksumAppend(path) && !FileSync(path);
  if (!error) error = FolderCheckOwn(c->folder); /* once more: writing took time */
  if (!c->folder->rank) {
    if (done && !error) done = CheckpointRotate(c, path);
    if (!done || error) (void)unlink(path);
  }
  PetscCall(error);
  PetscCall(FolderCheck(c->folder, done, "checkpoint.h5"));
  c->step = *m->step;
  PetscFunctionReturn(PETSC_SUCCESS);
}
