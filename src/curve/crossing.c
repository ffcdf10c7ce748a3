#include "curve/crossing.h"

#define FINER 8 /* times the points, where polygons of smooth curves cross */

/* Points sorted into cells at least `reach` wide: those of cell c are point[first[c]] .. point[first[c + 1] - 1], in
   order, and x has their positions. */
typedef struct {
  PetscInt cells[2], *first, *point;
  PetscReal *x, low[2], width[2];
  const PetscReal *period;
} CellList;

static PetscInt CellAlong(const CellList *c, int dir, PetscReal x) {
  const PetscReal at = PetscFloorReal((x - c->low[dir]) / c->width[dir]);
  const PetscInt cells = c->cells[dir];
  if (c->period[dir] > 0) return (PetscInt)(at - cells * PetscFloorReal(at / cells));
  return PetscMax(0, PetscMin(cells - 1, (PetscInt)at));
}

static PetscInt CellOf(const CellList *c, const PetscReal x[2]) {
  return CellAlong(c, 1, x[1]) * c->cells[0] + CellAlong(c, 0, x[0]);
}

static PetscErrorCode CellListCreate(PetscInt n, const PetscReal X[], PetscReal reach, CellList *c) {
  PetscInt *cell;
  PetscFunctionBeginUser;
  for (int dir = 0; dir < 2; dir++) {
    PetscReal low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < n; k++) {
      low = PetscMin(low, X[2 * k + dir]);
      high = PetscMax(high, X[2 * k + dir]);
    }
    const PetscReal extent = c->period[dir] > 0 ? c->period[dir] : PetscMax(high - low, reach);
    const PetscReal most = PetscCeilReal(PetscSqrtReal(4. * n)); /* cells in all: a few a point */
    c->cells[dir] = (PetscInt)PetscMax(1, PetscMin(most, PetscFloorReal(extent / reach)));
    c->low[dir] = low;
    c->width[dir] = extent / c->cells[dir];
  }
  const PetscInt cells = c->cells[0] * c->cells[1];
  PetscCall(PetscCalloc1(cells + 2, &c->first));
  PetscCall(PetscMalloc2(n, &c->point, 2 * n, &c->x));
  PetscCall(PetscMalloc1(n, &cell));
  for (PetscInt k = 0; k < n; k++) c->first[(cell[k] = CellOf(c, X + 2 * k)) + 2]++;
  for (PetscInt k = 0; k < cells; k++) c->first[k + 2] += c->first[k + 1];
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at = c->first[cell[k] + 1]++; /* in the end each has become its own cell's first again */
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

/* Indices of the cells beside and at `cell`, each once. */
static int Around(const CellList *c, int dir, PetscInt cell, PetscInt around[3]) {
  const PetscInt cells = c->cells[dir];
  int count = 0;
  for (PetscInt k = cell - 1; k <= cell + 1; k++) {
    if (c->period[dir] > 0) {
      if (cells >= 3 || (k >= 0 && k < cells)) around[count++] = (k + cells) % cells;
    } else if (k >= 0 && k < cells)
      around[count++] = k;
  }
  return count;
}

