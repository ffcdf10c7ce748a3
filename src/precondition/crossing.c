#include "precondition/crossing.h"
#include "numerics/blas.h"

struct _p_Crossing {
  Mobility mobility; /* borrowed */
  CoarseGrid coarse;
  CoarseCorrection near;
  CurvePoints *curve;  /* [own bodies] */
  PetscScalar *points; /* [2 own coarse points] work */
  PetscScalar *W;      /* [2 own markers] work */
};

PetscErrorCode CrossingCreate(const FluidSpec *spec, Mobility mobility, Crossing *out) {
  const Bodies bodies = mobility->bodies;
  const Layout l = bodies->layout;
  CoarseGrid coarse;
  PetscReal *length;
  Crossing c;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->bodies, &length));
  for (PetscInt b = 0; b < l->bodies; b++) length[b] = bodies->ds[b] * LayoutCount(l, b);
  PetscCall(CoarseGridCreate(spec, l, length, mobility->markers->kernel->name, &coarse));
  PetscCall(PetscFree(length));
  if (!coarse) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&c));
  *out = c;
  c->mobility = mobility;
  c->coarse = coarse;
  PetscCall(CoarseCorrectionCreate(mobility, coarse, CORRECTION_CROSSING, &c->near));
  PetscCall(PetscMalloc3(l->end - l->own, &c->curve, 2 * coarse->layout->n, &c->points, 2 * l->n, &c->W));
  for (PetscInt b = l->own; b < l->end; b++)
    PetscCall(CurvePointsCreate(PETSC_FALSE, LayoutCount(l, b), LayoutCount(coarse->layout, b), &c->curve[b - l->own]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossingDestroy(Crossing *crossing) {
  Crossing c = *crossing;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  const Layout l = c->mobility->bodies->layout;
  for (PetscInt b = l->own; b < l->end; b++) PetscCall(CurvePointsDestroy(&c->curve[b - l->own]));
  PetscCall(PetscFree3(c->curve, c->points, c->W));
  PetscCall(CoarseCorrectionDestroy(&c->near));
  PetscCall(CoarseGridDestroy(&c->coarse));
  PetscCall(PetscFree(*crossing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossingPlace(Crossing c) {
  const Layout l = c->mobility->bodies->layout;
  PetscFunctionBeginUser;
  for (PetscInt b = l->own; b < l->end; b++) {
    const CurvePoints *p = &c->curve[b - l->own];
    PetscCall(DenseProduct(PETSC_FALSE, 2, p->points, p->n, c->mobility->markers->X + 2 * l->start[b], p->to_points,
                           c->points + 2 * LayoutOffset(c->coarse->layout, b)));
  }
  PetscCall(CoarseGridPlace(c->coarse, c->points));
  PetscCall(CoarseCorrectionPlace(c->near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossingApply(Crossing c, PetscBool to_vesicles, const PetscScalar F[], PetscScalar W[]) {
  const Bodies bodies = c->mobility->bodies;
  const Layout l = bodies->layout, coarse = c->coarse->layout;
  const PetscInt solid = BodiesFirstObstacle(bodies), begin = to_vesicles ? 0 : solid,
                 end = to_vesicles ? solid : 2 * l->n;
  PetscFunctionBeginUser;
  for (PetscInt b = l->own; b < l->end; b++) {
    const CurvePoints *p = &c->curve[b - l->own];
    PetscCall(DenseProduct(PETSC_FALSE, 2, p->points, p->n, F + 2 * LayoutOffset(l, b), p->to_markers,
                           c->points + 2 * LayoutOffset(coarse, b)));
  }
  PetscCall(CoarseGridApply(c->coarse, c->points));
  PetscCall(PetscArrayzero(c->W, 2 * l->n));
  for (PetscInt b = l->own; b < l->end; b++)
    CurvePointsSpread(&c->curve[b - l->own], c->points + 2 * LayoutOffset(coarse, b), c->W + 2 * LayoutOffset(l, b));
  PetscCall(CoarseCorrectionApply(c->near, F, NULL, c->W));
  for (PetscInt k = begin; k < end; k++) W[k - begin] += c->W[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
