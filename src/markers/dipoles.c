#include "markers/dipoles.h"

#define WIDE (KERNEL_MAX_POINTS + 1)

void DipoleStencils(Grid g, const PetscReal X[2], Stencil s[DIPOLE_COUNT]) {
  const Kernel *five = KernelFind("cbs54"), *six = KernelFind("cbs65");
  const KernelWeights weights[DIPOLE_COUNT][2] = {
      {six->along, five->across}, {five->across, six->along}, {five->along, five->along}};
  for (int k = 0; k < DIPOLE_COUNT; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal r = (X[dir] - g->lo[dir]) / g->h - (k == DIPOLE_XY ? 1.0 : 0.5);
      s[k].n[dir] = weights[k][dir](r, &s[k].first[dir], s[k].weight[dir]);
      if (!g->wall[dir]) s[k].first[dir] = ((s[k].first[dir] % g->n[dir]) + g->n[dir]) % g->n[dir];
    }
}

/* Weights along one direction from entry `first` on. */
typedef struct {
  PetscInt first, n;
  PetscReal weight[WIDE];
} Line;

static Line Plain(const Stencil *s, int dir) {
  Line line = {.first = s->first[dir], .n = s->n[dir]};
  for (PetscInt k = 0; k < line.n; k++) line.weight[k] = s->weight[dir][k];
  return line;
}

/* Differences of neighbours: from entry `first` on, which is the stencil's own or the one before it. */
static Line Difference(const Stencil *s, int dir, PetscInt before) {
  Line line = {.first = s->first[dir] - before, .n = s->n[dir] + 1};
  for (PetscInt k = 0; k <= s->n[dir]; k++)
    line.weight[k] = (k < s->n[dir] ? s->weight[dir][k] : 0) - (k ? s->weight[dir][k - 1] : 0);
  return line;
}

/* a += value x y on this rank's rows of a field. */
static void Add(Grid g, Field f, PetscReal value, Line x, Line y, PetscScalar a[]) {
  const PetscInt columns = g->columns[f];
  for (PetscInt q = 0; q < y.n; q++) {
    PetscInt j = y.first + q;
    if (!g->wall[1]) j = (j + g->n[1]) % g->n[1];
    j -= g->first;
    if (j < 0 || j >= g->rows[f]) continue;
    PetscScalar *row = a + j * columns;
    const PetscReal v = value * y.weight[q];
    for (PetscInt k = 0; k < x.n; k++) {
      PetscInt i = x.first + k;
      if (!g->wall[0]) i = (i + columns) % columns;
      row[i] += v * x.weight[k];
    }
  }
}

PetscErrorCode DipolesSpread(Markers m, PetscReal nu, const PetscReal T[], Vec w, Vec source) {
  const Grid g = m->grid;
  const PetscReal force = -nu / PetscPowRealInt(g->h, 3), half = -0.5 / PetscSqr(g->h);
  PetscScalar *u, *v, *q;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &u));
  PetscCall(VecGetArray(source, &q));
  v = u + GridLocalU(g);
  for (PetscInt k = 0; k < m->layout->M; k++) {
    const PetscReal *t = T + DIPOLE_COUNT * k;
    Stencil s[DIPOLE_COUNT];
    if (t[0] == 0 && t[1] == 0 && t[2] == 0) continue;
    DipoleStencils(g, m->X + 2 * k, s);
    const Stencil *xx = &s[DIPOLE_XX], *yy = &s[DIPOLE_YY], *xy = &s[DIPOLE_XY];
    Add(g, FIELD_U, force * t[DIPOLE_XX], Difference(xx, 0, 1), Plain(xx, 1), u);
    Add(g, FIELD_U, force * t[DIPOLE_XY], Plain(xy, 0), Difference(xy, 1, 0), u);
    Add(g, FIELD_V, force * t[DIPOLE_XY], Difference(xy, 0, 0), Plain(xy, 1), v);
    Add(g, FIELD_V, force * t[DIPOLE_YY], Plain(yy, 0), Difference(yy, 1, 1), v);
    Add(g, FIELD_P, half * t[DIPOLE_XX], Plain(xx, 0), Plain(xx, 1), q);
    Add(g, FIELD_P, half * t[DIPOLE_YY], Plain(yy, 0), Plain(yy, 1), q);
  }
  PetscCall(VecRestoreArray(source, &q));
  PetscCall(VecRestoreArray(w, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
