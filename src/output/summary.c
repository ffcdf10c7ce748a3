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

ProgressClock ProgressBegin(PetscReal from, PetscReal end) {
  ProgressClock c = {.from = from, .end = end};
  (void)PetscTime(&c.start);
  c.printed = c.start;
  return c;
}

PetscErrorCode ProgressSay(ProgressClock *c, MPI_Comm comm, PetscInt step, PetscReal t, PetscBool force) {
  PetscLogDouble now, left;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  if (!force && now - c->printed < PROGRESS_SECONDS) PetscFunctionReturn(PETSC_SUCCESS);
  c->printed = now;
  left = t > c->from ? (now - c->start) * PetscMax(0, c->end - t) / (t - c->from) : 0;
  PetscCall(PetvesSay(comm, "step %" PetscInt_FMT "  time %.6g  %3.0f %%  %.0f s left\n", step, (double)t,
                      c->end > 0 ? 100 * PetscMin(1, (double)(t / c->end)) : 100, (double)left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SummaryProgress(Summary *s, PetscBool force) {
  const State *q = &s->scheme->state;
  PetscFunctionBeginUser;
  PetscCall(ProgressSay(&s->clock, s->folder->comm, q->step, q->t, force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sizes of the files in the folder, on rank 0. */
static void SummaryCountBytes(Summary *s) {
  static const char *const names[] = {"run.h5", "series.csv", "run.xmf", "vesicles.h5", "checkpoint.h5"};
  struct stat status;
  s->bytes = s->bytes_h5 = 0;
  for (PetscInt k = 0; k < 4 + s->scheme->scene->output.checkpoint_keep && !s->folder->rank; k++) {
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

PetscErrorCode SummaryPrintOptions(Scene scene, Scheme scheme, FILE *f) {
  PetscFunctionBeginUser;
  fprintf(f, "# every option in force: mpirun -n RANKS petves -options_file resolved.opts repeats the run\n");
  PetscCall(SceneWriteOptions(scene, f));
  if (scheme) PetscCall(SchemeWriteOptions(scheme, f));
  PetscCall(ResolvedPrintOthers(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ResolvedPrint(FILE *f, const void *what) {
  return SummaryPrintOptions(((Scheme)what)->scene, (Scheme)what, f);
}

PetscErrorCode SummaryBegin(Summary *s) {
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(s->folder, "resolved.opts", ResolvedPrint, s->scheme));
  s->clock = ProgressBegin(s->scheme->state.t, s->scheme->scene->time.end);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lines that only a run with vesicles has. */
static PetscErrorCode TablePrintVesicles(MPI_Comm comm, const Summary *s, PetscInt steps) {
  const Record *record = s->record;
  const PetscReal *r = record->last;
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(comm, "  energy, kinetic and bending   %.6e  %.6e\n", (double)r[COLUMN_KINETIC],
                      (double)r[COLUMN_BENDING]));
  if (!s->scheme->membrane->stretches)
    PetscCall(PetvesSay(comm, "  area error, length error      %.3e  %.3e\n", (double)r[COLUMN_AREA_ERROR],
                        (double)r[COLUMN_LENGTH_ERROR]));
  else
    PetscCall(PetvesSay(comm, "  area error, change of length  %.3e  %.3e\n", (double)r[COLUMN_AREA_ERROR],
                        (double)r[COLUMN_LENGTH_ERROR]));
  PetscCall(PetvesSay(comm, "  inclination (radians)         %.6f\n", (double)r[COLUMN_INCLINATION]));
  if (!PetscIsNanReal(r[COLUMN_FREQUENCY]))
    PetscCall(PetvesSay(comm, "  tank-treading frequency       %.6f\n", (double)r[COLUMN_FREQUENCY]));
  PetscCall(PetvesSay(comm, "  iterations a step             "));
  if (record->coupled)
    PetscCall(PetvesSay(comm, "coupled %.1f\n", (double)record->coupled / (double)steps));
  else
    PetscCall(PetvesSay(comm, "tension %.1f, bending %.1f\n", (double)record->tension / (double)steps,
                        (double)record->bending / (double)steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TablePrint(const Summary *s, const char reason[]) {
  const MPI_Comm comm = s->folder->comm;
  const PetscReal *r = s->record->last;
  const PetscInt step = (PetscInt)r[COLUMN_STEP], steps = PetscMax(step, 1);
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(comm, "\n%s at time %g after %" PetscInt_FMT " steps, %.2f s\n", reason, (double)r[COLUMN_TIME],
                      step, (double)s->seconds));
  if (s->record->vesicles) PetscCall(TablePrintVesicles(comm, s, steps));
  PetscCall(PetvesSay(comm, "  max |div u|                   %.3e\n", (double)r[COLUMN_DIV]));
  PetscCall(PetvesSay(comm, "  fast solves a step            %.1f\n", (double)s->record->solves / (double)steps));
  PetscCall(PetvesSay(comm, "  seconds: fast solves %.2f, rest of the steps %.2f, output %.2f\n",
                      (double)PhaseSeconds(PHASE_FAST_SOLVE), (double)PhaseSeconds(PHASE_STEP),
                      (double)PhaseSeconds(PHASE_OUTPUT)));
  PetscCall(PetvesSay(comm, "  files in %s: %.3g MB, %.3g MB of them run.h5 with %" PetscInt_FMT " frames\n",
                      s->folder->path, s->bytes / 1e6, s->bytes_h5 / 1e6, s->frames));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Print a JSON string: quotes, backslashes and control characters are escaped. */
void SummaryPrintString(FILE *f, const char *text) {
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

/* Print the least and the largest ratio of viscosities, unless all are 1. */
static void JsonPrintRatios(FILE *f, Scene scene) {
  PetscReal low = PETSC_MAX_REAL, high = 0;
  if (!SceneHasContrast(scene)) return;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) {
    low = PetscMin(low, SceneViscosityRatio(scene, v));
    high = PetscMax(high, SceneViscosityRatio(scene, v));
  }
  fprintf(f, "  \"viscosity_ratio\": [%.6g, %.6g],\n", (double)low, (double)high);
}

/* Print the warnings of the run, in order, that of the scene first. */
static void JsonPrintWarnings(FILE *f, const char scene[], const Warnings *w) {
  fprintf(f, "  \"warnings\": [");
  if (*scene) SummaryPrintString(f, scene);
  for (PetscInt k = 0; k < w->n; k++) {
    if (k || *scene) fprintf(f, ", ");
    SummaryPrintString(f, w->text[k]);
  }
  fprintf(f, "],\n");
}

static void JsonPrintRow(FILE *f, const Record *record) {
  fprintf(f, ",\n  \"last\": {");
  for (int c = 0; c < COLUMN_COUNT; c++) {
    fprintf(f, "%s\"%s\": ", c ? ", " : "", SeriesColumns[c]);
    if (PetscIsInfOrNanReal(record->last[c]))
      fprintf(f, "null");
    else
      fprintf(f, "%.17g", (double)record->last[c]);
  }
  fprintf(f, "},\n");
}

/* When and where the run ended, the words that its process was started with, versions. */
void SummaryPrintOrigin(FILE *f) {
  FILE *const started = fopen("/proc/self/cmdline", "r"); /* with a zero behind each word */
  char *word = NULL;
  size_t room = 0;
  char host[128] = "", date[32] = "";
  const time_t now = time(NULL);
  struct tm utc;
  (void)gethostname(host, sizeof(host) - 1);
  (void)strftime(date, sizeof(date), "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  fprintf(f, "  \"ended\": \"%s\",\n  \"host\": ", date);
  SummaryPrintString(f, host);
  fprintf(f, ",\n  \"command\": [");
  for (int k = 0; started && getdelim(&word, &room, 0, started) > 0; k++) {
    fprintf(f, k ? ", " : "");
    SummaryPrintString(f, word);
  }
  fprintf(f, "],\n");
  free(word);
  if (started) fclose(started);
  JsonPrintVersions(f);
  fprintf(f, "  \"git_commit\": \"%s\"\n}\n", PetvesCommit());
}

static PetscErrorCode JsonPrint(FILE *f, const void *what) {
  static const char *const models[] = {"unsteady", "none", "unsteady", "convective"}; /* of InertiaType */
  const Summary *s = what;
  const Record *r = s->record;
  const Scene scene = s->scheme->scene;
  struct rusage usage;
  int ranks;
  (void)MPI_Comm_size(s->folder->comm, &ranks);
  fprintf(f, "{\n  \"reason\": ");
  SummaryPrintString(f, s->reason);
  JsonPrintRow(f, r);
  fprintf(f,
          "  \"totals\": {\"steps\": %d, \"nsolve\": %d, \"tension_its\": %d, \"bending_its\": %d, "
          "\"coupled_its\": %d},\n",
          (int)s->scheme->state.step, (int)r->solves, (int)r->tension, (int)r->bending, (int)r->coupled);
  fprintf(f, "  \"wall_seconds\": {\"run\": %.6f", (double)s->seconds);
  for (int p = 0; p < PHASE_COUNT; p++) fprintf(f, ", \"%s\": %.6f", PhaseNames[p], (double)PhaseSeconds((Phase)p));
  (void)getrusage(RUSAGE_SELF, &usage);
  fprintf(f, "},\n  \"memory_mib_rank_0\": %.1f,\n", (double)usage.ru_maxrss / 1024);
  fprintf(f, "  \"markers\": %d,\n  \"cells\": [%d, %d],\n  \"ranks\": %d,\n", (int)s->scheme->membrane->layout->M,
          (int)scene->fluid.cells[0], (int)scene->fluid.cells[1], ranks);
  fprintf(f, "  \"written\": {\"frames\": %d, \"bytes\": %.0f, \"bytes_run_h5\": %.0f},\n", (int)s->frames, s->bytes,
          s->bytes_h5);
  JsonPrintRatios(f, scene);
  fprintf(f, "  \"inertia\": \"%s\",\n", models[scene->fluid.inertia]);
  /* null: not known; of the steps without convection the CFL number is 0 */
  fprintf(f, scene->reynolds >= 0 ? "  \"reynolds\": %.6g,\n" : "  \"reynolds\": null,\n", (double)scene->reynolds);
  fprintf(f, "  \"cfl_max\": %.6g,\n", (double)r->cfl_max);
  JsonPrintWarnings(f, scene->warning, &s->scheme->warnings);
  SummaryPrintOrigin(f);
  return PETSC_SUCCESS;
}

PetscErrorCode SummaryEnd(Summary *s, PetscInt frames, const char reason[], const char failure[]) {
  PetscLogDouble now;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  s->seconds = now - s->clock.start;
  s->frames = frames;
  s->reason = failure ? failure : reason;
  SummaryCountBytes(s);
  PetscCall(FolderWriteText(s->folder, "summary.json", JsonPrint, s));
  PetscCall(SummaryProgress(s, PETSC_TRUE));
  PetscCall(TablePrint(s, failure ? "stopped" : reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}
