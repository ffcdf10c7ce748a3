/* The double layer of a viscosity contrast, grid and near field together: the lattice's tables, rigid motions, flux,
   that it is adjoint to itself through the single layer, and the dissipation. */
#include "facts.h"
#include "problem/contrast.h"
#include "numerics/blas.h"
#include "layers/curvelayer.h"
#include "layers/stencilsums.h"

TestScoped(MembraneLaw, LawDestroy);

#define SCENE                                                                                                          \
  "-delta_type cbs54 -coupling_near_field exact -coupling_box_part false -membrane_derivative spectral "               \
  "-scheme_type coupled -fluid_inertia none -domain_box -2,2,-2,2 -domain_cells 64,64 -vesicle_area 1 "                \
  "-vesicle_reduced_area .7 -vesicle_center .013,.021 -vesicle_angle 20 "
/* Known values; the divergence is 1/2 in the dipole's own cell, none elsewhere nor of xy. Of xy, whose entry is the
   upper right corner of a cell, the four cells around it are those with offsets 0 and 1. */
static void CheckTables(void) {
  OffsetTable t[2];
  TestCall(LatticeDipoles(40, t));
  const PetscReal known[] = {.204577471545947, .045422528454052, .090845056908106};
  for (int part = 0; part < DIPOLE_COUNT; part++) {
    const PetscBool xy = part == DIPOLE_XY;
    PetscReal most = 0;
    TestAbout("%s", (const char *[]){"xx", "yy", "xy"}[part]);
    CheckBelow(OffsetAt(&t[0], part, 0, xy) - known[part], 1e-14, "the velocity next to the dipole");
    for (PetscInt j = -38; j <= 38; j++)
      for (PetscInt i = -38; i <= 38; i++)
        TestWorse(&most, OffsetAt(&t[0], part, i, j) - OffsetAt(&t[0], part, i - 1, j) + OffsetAt(&t[1], part, i, j) -
                             OffsetAt(&t[1], part, i, j - 1) - (xy || i || j ? 0 : 0.5));
    CheckBelow(most, 2e-14, "a divergence of 1/2 in the own cell, of xy none, elsewhere none");
  }
  for (int c = 0; c < 2; c++) TestCall(OffsetTableDestroy(&t[c]));
}

/* The lattice next to a wall: no divergence but of xx and yy in their own cell, nothing through the wall. */
static void CheckHalfTable(void) {
  OffsetTable free[2];
  ImageTable *t;
  TestCall(LatticeDipoles(2 * IMAGE_SHIFT, free));
  TestCall(PetscNew(&t));
  TestCall(stresslet.image_fill(free, t));
  TestAbout("a dipole at a wall");
  for (int part = 0; part < DIPOLE_COUNT; part++) {
    PetscReal most = 0, wall = 0;
    for (int source = 0; source < IMAGE_ROWS; source++)
      for (int row = 0; row < IMAGE_ROWS - 1; row++)
        for (int i = 2 - IMAGE_SHIFT; i <= IMAGE_SHIFT; i++) { /* xy has no entry below */
          const PetscReal *along = t->value[part][row][source] + IMAGE_SHIFT + i;
          const PetscReal across = t->value[DIPOLE_COUNT + part][row][source][IMAGE_SHIFT + i],
                          above = t->value[DIPOLE_COUNT + part][row + 1][source][IMAGE_SHIFT + i];
          const PetscBool own = part != DIPOLE_XY && !i && row == source;
          TestWorse(&most, along[0] - along[-1] + above - across - 0.5 * own);
          if (!row) TestWorse(&wall, across);
        }
    CheckBelow(most, 1e-9, "part %d: divergence", part);
    CheckBelow(wall, 1e-9, "part %d: through the wall", part);
  }
  TestCall(PetscFree(t));
  for (int c = 0; c < 2; c++) TestCall(OffsetTableDestroy(&free[c]));
}

/* A world with the ratio 0, so that the jump is the motion itself, and what its responses are made with. */
typedef struct {
  TestWorld world;
  Vec r, w, p, U, V; /* force, velocity, source or pressure on the grid; marker vectors */
} Double;

