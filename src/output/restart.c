#include "base/agree.h"
#include "base/version.h"
#include "output/gathered.h"
#include "output/restart.h"
#include "output/checkpoint.h"
#include "output/checksum.h"
#include "output/h5plain.h"
#include "scheme/bdf.h"
#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

static PetscErrorCode CheckFormat(Scene scene) {
  H5File file;
  PetscInt format = 0;
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5FileOpen(scene->comm, scene->output.restart, PETSC_FALSE, &file));
  PetscCall(H5GetInts(&file, "format", 1, &format));
  PetscCall(H5FileFailed(&file, &failed));
  PetscCall(H5FileClose(&file));
  PetvesCheck(failed || format == CHECKPOINT_FORMAT, scene->comm,
              "-restart %s: its format is %" PetscInt_FMT "; allowed: %d, which petves %s writes",
              scene->output.restart, format, CHECKPOINT_FORMAT, PETVES_VERSION);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is wrong with the file as such, found on rank 0 and told to all. The checksum covers every byte, so that HDF5
   reads what it wrote. Without one the file may be of a format that has none, or has it elsewhere. */
static PetscErrorCode CheckFile(Scene scene) {
  const char *path = scene->output.restart;
  char message[PETVES_MAX_MESSAGE] = "", tail[CHECKPOINT_TAIL_LENGTH + 1] = "";
  unsigned crc = 0, stored = 0;
  PetscMPIInt rank, sealed = 1;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(scene->comm, &rank));
  if (!rank && access(path, R_OK))
    PetscCall(PetscSNPrintf(message, sizeof(message), "cannot be opened (%s)", strerror(errno)));
  else if (!rank) {
    const PetscBool read = ChecksumOfFile(path, CHECKPOINT_TAIL_LENGTH, &crc, tail);
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
  if (!sealed || !*message) PetscCall(CheckFormat(scene));
  PetvesCheck(!*message, scene->comm,
              "-restart %s: %s; allowed: a checkpoint.h5 of petves, or the one before it, checkpoint_1.h5", path,
              message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Texts that differ are shown from the first entry of a list that does. */
static PetscErrorCode CompareOption(Scene scene, const char name[], const char here[], const char there[]) {
  size_t from = 0;
  PetscFunctionBeginUser;
  for (size_t k = 0; here[k] && here[k] == there[k]; k++)
    if (here[k] == ',' && k > 100) from = k;
  PetvesCheck(!*there || !strcmp(here, there), scene->comm,
              "%s %s%.100s: the checkpoint of -restart %s has %s%.100s; allowed: the same value", name,
              from ? "..." : "", here + from, scene->output.restart, from ? "..." : "", there + from);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CompareOptions(Scene scene, H5File *file) {
  PetscFunctionBeginUser;
  for (PetscInt i = 0; SceneOptionName(i); i++) {
    char *here, *there;
    if (SceneOptionMayChange(SceneOptionName(i))) continue;
    PetscCall(SceneOptionText(scene, i, &here));
    PetscCall(H5GetText(file, SceneOptionName(i), &there));
    const PetscErrorCode same = CompareOption(scene, SceneOptionName(i), here, there);
    PetscCall(PetscFree(here));
    PetscCall(PetscFree(there));
    PetscCall(same);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The files of curves may have other names or places, but not other numbers. */
static PetscErrorCode CompareFiles(Scene scene, H5File *file) {
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

static PetscErrorCode ReadFields(Scheme s, H5File *file, const char prefix[], State *q, Vec w) {
  static const char *const names[3] = {"u", "v", "p"};
  const Grid g = s->fluid->grid;
  char name[64];
  PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a[0]));
  a[1] = a[0] + GridLocalU(g);
  if (q->p) PetscCall(VecGetArray(q->p, &a[2]));
  for (int f = 0; f < (q->p ? 3 : 2); f++) {
    const PetscInt dims[2] = {g->all_rows[f], g->columns[f]};
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%s", prefix, names[f]));
    H5CheckEntry(file, name, 2, dims);
    PetscCall(H5ReadField(file, name, 0, g, (Field)f, a[f]));
  }
  if (q->p) PetscCall(VecRestoreArray(q->p, &a[2]));
  PetscCall(VecRestoreArray(w, &a[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The flow of a state: its bits, or where the file is of other solvers that of its velocity w. */
static PetscErrorCode ReadFlow(Scheme s, H5File *file, const char prefix[], State *q, Vec w) {
  const Grid g = s->fluid->grid;
  const PetscInt dims[2] = {g->all_rows[FIELD_U], StateFlowWidth(q, g)};
  PetscInt there = 0;
  char name[64];
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(H5GetInts(file, "flow", 1, &there));
  if (there != dims[1]) {
    PetscCall(s->ops.flow(s, w, q->flow));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/flow", prefix));
  H5CheckEntry(file, name, 2, dims);
  PetscCall(VecGetArray(q->flow, &a));
  PetscCall(H5ReadRows(file, name, 0, g, FIELD_U, dims[1], a));
  PetscCall(VecRestoreArray(q->flow, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFluid(Scheme s, H5File *file, const char prefix[], State *q) {
  Vec w = q->w;
  PetscFunctionBeginUser;
  if (!w && !q->flow) PetscFunctionReturn(PETSC_SUCCESS);
  if (!w) PetscCall(DMGetGlobalVector(s->fluid->grid->velocity, &w));
  PetscCall(ReadFields(s, file, prefix, q, w));
  if (q->flow) PetscCall(ReadFlow(s, file, prefix, q, w));
  if (!q->w) PetscCall(DMRestoreGlobalVector(s->fluid->grid->velocity, &w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* n rows of one number, or of `each`. */
static PetscErrorCode ReadOnly(H5File *file, const char prefix[], const char name[], PetscInt n, PetscInt each,
                               PetscReal values[]) {
  const PetscInt dims[2] = {n, each};
  char path[64];
  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", prefix, name));
  H5CheckEntry(file, path, each > 1 ? 2 : 1, dims);
  PetscCall(H5ReadArray(file, path, 0, n * each, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values that a run may have had. Vectors of an entry that could not be read are refused as that. */
static PetscErrorCode CheckVectors(Scheme s, const State *q) {
  const struct {
    const char *name;
    Vec vector;
    PetscReal most;
  } all[] = {{"velocity", q->w, PETSC_MAX_REAL},        {"flow", q->flow, PETSC_MAX_REAL},
             {"pressure", q->p, PETSC_MAX_REAL},        {"markers", q->X, 1e9 * s->fluid->grid->h},
             {"marker velocity", q->U, PETSC_MAX_REAL}, {"tension", q->sigma, PETSC_MAX_REAL}};
  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) {
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

/* The vectors of one state. */
static PetscErrorCode ReadVectors(Scheme s, H5File *file, const char prefix[], State *q) {
  Gathered there;
  PetscFunctionBeginUser;
  PetscCall(ReadFluid(s, file, prefix, q));
  PetscCall(GatheredCreate(q, &there));
  PetscCall(ReadOnly(file, prefix, "vesicle/markers", there.M, 2, there.markers));
  PetscCall(ReadOnly(file, prefix, "vesicle/velocity", there.M, 2, there.velocity));
  PetscCall(ReadOnly(file, prefix, "vesicle/tension", there.M, 1, there.tension));
  PetscCall(ReadOnly(file, prefix, "obstacle/force", there.W, 2, there.solid));
  PetscCall(ScatterState(&there, q));
  PetscCall(GatheredDestroy(&there));
  PetscCall(CheckVectors(s, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That all so far could be read. */
static PetscErrorCode CheckEntries(Scene scene, const H5File *file) {
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5FileFailed(file, &failed));
  PetvesCheck(!failed, scene->comm,
              "-restart %s: entries are missing, or have another size or storage; allowed: a checkpoint.h5 of petves",
              scene->output.restart);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers that a run may have had: a step to which as many may be added as a run may take. */
static PetscErrorCode CheckNumbers(Scene scene, H5File *file) {
  static const struct {
    const char *name;
    PetscReal least, most;
    PetscBool whole;
  } all[] = {{"step", 0, 1e9, PETSC_TRUE},
             {"past", 0, SCHEME_PAST, PETSC_TRUE},
             {"step_level", -1000, 1000, PETSC_TRUE},
             {"frames", 0, 1e9, PETSC_TRUE},
             {"time", 0, 1e300, PETSC_FALSE},
             {"dt", 0, 1e300, PETSC_FALSE},
             {"dt_last", 0, 1e300, PETSC_FALSE},
             {"step_order", 0, BDF_MOST, PETSC_TRUE},
             {"step_guess", 0, BDF_STATES, PETSC_TRUE}};
  PetscReal x[9] = {0};
  PetscFunctionBeginUser;
  for (int k = 0; k < 9; k++) {
    PetscInt n = 0;
    PetscCall(all[k].whole ? H5GetInts(file, all[k].name, 1, &n) : H5GetReals(file, all[k].name, 1, &x[k]));
    if (all[k].whole) x[k] = n;
    PetvesCheck(x[k] >= all[k].least && x[k] <= all[k].most, scene->comm,
                "-restart %s: its %s is %g; allowed: %g to %g, as petves writes it", scene->output.restart, all[k].name,
                (double)x[k], (double)all[k].least, (double)all[k].most);
  }
  PetvesCheck(x[3] <= x[0] + 1 && (x[0] == 0 || x[6] > 0), scene->comm,
              "-restart %s: it has %g frames and a last step of %g at step %g; allowed: a checkpoint.h5 of petves",
              scene->output.restart, (double)x[3], (double)x[6], (double)x[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level of step-size control counts from -time_step, which may have changed. */
static PetscErrorCode ReadLevel(Scheme s, H5File *file) {
  PetscInt level = 0;
  char base[64];
  PetscFunctionBeginUser;
  PetscCall(H5GetInts(file, "step_level", 1, &level));
  PetscCall(H5GetString(file, "-time_step", sizeof(base), base));
  if (*base && strtod(base, NULL) > 0 && strtod(base, NULL) < 1e300)
    level += (PetscInt)PetscFloorReal(2 * PetscLog2Real((PetscReal)strtod(base, NULL) / s->scene->time.dt) + 1e-9);
  if (s->policy.adaptive) s->plan.level = level;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last row and the totals. */
static PetscErrorCode ReadRecord(Scheme s, H5File *file, Record *record) {
  PetscBool fits;
  PetscInt totals[4] = {0};
  char *text;
  PetscFunctionBeginUser;
  PetscCall(H5GetInts(file, "totals", 4, totals));
  record->solves = totals[0];
  record->tension = totals[1];
  record->bending = totals[2];
  record->coupled = totals[3];
  PetscCall(H5GetText(file, "series_row", &text));
  PetscCall(RecordParse(record, text));
  PetscCall(PetscFree(text));
  fits = file->rank || file->failed || RecordFits(record, s->state.step, s->state.t) ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Bcast(&fits, 1, MPIU_BOOL, 0, file->comm));
  PetvesCheck(fits, s->scene->comm,
              "-restart %s: its row of series.csv is not that of its step; allowed: a checkpoint.h5 of petves",
              s->scene->output.restart);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many earlier states there are, and the steps that led to them: to each but the first state of a run there was
 * one.
 */
static PetscErrorCode ReadPast(Scheme s, H5File *file, PetscReal earlier[SCHEME_PAST]) {
  PetscFunctionBeginUser;
  PetscCall(H5GetInts(file, "past", 1, &s->past));
  PetscCall(H5GetReals(file, "dt_earlier", SCHEME_PAST, earlier));
  PetscCall(H5GetInts(file, "step_order", 1, &s->plan.order));
  PetscCall(H5GetInts(file, "step_guess", 1, &s->plan.guess));
  PetvesCheck(s->plan.order > 0 && s->plan.guess > 0, s->scene->comm,
              "-restart %s: its step_order is %" PetscInt_FMT ", its step_guess is %" PetscInt_FMT
              "; allowed: at least 1",
              s->scene->output.restart, s->plan.order, s->plan.guess);
  if (!s->old[0].X) s->past = 0; /* schemes that go on from one state */
  for (PetscInt j = 0; j < s->past; j++)
    PetvesCheck(earlier[j] >= 0 && earlier[j] <= 1e300 && (j == s->past - 1 || earlier[j] > 0), s->scene->comm,
                "-restart %s: its dt_earlier is %g; allowed: a step above 0, as petves writes it",
                s->scene->output.restart, (double)earlier[j]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadState(Scheme s, H5File *file) {
  State *q = &s->state;
  PetscReal earlier[SCHEME_PAST] = {0};
  PetscFunctionBeginUser;
  PetscCall(H5GetInts(file, "step", 1, &q->step));
  PetscCall(H5GetReals(file, "time", 1, &q->t));
  PetscCall(H5GetReals(file, "dt", 1, &q->dt));
  PetscCall(H5GetReals(file, "dt_last", 1, &q->dt_last));
  PetscCall(ReadPast(s, file, earlier));
  PetscCall(ReadLevel(s, file));
  PetscCall(ReadVectors(s, file, "", q));
  for (PetscInt j = 0; j < s->past; j++) {
    s->old[j].dt_last = earlier[j];
    PetscCall(ReadVectors(s, file, CheckpointGroup(j), &s->old[j]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All that the open checkpoint holds; memory[] is what the solvers have kept from earlier steps. */
static PetscErrorCode ReadAll(Scheme s, H5File *file, Record *record, PetscInt *frames, PetscReal memory[]) {
  const PetscInt numbers = SchemeMemorySize(s);
  PetscBool plain;
  PetscFunctionBeginUser;
  PetscCall(H5CheckLinks(file, &plain));
  PetvesCheck(plain, s->scene->comm,
              "-restart %s: it has links to other names or files; allowed: a checkpoint.h5 of petves",
              s->scene->output.restart);
  PetscCall(CompareOptions(s->scene, file));
  PetscCall(CheckNumbers(s->scene, file));
  PetscCall(CheckEntries(s->scene, file));
  PetscCall(CompareFiles(s->scene, file));
  PetscCall(ReadState(s, file));
  PetscCall(H5GetInts(file, "frames", 1, frames));
  PetscCall(ReadRecord(s, file, record));
  H5CheckEntry(file, "/solver", 1, &numbers);
  PetscCall(H5ReadArray(file, "/solver", 0, numbers, memory));
  for (PetscInt k = 0; k < numbers; k++)
    if (PetscIsInfOrNanReal(memory[k])) file->failed = file->rank ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(CheckEntries(s->scene, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RestartRead(Scheme s, Record *record, PetscInt *frames) {
  PetscReal *memory;
  PetscErrorCode error;
  H5File file;
  PetscFunctionBeginUser;
  PetscCall(CheckFile(s->scene));
  PetscCall(PetscMalloc1(SchemeMemorySize(s), &memory));
  PetscCall(H5FileOpen(s->scene->comm, s->scene->output.restart, PETSC_FALSE, &file));
  error = ReadAll(s, &file, record, frames, memory);
  PetscCall(H5FileClose(&file));
  if (!error) error = SchemeRecall(s, memory);
  PetscCall(PetscFree(memory));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}
