#include "output/series.h"
#include <stdlib.h>
#include <unistd.h>

#define SERIES "series.csv"
#define SERIES_TEMPORARY "series.csv.tmp"

/* Copy the file up to the row of `step` to the temporary name and count the rows; what is wrong with the file, or "".
 */
static const char *SeriesCopyRows(const char path[], const char temporary[], const char header[], PetscInt step,
                                  PetscInt *rows) {
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
    if (n && !wrong) last = (PetscInt)atol(line);
    *rows = n;
  }
  free(line);
  if (in) fclose(in);
  if (out && fclose(out) && !wrong) wrong = "cannot be written";
  if (!wrong && FileSync(temporary)) wrong = "cannot be written";
  if (wrong) (void)unlink(temporary);
  return wrong ? wrong : "";
}

PetscErrorCode SeriesCut(Series *s, Folder *folder, const char header[], PetscInt step, const char restart[],
                         PetscInt *rows) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN], wrong[64] = "";
  PetscFunctionBeginUser;
  s->cut = PETSC_TRUE;
  FolderPath(folder, SERIES, path);
  FolderPath(folder, SERIES_TEMPORARY, temporary);
  if (!folder->rank) PetscCall(PetscStrncpy(wrong, SeriesCopyRows(path, temporary, header, step, rows), sizeof(wrong)));
  PetscCallMPI(MPI_Bcast(wrong, sizeof(wrong), MPI_CHAR, 0, folder->comm));
  PetscCallMPI(MPI_Bcast(rows, 1, MPIU_INT, 0, folder->comm));
  PetvesCheck(!*wrong, folder->comm,
              "-restart %s: %s %s (step %" PetscInt_FMT "); allowed: the file as the run left it, or a new -output_dir",
              restart, path, wrong, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SeriesPrintFirst(FILE *file, const void *lines) {
  const char *const *line = lines;
  fprintf(file, *line[1] ? "%s\n%s\n" : "%s\n", line[0], line[1]);
  return PETSC_SUCCESS;
}

PetscErrorCode SeriesOpen(Series *s, Folder *folder, const char header[], const char row[]) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  s->folder = folder;
  if (!s->cut) PetscCall(FolderWriteText(folder, SERIES, SeriesPrintFirst, (const char *[]){header, row}));
  FolderPath(folder, SERIES, path);
  FolderPath(folder, SERIES_TEMPORARY, temporary);
  if (!folder->rank && (!s->cut || !rename(temporary, path))) s->file = fopen(path, "a");
  PetscCall(FolderCheck(folder, folder->rank || s->file, SERIES));
  if (s->file) (void)setvbuf(s->file, NULL, _IOLBF, 0); /* each row at once */
  FolderWatch(folder, SERIES);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SeriesWrite(Series *s, const char row[]) {
  if (s->file) fprintf(s->file, "%s\n", row);
}

PetscErrorCode SeriesFlush(Series *s, PetscBool sync) {
  PetscBool good = PETSC_TRUE;
  PetscFunctionBeginUser;
  if (s->file) good = !fflush(s->file) && !ferror(s->file) && !(sync && fsync(fileno(s->file)));
  PetscCall(FolderCheck(s->folder, good, SERIES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SeriesClose(Series *s) {
  FILE *file = s->file;
  const int lost = file && ferror(file); /* a row is lost */
  s->file = NULL;
  return !file || (!fclose(file) && !lost);
}
