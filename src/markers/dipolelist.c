#include "markers/dipolelist.h"

static PetscInt ListRows(DipoleList d) {
  return d->grid->rows[FIELD_U] + DIPOLE_BELOW + DIPOLE_ABOVE;
}

PetscErrorCode DipoleListCreate(Grid g, DipoleList *out) {
  DipoleList d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  *out = d;
  d->grid = g;
  for (int f = 0; f < 3; f++) PetscCall(PetscCalloc1(ListRows(d) + 2, &d->start[f]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DipoleListDestroy(DipoleList *list) {
  PetscFunctionBeginUser;
  if (!*list) PetscFunctionReturn(PETSC_SUCCESS);
  for (int f = 0; f < 3; f++) {
    PetscCall(PetscFree((*list)->start[f]));
    PetscCall(PetscFree((*list)->hit[f]));
  }
  PetscCall(PetscFree(*list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first row of the list that is this row of the grid; with a period others follow. */
static inline PetscInt ListFirstRow(const Grid g, PetscInt entry) {
  const PetscInt j = entry - g->first + DIPOLE_BELOW;
  return g->wall[1] ? j : (j % g->n[1] + g->n[1]) % g->n[1];
}

/* Count the rows of a spot in start[j + 2] or, with hit, put its hits at start[j + 1]. */
static void ListVisitSpot(DipoleList d, PetscInt k, PetscInt rows, PetscInt start[], DipoleHit hit[]) {
  const Grid g = d->grid;
  const DipoleSpot *s = &d->spot[k];
  const PetscInt period = g->wall[1] ? rows : g->n[1], part = k / DIPOLE_SPOTS * DIPOLE_COUNT + (PetscInt)s->part;
  const PetscInt n = s->line[1].n, first = ListFirstRow(g, s->line[1].first);
  for (PetscInt q = 0; q < n; q++)
    for (PetscInt j = g->wall[1] ? first + q : (first + q) % period; j >= 0 && j < rows; j += period)
      if (hit)
        hit[start[j + 1]++] = (DipoleHit){k, part, s->value * s->line[1].weight[q]};
      else
        start[j + 2]++;
}

/* Find the rows that spots reach. */
static void ListFindWindow(DipoleList d) {
  const PetscInt rows = ListRows(d);
  d->window[0] = rows - DIPOLE_BELOW;
  d->window[1] = -DIPOLE_BELOW;
  for (int f = 0; f < 3; f++)
    for (PetscInt j = 0; j < rows; j++) {
      if (d->start[f][j] == d->start[f][j + 1]) continue;
      d->window[0] = PetscMin(d->window[0], j - DIPOLE_BELOW);
      d->window[1] = PetscMax(d->window[1], j - DIPOLE_BELOW + 1);
    }
}

PetscErrorCode DipoleListPlace(DipoleList d, PetscInt M, const DipoleSpot spot[]) {
  const PetscInt rows = ListRows(d);
  PetscFunctionBeginUser;
  d->M = M;
  d->spot = spot;
  for (int f = 0; f < 3; f++) PetscCall(PetscArrayzero(d->start[f], rows + 2));
  for (PetscInt k = 0; k < DIPOLE_SPOTS * M; k++) ListVisitSpot(d, k, rows, d->start[spot[k].field], NULL);
  for (int f = 0; f < 3; f++) {
    for (PetscInt j = 0; j < rows; j++) d->start[f][j + 2] += d->start[f][j + 1];
    if (d->start[f][rows + 1] <= d->room[f]) continue;
    d->room[f] = d->start[f][rows + 1] * 11 / 10;
    PetscCall(PetscFree(d->hit[f]));
    PetscCall(PetscMalloc1(d->room[f], &d->hit[f]));
  }
  for (PetscInt k = 0; k < DIPOLE_SPOTS * M; k++)
    ListVisitSpot(d, k, rows, d->start[spot[k].field], d->hit[spot[k].field]);
  ListFindWindow(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline void ListAddHit(DipoleList d, const DipoleHit *hit, const PetscReal T[], PetscScalar row[]) {
  DipoleAddRow(d->grid, &d->spot[hit->spot], hit->value * T[hit->part], row);
}

void DipoleListAddRow(DipoleList d, Field f, PetscInt j, const PetscReal T[], PetscScalar row[]) {
  const PetscInt *start = d->start[f] + j + DIPOLE_BELOW;
  const DipoleHit *hit = d->hit[f] + start[0], *end = d->hit[f] + start[1], *half = hit + (end - hit) / 2;
  /* Neighbouring spots overlap, and a sum would wait for the sum before it. So two spots far apart take turns. */
  for (const DipoleHit *other = half; other < end; other++) {
    if (hit < half) ListAddHit(d, hit++, T, row);
    ListAddHit(d, other, T, row);
  }
}

PetscErrorCode DipoleListSpread(DipoleList d, const PetscReal T[], Vec w, Vec source) {
  const Grid g = d->grid;
  PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a[FIELD_U]));
  PetscCall(VecGetArray(source, &a[FIELD_P]));
  a[FIELD_V] = a[FIELD_U] + GridLocalU(g);
  for (int f = 0; f < 3; f++)
    for (PetscInt j = PetscMax(0, d->window[0]); j < PetscMin(g->rows[f], d->window[1]); j++)
      DipoleListAddRow(d, (Field)f, j, T, a[f] + j * g->columns[f]);
  PetscCall(VecRestoreArray(source, &a[FIELD_P]));
  PetscCall(VecRestoreArray(w, &a[FIELD_U]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
