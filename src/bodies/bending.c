#include "bodies/bending.h"
#include "numerics/blas.h"

/* Y += w (second difference of X) around a closed curve of n points. */
static void CurveAddSecondDifference(PetscInt n, PetscReal w, const PetscScalar X[], PetscScalar Y[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt p = k ? k - 1 : n - 1, q = k < n - 1 ? k + 1 : 0;
    for (int c = 0; c < 2; c++) Y[2 * k + c] += w * (X[2 * p + c] - 2 * X[2 * k + c] + X[2 * q + c]);
  }
}

/* Y += B X. */
static void BendingCurvature(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar Y[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *slope = m->work.memory;
  SpectralDerivative(m->spectral[v], 2, PetscSqr(n / m->arc[v]), X, Y);
  if (!m->memory) return;
  (void)PetscArrayzero(slope, 2 * n);
  SpectralDerivative(m->spectral[v], 1, n / m->arc[v], X, slope);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal kappa = m->memory[m->layout->start[v] + k];
    Y[2 * k] += kappa * slope[2 * k + 1];
    Y[2 * k + 1] -= kappa * slope[2 * k];
  }
}

PetscErrorCode MembraneMemoryMatrix(Membrane m, PetscInt v, PetscReal **BB) {
  const PetscInt n = 2 * LayoutCount(m->layout, v);
  PetscReal *unit, *B;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, BB));
  PetscCall(PetscCalloc2(n, &unit, n * n, &B));
  for (PetscInt k = 0; k < n; k++) {
    unit[k] = PetscSqrtReal(m->ds[v]);
    BendingCurvature(m, v, unit, B + n * k);
    unit[k] = 0;
  }
  PetscCall(DenseProduct(PETSC_TRUE, n, n, n, B, B, *BB));
  PetscCall(PetscFree2(unit, B));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MembraneVesicleBending(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *curvature = m->work.bending;
  alpha *= m->part[v];
  if (m->memory) {
    PetscScalar *near = m->work.bending; /* X close to the origin; far from it digits would be lost */
    for (PetscInt k = 0; k < 2 * n; k++) near[k] = X[k] - X[k % 2];
    (void)DenseMultAdd(PETSC_FALSE, 2 * n, 2 * n, alpha, m->BB[v], near, F);
    return;
  }
  if (m->derivative != DERIVATIVE_FD) {
    SpectralDerivative(m->spectral[v], 4, alpha * m->ds[v] * PetscPowRealInt(n / m->arc[v], 4), X, F);
    return;
  }
  (void)PetscArrayzero(curvature, 2 * n);
  CurveAddSecondDifference(n, 1 / PetscSqr(m->ds[v]), X, curvature);
  CurveAddSecondDifference(n, alpha / m->ds[v], curvature, F); /* ds D+D-/ds^2 */
}

void MembraneBending(Membrane m, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    MembraneVesicleBending(m, v, alpha, X + at, F + at);
  }
}

PetscReal MembraneBendingEnergy(Membrane m, PetscInt v, const PetscScalar X[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *curvature = m->work.bending;
  PetscReal sum = 0;
  (void)PetscArrayzero(curvature, 2 * n);
  if (m->derivative == DERIVATIVE_FD)
    CurveAddSecondDifference(n, 1 / PetscSqr(m->ds[v]), X, curvature);
  else
    BendingCurvature(m, v, X, curvature);
  for (PetscInt k = 0; k < 2 * n; k++) sum += PetscSqr(curvature[k]);
  return 0.5 * m->bending * m->part[v] * sum * m->ds[v];
}

static PetscErrorCode BendingRate(void *context, PetscReal alpha, const PetscScalar V[], PetscScalar F[]) {
  const Membrane m = (Membrane)context;
  PetscFunctionBeginUser;
  MembraneBending(m, alpha * m->bending, V, F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D4 is circulant: all columns are the first one, shifted. B^T B is not. */
static PetscErrorCode BendingDense(void *context, PetscInt v, PetscReal alpha, PetscReal K[]) {
  const Membrane m = (Membrane)context;
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal *unit, *first;
  PetscFunctionBeginUser;
  alpha *= m->bending;
  if (m->memory) {
    for (PetscInt k = 0; k < 4 * n * n; k++) K[k] += alpha * m->part[v] * m->BB[v][k];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc2(2 * n, &unit, 2 * n, &first));
  unit[0] = 1;
  MembraneVesicleBending(m, v, alpha, unit, first);
  DenseAddCirculant(n, first, 2 * n, K);
  PetscCall(PetscFree2(unit, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BendingEnergy(void *context, Instant at, const PetscScalar X[], PetscReal E[]) {
  const Membrane m = (Membrane)context;
  PetscFunctionBeginUser;
  for (PetscInt v = m->layout->own; v < m->layout->end; v++)
    E[v] += MembraneBendingEnergy(m, v, X + 2 * LayoutOffset(m->layout, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Bending(Bodies bodies, Grid grid, Scene scene, Force *force) {
  const Membrane m = bodies->membrane;
  PetscFunctionBeginUser;
  if (m->bending > 0 && m->moment == MOMENT_QUADRATIC)
    *force = (Force){.name = "bending",
                     .reach = FORCE_WITHIN,
                     .context = m,
                     .rate = BendingRate,
                     .dense = BendingDense,
                     .energy = BendingEnergy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
