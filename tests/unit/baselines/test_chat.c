/* The tension problem: the assembled Chat is S^T S + S^T G diag(L)^-1 G^T S, and the operator is symmetric positive. */
#include "facts.h"
#include "baselines/lagrangian.h"
#include "baselines/tensionmatrix.h"

TestScoped(LagrangianSolver, LagrangianSolverDestroy);

/* One column of Chat at a time with the MatShells; the largest difference over the largest entry. */
static PetscReal ChatError(TestWorld *t) {
  const Layout l = t->layout;
  const Fluid f = t->fluid;
  Scoped(Mat) Chat, L;
  Vec d, w, q, e, column;
  PetscReal largest = 0, off = 0;
  PetscScalar *want = TestReals(l->M), got;
  TestCall(TensionAssemble(t->coupling, &Chat));
  TestCall(GridAssemble(f->grid, FIELD_P, 0, -1, &L));
  TestFieldVecs(f->grid->da[FIELD_P], &d, &q, NULL);
  TestFieldVecs(f->grid->velocity, &w, NULL);
  TestMarkerVecs(l, 1, &e, &column, NULL);
  TestCall(MatGetDiagonal(L, d));
  for (PetscInt k = 0; k < l->M; k++) {
    TestUnit(k, e);
    TestCall(MatMult(t->coupling->S, e, w));
    TestCall(MatMultTranspose(f->G, w, q));
    TestCall(VecPointwiseDivide(q, q, d));
    TestCall(GridGradient(f->grid, 1, q, PETSC_TRUE, w));
    TestCall(MatMultTranspose(t->coupling->S, w, column));
    TestCall(LayoutGatherVec(l, column, want));
    for (PetscInt r = 0; r < l->M; r++) {
      TestCall(MatGetValue(Chat, r, k, &got));
      TestWorse(&largest, want[r]);
      TestWorse(&off, got - want[r]);
    }
  }
  return off / largest;
}

/* C on random vectors: <x, C y> = <y, C x>, <x, C x> > 0 (C is a compression of a projection:
   S^T (I + G L^-1 G^T) S >= 0). */
static void CheckSymmetry(TestWorld *t) {
  Scoped(LagrangianSolver) s;
  Vec x, y, Cx, Cy;
  TestCall(TensionSolverCreate(t->coupling, &s));
  TestMarkerVecs(t->layout, 1, &x, &y, &Cx, &Cy, NULL);
  for (unsigned k = 0; k < 5; k++) {
    TestRandomVec(20 + k, x);
    TestRandomVec(40 + k, y);
    TestCall(MatMult(s->A, x, Cx));
    TestCall(MatMult(s->A, y, Cy));
    CheckBelow((TestDot(y, Cx) - TestDot(x, Cy)) / (TestNorm(NORM_2, x) * TestNorm(NORM_2, Cy)), 1e-12,
               "the tension operator is symmetric");
    CHECK(TestDot(x, Cx) > 0, "the tension operator is positive, %.3e", TestDot(x, Cx));
  }
}

void Facts(void) {
  /* in the middle, three cells from two walls, and across one seam or both */
  static const char *const scenes[] = {"-vesicle_center 0.03,-0.02",
                                       "-vesicle_center -0.7,0.4 -vesicle_semi_axes 0.2,0.5",
                                       CHANNEL "-vesicle_center 0.97,0.01", PERIODIC "-vesicle_center 0.03,0.9",
                                       PERIODIC "-vesicle_center 0.96,-0.93 -vesicle_angle 30"};
  for (int k = 0; k < 10; k++) {
    ScopedWorld t;
    const char *name = TestText("%s -delta_type %s", scenes[k / 2], k % 2 ? "cbs54" : "ib6");
    TestWorldCreate(&t, "-domain_cells 60,60 %s", name);
    TestAbout("%s", name);
    CheckBelow(ChatError(&t), 1e-12, "Chat column by column");
    CheckSymmetry(&t);
  }
}
