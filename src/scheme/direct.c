#include "coupling/contrast.h"
#include "scheme/directrows.h"

PetscErrorCode DirectSolverCreate(Coupling coupling, DirectSolver *out) {
  const Grid g = coupling->fluid->grid;
  DirectSolver d;
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  *out = d;
  d->fluid = coupling->fluid;
  d->coupling = coupling;
  d->M = coupling->membrane->layout->M;
  d->W = coupling->bodies->layout->M - d->M;
  PetscCall(PetscMalloc1(2 * (d->M + d->W), &d->all));
  PetscCall(PetscCalloc1(g->size + 1, &d->start));
  for (PetscInt r = 0; r < g->size; r++) {
    d->start[r + 1] = d->start[r] + (r == g->size - 1 ? Others(d) : 0);
    for (int f = 0; f < 3; f++) d->start[r + 1] += g->columns[f] * DirectRows(g, r, f);
  }
  PetscCall(VecCreateMPI(g->comm, d->start[g->rank + 1] - d->start[g->rank], PETSC_DETERMINE, &d->x));
  PetscCall(VecDuplicate(d->x, &d->b));
  if (coupling->contrast) PetscCall(DMCreateGlobalVector(g->da[FIELD_P], &d->source));
  PetscCall(KSPCreate(g->comm, &d->ksp));
  PetscCall(KSPSetOptionsPrefix(d->ksp, "direct_"));
  PetscCall(KSPSetType(d->ksp, KSPPREONLY));
  PetscCall(KSPGetPC(d->ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetFromOptions(d->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DirectSolverDestroy(DirectSolver *solver) {
  PetscFunctionBeginUser;
  if (!*solver) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*solver)->start));
  PetscCall(PetscFree((*solver)->all));
  PetscCall(KSPDestroy(&(*solver)->ksp));
  PetscCall(VecDestroy(&(*solver)->x));
  PetscCall(VecDestroy(&(*solver)->b));
  PetscCall(VecDestroy(&(*solver)->source));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* H and G, G^T: each rank its own rows. */
static PetscErrorCode AddFluid(DirectSolver d, Mat A) {
  const Grid g = d->fluid->grid;
  const PetscReal off = d->fluid->nu / PetscSqr(g->h), h = g->h;
  PetscFunctionBeginUser;
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = g->first; j < g->first + g->rows[f]; j++)
      for (PetscInt i = 0; i < g->columns[f]; i++) {
        const PetscInt row = DirectIndex(d, f, i, j), di[4] = {-1, 1, 0, 0}, dj[4] = {0, 0, -1, 1};
        const PetscInt ahead = f == FIELD_U ? DirectIndex(d, FIELD_P, (i + 1) % g->n[0], j)
                                            : DirectIndex(d, FIELD_P, i, (j + 1) % g->n[1]);
        const PetscInt here = DirectIndex(d, FIELD_P, i, j);
        PetscReal diagonal = d->fluid->alpha + 4 * off;
        for (int k = 0; k < 4; k++) {
          PetscInt c = i + di[k], r = j + dj[k];
          const PetscBool outside = c < 0 || c >= g->columns[f] || r < 0 || r >= g->all_rows[f] ? PETSC_TRUE
                                                                                                : PETSC_FALSE;
          if (outside && g->wall[k / 2]) {
            diagonal -= off * GridWallFactor((Field)f, k / 2);
            continue;
          }
          c = (c + g->columns[f]) % g->columns[f];
          r = (r + g->all_rows[f]) % g->all_rows[f];
          PetscCall(MatSetValue(A, row, DirectIndex(d, f, c, r), -off, ADD_VALUES));
        }
        PetscCall(MatSetValue(A, row, row, diagonal, ADD_VALUES));
        PetscCall(MatSetValue(A, row, ahead, 1 / h, ADD_VALUES));
        PetscCall(MatSetValue(A, row, here, -1 / h, ADD_VALUES));
        PetscCall(MatSetValue(A, ahead, row, 1 / h, ADD_VALUES));
        PetscCall(MatSetValue(A, here, row, -1 / h, ADD_VALUES));
      }
  if (!g->rank)
    PetscCall(MatSetValue(A, DirectIndex(d, FIELD_P, 0, 0), DirectIndex(d, FIELD_P, 0, 0), -1 / d->fluid->nu,
                          ADD_VALUES)); /* p_0 = 0 */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* g in the momentum's rows, and its own rows, the sum of all velocities. */
static PetscErrorCode AddMean(DirectSolver d, Mat A) {
  const Grid g = d->fluid->grid;
  PetscFunctionBeginUser;
  for (int f = FIELD_U; f < MeanForces(d); f++)
    for (PetscInt j = g->first; j < g->first + g->rows[f]; j++)
      for (PetscInt i = 0; i < g->columns[f]; i++) {
        PetscCall(MatSetValue(A, DirectIndex(d, f, i, j), FirstMean(d) + f, 1, ADD_VALUES));
        PetscCall(MatSetValue(A, FirstMean(d) + f, DirectIndex(d, f, i, j), 1, ADD_VALUES));
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* E: -E w, what the markers have of it, in the rows of velocities, E^T F in the momentum. Without a matrix: entries of
 * the own momentum rows, into room. */
static PetscErrorCode AddInterpolation(DirectSolver d, Mat A, PetscInt room[]) {
  const Grid g = d->fluid->grid;
  const PetscReal part = CouplingGridPart(d->coupling, d->fluid->alpha);
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < 2 * (d->M + d->W); q++) {
    const Stencil *s = &d->coupling->markers->stencil[q];
    const int c = q % 2;
    for (PetscInt b = 0; b < s->n[1]; b++)
      for (PetscInt a = 0; a < s->n[0]; a++) {
        const PetscReal weight = s->weight[1][b] * s->weight[0][a];
        PetscInt i = s->first[0] + a, j = s->first[1] + b;
        if (!g->wall[0]) i %= g->n[0];
        if (!g->wall[1]) j %= g->n[1];
        if (i < 0 || j < 0 || i >= g->columns[c] || j >= g->all_rows[c]) continue;
        if (!A) {
          const PetscInt row = DirectIndex(d, c, i, j);
          if (row >= d->start[g->rank] && row < d->start[g->rank + 1]) room[row - d->start[g->rank]]++;
          continue;
        }
        PetscCall(MatSetValue(A, RowOf(d, q), DirectIndex(d, c, i, j), -part * weight, ADD_VALUES));
        PetscCall(MatSetValue(A, DirectIndex(d, c, i, j), FirstF(d) + q, weight, ADD_VALUES));
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddNonzero(Mat A, PetscInt row, PetscInt column, PetscReal value) {
  PetscFunctionBeginUser;
  if (value != 0) PetscCall(MatSetValue(A, row, column, value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One vesicle's rows between sigma, U and F, a column at a time by unit vectors:
   U + (v/a0) dU/dt - E w + h^2 C F = k,  F - Dm^T sigma/h^2 - ((c_b ds D4 + K_sigma)/(h^2 a0)) U = 0,  Dm U/h^2 = g. */
static PetscErrorCode AddVesicle(DirectSolver d, Mat A, PetscInt v, PetscInt sigma, PetscInt U, PetscInt F) {
  const Membrane m = d->coupling->membrane;
  const PetscInt first = m->layout->start[v], n = LayoutCount(m->layout, v);
  const PetscReal h2 = PetscSqr(d->fluid->grid->h), *tau = d->coupling->tau + 2 * LayoutOffset(m->layout, v);
  const PetscReal treading = d->coupling->treading[v], *turning = d->coupling->turning + LayoutOffset(m->layout, v);
  PetscReal *unit, *stretching, *out;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(2 * n, &unit, n, &stretching, 2 * n, &out));
  for (PetscInt c = 0; c < 2 * n; c++) { /* a row's columns in order: those of sigma before those of U */
    unit[c] = 1;
    MembraneVesicleStretching(m, v, tau, unit, stretching);
    for (PetscInt k = 0; k < n; k++) {
      PetscCall(AddNonzero(A, sigma + first + k, U + 2 * first + c, stretching[k] / h2));
      PetscCall(AddNonzero(A, F + 2 * first + c, sigma + first + k, -stretching[k] / h2));
    }
    unit[c] = 0;
  }
  for (PetscInt c = 0; c < 2 * n; c++) {
    const PetscInt column = 2 * first + c;
    unit[c] = 1;
    if (!d->source) PetscCall(MatSetValue(A, U + column, U + column, 1, ADD_VALUES));
    PetscCall(MatSetValue(A, F + column, F + column, 1, ADD_VALUES));
    PetscCall(PetscArrayzero(out, 2 * n));
    if (m->bending > 0) MembraneVesicleBending(m, v, -m->bending / (h2 * d->fluid->a0), unit, out);
    MembraneVesiclePull(m, v, -1 / (h2 * d->fluid->a0), turning, unit, out);
    for (PetscInt r = 0; r < 2 * n; r++) PetscCall(AddNonzero(A, F + 2 * first + r, U + column, out[r]));
    PetscCall(PetscArrayzero(out, 2 * n));
    if (treading != 0 && !d->source) MembraneLabelDerivative(m, v, treading / d->fluid->a0, unit, out);
    for (PetscInt r = 0; r < 2 * n; r++) PetscCall(AddNonzero(A, U + 2 * first + r, U + column, out[r]));
    unit[c] = 0;
  }
  PetscCall(PetscFree3(unit, stretching, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The springs of a repulsion: -(K_rep/(h^2 a0)) U in the rows of F. They are the same on every rank: one adds them. */
static PetscErrorCode AddSprings(DirectSolver d, Mat A, PetscInt U, PetscInt F) {
  const Repulsion r = d->coupling->repulsion;
  const PetscReal scale = -1 / (PetscSqr(d->fluid->grid->h) * d->fluid->a0);
  PetscFunctionBeginUser;
  for (PetscInt q = 0; r && q < r->count; q++) {
    const Spring *s = &r->spring[q];
    for (PetscInt i = 0; i < 2 * s->n; i++)
      for (PetscInt j = 0; j < 2 * s->n; j++)
        PetscCall(AddNonzero(A, F + 2 * s->marker[i / 2] + i % 2, U + 2 * s->marker[j / 2] + j % 2,
                             scale * s->stiffness * s->weight[i / 2] * s->normal[i % 2] * s->weight[j / 2] *
                                 s->normal[j % 2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The near field: h^2 (C + D) F in the rows of the own bodies' velocities. */
static PetscErrorCode AddNearField(DirectSolver d, Mat A) {
  const Layout l = d->coupling->bodies->layout;
  PetscReal *C;
  PetscFunctionBeginUser;
  if (!d->coupling->near) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(PetscSqr(2 * l->M), &C));
  PetscCall(NearFieldAdd(d->coupling->near, PetscSqr(d->fluid->grid->h), PETSC_TRUE, 0, l->M, C));
  for (PetscInt i = 2 * l->first; i < 2 * (l->first + l->n); i++) /* a row's columns in order */
    for (PetscInt j = 0; j < 2 * l->M; j++) PetscCall(AddNonzero(A, RowOf(d, i), FirstF(d) + j, C[j * 2 * l->M + i]));
  PetscCall(PetscFree(C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* h^2 beta N N^T F in the own obstacles' rows. */
static PetscErrorCode AddPressure(DirectSolver d, Mat A) {
  const Obstacles o = d->coupling->bodies->obstacles;
  const PetscReal h2 = PetscSqr(d->fluid->grid->h);
  PetscFunctionBeginUser;
  for (PetscInt b = o ? o->layout->own : 0; o && b < o->layout->end; b++)
    for (PetscInt i = 2 * o->layout->start[b]; i < 2 * o->layout->start[b + 1]; i++)
      for (PetscInt j = 2 * o->layout->start[b]; j < 2 * o->layout->start[b + 1]; j++)
        PetscCall(AddNonzero(A, RowOf(d, 2 * d->M + i), FirstF(d) + 2 * d->M + j, h2 * o->beta * o->N[i] * o->N[j]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sigma, U, F, J and areas are the last rank's rows: it adds E, and every owner its vesicles. */
static PetscErrorCode AddBodies(DirectSolver d, Mat A) {
  const Grid g = d->fluid->grid;
  const Layout l = d->coupling->membrane->layout;
  const PetscInt sigma = FirstSigma(d), U = FirstU(d), F = FirstF(d);
  PetscFunctionBeginUser;
  if (g->rank == g->size - 1) PetscCall(AddInterpolation(d, A, NULL));
  if (g->rank == g->size - 1) PetscCall(AddSprings(d, A, U, F));
  for (PetscInt v = l->own; v < l->end; v++) PetscCall(AddVesicle(d, A, v, sigma, U, F));
  PetscCall(AddNearField(d, A));
  PetscCall(AddPressure(d, A));
  PetscCall(DirectAddArea(d, A, U));
  if (d->source) PetscCall(DirectAddContrast(d, A, U, FirstJ(d)));
  if (d->source && g->rank == g->size - 1) PetscCall(DirectContrastMean(d, A, FirstJ(d)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define FEW 24 /* entries of a row of the fluid */

/* An empty matrix with room for its rows: those of sigma, U, F and g, the last rank's, are coupled to all of their
   vesicle by spectral derivatives, U to all F by the near field. */
static PetscErrorCode CreateMatrix(DirectSolver d, Mat *A) {
  const Grid g = d->fluid->grid;
  const Layout l = d->coupling->membrane->layout;
  const PetscInt n = d->start[g->rank + 1] - d->start[g->rank];
  PetscInt *room, longest = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &room));
  for (PetscInt k = 0; k < n; k++) room[k] = FEW;
  for (PetscInt v = 0; v < l->bodies; v++) longest = PetscMax(longest, LayoutCount(l, v));
  for (PetscInt k = n - Others(d); k < n && g->rank == g->size - 1; k++) {
    const PetscInt row = k - n + Others(d), bodies = 2 * (d->M + d->W);
    const PetscBool U = (row >= d->M && row < 3 * d->M) || row >= 5 * d->M ? PETSC_TRUE : PETSC_FALSE;
    room[k] = 4 * FEW + 3 * longest + (U && d->coupling->near ? bodies + (d->source ? 4 * d->M : 0) : 0);
    if (k >= n - MeanForces(d)) room[k] = g->n[0] * g->n[1] + 2 * d->M;
  }
  PetscCall(AddInterpolation(d, NULL, room));
  if (d->source) PetscCall(DirectRoom(d, room));
  for (PetscInt k = 0; k < n; k++) room[k] = PetscMin(n, room[k]);
  PetscCall(MatCreateAIJ(g->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, 0, room, FEW, NULL, A));
  PetscCall(PetscFree(room));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Assemble(DirectSolver d, Mat *A) {
  PetscFunctionBeginUser;
  PetscCall(CreateMatrix(d, A));
  PetscCall(MatSetOption(*A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(AddFluid(d, *A));
  PetscCall(AddMean(d, *A));
  PetscCall(AddBodies(d, *A));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion that is known: -B of it to k; its dipoles to f and the source, and the mean velocity that goes with them.
 */
static PetscErrorCode KnownMotion(DirectSolver d, const CoupledProblem *q) {
  PetscScalar *k;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(q->k, &k));
  PetscCall(ContrastKnownAdd(d->coupling, -1, q->moved, k));
  PetscCall(VecRestoreArray(q->k, &k));
  PetscCall(DoubleLayerSpread(d->coupling->contrast, q->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RightHandSide(DirectSolver d, const CoupledProblem *q) {
  const Grid g = d->fluid->grid;
  const PetscInt nw = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V],
                 np = g->columns[FIELD_P] * g->rows[FIELD_P];
  const PetscScalar *a;
  PetscScalar *b;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(q->k, &b));
  PetscCall(CouplingNearField(d->coupling, -1, q->F, b));
  PetscCall(VecRestoreArray(q->k, &b));
  if (d->source) PetscCall(KnownMotion(d, q));
  PetscCall(VecSet(d->b, 0));
  PetscCall(VecGetArray(d->b, &b));
  PetscCall(VecGetArrayRead(q->f->values, &a));
  PetscCall(PetscArraycpy(b, a, nw));
  PetscCall(VecRestoreArrayRead(q->f->values, &a));
  if (d->fluid->bc2) {
    PetscCall(VecGetArrayRead(d->fluid->bc2, &a));
    for (PetscInt k = 0; k < np; k++) b[nw + k] = -a[k];
    PetscCall(VecRestoreArrayRead(d->fluid->bc2, &a));
  }
  if (d->source) {
    PetscCall(VecGetArrayRead(q->f->source, &a));
    PetscCall(PetscArraycpy(b + nw, a, np));
    PetscCall(VecRestoreArrayRead(q->f->source, &a));
    for (PetscInt f = 0; f < MeanForces(d) && g->rank == g->size - 1; f++)
      b[FirstMean(d) + f - d->start[g->rank]] = q->f->mean[f] * g->n[0] * g->n[1];
  }
  PetscCall(LayoutGatherVec(d->coupling->membrane->layout, q->g, d->all));
  if (g->rank == g->size - 1) PetscCall(PetscArraycpy(b + nw + np, d->all, d->M));
  PetscCall(VecGetArrayRead(q->k, &a));
  PetscCall(LayoutGather(d->coupling->bodies->layout, 2, a, d->all));
  PetscCall(VecRestoreArrayRead(q->k, &a));
  for (PetscInt k = 0; k < 2 * (d->M + d->W) && g->rank == g->size - 1; k++)
    b[RowOf(d, k) - d->start[g->rank]] = d->all[k];
  PetscCall(VecRestoreArray(d->b, &b));
  PetscCall(DirectAreaTarget(d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyPart(Vec to, const PetscScalar from[], PetscInt n) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(to, &a));
  PetscCall(PetscArraycpy(a, from, n));
  PetscCall(VecRestoreArray(to, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last rank's part of the solution x from index `first` on, `each` numbers a marker, to the owners in a layout. */
static PetscErrorCode FromLastRank(DirectSolver d, Layout l, int each, PetscInt first, const PetscScalar x[], Vec to) {
  const Grid g = d->fluid->grid;
  PetscScalar *own;
  PetscFunctionBeginUser;
  if (g->rank == g->size - 1) PetscCall(PetscArraycpy(d->all, x + first - d->start[g->rank], each * l->M));
  PetscCall(VecGetArray(to, &own));
  PetscCall(LayoutFromRank(l, g->size - 1, each, d->all, own));
  PetscCall(VecRestoreArray(to, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pivoting in a saddle-point matrix needs more room than MUMPS expects: four times, ICNTL(14) in per cent. */
static PetscErrorCode SetUpFactor(DirectSolver d) {
  PC pc;
  Mat F;
  PetscBool lu;
  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(d->ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  if (!lu) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(MatMumpsSetIcntl(F, 14, 300));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DirectSolverSolve(DirectSolver d, const CoupledProblem *q) {
  const Grid g = d->fluid->grid;
  const Layout l = d->coupling->membrane->layout;
  const PetscInt nw = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V],
                 np = g->columns[FIELD_P] * g->rows[FIELD_P];
  const PetscScalar *x;
  PetscScalar mean;
  Mat A;
  PetscFunctionBeginUser;
  PetscCall(Assemble(d, &A));
  PetscCall(DirectFactors(d, 0, d->b));
  PetscCall(DirectFactors(d, 1, d->x));
  PetscCall(MatDiagonalScale(A, d->b, d->x));
  PetscCall(KSPReset(d->ksp)); /* a new factor, which keeps the settings made on it below */
  PetscCall(KSPSetOperators(d->ksp, A, A));
  PetscCall(MatDestroy(&A)); /* the KSP keeps it */
  PetscCall(SetUpFactor(d));
  PetscCall(RightHandSide(d, q));
  PetscCall(DirectFactors(d, 0, d->x));
  PetscCall(VecPointwiseMult(d->b, d->b, d->x));
  PetscCall(KSPSolve(d->ksp, d->b, d->x));
  PetscCall(DirectFactors(d, 1, d->b));
  PetscCall(VecPointwiseMult(d->x, d->x, d->b));
  PetscCall(KSPGetConvergedReason(d->ksp, &d->why));
  if (d->why < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(d->x, &x));
  PetscCall(CopyPart(q->w, x, nw));
  PetscCall(CopyPart(q->p, x + nw, np));
  PetscCall(VecSum(q->p, &mean));
  PetscCall(VecShift(q->p, -mean / ((PetscReal)g->n[0] * g->n[1])));
  PetscCall(FromLastRank(d, l, 1, FirstSigma(d), x, q->sigma));
  PetscCall(FromLastRank(d, l, 2, FirstU(d), x, q->V));
  if (q->solid) {
    PetscCall(FromLastRank(d, d->coupling->bodies->obstacles->layout, 2, FirstF(d) + 2 * d->M, x, q->solid));
    PetscCall(VecScale(q->solid, PetscSqr(g->h)));
  }
  PetscCall(VecRestoreArrayRead(d->x, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
