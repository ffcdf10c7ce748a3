#include "coupling/doubleblock.h"
#include "coupling/nearblock.h"

PetscErrorCode DoubleGeometry(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal normal[],
                              PetscReal along[]) {
  PetscReal *T;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &T));
  SpectralDerivative(spectral, 1, 1, X, T);
  for (PetscInt k = 0; k < n; k++) {
    normal[2 * k] = T[2 * k + 1];
    normal[2 * k + 1] = -T[2 * k];
    along[k] = PetscHypotReal(T[2 * k], T[2 * k + 1]);
  }
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D = -(1/pi) (r.n) r r/r^4 w with r from the target to the source and N = n w: xx, yy, xy. */
static void Free(const PetscReal r[2], const PetscReal N[2], PetscReal D[3]) {
  const PetscReal r2 = r[0] * r[0] + r[1] * r[1], q = -(r[0] * N[0] + r[1] * N[1]) / (PETSC_PI * r2 * r2);
  D[0] = q * r[0] * r[0];
  D[1] = q * r[1] * r[1];
  D[2] = q * r[0] * r[1];
}

/* On the diagonal the curvature takes the place of 2 r.n/r^2: D = -(kappa/2 pi) t t w, from the label's derivatives T
   and T' : xx, yy, xy. */
static void Diagonal(const PetscReal T[2], const PetscReal TT[2], PetscReal D[3]) {
  const PetscReal t2 = T[0] * T[0] + T[1] * T[1];
  const PetscReal q = -(T[0] * TT[1] - T[1] * TT[0]) / (2 * PETSC_PI * t2 * t2);
  D[0] = q * T[0] * T[0];
  D[1] = q * T[1] * T[1];
  D[2] = q * T[0] * T[1];
}

