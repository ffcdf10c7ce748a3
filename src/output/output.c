#include "output/output.h"
#include <ctype.h>
#include <errno.h>
#include <sys/stat.h>

PetscErrorCode OutputPath(Output o, const char file[], char path[PETSC_MAX_PATH_LEN]) {
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/%s", o->folder, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCheckFile(Output o, FILE *f, const char path[]) {
  PetscMPIInt failed = 0;
  PetscFunctionBeginUser;
  if (!o->rank) failed = !f || fclose(f);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_USER_INPUT,
             "%s: cannot be written; allowed: a folder with space that can be written", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mkdir -p on rank 0. */
static PetscErrorCode MakeFolder(Output o) {
  PetscMPIInt error = 0;
  PetscFunctionBeginUser;
  if (!o->rank) {
    char part[PETSC_MAX_PATH_LEN];
    struct stat what;
    PetscCall(PetscStrncpy(part, o->folder, sizeof(part)));
    for (char *p = part + 1; *p; p++)
      if (*p == '/') {
        *p = 0;
        (void)mkdir(part, 0777);
        *p = '/';
      }
    if (mkdir(part, 0777) && errno != EEXIST)
      error = errno;
    else if (stat(part, &what) || !S_ISDIR(what.st_mode))
      error = ENOTDIR;
  }
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, o->comm));
  PetscCheck(!error, o->comm, PETSC_ERR_USER_INPUT,
             "-output_dir %s: cannot be made (%s); allowed: a folder that can be written", o->folder, strerror(error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCreate(Scene scene, Scheme scheme, Output *out) {
  Output o;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  *out = o;
  o->comm = scene->comm;
  o->scene = scene;
  o->scheme = scheme;
  o->fields = -1;
  PetscCallMPI(MPI_Comm_rank(o->comm, &o->rank));
  PetscCall(PetscStrncpy(o->folder, scene->output_dir, sizeof(o->folder)));
  PetscCall(MakeFolder(o));
  PetscCall(SeriesCreate(o));
  PetscCall(FieldsCreate(o));
  PetscCall(OutputResolvedOptions(o));
  PetscCall(PetscTime(&o->start));
  o->printed = o->start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDestroy(Output *output) {
  Output o = *output;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->series) fclose(o->series);
  if (o->fields >= 0) {
    char path[PETSC_MAX_PATH_LEN];
    PetscCall(OutputPath(o, "run.h5", path));
    PetscCall(H5Close(o->comm, path, &o->fields));
  }
  PetscCall(PetscFree(o->times));
  PetscCall(PetscFree(o->cells));
  PetscCall(PetscFree(o->each));
  PetscCall(PetscFree(*output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether resolved.opts has an option of the database already, or must not have it. */
static PetscBool Skip(const char *name) {
  const char *const never[] = {"-options_file", "-help", "-restart"};
  for (size_t i = 0; i < sizeof(never) / sizeof(never[0]); i++)
    if (!strcmp(name, never[i])) return PETSC_TRUE;
  for (PetscInt i = 0; SceneOptionName(i); i++)
    if (!strcmp(name, SceneOptionName(i))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The options of PETSc's own that the user gave: -tension_ksp_monitor, -log_view and so on. */
static PetscErrorCode WriteOthers(FILE *f) {
  char *all, *word, *end = NULL;
  PetscBool keep = PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (word = strtok_r(all, " \n", &end); word; word = strtok_r(NULL, " \n", &end)) {
    if (word[0] == '-' && isalpha((unsigned char)word[1])) {
      if (keep) fprintf(f, "\n");
      keep = Skip(word) ? PETSC_FALSE : PETSC_TRUE;
      if (keep) fprintf(f, "%s", word);
    } else if (keep)
      fprintf(f, " %s", word);
  }
  if (keep) fprintf(f, "\n");
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteResolved(Output o, FILE *f) {
  PetscFunctionBeginUser;
  fprintf(f, "# every option in force: mpirun -n RANKS petves -options_file resolved.opts repeats the run\n");
  PetscCall(SceneWriteOptions(o->scene, f));
  if (o->scheme->options) PetscCall(o->scheme->options(o->scheme, f));
  PetscCall(WriteOthers(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputResolvedOptions(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  FILE *f = NULL;
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "resolved.opts", path));
  if (!o->rank) f = fopen(path, "w");
  if (f) PetscCall(WriteResolved(o, f));
  PetscCall(OutputCheckFile(o, f, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}
