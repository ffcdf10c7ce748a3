#include "curve/crossing.h"

#define ALIKE 1e-10 /* over the longest edge: edges whose middles are so near to one another cross, or are one edge */
#define CROSSING_FINER 8 /* times as many points where polygons of smooth curves cross */

/* Points sorted into cells at least `reach` wide. The points of cell c are point[first[c]] .. point[first[c + 1] - 1],
   in order, at the positions x. */
typedef struct {
  PetscInt cells[2], *first, *point;
  PetscReal *x, low[2], width[2];
  const PetscReal *period;
} CellList;

static PetscInt CellListAlong(const CellList *c, int dir, PetscReal x) {
  const PetscReal at = PetscFloorReal((x - c->low[dir]) / c->width[dir]);
  const PetscInt cells = c->cells[dir];
  if (c->period[dir] > 0) return (PetscInt)(at - cells * PetscFloorReal(at / cells));
  return PetscMax(0, PetscMin(cells - 1, (PetscInt)at));
}

static PetscInt CellListCell(const CellList *c, const PetscReal x[2]) {
  return CellListAlong(c, 1, x[1]) * c->cells[0] + CellListAlong(c, 0, x[0]);
}

static PetscErrorCode CellListCreate(PetscInt n, const PetscReal X[], PetscReal reach, CellList *c) {
  PetscInt *cell;
  PetscReal around[4] = CURVE_NOWHERE;
  PetscFunctionBeginUser;
  CurveBounds(n, X, around);
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal low = around[2 * dir], high = around[2 * dir + 1];
    const PetscReal extent = c->period[dir] > 0 ? c->period[dir] : PetscMax(high - low, reach);
    const PetscReal most = PetscCeilReal(PetscSqrtReal(4. * n)); /* a few cells a point in all */
    c->cells[dir] = (PetscInt)PetscMax(1, PetscMin(most, PetscFloorReal(extent / reach)));
    c->low[dir] = low;
    c->width[dir] = extent / c->cells[dir];
  }
  const PetscInt cells = c->cells[0] * c->cells[1];
  PetscCall(PetscCalloc1(cells + 2, &c->first));
  PetscCall(PetscMalloc2(n, &c->point, 2 * n, &c->x));
  PetscCall(PetscMalloc1(n, &cell));
  for (PetscInt k = 0; k < n; k++) c->first[(cell[k] = CellListCell(c, X + 2 * k)) + 2]++;
  for (PetscInt k = 0; k < cells; k++) c->first[k + 2] += c->first[k + 1];
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at =
        c->first[cell[k] + 1]++; /* first[c + 1] grows from the first place of cell c to that of cell c + 1 */
    c->point[at] = k;
    for (int dir = 0; dir < 2; dir++) c->x[2 * at + dir] = X[2 * k + dir];
  }
  PetscCall(PetscFree(cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CellListDestroy(CellList *c) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(c->first));
  PetscCall(PetscFree2(c->point, c->x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int CellsAround(PetscBool periodic, PetscInt cells, PetscInt cell, PetscInt around[3]) {
  int count = 0;
  for (PetscInt k = cell - 1; k <= cell + 1; k++)
    if ((k >= 0 && k < cells) || (periodic && cells >= 3)) around[count++] = (k + cells) % cells;
  return count;
}

/* d = vector from a to the nearest image of b. */
static void CrossingNearestImage(const PetscReal period[2], const PetscReal a[2], const PetscReal b[2],
                                 PetscReal d[2]) {
  for (int dir = 0; dir < 2; dir++) {
    d[dir] = b[dir] - a[dir];
    if (period[dir] > 0) d[dir] -= period[dir] * PetscFloorReal(d[dir] / period[dir] + 0.5);
  }
}

PetscErrorCode PairsWithin(PetscInt n, const PetscReal X[], const PetscInt part[2], const PetscReal period[2],
                           PetscReal reach, PairFound found, void *context) {
  CellList c = {.period = period};
  PetscInt around[2][3];
  const PetscInt begin = part ? part[0] : 0, end = part ? part[1] : n;
  PetscBool done = n < 2 || begin >= end || reach <= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CellListCreate(n, X, reach, &c));
  for (PetscInt i = begin; i < end && !done; i++) {
    int count[2];
    for (int d = 0; d < 2; d++)
      count[d] = CellsAround(period[d] > 0, c.cells[d], CellListAlong(&c, d, X[2 * i + d]), around[d]);
    for (int k = 0; k < count[0] * count[1] && !done; k++) {
      const PetscInt cell = around[1][k / count[0]] * c.cells[0] + around[0][k % count[0]];
      for (PetscInt at = c.first[cell]; at < c.first[cell + 1] && !done; at++) {
        PetscReal d[2];
        if (c.point[at] <= i) continue;
        CrossingNearestImage(period, X + 2 * i, c.x + 2 * at, d);
        if (d[0] * d[0] + d[1] * d[1] < reach * reach) done = found(context, i, c.point[at], d);
      }
    }
  }
  PetscCall(CellListDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A search for edges by their middles: edges that cross have middles no farther apart than the longest edge is long. */
typedef struct {
  const CurveSet *set;
  PetscInt *curve;       /* [points] the curve that a point is on */
  PetscReal *middle;     /* [points][2] middles of the edges */
  PetscReal longest;     /* length of the longest edge */
  PetscInt (*passed)[2]; /* [count] pairs of curves that do not cross although their polygons do */
  PetscInt count;
  size_t capacity;
  PetscInt pair[2]; /* the first pair of curves that cross */
  PetscErrorCode error;
} EdgeSearch;

/* Twice the area of the triangle a, b, c. */
static PetscReal TriangleArea(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2]) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Find out whether two curves cross whose polygons do; smooth curves are compared at CROSSING_FINER times their points.
   The pair becomes s->pair or is added to s->passed. */
static PetscErrorCode CurvesCrossTruly(EdgeSearch *s, const PetscInt pair[2], PetscBool *cross) {
  CurveFine fine;
  PetscInt found[2];
  PetscFunctionBeginUser;
  *cross = PETSC_FALSE;
  for (PetscInt k = 0; k < s->count; k++)
    if (pair[0] == s->passed[k][0] && pair[1] == s->passed[k][1]) PetscFunctionReturn(PETSC_SUCCESS);
  *cross = PETSC_TRUE;
  if (s->set->smooth) {
    PetscCall(CurveFineCreate(s->set, pair[0] == pair[1] ? 1 : 2, pair, CROSSING_FINER, &fine));
    PetscCall(CurvesCross(&fine.set, found));
    *cross = found[0] < 0 ? PETSC_FALSE : PETSC_TRUE;
    PetscCall(CurveFineDestroy(&fine));
  }
  PetscCall(ArrayReserve((size_t)(s->count + 1), &s->capacity, &s->passed));
  PetscCall(PetscArraycpy(*cross ? s->pair : s->passed[s->count++], pair, 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool EdgesCross(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  EdgeSearch *s = (EdgeSearch *)context;
  const PetscReal *X = s->set->X, *a = X + 2 * i;
  const PetscInt pair[2] = {s->curve[i], s->curve[j]}, *start = s->set->start + pair[0];
  PetscReal b[2], p[2], q[2];
  PetscBool cross;
  if (pair[0] == pair[1] && (j == i + 1 || j == i + start[1] - start[0] - 1)) return PETSC_FALSE; /* neighbours */
  if (!CurveSetWalk(s->set, pair[0], i, 1, b) || !CurveSetWalk(s->set, pair[1], j, 1, q)) return PETSC_FALSE;
  for (int dir = 0; dir < 2; dir++) { /* the image of edge j that is nearest to edge i */
    const PetscReal shift = s->middle[2 * i + dir] + d[dir] - s->middle[2 * j + dir];
    p[dir] = X[2 * j + dir] + shift;
    q[dir] += shift;
  }
  const PetscBool alike = PetscHypotReal(d[0], d[1]) <= ALIKE * s->longest ? PETSC_TRUE : PETSC_FALSE;
  if (!alike &&
      (TriangleArea(a, b, p) * TriangleArea(a, b, q) >= 0 || TriangleArea(p, q, a) * TriangleArea(p, q, b) >= 0))
    return PETSC_FALSE;
  s->error = CurvesCrossTruly(s, pair, &cross);
  return s->error || cross ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode CurvesCross(const CurveSet *set, PetscInt pair[2]) {
  const PetscInt *start = set->start, *part = set->part, n = start[set->curves];
  const PetscInt points[2] = {part ? start[part[0]] : 0, part ? start[part[1]] : n};
  const PetscReal *X = set->X;
  EdgeSearch s = {.set = set, .longest = CurveLongestEdge(set), .pair = {-1, -1}};
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &s.curve, 2 * n, &s.middle));
  for (PetscInt v = 0; v < set->curves; v++)
    for (PetscInt k = start[v]; k < start[v + 1]; k++) {
      PetscReal end[2];
      s.curve[k] = v;
      if (!CurveSetWalk(set, v, k, 1, end)) PetscCall(PetscArraycpy(end, X + 2 * k, 2));
      for (int dir = 0; dir < 2; dir++) s.middle[2 * k + dir] = 0.5 * (X[2 * k + dir] + end[dir]);
    }
  PetscCall(PairsWithin(n, s.middle, points, set->period, s.longest, EdgesCross, &s));
  PetscCall(s.error);
  PetscCall(PetscFree2(s.curve, s.middle));
  PetscCall(PetscFree(s.passed));
  PetscCall(PetscArraycpy(pair, s.pair, 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}