static void Create(const char options[], Double *d) {
  const PetscReal ratio = 0;
  TestWorld *w = &d->world;
  TestScene(&w->scene, "%s", options);
  TestWorldBuild(w);
  TestCall(DoubleLayerCreate(w->coupling->mobility->near, &ratio, &w->coupling->mobility->contrast));
  TestWorldPlace(1, w);
  TestFieldVecs(w->fluid->grid->velocity, &d->r, &d->w, NULL);
  TestFieldVecs(w->fluid->grid->da[FIELD_P], &d->p, NULL);
  TestVecs(w->X, &d->U, &d->V, NULL);
}

/* V = E v + C_D U, the double layer of the motion U. */
static void Respond(Double *d) {
  const Coupling c = d->world.coupling;
  const Grid g = d->world.fluid->grid;
  Forcing f = {.values = d->r, .source = d->p};
  TestCall(VecSet(d->r, 0));
  TestCall(VecSet(d->p, 0));
  TestCall(DoubleLayerSpread(c->mobility->contrast, d->U, &f));
  TestCall(StokesSolve(TestWorldStokes(&d->world), d->r, d->p, d->w, d->p));
  const PetscInt rows = g->rows[FIELD_U] * g->columns[FIELD_U];
  for (PetscInt k = 0; !g->wall[1] && k < rows + g->rows[FIELD_V] * g->columns[FIELD_V]; k++)
    TestArray(d->w)[k] += f.mean[k >= rows];
  TestCall(MarkersInterpolate(c->markers, d->w, d->V));
  TestCall(DoubleLayerApply(c->mobility->contrast, 1, d->U, TestArray(d->V)));
}

/* U of marker k: e_x, e_y, a turn, or along the curve. */
static void SetMotion(Double *d, int which) {
  const DoubleLayer s = d->world.coupling->mobility->contrast;
  const Layout l = d->world.layout;
  PetscScalar *u = TestArray(d->U);
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = d->world.coupling->markers->X + 2 * (l->first + k), *N = s->normal + 2 * (l->first + k);
    const PetscReal motion[4][2] = {
        {1, 0}, {0, 1}, {-X[1], X[0]}, {-N[1] / s->along[l->first + k], N[0] / s->along[l->first + k]}};
    for (int c = 0; c < 2; c++) u[2 * k + c] = motion[which][c];
  }
}

/* D R = -R/2 for rigid motions R; and a motion along the curve sends no flux through it. Next to walls a rigid motion
   inside a vesicle and none outside obeys the no-slip condition too. What is off there is the closed form's from 20
   cells on, and nearer than a cell what the markers' spacing leaves. */
static void CheckMotions(const char name[], const char options[], PetscReal bound, PetscReal most) {
  Double d;
  Create(options, &d);
  TestAbout("%s", name);
  for (int which = 0; which < 3; which++) {
    SetMotion(&d, which);
    Respond(&d);
    TestCall(VecAXPY(d.V, 0.5, d.U));
    CheckBelow(TestNorm(NORM_INFINITY, d.V), bound, "D R = -R/2 for the rigid motion %d", which);
  }
  SetMotion(&d, 3);
  Respond(&d);
  PetscReal *V = TestReals(2 * d.world.layout->M);
  TestCall(LayoutGatherVec(d.world.layout, d.V, V));
  const DoubleLayer s = d.world.coupling->mobility->contrast;
  CheckBelow(TestProduct(2 * d.world.layout->M, s->normal, V) / s->length[0], most,
             "no flux of a motion along the curve, speed 1, a length");
  TestWorldDestroy(&d.world);
}

/* The matrix of a response, columns one after another, on every rank. */
static void Matrix(Double *d, PetscBool single, PetscReal A[]) {
  const PetscInt n = 2 * d->world.layout->M;
  for (PetscInt k = 0; k < n; k++) {
    TestUnit(k, d->U);
    if (single)
      TestWorldRespond(&d->world, PETSC_TRUE, d->U, d->V);
    else
      Respond(d);
    TestCall(LayoutGatherVec(d->world.layout, d->V, A + k * n));
  }
}

