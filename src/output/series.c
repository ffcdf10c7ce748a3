#include "output/series.h"
#include "output/lock.h"
#include <stdlib.h>
#include <unistd.h>

#define NAME "series.csv"
#define TEMPORARY "series.csv.tmp"

PetscErrorCode SeriesPrepare(Series *s, Folder *folder, const char header[], const char row[]) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscBool written = PETSC_TRUE;
  PetscFunctionBeginUser;
  s->folder = folder;
  PetscCall(FolderPath(folder, NAME, path));
  PetscCall(FolderPath(folder, TEMPORARY, temporary));
  if (!folder->rank) {
    FILE *f = FileNew(temporary);
    if (f) fprintf(f, *row ? "%s\n%s\n" : "%s\n", header, row);
    written = f && !fclose(f) ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(FolderCheck(folder, written, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file up to the row of `step`, under the temporary name; what is wrong with it, or "". */
static const char *CopyRows(const char path[], const char temporary[], const char header[], PetscInt step) {
  FILE *in = fopen(path, "r"), *out = in ? FileNew(temporary) : NULL;
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
  if (!wrong && FileSync(temporary)) wrong = "cannot be written";
  if (wrong) (void)unlink(temporary);
  return wrong ? wrong : "";
}

PetscErrorCode SeriesCut(Series *s, Folder *folder, const char header[], PetscInt step, const char restart[]) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN], wrong[64] = "";
  PetscFunctionBeginUser;
  s->folder = folder;
  PetscCall(FolderPath(folder, NAME, path));
  PetscCall(FolderPath(folder, TEMPORARY, temporary));
  if (!folder->rank) PetscCall(PetscStrncpy(wrong, CopyRows(path, temporary, header, step), sizeof(wrong)));
  PetscCallMPI(MPI_Bcast(wrong, sizeof(wrong), MPI_CHAR, 0, folder->comm));
  PetvesCheck(!*wrong, folder->comm,
              "-restart %s: %s %s (step %" PetscInt_FMT "); allowed: the file as the run left it, or a new -output_dir",
              restart, path, wrong, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesOpen(Series *s) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(FolderPath(s->folder, NAME, path));
  PetscCall(FolderPath(s->folder, TEMPORARY, temporary));
  if (!s->folder->rank && !rename(temporary, path)) s->file = fopen(path, "a");
  PetscCall(FolderCheck(s->folder, s->file ? PETSC_TRUE : PETSC_FALSE, path));
  if (s->file) (void)setvbuf(s->file, NULL, _IOLBF, 0); /* each row at once */
  FolderWatch(s->folder, NAME);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesWrite(Series *s, const char row[]) {
  PetscFunctionBeginUser;
  if (s->file) fprintf(s->file, "%s\n", row);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesFlush(Series *s, PetscBool sync) {
  char path[PETSC_MAX_PATH_LEN];
  PetscBool good = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(FolderPath(s->folder, NAME, path));
  if (s->file) good = !fflush(s->file) && !ferror(s->file) && !(sync && fsync(fileno(s->file)));
  PetscCall(FolderCheck(s->folder, good, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesClose(Series *s, PetscBool *good) {
  FILE *file = s->file;
  const int lost = file && ferror(file); /* a row */
  PetscFunctionBeginUser;
  s->file = NULL; /* also when closing it fails: it is gone then */
  *good = !file || (!fclose(file) && !lost) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
