#include "curve/crossing.h"
#include "curve/spectral.h"

#define FINER 8 /* times the points, where polygons of smooth curves cross */
#define MOST 64 /* pairs of curves whose polygons cross and that do not themselves; more are too close to tell */

/* Points sorted into cells at least `reach` wide: those of cell c are next[first[c]], ... up to -1. */
typedef struct {
  PetscInt cells[2], *first, *next;
  PetscReal low[2], width[2];
  const PetscReal *period;
} CellList;

static PetscInt CellOf(const CellList *c, int dir, PetscReal x) {
  const PetscReal at = PetscFloorReal((x - c->low[dir]) / c->width[dir]);
  const PetscInt cells = c->cells[dir];
  if (c->period[dir] > 0) return (PetscInt)(at - cells * PetscFloorReal(at / cells));
  return PetscMax(0, PetscMin(cells - 1, (PetscInt)at));
}

static PetscErrorCode CellListCreate(PetscInt n, const PetscReal X[], PetscReal reach, CellList *c) {
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
  PetscCall(PetscMalloc2(c->cells[0] * c->cells[1], &c->first, n, &c->next));
  for (PetscInt k = 0; k < c->cells[0] * c->cells[1]; k++) c->first[k] = -1;
  for (PetscInt k = n - 1; k >= 0; k--) {
    const PetscInt cell = CellOf(c, 1, X[2 * k + 1]) * c->cells[0] + CellOf(c, 0, X[2 * k]);
    c->next[k] = c->first[cell];
    c->first[cell] = k;
  }
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

PetscErrorCode PairsWithin(PetscInt n, const PetscReal X[], const PetscReal period[2], PetscReal reach, PairFound found,
                           void *context) {
  CellList c = {.period = period};
  PetscInt around[2][3];
  PetscBool done = n < 2 || reach <= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CellListCreate(n, X, reach, &c));
  for (PetscInt i = 0; i < n && !done; i++) {
    const int columns = Around(&c, 0, CellOf(&c, 0, X[2 * i]), around[0]),
              rows = Around(&c, 1, CellOf(&c, 1, X[2 * i + 1]), around[1]);
    for (int k = 0; k < columns * rows && !done; k++)
      for (PetscInt j = c.first[around[1][k / columns] * c.cells[0] + around[0][k % columns]]; j >= 0 && !done;
           j = c.next[j]) {
        PetscReal d[2];
        if (j <= i) continue;
        Apart(period, X + 2 * i, X + 2 * j, d);
        if (d[0] * d[0] + d[1] * d[1] < reach * reach) done = found(context, i, j, d);
      }
  }
  PetscCall(PetscFree2(c.first, c.next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  const PetscInt *curve, *next; /* of each point; where its edge ends */
  const PetscReal *X, *middle;
  PetscInt passed[MOST][2], count; /* pairs of curves that do not cross, whatever their polygons do */
  PetscInt pair[2];                /* of curves that cross */
} EdgeSearch;

/* Twice the area of the triangle a, b, c. */
static PetscReal Turn(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2]) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static PetscBool EdgesCross(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  EdgeSearch *s = (EdgeSearch *)context;
  const PetscReal *a = s->X + 2 * i, *b = s->X + 2 * s->next[i];
  PetscReal p[2], q[2];
  if (s->next[i] == j || s->next[j] == i) return PETSC_FALSE;
  for (int dir = 0; dir < 2; dir++) { /* the image of edge j that is nearest to edge i */
    const PetscReal shift = s->middle[2 * i + dir] + d[dir] - s->middle[2 * j + dir];
    p[dir] = s->X[2 * j + dir] + shift;
    q[dir] = s->X[2 * s->next[j] + dir] + shift;
  }
  if (Turn(a, b, p) * Turn(a, b, q) >= 0 || Turn(p, q, a) * Turn(p, q, b) >= 0) return PETSC_FALSE;
  for (PetscInt k = 0; k < s->count; k++)
    if (s->curve[i] == s->passed[k][0] && s->curve[j] == s->passed[k][1]) return PETSC_FALSE;
  s->pair[0] = s->curve[i];
  s->pair[1] = s->curve[j];
  return PETSC_TRUE;
}

/* The first pair of polygons that cross, but for those passed. */
static PetscErrorCode PolygonsCross(PetscInt curves, const PetscInt start[], const PetscReal X[],
                                    const PetscReal period[2], EdgeSearch *s) {
  const PetscInt n = start[curves];
  PetscInt *curve, *next;
  PetscReal *middle, longest = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &curve, n, &next, 2 * n, &middle));
  for (PetscInt v = 0; v < curves; v++)
    for (PetscInt k = start[v]; k < start[v + 1]; k++) {
      curve[k] = v;
      next[k] = k + 1 < start[v + 1] ? k + 1 : start[v];
      for (int dir = 0; dir < 2; dir++) middle[2 * k + dir] = 0.5 * (X[2 * k + dir] + X[2 * next[k] + dir]);
      longest = PetscMax(longest, PetscHypotReal(X[2 * next[k]] - X[2 * k], X[2 * next[k] + 1] - X[2 * k + 1]));
    }
  s->curve = curve;
  s->next = next;
  s->X = X;
  s->middle = middle;
  s->pair[0] = s->pair[1] = -1;
  PetscCall(PairsWithin(n, middle, period, longest, EdgesCross, s)); /* edges that cross have their middles so near */
  PetscCall(PetscFree3(curve, next, middle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether two curves cross at FINER times their points. */
static PetscErrorCode FinerCross(const PetscInt start[], const PetscReal X[], const PetscReal period[2],
                                 const PetscInt pair[2], PetscBool *cross) {
  const PetscInt two = pair[0] == pair[1] ? 1 : 2;
  PetscInt fine[3] = {0}, n[2];
  EdgeSearch search = {.count = 0};
  PetscReal *Y;
  PetscFunctionBeginUser;
  for (int k = 0; k < two; k++) {
    n[k] = start[pair[k] + 1] - start[pair[k]];
    fine[k + 1] = fine[k] + FINER * n[k];
  }
  PetscCall(PetscMalloc1(2 * fine[two], &Y));
  for (int k = 0; k < two; k++) TrigonometricPoints(n[k], X + 2 * start[pair[k]], FINER, Y + 2 * fine[k]);
  PetscCall(PolygonsCross(two, fine, Y, period, &search));
  *cross = search.pair[0] < 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscFree(Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurvesCross(PetscInt curves, const PetscInt start[], const PetscReal X[], const PetscReal period[2],
                           PetscBool smooth, PetscInt pair[2]) {
  EdgeSearch search = {.count = 0};
  PetscBool cross = PETSC_TRUE;
  PetscFunctionBeginUser;
  do {
    PetscCall(PolygonsCross(curves, start, X, period, &search));
    if (search.pair[0] < 0 || !smooth || search.count == MOST) break;
    PetscCall(FinerCross(start, X, period, search.pair, &cross));
    if (!cross) PetscCall(PetscArraycpy(search.passed[search.count++], search.pair, 2));
  } while (!cross);
  PetscCall(PetscArraycpy(pair, search.pair, 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}