/* From a to b, to the nearest image of b. */
static void Apart(const PetscReal period[2], const PetscReal a[2], const PetscReal b[2], PetscReal d[2]) {
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
    const int columns = Around(&c, 0, CellAlong(&c, 0, X[2 * i]), around[0]),
              rows = Around(&c, 1, CellAlong(&c, 1, X[2 * i + 1]), around[1]);
    for (int k = 0; k < columns * rows && !done; k++) {
      const PetscInt cell = around[1][k / columns] * c.cells[0] + around[0][k % columns];
      for (PetscInt at = c.first[cell]; at < c.first[cell + 1] && !done; at++) {
        PetscReal d[2];
        if (c.point[at] <= i) continue;
        Apart(period, X + 2 * i, c.x + 2 * at, d);
        if (d[0] * d[0] + d[1] * d[1] < reach * reach) done = found(context, i, c.point[at], d);
      }
    }
  }
  PetscCall(CellListDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edges by their middles: those that cross have them as near as the longest is long. */
typedef struct {
  const CurveSet *set;
  PetscInt *curve, *next; /* of each point; where its edge ends, */
  PetscReal *end;         /* seen from its start; at the last point of an open curve there */
  PetscReal *middle, longest;
  PetscInt (*passed)[2], count, room; /* pairs of curves that do not cross, whatever their polygons do */
  PetscInt pair[2];                   /* of curves that cross */
  PetscErrorCode error;
} EdgeSearch;

/* Twice the area of the triangle a, b, c. */
static PetscReal Turn(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2]) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Whether two curves cross at FINER times their points. */
static PetscErrorCode FinerCross(const EdgeSearch *s, const PetscInt pair[2], PetscBool *cross) {
  CurveFine fine;
  PetscInt found[2];
  PetscFunctionBeginUser;
  PetscCall(CurveFineCreate(s->set, pair[0] == pair[1] ? 1 : 2, pair, FINER, &fine));
  PetscCall(CurvesCross(&fine.set, found));
  *cross = found[0] < 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(CurveFineDestroy(&fine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Curves whose polygons cross: s->pair if they cross themselves, else those passed. */
static PetscErrorCode LookAgain(EdgeSearch *s, const PetscInt pair[2], PetscBool *cross) {
  PetscFunctionBeginUser;
  *cross = PETSC_FALSE;
  for (PetscInt k = 0; k < s->count; k++)
    if (pair[0] == s->passed[k][0] && pair[1] == s->passed[k][1]) PetscFunctionReturn(PETSC_SUCCESS);
  *cross = PETSC_TRUE;
  if (s->set->smooth) PetscCall(FinerCross(s, pair, cross));
  if (!*cross && s->count == s->room) {
    s->room = 2 * s->room + 16;
    PetscCall(PetscRealloc((size_t)s->room * sizeof(*s->passed), &s->passed));
  }
  PetscCall(PetscArraycpy(*cross ? s->pair : s->passed[s->count++], pair, 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool EdgesCross(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  EdgeSearch *s = (EdgeSearch *)context;
  const PetscReal *X = s->set->X, *a = X + 2 * i, *b = s->end + 2 * i;
  const PetscInt pair[2] = {s->curve[i], s->curve[j]};
  PetscReal p[2], q[2];
  PetscBool cross;
  if (s->next[i] == j || s->next[j] == i) return PETSC_FALSE;
  for (int dir = 0; dir < 2; dir++) { /* the image of edge j that is nearest to edge i */
    const PetscReal shift = s->middle[2 * i + dir] + d[dir] - s->middle[2 * j + dir];
    p[dir] = X[2 * j + dir] + shift;
    q[dir] = s->end[2 * j + dir] + shift;
  }
  if (Turn(a, b, p) * Turn(a, b, q) >= 0 || Turn(p, q, a) * Turn(p, q, b) >= 0) return PETSC_FALSE;
  s->error = LookAgain(s, pair, &cross);
  return s->error || cross ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode CurvesCross(const CurveSet *set, PetscInt pair[2]) {
  const PetscInt *start = set->start, *part = set->part, n = start[set->curves];
  const PetscInt points[2] = {part ? start[part[0]] : 0, part ? start[part[1]] : n};
  const PetscReal *X = set->X;
  EdgeSearch s = {.set = set, .pair = {-1, -1}};
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &s.curve, n, &s.next, 2 * n, &s.end, 2 * n, &s.middle));
  for (PetscInt v = 0; v < set->curves; v++)
    for (PetscInt k = start[v]; k < start[v + 1]; k++) {
      PetscReal *end = s.end + 2 * k;
      s.curve[k] = v;
      s.next[k] = k + 1 < start[v + 1] ? k + 1 : start[v];
      if (!CurveSetWalk(set, v, k, 1, end)) PetscCall(PetscArraycpy(end, X + 2 * k, 2));
      for (int dir = 0; dir < 2; dir++) s.middle[2 * k + dir] = 0.5 * (X[2 * k + dir] + end[dir]);
      s.longest = PetscMax(s.longest, PetscHypotReal(end[0] - X[2 * k], end[1] - X[2 * k + 1]));
    }
  PetscCall(PairsWithin(n, s.middle, points, set->period, s.longest, EdgesCross, &s));
  PetscCall(s.error);
  PetscCall(PetscFree4(s.curve, s.next, s.end, s.middle));
  PetscCall(PetscFree(s.passed));
  PetscCall(PetscArraycpy(pair, s.pair, 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}
