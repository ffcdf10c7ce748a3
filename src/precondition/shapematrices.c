#include "precondition/shapeset.h"
#include "problem/contrast.h"
#include "precondition/denseblock.h"
#include "layers/layerpairs.h"
#include "numerics/blas.h"

/* What ContrastMatrix has of a vesicle of this shape, motion[2n][2n]. */
static PetscErrorCode ShapeMotion(SharedShapes s, const SharedShape *q, PetscReal motion[]) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = 2 * LayoutCount(m->layout, q->like);
  const PetscReal weight = MobilityWeight(s->coupling->mobility, q->like), jump = 2 - 2 * weight; /* 1 - ratio */
  PetscReal *D, *normal, *along;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n * n, &D, n, &normal, n / 2, &along));
  if (jump != 0) {
    PetscCall(DoubleGeometry(m->spectral[q->like], n / 2, q->X, normal, along));
    PetscCall(LayerSelf(&stresslet, &s->coupling->mobility->near->set, m->spectral[q->like], n / 2, q->X, normal, D));
  }
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) motion[j * n + i] = (i == j ? weight : 0) - jump * D[i * n + j];
  PetscCall(PetscFree3(D, normal, along));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F = D^T sigma + K V of an answer (V, sigma), D^T sigma by its law, K[2n][2n], and behind F
   J = (1 - ratio) (V + (treading/a0) dV/dt). */
