/* The double layer of a viscosity contrast, grid and near field together: the lattice's tables, rigid motions, flux,
   that it is adjoint to itself through the single layer, and the dissipation. */
#include "facts.h"
#include "problem/contrast.h"
#include "numerics/blas.h"
#include "layers/curvelayer.h"

#define SCENE                                                                                                          \
  "-delta_type cbs54 -coupling_near_field exact -coupling_box_part false -membrane_derivative spectral "               \
  "-scheme_type coupled -fluid_inertia none -domain_box -2,2,-2,2 -domain_cells 64,64 -vesicle_area 1 "                \
  "-vesicle_reduced_area .7 -vesicle_center .013,.021 -vesicle_angle 20 "
#define CHANNEL SCENE "-domain_bc_x periodic -domain_bc_y wall "
#define PERIODIC SCENE "-domain_bc_x periodic -domain_bc_y periodic "

static PetscReal Entry(const OffsetTable *t, DipolePart b, PetscInt i, PetscInt j) {
  return t->value[b][(j + t->size[1]) * (2 * t->size[0] + 1) + i + t->size[0]];
}

/* Known values; the divergence is 1/2 in the dipole's own cell, none elsewhere nor of xy. Of xy, whose entry is the
   upper right corner of a cell, the four cells around it are those with offsets 0 and 1. */
