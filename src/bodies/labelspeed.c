#include "bodies/membrane.h"

/* Ratio of the fit's singular values below which a turn and a shift of labels are taken to be the same. */
#define DISTINCT 0.05

/* Sums over the markers of the products of U - mean U, T = dX/dt and R = J (X - mean X). */
typedef struct {
  PetscReal TT, TR, RR, UT, UR;
} Products;

static Products TreadingProducts(PetscInt n, const PetscScalar X[], const PetscScalar U[], const PetscScalar T[]) {
  PetscReal center[2] = {0, 0}, mean[2] = {0, 0};
  Products p = {0};
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) {
      center[c] += X[2 * k + c] / n;
      mean[c] += U[2 * k + c] / n;
    }
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal R[2] = {center[1] - X[2 * k + 1], X[2 * k] - center[0]};
    for (int c = 0; c < 2; c++) {
      const PetscReal u = U[2 * k + c] - mean[c], t = T[2 * k + c];
      p.TT += t * t;
      p.TR += t * R[c];
      p.RR += R[c] * R[c];
      p.UT += u * t;
      p.UR += u * R[c];
    }
  }
  return p;
}

PetscReal MembraneTreading(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *T = m->work.treading;
  (void)PetscArrayzero(T, 2 * n);
  MembraneLabelDerivative(m, v, 1, X, T);
  const Products p = TreadingProducts(n, X, U, T);
  /* the eigenvalues of the normal equations are the squares of the singular values */
  const PetscReal half = 0.5 * (p.TT + p.RR), determinant = p.TT * p.RR - p.TR * p.TR;
  const PetscReal largest = half + PetscSqrtReal(PetscMax(half * half - determinant, 0));
  if (!(determinant > PetscSqr(DISTINCT * largest))) return p.TT > 0 ? p.UT / p.TT : 0;
  return (p.RR * p.UT - p.TR * p.UR) / determinant;
}

void MembraneLabelDerivative(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar X[], PetscScalar Y[]) {
  SpectralDerivative(m->spectral[v], 1, alpha * LayoutCount(m->layout, v) / (2 * PETSC_PI), X, Y);
}

void MembraneTread(Membrane m, const PetscReal V[], PetscReal alpha, const PetscScalar X[], PetscScalar U[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    if (V[v] != 0) MembraneLabelDerivative(m, v, alpha * V[v], X + at, U + at);
  }
}

void MembraneShiftLabels(Membrane m, const PetscReal V[], PetscReal time, int each, const PetscScalar x[],
                         PetscScalar y[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = each * LayoutOffset(m->layout, v);
    SpectralShift(m->spectral[v], each, V[v] * time, x + at, y + at);
  }
}
