#include "coupling/mobility.h"

#define NEAR 14 /* cells up to which stencils are summed where the near field is exact */

PetscErrorCode MobilityCreate(const FluidSpec *spec, Coupling c, PetscReal reach, Mobility *out) {
  Mobility m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->coupling = c;
  m->near = c->near ? NEAR : PETSC_MAX_REAL;
  PetscCall(MobilityTableCreate(spec, c->markers->kernel, reach, &m->table));
  PetscCall(PetscMalloc1(2 * c->bodies->layout->M, &m->stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityDestroy(Mobility *mobility) {
  PetscFunctionBeginUser;
  if (!*mobility) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MobilityTableDestroy(&(*mobility)->table));
  PetscCall(PetscFree((*mobility)->stencil));
  PetscCall(PetscFree(*mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilitySetUp(Mobility m, PetscReal alpha) {
  PetscFunctionBeginUser;
  PetscCall(MobilityTableSetUp(m->table, alpha));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mob of markers i and j, the nearest image: xx, yy, xy, yx. */
static void Pair(Mobility m, PetscInt i, PetscInt j, PetscReal Mob[4]) {
  const Grid g = m->coupling->fluid->grid;
  const PetscReal *X = m->coupling->markers->X;
  const PaddedStencil *a = &m->stencil[2 * i], *b = &m->stencil[2 * j];
  PetscReal d[2], back[2];
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal period = g->hi[dir] - g->lo[dir];
    d[dir] = X[2 * i + dir] - X[2 * j + dir];
    d[dir] -= period * PetscFloorReal(d[dir] / period + 0.5);
    back[dir] = -d[dir];
  }
  if (d[0] * d[0] + d[1] * d[1] > PetscSqr(m->near * g->h)) {
    MobilityTableMean(m->table, d, Mob);
    Mob[3] = Mob[2];
    return;
  }
  Mob[0] = StencilImageSum(g, &m->table->green, OFFSET_UU, &a[0], &b[0], d);
  Mob[1] = StencilImageSum(g, &m->table->green, OFFSET_VV, &a[1], &b[1], d);
  Mob[2] = StencilImageSum(g, &m->table->green, OFFSET_VU, &b[1], &a[0],
                           back); /* u from v is v from u the other way round */
  Mob[3] = StencilImageSum(g, &m->table->green, OFFSET_VU, &a[1], &b[0], d);
}

PetscErrorCode MobilityAssemble(Mobility m, PetscInt first, PetscInt n, PetscInt part, PetscInt parts,
                                PetscReal Mob[]) {
  PetscFunctionBeginUser;
  for (PetscInt k = 2 * first; k < 2 * (first + n); k++) StencilPad(&m->coupling->markers->plain[k], &m->stencil[k]);
  if (parts > 1) PetscCall(PetscArrayzero(Mob, 4 * n * n));
  for (PetscInt i = part; i < n; i += parts)
    for (PetscInt j = i; j < n; j++) { /* symmetric */
      PetscReal *block = Mob + 2 * i * 2 * n + 2 * j, *mirror = Mob + 2 * j * 2 * n + 2 * i, one[4];
      Pair(m, first + i, first + j, one);
      block[0] = mirror[0] = one[0];
      block[2 * n + 1] = mirror[2 * n + 1] = one[1];
      block[1] = mirror[2 * n] = one[2];
      block[2 * n] = mirror[1] = one[3];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
