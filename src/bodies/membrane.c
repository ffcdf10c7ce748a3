#include "bodies/membrane.h"

/* Arc length of one vesicle's curve by spectral derivatives. */
static PetscReal ArcLength(Membrane m, PetscInt v, const PetscScalar X[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *e = m->work.measures;
  PetscReal length = 0;
  (void)PetscArrayzero(e, 2 * n);
  SpectralDerivative(m->spectral[v], 1, 1, X, e);
  for (PetscInt k = 0; k < n; k++) length += PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
  return length;
}

/* `part` of the curvature of one vesicle's curve of equal edges at its markers. */
static void MembraneCurvature(Membrane m, PetscInt v, PetscReal part, const PetscScalar X[], PetscReal kappa[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *slope = m->work.memory, *second = slope + 2 * n;
  (void)PetscArrayzero(slope, 4 * n);
  SpectralDerivative(m->spectral[v], 1, n / m->arc[v], X, slope);
  SpectralDerivative(m->spectral[v], 2, PetscSqr(n / m->arc[v]), X, second);
  for (PetscInt k = 0; k < 2 * n; k += 2) kappa[k / 2] = part * (slope[k] * second[k + 1] - slope[k + 1] * second[k]);
}

/* The columns of B = D2 - kappa J D1 of one vesicle. */
static PetscErrorCode MembraneMemoryMatrix(Membrane m, PetscInt v, const PetscReal kappa[], PetscReal **B) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *unit = m->work.bending, *slope = m->work.memory;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(4 * n * n, B));
  for (PetscInt k = 0; k < 2 * n; k++) {
    PetscReal *column = *B + 2 * n * k;
    for (PetscInt i = 0; i < 2 * n; i++) unit[i] = i == k;
    (void)PetscArrayzero(slope, 2 * n);
    SpectralDerivative(m->spectral[v], 1, n / m->arc[v], unit, slope);
    SpectralDerivative(m->spectral[v], 2, PetscSqr(n / m->arc[v]), unit, column);
    for (PetscInt i = 0; i < n; i++) {
      column[2 * i] += kappa[i] * slope[2 * i + 1];
      column[2 * i + 1] -= kappa[i] * slope[2 * i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MembraneCreate(Layout layout, const PetscReal X[], const SceneMembrane *given, Membrane *out) {
  const Material *material = given->material;
  const PetscInt vesicles = layout->bodies;
  MembraneWork *w;
  Membrane m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  w = &m->work;
  m->layout = layout;
  m->bending = 0;
  for (PetscInt v = 0; v < vesicles; v++) m->bending = PetscMax(m->bending, material[v].bending);
  m->derivative = (DerivativeType)given->derivative;
  m->moment = (MomentType)given->moment;
  m->permeability = given->permeability;
  for (int k = 0; k < 2; k++) m->osmotic[k] = given->osmotic.n == 2 ? given->osmotic.v[k] : 0;
  PetscCall(PetscMalloc7(vesicles, &m->ds, vesicles, &m->A0, vesicles, &m->L0, vesicles, &m->spectral, vesicles,
                         &m->arc, vesicles, &m->part, vesicles, &m->material));
  PetscCall(PetscMalloc5(2 * layout->M, &w->stretching, 2 * layout->M, &w->bending, 2 * layout->M, &w->measures,
                         2 * layout->M, &w->restore, 2 * layout->M, &w->treading));
  PetscCall(PetscMalloc1(4 * layout->M, &w->memory));
  for (PetscInt v = 0; v < vesicles && !m->memory; v++)
    if (material[v].memory > 0) PetscCall(PetscMalloc1(layout->M, &m->memory));
  if (m->memory) PetscCall(PetscCalloc1(vesicles, &m->B));
  for (PetscInt v = 0; v < vesicles; v++) {
    const PetscInt n = LayoutCount(layout, v);
    const PetscReal *rest = (given->rest_X ? given->rest_X : X) + 2 * layout->start[v];
    Measures measures;
    PetscCall(SpectralCreate(n, &m->spectral[v]));
    MembraneMeasure(m, v, X + 2 * layout->start[v], &measures);
    m->A0[v] = measures.area;
    MembraneMeasure(m, v, rest, &measures);
    m->arc[v] = ArcLength(m, v, rest);
    m->L0[v] = measures.length;
    m->ds[v] = measures.length / n;
    m->material[v] = material[v];
    if (MembraneStretches(m, v)) m->stretches = PETSC_TRUE;
    if (material[v].viscosity > 0) m->viscous = PETSC_TRUE;
    if (m->memory) {
      MembraneCurvature(m, v, material[v].memory, rest, m->memory + layout->start[v]);
      PetscCall(MembraneMemoryMatrix(m, v, m->memory + layout->start[v], &m->B[v]));
    }
    m->part[v] = m->bending > 0 ? material[v].bending / m->bending : 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MembraneDestroy(Membrane *membrane) {
  Membrane m = *membrane;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < m->layout->bodies; v++) {
    PetscCall(SpectralDestroy(&m->spectral[v]));
    if (m->B) PetscCall(PetscFree(m->B[v]));
  }
  PetscCall(PetscFree(m->B));
  PetscCall(PetscFree7(m->ds, m->A0, m->L0, m->spectral, m->arc, m->part, m->material));
  PetscCall(PetscFree(m->work.memory));
  PetscCall(PetscFree(m->memory));
  PetscCall(PetscFree5(m->work.stretching, m->work.bending, m->work.measures, m->work.restore, m->work.treading));
  PetscCall(PetscFree(*membrane));
  PetscFunctionReturn(PETSC_SUCCESS);
}
