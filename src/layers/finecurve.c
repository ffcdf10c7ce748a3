#include "layers/finecurve.h"
#include "numerics/blas.h"
#include "numerics/spectral.h"

#define CLOSE 1.3        /* marker spacings: gaps below it need finer points */
#define CLOSE_AT_WALLS 2 /* of a curve and an image in a wall */
#define FINE 2.5         /* fine points a gap */
#define MOST_FINE 64     /* times the markers */
#define PROBE 4          /* times the markers, for measuring the gap */
#define WINDOW 8         /* marker spacings */

/* A curve at finer points. */
typedef struct {
  const CurveKind *kind; /* borrowed */
  PetscInt n, f;         /* markers, factor */
  PetscReal *weight;     /* closed and spanning: [f n] P by index difference: P_qk = weight[(q - f k) mod f n] */
  PetscReal *x;          /* [f n][2] the points (length) */
  PetscReal edge;        /* the longest distance from one point to the next */
  PetscInt *used;        /* [count] points in use */
  PetscInt count;
  PetscReal *P; /* [n][count] rows of P/f that are in use, columns one after another */
} FineCurve;

static PetscReal Distance2(const PetscReal a[2], const PetscReal b[2]) {
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]);
}

/* A body moved by shift (length), at factor times its markers. */
static PetscErrorCode FineCurveCreate(const LayerSetting *set, PetscInt v, const PetscReal shift[2], PetscInt factor,
                                      FineCurve *c) {
  const Layout l = set->bodies->layout;
  const PetscInt n = LayoutCount(l, v), Q = n * factor;
  PetscFunctionBeginUser;
  *c = (FineCurve){.kind = &set->bodies->kind[v], .n = n, .f = factor};
  PetscCall(PetscMalloc3(Q, &c->weight, 2 * Q, &c->x, Q, &c->used));
  for (PetscInt q = 0; q < Q && c->kind->type != CURVE_OPEN; q++)
    c->weight[q] = TrigonometricCardinal(n, 2 * PETSC_PI * q / Q);
  PetscCall(CurveFinePoints(c->kind, n, set->markers->X + 2 * l->start[v], factor, c->x));
  for (PetscInt q = 0; q < 2 * Q; q++) c->x[q] += shift[q % 2];
  for (PetscInt q = 0; q + 1 < Q; q++) c->edge = PetscMax(c->edge, Distance2(c->x + 2 * q, c->x + 2 * (q + 1)));
  c->edge = PetscSqrtReal(c->edge);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FineCurvesCreate(const LayerSetting *set, const FinePair *p, PetscInt factor, FineCurve *a,
                                       FineCurve *b) {
  const PetscReal none[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(set, p->row, none, factor, a));
  PetscCall(FineCurveCreate(set, p->column, p->shift, factor, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FineCurveDestroy(FineCurve *c) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(c->weight, c->x, c->used));
  PetscCall(PetscFree(c->P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The distance from x to the points of a curve where it is below `least`, which else is returned. Along the curve it
   changes by an edge a point at most: points that cannot be near are left out. */
static PetscReal DistanceBelow(const PetscReal x[2], const FineCurve *c, PetscReal least) {
  PetscInt skip;
  for (PetscInt q = 0; q < c->n * c->f; q += PetscMax(1, skip)) {
    const PetscReal distance = PetscSqrtReal(Distance2(x, c->x + 2 * q));
    least = PetscMin(least, distance);
    skip = (PetscInt)PetscMin((distance - least) / c->edge, c->n * c->f);
  }
  return least;
}

/* The points of a with a point of b in the window, and their rows of P/f. */
static PetscErrorCode FineCurveUse(FineCurve *a, const FineCurve *b, PetscReal window) {
  const PetscInt Q = a->n * a->f;
  PetscReal *weight;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < Q; p++)
    if (DistanceBelow(a->x + 2 * p, b, window) < window) a->used[a->count++] = p;
  PetscCall(PetscMalloc1(a->n * a->count, &a->P));
  if (a->kind->type != CURVE_OPEN) {
    for (PetscInt k = 0; k < a->n; k++)
      for (PetscInt p = 0; p < a->count; p++)
        a->P[k * a->count + p] = a->weight[a->used[p] - a->f * k + (a->used[p] < a->f * k ? Q : 0)] / a->f;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(a->n, &weight));
  for (PetscInt p = 0; p < a->count; p++) {
    CurveOpenWeights(a->n, a->f, a->used[p], weight);
    for (PetscInt k = 0; k < a->n; k++) a->P[k * a->count + p] = weight[k] / a->f;
  }
  PetscCall(PetscFree(weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The larger marker spacing of two bodies. */
static PetscReal FinePairSpacing(const LayerSetting *set, PetscInt v, PetscInt w) {
  return PetscMax(set->bodies->ds[v], set->bodies->ds[w]);
}

FinePair FinePairMake(const LayerSetting *set, PetscInt row, PetscInt column, const PetscReal shift[2], PetscReal gap) {
  const PetscReal ds = FinePairSpacing(set, row, column), times = FINE * ds / PetscMax(gap, FINE * ds / MOST_FINE);
  return (FinePair){.row = row,
                    .column = column,
                    .shift = {shift[0], shift[1]},
                    .wall = -1,
                    .factor = (PetscInt)PetscMin(MOST_FINE, PetscCeilReal(times)),
                    .window = WINDOW * ds};
}

PetscErrorCode FinePairGap(const LayerSetting *set, PetscInt row, PetscInt column, const PetscReal shift[2],
                           PetscReal *gap, PetscBool *close) {
  const FinePair p = {.row = row, .column = column, .shift = {shift[0], shift[1]}};
  const PetscReal ds = FinePairSpacing(set, row, column);
  FineCurve a, b;
  PetscFunctionBeginUser;
  if (*gap <= (CLOSE + 1) * ds) { /* where markers are farther, so are the curves */
    PetscCall(FineCurvesCreate(set, &p, PROBE, &a, &b));
    *gap = PETSC_MAX_REAL;
    for (PetscInt q = 0; q < a.n * a.f; q++) *gap = DistanceBelow(a.x + 2 * q, &b, *gap);
    PetscCall(FineCurveDestroy(&a));
    PetscCall(FineCurveDestroy(&b));
  }
  *close = *gap <= CLOSE * ds;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FinePairsAtWalls(const LayerSetting *set, const NearBounds bounds[], PetscInt row, PetscInt column,
                      const PetscReal shift[2], FinePair pair[4], PetscInt *count) {
  const Grid g = set->markers->grid;
  const CurveKind *kind = set->bodies->kind;
  *count = 0;
  if (g->free || kind[row].type != CURVE_CLOSED || kind[column].type != CURVE_CLOSED) return;
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal gap = WallGap(g, wall, &bounds[row], &bounds[column]);
    if (!g->wall[wall / 2] || gap > CLOSE_AT_WALLS * FinePairSpacing(set, row, column)) continue;
    pair[*count] = FinePairMake(set, row, column, shift, gap);
    pair[(*count)++].wall = wall;
  }
}

/* chi K of the points in use, times a sign, K[parts][count_b][count_a]. */
static void FinePairFill(PetscReal sign, const FinePair *pair, const FineKernel *k, const FineCurve *a,
                         const FineCurve *b, PetscReal K[]) {
  const PetscInt Q = b->n * b->f;
  for (PetscInt q = 0; q < b->count; q++) {
    const PetscReal *y = b->x + 2 * b->used[q];
    PetscReal N[2] = {0, 0};
    for (PetscInt m = 0; m < 2 * b->n && k->normal; m++)
      N[m % 2] += b->weight[((b->used[q] - b->f * (m / 2)) % Q + Q) % Q] * k->normal[m];
    for (PetscInt p = 0; p < a->count; p += LANES) {
      Lanes x[2], value[FINE_PARTS];
      for (PetscInt i = 0; i < 2 * LANES; i++)
        x[i % 2][i / 2] = a->x[2 * a->used[PetscMin(p + i / 2, a->count - 1)] + i % 2];
      k->at(k->context, pair->wall, x, y, N, value);
      for (PetscInt i = 0; i < LANES && p + i < a->count; i++) {
        const PetscReal r = PetscSqrtReal(PetscSqr(x[0][i] - y[0]) + PetscSqr(x[1][i] - y[1]));
        const PetscReal chi = sign * (1 - BoxSmoothStep(r, pair->window / 3, pair->window));
        for (int c = 0; c < k->parts; c++) K[(c * b->count + q) * a->count + p + i] = chi * value[c][i];
      }
    }
  }
}

PetscErrorCode FinePairParts(const LayerSetting *set, const FinePair *pair, const FineKernel *kernel,
                             PetscReal part[]) {
  const Grid g = set->markers->grid;
  const int d = pair->wall / 2;
  PetscReal *K, *half;
  FineCurve a, b;
  PetscFunctionBeginUser;
  for (int fine = 1; fine >= 0; fine--) {
    PetscCall(FineCurvesCreate(set, pair, fine ? pair->factor : 1, &a, &b));
    for (PetscInt q = 0; q < b.n * b.f && pair->wall >= 0; q++)
      b.x[2 * q + d] = 2 * (pair->wall % 2 ? g->hi[d] : g->lo[d]) - b.x[2 * q + d];
    PetscCall(FineCurveUse(&a, &b, pair->window));
    PetscCall(FineCurveUse(&b, &a, pair->window));
    PetscCall(PetscMalloc2(kernel->parts * a.count * b.count, &K, a.n * b.count, &half));
    FinePairFill(fine ? 1 : -1, pair, kernel, &a, &b, K);
    for (int c = 0; c < kernel->parts; c++) { /* P_a^T K P_b */
      const DenseView left = {half, a.n, b.count, a.n}, right = {b.P, b.count, b.n, b.count};
      PetscCall(DenseProduct(PETSC_TRUE, a.n, b.count, a.count, a.P, K + c * a.count * b.count, half));
      PetscCall(DenseProductWithin(PETSC_FALSE, left, right, fine ? 0 : 1, part + c * a.n * b.n, a.n));
    }
    PetscCall(PetscFree2(K, half));
    PetscCall(FineCurveDestroy(&a));
    PetscCall(FineCurveDestroy(&b));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
