#include "markers/rows.h"
#include "base/lanes.h"

#define AHEAD 16 /* entries from the one in use to the one that is fetched into the cache */

/* The local row of entry b of a stencil: one of this rank's rows or the row above them; -1 for any other row. Beyond a
   wall only zero weights can fall: markers keep three cells away, or stencils are folded. */
static inline PetscInt StencilLocalRow(const Grid g, int comp, const Stencil *s, PetscInt b) {
  PetscInt j = s->first[1] + b;
  if (!g->wall[1] && j >= g->n[1]) j -= g->n[1];
  j -= g->first;
  if (j >= 0 && j <= g->rows[comp]) return j;
  return !g->wall[1] && j + g->n[1] == g->rows[comp] ? g->rows[comp] : -1; /* the row above, across the periodic seam */
}

PetscErrorCode MarkerRowsPlace(MarkerRows r, const Stencil stencil[]) {
  const Grid g = r->grid;
  PetscFunctionBeginUser;
  r->stencil = stencil;
  for (int c = 0; c < 2; c++) {
    PetscInt *start = r->start[c], j;
    PetscCall(PetscArrayzero(start, g->rows[c] + 2));
    for (PetscInt k = c; k < r->stencils; k += 2)
      for (PetscInt b = 0; b < stencil[k].n[1]; b++)
        if ((j = StencilLocalRow(g, c, &stencil[k], b)) >= 0) start[j + 1]++;
    for (j = 0; j <= g->rows[c]; j++) start[j + 1] += start[j];
    if (start[g->rows[c] + 1] > r->room[c]) {
      r->room[c] = start[g->rows[c] + 1] * 11 / 10;
      PetscCall(PetscFree(r->entry[c]));
      PetscCall(PetscCalloc1(r->room[c] + AHEAD, &r->entry[c]));
    }
    for (PetscInt k = c; k < r->stencils; k += 2)
      for (PetscInt b = 0; b < stencil[k].n[1]; b++)
        if ((j = StencilLocalRow(g, c, &stencil[k], b)) >= 0)
          r->entry[c][start[j]++] = (RowEntry){.stencil = k, .entry = b};
    for (j = g->rows[c] + 1; j > 0; j--) start[j] = start[j - 1]; /* start[j] has become the start of row j + 1 */
    start[0] = 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fetch a stencil that is used some entries later: the stencils of a row lie far apart in memory. */
static inline void RowPrefetch(MarkerRows r, Field f, PetscInt e) {
  const char *next = (const char *)&r->stencil[r->entry[f][e + AHEAD].stencil];
  __builtin_prefetch(next);
  __builtin_prefetch(next + 64);
}

/* row += force times the weights of a stencil along x. */
static inline void RowAddStencil(const Grid g, PetscInt columns, const Stencil *s, PetscScalar force,
                                 PetscScalar row[]) {
  const PetscInt i0 = s->first[0];
  const PetscReal *weight = s->weight[0];
  if (i0 >= 0 && i0 + LANES <= columns && i0 + s->n[0] <= columns) {
    LanesPut(LanesAt(row + i0) + force * LanesAt(weight), row + i0);
    for (PetscInt a = LANES; a < s->n[0]; a++) row[i0 + a] += force * weight[a];
  } else
    for (PetscInt a = 0; a < s->n[0]; a++) {
      const PetscInt i = g->wall[0] ? i0 + a : (i0 + a) % columns;
      if (i >= 0 && i < columns) row[i] += force * weight[a];
    }
}

void MarkerRowSpread(MarkerRows r, Field f, PetscInt j, PetscReal alpha, const PetscScalar F[], PetscScalar row[]) {
  for (PetscInt e = r->start[f][j]; e < r->start[f][j + 1]; e++) {
    const RowEntry at = r->entry[f][e];
    const Stencil *s = &r->stencil[at.stencil];
    RowPrefetch(r, f, e);
    RowAddStencil(r->grid, r->grid->columns[f], s, alpha * F[at.stencil] * s->weight[1][at.entry], row);
  }
}

void MarkerRowsSpread(MarkerRows r, Field f, PetscReal alpha, const PetscScalar F[], PetscScalar all[]) {
  const Grid g = r->grid;
  const PetscInt columns = g->columns[f];
  for (PetscInt k = f; k < r->stencils; k += 2) {
    const Stencil *s = &r->stencil[k];
    for (PetscInt b = 0; b < s->n[1]; b++) {
      const PetscInt j = StencilLocalRow(g, f, s, b);
      if (j >= 0 && j < g->rows[f]) RowAddStencil(g, columns, s, alpha * F[k] * s->weight[1][b], all + j * columns);
    }
  }
}

void MarkerRowInterpolate(MarkerRows r, Field f, PetscInt j, const PetscScalar row[], PetscScalar U[]) {
  const PetscInt columns = r->grid->columns[f];
  for (PetscInt e = r->start[f][j]; e < r->start[f][j + 1]; e++) {
    const RowEntry at = r->entry[f][e];
    const Stencil *s = &r->stencil[at.stencil];
    RowPrefetch(r, f, e);
    const PetscInt i0 = s->first[0];
    const PetscReal *weight = s->weight[0];
    PetscScalar line = 0;
    if (i0 >= 0 && i0 + LANES <= columns && i0 + s->n[0] <= columns) {
      line = LanesSum(LanesAt(row + i0) * LanesAt(weight));
      for (PetscInt a = LANES; a < s->n[0]; a++) line += row[i0 + a] * weight[a];
    } else
      for (PetscInt a = 0; a < s->n[0]; a++) {
        const PetscInt i = r->grid->wall[0] ? i0 + a : (i0 + a) % columns;
        if (i >= 0 && i < columns) line += row[i] * weight[a];
      }
    U[at.stencil] += line * s->weight[1][at.entry];
  }
}

PetscErrorCode MarkerRowsCreate(Grid g, PetscInt stencils, MarkerRows *out) {
  MarkerRows r;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  *out = r;
  r->grid = g;
  r->stencils = stencils;
  PetscCall(PetscCalloc2(g->rows[FIELD_U] + 2, &r->start[0], g->rows[FIELD_V] + 2, &r->start[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkerRowsDestroy(MarkerRows *rows) {
  MarkerRows r = *rows;
  PetscFunctionBeginUser;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  for (int c = 0; c < 2; c++) PetscCall(PetscFree(r->entry[c]));
  PetscCall(PetscFree2(r->start[0], r->start[1]));
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}
