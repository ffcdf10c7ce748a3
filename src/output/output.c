#include "output/output.h"
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

PetscReal OutputNextTime(Output o) {
  const State *q = &o->scheme->state;
  const PetscReal every = o->scene->output.every;
  return every * (PetscFloorReal((q->t + 1e-9 * q->dt) / every) + 1);
}

PetscErrorCode OutputPath(Output o, const char file[], char path[PETSC_MAX_PATH_LEN]) {
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/%s", o->folder, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCheck(Output o, PetscBool written, const char path[]) {
  PetscMPIInt failed = !o->rank && !written;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_USER_INPUT,
             "%s: cannot be written; allowed: a folder with space that can be written", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int OutputSync(const char path[]) {
  const int fd = open(path, O_RDONLY), failed = fd < 0 || fsync(fd);
  return (fd >= 0 && close(fd)) || failed;
}

PetscErrorCode OutputWriteText(Output o, const char file[], PetscErrorCode (*write)(Output, FILE *)) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN], name[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.tmp", file));
  PetscCall(OutputPath(o, file, path));
  PetscCall(OutputPath(o, name, temporary));
  if (!o->rank) {
    FILE *f = fopen(temporary, "w");
    if (f) PetscCall(write(o, f));
    done = f && !ferror(f) ? PETSC_TRUE : PETSC_FALSE;
    if (f && fclose(f)) done = PETSC_FALSE;
    if (done && rename(temporary, path)) done = PETSC_FALSE;
    if (f && !done) (void)unlink(temporary);
  }
  PetscCall(OutputCheck(o, done, path));
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

/* Whether -restart's checkpoint lies in the folder of the output, on rank 0. */
static PetscBool RestartsHere(Output o) {
  char folder[PETSC_MAX_PATH_LEN], *slash;
  struct stat here, there;
  if (!*o->scene->output.restart) return PETSC_FALSE;
  (void)PetscStrncpy(folder, o->scene->output.restart, sizeof(folder));
  slash = strrchr(folder, '/');
  if (slash) slash[slash == folder] = 0;
  if (stat(slash ? folder : ".", &there) || stat(o->folder, &here)) return PETSC_FALSE;
  return here.st_dev == there.st_dev && here.st_ino == there.st_ino ? PETSC_TRUE : PETSC_FALSE;
}

/* Refuse to write over another run's results. */
static PetscErrorCode ClaimFolder(Output o) {
  const char *const results[] = {"series.csv", "run.h5", "checkpoint.h5"};
  char path[PETSC_MAX_PATH_LEN], found[64] = "";
  PetscMPIInt here = 0;
  PetscFunctionBeginUser;
  if (!o->rank) {
    here = RestartsHere(o);
    for (int k = 0; k < 3 && !here && !o->scene->output.overwrite; k++) {
      PetscCall(OutputPath(o, results[k], path));
      if (!access(path, F_OK)) PetscCall(PetscStrncpy(found, results[k], sizeof(found)));
    }
  }
  PetscCallMPI(MPI_Bcast(&here, 1, MPI_INT, 0, o->comm));
  PetscCallMPI(MPI_Bcast(found, sizeof(found), MPI_CHAR, 0, o->comm));
  o->go_on = here ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(!*found, o->comm, PETSC_ERR_USER_INPUT,
             "-output_dir %s: holds %s of another run; allowed: a new folder, -output_overwrite to replace what is "
             "there, or -restart %s/checkpoint.h5 to go on",
             o->folder, found, o->folder);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Remove what would be taken for this run's: the summary, and checkpoints of a run that is written over. */
static PetscErrorCode ClearFolder(Output o) {
  char path[PETSC_MAX_PATH_LEN], old[64] = "checkpoint.h5";
  PetscFunctionBeginUser;
  if (o->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OutputPath(o, "summary.json", path));
  (void)unlink(path);
  PetscCall(OutputPath(o, "run.h5.new", path));
  if (!o->go_on) (void)unlink(path);
  for (PetscInt k = 1; !o->go_on && k < 100; k++) {
    PetscCall(OutputPath(o, old, path));
    (void)unlink(path);
    PetscCall(PetscSNPrintf(old, sizeof(old), "checkpoint_%" PetscInt_FMT ".h5", k));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteResolved(Output o, FILE *f);

PetscErrorCode OutputCreate(Scene scene, Scheme scheme, Output *out) {
  Output o;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  *out = o;
  o->comm = scene->comm;
  o->scene = scene;
  o->scheme = scheme;
  o->saved_step = -1;
  PetscCallMPI(MPI_Comm_rank(o->comm, &o->rank));
  PetscCall(PetscStrncpy(o->folder, scene->output.dir, sizeof(o->folder)));
  if (*scene->output.restart) PetscCall(RestartRead(o));
  PetscCall(MakeFolder(o));
  PetscCall(ClaimFolder(o));
  if (!o->go_on) o->scheduled = 0;
  PetscCall(SeriesPrepare(o));
  PetscCall(ClearFolder(o));
  PetscCall(FieldsCreate(o));
  PetscCall(SeriesOpen(o));
  if (o->go_on) PetscCall(CheckpointAdopt(o));
  PetscCall(OutputWriteText(o, "resolved.opts", WriteResolved));
  PetscCall(PetscTime(&o->start));
  o->printed = o->start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDestroy(Output *output) {
  Output o = *output;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->series) {
    char path[PETSC_MAX_PATH_LEN];
    const PetscBool closed = !fclose(o->series) ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(OutputPath(o, "series.csv", path));
    PetscCheck(closed, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: cannot be written; allowed: a folder with space that can be written", path);
  }
  if (o->fields_open) {
    PetscCall(H5FileClose(&o->fields));
    PetscCall(FramesClose(o, o->fields.failed ? PETSC_FALSE : PETSC_TRUE));
    PetscCall(H5FileCheck(&o->fields));
  }
  PetscCall(PetscFree(o->times));
  PetscCall(PetscFree(o->cells));
  PetscCall(PetscFree(o->each));
  PetscCall(PetscFree(o->row));
  PetscCall(PetscFree(*output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether resolved.opts has an option of the database already, or must not have it. */
static PetscBool Skip(const char *name) {
  const char *const never[] = {"-options_file", "-help"};
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
