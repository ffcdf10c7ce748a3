#include "coupling/selfmobility.h"
#include "coupling/blas.h"

/* a0 h^2/nu that stands for steady flow: small, and resolved by the quadrature of the symbols. */
#define STEADY 1e-4

typedef struct {
  PetscInt n;
  PetscReal *T, *N; /* [n] circulants of dT and dN by index difference */
  PetscReal *Theta; /* [2n][2n] */
  PetscReal *R;     /* LU factors of I + (c_b/a0) D4 Theta, the transpose of R^-1 */
  PetscReal *work, *product;
  PetscBLASInt *pivot;
} Block;

struct _p_SelfMobility {
  Coupling coupling;
  SelfMobilityType type;
  PetscReal nu;
  PetscReal c1;
  Block *block;
};

/* Circulants of one vesicle: inverse transforms of the symbols, which are even. The symbols are those of steady flow
   (a0 far below nu/h^2) whatever the step: what a slowly varying force loses over all steps, not in one. With the
   step's own a0 the correction fades as dt falls (docs/accuracy.md). */
static PetscErrorCode Circulants(SelfMobility s, PetscInt v) {
  Block *b = &s->block[v];
  const Membrane m = s->coupling->membrane;
  const PetscReal h = s->coupling->grid->h, a0 = STEADY * s->nu / PetscSqr(h);
  PetscReal *dT, *dN;
  PetscFunctionBeginUser;
  if (s->type == SELF_LOCAL) {
    b->T[0] = h * s->c1 / s->nu;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc2(b->n, &dT, b->n, &dN));
  PetscCall(PlaneSymbols(s->coupling->kernel, h, a0, s->nu, b->n, m->ds[v] * b->n, dT, dN));
  for (PetscInt k = 0; k < b->n; k++) {
    b->T[k] = b->N[k] = 0;
    for (PetscInt q = 0; q < b->n; q++) {
      const PetscReal wave = PetscCosReal(2 * PETSC_PI * ((k * q) % b->n) / b->n) / b->n;
      b->T[k] += dT[q] * wave;
      b->N[k] += dN[q] * wave;
    }
  }
  PetscCall(PetscFree2(dT, dN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityCreate(Coupling coupling, PetscReal nu, SelfMobilityType type, SelfMobility *out) {
  const Membrane m = coupling->membrane;
  SelfMobility s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->coupling = coupling;
  s->type = type;
  s->nu = nu;
  PetscCall(SmoothingConstant(coupling->kernel, &s->c1));
  PetscCall(PetscCalloc1(m->vesicles, &s->block));
  for (PetscInt v = 0; v < m->vesicles; v++) {
    Block *b = &s->block[v];
    const PetscInt n = b->n = m->start[v + 1] - m->start[v];
    PetscCall(PetscCalloc7(n, &b->T, n, &b->N, 4 * n * n, &b->Theta, 4 * n * n, &b->R, 2 * n, &b->work, 2 * n,
                           &b->product, 2 * n, &b->pivot));
    PetscCall(Circulants(s, v));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityDestroy(SelfMobility *self) {
  SelfMobility s = *self;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < s->coupling->membrane->vesicles; v++) {
    Block *b = &s->block[v];
    PetscCall(PetscFree7(b->T, b->N, b->Theta, b->R, b->work, b->product, b->pivot));
  }
  PetscCall(PetscFree(s->block));
  PetscCall(PetscFree(*self));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PetscReal *SelfMobilityBlock(SelfMobility s, PetscInt v) {
  return s->block[v].Theta;
}

/* Unit tangents: of the spectral edges, or by fourth-order differences (with chords the area would drift ten times
 * faster). */
static void Tangents(SelfMobility s, PetscInt v, const PetscScalar X[], PetscReal t[]) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = s->block[v].n;
  const PetscScalar *x = X + 2 * m->start[v];
  if (m->derivative == DERIVATIVE_SPECTRAL) MembraneEdges(m, v, x, t);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal *tk = t + 2 * k, length;
    if (m->derivative != DERIVATIVE_SPECTRAL)
      for (int c = 0; c < 2; c++)
        tk[c] = 8 * (x[2 * ((k + 1) % n) + c] - x[2 * ((k + n - 1) % n) + c]) -
                (x[2 * ((k + 2) % n) + c] - x[2 * ((k + n - 2) % n) + c]);
    length = PetscSqrtReal(tk[0] * tk[0] + tk[1] * tk[1]);
    tk[0] /= length;
    tk[1] /= length;
  }
}

static void FillTheta(SelfMobility s, PetscInt v, const PetscReal t[]) {
  Block *b = &s->block[v];
  const PetscInt n = b->n;
  const PetscReal ds = s->coupling->membrane->ds[v];
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < n; l++) {
      const PetscInt d = k >= l ? k - l : k - l + n;
      const PetscReal T = b->T[d] / ds, N = b->N[d] / ds, *tk = t + 2 * k, *tl = t + 2 * l;
      PetscReal *block = b->Theta + 2 * k * 2 * n + 2 * l;
      if (s->type == SELF_LOCAL && k != l) continue;
      block[0] = T * tk[0] * tl[0] + N * tk[1] * tl[1];
      block[1] = T * tk[0] * tl[1] - N * tk[1] * tl[0];
      block[2 * n] = T * tk[1] * tl[0] - N * tk[0] * tl[1];
      block[2 * n + 1] = T * tk[1] * tl[1] + N * tk[0] * tl[0];
    }
}

PetscErrorCode SelfMobilitySetMarkers(SelfMobility s, PetscReal a0, const PetscScalar X[]) {
  const Membrane m = s->coupling->membrane;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->vesicles; v++) {
    Block *b = &s->block[v];
    const PetscInt n = b->n;
    Tangents(s, v, X, b->product);
    FillTheta(s, v, b->product);
    if (m->bending == 0) continue;
    /* column by column: I + (c_b/a0) (ds D4) Theta */
    PetscCall(PetscArrayzero(b->R, 4 * n * n));
    for (PetscInt c = 0; c < 2 * n; c++) {
      MembraneBendingVesicle(m, v, m->bending / a0, b->Theta + c * 2 * n, b->work, b->R + c * 2 * n);
      b->R[c * 2 * n + c] += 1;
    }
    PetscCall(DenseFactor(2 * n, b->R, b->pivot));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U := R (U - Theta F) of one vesicle. */
static PetscErrorCode Subtract(SelfMobility s, PetscInt v, PetscScalar U[], const PetscScalar F[]) {
  Block *b = &s->block[v];
  PetscFunctionBeginUser;
  PetscCall(DenseMultAdd(2 * b->n, 2 * b->n, -1, b->Theta, F, U));
  if (s->coupling->membrane->bending > 0) PetscCall(DenseSolve(2 * b->n, b->R, b->pivot, PETSC_TRUE, 1, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityApply(SelfMobility s, const PetscScalar sigma[], const PetscScalar Xhat[], PetscScalar U[]) {
  const Membrane m = s->coupling->membrane;
  PetscScalar *F = s->coupling->work;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(F, 2 * m->M));
  if (sigma) MembraneStretchingTranspose(m, s->coupling->tau, 1, sigma, F);
  if (Xhat) MembraneBending(m, m->bending, Xhat, s->coupling->force, F);
  for (PetscInt v = 0; v < m->vesicles; v++) PetscCall(Subtract(s, v, U + 2 * m->start[v], F + 2 * m->start[v]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SelfMobilityMultTheta(SelfMobility s, PetscScalar F[]) {
  const Membrane m = s->coupling->membrane;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->vesicles; v++) {
    Block *b = &s->block[v];
    PetscScalar *own = F + 2 * m->start[v];
    PetscCall(PetscArraycpy(b->work, own, 2 * b->n));
    PetscCall(PetscArrayzero(own, 2 * b->n));
    PetscCall(DenseMultAdd(2 * b->n, 2 * b->n, 1, b->Theta, b->work, own));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
