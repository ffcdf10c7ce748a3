#include "coupling/patternmake.h"
#include "coupling/blas.h"
#include "coupling/contrast.h"
#include "coupling/denseblock.h"
#include "coupling/doubleblock.h"
#include "coupling/selflayer.h"

/* M += scale times the coarse grid's mean mobility between n points. */
static void AddMean(MobilityTable table, PetscReal scale, PetscInt n, const PetscReal X[], PetscReal M[]) {
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]};
      PetscReal mean[3], *at = M + 2 * j * 2 * n + 2 * i;
      MobilityTableMean(table, d, mean);
      at[0] += scale * mean[0];
      at[1] += scale * mean[2];
      at[2 * n] += scale * mean[2];
      at[2 * n + 1] += scale * mean[1];
    }
}

/* M = h^2 S. */
static PetscErrorCode Assemble(Patterns s, const Pattern *q, PetscReal M[]) {
  const Coupling c = s->coupling;
  const PetscInt n = LayoutCount(c->membrane->layout, q->like);
  const PetscReal h2 = PetscSqr(c->fluid->grid->h);
  PetscFunctionBeginUser;
  PetscCall(SelfLayer(c->membrane->spectral[q->like], n, c->fluid->nu, q->X, M));
  for (PetscInt k = 0; k < 4 * n * n; k++) M[k] *= h2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With viscosity contrast what ContrastMatrix has of a vesicle of this shape, else NULL. */
static PetscErrorCode Motion(Patterns s, const Pattern *q, PetscReal **motion) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = 2 * LayoutCount(m->layout, q->like);
  PetscReal *D;
  PetscFunctionBeginUser;
  *motion = NULL;
  if (!s->coupling->contrast) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal ratio = s->coupling->contrast->ratio[q->like];
  PetscCall(PetscMalloc1(n * n, motion));
  PetscCall(PetscMalloc1(n * n, &D));
  PetscCall(DoubleSelf(m->spectral[q->like], n / 2, q->X, D));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++)
      (*motion)[j * n + i] = (i == j ? 0.5 * (1 + ratio) : 0) - (1 - ratio) * D[i * n + j];
  PetscCall(ContrastTread(m, q->like, q->like + 1, &q->treading, s->a0, n, *motion));
  PetscCall(PetscFree(D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The columns of the inverse are the answers to those of the identity. */
static PetscErrorCode Invert(Patterns s, const Pattern *q, PetscReal inverse[], PetscBool *good) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = LayoutCount(m->layout, q->like), all = 3 * n;
  const PetscReal h2 = PetscSqr(s->coupling->fluid->grid->h);
  PetscReal *M, *motion, *U, *sigma;
  DenseBlock block;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * n * n, &M));
  PetscCall(PetscCalloc2(2 * n * all, &U, n * all, &sigma));
  PetscCall(DenseBlockCreate(m->layout, q->like, q->like + 1, &block));
  PetscCall(Assemble(s, q, M));
  PetscCall(Motion(s, q, &motion));
  MembraneVesicleTangents(m, q->like, q->X, block.tau);
  PetscCall(DenseBlockFactor(m, h2, &block, s->a0, &q->treading, M, motion, good));
  PetscCall(PetscFree(motion));
  for (PetscInt j = 0; j < 2 * n; j++) U[j * 2 * n + j] = 1;
  for (PetscInt j = 0; j < n; j++) sigma[(2 * n + j) * n + j] = 1;
  if (*good) PetscCall(DenseBlockSolve(m, h2, &block, all, U, sigma));
  for (PetscInt j = 0; j < all; j++) {
    PetscCall(PetscArraycpy(inverse + j * 5 * n, U + j * 2 * n, 2 * n));
    PetscCall(PetscArraycpy(inverse + j * 5 * n + 2 * n, sigma + j * n, n));
  }
  PetscCall(DenseBlockDestroy(&block));
  PetscCall(PetscFree(M));
  PetscCall(PetscFree2(U, sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* [points][n]: trigonometric interpolation from the coarse points to the markers. */
static void Interpolation(PetscInt points, PetscInt n, PetscReal weight[]) {
  for (PetscInt i = 0; i < points; i++)
    for (PetscInt k = 0; k < n; k++)
      weight[i * n + k] = TrigonometricCardinal(
          points, 2 * PETSC_PI * ((PetscReal)k / (PetscReal)n - (PetscReal)i / (PetscReal)points));
}

/* F = Dm^T sigma + (c_b ds/a0) D4 V below each column (V, sigma) of the inverse. */
static void Forces(Patterns s, const Pattern *q, const PetscReal tau[]) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = LayoutCount(m->layout, q->like);
  PetscReal *pull = s->X;
  for (PetscInt j = 0; j < 3 * n; j++) {
    PetscReal *V = q->inverse + j * 5 * n, *sigma = V + 2 * n, *F = V + 3 * n;
    for (PetscInt k = 0; k < 2 * n; k++) pull[k] = sigma[k / 2] * tau[k];
    (void)PetscArrayzero(F, 2 * n);
    MembraneEdgesTranspose(m, q->like, 1, pull, F);
    if (m->bending > 0) MembraneVesicleBending(m, q->like, m->bending / s->a0, V, F);
  }
}

/* The curve through n markers X at the labels of the coarse points. */
static void Points(PetscInt n, const PetscReal X[], PetscInt points, PetscReal Y[]) {
  (void)PetscArrayzero(Y, 2 * points);
  for (PetscInt i = 0; i < points; i++)
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal t = 2 * PETSC_PI * ((PetscReal)i / (PetscReal)points - (PetscReal)k / (PetscReal)n);
      const PetscReal weight = TrigonometricCardinal(n, t);
      for (int c = 0; c < 2; c++) Y[2 * i + c] += weight * X[2 * k + c];
    }
}

/* The coarse parts of a pattern: weight, self, points. */
static PetscErrorCode MakeCoarse(Patterns s, Pattern *q) {
  const PetscInt n = LayoutCount(s->coupling->membrane->layout, q->like),
                 points = LayoutCount(s->coarse->layout, q->like);
  const PetscReal h2 = PetscSqr(s->coarse->fluid->grid->h);
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * points, &q->weight));
  PetscCall(PetscCalloc1(4 * points * points, &q->self));
  PetscCall(PetscMalloc1(2 * points, &q->points));
  Interpolation(points, n, q->weight);
  Points(n, q->X, points, q->points);
  AddMean(s->coarse->table, 1 / h2, points, q->points, q->self);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PatternMake(Patterns s, Pattern *q, PetscBool *good) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = LayoutCount(m->layout, q->like);
  PetscReal *tau;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(15 * n * n, &q->inverse));
  PetscCall(PetscMalloc1(2 * n, &tau));
  PetscCall(Invert(s, q, q->inverse, good));
  MembraneVesicleTangents(m, q->like, q->X, tau);
  Forces(s, q, tau);
  if (s->coarse) PetscCall(MakeCoarse(s, q));
  PetscCall(PetscFree(tau));
  PetscFunctionReturn(PETSC_SUCCESS);
}
