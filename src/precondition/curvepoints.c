#include "precondition/curvepoints.h"
#include "numerics/spectral.h"

/* Value at angle t (pi: the other end) of the cosines that are 1 at point i of n and 0 at the others. */
static PetscReal CosineCardinal(PetscInt n, PetscInt i, PetscReal t) {
  const PetscReal own = PETSC_PI * (i + 0.5) / n;
  PetscReal sum = 1;
  for (PetscInt m = 1; m < n; m++) sum += 2 * PetscCosReal(m * own) * PetscCosReal(m * t);
  return sum / n;
}

PetscErrorCode CurvePointsCreate(PetscBool open, PetscInt n, PetscInt points, CurvePoints *w) {
  PetscFunctionBeginUser;
  *w = (CurvePoints){.n = n, .points = points};
  PetscCall(PetscMalloc2(n * points, &w->to_markers, n * points, &w->to_points));
  for (PetscInt i = 0; i < points; i++)
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal t = 2 * PETSC_PI * ((PetscReal)k / (PetscReal)n - (PetscReal)i / (PetscReal)points);
      w->to_markers[i * n + k] = open ? CosineCardinal(points, i, PETSC_PI * (k + 0.5) / n)
                                      : TrigonometricCardinal(points, t);
      w->to_points[i * n + k] = open ? CosineCardinal(n, k, PETSC_PI * (i + 0.5) / points)
                                     : TrigonometricCardinal(n, -t);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurvePointsDestroy(CurvePoints *w) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(w->to_markers, w->to_points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CurvePointsPlace(const CurvePoints *w, const PetscReal span[2], const PetscReal X[], PetscReal Y[]) {
  for (PetscInt i = 0; i < 2 * w->points; i++) {
    Y[i] = span[i % 2] * (PetscReal)(i / 2) / (PetscReal)w->points;
    for (PetscInt k = 0; k < w->n; k++)
      Y[i] += w->to_points[i / 2 * w->n + k] * (X[2 * k + i % 2] - span[i % 2] * (PetscReal)k / (PetscReal)w->n);
  }
}
