/* After an unsplit step: the new state takes its place, and its markers are moved to their area and edge lengths. */
#include "base/agree.h"
#include "scheme/coupled.h"

#define EDGE_WARNING 0.01 /* relative error of an edge that is worth a warning */

/* What happened to the vesicles; `who` has the largest error of an edge. */
typedef struct {
  PetscReal most, least; /* shift that restored an area (length) */
  PetscReal error;       /* of an edge that was corrected */
  PetscInt who;
} Restored;

/* Once a run: an edge that was off by this much shows that the step is too large. */
static PetscErrorCode WarnOfEdges(Scheme s, Coupled *d, const Restored *r) {
  char message[PETVES_MAX_MESSAGE] = "";
  PetscFunctionBeginUser;
  if (r->error >= EDGE_WARNING)
    PetscCall(PetscSNPrintf(message, sizeof(message),
                            "vesicle %" PetscInt_FMT ": an edge was off by %.2g of its length after step "
                            "%" PetscInt_FMT " and has been corrected; try a smaller -time_step",
                            r->who + 1, (double)r->error, s->state.step + 1));
  PetscCall(AgreeMessage(s->membrane->layout->comm, message));
  PetscCall(SchemeWarn(s, "%s", message));
  d->warned = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each owner its vesicles. The old markers stay: X* and Xhat then go along the constraints and do not carry on what was
   corrected. */
static PetscErrorCode RestoreMarkers(Scheme s, Coupled *d) {
  const Layout l = s->membrane->layout;
  PetscScalar *X;
  PetscReal largest[3], shift, error;
  Restored r = {0};
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(s->state.X, &X));
  for (PetscInt v = l->own; v < l->end; v++) {
    PetscCall(
        LawRestore(s->coupling->law, v, s->scene->scheme.length_target, X + 2 * LayoutOffset(l, v), &shift, &error));
    r.most = PetscMax(r.most, shift);
    r.least = PetscMin(r.least, shift);
    if (error > r.error) r.who = v;
    r.error = PetscMax(r.error, error);
  }
  PetscCall(VecRestoreArray(s->state.X, &X));
  largest[0] = r.most;
  largest[1] = -r.least;
  largest[2] = r.error;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPIU_REAL, MPI_MAX, l->comm));
  shift = largest[0] >= largest[1] ? largest[0] : -largest[1];
  if (PetscAbsReal(shift) > PetscAbsReal(s->report.area_shift)) s->report.area_shift = shift;
  if (largest[2] >= EDGE_WARNING && !d->warned) PetscCall(WarnOfEdges(s, d, &r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledAdvance(Scheme s, PetscReal dt) {
  Coupled *d = (Coupled *)s->data;
  PetscFunctionBeginUser;
  for (int j = SCHEME_PAST - 1; j > 0; j--) {
    StateSwap(&s->old[j], &s->old[j - 1]);
    s->old[j].dt_last = s->old[j - 1].dt_last;
  }
  StateSwap(&s->old[0], &s->state);
  StateSwap(&s->state, &d->next);
  s->old[0].dt_last = s->state.dt_last;
  s->state.dt_last = dt;
  s->state.fields = CoupledMakes(d);
  s->past = PetscMin(s->past + 1, SCHEME_PAST);
  s->plan.order = d->next_plan.order;
  s->plan.guess = d->next_plan.guess;
  if (CouplingHasMembrane(s->coupling)) PetscCall(RestoreMarkers(s, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}