static PetscErrorCode CheckTables(void) {
  OffsetTable t[2];
  PetscFunctionBeginUser;
  PetscCall(LatticeDipoles(40, t));
  const PetscReal known[] = {.204577471545947, .045422528454052, .090845056908106};
  const char *const name[] = {"xx", "yy", "xy"};
  for (int k = 0; k < DIPOLE_COUNT; k++) {
    const DipolePart part = (DipolePart)k;
    const PetscReal off = Entry(&t[0], part, 0, part == DIPOLE_XY) - known[k];
    PetscReal most = 0;
    CHECK(PetscAbsReal(off) < 1e-14, "%s: the velocity next to the dipole is off by %.0e", name[k], off);
    for (PetscInt j = -38; j <= 38; j++)
      for (PetscInt i = -38; i <= 38; i++) {
        const PetscReal div = Entry(&t[0], part, i, j) - Entry(&t[0], part, i - 1, j) + Entry(&t[1], part, i, j) -
                              Entry(&t[1], part, i, j - 1);
        most = PetscMax(most, PetscAbsReal(div - (part != DIPOLE_XY && !i && !j ? 0.5 : 0)));
      }
    CHECK(most < 2e-14, "%s: a divergence of 1/2 in the own cell, of xy none, elsewhere none: %.0e", name[k], most);
  }
  for (int c = 0; c < 2; c++) PetscCall(OffsetTableDestroy(&t[c]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lattice next to a wall: no divergence but of xx and yy in their own cell, nothing through the wall. */
static PetscErrorCode CheckHalfTable(void) {
  OffsetTable free[2];
  ImageTable *t;
  PetscFunctionBeginUser;
  PetscCall(LatticeDipoles(2 * IMAGE_SHIFT, free));
  PetscCall(PetscNew(&t));
  PetscCall(stresslet.image_fill(free, t));
  for (int part = 0; part < DIPOLE_COUNT; part++) {
    PetscReal most = 0, wall = 0;
    for (int source = 0; source < IMAGE_ROWS; source++)
      for (int row = 0; row < IMAGE_ROWS - 1; row++)
        for (int i = 1 - IMAGE_SHIFT; i <= IMAGE_SHIFT; i++) {
          const PetscReal *along = t->value[part][row][source] + IMAGE_SHIFT + i;
          const PetscReal div = along[0] - along[-1] + t->value[DIPOLE_COUNT + part][row + 1][source][IMAGE_SHIFT + i] -
                                t->value[DIPOLE_COUNT + part][row][source][IMAGE_SHIFT + i];
          const PetscBool own = part != DIPOLE_XY && !i && row == source ? PETSC_TRUE : PETSC_FALSE;
          if (i < 2 - IMAGE_SHIFT) continue; /* xy has no entry below */
          most = PetscMax(most, PetscAbsReal(div - 0.5 * own));
          if (!row) wall = PetscMax(wall, PetscAbsReal(t->value[DIPOLE_COUNT + part][0][source][IMAGE_SHIFT + i]));
        }
    CHECK(most < 1e-9 && wall < 1e-9, "part %d at a wall: divergence %.0e, through the wall %.0e", part, most, wall);
  }
  PetscCall(PetscFree(t));
  for (int c = 0; c < 2; c++) PetscCall(OffsetTableDestroy(&free[c]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A world with the ratio 0, so that the jump is the motion itself, and what its responses are made with. */
typedef struct {
  TestWorld world;
  Stokes stokes;
  Vec r, w, p, U, V; /* force, velocity, source or pressure on the grid; marker vectors */
} Double;

static PetscErrorCode Create(const char options[], Double *d) {
  const PetscReal ratio = 0;
  TestWorld *w = &d->world;
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &w->scene));
  PetscCall(TestWorldBuild(w));
  PetscCall(DoubleLayerCreate(w->coupling->mobility->near, &ratio, &w->coupling->mobility->contrast));
  PetscCall(TestWorldPlace(1, w));
  PetscCall(StokesCreate(w->fluid, &d->stokes));
  PetscCall(TestFieldVecs(w->fluid->grid->velocity, &d->r, &d->w, NULL));
  PetscCall(TestFieldVecs(w->fluid->grid->da[FIELD_P], &d->p, NULL));
  PetscCall(TestVecs(w->X, &d->U, &d->V, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Double *d) {
  PetscFunctionBeginUser;
  PetscCall(StokesDestroy(&d->stokes));
  PetscCall(TestWorldDestroy(&d->world));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddConstant(Vec w, PetscInt first, const PetscReal mean[2]) {
  PetscScalar *a;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(w, &n));
  PetscCall(VecGetArray(w, &a));
  for (PetscInt k = 0; k < n; k++) a[k] += mean[k >= first];
  PetscCall(VecRestoreArray(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* V = E v + C_D U, the double layer of the motion U. */
static PetscErrorCode Respond(Double *d) {
  const Coupling c = d->world.coupling;
  const Grid g = d->world.fluid->grid;
  const PetscScalar *u;
  PetscScalar *v;
  Forcing f = {.values = d->r, .source = d->p};
  PetscFunctionBeginUser;
  PetscCall(VecSet(d->r, 0));
  PetscCall(VecSet(d->p, 0));
  PetscCall(VecGetArrayRead(d->U, &u));
  PetscCall(DoubleLayerSpread(c->mobility->contrast, u, &f));
  PetscCall(StokesSolve(d->stokes, d->r, d->p, d->w, d->p));
  if (!g->wall[1]) PetscCall(AddConstant(d->w, GridLocalU(g), f.mean));
  PetscCall(MarkersInterpolate(c->markers, d->w, d->V));
  PetscCall(VecGetArray(d->V, &v));
  PetscCall(DoubleLayerApply(c->mobility->contrast, 1, u, v));
  PetscCall(VecRestoreArray(d->V, &v));
  PetscCall(VecRestoreArrayRead(d->U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U of marker k: e_x, e_y, a turn, or along the curve. */
static PetscErrorCode SetMotion(Double *d, int which) {
  const DoubleLayer s = d->world.coupling->mobility->contrast;
  const Layout l = d->world.layout;
  PetscScalar *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(d->U, &u));
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = d->world.coupling->markers->X + 2 * (l->first + k), *N = s->normal + 2 * (l->first + k);
    const PetscReal motion[4][2] = {
        {1, 0}, {0, 1}, {-X[1], X[0]}, {-N[1] / s->along[l->first + k], N[0] / s->along[l->first + k]}};
    for (int c = 0; c < 2; c++) u[2 * k + c] = motion[which][c];
  }
  PetscCall(VecRestoreArray(d->U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D R = -R/2 for rigid motions. */
static PetscErrorCode CheckRigid(const char name[], PetscReal bound, Double *d) {
  PetscReal rigid;
  PetscFunctionBeginUser;
  for (int which = 0; which < 3; which++) {
    PetscCall(SetMotion(d, which));
    PetscCall(Respond(d));
    PetscCall(VecAXPY(d->V, 0.5, d->U));
    PetscCall(VecNorm(d->V, NORM_INFINITY, &rigid));
    CHECK(rigid < bound, "%s: D R = -R/2 for the rigid motion %d: %.1e", name, which, rigid);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rigid motions; and a motion along the curve sends no flux through it. */
static PetscErrorCode CheckMotions(const char name[], const char options[]) {
  PetscReal flux = 0, *V;
  Double d;
  PetscFunctionBeginUser;
  PetscCall(Create(options, &d));
  PetscCall(CheckRigid(name, 1e-6, &d));
  PetscCall(SetMotion(&d, 3));
  PetscCall(Respond(&d));
  PetscCall(PetscMalloc1(2 * d.world.layout->M, &V));
  PetscCall(LayoutGatherVec(d.world.layout, d.V, V));
  for (PetscInt k = 0; k < 2 * d.world.layout->M; k++) flux += d.world.coupling->mobility->contrast->normal[k] * V[k];
  flux /= d.world.coupling->mobility->contrast->length[0];
  CHECK(PetscAbsReal(flux) < 1e-9, "%s: no flux of a motion along the curve, speed 1, a length: %.1e", name, flux);
  PetscCall(PetscFree(V));
  PetscCall(Destroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Next to walls: a rigid motion inside a vesicle and none outside obeys the no-slip condition too. What is off
   is the closed form's from 20 cells on, and nearer than a cell what the markers' spacing leaves. */
static PetscErrorCode CheckAtWall(const char name[], const char options[], PetscReal bound) {
  Double d;
  PetscFunctionBeginUser;
  PetscCall(Create(options, &d));
  PetscCall(CheckRigid(name, bound, &d));
  PetscCall(Destroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The matrix of a response, columns one after another, on every rank. */
static PetscErrorCode Matrix(Double *d, PetscBool single, PetscReal A[]) {
  const PetscInt n = 2 * d->world.layout->M;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(TestUnit(k, d->U));
    if (single)
      PetscCall(TestWorldRespond(&d->world, d->stokes, PETSC_TRUE, d->U, d->V));
    else
      PetscCall(Respond(d));
    PetscCall(LayoutGatherVec(d->world.layout, d->V, A + k * n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D S = S D^T, by which the power of the forces is a dissipation. */
static PetscErrorCode CheckAdjoint(PetscInt n, const PetscReal D[], const PetscReal S[]) {
  PetscReal *product, off = 0, all = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &product));
  PetscCall(DenseProduct(PETSC_FALSE, n, n, n, D, S, product));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) { /* S is symmetric: S D^T is the transpose */
      off += PetscSqr(product[j * n + i] - product[i * n + j]);
      all += PetscSqr(product[j * n + i]);
    }
  off = PetscSqrtReal(off / all);
  CHECK(off < 1e-3, "D S = S D^T: apart by %.1e of it", off);
  PetscCall(PetscFree(product));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Orthonormal motions of 2 M markers that stretch no edge and keep the area: the first M - 1 columns of Q[2M][2M]. */
static PetscErrorCode Inextensible(const TestWorld *w, PetscReal Q[]) {
  const PetscInt M = w->layout->M, n = 2 * M, rows = M + 1;
  const DoubleLayer s = w->coupling->mobility->contrast;
  PetscReal *A, *l, *U;
  MembraneLaw law;
  PetscFunctionBeginUser;
  PetscCall(LawCreate(w->membrane, 1, 0, 1, &law));
  LawPlace(law, 1, w->coupling->markers->X);
  PetscCall(PetscMalloc3(rows * n, &A, n, &l, n, &U));
  PetscCall(PetscArrayzero(U, n));
  for (PetscInt k = 0; k < n; k++) {
    U[k] = 1;
    LawRows(law, U, NULL, A + k * rows);
    A[k * rows + M] = s->normal[k] / s->along[k / 2];
    U[k] = 0;
  }
  PetscCall(DenseProduct(PETSC_TRUE, n, n, rows, A, A, Q));
  PetscCall(DenseEigen(n, Q, l));
  CHECK(l[M - 2] < 1e-12 * l[n - 1] && l[M - 1] > 1e-6 * l[n - 1],
        "M - 1 motions stretch no edge and keep the area: %.0e, %.0e", l[M - 2], l[M - 1]);
  PetscCall(PetscFree3(A, l, U));
  PetscCall(LawDestroy(&law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F[n + 1][m]: forces and a pressure with S F + p n = B U, n . F = 0, of the m columns U of [n], B of a ratio. */
static PetscErrorCode ForcesOf(const Double *d, PetscReal ratio, const PetscReal D[], const PetscReal S[], PetscInt m,
                               const PetscReal U[], PetscReal F[]) {
  const PetscReal *normal = d->world.coupling->mobility->contrast->normal;
  const PetscInt n = 2 * d->world.layout->M, size = n + 1;
  PetscReal *A;
  PetscBLASInt *pivot;
  PetscBool factored;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(size * size, &A, size, &pivot));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscArraycpy(A + k * size, S + k * n, n));
    A[k * size + n] = A[n * size + k] = normal[k];
  }
  for (PetscInt k = 0; k < m; k++) {
    for (PetscInt i = 0; i < n; i++) F[k * size + i] = (1 + ratio) / 2 * U[k * n + i];
    F[k * size + n] = 0;
    PetscCall(DenseMultAdd(PETSC_FALSE, n, n, ratio - 1, D, U + k * n, F + k * size));
  }
  PetscCall(DenseFactor(size, A, pivot, &factored));
  CHECK(factored, "the forces of a motion, ratio %g", ratio);
  PetscCall(DenseSolve(size, A, pivot, PETSC_FALSE, m, F));
  PetscCall(PetscFree2(A, pivot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The dissipation U . F of every motion U that stretches no edge and keeps the area is positive: the least eigenvalue
   of that form is. It is that of a nearly rigid motion, which dissipates outside only, so the ratio hardly matters. */
static PetscErrorCode CheckDissipation(const Double *d, const PetscReal D[], const PetscReal S[]) {
  const PetscReal ratios[] = {0.1, 10, 50};
  const PetscInt n = 2 * d->world.layout->M, m = n / 2 - 1;
  PetscReal *Q, *F, *K, *l, first = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * n, &Q, (n + 1) * m, &F, m * m, &K, m, &l));
  PetscCall(Inextensible(&d->world, Q));
  for (int r = 0; r < 3; r++) {
    PetscCall(ForcesOf(d, ratios[r], D, S, m, Q, F));
    for (PetscInt j = 0; j < m; j++)
      for (PetscInt i = 0; i < m; i++) {
        K[j * m + i] = 0;
        for (PetscInt k = 0; k < n; k++)
          K[j * m + i] += 0.5 * (Q[i * n + k] * F[j * (n + 1) + k] + Q[j * n + k] * F[i * (n + 1) + k]);
      }
    PetscCall(DenseEigen(m, K, l));
    if (!r) first = l[0];
    CHECK(l[0] > 0 && PetscAbsReal(l[0] - first) < 0.01 * first,
          "ratio %g: inextensible motions dissipate, from %.5f to %.1f of their square", ratios[r], l[0], l[m - 1]);
  }
  PetscCall(PetscFree4(Q, F, K, l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the matrices of D and S say, in a channel. */
static PetscErrorCode CheckMatrices(void) {
  PetscReal *D, *S;
  Double d;
  PetscFunctionBeginUser;
  PetscCall(Create(CHANNEL "-vesicle_markers 45", &d));
  const PetscInt n = 2 * d.world.layout->M;
  PetscCall(PetscMalloc2(n * n, &D, n * n, &S));
  PetscCall(Matrix(&d, PETSC_FALSE, D));
  PetscCall(Matrix(&d, PETSC_TRUE, S));
  PetscCall(CheckAdjoint(n, D, S));
  PetscCall(CheckDissipation(&d, D, S));
  PetscCall(PetscFree2(D, S));
  PetscCall(Destroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On the unit circle, in a fluid of viscosity 3: J = (1, 2) is -J inside and nothing outside; J = (x, -y) is -J/2
   inside without pressure, and has the pressure 2 nu cos(2 phi)/r^2 outside. At any distance from the curve. */
static PetscErrorCode CheckCurve(void) {
  const PetscReal radius[] = {0.3, 0.9, 0.9999, 1.0001, 1.1, 3};
  PetscReal X[64], constant[64], strain[64];
  CurveLayer curve[2];
  PetscFunctionBeginUser;
  for (int k = 0; k < 64; k++) {
    X[k] = k % 2 ? PetscSinReal(PETSC_PI * (k / 2) / 16) : PetscCosReal(PETSC_PI * (k / 2) / 16);
    constant[k] = k % 2 ? 2 : 1;
    strain[k] = k % 2 ? -X[k] : X[k];
  }
  PetscCall(CurveLayerCreate(&stresslet, 32, 3, X, constant, &curve[0]));
  PetscCall(CurveLayerCreate(&stresslet, 32, 3, X, strain, &curve[1]));
  for (int k = 0; k < 6; k++) {
    const PetscReal r = radius[k];
    PetscReal worst = 0;
    for (PetscReal angle = 0.1; angle < 6; angle += 0.37) {
      const PetscReal x[2] = {r * PetscCosReal(angle), r * PetscSinReal(angle)};
      PetscReal u[3] = {0}, s[3] = {0};
      PetscBool inside;
      CurveLayerAdd(curve[0], x, u, &u[2], &inside);
      worst = PetscMax(worst, PetscAbsReal(u[0] + (r < 1)) + PetscAbsReal(u[1] + 2 * (r < 1)) + PetscAbsReal(u[2]));
      CurveLayerAdd(curve[1], x, s, &s[2], &inside);
      worst = PetscMax(worst, PetscAbsReal(s[2] - (r < 1 ? 0 : 6 * PetscCosReal(2 * angle) / (r * r))));
      if (r < 1) worst = PetscMax(worst, PetscAbsReal(s[0] + 0.5 * x[0]) + PetscAbsReal(s[1] - 0.5 * x[1]));
      if (inside != (r < 1)) worst = PETSC_MAX_REAL;
    }
    CHECK(worst < 1e-7, "the double layer of a unit circle %g from its middle: off by %.1e", r, worst);
  }
  for (int k = 0; k < 2; k++) PetscCall(CurveLayerDestroy(&curve[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  PetscCall(CheckCurve());
  PetscCall(CheckTables());
  PetscCall(CheckMotions("channel", CHANNEL "-vesicle_markers 69"));
  PetscCall(CheckMotions("periodic both ways", PERIODIC "-vesicle_markers 69"));
  PetscCall(CheckHalfTable());
  PetscCall(CheckAtWall("bottom wall", CHANNEL "-vesicle_markers 69 -vesicle_center .013,-1.435 ", 4e-6));
  PetscCall(CheckAtWall("top wall", CHANNEL "-vesicle_markers 69 -vesicle_center .013,1.5 ", 4e-4));
  PetscCall(CheckAtWall("top wall, twice the markers", CHANNEL "-vesicle_markers 137 -vesicle_center .013,1.5 ", 5e-5));
  PetscCall(CheckMatrices());
  PetscFunctionReturn(PETSC_SUCCESS);
}
