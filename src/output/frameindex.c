#include "output/frameindex.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#define NAME "run.h5.index"

/* One line: the frame, its time, and its places in the order of FrameSeries. */
static void PrintFrame(FrameIndex *x, H5File *fields, PetscInt frame, PetscReal t) {
  fprintf(x->file, "%d %.17g", (int)frame, (double)t);
  for (PetscInt k = 0; k < FrameSeriesCount(x->scheme); k++)
    fprintf(x->file, " %llu", H5FramePlace(fields, FrameSeries[k], frame));
  fprintf(x->file, "\n");
}

PetscErrorCode FrameIndexAppend(FrameIndex *x, H5File *fields, PetscInt frame, PetscReal t) {
  PetscBool done = PETSC_TRUE;
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  if (x->file) {
    PrintFrame(x, fields, frame, t);
    done = !fflush(x->file) && !ferror(x->file) ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(FolderPath(x->folder, NAME, path));
  PetscCall(FolderCheck(x->folder, done, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrameIndexOpen(FrameIndex *x, Folder *folder, Scheme scheme, H5File *fields, PetscInt frames,
                              const PetscReal times[]) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  x->folder = folder;
  x->scheme = scheme;
  PetscCall(FolderPath(folder, NAME, path));
  PetscCall(FolderPath(folder, NAME ".tmp", temporary));
  if (!folder->rank) {
    x->file = fopen(temporary, "w");
    for (PetscInt t = 0; t < frames && x->file; t++) PrintFrame(x, fields, t, times[t]);
    done = x->file && !fflush(x->file) && !ferror(x->file) ? PETSC_TRUE : PETSC_FALSE;
    if (done) done = fields->failed ? !unlink(temporary) : !rename(temporary, path);
  }
  PetscCall(FolderCheck(folder, done, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int FrameIndexSync(FrameIndex *x) {
  return x->file && (fflush(x->file) || fsync(fileno(x->file)));
}

PetscErrorCode FrameIndexClose(FrameIndex *x, PetscBool whole) {
  PetscFunctionBeginUser;
  if (!x->file) PetscFunctionReturn(PETSC_SUCCESS);
  (void)fclose(x->file); /* it is of use only to a run that is killed before this */
  x->file = NULL;
  if (whole) PetscCall(FolderRemove(x->folder, NAME));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One line of the index, of n places. */
static PetscBool ReadPlaces(FILE *index, PetscInt n, PetscInt *frame, PetscReal *t, unsigned long long place[]) {
  char line[512], *p = line;
  if (!fgets(line, sizeof(line), index) || !strchr(line, '\n')) return PETSC_FALSE;
  *frame = (PetscInt)strtol(p, &p, 10);
  *t = strtod(p, &p);
  for (PetscInt k = 0; k < n; k++) {
    char *end;
    place[k] = strtoull(p, &end, 10);
    if (end == p || !place[k]) return PETSC_FALSE;
    p = end;
  }
  return PETSC_TRUE;
}

/* Entry k of a frame at its place in the file, n numbers. */
static PetscBool ReadEntry(Scheme s, int file, PetscInt k, off_t place, PetscReal values[]) {
  const PetscInt n = FrameEntries(s, k);
  const size_t bytes = (size_t)n * (FrameIsSingle(s, k) ? sizeof(float) : sizeof(PetscReal));
  if (pread(file, values, bytes, place) != (ssize_t)bytes) return PETSC_FALSE;
  for (PetscInt i = n - 1; i >= 0 && FrameIsSingle(s, k); i--) { /* from behind, where there is room */
    float x;
    memcpy(&x, (const char *)values + (size_t)i * sizeof(x), sizeof(x));
    values[i] = x;
  }
  return PETSC_TRUE;
}

/* Copy the first `frames` frames into the new file `f`; the number that could be read. A frame may have several lines,
   where a run went on after its end: the last one holds. Rank 0's. */
static PetscErrorCode CopyFrames(Scheme s, PetscInt frames, FILE *index, int old, H5File *f, PetscInt *copied) {
  const PetscInt series = FrameSeriesCount(s);
  PetscReal *values, t;
  PetscInt most = 0, frame;
  unsigned long long place[FRAME_SERIES];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < series; k++) most = PetscMax(most, FrameEntries(s, k));
  PetscCall(PetscMalloc1(most, &values));
  *copied = 0;
  while (ReadPlaces(index, series, &frame, &t, place) && frame <= *copied) {
    PetscBool good = PETSC_TRUE;
    if (frame >= frames) continue;
    for (PetscInt k = 0; good && k < series; k++) {
      good = ReadEntry(s, old, k, (off_t)place[k], values);
      if (good) PetscCall(H5WriteArray(f, FrameSeries[k], frame, FrameEntries(s, k), values));
    }
    if (!good) break;
    PetscCall(H5WriteArray(f, "/time", frame, 1, &t));
    *copied = frame + 1;
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run.h5.new is whole when it has that name; the index, which is of the old run.h5, goes before it. */
static PetscBool TakeNew(const char fresh[], const char index[], const char path[]) {
  return !access(fresh, F_OK) && (!unlink(index) || errno == ENOENT) && !rename(fresh, path) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode FrameIndexRepair(Folder *folder, Scheme scheme, PetscInt frames) {
  char path[PETSC_MAX_PATH_LEN], index[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN], fresh[PETSC_MAX_PATH_LEN];
  FILE *lines = NULL;
  H5File f;
  PetscInt copied = 0;
  int old = -1;
  PetscMPIInt here = 0;
  PetscFunctionBeginUser;
  PetscCall(FolderPath(folder, "run.h5", path));
  PetscCall(FolderPath(folder, NAME, index));
  PetscCall(FolderPath(folder, "run.h5.tmp", part));
  PetscCall(FolderPath(folder, "run.h5.new", fresh));
  if (!folder->rank && !TakeNew(fresh, index, path)) {
    lines = fopen(index, "r");
    old = lines ? open(path, O_RDONLY) : -1;
    here = old >= 0;
  }
  PetscCallMPI(MPI_Bcast(&here, 1, MPI_INT, 0, folder->comm));
  if (here) {
    PetscCall(FrameFileCreate(scheme, part, &f));
    if (!folder->rank) PetscCall(CopyFrames(scheme, frames, lines, old, &f, &copied));
    PetscCall(H5FileClose(&f));
    if (!folder->rank && copied == frames && !f.failed &&
        (FileSync(part) || rename(part, fresh) || !TakeNew(fresh, index, path)))
      f.failed = PETSC_TRUE;
    if (!folder->rank) (void)unlink(part);
  }
  if (lines) (void)fclose(lines);
  if (old >= 0) (void)close(old);
  if (here) PetscCall(FolderCheck(folder, !f.failed, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}
