/* The tension problem: the assembled Chat is S^T S + S^T G diag(L)^-1 G^T S, and the operator is symmetric positive. */
#include "facts.h"
#include "baselines/lagrangian.h"
#include "baselines/tensionmatrix.h"

/* 1/diag(L), from the assembled L. */
static void InverseDiagonal(Grid g, Vec *d) {
  Mat L;
  TestCall(GridAssemble(g, FIELD_P, 0, -1, &L));
  TestCall(DMCreateGlobalVector(g->da[FIELD_P], d));
  TestCall(MatGetDiagonal(L, *d));
  TestCall(VecReciprocal(*d));
  TestCall(MatDestroy(&L));
}

/* One column of Chat at a time with the MatShells; the largest difference over the largest entry. */
static PetscReal ChatError(TestWorld *t) {
  const Layout l = t->layout;
  const Fluid f = t->fluid;
  Mat Chat;
  Vec d, w, q, e, column;
  PetscReal largest = 0, off = 0;
  PetscScalar *want = TestReals(l->M);
  TestCall(TensionAssemble(t->coupling, &Chat));
  InverseDiagonal(f->grid, &d);
  TestFieldVecs(f->grid->velocity, &w, NULL);
  TestVecs(d, &q, NULL);
  TestMarkerVecs(l, 1, &e, &column, NULL);
  for (PetscInt k = 0; k < l->M; k++) {
    TestUnit(k, e);
    TestCall(MatMult(t->coupling->S, e, w));
    TestCall(MatMultTranspose(f->G, w, q));
    TestCall(VecPointwiseMult(q, d, q));
    TestCall(GridGradient(f->grid, 1, q, PETSC_TRUE, w));
    TestCall(MatMultTranspose(t->coupling->S, w, column));
    TestCall(LayoutGatherVec(l, column, want));
    for (PetscInt r = 0; r < l->M; r++) {
      PetscScalar got;
      TestCall(MatGetValue(Chat, r, k, &got));
      largest = PetscMax(largest, PetscAbsReal(want[r]));
      off = PetscMax(off, PetscAbsReal(got - want[r]));
    }
  }
  TestCall(MatDestroy(&Chat));
  return off / largest;
}

/* C on random vectors: <x, C y> = <y, C x>, <x, C x> > 0 (C is a compression of a projection:
   S^T (I + G L^-1 G^T) S >= 0). */
static void CheckSymmetry(const char name[], TestWorld *t) {
  LagrangianSolver s;
  Vec x, y, Cx, Cy;
  TestCall(TensionSolverCreate(t->coupling, &s));
  TestMarkerVecs(t->layout, 1, &x, &y, &Cx, &Cy, NULL);
  for (unsigned k = 0; k < 5; k++) {
    TestRandomVec(20 + k, x);
    TestRandomVec(40 + k, y);
    TestCall(MatMult(s->A, x, Cx));
    TestCall(MatMult(s->A, y, Cy));
    const PetscReal self = TestDot(x, Cx), off = PetscAbsReal(TestDot(y, Cx) - TestDot(x, Cy));
    const PetscReal size = TestNorm(NORM_2, x) * TestNorm(NORM_2, Cy);
    CHECK(off < 1e-12 * size, "%s: the tension operator is symmetric, error %.1e", name, off / size);
    CHECK(self > 0, "%s: the tension operator is positive, %.3e", name, self);
  }
  TestCall(LagrangianSolverDestroy(&s));
}

void Facts(void) {
  /* in the middle, three cells from two walls, and across one seam or both */
  static const char *const scenes[] = {
      "-vesicle_center 0.03,-0.02", "-vesicle_center -0.7,0.4 -vesicle_semi_axes 0.2,0.5",
      "-domain_bc_x periodic -vesicle_center 0.97,0.01",
      "-domain_bc_x periodic -domain_bc_y periodic -vesicle_center 0.03,0.9",
      "-domain_bc_x periodic -domain_bc_y periodic -vesicle_center 0.96,-0.93 -vesicle_angle 30"};
  static const char *const kernels[] = {"ib6", "cbs54"};
  for (int k = 0; k < 5; k++)
    for (int d = 0; d < 2; d++) {
      ScopedWorld t;
      const char *name = TestText("%s -delta_type %s", scenes[k], kernels[d]);
      TestWorldCreate(&t, "-domain_cells 60,60 %s", name);
      const PetscReal error = ChatError(&t);
      CHECK(error < 1e-12, "%s: Chat column by column, error %.1e", name, error);
      CheckSymmetry(name, &t);
    }
}
