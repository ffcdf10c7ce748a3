#include "sphere/surface.h"
#include "numerics/blas.h"

void SurfaceEllipsoid(PetscInt p, const PetscReal axes[3], PetscReal c[]) {
  static const int which[3] = {3, 1, 2}; /* harmonics in proportion to x, y, z */
  const PetscInt count = HarmonicsCount(p);
  (void)PetscArrayzero(c, 3 * count);
  for (int d = 0; d < 3; d++) c[d * count + which[d]] = axes[d] * PetscSqrtReal(4 * PETSC_PI / 3);
}

void SurfaceSpheroid(PetscInt p, PetscReal along, PetscReal across, PetscReal c[]) {
  (void)PetscArrayzero(c, 2 * p + 1);
  c[1] = along * PetscSqrtReal(4 * PETSC_PI / 3);
  c[p + 1] = across * PetscSqrtReal(8 * PETSC_PI / 3);
}

PetscErrorCode SurfaceCreate(Sphere sphere, Surface *out) {
  const PetscInt n = sphere->fine.grid.n;
  Surface s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->sphere = sphere;
  s->n = n;
  PetscCall(PetscMalloc1(HARMONIC_PARTS * 3 * n, &s->D[0]));
  for (PetscInt part = 1; part < HARMONIC_PARTS; part++) s->D[part] = s->D[0] + 3 * part * n;
  PetscCall(PetscMalloc3(3 * n, &s->normal, n, &s->J, n, &s->h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceDestroy(Surface *surface) {
  Surface s = *surface;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(s->D[0]));
  PetscCall(PetscFree3(s->normal, s->J, s->h));
  PetscCall(PetscFree2(s->dh, s->dJ));
  PetscCall(PetscFree(*surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscReal Dot(const PetscReal a[3], const PetscReal b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void Cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3]) {
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* The surface at one point. */
typedef struct {
  PetscReal X[HARMONIC_PARTS][3]; /* X and its derivatives */
  PetscReal E, F, G;
  PetscReal a[3], b[3], W, N;
  PetscReal root; /* of sin(theta) */
} SurfacePoint;

static SurfacePoint SurfacePointOf(Surface s, PetscInt i) {
  SurfacePoint at;
  for (PetscInt part = 0; part < HARMONIC_PARTS; part++)
    for (int d = 0; d < 3; d++) at.X[part][d] = s->D[part][d * s->n + i];
  at.E = Dot(at.X[HARMONIC_T], at.X[HARMONIC_T]);
  at.F = Dot(at.X[HARMONIC_T], at.X[HARMONIC_P]);
  at.G = Dot(at.X[HARMONIC_P], at.X[HARMONIC_P]);
  Cross(at.X[HARMONIC_T], at.X[HARMONIC_P], at.a);
  for (int d = 0; d < 3; d++)
    at.b[d] = at.E * at.X[HARMONIC_PP][d] - 2 * at.F * at.X[HARMONIC_TP][d] + at.G * at.X[HARMONIC_TT][d];
  at.W = PetscSqrtReal(Dot(at.a, at.a));
  at.N = Dot(at.a, at.b);
  at.root = PetscSqrtReal(PetscSinReal(s->sphere->fine.grid.theta[i]));
  return at;
}

/* dh[part][3] and dJ[2][3]: how h and J change with the derivatives of X. */
static void SurfacePointDerivatives(const SurfacePoint *at, PetscReal dh[HARMONIC_PARTS][3],
                                    PetscReal dJ[HARMONIC_PARTS][3]) {
  const PetscReal *T = at->X[HARMONIC_T], *P = at->X[HARMONIC_P], *a = at->a;
  const PetscReal f = PetscPowReal(at->W, -2.5) / at->root, g = 2.5 * at->N * f / at->W,
                  tt = Dot(at->X[HARMONIC_TT], a), tp = Dot(at->X[HARMONIC_TP], a), pp = Dot(at->X[HARMONIC_PP], a);
  PetscReal WT[3], WP[3], Pb[3], bT[3];
  Cross(P, a, WT);
  Cross(a, T, WP);
  Cross(P, at->b, Pb);
  Cross(at->b, T, bT);
  for (int d = 0; d < 3; d++) {
    WT[d] /= at->W;
    WP[d] /= at->W;
    dh[HARMONIC_T][d] = f * (2 * pp * T[d] - 2 * tp * P[d] + Pb[d]) - g * WT[d];
    dh[HARMONIC_P][d] = f * (2 * tt * P[d] - 2 * tp * T[d] + bT[d]) - g * WP[d];
    dh[HARMONIC_TT][d] = f * at->G * a[d];
    dh[HARMONIC_TP][d] = -2 * f * at->F * a[d];
    dh[HARMONIC_PP][d] = f * at->E * a[d];
    dJ[HARMONIC_T][d] = WT[d] / (at->root * at->root);
    dJ[HARMONIC_P][d] = WP[d] / (at->root * at->root);
  }
}

void SurfaceCombine(Surface s, PetscInt first, PetscInt last, const PetscReal factor[], PetscReal out[]) {
  const PetscInt n = s->n;
  (void)PetscArrayzero(out, s->sphere->size * n);
  for (int d = 0; d < 3; d++) {
    const FieldComponent *own = &s->sphere->fine.component[d];
    for (PetscInt k = 0; k < own->columns; k++)
      for (PetscInt part = first; part <= last; part++) {
        const PetscReal *f = factor + (3 * (part - first) + d) * n, *Y = own->part[part] + k * n;
        PetscReal *column = out + (own->first + k) * n;
        for (PetscInt i = 0; i < n; i++) column[i] += f[i] * Y[i];
      }
  }
}

static PetscErrorCode SurfaceDerivatives(Surface s) {
  const PetscInt n = s->n, size = s->sphere->size * n;
  PetscReal *h, *J;
  PetscFunctionBeginUser;
  if (!s->dh) PetscCall(PetscMalloc2(size, &s->dh, size, &s->dJ));
  PetscCall(PetscMalloc2(3 * HARMONIC_PARTS * n, &h, 3 * HARMONIC_PARTS * n, &J));
  for (PetscInt i = 0; i < n; i++) {
    const SurfacePoint at = SurfacePointOf(s, i);
    PetscReal dh[HARMONIC_PARTS][3] = {{0}}, dJ[HARMONIC_PARTS][3] = {{0}};
    SurfacePointDerivatives(&at, dh, dJ);
    for (PetscInt part = 0; part < HARMONIC_PARTS; part++)
      for (int d = 0; d < 3; d++) {
        h[(3 * part + d) * n + i] = dh[part][d];
        J[(3 * part + d) * n + i] = dJ[part][d];
      }
  }
  SurfaceCombine(s, HARMONIC_T, HARMONIC_PP, h + 3 * HARMONIC_T * n, s->dh);
  SurfaceCombine(s, HARMONIC_T, HARMONIC_P, J + 3 * HARMONIC_T * n, s->dJ);
  PetscCall(PetscFree2(h, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfacePlace(Surface s, const PetscReal c[], PetscBool derivatives) {
  const SphereGrid *g = &s->sphere->fine.grid;
  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < HARMONIC_PARTS; part++)
    PetscCall(SphereFieldValues(&s->sphere->fine, part, c, s->D[part]));
  s->area = s->volume = s->energy = 0;
  for (PetscInt i = 0; i < s->n; i++) {
    const SurfacePoint at = SurfacePointOf(s, i);
    s->J[i] = at.W / (at.root * at.root);
    s->h[i] = at.N * PetscPowReal(at.W, -2.5) / at.root;
    for (int d = 0; d < 3; d++) s->normal[d * s->n + i] = at.a[d] / at.W;
    s->area += g->weight[i] * s->J[i];
    s->volume += g->weight[i] * Dot(at.X[HARMONIC], at.a) / (3 * at.root * at.root);
    s->energy += 0.5 * g->weight[i] * s->h[i] * s->h[i];
  }
  if (derivatives) PetscCall(SurfaceDerivatives(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C[columns_B][columns_A] = SUM over points of factor A B, A[columns_A][n], B[columns_B][n]. */
static PetscErrorCode SurfaceProduct(Surface s, const PetscReal factor[], PetscInt columns_A, const PetscReal A[],
                                     PetscInt columns_B, const PetscReal B[], PetscReal C[]) {
  const PetscInt n = s->n;
  PetscReal *scaled;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * columns_A, &scaled));
  for (PetscInt k = 0; k < columns_A; k++)
    for (PetscInt i = 0; i < n; i++) scaled[k * n + i] = factor[i] * A[k * n + i];
  PetscCall(DenseProduct(PETSC_TRUE, columns_A, columns_B, n, scaled, B, C));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C[columns][columns] = SUM over points of the grid's weight times A A, A[columns][n]. */
static PetscErrorCode SurfaceGram(Surface s, PetscInt columns, const PetscReal A[], PetscReal C[]) {
  PetscReal *scaled, *root;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->n * columns, &scaled, s->n, &root));
  for (PetscInt i = 0; i < s->n; i++) root[i] = PetscSqrtReal(s->sphere->fine.grid.weight[i]);
  for (PetscInt k = 0; k < columns; k++)
    for (PetscInt i = 0; i < s->n; i++) scaled[k * s->n + i] = root[i] * A[k * s->n + i];
  PetscCall(DenseGram(columns, s->n, scaled, C));
  PetscCall(PetscFree2(scaled, root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceGradient(Surface s, PetscReal g[]) {
  PetscFunctionBeginUser;
  PetscCall(SurfaceProduct(s, s->sphere->fine.grid.weight, 1, s->h, s->sphere->size, s->dh, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceBending(Surface s, PetscReal K[]) {
  PetscFunctionBeginUser;
  PetscCall(SurfaceGram(s, s->sphere->size, s->dh, K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceAreaColumns(Surface s, PetscReal A[]) {
  const SphereTable *fine = &s->sphere->fine;
  PetscFunctionBeginUser;
  PetscCall(SurfaceProduct(s, fine->grid.weight, s->sphere->size, s->dJ, s->sphere->count, fine->part[HARMONIC], A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceNormals(Surface s, PetscReal N[]) {
  PetscReal *normal;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->sphere->size * s->n, &normal));
  SurfaceCombine(s, HARMONIC, HARMONIC, s->normal, normal);
  PetscCall(SurfaceGram(s, s->sphere->size, normal, N));
  PetscCall(PetscFree(normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* L[count][count] = INT max(sigma, 0) grad_s Y_k . grad_s Y_l dA. */
static PetscErrorCode SurfaceTensionGradients(Surface s, const PetscReal sigma[], PetscReal L[]) {
  const PetscInt n = s->n, count = s->sphere->count;
  PetscReal *at, *factor, *block;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &at, 3 * n, &factor, count * count, &block));
  PetscCall(SphereTableValues(&s->sphere->fine, HARMONIC, count, 1, sigma, at));
  for (PetscInt i = 0; i < n; i++) {
    const SurfacePoint point = SurfacePointOf(s, i);
    const PetscReal a = s->sphere->fine.grid.weight[i] * s->J[i] * PetscMax(at[i], 0) / PetscSqr(point.W);
    factor[i] = a * point.G;
    factor[n + i] = -a * point.F;
    factor[2 * n + i] = a * point.E;
  }
  PetscCall(PetscArrayzero(L, count * count));
  for (int q = 0; q < 4; q++) {
    const PetscReal *A = s->sphere->fine.part[q / 2 ? HARMONIC_P : HARMONIC_T],
                    *B = s->sphere->fine.part[q % 2 ? HARMONIC_P : HARMONIC_T];
    PetscCall(SurfaceProduct(s, factor + (q / 2 + q % 2) * n, count, A, count, B, block));
    for (PetscInt k = 0; k < count * count; k++) L[k] += block[k];
  }
  PetscCall(PetscFree3(at, factor, block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfacePull(Surface s, const PetscReal sigma[], PetscReal K[]) {
  const PetscInt n = s->n, count = s->sphere->count, size = s->sphere->size;
  PetscReal *L, *normal, *projected, *LP;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(count * count, &L, size * n, &normal, size * count, &projected, size * count, &LP));
  PetscCall(SurfaceTensionGradients(s, sigma, L));
  SurfaceCombine(s, HARMONIC, HARMONIC, s->normal, normal);
  PetscCall(SphereTableProject(&s->sphere->fine, count, size, normal, projected));
  PetscCall(DenseProduct(PETSC_FALSE, count, size, count, L, projected, LP));
  PetscCall(DenseProduct(PETSC_TRUE, size, size, count, projected, LP, K));
  PetscCall(PetscFree4(L, normal, projected, LP));
  PetscFunctionReturn(PETSC_SUCCESS);
}