static PetscErrorCode AnswerSources(SharedShapes s, const SharedShape *q, MembraneLaw law, const PetscReal K[],
                                    const PetscReal V[], PetscReal F[]) {
  const PetscInt n = law->n;
  PetscFunctionBeginUser;
  (void)PetscArrayzero(F, 2 * n);
  LawForce(law, 1, V + 2 * n, F);
  PetscCall(DenseMultAdd(PETSC_FALSE, 2 * n, 2 * n, 1, K, V, F));
  if (q->rows == 2 * n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscReal *J = F + 2 * n;
  (void)PetscArraycpy(J, V, 2 * n);
  MembraneLabelDerivative(law->membrane, q->like, q->treading / s->a0, V, J);
  for (PetscInt k = 0; k < 2 * n; k++) J[k] *= 1 - s->coupling->mobility->contrast->ratio[q->like];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The coarse parts of a shape: the points of the curve through its markers, weights, self. */
static PetscErrorCode MakeShapePoints(SharedShapes s, SharedShape *q) {
  const PetscInt n = LayoutCount(s->coupling->membrane->layout, q->like),
                 points = LayoutCount(s->coarse->layout, q->like);
  const PetscReal h2 = PetscSqr(s->coarse->fluid->grid->h);
  PetscFunctionBeginUser;
  PetscCall(CurvePointsCreate(PETSC_FALSE, n, points, &q->curve));
  PetscCall(PetscCalloc1(4 * points * points, &q->self));
  PetscCall(PetscMalloc1(2 * points, &q->points));
  PetscCall(DenseProduct(PETSC_FALSE, 2, points, n, q->X, q->curve.to_points, q->points));
  for (PetscInt j = 0; j < points; j++)
    for (PetscInt i = 0; i < points; i++) {
      const PetscReal d[2] = {q->points[2 * i] - q->points[2 * j], q->points[2 * i + 1] - q->points[2 * j + 1]};
      MobilityTableAdd(s->coarse->table, 1 / h2, d, 2 * points, q->self + 4 * j * points + 2 * i);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The inverse and its sources: the columns are the answers V, sigma to those of the identity. */
static PetscErrorCode StoreShape(SharedShapes s, SharedShape *q, MembraneLaw law, const PetscReal V[],
                                 const PetscReal sigma[]) {
  const PetscInt n = law->n, all = 3 * n;
  PetscReal *K;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(4 * n * n, &K));
  PetscCall(ForcesDense(s->coupling->forces, q->like, 1 / s->a0, K));
  PetscCall(PetscMalloc1(all * all, &q->inverse));
  PetscCall(PetscMalloc1(q->rows * all, &q->sources));
  for (PetscInt j = 0; j < all; j++) {
    PetscReal *answer = q->inverse + j * all;
    PetscCall(PetscArraycpy(answer, V + j * 2 * n, 2 * n));
    PetscCall(PetscArraycpy(answer + 2 * n, sigma + j * n, n));
    PetscCall(AnswerSources(s, q, law, K, answer, q->sources + j * q->rows));
  }
  PetscCall(PetscFree(K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SharedShapeMake(SharedShapes s, SharedShape *q, PetscBool *good) {
  const Membrane m = s->coupling->membrane;
  const PetscInt n = LayoutCount(m->layout, q->like), all = 3 * n;
  PetscReal *M, *motion, *V, *sigma;
  DenseBlock block;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(4 * n * n, &M, 4 * n * n, &motion));
  PetscCall(PetscCalloc2(2 * n * all, &V, n * all, &sigma));
  PetscCall(DenseBlockCreate(m, s->coupling->forces, s->coupling->fluid->grid->h, q->like, q->like + 1, &block));
  PetscCall(LayerSelf(&stokeslet, &s->coupling->mobility->near->set, m->spectral[q->like], n, q->X, NULL, M));
  for (PetscInt k = 0; k < 4 * n * n; k++) M[k] *= PetscSqr(s->coupling->fluid->grid->h);
  PetscCall(ShapeMotion(s, q, motion));
  PetscCall(ContrastTread(m, q->like, q->like + 1, &q->treading, s->a0, 2 * n, motion));
  LawPlace(block.law, s->a0, q->X);
  PetscCall(DenseBlockFactor(&block, s->a0, M, motion, good));
  for (PetscInt j = 0; j < 2 * n; j++) V[j * 2 * n + j] = 1;
  for (PetscInt j = 0; j < n; j++) sigma[(2 * n + j) * n + j] = 1;
  if (*good) PetscCall(DenseBlockSolve(&block, all, V, sigma));
  PetscCall(StoreShape(s, q, block.law, V, sigma));
  if (s->coarse) PetscCall(MakeShapePoints(s, q));
  PetscCall(DenseBlockDestroy(&block));
  PetscCall(PetscFree2(M, motion));
  PetscCall(PetscFree2(V, sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A matrix of a shape times the columns of the vesicles that take it: s->to. */
static PetscErrorCode ShapeProduct(SharedShapes s, const SharedShape *q, const PetscReal A[], PetscInt rows,
                                   const PetscScalar U[], const PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like), inner = sigma ? 3 * n : 2 * n;
  PetscReal *x = s->from;
  PetscFunctionBeginUser;
  for (PetscInt k = q->begin; k < q->end; k++, x += inner) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    RigidFitInto(&s->fit[v - l->own], 2, n, U + 2 * at, x);
    if (sigma) RigidFitInto(&s->fit[v - l->own], 1, n, sigma + at, x + 2 * n);
  }
  PetscCall(DenseProduct(PETSC_FALSE, rows, q->end - q->begin, inner, A, s->from, s->to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SharedShapeSources(SharedShapes s, const SharedShape *q, const PetscScalar U[],
                                  const PetscScalar sigma[], const ShapeSources *sources) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like);
  const PetscReal *y = s->to;
  PetscFunctionBeginUser;
  PetscCall(ShapeProduct(s, q, q->sources, q->rows, U, sigma));
  for (PetscInt k = q->begin; k < q->end; k++, y += q->rows) {
    const PetscInt v = s->order[k], at = 2 * LayoutOffset(l, v);
    RigidFitBack(&s->fit[v - l->own], 2, n, y, sources->force + at);
    if (q->rows > 2 * n)
      RigidFitBack(&s->fit[v - l->own], 2, n, y + 2 * n, sources->jump + at);
    else if (sources->jump)
      PetscCall(PetscArrayzero(sources->jump + at, 2 * n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SharedShapeSolve(SharedShapes s, const SharedShape *q, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like);
  const PetscReal *y = s->to;
  PetscFunctionBeginUser;
  PetscCall(ShapeProduct(s, q, q->inverse, 3 * n, U, sigma));
  for (PetscInt k = q->begin; k < q->end; k++, y += 3 * n) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    RigidFitBack(&s->fit[v - l->own], 2, n, y, U + 2 * at);
    RigidFitBack(&s->fit[v - l->own], 1, n, y + 2 * n, sigma + at);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
