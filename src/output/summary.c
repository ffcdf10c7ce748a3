/* summary.json, the progress line and the table that a run ends with. */
#include "output/output.h"
#include <fftw3.h>
#include <sys/resource.h>

#ifndef PETVES_COMMIT
#define PETVES_COMMIT "unknown"
#endif

/* Seconds between progress lines. */
#define PROGRESS_SECONDS 2

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
static void WriteInertia(Output o, FILE *f) {
  static const char *const names[] = {"unsteady", "none", "unsteady", "convective"};
  fprintf(f, "  \"inertia\": \"%s\",\n  \"reynolds\": %.6g,\n  \"cfl_max\": %.6g,\n  \"warning\": ",
          names[o->scene->fluid.inertia], (double)o->scene->reynolds, (double)o->cfl_max);
  PrintString(f, o->scene->warning);
  fprintf(f, ",\n");
}

static PetscErrorCode WriteSummary(Output o, FILE *f) {
  PetscMPIInt ranks;
  PetscLogDouble now;
  struct rusage usage;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(o->comm, &ranks));
  (void)PetscTime(&now);
  fprintf(f, "{\n  \"reason\": ");
  PrintString(f, o->reason);
  fprintf(f, ",\n  \"last\": {");
  for (int c = 0; c < COLUMN_COUNT; c++) {
    fprintf(f, "%s\"%s\": ", c ? ", " : "", SeriesColumns[c]);
    if (PetscIsInfOrNanReal(o->last[c]))
      fprintf(f, "null");
    else
      fprintf(f, "%.17g", (double)o->last[c]);
  }
  fprintf(f,
          "},\n  \"totals\": {\"steps\": %d, \"nsolve\": %d, \"tension_its\": %d, \"bending_its\": %d, "
          "\"coupled_its\": %d},\n",
          (int)o->scheme->state.step, (int)o->total_solves, (int)o->total_tension, (int)o->total_bending,
          (int)o->total_coupled);
  fprintf(f, "  \"wall_seconds\": {\"run\": %.6f", now - o->start);
  for (int p = 0; p < PHASE_COUNT; p++) fprintf(f, ", \"%s\": %.6f", PhaseNames[p], (double)PhaseSeconds((Phase)p));
  (void)getrusage(RUSAGE_SELF, &usage);
  fprintf(f, "},\n  \"memory_mib_rank_0\": %.1f,\n", (double)usage.ru_maxrss / 1024);
  fprintf(f, "  \"markers\": %d,\n  \"cells\": [%d, %d],\n  \"ranks\": %d,\n", (int)o->scheme->membrane->M,
          (int)o->scene->fluid.cells[0], (int)o->scene->fluid.cells[1], ranks);
  WriteInertia(o, f);
  PrintVersions(f);
  fprintf(f, "  \"git_commit\": \"%s\"\n}\n", PETVES_COMMIT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSummary(Output o, const char reason[]) {
  PetscFunctionBeginUser;
  if (o->series) fflush(o->series);
  o->reason = reason;
  PetscCall(OutputWriteText(o, "summary.json", WriteSummary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputProgress(Output o, PetscBool force) {
  const State *q = &o->scheme->state;
  PetscLogDouble now;
  PetscReal share, left;
  PetscFunctionBeginUser;
  if (o->rank || o->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&now));
  if (!force && now - o->printed < PROGRESS_SECONDS) PetscFunctionReturn(PETSC_SUCCESS);
  o->printed = now;
  share = o->scene->time.end > 0 ? PetscMin(1, q->t / o->scene->time.end) : 1;
  left = share > 0 ? (now - o->start) * (1 - share) / share : 0;
  printf("step %" PetscInt_FMT "  time %.6g  %3.0f %%  %.0f s left\n", q->step, (double)q->t, 100 * (double)share,
         left);
  fflush(stdout);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputFinalTable(Output o, const char reason[]) {
  const PetscReal *r = o->last;
  const PetscInt steps = PetscMax(o->scheme->state.step, 1);
  PetscLogDouble now;
  PetscFunctionBeginUser;
  if (o->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&now));
  PetscCall(PetscPrintf(o->comm, "\n%s at time %g after %" PetscInt_FMT " steps, %.2f s\n", reason,
                        (double)r[COLUMN_TIME], o->scheme->state.step, now - o->start));
  if (o->scheme->membrane->vesicles) {
    PetscCall(PetscPrintf(o->comm, "  energy, kinetic and bending   %.6e  %.6e\n", (double)r[COLUMN_KINETIC],
                          (double)r[COLUMN_BENDING]));
    PetscCall(PetscPrintf(o->comm, "  area error, length error      %.3e  %.3e\n", (double)r[COLUMN_AREA_ERROR],
                          (double)r[COLUMN_LENGTH_ERROR]));
    PetscCall(PetscPrintf(o->comm, "  inclination (radians)         %.6f\n", (double)r[COLUMN_INCLINATION]));
    if (!PetscIsNanReal(r[COLUMN_FREQUENCY]))
      PetscCall(PetscPrintf(o->comm, "  tank-treading frequency       %.6f\n", (double)r[COLUMN_FREQUENCY]));
    PetscCall(PetscPrintf(o->comm, "  iterations a step             "));
    if (o->total_coupled)
      PetscCall(PetscPrintf(o->comm, "coupled %.1f\n", (double)o->total_coupled / (double)steps));
    else
      PetscCall(PetscPrintf(o->comm, "tension %.1f, bending %.1f\n", (double)o->total_tension / (double)steps,
                            (double)o->total_bending / (double)steps));
  }
  PetscCall(PetscPrintf(o->comm, "  max |div u|                   %.3e\n", (double)r[COLUMN_DIV]));
  PetscCall(PetscPrintf(o->comm, "  fast solves a step            %.1f\n", (double)o->total_solves / (double)steps));
  PetscCall(PetscPrintf(o->comm, "  seconds: fast solves %.2f, rest of the steps %.2f, output %.2f\n",
                        (double)PhaseSeconds(PHASE_FAST_SOLVE), (double)PhaseSeconds(PHASE_STEP),
                        (double)PhaseSeconds(PHASE_OUTPUT)));
  PetscCall(PetscPrintf(o->comm, "  files in %s\n", o->folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}
