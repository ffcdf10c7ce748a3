#include "coupling/waves.h"
#include "coupling/blas.h"

/* Function m of a curve that repeats: the constant, cos t, sin t, cos 2 t, .. */
static PetscReal Periodic(PetscInt n, PetscInt m, PetscInt k) {
  const PetscInt wave = (m + 1) / 2;
  const PetscReal angle = 2 * PETSC_PI * (PetscReal)((wave * k) % n) / n;
  if (!m) return PetscSqrtReal(1. / n);
  return PetscSqrtReal(2. / n) * (m % 2 ? PetscCosReal(angle) : PetscSinReal(angle));
}

static PetscReal Open(PetscInt n, PetscInt m, PetscInt k) {
  return PetscSqrtReal((m ? 2. : 1.) / n) * PetscCosReal(PETSC_PI * m * (k + 0.5) / n);
}

/* The fit's weights by the normal equations: (V V^T)^-1 V, V the functions at the places. */
static PetscErrorCode Fit(Waves *w) {
  PetscReal *V, *N;
  PetscBLASInt *pivot;
  PetscBool done;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(w->count * w->places, &V, w->count * w->count, &N, w->count, &pivot));
  for (PetscInt s = 0; s < w->places; s++)
    for (PetscInt m = 0; m < w->count; m++) V[s * w->count + m] = w->value[m * w->n + w->place[s]];
  for (PetscInt i = 0; i < w->count; i++)
    for (PetscInt j = 0; j < w->count; j++) {
      N[j * w->count + i] = 0;
      for (PetscInt s = 0; s < w->places; s++) N[j * w->count + i] += V[s * w->count + i] * V[s * w->count + j];
    }
  PetscCall(DenseFactor(w->count, N, pivot, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_PLIB, "functions of a curve that do not differ");
  PetscCall(DenseSolve(w->count, N, pivot, PETSC_FALSE, w->places, V));
  for (PetscInt s = 0; s < w->places; s++)
    for (PetscInt m = 0; m < w->count; m++) w->fit[m * w->places + s] = V[s * w->count + m];
  PetscCall(PetscFree3(V, N, pivot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WavesCreate(PetscBool open, PetscInt n, PetscInt count, Waves *w) {
  PetscFunctionBeginUser;
  *w = (Waves){.n = n, .count = count, .places = PetscMin(n, 2 * count + 1)};
  PetscCall(PetscMalloc3(count * n, &w->value, w->places, &w->place, count * w->places, &w->fit));
  for (PetscInt m = 0; m < count; m++)
    for (PetscInt k = 0; k < n; k++) w->value[m * n + k] = (open ? Open : Periodic)(n, m, k);
  for (PetscInt s = 0; s < w->places; s++) w->place[s] = (2 * s + 1) * n / (2 * w->places);
  PetscCall(Fit(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WavesDestroy(Waves *w) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(w->value, w->place, w->fit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void WavesOf(const Waves *w, const PetscReal x[], PetscReal a[]) {
  for (PetscInt m = 0; m < w->count; m++)
    for (int c = 0; c < 2; c++) {
      a[2 * m + c] = 0;
      for (PetscInt k = 0; k < w->n; k++) a[2 * m + c] += w->value[m * w->n + k] * x[2 * k + c];
    }
}

void WavesSum(const Waves *w, const PetscReal a[], PetscReal x[]) {
  (void)PetscArrayzero(x, 2 * w->n);
  for (PetscInt m = 0; m < w->count; m++)
    for (PetscInt k = 0; k < w->n; k++)
      for (int c = 0; c < 2; c++) x[2 * k + c] += w->value[m * w->n + k] * a[2 * m + c];
}
