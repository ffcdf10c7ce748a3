/* The tension problem: the assembled Chat is S^T S + S^T G diag(L)^-1 G^T S, and the operator is symmetric positive. */
#include "facts.h"
#include "baselines/lagrangian.h"
#include "baselines/tensionmatrix.h"

/* 1/diag(L), from the assembled L. */
static PetscErrorCode InverseDiagonal(Grid g, Vec *d) {
  Mat L;
  PetscFunctionBeginUser;
  PetscCall(GridAssemble(g, FIELD_P, 0, -1, &L));
  PetscCall(DMCreateGlobalVector(g->da[FIELD_P], d));
  PetscCall(MatGetDiagonal(L, *d));
  PetscCall(VecReciprocal(*d));
  PetscCall(MatDestroy(&L));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One column of Chat at a time with the MatShells; the largest difference over the largest entry. */
static PetscErrorCode ChatError(TestWorld *t, PetscReal *error) {
  const Layout l = t->layout;
  const Fluid f = t->fluid;
  Mat Chat;
  Vec d, w, q, e, column;
  PetscReal largest = 0, off = 0;
  PetscScalar *want;
  PetscFunctionBeginUser;
  PetscCall(TensionAssemble(t->coupling, &Chat));
  PetscCall(InverseDiagonal(f->grid, &d));
  PetscCall(TestFieldVecs(f->grid->velocity, &w, NULL));
  PetscCall(TestVecs(d, &q, NULL));
  PetscCall(TestMarkerVecs(l, 1, &e, &column, NULL));
  PetscCall(PetscMalloc1(l->M, &want));
  for (PetscInt k = 0; k < l->M; k++) {
    PetscCall(TestUnit(k, e));
    PetscCall(MatMult(t->coupling->S, e, w));
    PetscCall(MatMultTranspose(f->G, w, q));
    PetscCall(VecPointwiseMult(q, d, q));
    PetscCall(GridGradient(f->grid, 1, q, PETSC_TRUE, w));
    PetscCall(MatMultTranspose(t->coupling->S, w, column));
    PetscCall(LayoutGatherVec(l, column, want));
    for (PetscInt r = 0; r < l->M; r++) {
      PetscScalar got;
      PetscCall(MatGetValue(Chat, r, k, &got));
      largest = PetscMax(largest, PetscAbsReal(want[r]));
      off = PetscMax(off, PetscAbsReal(got - want[r]));
    }
  }
  *error = off / largest;
  PetscCall(PetscFree(want));
  PetscCall(MatDestroy(&Chat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C on random vectors: <x, C y> = <y, C x>, <x, C x> > 0 (C is a compression of a projection:
   S^T (I + G L^-1 G^T) S >= 0). */
static PetscErrorCode CheckSymmetry(const char name[], TestWorld *t) {
  LagrangianSolver s;
  Vec x, y, Cx, Cy;
  PetscReal one, two, nx, ny, self;
  PetscFunctionBeginUser;
  PetscCall(TensionSolverCreate(t->coupling, &s));
  PetscCall(TestMarkerVecs(t->layout, 1, &x, &y, &Cx, &Cy, NULL));
  for (unsigned k = 0; k < 5; k++) {
    PetscCall(TestRandomVec(20 + k, x));
    PetscCall(TestRandomVec(40 + k, y));
    PetscCall(MatMult(s->A, x, Cx));
    PetscCall(MatMult(s->A, y, Cy));
    PetscCall(VecDot(y, Cx, &one));
    PetscCall(VecDot(x, Cy, &two));
    PetscCall(VecDot(x, Cx, &self));
    PetscCall(VecNorm(x, NORM_2, &nx));
    PetscCall(VecNorm(Cy, NORM_2, &ny));
    CHECK(PetscAbsReal(one - two) < 1e-12 * nx * ny, "%s: the tension operator is symmetric, error %.1e", name,
          PetscAbsReal(one - two) / (nx * ny));
    CHECK(self > 0, "%s: the tension operator is positive, %.3e", name, self);
  }
  PetscCall(LagrangianSolverDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  /* in the middle, three cells from two walls, and across one seam or both */
  static const char *const scenes[] = {
      "-vesicle_center 0.03,-0.02", "-vesicle_center -0.7,0.4 -vesicle_semi_axes 0.2,0.5",
      "-domain_bc_x periodic -vesicle_center 0.97,0.01",
      "-domain_bc_x periodic -domain_bc_y periodic -vesicle_center 0.03,0.9",
      "-domain_bc_x periodic -domain_bc_y periodic -vesicle_center 0.96,-0.93 -vesicle_angle 30"};
  static const char *const kernels[] = {"ib6", "cbs54"};
  PetscFunctionBeginUser;
  for (int k = 0; k < 5; k++)
    for (int d = 0; d < 2; d++) {
      char options[512], name[256];
      TestWorld t;
      PetscReal error = 0;
      PetscCall(PetscSNPrintf(name, sizeof(name), "%s -delta_type %s", scenes[k], kernels[d]));
      PetscCall(PetscSNPrintf(options, sizeof(options), "-domain_cells 60,60 %s", name));
      PetscCall(TestWorldCreate(options, &t));
      PetscCall(ChatError(&t, &error));
      CHECK(error < 1e-12, "%s: Chat column by column, error %.1e", name, error);
      PetscCall(CheckSymmetry(name, &t));
      PetscCall(TestWorldDestroy(&t));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
