#include "coupling/nearblock.h"
#include "coupling/wallclose.h"

/* Smoothing by the kernel and dispersion by the lattice, to the order h^2/r^2: transforms of e^{i n phi} waves, the
   first three from the moments (docs/method.md, Near field). */
void NearFarCoefficients(const Kernel *kernel, PetscReal far[5]) {
  const PetscReal along = KernelSecondMoment(kernel->along), across = KernelSecondMoment(kernel->across);
  far[0] = -(across + 1. / 12) / 2 + 3.5 / 48;            /* a2 */
  far[1] = -along / 8 + (across + 1. / 12) / 8 - 1. / 48; /* a4 */
  far[2] = 1. / 96;                                       /* a6 */
  far[3] = -(along + across) / 4 + 1. / 32;               /* b2 */
  far[4] = 1. / 96;                                       /* b6 */
}

/* C of two distant markers, d apart: xx, yy, xy. */
static void FarPair(const PetscReal far[5], PetscReal scale, const PetscReal d[2], PetscReal C[3]) {
  const PetscReal r2 = d[0] * d[0] + d[1] * d[1], c = d[0] * d[0] - d[1] * d[1], s = 2 * d[0] * d[1];
  const PetscReal c2 = c / r2, s2 = s / r2, c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2, c6 = c4 * c2 - s4 * s2,
                  s6 = s4 * c2 + c4 * s2;
  const PetscReal factor = scale / r2;
  C[0] = factor * (-2 * far[0] * c2 + 4 * far[1] * c4 - 6 * far[2] * c6);
  C[1] = factor * (2 * far[0] * c2 + 4 * far[1] * c4 + 6 * far[2] * c6);
  C[2] = factor * (-2 * far[3] * s2 - 6 * far[4] * s6);
}

/* The free-space Stokeslet: xx, yy, xy. */
static void Stokeslet(PetscReal nu, const PetscReal d[2], PetscReal S[3]) {
  const PetscReal r2 = d[0] * d[0] + d[1] * d[1], logarithm = -0.5 * PetscLogReal(r2), factor = 1 / (4 * PETSC_PI * nu);
  S[0] = factor * (logarithm + d[0] * d[0] / r2);
  S[1] = factor * (logarithm + d[1] * d[1] / r2);
  S[2] = factor * d[0] * d[1] / r2;
}

/* L of markers i and j, d = X_i - X_j: xx, yy, xy and yx. */
static void LatticePair(NearField f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]) {
  const Grid g = f->markers->grid;
  const PaddedStencil *a = &f->stencil[2 * i], *b = &f->stencil[2 * j];
  const PetscReal constant = PetscLogReal(g->h) / (4 * PETSC_PI), back[2] = {-d[0], -d[1]};
  L[0] = (StencilImageSum(g, &f->lattice, OFFSET_UU, &a[0], &b[0], d) - constant) / f->nu;
  L[1] = (StencilImageSum(g, &f->lattice, OFFSET_VV, &a[1], &b[1], d) - constant) / f->nu;
  L[2] = StencilImageSum(g, &f->lattice, OFFSET_VU, &b[1], &a[0], back) / f->nu; /* the other way round */
  L[3] = StencilImageSum(g, &f->lattice, OFFSET_VU, &a[1], &b[0], d) / f->nu;
}

void NearLatticePair(NearField f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]) {
  const PetscReal h = f->markers->grid->h, reach = (f->lattice.size[0] - OFFSET_LAGS) * h;
  PetscReal S[3], C[3];
  if (d[0] * d[0] + d[1] * d[1] <= reach * reach) {
    LatticePair(f, i, j, d, L);
    return;
  }
  Stokeslet(f->nu, d, S);
  FarPair(f->far, h * h / (2 * PETSC_PI * f->nu), d, C);
  for (int c = 0; c < 4; c++) L[c] = S[PetscMin(c, 2)] - C[PetscMin(c, 2)];
}

/* What Kress' quadrature has besides the plain logarithm, for two markers of one curve of n that are k apart; on the
   diagonal the whole of S, from the derivative T = dX/dk: xx, yy, xy. */
static void SelfPart(NearField f, PetscInt v, PetscInt k, const PetscReal T[2], PetscReal S[3]) {
  const PetscInt n = LayoutCount(f->membrane->layout, v);
  const PetscReal factor = 1 / (4 * PETSC_PI * f->nu);
  if (k) {
    S[0] = S[1] = -0.5 * factor * (f->kress[v][k] - PetscLogReal(4 * PetscSqr(PetscSinReal(PETSC_PI * k / n))));
    S[2] = 0;
    return;
  }
  const PetscReal t2 = T[0] * T[0] + T[1] * T[1];
  const PetscReal logarithm = -0.5 * (f->kress[v][0] + PetscLogReal(t2 * PetscSqr(n / (2 * PETSC_PI))));
  S[0] = factor * (logarithm + T[0] * T[0] / t2);
  S[1] = factor * (logarithm + T[1] * T[1] / t2);
  S[2] = factor * T[0] * T[1] / t2;
}

/* C of marker i and the image of marker j, k their difference along one curve (-1: of another curve or image). */
static void Pair(NearField f, PetscInt v, PetscInt i, PetscInt j, PetscInt k, const PetscReal shift[2],
                 const PetscReal T[2], PetscReal C[4]) {
  const PetscReal *X = f->markers->X;
  PetscReal d[2] = {X[2 * i] - X[2 * j] - shift[0], X[2 * i + 1] - X[2 * j + 1] - shift[1]};
  const PetscReal part = f->box ? BoxPartImage(f->box, d) : 1;
  PetscReal S[3] = {0, 0, 0}, own[3] = {0, 0, 0}, L[4] = {0, 0, 0, 0};
  if (k >= 0) SelfPart(f, v, k, T, own);
  if (k) Stokeslet(f->nu, d, S);
  if (!f->free) NearLatticePair(f, i, j, d, L);
  for (int c = 0; c < 4; c++) C[c] = S[PetscMin(c, 2)] - L[c];
  if (f->image) NearImageAdd(f->image, i, j, d, L, C);
  for (int c = 0; c < 4; c++) C[c] = part * C[c] + own[PetscMin(c, 2)];
}

PetscErrorCode NearBlockFill(NearField f, NearBlock *b) {
  const Membrane m = f->membrane;
  const Layout l = m->layout;
  const PetscInt n = LayoutCount(l, b->row), columns = LayoutCount(l, b->column), i0 = l->start[b->row],
                 j0 = l->start[b->column];
  const PetscBool self = b->row == b->column && b->shift[0] == 0 && b->shift[1] == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscReal *T, C[4];
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &T));
  if (self) SpectralDerivative(m->spectral[b->row], 1, 1, f->markers->X + 2 * i0, T);
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = self ? j : 0; i < n; i++) {
      PetscReal *at = b->C + 2 * j * 2 * n + 2 * i, *mirror = b->C + 2 * i * 2 * n + 2 * j;
      Pair(f, b->row, i0 + i, j0 + j, self ? i - j : -1, b->shift, T + 2 * i, C);
      at[0] = C[0];
      at[1] = C[3];
      at[2 * n] = C[2];
      at[2 * n + 1] = C[1];
      if (!self || i == j) continue;
      mirror[0] = C[0];
      mirror[1] = C[2];
      mirror[2 * n] = C[3];
      mirror[2 * n + 1] = C[1];
    }
  PetscCall(PetscFree(T));
  if (f->image) PetscCall(NearBlockRefineAtWalls(f, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