/* D S = S D^T, by which the power of the forces is a dissipation. */
static void CheckAdjoint(PetscInt n, const PetscReal D[], const PetscReal S[]) {
  PetscReal *product = TestReals(n * n), off = 0, all = 0;
  TestCall(DenseProduct(PETSC_FALSE, n, n, n, D, S, product));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) { /* S is symmetric: S D^T is the transpose */
      off += PetscSqr(product[j * n + i] - product[i * n + j]);
      all += PetscSqr(product[j * n + i]);
    }
  CheckBelow(PetscSqrtReal(off / all), 1e-3, "D S = S D^T");
}

/* Orthonormal motions of 2 M markers that stretch no edge and keep the area: the first M - 1 columns of Q[2M][2M]. */
static void Inextensible(const TestWorld *w, PetscReal Q[]) {
  const PetscInt M = w->layout->M, n = 2 * M, rows = M + 1;
  const DoubleLayer s = w->coupling->mobility->contrast;
  PetscReal *A = TestReals(rows * n), *l = TestReals(n), *U = TestReals(n);
  Scoped(MembraneLaw) law;
  TestCall(LawCreate(w->membrane, 1, 0, 1, &law));
  LawPlace(law, 1, w->coupling->markers->X);
  for (PetscInt k = 0; k < n; k++) {
    U[k] = 1;
    LawRows(law, U, NULL, A + k * rows);
    A[k * rows + M] = s->normal[k] / s->along[k / 2];
    U[k] = 0;
  }
  TestCall(DenseProduct(PETSC_TRUE, n, n, rows, A, A, Q));
  TestCall(DenseEigen(n, Q, l));
  CHECK(l[M - 2] < 1e-12 * l[n - 1] && l[M - 1] > 1e-6 * l[n - 1],
        "M - 1 motions stretch no edge and keep the area: %.0e, %.0e", l[M - 2], l[M - 1]);
}

/* F[n + 1][m]: forces and a pressure with S F + p n = B U, n . F = 0, of the m columns U of [n], B of a ratio. */
static void ForcesOf(const Double *d, PetscReal ratio, const PetscReal D[], const PetscReal S[], PetscInt m,
                     const PetscReal U[], PetscReal F[]) {
  const PetscReal *normal = d->world.coupling->mobility->contrast->normal;
  const PetscInt n = 2 * d->world.layout->M, size = n + 1;
  PetscReal *A = TestReals(size * size);
  PetscBLASInt *pivot;
  PetscBool factored;
  TestCall(PetscCalloc1(size, &pivot));
  for (PetscInt k = 0; k < n; k++) {
    TestCall(PetscArraycpy(A + k * size, S + k * n, n));
    A[k * size + n] = A[n * size + k] = normal[k];
  }
  for (PetscInt k = 0; k < m; k++) {
    for (PetscInt i = 0; i < n; i++) F[k * size + i] = (1 + ratio) / 2 * U[k * n + i];
    F[k * size + n] = 0;
    TestCall(DenseMultAdd(PETSC_FALSE, n, n, ratio - 1, D, U + k * n, F + k * size));
  }
  TestCall(DenseFactor(size, A, pivot, &factored));
  CHECK(factored, "the forces of a motion, ratio %g", ratio);
  TestCall(DenseSolve(size, A, pivot, PETSC_FALSE, m, F));
  TestCall(PetscFree(pivot));
}

/* The dissipation U . F of every motion U that stretches no edge and keeps the area is positive: the least eigenvalue
   of that form is. It is that of a nearly rigid motion, which dissipates outside only, so the ratio hardly matters. */
static void CheckDissipation(const Double *d, const PetscReal D[], const PetscReal S[]) {
  const PetscReal ratios[] = {0.1, 10, 50};
  const PetscInt n = 2 * d->world.layout->M, m = n / 2 - 1;
  PetscReal *Q = TestReals(n * n), *F = TestReals((n + 1) * m), *K = TestReals(m * m), *l = TestReals(m), first = 0;
  Inextensible(&d->world, Q);
  for (int r = 0; r < 3; r++) {
    ForcesOf(d, ratios[r], D, S, m, Q, F);
    for (PetscInt j = 0; j < m; j++)
      for (PetscInt i = 0; i < m; i++) {
        K[j * m + i] = 0;
        for (PetscInt k = 0; k < n; k++)
          K[j * m + i] += 0.5 * (Q[i * n + k] * F[j * (n + 1) + k] + Q[j * n + k] * F[i * (n + 1) + k]);
      }
    TestCall(DenseEigen(m, K, l));
    if (!r) first = l[0];
    CHECK(l[0] > 0 && PetscAbsReal(l[0] - first) < 0.01 * first,
          "ratio %g: inextensible motions dissipate, from %.5f to %.1f of their square", ratios[r], l[0], l[m - 1]);
  }
}