/* D(i, i) of all markers: [n][3]. */
static PetscErrorCode Diagonals(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal D[]) {
  PetscReal *T, *TT;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &T, 2 * n, &TT));
  SpectralDerivative(spectral, 1, 1, X, T);
  SpectralDerivative(spectral, 2, 1, X, TT);
  for (PetscInt k = 0; k < n; k++) Diagonal(T + 2 * k, TT + 2 * k, D + 3 * k);
  PetscCall(PetscFree2(T, TT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleSelf(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal D[]) {
  PetscReal *normal, *along, *diagonal;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(2 * n, &normal, n, &along, 3 * n, &diagonal));
  PetscCall(DoubleGeometry(spectral, n, X, normal, along));
  PetscCall(Diagonals(spectral, n, X, diagonal));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal r[2] = {X[2 * j] - X[2 * i], X[2 * j + 1] - X[2 * i + 1]};
      PetscReal pair[3], *at = D + 2 * j * 2 * n + 2 * i, *d = i == j ? diagonal + 3 * i : pair;
      if (i != j) Free(r, normal + 2 * j, pair);
      at[0] = d[0];
      at[2 * n + 1] = d[1];
      at[1] = at[2 * n] = d[2];
    }
  PetscCall(PetscFree3(normal, along, diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D of unit tensor parts, which are 2 J_x N_x, 2 J_y N_y and J_x N_y + J_y N_x of a marker; r from target to source. */
static void FreeParts(const PetscReal r[2], PetscReal K[2][DIPOLE_COUNT]) {
  const PetscReal r2 = r[0] * r[0] + r[1] * r[1], q = -1 / (PETSC_PI * r2 * r2);
  for (int c = 0; c < 2; c++) {
    K[c][DIPOLE_XX] = 0.5 * q * r[0] * r[0] * r[c];
    K[c][DIPOLE_YY] = 0.5 * q * r[1] * r[1] * r[c];
    K[c][DIPOLE_XY] = q * r[0] * r[1] * r[c];
  }
}

/* D - L of distant markers, d = X_i - X_j: smoothing by the kernels and dispersion by the lattice, h^2/(48 pi r^3)
   times these waves of the angle of d. */
static void FarParts(const PetscReal d[2], PetscReal h, PetscReal K[2][DIPOLE_COUNT]) {
  const PetscReal r = PetscHypotReal(d[0], d[1]), c = d[0] / r, s = d[1] / r, c2 = c * c - s * s, s2 = 2 * c * s;
  const PetscReal c3 = c2 * c - s2 * s, s3 = s2 * c + c2 * s, c5 = c3 * c2 - s3 * s2, s5 = s3 * c2 + c3 * s2;
  const PetscReal c7 = c5 * c2 - s5 * s2, s7 = s5 * c2 + c5 * s2, scale = h * h / (48 * PETSC_PI * r * r * r);
  K[0][DIPOLE_XX] = scale * (13 * c3 - 9 * c5 - 6 * c7);
  K[0][DIPOLE_YY] = scale * (-17 * c3 - 3 * c5 + 6 * c7);
  K[0][DIPOLE_XY] = scale * (34 * s3 - 6 * s5 - 12 * s7);
  K[1][DIPOLE_XX] = scale * (17 * s3 - 3 * s5 - 6 * s7);
  K[1][DIPOLE_YY] = scale * (-13 * s3 - 9 * s5 + 6 * s7);
  K[1][DIPOLE_XY] = scale * (-34 * c3 - 6 * c5 + 12 * c7);
}

void DoubleLatticeParts(const OffsetTable lattice[2], PetscReal h, PetscReal reach, const PaddedStencil response[2],
                        const PaddedStencil dipole[DIPOLE_COUNT], const PetscInt cells[2], const PetscReal d[2],
                        PetscReal K[2][DIPOLE_COUNT]) {
  const PetscReal r[2] = {-d[0], -d[1]};
  PetscReal far[2][DIPOLE_COUNT];
  if (d[0] * d[0] + d[1] * d[1] <= reach * reach) {
    StencilDipoleSums(lattice, response, dipole, cells, K);
    for (int c = 0; c < 2; c++)
      for (int k = 0; k < DIPOLE_COUNT; k++) K[c][k] /= h;
    return;
  }
  FreeParts(r, K);
  FarParts(d, h, far);
  for (int c = 0; c < 2; c++)
    for (int k = 0; k < DIPOLE_COUNT; k++) K[c][k] -= far[c][k];
}

/* M = D of two markers, N = n w of the source j; r from the target to the source's image, own: D(i, i) of a marker
   with itself. */
static void Whole(const PetscReal r[2], const PetscReal N[2], const PetscReal *own, PetscReal M[4]) {
  PetscReal D[3];
  if (!own) Free(r, N, D);
  for (int k = 0; k < 3 && own; k++) D[k] = own[k];
  M[0] = D[0];
  M[1] = M[2] = D[2];
  M[3] = D[1];
}

/* Images in walls that are left out, cells; with a box part, which is made with all, none. */
static PetscReal ImageReach(DoubleLayer s) {
  return s->near->box ? PETSC_MAX_REAL : DOUBLE_IMAGE_REACH;
}

/* C = D - L of two markers, and L, walls included; d = X_i - X_j of the image meant (length), own: D(i, i) of a marker
   with itself; by stencils up to `reach` (length). */
static void Pair(DoubleLayer s, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal reach, const PetscReal *own,
                 PetscReal C[4], PetscReal L[4]) {
  const NearField f = s->near;
  const PetscReal *X = f->markers->X, h = f->markers->grid->h, r[2] = {-d[0], -d[1]}, *N = s->normal + 2 * j;
  PetscReal K[2][DIPOLE_COUNT], image[2][DIPOLE_COUNT] = {{0}}, D[4];
  PetscInt cells[2];
  for (int dir = 0; dir < 2; dir++) cells[dir] = (PetscInt)rint((d[dir] - (X[2 * i + dir] - X[2 * j + dir])) / h);
  DoubleLatticeParts(s->lattice, h, reach, &f->stencil[2 * i], &s->dipole[DIPOLE_COUNT * j], cells, d, K);
  DoubleImageAdd(s->image, i, j, d, ImageReach(s), image, K);
  Whole(r, N, own, D);
  DipoleContract((const PetscReal(*)[DIPOLE_COUNT])K, N, 1, L);
  DipoleContract((const PetscReal(*)[DIPOLE_COUNT])image, N, 1, C);
  for (int k = 0; k < 4; k++) C[k] += D[k] - L[k];
}

/* D alone, walls included. */
static void WithoutLattice(DoubleLayer s, PetscInt i, PetscInt j, const PetscReal d[2], const PetscReal *own,
                           PetscReal C[4]) {
  const PetscReal r[2] = {-d[0], -d[1]}, *N = s->normal + 2 * j;
  PetscReal image[2][DIPOLE_COUNT] = {{0}}, D[4];
  Whole(r, N, own, D);
  if (s->image) DoubleImageExactAll(s->image, i, j, d, ImageReach(s), image);
  DipoleContract((const PetscReal(*)[DIPOLE_COUNT])image, N, 1, C);
  for (int k = 0; k < 4; k++) C[k] += D[k];
}

/* value += (L n) (n w)^T/length: L acts on what Q leaves, flux[2n] being the rows' SUM L n over the column's markers.
 */
static void PutFluxBack(DoubleLayer s, const DoubleBlock *b, const PetscReal flux[], PetscReal value[]) {
  const Layout l = s->near->bodies->layout;
  const PetscInt n = 2 * LayoutCount(l, b->row), first = 2 * l->start[b->column];
  for (PetscInt j = 0; j < 2 * LayoutCount(l, b->column); j++)
    for (PetscInt i = 0; i < n; i++) value[j * n + i] += flux[i] * s->normal[first + j] / s->length[b->column];
}

PetscErrorCode DoubleBlockFill(DoubleLayer s, const DoubleBlock *b, PetscBool lattice, PetscReal value[]) {
  const NearField f = s->near;
  const Layout l = f->bodies->layout;
  const PetscInt n = LayoutCount(l, b->row), m = LayoutCount(l, b->column);
  const PetscBool self = b->row == b->column && b->shift[0] == 0 && b->shift[1] == 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal *X = f->markers->X, reach = (self ? DOUBLE_CELLS : DOUBLE_CROSS_CELLS) * f->markers->grid->h;
  PetscReal *flux, *diagonal;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &flux, 3 * n, &diagonal));
  if (self) PetscCall(Diagonals(f->bodies->spectral[b->row], n, X + 2 * l->start[b->row], diagonal));
  for (PetscInt q = 0; q < m; q++)
    for (PetscInt p = 0; p < n; p++) {
      const PetscInt i = l->start[b->row] + p, j = l->start[b->column] + q;
      PetscReal d[2] = {X[2 * i] - X[2 * j] - b->shift[0], X[2 * i + 1] - X[2 * j + 1] - b->shift[1]};
      const PetscReal part = lattice && f->box ? BoxPartImage(f->box, d) : 1;
      const PetscReal *own = self && p == q ? diagonal + 3 * p : NULL, *N = s->normal + 2 * j;
      PetscReal C[4], L[4], *at = value + 2 * q * 2 * n + 2 * p;
      if (lattice) {
        Pair(s, i, j, d, reach, own, C, L);
        for (int c = 0; c < 2; c++) flux[2 * p + c] += part * (L[c] * N[0] + L[2 + c] * N[1]) / s->along[j];
      } else
        WithoutLattice(s, i, j, d, own, C);
      at[0] = part * C[0];
      at[1] = part * C[1];
      at[2 * n] = part * C[2];
      at[2 * n + 1] = part * C[3];
    }
  if (lattice) PutFluxBack(s, b, flux, value);
  PetscCall(PetscFree2(flux, diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
