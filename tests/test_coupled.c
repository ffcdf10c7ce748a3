/* The coupled problem's parts: the block operator against its structure and against the assembled pieces, Mob against
   E A^-1 E^T column by column, the preconditioner as the inverse in a periodic box. */
#include "check.h"
#include "coupling/saddle.h"

typedef struct {
  TestWorld t;
  Saddle s;
  Vec x[2], y[2]; /* block vectors */
  Vec sigma[2];   /* their tensions, as SaddleSplit gives them */
} Problem;

static PetscErrorCode ProblemCreate(const char options[], PetscReal a0, Problem *p) {
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, &p->t));
  PetscCall(FluidSetTimeCoefficient(p->t.fluid, a0));
  PetscCall(SaddleCreate(p->t.scene, p->t.fluid, p->t.coupling, NULL, &p->s));
  PetscCall(SaddleSetUp(p->s));
  for (int k = 0; k < 2; k++) {
    PetscCall(VecDuplicate(p->s->x, &p->x[k]));
    PetscCall(VecDuplicate(p->s->x, &p->y[k]));
    PetscCall(MembraneCreateTensionVec(p->t.membrane, &p->sigma[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ProblemDestroy(Problem *p) {
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(VecDestroy(&p->x[k]));
    PetscCall(VecDestroy(&p->y[k]));
    PetscCall(VecDestroy(&p->sigma[k]));
  }
  PetscCall(SaddleDestroy(&p->s));
  PetscCall(TestWorldDestroy(&p->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x = (w, p, sigma) with random parts, those not asked for zero. */
static PetscErrorCode Fill(Problem *q, unsigned seed, PetscBool velocity, PetscBool pressure, PetscBool tension,
                           Vec x) {
  PetscScalar *a;
  Vec sigma;
  PetscFunctionBeginUser;
  PetscCall(VecSet(x, 0));
  PetscCall(VecDuplicate(q->sigma[0], &sigma));
  PetscCall(VecGetArray(x, &a));
  PetscCall(SaddleSplit(q->s, 0, a, NULL));
  if (velocity) PetscCall(TestRandomVec(seed, q->s->w[0]));
  if (pressure) PetscCall(TestRandomVec(seed + 1, q->s->p[0]));
  if (tension) PetscCall(TestRandomVec(seed + 2, sigma));
  PetscCall(SaddleJoin(q->s, 0, a, sigma));
  PetscCall(VecRestoreArray(x, &a));
  PetscCall(VecDestroy(&sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* <x, y> with the third rows of y unscaled: ds/h^2 of each. */
static PetscErrorCode Product(Problem *q, Vec x, Vec y, PetscReal *product) {
  const PetscScalar *a, *b;
  PetscReal third = 0, scaled = 0;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(VecDot(x, y, product));
  if (!q->t.fluid->grid->rank) {
    const PetscInt M = q->t.membrane->M;
    PetscCall(VecGetLocalSize(x, &n));
    PetscCall(VecGetArrayRead(x, &a));
    PetscCall(VecGetArrayRead(y, &b));
    for (PetscInt k = 0; k < M; k++) {
      third += a[n - M + k] * b[n - M + k];
      scaled += a[n - M + k] * b[n - M + k] / SaddleScale(q->s, k);
    }
    PetscCall(VecRestoreArrayRead(y, &b));
    PetscCall(VecRestoreArrayRead(x, &a));
  }
  scaled -= third;
  PetscCallMPI(MPI_Bcast(&scaled, 1, MPIU_REAL, 0, PETSC_COMM_WORLD));
  *product += scaled;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |<A x1, x2> - <x1, A x2>| over its size, third rows unscaled. */
static PetscErrorCode Asymmetry(Problem *q, PetscReal *error) {
  PetscReal one, two;
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(MatMult(q->s->A, q->x[k], q->y[k]));
  PetscCall(Product(q, q->x[1], q->y[0], &one));
  PetscCall(Product(q, q->x[0], q->y[1], &two));
  *error = PetscAbsReal(one - two) / PetscAbsReal(one);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckStructure(const char name[], Problem *q) {
  const PetscBool yes = PETSC_TRUE, no = PETSC_FALSE;
  PetscReal error;
  PetscFunctionBeginUser;
  /* a velocity against a pressure and a tension: upper right against lower left */
  PetscCall(Fill(q, 1, yes, no, no, q->x[0]));
  PetscCall(Fill(q, 4, no, yes, no, q->x[1]));
  PetscCall(Asymmetry(q, &error));
  CHECK(error < 1e-12, "%s: G and G^T are transposed, %.1e", name, error);
  PetscCall(Fill(q, 4, no, no, yes, q->x[1]));
  PetscCall(Asymmetry(q, &error));
  CHECK(error < 1e-12, "%s: S and S^T are transposed, the third row unscaled, %.1e", name, error);
  /* a velocity against a velocity: H + B E/a0 */
  PetscCall(Fill(q, 7, yes, no, no, q->x[1]));
  PetscCall(Asymmetry(q, &error));
  CHECK(error < 1e-12, "%s: H + B E/a0 is symmetric, %.1e", name, error);
  PetscCall(Fill(q, 1, yes, yes, yes, q->x[0]));
  PetscCall(Fill(q, 4, yes, yes, yes, q->x[1]));
  PetscCall(Asymmetry(q, &error));
  CHECK(error < 1e-12, "%s: the whole operator is symmetric, %.1e", name, error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = A x against H w + (1/a0) B E w + G p + S sigma, G^T w, (h^2/ds) S^T w from the operators that split uses; B E is
   symmetric and not negative by itself. */
static PetscErrorCode CheckOperator(const char name[], Problem *q) {
  const Fluid f = q->t.fluid;
  const Coupling c = q->t.coupling;
  const PetscScalar *xa, *ya, *stretching, *got;
  PetscReal size[3], error[3] = {0, 0, 0}, work[2], most = 0;
  Vec w, other, p, U, V;
  PetscFunctionBeginUser;
  PetscCall(Fill(q, 11, PETSC_TRUE, PETSC_TRUE, PETSC_TRUE, q->x[0]));
  PetscCall(MatMult(q->s->A, q->x[0], q->y[0]));
  PetscCall(VecGetArrayRead(q->x[0], &xa));
  PetscCall(VecGetArrayRead(q->y[0], &ya));
  PetscCall(SaddleSplit(q->s, 0, (PetscScalar *)xa, q->sigma[0]));
  PetscCall(SaddleSplit(q->s, 1, (PetscScalar *)ya, q->sigma[1]));
  PetscCall(VecDuplicate(q->s->r, &w));
  PetscCall(VecDuplicate(q->s->r, &other));
  PetscCall(VecDuplicate(q->s->p1, &p));
  PetscCall(VecDuplicate(q->t.X, &U));
  PetscCall(VecDuplicate(q->t.X, &V));
  PetscCall(MatMult(f->H, q->s->w[0], w));
  PetscCall(CouplingInterpolate(c, c->E, q->s->w[0], U));
  PetscCall(CouplingSpreadAdd(c, 1 / f->a0, c->B, U, w));
  PetscCall(GridGradient(f->grid, 1, q->s->p[0], PETSC_TRUE, w));
  PetscCall(CouplingSpreadAdd(c, 1, c->S, q->sigma[0], w));
  PetscCall(VecNorm(w, NORM_2, &size[0]));
  PetscCall(VecAXPY(w, -1, q->s->w[1]));
  PetscCall(VecNorm(w, NORM_2, &error[0]));
  PetscCall(GridGradientTranspose(f->grid, 1, q->s->w[0], p));
  PetscCall(VecNorm(p, NORM_2, &size[1]));
  PetscCall(VecAXPY(p, -1, q->s->p[1]));
  PetscCall(VecNorm(p, NORM_2, &error[1]));
  PetscCall(CouplingInterpolate(c, c->S, q->s->w[0], q->sigma[0]));
  PetscCall(VecGetArrayRead(q->sigma[0], &stretching));
  PetscCall(VecGetArrayRead(q->sigma[1], &got));
  for (PetscInt k = 0; k < q->t.membrane->M; k++) {
    const PetscReal want = stretching[k] * SaddleScale(q->s, k);
    error[2] = PetscMax(error[2], PetscAbsReal(got[k] - want));
    most = PetscMax(most, PetscAbsReal(want));
  }
  PetscCall(VecRestoreArrayRead(q->sigma[1], &got));
  PetscCall(VecRestoreArrayRead(q->sigma[0], &stretching));
  CHECK(error[0] < 1e-12 * size[0], "%s: first row, %.1e", name, error[0] / size[0]);
  CHECK(error[1] < 1e-12 * size[1], "%s: second row, %.1e", name, error[1] / size[1]);
  CHECK(error[2] < 1e-12 * most, "%s: third row is h^2/ds S^T u, %.1e", name, error[2] / most);
  /* B E: <B E w, v> = <w, B E v>, and <B E w, w> >= 0 */
  PetscCall(TestRandomVec(21, other));
  PetscCall(VecSet(w, 0));
  PetscCall(CouplingSpreadAdd(c, 1, c->B, U, w));
  PetscCall(VecDot(w, q->s->w[0], &most));
  PetscCall(VecDot(w, other, &work[0]));
  PetscCall(CouplingInterpolate(c, c->E, other, V));
  PetscCall(VecSet(w, 0));
  PetscCall(CouplingSpreadAdd(c, 1, c->B, V, w));
  PetscCall(VecDot(w, q->s->w[0], &work[1]));
  CHECK(PetscAbsReal(work[0] - work[1]) < 1e-12 * PetscAbsReal(work[0]), "%s: B E is symmetric, %.1e", name,
        PetscAbsReal(work[0] - work[1]) / PetscAbsReal(work[0]));
  CHECK(most > 0, "%s: B E only takes energy, %.3e", name, most);
  PetscCall(SaddleJoin(q->s, 0, (PetscScalar *)xa, NULL));
  PetscCall(SaddleJoin(q->s, 1, (PetscScalar *)ya, NULL));
  PetscCall(VecRestoreArrayRead(q->y[0], &ya));
  PetscCall(VecRestoreArrayRead(q->x[0], &xa));
  PetscCall(VecDestroy(&w));
  PetscCall(VecDestroy(&other));
  PetscCall(VecDestroy(&p));
  PetscCall(VecDestroy(&U));
  PetscCall(VecDestroy(&V));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mob of one vesicle against E A^-1 E^T, one Stokes solve a column: largest difference over the largest entry. */
static PetscErrorCode CheckMobility(const char name[], Problem *q, PetscInt v) {
  const Coupling c = q->t.coupling;
  const PetscInt first = c->membrane->start[v], n = 2 * (c->membrane->start[v + 1] - first);
  const GreenTable *table;
  const PetscScalar *U;
  PetscReal *Mob, most = 0, error = 0, asymmetry = 0;
  Stokes stokes;
  Vec F, r;
  PetscFunctionBeginUser;
  PetscCall(MobilityGetTable(q->s->mobility, q->t.fluid->alpha, &table));
  CHECK(table->alpha == q->t.fluid->alpha, "%s: the table is for alpha = %g", name, (double)q->t.fluid->alpha);
  PetscCall(PetscMalloc1(n * n, &Mob));
  PetscCall(MobilityAssemble(q->s->mobility, table, first, n / 2, Mob));
  PetscCall(StokesCreate(q->t.fluid, &stokes));
  PetscCall(VecDuplicate(q->t.X, &F));
  PetscCall(VecDuplicate(q->s->r, &r));
  for (PetscInt column = 0; column < n; column++) {
    PetscCall(VecSet(F, 0));
    PetscCall(VecSetValue(F, 2 * first + column, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(F));
    PetscCall(VecAssemblyEnd(F));
    PetscCall(VecSet(r, 0));
    PetscCall(CouplingSpreadAdd(c, 1, c->E, F, r));
    PetscCall(StokesSolve(stokes, r, NULL, r, q->s->p1));
    PetscCall(CouplingInterpolate(c, c->E, r, F));
    PetscCall(VecGetArrayRead(F, &U));
    for (PetscInt row = 0; row < n; row++) {
      error = PetscMax(error, PetscAbsReal(Mob[column * n + row] - U[2 * first + row]));
      asymmetry = PetscMax(asymmetry, PetscAbsReal(Mob[column * n + row] - Mob[row * n + column]));
      most = PetscMax(most, PetscAbsReal(Mob[column * n + row]));
    }
    PetscCall(VecRestoreArrayRead(F, &U));
  }
  CHECK(error < 1e-11 * most, "%s: Mob is E A^-1 E^T, %.1e", name, error / most);
  CHECK(asymmetry < 1e-11 * most, "%s: Mob is symmetric, %.1e", name, asymmetry / most);
  PetscCall(VecDestroy(&F));
  PetscCall(VecDestroy(&r));
  PetscCall(StokesDestroy(&stokes));
  PetscCall(PetscFree(Mob));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckCase(const char options[], PetscReal a0, PetscBool periodic) {
  Problem q;
  char name[256], all[512];
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%.*s a0 = %g", (int)strcspn(strstr(options, "-domain_cells") + 14, ";"),
                          strstr(options, "-domain_cells") + 14, (double)a0));
  PetscCall(
      PetscSNPrintf(all, sizeof(all), "%s %s", options, periodic ? "-domain_bc_x periodic -domain_bc_y periodic" : ""));
  PetscCall(ProblemCreate(all, a0, &q));
  PetscCall(CheckStructure(name, &q));
  PetscCall(CheckOperator(name, &q));
  for (PetscInt v = 0; v < q.t.membrane->vesicles && periodic; v++) PetscCall(CheckMobility(name, &q, v));
  PetscCall(ProblemDestroy(&q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Facts(void) {
  const PetscBool yes = PETSC_TRUE, no = PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(CheckCase("-domain_cells 48,48 -vesicle_bending 1", 100, no));
  PetscCall(CheckCase("-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47 -domain_bc_x periodic "
                      "-vesicle_center 0.95,0.05 -vesicle_angle 20",
                      3, no));
  PetscCall(CheckCase("-domain_cells 48,48 -vesicle_angle 20", 100, yes));
  PetscCall(
      CheckCase("-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47 -vesicle_center -0.97,0.93", 0.5, yes));
  PetscCall(CheckCase("-domain_cells 32,32 -delta_type cbs54 -vesicle_center 0.9,0.9", 30, yes));
  /* two vesicles of different size, each with its own ds, and one that nearly fills the period */
  PetscCall(CheckCase("-domain_cells 48,48 -vesicle_count 2 -vesicle_center -0.5,0,0.5,0 -vesicle_semi_axes "
                      "0.2,0.5,0.3,0.35",
                      20, yes));
  PetscCall(CheckCase("-domain_cells 32,32 -vesicle_semi_axes 0.9,0.2", 20, yes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
