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
