#include "fluid/transforms/sinematrix.h"
#include "base/lanes.h"

PetscReal SineMatrixWave(SineMatrixKind kind, PetscInt n, PetscInt k) {
  if (kind == SINE_MATRIX_ENTRIES) return (k + 1.0) / (n + 1.0);
  return (kind == SINE_MATRIX_HALF_SINES ? k + 1.0 : k) / n;
}

/* Entry j of mode k, divided by the root of 2 over the period. sine[q] = sin(pi q/(2 N)) of a whole period, 0 <= q <
   4 N: integers keep the phases exact. */
static PetscReal Entry(SineMatrixKind kind, PetscInt n, PetscInt k, PetscInt j, const PetscReal sine[]) {
  if (kind == SINE_MATRIX_ENTRIES) return sine[2 * (k + 1) * (j + 1) % (4 * (n + 1))];
  if (kind == SINE_MATRIX_HALF_SINES) return sine[(k + 1) * (2 * j + 1) % (4 * n)] * (k + 1 == n ? PETSC_SQRT2 / 2 : 1);
  return sine[(k * (2 * j + 1) + n) % (4 * n)] * (k == 0 ? PETSC_SQRT2 / 2 : 1);
}

PetscErrorCode SineMatrixCreate(SineMatrixKind kind, PetscInt n, SineMatrix *m) {
  const PetscInt N = kind == SINE_MATRIX_ENTRIES ? n + 1 : n;
  PetscReal sine[4 * (SINE_MATRIX_MOST + 1)];
  PetscFunctionBeginUser;
  *m = (SineMatrix){.n = n, .stride = (n + LANES - 1) / LANES * LANES};
  if (n > SINE_MATRIX_MOST) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < 4 * N; q++) sine[q] = PetscSinReal(PETSC_PI * q / (2.0 * N));
  for (int way = 0; way < 2; way++) PetscCall(PetscCalloc1(n * m->stride, &m->matrix[way]));
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt j = 0; j < n; j++)
      m->matrix[0][j * m->stride + k] = m->matrix[1][k * m->stride + j] = PetscSqrtReal(2.0 / N) *
                                                                          Entry(kind, n, k, j, sine);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SineMatrixDestroy(SineMatrix *m) {
  PetscFunctionBeginUser;
  for (int way = 0; way < 2; way++) PetscCall(PetscFree(m->matrix[way]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = x A for `vectors` times LANES columns of A. The last vector may be longer than the rest of y. The function is
   inlined for each number of vectors, so that all sums stay in registers. */
static inline __attribute__((always_inline)) void Columns(int vectors, PetscInt n, PetscInt stride, PetscInt columns,
                                                          const PetscReal A[], const PetscReal x[], PetscReal y[]) {
  Lanes sum[8];
  for (int v = 0; v < vectors; v++) sum[v] = (Lanes){0};
  for (PetscInt i = 0; i < n; i++)
    for (int v = 0; v < vectors; v++) sum[v] += x[i] * LanesAt(A + i * stride + v * LANES);
  for (int v = 0; v < vectors - 1; v++) LanesPut(sum[v], y + v * LANES);
  const PetscInt last = (vectors - 1) * LANES;
  if (columns >= vectors * LANES)
    LanesPut(sum[vectors - 1], y + last);
  else
    for (PetscInt k = 0; k < columns - last; k++) y[last + k] = sum[vectors - 1][k];
}

void SineMatrixApply(const SineMatrix *m, int way, const PetscReal x[], PetscReal y[]) {
  const PetscInt n = m->n, stride = m->stride;
  const PetscReal *A = m->matrix[way];
  PetscInt at = 0;
  for (; stride - at > 8 * LANES; at += 6 * LANES) Columns(6, n, stride, n - at, A + at, x, y + at);
#define REST(vectors)                                                                                                  \
  case vectors:                                                                                                        \
    Columns(vectors, n, stride, n - at, A + at, x, y + at);                                                            \
    break;
  switch ((stride - at) / LANES) {
    REST(1)
    REST(2)
    REST(3)
    REST(4)
    REST(5)
    REST(6)
    REST(7)
    REST(8)
  }
#undef REST
}
