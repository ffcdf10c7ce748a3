#include "layers/singlepairs.h"

#define ZETA 0.0304484570583 /* -zeta'(-2) */

/* Kress' weights of ln(4 sin^2(t/2)) less that logarithm, which is left out at 0. */
static void SelfLogarithm(PetscInt n, PetscReal own[]) {
  for (PetscInt d = 0; d < n; d++) {
    own[d] = 0;
    for (PetscInt m = 1; m <= (n - 1) / 2; m++) own[d] -= 2 * PetscCosReal(2 * PETSC_PI * ((m * d) % n) / n) / m;
    if (n % 2 == 0) own[d] -= (d % 2 ? -2.0 : 2.0) / n;
    if (d) own[d] -= PetscLogReal(4 * PetscSqr(PetscSinReal(PETSC_PI * d / n)));
  }
}

/* The quadrature of an open curve: the trapezoidal rule with three corrected weights, ln(2 pi/ds) - 2 ZETA on the
   diagonal, ZETA beside it. There are no corrections at the ends, where the force fades. */
static void OpenLogarithm(PetscInt n, PetscReal own[]) {
  (void)PetscArrayzero(own, n);
  own[0] = 4 * ZETA;
  own[1] = -2 * ZETA;
}

PetscErrorCode SinglePairsCreate(const LayerSetting *set, const OffsetTable *lattice, const ImageTable *half,
                                 SinglePairs *out) {
  const Layout l = set->markers->layout;
  SinglePairs f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->set = set;
  f->lattice = lattice;
  NearFarMake(set->markers->kernel, f->far);
  if (!set->markers->grid->free) PetscCall(NearImageCreate(set, half, &f->image));
  PetscCall(PetscMalloc2(2 * l->M, &f->stencil, l->bodies, &f->bounds));
  for (int c = 0; c < 4; c++) PetscCall(PetscCalloc1(l->M + LANES, &f->fourth[c / 2][c % 2]));
  PetscCall(PetscCalloc1(l->bodies, &f->logarithm));
  for (PetscInt v = l->own; v < l->end && set->bodies; v++) {
    PetscCall(PetscMalloc1(LayoutCount(l, v), &f->logarithm[v]));
    (set->bodies->kind[v].type == CURVE_OPEN ? OpenLogarithm : SelfLogarithm)(LayoutCount(l, v), f->logarithm[v]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SinglePairsDestroy(SinglePairs *pairs) {
  SinglePairs f = *pairs;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < f->set->markers->layout->bodies; v++) PetscCall(PetscFree(f->logarithm[v]));
  PetscCall(PetscFree(f->logarithm));
  PetscCall(PetscFree2(f->stencil, f->bounds));
  for (int c = 0; c < 4; c++) PetscCall(PetscFree(f->fourth[c / 2][c % 2]));
  PetscCall(NearImageDestroy(&f->image));
  PetscCall(PetscFree(*pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SinglePairsPlace(SinglePairs f) {
  const Markers m = f->set->markers;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->layout->bodies; v++)
    f->bounds[v] = NearBoundsOf(LayoutCount(m->layout, v), m->X + 2 * m->layout->start[v]);
  for (PetscInt k = 0; k < m->layout->M && !m->grid->free; k++) {
    PaddedStencil *s = &f->stencil[2 * k];
    for (int c = 0; c < 2; c++) StencilPad(&m->plain[2 * k + c], &s[c]);
    StencilUnwrap(m->grid, m->X + 2 * k, s);
    for (int c = 0; c < 4; c++)
      f->fourth[c / 2][c % 2][k] = s[c / 2].fourth[c % 2] - f->far[NEAR_ONE].fourth[c / 2 != c % 2];
  }
  if (f->image) PetscCall(NearImagePlace(f->image, f->stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfLayer(const LayerSetting *set, Spectral spectral, PetscInt n, const PetscReal X[], PetscReal S[]) {
  PetscReal *own, *T, pair[3];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &own));
  PetscCall(PetscCalloc1(2 * n, &T));
  SelfLogarithm(n, own);
  SpectralDerivative(spectral, 1, n / (2 * PETSC_PI), X, T);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) { /* on the diagonal the derivative takes the place of the difference */
      const PetscReal d[2] = {i == j ? T[2 * i] : X[2 * i] - X[2 * j],
                              i == j ? T[2 * i + 1] : X[2 * i + 1] - X[2 * j + 1]};
      PetscReal *at = S + 2 * j * 2 * n + 2 * i;
      StokesletOne(set, d, own[PetscAbsInt(i - j)], pair);
      at[0] = pair[0];
      at[2 * n + 1] = pair[1];
      at[1] = at[2 * n] = pair[2];
    }
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}
