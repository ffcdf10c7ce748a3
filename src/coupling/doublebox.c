#include "coupling/doublebox.h"

PetscErrorCode DoubleBoxCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice, DoubleBox *out) {
  const PetscInt n = markers->layout->n;
  DoubleBox b;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->markers = markers;
  PetscCall(PetvesEvent("BoxTable", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(BoxTableCreate(spec, markers->kernel->name, lattice, &b->table));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscCall(PetscMalloc3(2 * n * b->table.rank, &b->response, DIPOLE_COUNT * n * b->table.rank, &b->source,
                         b->table.rank, &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxDestroy(DoubleBox *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxTableDestroy(&(*box)->table));
  PetscCall(PetscFree3((*box)->response, (*box)->source, (*box)->amplitude));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void DoubleBoxPlace(DoubleBox b) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->table.rank;
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = b->markers->X + 2 * (l->first + k);
    BoxTableRows(&b->table, b->markers->grid, X, 1, 0, 2, b->response + 2 * k * r);
    BoxTableRows(&b->table, b->markers->grid, X, 1, 2, DIPOLE_COUNT, b->source + DIPOLE_COUNT * k * r);
  }
}

PetscErrorCode DoubleBoxApply(DoubleBox b, PetscReal alpha, const PetscReal T[], PetscScalar y[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->table.rank;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->amplitude, r));
  for (PetscInt k = 0; k < DIPOLE_COUNT * l->n; k++)
    for (PetscInt m = 0; m < r; m++) b->amplitude[m] += b->source[k * r + m] * T[k];
  if (l->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, (PetscMPIInt)r, MPIU_REAL, MPI_SUM, l->comm));
  for (PetscInt m = 0; m < r; m++) b->amplitude[m] *= alpha * b->table.l[m];
  for (PetscInt k = 0; k < 2 * l->n; k++) y[k] += BoxSum(r, b->amplitude, b->response + k * r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxMatrix(DoubleBox b, PetscReal scale, PetscReal out[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->table.rank;
  PetscReal *source;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(DIPOLE_COUNT * r, &source));
  for (PetscInt j = 0; j < l->M; j++) {
    const PetscReal *X = b->markers->X + 2 * j;
    BoxTableRows(&b->table, b->markers->grid, X, scale, 2, DIPOLE_COUNT, source);
    for (PetscInt k = 0; k < DIPOLE_COUNT * r; k++) source[k] *= b->table.l[k % r];
    for (int c = 0; c < DIPOLE_COUNT; c++)
      for (PetscInt i = 0; i < 2 * l->n; i++)
        out[(DIPOLE_COUNT * j + c) * 2 * l->M + 2 * l->first + i] += BoxSum(r, source + c * r, b->response + i * r);
  }
  PetscCall(PetscFree(source));
  PetscFunctionReturn(PETSC_SUCCESS);
}
