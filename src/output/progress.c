#include "output/progress.h"

/* Seconds between progress lines. */
#define PROGRESS_SECONDS 2

PetscErrorCode ProgressStart(Progress *p, MPI_Comm comm) {
  PetscFunctionBeginUser;
  p->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &p->rank));
  PetscCall(PetscTime(&p->start));
  p->printed = p->start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ProgressSeconds(const Progress *p) {
  PetscLogDouble now;
  (void)PetscTime(&now);
  return now - p->start;
}

PetscErrorCode ProgressLine(Progress *p, const State *q, PetscReal t_end, PetscBool force) {
  PetscLogDouble now;
  PetscReal share, left;
  PetscFunctionBeginUser;
  if (p->rank || PetvesIsQuiet()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&now));
  if (!force && now - p->printed < PROGRESS_SECONDS) PetscFunctionReturn(PETSC_SUCCESS);
  p->printed = now;
  share = t_end > 0 ? PetscMin(1, q->t / t_end) : 1;
  left = share > 0 ? (now - p->start) * (1 - share) / share : 0;
  printf("step %" PetscInt_FMT "  time %.6g  %3.0f %%  %.0f s left\n", q->step, (double)q->t, 100 * (double)share,
         left);
  fflush(stdout);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lines that only a run with vesicles has. */
static PetscErrorCode PrintVesicles(MPI_Comm comm, const Record *record, PetscInt steps) {
  const PetscReal *r = record->last;
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(comm, "  energy, kinetic and bending   %.6e  %.6e\n", (double)r[COLUMN_KINETIC],
                      (double)r[COLUMN_BENDING]));
  PetscCall(PetvesSay(comm, "  area error, length error      %.3e  %.3e\n", (double)r[COLUMN_AREA_ERROR],
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

PetscErrorCode ProgressTable(const Progress *p, const Record *record, const char folder[], const Written *w,
                             const char reason[]) {
  const PetscReal *r = record->last;
  const PetscInt step = (PetscInt)r[COLUMN_STEP], steps = PetscMax(step, 1);
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(p->comm, "\n%s at time %g after %" PetscInt_FMT " steps, %.2f s\n", reason,
                      (double)r[COLUMN_TIME], step, (double)ProgressSeconds(p)));
  if (record->vesicles) PetscCall(PrintVesicles(p->comm, record, steps));
  PetscCall(PetvesSay(p->comm, "  max |div u|                   %.3e\n", (double)r[COLUMN_DIV]));
  PetscCall(PetvesSay(p->comm, "  fast solves a step            %.1f\n", (double)record->solves / (double)steps));
  PetscCall(PetvesSay(p->comm, "  seconds: fast solves %.2f, rest of the steps %.2f, output %.2f\n",
                      (double)PhaseSeconds(PHASE_FAST_SOLVE), (double)PhaseSeconds(PHASE_STEP),
                      (double)PhaseSeconds(PHASE_OUTPUT)));
  PetscCall(PetvesSay(p->comm, "  files in %s: %.3g MB, %.3g MB of them run.h5 with %" PetscInt_FMT " frames\n", folder,
                      w->all / 1e6, w->h5 / 1e6, w->frames));
  PetscFunctionReturn(PETSC_SUCCESS);
}
