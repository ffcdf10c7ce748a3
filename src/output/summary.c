#include "output/summary.h"
#include "base/version.h"
#include "options/typed.h"
#include <ctype.h>
#include <fftw3.h>
#include <hdf5.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Seconds between progress lines. */
#define PROGRESS_SECONDS 2

PetscErrorCode SummaryProgress(Summary *s, PetscBool force) {
  const Model *m = s->model;
  const PetscReal end = m->scene->time.end;
  PetscLogDouble now, left;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  if (!force && now - s->printed < PROGRESS_SECONDS) PetscFunctionReturn(PETSC_SUCCESS);
  s->printed = now;
  left = *m->t > s->from ? (now - s->start) * PetscMax(0, end - *m->t) / (*m->t - s->from) : 0;
  PetscCall(PetvesSay(s->folder->comm, "step %" PetscInt_FMT "  time %.6g  %3.0f %%  %.0f s left\n", *m->step,
                      (double)*m->t, end > 0 ? 100 * PetscMin(1, (double)(*m->t / end)) : 100, (double)left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sizes of the files in the folder, on rank 0. */
static void SummaryCountBytes(Summary *s) {
  static const char *const names[] = {"run.h5", "series.csv", "run.xmf", "vesicles.h5", "checkpoint.h5"};
  struct stat status;
  s->bytes = s->bytes_h5 = 0;
  for (PetscInt k = 0; k < 4 + s->model->scene->output.checkpoint_keep && !s->folder->rank; k++) {
    char name[64], path[PETSC_MAX_PATH_LEN];
    (void)(k < 5 ? PetscStrncpy(name, names[k], sizeof(name))
                 : PetscSNPrintf(name, sizeof(name), "checkpoint_%d.h5", (int)k - 4));
    FolderPath(s->folder, name, path);
    if (!stat(path, &status)) s->bytes += (double)status.st_size;
    if (!k) s->bytes_h5 = s->bytes;
  }
}

/* Print PETSc's own options that the user gave, -tension_ksp_monitor, -log_view and so on. A word of the database may
   be a value, which is no option. A file must not have the options that TypedIsOwn names. */
static PetscErrorCode ResolvedPrintOthers(FILE *f) {
  char *all, *word, *end = NULL;
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (word = strtok_r(all, " \n", &end); word; word = strtok_r(NULL, " \n", &end)) {
    const char *value = NULL;
    PetscBool given = PETSC_FALSE;
    PetscBool known = !strcmp(word, "-options_file") || !strcmp(word, "-help");
    for (PetscInt i = 0; SceneOptionRow(i) && !known; i++) known = !strcmp(word, SceneOptionRow(i)->name);
    if (word[0] != '-' || !isalpha((unsigned char)word[1]) || known) continue;
    PetscCall(PetscOptionsFindPair(NULL, NULL, word, &value, &given));
    if (given && !TypedIsOwn(word, value)) OptionPrint(f, word, value ? value : "");
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ResolvedPrint(FILE *f, const void *model) {
  const Model *m = model;
  PetscFunctionBeginUser;
  fprintf(f, "# every option in force: mpirun -n RANKS petves -options_file resolved.opts repeats the run\n");
  PetscCall(SceneWriteOptions(m->scene, f));
  if (m->ops.options) PetscCall(m->ops.options(m->context, f));
  PetscCall(ResolvedPrintOthers(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SummaryBegin(Summary *s) {
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(s->folder, "resolved.opts", ResolvedPrint, s->model));
  PetscCall(PetscTime(&s->start));
  s->printed = s->start;
  s->from = *s->model->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Print a JSON string: quotes, backslashes and control characters are escaped. */
static void JsonPrintString(FILE *f, const char *text) {
  fputc('"', f);
  for (; *text; text++) {
    if (*text == '"' || *text == '\\')
      fprintf(f, "\\%c", *text);
    else if ((unsigned char)*text < 32)
      fprintf(f, "\\u%04x", *text);
    else
      fputc(*text, f);
  }
  fputc('"', f);
}

static void JsonPrintVersions(FILE *f) {
  char petsc[256] = "";
  unsigned major, minor, release;
  (void)PetscGetVersion(petsc, sizeof(petsc));
  (void)H5get_libversion(&major, &minor, &release);
  fprintf(f,
          "  \"versions\": {\"petves\": \"%s\", \"petsc\": \"%d.%d.%d\", \"fftw\": \"%s\", \"hdf5\": \"%u.%u.%u\"},\n",
          PETVES_VERSION, PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR, fftw_version, major, minor,
          release);
}

static void JsonPrintRow(FILE *f, const Record *record) {
  fprintf(f, ",\n  \"last\": {");
  for (PetscInt c = 0; c < record->setting.columns; c++) {
    fprintf(f, "%s\"%s\": ", c ? ", " : "", record->setting.column[c].name);
    if (PetscIsInfOrNanReal(record->last[c]))
      fprintf(f, "null");
    else
      fprintf(f, "%.17g", (double)record->last[c]);
  }
  fprintf(f, "},\n");
}

/* When and where the run ended, the words that its process was started with, versions. */
static void JsonPrintOrigin(FILE *f) {
  FILE *const started = fopen("/proc/self/cmdline", "r"); /* with a zero behind each word */
  char *word = NULL;
  size_t room = 0;
  char host[128] = "", date[32] = "";
  const time_t now = time(NULL);
  struct tm utc;
  (void)gethostname(host, sizeof(host) - 1);
  (void)strftime(date, sizeof(date), "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  fprintf(f, "  \"ended\": \"%s\",\n  \"host\": ", date);
  JsonPrintString(f, host);
  fprintf(f, ",\n  \"command\": [");
  for (int k = 0; started && getdelim(&word, &room, 0, started) > 0; k++) {
    fprintf(f, k ? ", " : "");
    JsonPrintString(f, word);
  }
  fprintf(f, "],\n");
  free(word);
  if (started) fclose(started);
  JsonPrintVersions(f);
  fprintf(f, "  \"git_commit\": \"%s\"\n}\n", PetvesCommit());
}

static PetscErrorCode JsonPrint(FILE *f, const void *what) {
  const Summary *s = what;
  const Model *m = s->model;
  const char *warning;
  struct rusage usage;
  int ranks;
  (void)MPI_Comm_size(s->folder->comm, &ranks);
  fprintf(f, "{\n  \"reason\": ");
  JsonPrintString(f, s->reason);
  JsonPrintRow(f, s->record);
  m->ops.summary(m->context, f);
  fprintf(f, "  \"wall_seconds\": {\"run\": %.6f", (double)s->seconds);
  for (int p = 0; p < PHASE_COUNT; p++) fprintf(f, ", \"%s\": %.6f", PhaseNames[p], (double)PhaseSeconds((Phase)p));
  (void)getrusage(RUSAGE_SELF, &usage);
  fprintf(f, "},\n  \"memory_mib_rank_0\": %.1f,\n  \"ranks\": %d,\n", (double)usage.ru_maxrss / 1024, ranks);
  fprintf(f, "  \"written\": {\"frames\": %d, \"bytes\": %.0f, \"bytes_run_h5\": %.0f},\n  \"warnings\": [",
          (int)s->frames, s->bytes, s->bytes_h5);
  for (PetscInt i = 0; (warning = m->ops.warning(m->context, i)); i++) {
    fprintf(f, i ? ", " : "");
    JsonPrintString(f, warning);
  }
  fprintf(f, "],\n");
  JsonPrintOrigin(f);
  return PETSC_SUCCESS;
}

/* The table that a run ends with. */
static PetscErrorCode TablePrint(const Summary *s, const char reason[]) {
  const Model *m = s->model;
  const MPI_Comm comm = s->folder->comm;
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(comm, "\n%s at time %g after %" PetscInt_FMT " steps, %.2f s\n", reason, (double)*m->t, *m->step,
                      (double)s->seconds));
  PetscCall(m->ops.table(m->context, s->record->last));
  PetscCall(PetvesSay(comm, "  seconds: fast solves %.2f, rest of the steps %.2f, output %.2f\n",
                      (double)PhaseSeconds(PHASE_FAST_SOLVE), (double)PhaseSeconds(PHASE_STEP),
                      (double)PhaseSeconds(PHASE_OUTPUT)));
  PetscCall(PetvesSay(comm, "  files in %s: %.3g MB, %.3g MB of them run.h5 with %" PetscInt_FMT " frames\n",
                      s->folder->path, s->bytes / 1e6, s->bytes_h5 / 1e6, s->frames));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SummaryEnd(Summary *s, PetscInt frames, const char reason[], const char failure[]) {
  PetscLogDouble now;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  s->seconds = now - s->start;
  s->frames = frames;
  s->reason = failure ? failure : reason;
  SummaryCountBytes(s);
  PetscCall(FolderWriteText(s->folder, "summary.json", JsonPrint, s));
  PetscCall(SummaryProgress(s, PETSC_TRUE));
  PetscCall(TablePrint(s, failure ? "stopped" : reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}
