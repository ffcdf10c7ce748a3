/* -restart: a checkpoint is checked, compared with the scene, and read into the model. */
#include "base/version.h"
#include "output/checkpoint.h"
#include <errno.h>
#include <unistd.h>

static PetscErrorCode RestartFormat(Scene scene) {
  H5File file;
  PetscInt format = 0;
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5FileOpen(scene->comm, scene->output.restart, H5_READ, &file));
  PetscCall(H5Get(&file, "format", H5_INT, 1, &format));
  PetscCall(H5FileFailed(&file, &failed));
  H5FileClose(&file);
  PetvesCheck(failed || format == CHECKPOINT_FORMAT, scene->comm,
              "-restart %s: its format is %" PetscInt_FMT "; allowed: %d, which petves %s writes",
              scene->output.restart, format, CHECKPOINT_FORMAT, PETVES_VERSION);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 finds what is wrong with the file as such and tells all ranks. The checksum covers every byte, so that HDF5
   reads what it wrote. A file without a checksum may be of another format. */
static PetscErrorCode RestartFile(Scene scene) {
  const char *path = scene->output.restart;
  char message[PETVES_MAX_MESSAGE] = "", tail[CHECKPOINT_TAIL_LENGTH + 1] = "";
  unsigned crc = 0, stored = 0;
  PetscMPIInt rank, sealed = 1;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(scene->comm, &rank));
  if (!rank && access(path, R_OK))
    PetscCall(PetscSNPrintf(message, sizeof(message), "cannot be opened (%s)", strerror(errno)));
  else if (!rank) {
    const PetscBool read = CheckpointChecksum(path, CHECKPOINT_TAIL_LENGTH, &crc, tail);
    sealed = read && sscanf(tail, CHECKPOINT_TAIL, &stored) == 1;
    if (!sealed)
      PetscCall(
          PetscSNPrintf(message, sizeof(message), "no checkpoint, or cut off: the checksum at its end is missing"));
    else if (crc != stored)
      PetscCall(
          PetscSNPrintf(message, sizeof(message), "damaged: its checksum is %08x, its bytes have %08x", stored, crc));
  }
  PetscCallMPI(MPI_Bcast(&sealed, 1, MPI_INT, 0, scene->comm));
  PetscCallMPI(MPI_Bcast(message, sizeof(message), MPI_CHAR, 0, scene->comm));
  if (!sealed || !*message) PetscCall(RestartFormat(scene));
  PetvesCheck(!*message, scene->comm,
              "-restart %s: %s; allowed: a checkpoint.h5 of petves, or the one before it, checkpoint_1.h5", path,
              message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuse an option that differs. Two lists that differ are shown from the first entry that does. */
static PetscErrorCode RestartOption(Scene scene, const char name[], const char here[], const char there[]) {
  size_t from = 0;
  PetscFunctionBeginUser;
  for (size_t k = 0; here[k] && here[k] == there[k]; k++)
    if (here[k] == ',' && k > 100) from = k;
  PetvesCheck(!*there || !strcmp(here, there), scene->comm,
              "%s %s%.100s: the checkpoint of -restart %s has %s%.100s; allowed: the same value", name,
              from ? "..." : "", here + from, scene->output.restart, from ? "..." : "", there + from);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RestartOptions(Scene scene, H5File *file) {
  PetscFunctionBeginUser;
  for (PetscInt i = 0; SceneOptionRow(i); i++) {
    char *here, *there;
    if (SceneOptionRow(i)->may_change) continue;
    PetscCall(OptionText(&scene->options, scene, i, &here));
    PetscCall(H5GetText(file, SceneOptionRow(i)->name, &there));
    const PetscErrorCode same = RestartOption(scene, SceneOptionRow(i)->name, here, there);
    PetscCall(PetscFree(here));
    PetscCall(PetscFree(there));
    PetscCall(same);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuse a file if something in it could not be read. */
PetscErrorCode RestartEntries(Scene scene, const H5File *file) {
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5FileFailed(file, &failed));
  PetvesCheck(!failed, scene->comm,
              "-restart %s: entries are missing, or have another size or storage; allowed: a checkpoint.h5 of petves",
              scene->output.restart);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Files of curves may have other names or places, but not other numbers. */
static PetscErrorCode RestartFiles(Scene scene, H5File *file) {
  const struct {
    const char *option, *file, *name, *digest;
  } all[] = {{"-vesicle_file", scene->vesicles.file, "vesicle_digest", scene->shape.digest},
             {"-obstacle_file", scene->obstacles.file, "obstacle_digest", scene->obstacles.outline.digest}};
  char there[DIGEST];
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(H5GetString(file, all[k].name, sizeof(there), there));
    PetvesCheck(!strcmp(there, all[k].digest), scene->comm,
                "%s %s: its curves are not those that the run of -restart %s began with; allowed: the same points, "
                "velocities and rotations",
                all[k].option, all[k].file, scene->output.restart);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read all of the open checkpoint. */
static PetscErrorCode RestartReadAll(const Model *m, H5File *file, Record *record, PetscInt *frames) {
  PetscBool plain, fits;
  char *text;
  PetscFunctionBeginUser;
  PetscCall(H5CheckLinks(file, &plain));
  PetvesCheck(plain, file->comm,
              "-restart %s: it has links to other names or files; allowed: a checkpoint.h5 of petves", file->path);
  PetscCall(RestartFiles(m->scene, file)); /* first, as options have defaults that follow from the curves */
  PetscCall(RestartOptions(m->scene, file));
  PetscCall(m->ops.checkpoint(m->context, file, PETSC_FALSE, frames));
  PetscCall(H5GetText(file, "series_row", &text));
  RecordParse(record, text);
  PetscCall(PetscFree(text));
  fits = file->rank || file->failed || RecordFits(record, *m->step, *m->t);
  PetscCallMPI(MPI_Bcast(&fits, 1, MPIU_BOOL, 0, file->comm));
  PetvesCheck(fits, file->comm,
              "-restart %s: its row of series.csv is not that of its step; allowed: a checkpoint.h5 of petves",
              file->path);
  PetscCall(RestartEntries(m->scene, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RestartRead(const Model *m, Record *record, PetscInt *frames) {
  PetscErrorCode error;
  H5File file;
  PetscFunctionBeginUser;
  PetscCall(RestartFile(m->scene));
  PetscCall(H5FileOpen(m->scene->comm, m->scene->output.restart, H5_READ, &file));
  error = RestartReadAll(m, &file, record, frames);
  H5FileClose(&file);
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}
