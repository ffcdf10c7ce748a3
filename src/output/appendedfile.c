#include "output/appendedfile.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

/* Numbers in an entry of series k. */
static PetscInt EntrySize(const AppendedKind *kind, PetscInt k) {
  return PetscMax(1, kind->series[k].rows) * kind->series[k].columns;
}

/* Path of the file with an ending behind its name. */
static void AppendedPath(const AppendedFile *a, const char ending[], char path[PETSC_MAX_PATH_LEN]) {
  (void)PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/%s%s", a->folder->path, a->kind.name, ending);
}

/* Write the line of an entry. */
static void IndexPrint(AppendedFile *a, PetscInt entry, PetscReal t) {
  fprintf(a->index, "%d %.17g", (int)entry, (double)t);
  for (PetscInt k = 0; k < a->kind.n; k++)
    fprintf(a->index, " %llu", H5EntryPlace(&a->file, a->kind.series[k].path, entry));
  fprintf(a->index, "\n");
}

/* Make the index of the entries that there are, to which further lines are added. */
static PetscErrorCode IndexOpen(AppendedFile *a) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  AppendedPath(a, ".index", path);
  AppendedPath(a, ".index.tmp", temporary);
  if (!a->folder->rank) {
    a->index = FileNew(temporary);
    for (PetscInt t = 0; t < a->count && a->index; t++) IndexPrint(a, t, a->time[t]);
    done = a->index && !fflush(a->index) && !ferror(a->index);
    if (done) done = a->file.failed ? !unlink(temporary) : !rename(temporary, path);
  }
  PetscCall(FolderCheck(a->folder, done, a->index_name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stop every rank when the file could not be written. The file is closed at once: HDF5 crashes at the program's end
   where a file is open that it cannot write. */
static PetscErrorCode AppendedCheck(AppendedFile *a) {
  PetscFunctionBeginUser;
  if (a->file.failed) H5FileClose(&a->file);
  PetscCall(FolderCheck(a->folder, !a->file.failed, a->kind.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A file without entries. */
static PetscErrorCode AppendedMake(const AppendedKind *kind, MPI_Comm comm, const char path[], H5File *f) {
  PetscFunctionBeginUser;
  PetscCall(H5FileOpen(comm, path, H5_NEW, f));
  PetscCall(kind->describe(kind->context, f));
  H5CreateSeries(f, "/time", PETSC_FALSE, 0, NULL);
  H5PutUnit(f, "/time", "time");
  for (PetscInt k = 0; k < kind->n; k++) {
    const AppendedSeries *s = &kind->series[k];
    H5CreateSeries(f, s->path, s->single, !s->rows ? 0 : (s->columns > 1 ? 2 : 1), &s->rows);
    if (s->unit) H5PutUnit(f, s->path, s->unit);
  }
  H5FileFlush(f);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read one line of the index with n places; false when it is not whole. */
static PetscBool IndexRead(FILE *index, PetscInt n, PetscInt *entry, PetscReal *t, unsigned long long place[]) {
  char line[32 * (APPENDED_SERIES + 2)], *p = line;
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

/* Copy the first `most` entries into the new file `f`, on rank 0; copied: the number of entries that could be read. An
   entry may have several lines, where a run went on after its end: the last line counts. */
static PetscErrorCode EntriesCopy(const AppendedKind *kind, PetscInt most, FILE *index, int old, H5File *f,
                                  PetscInt *copied) {
  PetscReal *values, t;
  PetscInt largest = 0, entry;
  unsigned long long place[APPENDED_SERIES];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < kind->n; k++) largest = PetscMax(largest, EntrySize(kind, k));
  PetscCall(PetscMalloc1(largest, &values));
  *copied = 0;
  while (IndexRead(index, kind->n, &entry, &t, place) && entry <= *copied) {
    PetscBool good = PETSC_TRUE;
    if (entry >= most) continue;
    for (PetscInt k = 0; good && k < kind->n; k++) {
      const PetscInt n = EntrySize(kind, k);
      const size_t bytes = (size_t)n * (kind->series[k].single ? sizeof(float) : sizeof(*values));
      good = pread(old, values, bytes, (off_t)place[k]) == (ssize_t)bytes;
      if (good && kind->series[k].single)
        good = H5Tconvert(H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE, (size_t)n, values, NULL, H5P_DEFAULT) >= 0;
      if (good) H5Transfer(f, PETSC_TRUE, kind->series[k].path, entry, n, values);
    }
    if (!good) break;
    H5Transfer(f, PETSC_TRUE, "/time", entry, 1, &t);
    *copied = entry + 1;
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Give the file run.h5.new, which is whole when it has that name, the name run.h5. The index, which is of the old
   run.h5, goes first. */
static PetscBool AppendedTakeNew(const char fresh[], const char index[], const char path[]) {
  return !access(fresh, F_OK) && (!unlink(index) || errno == ENOENT) && !rename(fresh, path);
}

/* Make the file anew of its first `count` entries where there is an index. If fewer can be read the file stays as it
   is. */
static PetscErrorCode AppendedRepair(AppendedFile *a, PetscInt count) {
  char path[PETSC_MAX_PATH_LEN], index[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN], fresh[PETSC_MAX_PATH_LEN];
  FILE *lines = NULL;
  H5File f;
  PetscInt copied = 0;
  int old = -1;
  PetscMPIInt here = 0;
  PetscFunctionBeginUser;
  AppendedPath(a, "", path);
  AppendedPath(a, ".index", index);
  AppendedPath(a, ".tmp", part);
  AppendedPath(a, ".new", fresh);
  if (!a->folder->rank && !AppendedTakeNew(fresh, index, path)) {
    lines = fopen(index, "r");
    old = lines ? open(path, O_RDONLY) : -1;
    here = old >= 0;
  }
  PetscCallMPI(MPI_Bcast(&here, 1, MPI_INT, 0, a->folder->comm));
  if (here) {
    PetscCall(AppendedMake(&a->kind, a->folder->comm, part, &f));
    if (!a->folder->rank) PetscCall(EntriesCopy(&a->kind, count, lines, old, &f, &copied));
    H5FileClose(&f);
    if (!a->folder->rank && copied == count && !f.failed &&
        (FileSync(part) || rename(part, fresh) || !AppendedTakeNew(fresh, index, path)))
      f.failed = PETSC_TRUE;
    if (!a->folder->rank) (void)unlink(part);
  }
  if (lines) (void)fclose(lines);
  if (old >= 0) (void)close(old);
  if (here) PetscCall(FolderCheck(a->folder, !f.failed, strrchr(part, '/') + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Remove the entries from a->count on. */
static PetscErrorCode AppendedCut(AppendedFile *a, const char restart[]) {
  H5File *file = &a->file;
  PetscBool failed;
  PetscFunctionBeginUser;
  H5TruncateSeries(file, "/time", a->count); /* readers count entries by their times */
  H5FileFlush(file);
  for (PetscInt k = 0; k < a->kind.n; k++) H5TruncateSeries(file, a->kind.series[k].path, a->count);
  H5FileFlush(file);
  PetscCall(H5FileFailed(file, &failed));
  if (failed) H5FileClose(file);
  PetvesCheck(!failed, file->comm,
              "-restart %s: %s cannot be cut to the %" PetscInt_FMT
              " readable %s that the checkpoint counts; allowed: %s as the run left it, or a new -output_dir",
              restart, file->path, a->count, a->kind.entries, a->kind.name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Open the file of an earlier run and find its first `count` entries, none of them after the present time. */
static PetscErrorCode AppendedFind(AppendedFile *a, const char path[], PetscInt count, const char restart[]) {
  PetscInt length;
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(AppendedRepair(a, count));
  PetscCall(H5FileOpen(a->folder->comm, path, H5_WRITE, &a->file));
  a->open = PETSC_TRUE;
  PetscCall(H5SeriesLength(&a->file, "/time", &length));
  PetscCall(H5FileFailed(&a->file, &failed));
  PetscCall(PetscMalloc1(count, &a->time));
  for (; !failed && a->count < PetscMin(length, count); a->count++) {
    PetscCall(H5ReadArray(&a->file, "/time", a->count, 1, &a->time[a->count]));
    if (a->time[a->count] > a->kind.now) break;
  }
  PetscCall(H5FileFailed(&a->file, &failed));
  PetvesCheck(!failed && a->count == count, a->folder->comm,
              "-restart %s: %s has %" PetscInt_FMT " readable %s, the checkpoint counts %" PetscInt_FMT
              "; allowed: %s as the run left it, or a new -output_dir",
              restart, path, a->count, a->kind.entries, count, a->kind.name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppendedOpen(AppendedFile *a, Folder *folder, const AppendedKind *kind, PetscInt count,
                            const char restart[]) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  a->folder = folder;
  a->kind = *kind;
  (void)PetscSNPrintf(a->index_name, sizeof(a->index_name), "%s.index", kind->name);
  FolderPath(folder, kind->name, path);
  if (count == APPENDED_NEW) {
    PetscCall(AppendedMake(kind, folder->comm, path, &a->file));
    a->open = PETSC_TRUE;
    PetscCall(AppendedCheck(a));
  } else
    PetscCall(AppendedFind(a, path, count, restart));
  PetscCall(IndexOpen(a)); /* before anything in the file is changed */
  if (count != APPENDED_NEW) PetscCall(AppendedCut(a, restart));
  FolderWatch(folder, kind->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AppendedSet(AppendedFile *a, PetscInt k, PetscReal values[]) {
  H5Transfer(&a->file, PETSC_TRUE, a->kind.series[k].path, a->count, EntrySize(&a->kind, k), values);
}

PetscErrorCode AppendedAdd(AppendedFile *a, PetscReal t) {
  PetscFunctionBeginUser;
  if (a->index) IndexPrint(a, a->count, t);
  H5Transfer(&a->file, PETSC_TRUE, "/time", a->count, 1, &t);
  PetscCall(AppendedCheck(a));
  a->count++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppendedFlush(AppendedFile *a, PetscBool sync) {
  PetscFunctionBeginUser;
  if (!a->open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FolderCheck(a->folder, !a->index || (!fflush(a->index) && !ferror(a->index)), a->index_name));
  H5FileFlush(&a->file);
  if (sync && a->index && (FileSync(a->file.path) || fsync(fileno(a->index)))) a->file.failed = PETSC_TRUE;
  PetscCall(AppendedCheck(a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppendedClose(AppendedFile *a, PetscBool *good) {
  const PetscBool known = a->open ? a->file.failed : PETSC_FALSE; /* a line has said so */
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  *good = PETSC_TRUE;
  if (a->open) {
    H5FileClose(&a->file);
    AppendedPath(a, ".index", path);
    if (a->index) (void)fclose(a->index);
    if (a->index && !a->file.failed && !a->folder->failed) (void)unlink(path);
    *good = !a->file.failed || known;
  }
  a->index = NULL;
  a->open = PETSC_FALSE;
  PetscCall(PetscFree(a->time));
  PetscFunctionReturn(PETSC_SUCCESS);
}
