#include "sphere/spherelayer.h"
#include "numerics/blas.h"

/* Components of symmetric tensors, and where the product of the components a and b is. */
enum { TENSOR_XX, TENSOR_YY, TENSOR_ZZ, TENSOR_YZ, TENSOR_XZ, TENSOR_XY, TENSOR_COUNT };
static const int TensorPlace[3][3] = {
    {TENSOR_XX, TENSOR_XY, TENSOR_XZ}, {TENSOR_XY, TENSOR_YY, TENSOR_YZ}, {TENSOR_XZ, TENSOR_YZ, TENSOR_ZZ}};

/* G = (a I + b d d) at one of n distances. */
static inline void SetTensor(PetscInt n, PetscReal a, PetscReal b, const PetscReal d[], PetscReal G[]) {
  const PetscReal x = d[0], y = d[n], z = d[2 * n];
  G[TENSOR_XX * n] = a + b * x * x;
  G[TENSOR_YY * n] = a + b * y * y;
  G[TENSOR_ZZ * n] = a + b * z * z;
  G[TENSOR_YZ * n] = b * y * z;
  G[TENSOR_XZ * n] = b * x * z;
  G[TENSOR_XY * n] = b * x * y;
}

static inline PetscReal Dot(PetscInt n, const PetscReal a[], const PetscReal b[]) {
  return a[0] * b[0] + a[n] * b[n] + a[2 * n] * b[2 * n];
}

static void SetStokeslets(PetscInt n, const PetscReal d[], const PetscReal normal[], const PetscReal weight[],
                          PetscReal G[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal r2 = Dot(n, d + k, d + k), a = weight[k] / (8 * PETSC_PI * PetscSqrtReal(r2));
    SetTensor(n, a, a / r2, d + k, G + k);
  }
}

static void SetStresslets(PetscInt n, const PetscReal d[], const PetscReal normal[], const PetscReal weight[],
                          PetscReal G[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal r2 = Dot(n, d + k, d + k), r5 = r2 * r2 * PetscSqrtReal(r2);
    SetTensor(n, 0, -3 * weight[k] * Dot(n, d + k, normal + k) / (4 * PETSC_PI * r5), d + k, G + k);
  }
}

const Kernel3 Stokeslet3 = {.set = SetStokeslets}, Stresslet3 = {.set = SetStresslets, .normal = PETSC_TRUE};

/* Work of one latitude: `around` turns of the surface, n points of the turned grid. */
typedef struct {
  PetscInt around, n;
  PetscReal *turned; /* [around][3][count] coefficients, of degree 2p for normals */
  PetscReal *X;      /* [around][3][n] points */
  PetscReal *normal; /* [around][3][n], where the kernel has one */
  PetscReal *G;      /* [around][TENSOR_COUNT][n] */
  PetscReal *rows;   /* [count][around TENSOR_COUNT] */
} LatitudeWork;

