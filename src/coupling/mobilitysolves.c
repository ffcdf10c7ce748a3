#include "coupling/mobilitysolves.h"
#include "fluid/stokes.h"
#include "markers/respond.h"

PetscErrorCode MobilitySolves(Coupling c, PetscMPIInt root, PetscReal Mob[]) {
  const Layout l = c->bodies->obstacles->layout;
  const PetscInt n = 2 * l->M, own = BodiesFirstObstacle(c->bodies);
  const PetscReal part = CouplingGridPart(c, c->fluid->alpha); /* of the velocity that markers have */
  const PetscScalar *u;
  PetscScalar *f, *column;
  Stokes stokes;
  Vec F, U;
  PetscFunctionBeginUser;
  PetscCall(StokesCreate(c->fluid, &stokes));
  PetscCall(VecDuplicate(c->X, &F));
  PetscCall(VecDuplicate(c->X, &U));
  PetscCall(VecSet(F, 0));
  PetscCall(PetscMalloc1(n, &column));
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt at = j - 2 * l->first;
    PetscCall(VecGetArray(F, &f));
    for (PetscInt k = 0; k < 2 * l->n; k++) f[own + k] = k == at ? 1 : 0;
    PetscCall(VecRestoreArray(F, &f));
    PetscCall(MarkersRespond(c->markers, StokesStream(stokes), NULL, part, F, U));
    PetscCall(VecGetArrayRead(U, &u));
    PetscCall(LayoutToRank(l, root, 2, u + own, l->rank == root ? Mob + j * n : column));
    PetscCall(VecRestoreArrayRead(U, &u));
  }
  PetscCall(PetscFree(column));
  PetscCall(VecDestroy(&F));
  PetscCall(VecDestroy(&U));
  PetscCall(StokesDestroy(&stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
