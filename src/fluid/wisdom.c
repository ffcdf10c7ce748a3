#include "fluid/wisdom.h"
#include <errno.h>
#include <fftw3-mpi.h>
#include <unistd.h>

static PetscErrorCode CleanUpFFTW(void) {
  fftw_mpi_cleanup();
  return PETSC_SUCCESS;
}

PetscErrorCode WisdomInitialise(void) {
  static PetscBool done = PETSC_FALSE;
  PetscFunctionBeginUser;
  if (!done) {
    fftw_mpi_init();
    PetscCall(PetscRegisterFinalize(CleanUpFFTW));
    done = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file's text, to be freed; NULL where it cannot be read or, with `missing`, where there is no file. */
static char *ReadText(const char path[], PetscBool *missing) {
  FILE *f = FileOpen(path);
  char *text = NULL;
  size_t used = 0, room = 0, n = 1;
  *missing = !f && errno == ENOENT ? PETSC_TRUE : PETSC_FALSE;
  if (!f) return NULL;
  while (n > 0) {
    if (used + 1 >= room) {
      char *more = (char *)realloc(text, room = 2 * room + 65536);
      if (!more) break;
      text = more;
    }
    n = fread(text + used, 1, room - used - 1, f);
    used += n;
  }
  const PetscBool whole = n == 0 && !ferror(f) ? PETSC_TRUE : PETSC_FALSE;
  fclose(f);
  if (whole) {
    text[used] = 0;
    return text;
  }
  free(text);
  return NULL;
}

PetscErrorCode WisdomRead(MPI_Comm comm, const char path[]) {
  const char *wrong[] = {NULL, "not wisdom of this FFTW", "cannot be read"};
  PetscMPIInt rank, failed = 0;
  PetscFunctionBeginUser;
  if (!*path) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WisdomInitialise());
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) {
    PetscBool missing;
    char *text = ReadText(path, &missing);
    if (text)
      failed = fftw_import_wisdom_from_string(text) ? 0 : 1;
    else
      failed = missing ? 0 : 2;
    free(text);
  }
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCheck(!failed, comm, PETSC_ERR_USER_INPUT,
             "-fftw_wisdom %s: %s; allowed: a file that an earlier run wrote, or a new name", path, wrong[failed]);
  fftw_mpi_broadcast_wisdom(comm);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a line of `text` is missing in `file`. */
static PetscBool HasMore(const char *text, const char *file) {
  char line[1024];
  for (const char *p = text; *p;) {
    const size_t n = strcspn(p, "\n"), length = PetscMin(n, sizeof(line) - 1);
    memcpy(line, p, length);
    line[length] = 0;
    if (!strstr(file, line)) return PETSC_TRUE;
    p += n + (p[n] == '\n');
  }
  return PETSC_FALSE;
}

/* Rank 0's part of WisdomWrite; false when the file cannot be written. */
static PetscBool Save(const char path[]) {
  char temporary[PETSC_MAX_PATH_LEN + 32];
  PetscBool good = PETSC_TRUE, missing;
  char *file = ReadText(path, &missing), *text;
  if (file) (void)fftw_import_wisdom_from_string(file); /* another run may have added to it */
  text = fftw_export_wisdom_to_string();
  if (text && (!file || HasMore(text, file))) {
    snprintf(temporary, sizeof(temporary), "%s.%d.tmp", path, (int)getpid());
    FILE *f = FileNew(temporary);
    good = f && fputs(text, f) >= 0 ? PETSC_TRUE : PETSC_FALSE;
    if (f && fclose(f)) good = PETSC_FALSE;
    if (good && rename(temporary, path)) good = PETSC_FALSE;
    if (f && !good) (void)remove(temporary);
  }
  free(file);
  free(text);
  return good;
}

PetscErrorCode WisdomWrite(MPI_Comm comm, const char path[]) {
  PetscMPIInt rank, good = 1;
  PetscFunctionBeginUser;
  if (!*path) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  fftw_mpi_gather_wisdom(comm);
  if (!rank) good = Save(path);
  PetscCallMPI(MPI_Bcast(&good, 1, MPI_INT, 0, comm));
  PetscCheck(good, comm, PETSC_ERR_USER_INPUT,
             "-fftw_wisdom %s: cannot be written; allowed: a file in a folder that can be written", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