/* What the matrices of D and S say, in a channel. */
static void CheckMatrices(void) {
  Double d;
  TestAbout("channel");
  Create(SCENE CHANNEL "-vesicle_markers 45", &d);
  const PetscInt n = 2 * d.world.layout->M;
  PetscReal *D = TestReals(n * n), *S = TestReals(n * n);
  Matrix(&d, PETSC_FALSE, D);
  Matrix(&d, PETSC_TRUE, S);
  CheckAdjoint(n, D, S);
  CheckDissipation(&d, D, S);
  TestWorldDestroy(&d.world);
}

/* On the unit circle, in a fluid of viscosity 3: J = (1, 2) is -J inside and nothing outside; J = (x, -y) is -J/2
   inside without pressure, and has the pressure 2 nu cos(2 phi)/r^2 outside. At any distance from the curve. */
static void CheckCurve(void) {
  const PetscReal radius[] = {0.3, 0.9, 0.9999, 1.0001, 1.1, 3};
  PetscReal X[64], jump[2][64];
  CurveLayer curve[2];
  for (int k = 0; k < 64; k++) {
    X[k] = k % 2 ? PetscSinReal(PETSC_PI * (k / 2) / 16) : PetscCosReal(PETSC_PI * (k / 2) / 16);
    jump[0][k] = k % 2 ? 2 : 1;
    jump[1][k] = k % 2 ? -X[k] : X[k];
  }
  for (int k = 0; k < 2; k++) TestCall(CurveLayerCreate(&stresslet, 32, 3, X, jump[k], &curve[k]));
  for (int k = 0; k < 6; k++) {
    const PetscReal r = radius[k];
    PetscReal worst = 0;
    for (PetscReal angle = 0.1; angle < 6; angle += 0.37) {
      const PetscReal x[2] = {r * PetscCosReal(angle), r * PetscSinReal(angle)};
      PetscReal u[3] = {0}, s[3] = {0};
      PetscBool inside;
      CurveLayerAdd(curve[0], x, u, &u[2], &inside);
      TestWorse(&worst, PetscAbsReal(u[0] + (r < 1)) + PetscAbsReal(u[1] + 2 * (r < 1)) + PetscAbsReal(u[2]));
      CurveLayerAdd(curve[1], x, s, &s[2], &inside);
      TestWorse(&worst, PetscAbsReal(s[2] - (r < 1 ? 0 : 6 * PetscCosReal(2 * angle) / (r * r))));
      if (r < 1) TestWorse(&worst, PetscAbsReal(s[0] + 0.5 * x[0]) + PetscAbsReal(s[1] - 0.5 * x[1]));
      if (inside != (r < 1)) worst = PETSC_MAX_REAL;
    }
    CheckBelow(worst, 1e-7, "the double layer of a unit circle %g from its middle", r);
  }
  for (int k = 0; k < 2; k++) TestCall(CurveLayerDestroy(&curve[k]));
}

void Facts(void) {
  CheckCurve();
  CheckTables();
  CheckMotions("channel", SCENE CHANNEL "-vesicle_markers 69", 1e-6, 1e-9);
  CheckMotions("periodic both ways", SCENE PERIODIC "-vesicle_markers 69", 1e-6, 1e-9);
  CheckHalfTable();
  CheckMotions("bottom wall", SCENE CHANNEL "-vesicle_markers 69 -vesicle_center .013,-1.435 ", 4e-6, 1e-5);
  CheckMotions("top wall", SCENE CHANNEL "-vesicle_markers 69 -vesicle_center .013,1.5 ", 4e-4, 1e-5);
  CheckMotions("top wall, twice the markers", SCENE CHANNEL "-vesicle_markers 137 -vesicle_center .013,1.5 ", 5e-5,
               1e-5);
  CheckMatrices();
}
