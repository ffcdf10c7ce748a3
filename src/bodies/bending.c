#include "bodies/bending.h"
#include "numerics/blas.h"

/* Y += w (second difference of X) around a closed curve of n points. */
static void CurveAddSecondDifference(PetscInt n, PetscReal w, const PetscScalar X[], PetscScalar Y[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt p = k ? k - 1 : n - 1, q = k < n - 1 ? k + 1 : 0;
    for (int c = 0; c < 2; c++) Y[2 * k + c] += w * (X[2 * p + c] - 2 * X[2 * k + c] + X[2 * q + c]);
  }
}

/* Y += B X; X is moved to the origin, far from which a matrix would lose digits. */
static void BendingCurvature(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar Y[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *near = m->work.memory;
  if (!m->memory) {
    SpectralDerivative(m->spectral[v], 2, PetscSqr(n / m->arc[v]), X, Y);
    return;
  }
  for (PetscInt k = 0; k < 2 * n; k++) near[k] = X[k] - X[k % 2];
  (void)DenseMultAdd(PETSC_FALSE, 2 * n, 2 * n, 1, m->B[v], near, Y);
}

void MembraneVesicleBending(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *curvature = m->work.bending;
  alpha *= m->part[v];
  if (m->memory) {
    (void)PetscArrayzero(curvature, 2 * n);
    BendingCurvature(m, v, X, curvature);
    (void)DenseMultAdd(PETSC_TRUE, 2 * n, 2 * n, alpha * m->ds[v], m->B[v], curvature, F);
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
  const PetscInt n = 2 * LayoutCount(m->layout, v), columns = m->memory ? n : 1;
  PetscReal *unit, *B;
  PetscFunctionBeginUser;
  alpha *= m->bending;
  PetscCall(PetscCalloc2(n, &unit, n * columns, &B));
  if (m->memory) {
    const DenseView root = {B, n, n, n};
    for (PetscInt k = 0; k < n * n; k++) B[k] = PetscSqrtReal(alpha * m->part[v] * m->ds[v]) * m->B[v][k];
    PetscCall(DenseProductWithin(PETSC_TRUE, root, root, 1, K, n));
  } else {
    unit[0] = 1;
    MembraneVesicleBending(m, v, alpha, unit, B);
    DenseAddCirculant(n / 2, B, n, K);
  }
  PetscCall(PetscFree2(unit, B));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BendingEnergy(void *context, Instant at, const PetscScalar X[], PetscScalar F[], PetscReal E[]) {
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
