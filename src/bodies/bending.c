#include "bodies/bending.h"
#include "numerics/blas.h"

/* Y += w (second difference of X) around a closed curve of n points. */
static void CurveAddSecondDifference(PetscInt n, PetscReal w, const PetscScalar X[], PetscScalar Y[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt p = k ? k - 1 : n - 1, q = k < n - 1 ? k + 1 : 0;
    for (int c = 0; c < 2; c++) Y[2 * k + c] += w * (X[2 * p + c] - 2 * X[2 * k + c] + X[2 * q + c]);
  }
}

/* Y += J (D1 X) kappa0, or (transposed) J D1 (kappa0 X), times w and by the arc length. */
static void BendingAddMemory(Membrane m, PetscInt v, PetscBool transposed, PetscReal w, const PetscScalar X[],
                             PetscScalar Y[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  const PetscReal *kappa = m->memory + m->layout->start[v];
  PetscScalar *given = m->work.memory, *slope = given + 2 * n;
  for (PetscInt k = 0; k < 2 * n; k++) given[k] = transposed ? kappa[k / 2] * X[k] : X[k];
  (void)PetscArrayzero(slope, 2 * n);
  SpectralDerivative(m->spectral[v], 1, w * n / m->arc[v], given, slope);
  for (PetscInt k = 0; k < n; k++) {
    Y[2 * k] -= (transposed ? 1 : kappa[k]) * slope[2 * k + 1];
    Y[2 * k + 1] += (transposed ? 1 : kappa[k]) * slope[2 * k];
  }
}

/* Y += B X. */
static void BendingCurvature(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar Y[]) {
  SpectralDerivative(m->spectral[v], 2, PetscSqr(LayoutCount(m->layout, v) / m->arc[v]), X, Y);
  if (m->memory) BendingAddMemory(m, v, PETSC_FALSE, -1, X, Y);
}

void MembraneVesicleBending(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *curvature = m->work.bending;
  alpha *= m->part[v];
  if (m->memory) {
    (void)PetscArrayzero(curvature, 2 * n);
    BendingCurvature(m, v, X, curvature);
    SpectralDerivative(m->spectral[v], 2, alpha * m->ds[v] * PetscSqr(n / m->arc[v]), curvature, F);
    BendingAddMemory(m, v, PETSC_TRUE, -alpha * m->ds[v], curvature, F);
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
  const PetscInt n = LayoutCount(m->layout, v), columns = m->memory ? 2 * n : 1;
  PetscReal *unit, *first;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &unit, 2 * n, &first));
  for (PetscInt k = 0; k < columns; k++) {
    unit[k] = 1;
    MembraneVesicleBending(m, v, alpha * m->bending, unit, m->memory ? K + 2 * n * k : first);
    unit[k] = 0;
  }
  if (!m->memory) DenseAddCirculant(n, first, 2 * n, K);
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
