#include "output/growing.h"
#include "output/lock.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

/* The name of the file with an ending, in the folder. */
static PetscErrorCode Path(const Growing *g, const char ending[], char path[PETSC_MAX_PATH_LEN]) {
  char name[64];
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s%s", g->kind.name, ending));
  PetscCall(FolderPath(g->folder, name, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One line of the index: the entry, its time, and its places in the order of the series. */
static void PrintEntry(Growing *g, FILE *f, PetscInt entry, PetscReal t) {
  fprintf(f, "%d %.17g", (int)entry, (double)t);
  for (PetscInt k = 0; k < g->kind.series; k++) fprintf(f, " %llu", H5FramePlace(&g->file, g->kind.path[k], entry));
  fprintf(f, "\n");
}

/* The index of the first `count` entries, to go on with. */
static PetscErrorCode OpenIndex(Growing *g, PetscInt count) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(Path(g, ".index", path));
  PetscCall(Path(g, ".index.tmp", temporary));
  if (!g->folder->rank) {
    g->index = FileNew(temporary);
    for (PetscInt t = 0; t < count && g->index; t++) PrintEntry(g, g->index, t, g->time[t]);
    done = g->index && !fflush(g->index) && !ferror(g->index) ? PETSC_TRUE : PETSC_FALSE;
    if (done) done = g->file.failed ? !unlink(temporary) : !rename(temporary, path);
  }
  PetscCall(FolderCheck(g->folder, done, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stop every rank when the file could not be written. It is closed at once: HDF5 crashes at the program's end where a
   file is open that it cannot write. */
static PetscErrorCode Check(Growing *g) {
  PetscFunctionBeginUser;
  if (g->file.failed) PetscCall(H5FileClose(&g->file));
  PetscCall(FolderCheck(g->folder, !g->file.failed, g->file.path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GrowingCreate(Growing *g, Folder *folder, const GrowingKind *kind) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  g->folder = folder;
  g->kind = *kind;
  PetscCall(FolderPath(folder, kind->name, path));
  PetscCall(kind->create(kind->scheme, path, &g->file));
  g->open = PETSC_TRUE;
  PetscCall(Check(g));
  FolderWatch(folder, kind->name);
  PetscCall(OpenIndex(g, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One line of the index; room for all its places. */
static PetscBool ReadPlaces(FILE *index, PetscInt n, PetscInt *entry, PetscReal *t, unsigned long long place[]) {
  char line[32 * (GROWING_SERIES + 2)], *p = line;
  if (!fgets(line, sizeof(line), index) || !strchr(line, '\n')) return PETSC_FALSE;
  *entry = (PetscInt)strtol(p, &p, 10);
  *t = strtod(p, &p);
  for (PetscInt k = 0; k < n; k++) {
    char *end;
    place[k] = strtoull(p, &end, 10);
    if (end == p || !place[k]) return PETSC_FALSE;
    p = end;
  }
  return PETSC_TRUE;
}

/* Entry of series k at its place in the old file. */
static PetscBool ReadEntry(const GrowingKind *kind, int old, PetscInt k, off_t place, PetscReal values[]) {
  const PetscInt n = kind->entries[k];
  const size_t bytes = (size_t)n * (kind->single[k] ? sizeof(float) : sizeof(*values));
  if (pread(old, values, bytes, place) != (ssize_t)bytes) return PETSC_FALSE;
  for (PetscInt i = n - 1; i >= 0 && kind->single[k]; i--) { /* from behind, where there is room */
    float x;
    memcpy(&x, (const char *)values + (size_t)i * sizeof(x), sizeof(x));
    values[i] = x;
  }
  return PETSC_TRUE;
}

/* Copy the first `most` entries into the new file `f`; the number that could be read. An entry may have several lines,
   where a run went on after its end: the last one holds. Rank 0's. */
static PetscErrorCode CopyEntries(const GrowingKind *kind, PetscInt most, FILE *index, int old, H5File *f,
                                  PetscInt *copied) {
  PetscReal *values, t;
  PetscInt room = 0, entry;
  unsigned long long place[GROWING_SERIES];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < kind->series; k++) room = PetscMax(room, kind->entries[k]);
  PetscCall(PetscMalloc1(room, &values));
  *copied = 0;
  while (ReadPlaces(index, kind->series, &entry, &t, place) && entry <= *copied) {
    PetscBool good = PETSC_TRUE;
    if (entry >= most) continue;
    for (PetscInt k = 0; good && k < kind->series; k++) {
      good = ReadEntry(kind, old, k, (off_t)place[k], values);
      if (good) PetscCall(H5WriteArray(f, kind->path[k], entry, kind->entries[k], values));
    }
    if (!good) break;
    PetscCall(H5WriteArray(f, "/time", entry, 1, &t));
    *copied = entry + 1;
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run.h5.new is whole when it has that name; the index, which is of the old run.h5, goes before it. */
static PetscBool TakeNew(const char fresh[], const char index[], const char path[]) {
  return !access(fresh, F_OK) && (!unlink(index) || errno == ENOENT) && !rename(fresh, path) ? PETSC_TRUE : PETSC_FALSE;
}

/* Where a run was killed (its index is there): the file anew, of its first `most` entries, or with PETSC_MAX_INT of
   those that can be read. Entries that cannot be read leave the file as it is. */
static PetscErrorCode Repair(Growing *g, PetscInt most) {
  char path[PETSC_MAX_PATH_LEN], index[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN], fresh[PETSC_MAX_PATH_LEN];
  FILE *lines = NULL;
  H5File f;
  PetscInt copied = 0;
  int old = -1;
  PetscMPIInt here = 0;
  PetscFunctionBeginUser;
  PetscCall(Path(g, "", path));
  PetscCall(Path(g, ".index", index));
  PetscCall(Path(g, ".tmp", part));
  PetscCall(Path(g, ".new", fresh));
  if (!g->folder->rank && !TakeNew(fresh, index, path)) {
    lines = fopen(index, "r");
    old = lines ? open(path, O_RDONLY) : -1;
    here = old >= 0;
  }
  PetscCallMPI(MPI_Bcast(&here, 1, MPI_INT, 0, g->folder->comm));
  if (here) {
    PetscCall(g->kind.create(g->kind.scheme, part, &f));
    if (!g->folder->rank) PetscCall(CopyEntries(&g->kind, most, lines, old, &f, &copied));
    PetscCall(H5FileClose(&f));
    if (!g->folder->rank && (copied == most || most == PETSC_MAX_INT) && !f.failed &&
        (FileSync(part) || rename(part, fresh) || !TakeNew(fresh, index, path)))
      f.failed = PETSC_TRUE;
    if (!g->folder->rank) (void)unlink(part);
  }
  if (lines) (void)fclose(lines);
  if (old >= 0) (void)close(old);
  if (here) PetscCall(FolderCheck(g->folder, !f.failed, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GrowingOpen(Growing *g, Folder *folder, const GrowingKind *kind, PetscInt most, PetscInt *length) {
  char path[PETSC_MAX_PATH_LEN];
  PetscBool failed;
  PetscFunctionBeginUser;
  g->folder = folder;
  g->kind = *kind;
  PetscCall(FolderPath(folder, kind->name, path));
  PetscCall(Repair(g, most));
  PetscCall(H5FileOpen(folder->comm, path, PETSC_TRUE, &g->file));
  g->open = PETSC_TRUE;
  PetscCall(H5SeriesLength(&g->file, "/time", length));
  PetscCall(H5FileFailed(&g->file, &failed));
  if (failed) *length = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Drop the entries from `count` on. */
static PetscErrorCode Cut(Growing *g, const char what[], const char restart[]) {
  H5File *file = &g->file;
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5TruncateSeries(file, "/time", g->count)); /* the readers' count of entries goes first */
  PetscCall(H5FileFlush(file));
  for (PetscInt k = 0; k < g->kind.series; k++) PetscCall(H5TruncateSeries(file, g->kind.path[k], g->count));
  PetscCall(H5FileFlush(file));
  PetscCall(H5FileFailed(file, &failed));
  if (failed) PetscCall(H5FileClose(file));
  PetvesCheck(!failed, file->comm,
              "-restart %s: %s cannot be cut to the %" PetscInt_FMT
              " readable %s that the checkpoint counts; allowed: %s as the run left it, or a new -output_dir",
              restart, file->path, g->count, what, g->kind.name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GrowingGoOn(Growing *g, PetscInt length, PetscInt count, const char what[], const char restart[]) {
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5FileFailed(&g->file, &failed));
  PetvesCheck(!failed && length >= count, g->folder->comm,
              "-restart %s: %s has %" PetscInt_FMT " readable %s, the checkpoint counts %" PetscInt_FMT
              "; allowed: %s as the run left it, or a new -output_dir",
              restart, g->file.path, length, what, count, g->kind.name);
  g->count = count;
  PetscCall(PetscMalloc1(count, &g->time));
  for (PetscInt t = 0; t < count; t++) PetscCall(H5ReadArray(&g->file, "/time", t, 1, &g->time[t]));
  PetscCall(OpenIndex(g, count)); /* before anything is changed */
  PetscCall(Cut(g, what, restart));
  FolderWatch(g->folder, g->kind.name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GrowingAppend(Growing *g, PetscReal t) {
  PetscFunctionBeginUser;
  if (g->index) PrintEntry(g, g->index, g->count, t);
  PetscCall(H5WriteArray(&g->file, "/time", g->count, 1, &t));
  PetscCall(Check(g));
  g->count++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GrowingFlush(Growing *g, PetscBool sync) {
  PetscBool done = PETSC_TRUE;
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  if (g->index) done = !fflush(g->index) && !ferror(g->index) ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(Path(g, ".index", path));
  PetscCall(FolderCheck(g->folder, done, path));
  PetscCall(H5FileFlush(&g->file));
  if (sync && !g->folder->rank && (FileSync(g->file.path) || (g->index && fsync(fileno(g->index)))))
    g->file.failed = PETSC_TRUE;
  PetscCall(Check(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GrowingClose(Growing *g, PetscBool *good) {
  const PetscBool known = g->open ? g->file.failed : PETSC_FALSE; /* said when it was found */
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  *good = PETSC_TRUE;
  if (g->open) {
    PetscCall(H5FileClose(&g->file));
    if (g->index) (void)fclose(g->index); /* it is of use only to a run that is killed before this */
    PetscCall(Path(g, ".index", path));
    if (g->index && !g->file.failed && !g->folder->failed) (void)unlink(path);
    *good = !g->file.failed || known ? PETSC_TRUE : PETSC_FALSE;
  }
  g->index = NULL;
  g->open = PETSC_FALSE;
  PetscCall(PetscFree(g->time));
  PetscFunctionReturn(PETSC_SUCCESS);
}
