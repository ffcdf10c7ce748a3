#include "scheme/directrows.h"

/* Rank that holds a global row of a field. */
static PetscInt Owner(Grid g, PetscInt j) {
  return PetscMin(j / g->block, g->size - 1);
}

PetscInt DirectRows(Grid g, PetscInt rank, int f) {
  return rank < g->size - 1 ? g->block : g->all_rows[f] - (g->size - 1) * g->block;
}

PetscInt DirectIndex(DirectSolver d, int f, PetscInt i, PetscInt j) {
  const Grid g = d->fluid->grid;
  const PetscInt rank = Owner(g, j);
  PetscInt index = d->start[rank] + (j - rank * g->block) * g->columns[f] + i;
  for (int k = 0; k < f; k++) index += g->columns[k] * DirectRows(g, rank, k);
  return index;
}

PetscErrorCode DirectFactors(DirectSolver d, int side, Vec factors) {
  const Grid g = d->fluid->grid;
  const PetscReal h = g->h, force = side ? d->fluid->nu / (h * h) : h * h / d->fluid->nu;
  const PetscInt there = g->rank == g->size - 1, mean = MeanForces(d);
  const struct {
    PetscInt n;
    PetscReal factor;
  } part[] = {{GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V], side ? 1 : force},
              {g->columns[FIELD_P] * g->rows[FIELD_P], side ? force * h : h},
              {there * d->M, side ? force * h * h : h * h},
              {there * 2 * d->M, 1},
              {there * 2 * d->M, force},
              {there * 2 * d->W, side ? force : 1},
              {there * (Others(d) - 5 * d->M - 2 * d->W - mean), 1},
              {there * mean, side ? force : 1}};
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(factors, &a));
  for (size_t k = 0, at = 0; k < PETSC_STATIC_ARRAY_LENGTH(part); k++)
    for (PetscInt i = 0; i < part[k].n; i++) a[at++] = part[k].factor;
  PetscCall(VecRestoreArrayWrite(factors, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
