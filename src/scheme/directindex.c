#include "scheme/direct.h"

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
