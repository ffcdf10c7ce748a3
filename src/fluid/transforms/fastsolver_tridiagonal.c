/* Back end "fftw_tridiagonal": transforms along the rows, tridiagonal solves across them. */
#include "fluid/transforms/fastsolver.h"
#include "fluid/transforms/rowtransform.h"
#include "fluid/transforms/tridiagonal.h"

typedef struct {
  RowTransform t;
  Tridiagonal d;
} Solver;

static PetscErrorCode SetCoefficients_Tridiagonal(FastSolver s) {
  Solver *q = (Solver *)s->data;
  PetscFunctionBeginUser;
  PetscCall(TridiagonalSetCoefficients(q->d, s->a0, s->nu, s->singular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve_Tridiagonal(FastSolver s, const PetscScalar b[], PetscScalar x[]) {
  Solver *q = (Solver *)s->data;
  const PetscInt rows = s->grid->rows[s->field], columns = s->grid->columns[s->field];
  PetscFunctionBeginUser;
  PetscCall(SlabsReserve(q->d->slabs));
  for (PetscInt j = 0; j < rows; j++) {
    RowTransformForward(q->t, b + j * columns);
    TridiagonalUp(q->d, j, q->t->modes);
  }
  PetscCall(TridiagonalEnd(q->d));
  for (PetscInt j = rows - 1; j >= 0; j--) {
    TridiagonalDown(q->d, j, q->t->modes);
    RowTransformBackward(q->t, x + j * columns);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Tridiagonal(FastSolver s) {
  Solver *q = (Solver *)s->data;
  PetscFunctionBeginUser;
  PetscCall(TridiagonalDestroy(&q->d));
  PetscCall(RowTransformDestroy(&q->t));
  PetscCall(PetscFree(s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverCreate_Tridiagonal(FastSolver s) {
  Solver *q;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&q));
  s->data = q;
  s->solve = Solve_Tridiagonal;
  s->setcoefficients = SetCoefficients_Tridiagonal;
  s->destroy = Destroy_Tridiagonal;
  PetscCall(RowTransformCreate(s->grid, s->field, &q->t));
  PetscCall(TridiagonalCreate(s->grid, s->field, q->t->width, q->t->lambda, q->t->scale, &q->d));
  PetscFunctionReturn(PETSC_SUCCESS);
}
