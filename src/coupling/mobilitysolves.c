#include "coupling/mobilitysolves.h"
#include "fluid/stokes.h"
#include "markers/respond.h"

/* Where a column is made. */
typedef struct {
  Coupling coupling; /* borrowed */
  Stokes stokes;
  Stream stream; /* borrowed; NULL: on the grid */
  Vec F, U;      /* marker vectors of all bodies */
  Vec w, p;      /* on the grid */
} Solves;

static PetscErrorCode Create(Coupling c, Solves *s) {
  PetscFunctionBeginUser;
  *s = (Solves){.coupling = c};
  PetscCall(StokesCreate(c->fluid, &s->stokes));
  s->stream = StokesStream(s->stokes);
  PetscCall(VecDuplicate(c->X, &s->F));
  PetscCall(VecDuplicate(c->X, &s->U));
  PetscCall(VecSet(s->F, 0));
  if (s->stream) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMCreateGlobalVector(c->fluid->grid->velocity, &s->w));
  PetscCall(DMCreateGlobalVector(c->fluid->grid->da[FIELD_P], &s->p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Solves *s) {
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&s->F));
  PetscCall(VecDestroy(&s->U));
  PetscCall(VecDestroy(&s->w));
  PetscCall(VecDestroy(&s->p));
  PetscCall(StokesDestroy(&s->stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U = E A^-1 E^T F, the part of it that the markers have. */
static PetscErrorCode Respond(Solves *s) {
  const Markers m = s->coupling->markers;
  const PetscReal part = CouplingGridPart(s->coupling, s->coupling->fluid->alpha);
  PetscFunctionBeginUser;
  if (s->stream) {
    PetscCall(MarkersRespond(m, s->stream, NULL, part, s->F, s->U));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecSet(s->w, 0));
  PetscCall(MarkersSpread(m, part, s->F, s->w));
  PetscCall(StokesSolve(s->stokes, s->w, NULL, s->w, s->p));
  PetscCall(MarkersInterpolate(m, s->w, s->U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilitySolves(Coupling c, PetscMPIInt root, PetscReal Mob[]) {
  const Layout l = c->bodies->obstacles->layout;
  const PetscInt n = 2 * l->M, own = BodiesFirstObstacle(c->bodies);
  const PetscScalar *U;
  PetscScalar *F, *part;
  Solves s;
  PetscFunctionBeginUser;
  PetscCall(Create(c, &s));
  PetscCall(PetscMalloc1(n, &part));
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt at = j - 2 * l->first;
    PetscCall(VecGetArray(s.F, &F));
    for (PetscInt k = 0; k < 2 * l->n; k++) F[own + k] = k == at ? 1 : 0;
    PetscCall(VecRestoreArray(s.F, &F));
    PetscCall(Respond(&s));
    PetscCall(VecGetArrayRead(s.U, &U));
    PetscCall(LayoutToRank(l, root, 2, U + own, l->rank == root ? Mob + j * n : part));
    PetscCall(VecRestoreArrayRead(s.U, &U));
  }
  PetscCall(PetscFree(part));
  PetscCall(Destroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
