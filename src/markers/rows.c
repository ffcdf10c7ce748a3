#include "markers/rows.h"

#define AHEAD 16 /* entries from the one in use to the one that is fetched into the cache */

static PetscInt StencilRowsCount(StencilRows r) {
  return r->grid->rows[FIELD_U] + r->below + r->above;
}

PetscErrorCode StencilRowsCreate(Grid g, const StencilForm *form, PetscInt below, PetscInt above, StencilRows *out) {
  StencilRows r;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  *out = r;
  r->grid = g;
  r->form = form;
  r->below = below;
  r->above = above;
  for (int f = 0; f < 3; f++) PetscCall(PetscCalloc1(StencilRowsCount(r) + 2, &r->start[f]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StencilRowsDestroy(StencilRows *rows) {
  PetscFunctionBeginUser;
  if (!*rows) PetscFunctionReturn(PETSC_SUCCESS);
  for (int f = 0; f < 3; f++) {
    PetscCall(PetscFree((*rows)->start[f]));
    PetscCall(PetscFree((*rows)->entry[f]));
  }
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Count the rows of stencil k in start[j + 2] or, with put, put its entries at start[j + 1]. Across a periodic seam a
   row may be in the list more than once. */
static void StencilRowsVisit(StencilRows r, PetscInt k, PetscBool put) {
  const Grid g = r->grid;
  const Stencil *s = &r->stencil[k];
  const PetscInt q = k % r->form->stencils, source = k / r->form->stencils * r->form->parts + r->form->of[q].part;
  const PetscInt rows = StencilRowsCount(r), period = g->wall[1] ? PETSC_MAX_INT / 2 : g->n[1];
  PetscInt *start = r->start[r->form->of[q].field], first = s->first[1] - g->first + r->below;
  if (!g->wall[1]) first = (first % period + period) % period;
  for (PetscInt b = 0; b < s->n[1]; b++, first = first + 1 < period ? first + 1 : 0)
    for (PetscInt j = first; j >= 0 && j < rows; j += period)
      if (put)
        r->entry[r->form->of[q].field][start[j + 1]++] = (RowEntry){k, source, s->weight[1][b]};
      else
        start[j + 2]++;
}

PetscErrorCode StencilRowsPlace(StencilRows r, PetscInt markers, const Stencil stencil[]) {
  const PetscInt rows = StencilRowsCount(r), stencils = r->form->stencils * markers;
  PetscFunctionBeginUser;
  r->markers = markers;
  r->stencil = stencil;
  for (int f = 0; f < 3; f++) PetscCall(PetscArrayzero(r->start[f], rows + 2));
  for (PetscInt k = 0; k < stencils; k++) StencilRowsVisit(r, k, PETSC_FALSE);
  for (int f = 0; f < 3; f++) {
    for (PetscInt j = 0; j < rows; j++) r->start[f][j + 2] += r->start[f][j + 1];
    if (r->start[f][rows + 1] <= r->room[f]) continue;
    r->room[f] = r->start[f][rows + 1] * 11 / 10;
    PetscCall(PetscFree(r->entry[f]));
    PetscCall(PetscCalloc1(r->room[f] + AHEAD, &r->entry[f]));
  }
  for (PetscInt k = 0; k < stencils; k++) StencilRowsVisit(r, k, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stencil of an entry; that of some entries later is fetched, as the stencils of a row lie far apart in memory. */
static inline const Stencil *RowStencil(StencilRows r, const RowEntry *e) {
  const char *next = (const char *)&r->stencil[e[AHEAD].stencil];
  __builtin_prefetch(next);
  __builtin_prefetch(next + 64);
  return &r->stencil[e->stencil];
}

/* Whether all points of a stencil, zeros included, are next to one another in a row. */
static inline PetscBool RowIsWhole(const Stencil *s, PetscInt columns) {
  return s->first[0] >= 0 && s->first[0] + STENCIL_POINTS <= columns;
}

/* The column of point a of a stencil; -1: there is none, and the weight is zero. */
static inline PetscInt RowColumn(const Grid g, const Stencil *s, PetscInt a, PetscInt columns) {
  const PetscInt i = s->first[0] + a;
  if (!g->wall[0]) return (i + columns) % columns;
  return i >= 0 && i < columns ? i : -1;
}

/* row += force times the weights of an entry's stencil along x. */
static inline void RowAddEntry(StencilRows r, PetscInt columns, const RowEntry *e, PetscReal alpha,
                               const PetscScalar F[], PetscScalar row[]) {
  const Stencil *s = RowStencil(r, e);
  const PetscReal force = alpha * F[e->source] * e->value, *weight = s->weight[0];
  PetscScalar *at = row + s->first[0];
  if (RowIsWhole(s, columns)) {
    LanesPut(LanesAt(at) + force * LanesAt(weight), at);
    LanesPut(LanesAt(at + LANES) + force * LanesAt(weight + LANES), at + LANES);
  } else
    for (PetscInt a = 0; a < s->n[0]; a++) {
      const PetscInt i = RowColumn(r->grid, s, a, columns);
      if (i >= 0) row[i] += force * weight[a];
    }
}

void StencilRowSpread(StencilRows r, Field f, PetscInt j, PetscReal alpha, const PetscScalar F[], PetscScalar row[]) {
  const PetscInt *start = r->start[f] + j + r->below, columns = r->grid->columns[f];
  for (const RowEntry *e = r->entry[f] + start[0]; e < r->entry[f] + start[1]; e++)
    if (F[e->source] != 0) RowAddEntry(r, columns, e, alpha, F, row);
}

void StencilRowInterpolate(StencilRows r, Field f, PetscInt j, const PetscScalar row[], PetscScalar U[]) {
  const PetscInt *start = r->start[f] + j + r->below, columns = r->grid->columns[f];
  for (const RowEntry *e = r->entry[f] + start[0]; e < r->entry[f] + start[1]; e++) {
    const Stencil *s = RowStencil(r, e);
    const PetscScalar *at = row + s->first[0];
    const PetscReal *weight = s->weight[0];
    PetscScalar line = 0;
    if (RowIsWhole(s, columns))
      line = LanesSum(LanesAt(at) * LanesAt(weight) + LanesAt(at + LANES) * LanesAt(weight + LANES));
    else
      for (PetscInt a = 0; a < s->n[0]; a++) {
        const PetscInt i = RowColumn(r->grid, s, a, columns);
        if (i >= 0) line += row[i] * weight[a];
      }
    U[e->source] += line * e->value;
  }
}
