#include "baselines/tensionmatrix.h"

typedef struct {
  PetscInt n[2];      /* cells of a window, the same for all edges */
  PetscInt *origin;   /* [2M] first cell of each window */
  PetscInt *previous; /* [M] the marker before k on the same vesicle */
  PetscReal *tau;     /* [2M] tangents of all vesicles */
  PetscReal *values;  /* [M][3][n1][n0]: u faces, v faces and scaled cells of G^T S */
} Windows;

static PetscReal *WindowLayer(const Windows *w, PetscInt k, int layer) {
  return w->values + (3 * k + layer) * w->n[0] * w->n[1];
}

/* First index of a stencil, moved by whole periods next to `near`. */
static PetscInt Unwrap(Grid g, int dir, PetscInt first, PetscInt near) {
  if (g->wall[dir]) return first;
  const PetscInt n = g->n[dir], shift = first - near;
  if (shift > n / 2) return first - n;
  if (shift < -n / 2) return first + n;
  return first;
}

static PetscErrorCode PlaceWindows(Coupling c, Windows *w) {
  const Layout l = c->membrane->layout;
  const PetscInt M = l->M;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(2 * M, &w->origin, M, &w->previous, 2 * M, &w->tau));
  MembraneTangents(c->membrane, 0, l->bodies, c->markers->X, w->tau);
  for (PetscInt v = 0; v < l->bodies; v++)
    for (PetscInt k = l->start[v]; k < l->start[v + 1]; k++)
      w->previous[k] = (k > l->start[v] ? k : l->start[v + 1]) - 1;
  w->n[0] = w->n[1] = 0;
  for (PetscInt k = 0; k < M; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscInt near = c->markers->stencil[2 * k].first[dir];
      PetscInt lo = PETSC_MAX_INT, hi = PETSC_MIN_INT;
      for (int e = 0; e < 4; e++) {
        const Stencil *s = &c->markers->stencil[2 * (e / 2 ? w->previous[k] : k) + e % 2];
        const PetscInt first = Unwrap(c->fluid->grid, dir, s->first[dir], near);
        lo = PetscMin(lo, first);
        hi = PetscMax(hi, first + s->n[dir]);
      }
      w->origin[2 * k + dir] = lo;
      w->n[dir] = PetscMax(w->n[dir], hi - lo + 1); /* one more cell: the divergence reaches right and up */
    }
  PetscCall(PetscCalloc1(3 * M * w->n[0] * w->n[1], &w->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Column k of S in its window: tau_k (E_k - E_{k-1})^T / h^2. */
static void FillFaces(Coupling c, Windows *w, PetscInt k) {
  const PetscReal h2 = PetscSqr(c->fluid->grid->h);
  for (int end = 0; end < 2; end++)
    for (int comp = 0; comp < 2; comp++) {
      const Stencil *s = &c->markers->stencil[2 * (end ? w->previous[k] : k) + comp];
      const PetscReal f = (end ? -1 : 1) * w->tau[2 * k + comp] / h2;
      const PetscInt i0 = Unwrap(c->fluid->grid, 0, s->first[0], w->origin[2 * k]) - w->origin[2 * k];
      const PetscInt j0 = Unwrap(c->fluid->grid, 1, s->first[1], w->origin[2 * k + 1]) - w->origin[2 * k + 1];
      PetscReal *a = WindowLayer(w, k, comp);
      for (PetscInt j = 0; j < s->n[1]; j++)
        for (PetscInt i = 0; i < s->n[0]; i++) a[(j0 + j) * w->n[0] + i0 + i] += f * s->weight[1][j] * s->weight[0][i];
    }
}

/* G^T S in the window, times sqrt(-1/diag(L)). */
static void FillCells(Coupling c, Windows *w, PetscInt k) {
  const Grid g = c->fluid->grid;
  const PetscInt nx = w->n[0];
  const PetscReal *u = WindowLayer(w, k, FIELD_U), *v = WindowLayer(w, k, FIELD_V);
  PetscReal *q = WindowLayer(w, k, FIELD_P);
  for (PetscInt j = 0; j < w->n[1]; j++)
    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt cell[2] = {w->origin[2 * k] + i, w->origin[2 * k + 1] + j};
      PetscInt faces = 4; /* diag(L) = -faces/h^2 */
      for (int dir = 0; dir < 2; dir++)
        if (g->wall[dir]) faces -= (cell[dir] <= 0) + (cell[dir] >= g->n[dir] - 1);
      q[j * nx + i] = ((i ? u[j * nx + i - 1] : 0) - u[j * nx + i] + (j ? v[(j - 1) * nx + i] : 0) - v[j * nx + i]) /
                      PetscSqrtReal((PetscReal)faces);
    }
}

/* Offset of window l from window k, the nearest image; whether they overlap. */
static PetscBool Offset(Grid g, const Windows *w, PetscInt k, PetscInt l, PetscInt d[2]) {
  for (int dir = 0; dir < 2; dir++) {
    d[dir] = Unwrap(g, dir, w->origin[2 * l + dir], w->origin[2 * k + dir]) - w->origin[2 * k + dir];
    if (PetscAbsInt(d[dir]) >= w->n[dir]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscReal Product(const Windows *w, PetscInt k, PetscInt l, const PetscInt d[2]) {
  const PetscInt i0 = PetscMax(0, d[0]), i1 = PetscMin(w->n[0], w->n[0] + d[0]);
  const PetscInt j0 = PetscMax(0, d[1]), j1 = PetscMin(w->n[1], w->n[1] + d[1]);
  PetscReal sum = 0;
  for (int layer = 0; layer < 3; layer++) {
    const PetscReal *a = WindowLayer(w, k, layer), *b = WindowLayer(w, l, layer);
    PetscReal part = 0;
    for (PetscInt j = j0; j < j1; j++)
      for (PetscInt i = i0; i < i1; i++) part += a[j * w->n[0] + i] * b[(j - d[1]) * w->n[0] + i - d[0]];
    sum += layer == FIELD_P ? -part : part;
  }
  return sum;
}

PetscErrorCode TensionAssemble(Coupling c, PetscMPIInt root, Mat *Chat) {
  const PetscInt M = c->membrane->layout->M;
  Windows w;
  PetscInt *row, d[2];
  PetscLogEvent event;
  PetscFunctionBeginUser;
  *Chat = NULL;
  if (c->membrane->layout->rank != root) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetvesEvent("AssembleChat", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(PlaceWindows(c, &w));
  for (PetscInt k = 0; k < M; k++) {
    FillFaces(c, &w, k);
    FillCells(c, &w, k);
  }
  PetscCall(PetscCalloc1(M, &row));
  for (PetscInt k = 0; k < M; k++)
    for (PetscInt l = 0; l < M; l++) row[k] += Offset(c->fluid->grid, &w, k, l, d);
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, M, M, 0, row, Chat));
  for (PetscInt k = 0; k < M; k++)
    for (PetscInt l = k; l < M; l++) {
      if (!Offset(c->fluid->grid, &w, k, l, d)) continue;
      const PetscReal value = Product(&w, k, l, d);
      PetscCall(MatSetValue(*Chat, k, l, value, INSERT_VALUES));
      if (l != k) PetscCall(MatSetValue(*Chat, l, k, value, INSERT_VALUES));
    }
  PetscCall(MatAssemblyBegin(*Chat, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*Chat, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree(row));
  PetscCall(PetscFree3(w.origin, w.previous, w.tau));
  PetscCall(PetscFree(w.values));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
