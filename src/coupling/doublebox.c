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
  PetscCall(PetscMalloc2(BOX_COMPONENTS * n * b->table.rank, &b->rows, b->table.rank, &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxDestroy(DoubleBox *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxTableDestroy(&(*box)->table));
  PetscCall(PetscFree2((*box)->rows, (*box)->amplitude));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void DoubleBoxPlace(DoubleBox b) {
  const Layout l = b->markers->layout;
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = b->markers->X + 2 * (l->first + k);
    BoxTableRows(&b->table, b->markers->grid, X, 1, 0, BOX_COMPONENTS, b->rows + BOX_COMPONENTS * k * b->table.rank);
  }
}

/* Of own marker k: a component of its velocity (0, 1) or of its tensor (from 2 on). */
static const PetscReal *Row(DoubleBox b, PetscInt k, PetscInt component) {
  return b->rows + (BOX_COMPONENTS * k + component) * b->table.rank;
}

PetscErrorCode DoubleBoxApply(DoubleBox b, PetscReal alpha, const PetscReal T[], PetscScalar y[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->table.rank;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->amplitude, r));
  for (PetscInt k = 0; k < DIPOLE_COUNT * l->n; k++) {
    const PetscReal *source = Row(b, k / DIPOLE_COUNT, 2 + k % DIPOLE_COUNT);
    for (PetscInt m = 0; m < r; m++) b->amplitude[m] += source[m] * T[k];
  }
  if (l->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, (PetscMPIInt)r, MPIU_REAL, MPI_SUM, l->comm));
  for (PetscInt m = 0; m < r; m++) b->amplitude[m] *= alpha * b->table.l[m];
  for (PetscInt k = 0; k < 2 * l->n; k++) y[k] += BoxSum(r, b->amplitude, Row(b, k / 2, k % 2));
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
        out[(DIPOLE_COUNT * j + c) * 2 * l->M + 2 * l->first + i] += BoxSum(r, source + c * r, Row(b, i / 2, i % 2));
  }
  PetscCall(PetscFree(source));
  PetscFunctionReturn(PETSC_SUCCESS);
}
