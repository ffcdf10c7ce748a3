/* B mode by mode: the response of chi's mode k to a curl of 1 in row j' is g(|j - j'|) without walls in y and, between
   them, with what makes chi = 0 there and chi even about them (stream.c). With the matrix M of stream.c, t1(m)
   and t2(m) the second row of M^m, s = -1, 1 for a pair of sources that mirror one another in y,

       g(m) = G1 t1(m) + G2 t2(m),   G1 = 1/((1 - r1^2)(1 - r1 r2)),   G2 = (1 + r1 r2) G1/(1 - r2^2),
       chi_j = f_j + A1 p1(j) + A2 p2(j),   f_j = g(|j - j'|) + s g(|j - n + 1 + j'|),   p(j) = t(j + 1) + s t(n - j),

   and A from chi_{-1} = 0, chi_{-2} = chi_0. The sum of g over all modes is made once for each distance. */
#include "fluid/stokes/sidewalls.h"
#include "numerics/blas.h"

#define NEGLIGIBLE 1e-19 /* of the largest entry */

PetscErrorCode SideWallsCreate(Grid g, RowTransform t, ModeFactors factors, SideWalls *out) {
  const PetscInt w = factors->width, n = g->all_rows[FIELD_V], half = (n + 1) / 2;
  PetscReal *norm;
  SideWalls s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = g;
  s->factors = factors;
  s->alpha = -1;
  s->faces = n;
  s->half = half;
  PetscCall(PetscCalloc5(w, &s->curl[0], w, &s->curl[1], w, &s->velocity[0], w, &s->velocity[1], w, &s->even));
  PetscCall(PetscMalloc3(2 * n, &s->v[0], 2 * n, &s->d[0], 2 * half, &s->work));
  s->v[1] = s->v[0] + n;
  s->d[1] = s->d[0] + n;
  PetscCall(RowTransformEnds(t, s->curl[0], s->curl[1]));
  for (PetscInt k = 0; k < t->width; k++) s->curl[0][k] *= -1; /* v_{i+1} - v_i at the nodes next to the walls */
  PetscCall(PetscMalloc1(t->width, &norm));
  PetscCall(RowTransformNorms(t, norm));
  for (PetscInt k = 0; k < t->width; k++) {
    for (int side = 0; side < 2; side++) s->velocity[side][k] = norm[k] * t->scale[k] * s->curl[side][k];
    s->even[k] = s->curl[0][k] * s->curl[1][k] < 0;
  }
  PetscCall(PetscFree(norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SideWallsDestroy(SideWalls *walls) {
  SideWalls s = *walls;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (int q = 0; q < SIDE_SYMMETRIES; q++) PetscCall(PetscFree(s->inverse[q]));
  PetscCall(PetscFree5(s->curl[0], s->curl[1], s->velocity[0], s->velocity[1], s->even));
  PetscCall(PetscFree3(s->v[0], s->d[0], s->work));
  PetscCall(PetscFree(*walls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One mode's decays, and t1, t2 from m = -1 on; `reach`: rows after which they are negligible. */
typedef struct {
  PetscReal G[2], *t[2];
  PetscInt n, reach;
} ModeDecays;

static void SetDecays(PetscReal theta_1, PetscReal theta_2, ModeDecays *m) {
  const PetscReal r1 = PetscExpReal(-theta_1), r2 = PetscExpReal(-theta_2), both = -expm1(-theta_1 - theta_2);
  PetscReal power = 1;
  m->G[0] = 1 / (-expm1(-2 * theta_1) * both);
  m->G[1] = (1 + r1 * r2) * m->G[0] / -expm1(-2 * theta_2);
  m->t[0][-1] = -1 / r2;
  m->t[1][-1] = 1 / r2;
  m->t[0][0] = 0;
  m->t[1][0] = 1;
  m->reach = m->n + 3;
  for (PetscInt k = 1; k < m->n + 3; k++) {
    const PetscBool near = m->reach > k;
    power *= r1;
    m->t[0][k] = near ? power + r2 * m->t[0][k - 1] : 0;
    m->t[1][k] = near ? r2 * m->t[1][k - 1] : 0;
    if (near && m->t[0][k] < NEGLIGIBLE * m->t[0][1]) m->reach = k;
  }
}

static PetscReal Free(const ModeDecays *m, PetscInt distance) {
  return m->G[0] * m->t[0][distance] + m->G[1] * m->t[1][distance];
}

/* A of sources in row j' and, times s, in its mirror image. */
static void WallTerms(const ModeDecays *m, PetscReal s, PetscInt j, PetscReal A[2]) {
  const PetscInt n = m->n;
  const PetscReal on = Free(m, j + 1) + s * Free(m, n - j);
  const PetscReal bend = Free(m, j + 2) + s * Free(m, n + 1 - j) - Free(m, j) - s * Free(m, n - 1 - j);
  PetscReal at[2], odd[2];
  for (int q = 0; q < 2; q++) { /* rows -1; -2 less 0 */
    at[q] = m->t[q][0] + s * m->t[q][n + 1];
    odd[q] = m->t[q][-1] + s * m->t[q][n + 2] - m->t[q][1] - s * m->t[q][n];
  }
  const PetscReal determinant = at[0] * odd[1] - at[1] * odd[0];
  A[0] = (at[1] * bend - odd[1] * on) / determinant;
  A[1] = (odd[0] * on - at[0] * bend) / determinant;
}

/* The walls' part of one mode, weighed, for both mirror symmetries; p: [2][half] work. */
static void AddWalls(SideWalls s, const ModeDecays *m, PetscReal weight, PetscReal *const B[2], PetscReal p[]) {
  const PetscInt half = s->half, reach = PetscMin(half, m->reach);
  for (int symmetry = 0; symmetry < 2; symmetry++) {
    const PetscReal sign = symmetry ? -1 : 1;
    for (int q = 0; q < 2; q++)
      for (PetscInt j = 0; j < reach; j++) p[q * half + j] = m->t[q][j + 1] + sign * m->t[q][m->n - j];
    for (PetscInt b = 0; b < reach; b++) {
      PetscReal A[2], *restrict to = B[symmetry] + b * half;
      const PetscReal *restrict p1 = p, *restrict p2 = p + half;
      WallTerms(m, sign, b, A);
      const PetscReal a1 = weight * A[0], a2 = weight * A[1];
      for (PetscInt a = 0; a < reach; a++) to[a] += a1 * p1[a] + a2 * p2[a];
    }
  }
}

/* B of one parity in x to its two blocks, columns contiguous: by rows up to the middle of a pair of mirrored forces. */
static PetscErrorCode SideWallsFill(SideWalls s, PetscInt even, PetscReal alpha, PetscReal nu, PetscReal *const B[2]) {
  const PetscInt n = s->faces, half = s->half;
  const PetscReal h2 = PetscSqr(s->grid->h);
  PetscReal *sum, *t, *p;
  ModeDecays m = {.n = n};
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n, &sum, 2 * (n + 4), &t, 2 * half, &p));
  for (int q = 0; q < 2; q++) {
    m.t[q] = t + q * (n + 4) + 1;
    PetscCall(PetscArrayzero(B[q], half * half));
  }
  for (PetscInt k = 0; k < s->factors->modes; k++) {
    const PetscReal lambda = s->factors->lambda[k];
    if (s->even[k] != even) continue;
    SetDecays(ModeTheta(lambda), ModeTheta(lambda + alpha * h2 / nu), &m);
    const PetscReal weight = 2 * s->velocity[0][k] * s->curl[0][k] * s->factors->factor[k]; /* 2: of both walls */
    for (PetscInt d = 0; d < PetscMin(n, m.reach); d++) sum[d] += weight * Free(&m, d);
    AddWalls(s, &m, weight, B, p);
  }
  for (int symmetry = 0; symmetry < 2; symmetry++)
    for (PetscInt b = 0; b < half; b++)
      for (PetscInt a = 0; a < half; a++)
        B[symmetry][b * half + a] += sum[PetscAbsInt(a - b)] + (symmetry ? -1 : 1) * sum[n - 1 - a - b];
  PetscCall(PetscFree3(sum, t, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A := (1 + c A)^-1, A symmetric of size n, 1 + c A positive definite. */
static PetscErrorCode Invert(PetscInt n, PetscReal c, PetscReal A[]) {
  PetscBLASInt size, info;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  for (PetscInt k = 0; k < n * n; k++) A[k] = c * A[k] + (k % (n + 1) ? 0 : 1);
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &size, A, &size, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_PLIB, "walls' forces: LAPACK says %d", (int)info);
  PetscCallBLAS("LAPACKpotri", LAPACKpotri_("L", &size, A, &size, &info));
  for (PetscInt j = 0; j < n; j++) /* the triangle that it leaves */
    for (PetscInt i = j + 1; i < n; i++) A[i * n + j] = A[j * n + i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row j's numbers are taken times this, by which the systems are symmetric: the middle one is its own mirror image. */
static PetscReal RowFactor(SideWalls s, PetscInt j) {
  return 2 * j + 1 == s->faces ? 1 / PETSC_SQRT2 : 1;
}

PetscErrorCode SideWallsSet(SideWalls s, PetscReal alpha, PetscReal nu) {
  const PetscReal c = 2 * nu / PetscSqr(s->grid->h), middle = RowFactor(s, s->half - 1);
  const PetscInt half = s->half;
  PetscFunctionBeginUser;
  if (s->alpha == alpha) PetscFunctionReturn(PETSC_SUCCESS);
  s->alpha = alpha;
  for (int q = 0; q < SIDE_SYMMETRIES && !s->inverse[q]; q++) PetscCall(PetscMalloc1(half * half, &s->inverse[q]));
  for (PetscInt even = 0; even < 2; even++) PetscCall(SideWallsFill(s, even, alpha, nu, &s->inverse[2 * even]));
  for (int q = 0; q < SIDE_SYMMETRIES; q++) {
    PetscReal *last = s->inverse[q] + (half - 1) * half;
    for (PetscInt a = 0; a < half; a++) last[a] *= middle;
    for (PetscInt b = 0; b < half; b++) s->inverse[q][b * half + half - 1] *= middle;
    PetscCall(Invert(half, c, s->inverse[q]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sum the arrays of both walls over the ranks. Each entry is zero on all ranks but one, so that all ranks get the same
   bits. */
static PetscErrorCode Share(SideWalls s, PetscReal faces[]) {
  PetscFunctionBeginUser;
  if (s->grid->size > 1)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, faces, (PetscMPIInt)(2 * s->faces), MPIU_REAL, MPI_SUM, s->grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each rank finds a part of the forces, and those in their mirror images. */
PetscErrorCode SideWallsForces(SideWalls s, PetscReal nu) {
  const PetscInt n = s->faces, half = s->half, first = s->grid->first, above = first + s->grid->rows[FIELD_V];
  const PetscInt begin = half * s->grid->rank / s->grid->size, end = half * (s->grid->rank + 1) / s->grid->size;
  const PetscReal c = 2 * nu / PetscSqr(s->grid->h);
  PetscReal *x = s->work, *y = s->work + half;
  PetscFunctionBeginUser;
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscArrayzero(s->v[side], first));
    PetscCall(PetscArrayzero(s->v[side] + above, n - above));
  }
  PetscCall(Share(s, s->v[0]));
  for (int side = 0; side < 2; side++) PetscCall(PetscArrayzero(s->d[side], n));
  for (int q = 0; q < SIDE_SYMMETRIES; q++) {
    const PetscReal across = q / 2 ? -1 : 1, along = q % 2 ? -1 : 1; /* an even chi moves v up here, down there */
    for (PetscInt j = 0; j < half; j++) {
      const PetscInt m = n - 1 - j;
      x[j] = RowFactor(s, j) / 4 * (s->v[0][j] + across * s->v[1][j] + along * (s->v[0][m] + across * s->v[1][m]));
    }
    PetscCall(PetscArrayzero(y, half));
    PetscCall(
        DenseMultAdd(PETSC_TRUE, half, end - begin, 1, s->inverse[q] + begin * half, x, y + begin)); /* symmetric */
    for (PetscInt j = begin; j < end; j++) {
      const PetscInt m = n - 1 - j;
      const PetscReal d = -c * y[j] / RowFactor(s, j);
      s->d[0][j] += d;
      s->d[1][j] += across * d;
      if (m == j) continue;
      s->d[0][m] += along * d;
      s->d[1][m] += along * across * d;
    }
  }
  PetscCall(Share(s, s->d[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
