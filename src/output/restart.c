/* -restart: a checkpoint is checked, compared with the scene, and read into the scheme. */
#include "base/agree.h"
#include "base/version.h"
#include "output/checkpoint.h"
#include <errno.h>
#include <stdlib.h>
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

/* Refuse vectors with values that a run cannot have had. */
static PetscErrorCode RestartVectors(Scheme s, const State *q) {
  const struct {
    const char *name;
    Vec vector;
    PetscReal most;
  } all[] = {{"velocity", q->w, PETSC_MAX_REAL},
             {"flow", q->flow, PETSC_MAX_REAL},
             {"pressure", q->p, PETSC_MAX_REAL},
             {"markers", q->X, 1e9 * s->fluid->grid->h},
             {"marker velocity", q->U, PETSC_MAX_REAL},
             {"tension", q->sigma, PETSC_MAX_REAL},
             {"force on obstacles", q->solid, PETSC_MAX_REAL},
             {"place of obstacles", q->place, 1e9 * s->fluid->grid->h}};
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) {
    PetscReal largest = 0;
    PetscBool finite = PETSC_TRUE;
    if (!all[k].vector) continue;
    PetscCall(AgreeFinite(all[k].vector, &finite));
    PetscCall(VecNorm(all[k].vector, NORM_INFINITY, &largest));
    PetvesCheck(finite && largest <= all[k].most, s->scene->comm,
                "-restart %s: its %s is up to %g; allowed: a checkpoint.h5 of petves", s->scene->output.restart,
                all[k].name, finite ? (double)largest : (double)NAN);
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

/* The level of step-size control counts from -time_step, which may differ from that of the checkpoint. */
static PetscErrorCode RestartLevel(Scheme s, H5File *file, PetscInt *level) {
  char base[64];
  PetscFunctionBeginUser;
  PetscCall(H5GetString(file, "-time_step", sizeof(base), base));
  if (*base && strtod(base, NULL) > 0 && strtod(base, NULL) < 1e300)
    *level += (PetscInt)PetscFloorReal(2 * PetscLog2Real((PetscReal)strtod(base, NULL) / s->scene->time.dt) + 1e-9);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last row and the totals. */
static PetscErrorCode RestartRecord(Scheme s, H5File *file, const PetscInt totals[4], Record *record) {
  PetscBool fits;
  char *text;
  PetscFunctionBeginUser;
  record->solves = totals[0];
  record->tension = totals[1];
  record->bending = totals[2];
  record->coupled = totals[3];
  PetscCall(H5GetText(file, "series_row", &text));
  RecordParse(record, text);
  PetscCall(PetscFree(text));
  fits = file->rank || file->failed || RecordFits(record, s->state.step, s->state.t);
  PetscCallMPI(MPI_Bcast(&fits, 1, MPIU_BOOL, 0, file->comm));
  PetvesCheck(fits, s->scene->comm,
              "-restart %s: its row of series.csv is not that of its step; allowed: a checkpoint.h5 of petves",
              s->scene->output.restart);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The present state and those before it. dt_earlier: the steps that led to the earlier states; to each but the first
   state of a run there was one. */
static PetscErrorCode RestartState(Scheme s, H5File *file, SchemeTimes *times) {
  PetscFunctionBeginUser;
  PetscCall(RestartLevel(s, file, &times->plan.level));
  SchemeSetTimes(s, times);
  for (PetscInt j = 0; j < s->past; j++) {
    const PetscReal dt = times->dt_earlier[j];
    PetvesCheck(dt >= 0 && dt <= 1e300 && (j == s->past - 1 || dt > 0), s->scene->comm,
                "-restart %s: its dt_earlier is %g; allowed: a step above 0, as petves writes it",
                s->scene->output.restart, (double)dt);
  }
  for (PetscInt j = 0; j <= s->past; j++) {
    State *state = j ? &s->old[j - 1] : &s->state;
    PetscCall(CheckpointVectors(file, PETSC_FALSE, s, j, state));
    PetscCall(RestartVectors(s, state));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read all of the open checkpoint; memory[] is what the solvers have kept from earlier steps. */
static PetscErrorCode RestartReadAll(Scheme s, H5File *file, Record *record, Tracers *tracers, PetscInt *frames,
                                     PetscReal memory[]) {
  const PetscInt numbers = SchemeMemorySize(s);
  CheckpointNumbers n = {.times.plan = {.order = 1, .guess = 1}}; /* allowed, where nothing can be read */
  PetscFunctionBeginUser;
  PetscCall(CheckpointMoveNumbers(file, PETSC_FALSE, &n));
  PetscCall(RestartEntries(s->scene, file));
  PetscCall(RestartFiles(s->scene, file));
  PetscCall(RestartState(s, file, &n.times));
  PetscCall(CheckpointTracers(file, PETSC_FALSE, s, tracers));
  *frames = n.frames;
  PetscCall(RestartRecord(s, file, n.totals, record));
  PetscCall(CheckpointEntry(file, PETSC_FALSE, "/solver", numbers, 1, memory));
  for (PetscInt k = 0; k < numbers; k++)
    if (PetscIsInfOrNanReal(memory[k])) file->failed = file->rank ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(RestartEntries(s->scene, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RestartOpen(Scene scene, H5File *file) {
  PetscBool plain;
  PetscFunctionBeginUser;
  PetscCall(RestartFile(scene));
  PetscCall(H5FileOpen(scene->comm, scene->output.restart, H5_READ, file));
  PetscCall(H5CheckLinks(file, &plain));
  if (!plain) H5FileClose(file);
  PetvesCheck(plain, scene->comm,
              "-restart %s: it has links to other names or files; allowed: a checkpoint.h5 of petves",
              scene->output.restart);
  const PetscErrorCode fits = RestartOptions(scene, file);
  if (fits) H5FileClose(file);
  PetscCall(fits);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RestartRead(Scheme s, Record *record, Tracers *tracers, PetscInt *frames) {
  PetscReal *memory;
  PetscErrorCode error;
  H5File file;
  PetscFunctionBeginUser;
  PetscCall(RestartOpen(s->scene, &file));
  PetscCall(PetscMalloc1(SchemeMemorySize(s), &memory));
  error = RestartReadAll(s, &file, record, tracers, frames, memory);
  H5FileClose(&file);
  if (!error) error = SchemeRecall(s, memory);
  PetscCall(PetscFree(memory));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}
