#include "markers/dipoles.h"

void DipoleStencilsUnwrapped(Grid g, const PetscReal X[2], Stencil s[DIPOLE_COUNT]) {
  const Kernel *five = KernelFind("cbs54"), *six = KernelFind("cbs65");
  const KernelWeights weights[DIPOLE_COUNT][2] = {
      {six->along, five->across}, {five->across, six->along}, {five->along, five->along}};
  for (int k = 0; k < DIPOLE_COUNT; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal r = (X[dir] - g->lo[dir]) / g->h - (k == DIPOLE_XY ? 1.0 : 0.5);
      s[k].n[dir] = weights[k][dir](r, &s[k].first[dir], s[k].weight[dir]);
    }
}

void DipoleStencils(Grid g, const PetscReal X[2], Stencil s[DIPOLE_COUNT]) {
  DipoleStencilsUnwrapped(g, X, s);
  for (int k = 0; k < DIPOLE_COUNT; k++)
    for (int dir = 0; dir < 2; dir++)
      if (!g->wall[dir]) s[k].first[dir] = ((s[k].first[dir] % g->n[dir]) + g->n[dir]) % g->n[dir];
}

static DipoleLine Plain(const Stencil *s, int dir) {
  DipoleLine line = {.first = s->first[dir], .n = s->n[dir]};
  for (PetscInt k = 0; k < line.n; k++) line.weight[k] = s->weight[dir][k];
  return line;
}

/* Differences of neighbours: from entry `first` on, which is the stencil's own or the one before it. */
static DipoleLine Difference(const Stencil *s, int dir, PetscInt before) {
  DipoleLine line = {.first = s->first[dir] - before, .n = s->n[dir] + 1};
  for (PetscInt k = 0; k <= s->n[dir]; k++)
    line.weight[k] = (k < s->n[dir] ? s->weight[dir][k] : 0) - (k ? s->weight[dir][k - 1] : 0);
  return line;
}

void DipoleSpots(Grid g, PetscReal nu, const PetscReal X[2], const PetscReal T[DIPOLE_COUNT],
                 DipoleSpot spot[DIPOLE_SPOTS]) {
  const PetscReal force = -nu / PetscPowRealInt(g->h, 3), half = -0.5 / PetscSqr(g->h);
  Stencil s[DIPOLE_COUNT];
  DipoleStencils(g, X, s);
  const Stencil *xx = &s[DIPOLE_XX], *yy = &s[DIPOLE_YY], *xy = &s[DIPOLE_XY];
  spot[0] = (DipoleSpot){FIELD_U, force * T[DIPOLE_XX], {Difference(xx, 0, 1), Plain(xx, 1)}};
  spot[1] = (DipoleSpot){FIELD_U, force * T[DIPOLE_XY], {Plain(xy, 0), Difference(xy, 1, 0)}};
  spot[2] = (DipoleSpot){FIELD_V, force * T[DIPOLE_XY], {Difference(xy, 0, 0), Plain(xy, 1)}};
  spot[3] = (DipoleSpot){FIELD_V, force * T[DIPOLE_YY], {Plain(yy, 0), Difference(yy, 1, 1)}};
  spot[4] = (DipoleSpot){FIELD_P, half * T[DIPOLE_XX], {Plain(xx, 0), Plain(xx, 1)}};
  spot[5] = (DipoleSpot){FIELD_P, half * T[DIPOLE_YY], {Plain(yy, 0), Plain(yy, 1)}};
}

/* a += the spot on this rank's rows of its field. */
static void Add(Grid g, const DipoleSpot *s, PetscScalar a[]) {
  const PetscInt columns = g->columns[s->field];
  const DipoleLine *x = &s->line[0], *y = &s->line[1];
  for (PetscInt q = 0; q < y->n; q++) {
    const PetscInt j = DipoleEntry(g, s, 1, q) - g->first;
    if (j < 0 || j >= g->rows[s->field]) continue;
    const PetscReal v = s->value * y->weight[q];
    for (PetscInt k = 0; k < x->n; k++) a[j * columns + DipoleEntry(g, s, 0, k)] += v * x->weight[k];
  }
}

PetscErrorCode DipolesSpread(Markers m, PetscReal nu, const PetscReal T[], Vec w, Vec source) {
  const Grid g = m->grid;
  PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a[FIELD_U]));
  PetscCall(VecGetArray(source, &a[FIELD_P]));
  a[FIELD_V] = a[FIELD_U] + GridLocalU(g);
  for (PetscInt k = 0; k < m->layout->M; k++) {
    const PetscReal *t = T + DIPOLE_COUNT * k;
    DipoleSpot spot[DIPOLE_SPOTS];
    if (t[0] == 0 && t[1] == 0 && t[2] == 0) continue;
    DipoleSpots(g, nu, m->X + 2 * k, t, spot);
    for (int q = 0; q < DIPOLE_SPOTS; q++) Add(g, &spot[q], a[spot[q].field]);
  }
  PetscCall(VecRestoreArray(source, &a[FIELD_P]));
  PetscCall(VecRestoreArray(w, &a[FIELD_U]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
