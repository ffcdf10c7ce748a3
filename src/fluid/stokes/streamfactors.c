/* Rows of a slab of m rows without right-hand side turn Y = y below them into Y_j = M^{j+1} y, so that
       gain = SUM_j M^j (1, 1)^T (0, 1) M^{j+1},
   and of a slab on top of another, gain = gain_1 + M^{m_1} gain_2 M^{m_1}. All terms are positive: nothing cancels. */
#include "fluid/stokes/streamfactors.h"
#include "fluid/transforms/tridiagonal.h"

#define NEGLIGIBLE 50. /* a mode that has decayed by e^-50 = 2e-22 is zero to rounding */

typedef struct {
  PetscReal a[2][2];
} Pair;

/* A slab: M^m and its gain. */
typedef struct {
  Pair power, gain;
} Slab;

static Pair PairTimes(Pair A, Pair B) {
  Pair C;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) C.a[i][j] = A.a[i][0] * B.a[0][j] + A.a[i][1] * B.a[1][j];
  return C;
}
/* A + factor B */
static Pair Plus(Pair A, PetscReal factor, Pair B) {
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) A.a[i][j] += factor * B.a[i][j];
  return A;
}
static Pair PairInverse(Pair A) {
  const PetscReal d = A.a[0][0] * A.a[1][1] - A.a[0][1] * A.a[1][0];
  return (Pair){{{A.a[1][1] / d, -A.a[0][1] / d}, {-A.a[1][0] / d, A.a[0][0] / d}}};
}
static const Pair unit = {{{1, 0}, {0, 1}}};

static Slab Stack(Slab low, Slab high) {
  return (Slab){.power = PairTimes(high.power, low.power),
                .gain = Plus(low.gain, 1, PairTimes(low.power, PairTimes(high.gain, low.power)))};
}

/* M^m and the gain of a slab of m rows, by doubling. */
static Slab OfRows(PetscReal r1, PetscReal r2, PetscInt m) {
  Slab all = {.power = unit}, next = {.power = {{{r1, 0}, {r1, r2}}}, .gain = {{{r1, r2}, {r1, r2}}}};
  for (; m > 0; m /= 2) {
    if (m % 2) all = Stack(all, next);
    next = Stack(next, next);
  }
  return all;
}

/* Walls, on which chi = 0, and chi is even: chi_{-1} = 0 and chi_{-2} = chi_0. Put into the recurrences,
       y1_{-1} = -r1 z1_0 - r2 (2 + r1 r2) z2_0,   y2_{-1} = -r1 z1_0 - r2 z2_0:             Y = B Z_0,
       z1_n = -r2/(1 + r1 r2) y2_{n-1},            z2_n = 0                        above:    Z = T Y_{n-1}.
   Z_0 itself grows with Y: Z_0 = W + D Y, W being Z_0 for Y = 0, D = gain + M^n T M^n. So Y = B (1 - D B)^-1 W. */
static void Walls(PetscReal r1, PetscReal r2, Slab all, Pair *bottom, Pair *top) {
  const Pair B = {{{-r1, -r2 * (2 + r1 * r2)}, {-r1, -r2}}};
  *top = (Pair){{{0, -r2 / (1 + r1 * r2)}, {0, 0}}};
  const Pair D = Plus(all.gain, 1, PairTimes(all.power, PairTimes(*top, all.power)));
  *bottom = PairTimes(B, PairInverse(Plus(unit, -1, PairTimes(D, B))));
}

static void Store(StreamFactors s, PetscInt k, Pair from, PairMatrix to) {
  for (int i = 0; i < 4; i++) to[i * s->width + k] = from.a[i / 2][i % 2];
}

/* Set the constants of mode k. At the seam of a period Y below the first row is what leaves the last row,
   (1 - M^n)^-1 times what leaves it when nothing comes in; so is Z above the last row. */
static void SetMode(StreamFactors s, PetscInt k, PetscReal theta_1, PetscReal theta_2) {
  const PetscInt n = s->grid->all_rows[FIELD_V], full = s->grid->block;
  const PetscReal r1 = PetscExpReal(-theta_1), r2 = PetscExpReal(-theta_2);
  const Slab all = OfRows(r1, r2, n);
  Pair bottom, top;
  s->r[0][k] = r1;
  s->r[1][k] = r2;
  for (int last = 0; last < 2; last++) {
    const Slab slab = OfRows(r1, r2, last ? n - (s->grid->size - 1) * full : full);
    Store(s, k, slab.power, s->power[last]);
    Store(s, k, slab.gain, s->gain[last]);
  }
  if (s->grid->wall[1])
    Walls(r1, r2, all, &bottom, &top);
  else
    bottom = top = PairInverse((Pair){{{-expm1(-n * theta_1), 0}, {-all.power.a[1][0], -expm1(-n * theta_2)}}});
  Store(s, k, bottom, s->bottom);
  Store(s, k, top, s->top);
}

void StreamFactorsSet(StreamFactors s, PetscReal alpha, PetscReal nu) {
  const PetscReal h2 = PetscSqr(s->grid->h);
  s->alpha = alpha;
  for (PetscInt k = s->grid->wall[0] ? 0 : 2; k < s->modes; k++) { /* where x is periodic mode 0 is the mean flow */
    const PetscReal theta_1 = 2 * asinh(0.5 * PetscSqrtReal(s->lambda[k]));
    const PetscReal theta_2 = 2 * asinh(0.5 * PetscSqrtReal(s->lambda[k] + alpha * h2 / nu));
    SetMode(s, k, theta_1, theta_2);
    s->factor[k] = s->scale[k] * s->r[0][k] * s->r[1][k] * h2 / nu;
  }
  TridiagonalReach(s->width, s->r[0], NEGLIGIBLE, s->grid->n[1], s->reach); /* r1 is the slower decay */
}

PetscErrorCode StreamFactorsCreate(Grid g, RowTransform t, StreamFactors *out) {
  const PetscInt w = (t->width + TRIDIAGONAL_BLOCK - 1) / TRIDIAGONAL_BLOCK * TRIDIAGONAL_BLOCK;
  StreamFactors s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = g;
  s->modes = t->width;
  s->width = w;
  s->lambda = t->lambda;
  s->scale = t->scale;
  s->alpha = -1;
  PetscCall(PetscCalloc4(w, &s->r[0], w, &s->r[1], w, &s->factor, w / TRIDIAGONAL_BLOCK, &s->reach));
  PetscCall(PetscCalloc6(4 * w, &s->power[0], 4 * w, &s->power[1], 4 * w, &s->gain[0], 4 * w, &s->gain[1], 4 * w,
                         &s->bottom, 4 * w, &s->top));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamFactorsDestroy(StreamFactors *factors) {
  StreamFactors s = *factors;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(s->r[0], s->r[1], s->factor, s->reach));
  PetscCall(PetscFree6(s->power[0], s->power[1], s->gain[0], s->gain[1], s->bottom, s->top));
  PetscCall(PetscFree(*factors));
  PetscFunctionReturn(PETSC_SUCCESS);
}
