#include "output/summary.h"
#include "base/version.h"
#include <fftw3.h>
#include <hdf5.h>
#include <sys/resource.h>

/* A JSON string: quotes, backslashes and control characters escaped. */
static void PrintString(FILE *f, const char *text) {
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

static void PrintVersions(FILE *f) {
  char petsc[256] = "";
  unsigned major, minor, release;
  (void)PetscGetVersion(petsc, sizeof(petsc));
  (void)H5get_libversion(&major, &minor, &release);
  fprintf(f,
          "  \"versions\": {\"petves\": \"%s\", \"petsc\": \"%d.%d.%d\", \"fftw\": \"%s\", \"hdf5\": \"%u.%u.%u\"},\n",
          PETVES_VERSION, PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR, fftw_version, major, minor,
          release);
}

/* The model of the fluid, how much inertia there is, the largest CFL number of a step (0 without convection). */
static void PrintInertia(FILE *f, Scene scene, PetscReal cfl_max) {
  static const char *const names[] = {"unsteady", "none", "unsteady", "convective"};
  fprintf(f, "  \"inertia\": \"%s\",\n  \"reynolds\": %.6g,\n  \"cfl_max\": %.6g,\n  \"warning\": ",
          names[scene->fluid.inertia], (double)scene->reynolds, (double)cfl_max);
  PrintString(f, scene->warning);
  fprintf(f, ",\n");
}

/* The least and the largest ratio of viscosities, where they are not all 1. */
static void PrintRatios(FILE *f, Scene scene) {
  PetscReal low = PETSC_MAX_REAL, high = 0;
  if (!SceneHasContrast(scene)) return;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) {
    low = PetscMin(low, SceneViscosityRatio(scene, v));
    high = PetscMax(high, SceneViscosityRatio(scene, v));
  }
  fprintf(f, "  \"viscosity_ratio\": [%.6g, %.6g],\n", (double)low, (double)high);
}

/* What the run has warned of, in order. */
static void PrintWarnings(FILE *f, const Warnings *w) {
  fprintf(f, "  \"warnings\": [");
  for (PetscInt k = 0; k < w->n; k++) {
    if (k) fprintf(f, ", ");
    PrintString(f, w->text[k]);
  }
  fprintf(f, "],\n");
}

static void PrintRow(FILE *f, const Record *record) {
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

/* What is printed. */
typedef struct {
  Scheme scheme;
  const Record *record;
  const Written *written;
  const char *reason;
  PetscReal seconds;
  PetscMPIInt ranks;
} Summary;

static PetscErrorCode Print(FILE *f, const void *what) {
  const Summary *s = what;
  const Record *r = s->record;
  struct rusage usage;
  fprintf(f, "{\n  \"reason\": ");
  PrintString(f, s->reason);
  PrintRow(f, r);
  fprintf(f,
          "  \"totals\": {\"steps\": %d, \"nsolve\": %d, \"tension_its\": %d, \"bending_its\": %d, "
          "\"coupled_its\": %d},\n",
          (int)s->scheme->state.step, (int)r->solves, (int)r->tension, (int)r->bending, (int)r->coupled);
  fprintf(f, "  \"wall_seconds\": {\"run\": %.6f", (double)s->seconds);
  for (int p = 0; p < PHASE_COUNT; p++) fprintf(f, ", \"%s\": %.6f", PhaseNames[p], (double)PhaseSeconds((Phase)p));
  (void)getrusage(RUSAGE_SELF, &usage);
  fprintf(f, "},\n  \"memory_mib_rank_0\": %.1f,\n", (double)usage.ru_maxrss / 1024);
  fprintf(f, "  \"markers\": %d,\n  \"cells\": [%d, %d],\n  \"ranks\": %d,\n", (int)s->scheme->membrane->layout->M,
          (int)s->scheme->scene->fluid.cells[0], (int)s->scheme->scene->fluid.cells[1], s->ranks);
  fprintf(f, "  \"written\": {\"frames\": %d, \"bytes\": %.0f, \"bytes_run_h5\": %.0f},\n", (int)s->written->frames,
          s->written->all, s->written->h5);
  PrintRatios(f, s->scheme->scene);
  PrintInertia(f, s->scheme->scene, r->cfl_max);
  PrintWarnings(f, &s->scheme->warnings);
  PrintVersions(f);
  fprintf(f, "  \"git_commit\": \"%s\"\n}\n", PetvesCommit());
  return PETSC_SUCCESS;
}

PetscErrorCode SummaryWrite(Folder *folder, Scheme scheme, const Record *record, const Written *written,
                            PetscReal seconds, const char reason[]) {
  Summary summary = {scheme, record, written, reason, seconds, 1};
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(folder->comm, &summary.ranks));
  PetscCall(FolderWriteText(folder, "summary.json", Print, &summary));
  PetscFunctionReturn(PETSC_SUCCESS);
}