/* y[around][3][n]: fields with coefficients c[3] of degree p, at the points of all turns of a turned table. */
static PetscErrorCode LayerTurnedValues(const SphereTable *t, PetscInt p, const PetscReal c[], LatitudeWork *w,
                                        PetscReal y[]) {
  const PetscInt count = HarmonicsCount(p);
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < w->around; j++)
    for (int d = 0; d < 3; d++)
      HarmonicsTurn(p, 2 * PETSC_PI * j / w->around, PETSC_FALSE, c + d * count, w->turned + (3 * j + d) * count);
  PetscCall(SphereTableValues(t, HARMONIC, count, 3 * w->around, w->turned, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The inner integrals for the points of one latitude: out[TENSOR_COUNT][count][targets]; at[3][targets]: the points. */
static PetscErrorCode LayerLatitude(Sphere s, const Kernel3 *kernel, PetscInt latitude, const PetscReal at[],
                                    LatitudeWork *w, PetscReal out[]) {
  const PetscInt n = w->n, count = s->count, targets = s->shape.grid.n, rows = TENSOR_COUNT * w->around;
  PetscReal *row = w->turned, *back = w->turned + count;
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < w->around; j++) {
    PetscReal *d = w->X + 3 * j * n;
    for (PetscInt k = 0; k < 3 * n; k++) d[k] = at[(k / n) * targets + latitude * w->around + j] - d[k];
    kernel->set(n, d, w->normal + 3 * j * n, s->turned[latitude].grid.weight, w->G + TENSOR_COUNT * j * n);
  }
  PetscCall(DenseProduct(PETSC_TRUE, rows, count, n, w->G, s->turned[latitude].part[HARMONIC], w->rows));
  for (PetscInt r = 0; r < rows; r++) {
    const PetscInt j = r / TENSOR_COUNT, target = latitude * w->around + j;
    for (PetscInt l = 0; l < count; l++) row[l] = w->rows[l * rows + r];
    HarmonicsTurn(s->p, 2 * PETSC_PI * j / w->around, PETSC_TRUE, row, back);
    for (PetscInt l = 0; l < count; l++) out[((r % TENSOR_COUNT) * count + l) * targets + target] = back[l];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayerNormals(const SphereTable *t, const PetscReal c[], PetscReal a[]) {
  const PetscInt n = t->grid.n;
  PetscReal *T, *P;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &T, 3 * n, &P));
  PetscCall(SphereFieldValues(t, HARMONIC_T, c, T));
  PetscCall(SphereFieldValues(t, HARMONIC_P, c, P));
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      a[d * n + i] = (T[e * n + i] * P[f * n + i] - T[f * n + i] * P[e * n + i]) / PetscSinReal(t->grid.theta[i]);
    }
  PetscCall(PetscFree2(T, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficients of degree 2p of n dA/domega, a polynomial of that degree. */
static PetscErrorCode LayerNormalFields(Sphere s, const PetscReal c[], PetscReal m[]) {
  PetscReal *a;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * s->fine.grid.n, &a));
  PetscCall(LayerNormals(&s->fine, c, a));
  PetscCall(SphereFieldProject(&s->twice, a, m));
  PetscCall(PetscFree(a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* m: coefficients of the normals. */
static PetscErrorCode WholeLayerMatrix(Sphere s, const Kernel3 *kernel, const PetscReal c[], const PetscReal m[],
                                       PetscReal M[]) {
  const PetscInt count = s->count, targets = s->shape.grid.n, size = 3 * count, around = 2 * s->p + 2,
                 n = s->turned->grid.n, many = HarmonicsCount(kernel->normal ? 2 * s->p : s->p);
  LatitudeWork w = {.around = around, .n = n};
  PetscReal *at, *out, *block;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(3 * targets, &at, TENSOR_COUNT * count * targets, &out, TENSOR_COUNT * count * count, &block));
  PetscCall(PetscMalloc5(3 * around * many, &w.turned, 3 * around * n, &w.X, 3 * around * n, &w.normal,
                         TENSOR_COUNT * around * n, &w.G, TENSOR_COUNT * around * count, &w.rows));
  PetscCall(SphereFieldValues(&s->shape, HARMONIC, c, at));
  for (PetscInt i = 0; i <= s->p; i++) {
    PetscCall(LayerTurnedValues(&s->turned[i], s->p, c, &w, w.X));
    if (kernel->normal) PetscCall(LayerTurnedValues(&s->normal[i], 2 * s->p, m, &w, w.normal));
    PetscCall(LayerLatitude(s, kernel, i, at, &w, out));
  }
  PetscCall(SphereTableProject(&s->shape, count, TENSOR_COUNT * count, out, block));
  for (int a = 0; a < 3; a++)
    for (PetscInt l = 0; l < size; l++)
      PetscCall(PetscArraycpy(M + l * size + a * count, block + (TensorPlace[a][l / count] * count + l % count) * count,
                              count));
  PetscCall(PetscFree3(at, out, block));
  PetscCall(PetscFree5(w.turned, w.X, w.normal, w.G, w.rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same of a body of revolution: targets are the points of one meridian, where fields have two components. */
static PetscErrorCode MeridianLayerMatrix(Sphere s, const Kernel3 *kernel, const PetscReal c[], const PetscReal m[],
                                          PetscReal M[]) {
  const PetscInt n = s->turned->grid.n, latitudes = s->p + 1;
  PetscReal *at, *d, *normal, *G, *rows, *out;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(3 * latitudes, &at, 3 * n, &d, 3 * n, &normal, TENSOR_COUNT * n, &G, TENSOR_COUNT * latitudes,
                         &rows));
  PetscCall(PetscCalloc1(s->size * 3 * latitudes, &out)); /* [size][3][latitudes] inner integrals of each harmonic */
  PetscCall(SphereFieldValues(&s->shape, HARMONIC, c, at));
  for (PetscInt i = 0; i < latitudes; i++) {
    const SphereTable *turned = &s->turned[i];
    PetscCall(SphereFieldValues(turned, HARMONIC, c, d));
    for (PetscInt k = 0; k < 3 * n; k++) d[k] = at[k / n * latitudes + i] - d[k];
    if (kernel->normal) PetscCall(SphereFieldValues(&s->normal[i], HARMONIC, m, normal));
    kernel->set(n, d, normal, turned->grid.weight, G);
    for (int b = 0; b < 3; b++) {
      const FieldComponent *own = &turned->component[b];
      PetscCall(DenseProduct(PETSC_TRUE, TENSOR_COUNT, own->columns, n, G, own->part[HARMONIC], rows));
      for (PetscInt k = 0; k < own->columns; k++)
        for (int a = 0; a < 2; a++)
          out[(3 * (own->first + k) + a) * latitudes + i] += rows[k * TENSOR_COUNT + TensorPlace[a][b]];
    }
  }
  for (PetscInt l = 0; l < s->size; l++)
    PetscCall(SphereFieldProject(&s->shape, out + 3 * l * latitudes, M + l * s->size));
  PetscCall(PetscFree5(at, d, normal, G, rows));
  PetscCall(PetscFree(out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereLayerMatrix(Sphere s, const Kernel3 *kernel, const PetscReal c[], PetscReal M[]) {
  PetscReal *m = NULL;
  PetscFunctionBeginUser;
  PetscCall(SphereTurn(s, kernel->normal));
  if (kernel->normal) PetscCall(PetscMalloc1(3 * HarmonicsCount(2 * s->p), &m));
  if (kernel->normal) PetscCall(LayerNormalFields(s, c, m));
  PetscCall((s->symmetry == SPHERE_WHOLE ? WholeLayerMatrix : MeridianLayerMatrix)(s, kernel, c, m, M));
  PetscCall(PetscFree(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereSingleLayer(Sphere s, PetscReal nu, const PetscReal c[], PetscReal M[]) {
  const PetscInt size = s->size;
  PetscFunctionBeginUser;
  PetscCall(SphereLayerMatrix(s, &Stokeslet3, c, M));
  for (PetscInt l = 0; l < size; l++)
    for (PetscInt k = 0; k <= l; k++)
      M[l * size + k] = M[k * size + l] = (M[l * size + k] + M[k * size + l]) / (2 * nu);
  PetscFunctionReturn(PETSC_SUCCESS);
}
