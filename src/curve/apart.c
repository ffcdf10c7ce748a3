/* A curve is cut into groups of successive edges. Where the discs around two groups are disjoint, their edges do not
   cross. Two groups that follow one another make an arc; one that turns by less than half a turn in all, T, does not
   cross itself, and its chords are at least cos(T/2) times as long as the way along it. */
#include "curve/apart.h"
#include "base/lanes.h"

#define MOST_CURVES 32  /* beyond, boxes overlap in most scenes */
#define MOST_GROUPS 64  /* about; each is compared with each */
#define MOST_TURN 1.85  /* of an arc: cos(T/2) > .6 = 1/(2 SHORTEST) */
#define SHORTEST 0.8334 /* an edge over ds */

typedef struct {
  PetscReal low[2], high[2];
} Box;

static Box BoxOf(PetscInt n, const PetscReal X[]) {
  Box b = {{PETSC_MAX_REAL, PETSC_MAX_REAL}, {-PETSC_MAX_REAL, -PETSC_MAX_REAL}};
  PetscInt k = 0;
  if (n >= LANES / 2) {
    Lanes low = LanesAt(X), high = low;
    for (k = LANES / 2; k + LANES / 2 <= n; k += LANES / 2) {
      const Lanes x = LanesAt(X + 2 * k);
      low = LanesMin(low, x);
      high = LanesMax(high, x);
    }
    for (int d = 0; d < 2; d++) {
      b.low[d] = PetscMin(low[d], low[d + 2]);
      b.high[d] = PetscMax(high[d], high[d + 2]);
    }
  }
  for (; k < n; k++)
    for (int d = 0; d < 2; d++) {
      b.low[d] = PetscMin(b.low[d], X[2 * k + d]);
      b.high[d] = PetscMax(b.high[d], X[2 * k + d]);
    }
  return b;
}

PetscReal CurveLongestEdge(const CurveSet *set) {
  PetscReal longest = 0, to[2];
  for (PetscInt v = 0; v < set->curves; v++) {
    const PetscInt last = set->start[v + 1] - 1;
    for (PetscInt k = set->start[v]; k < last; k++) {
      const PetscReal x = set->X[2 * k + 2] - set->X[2 * k], y = set->X[2 * k + 3] - set->X[2 * k + 1];
      longest = PetscMax(longest, x * x + y * y);
    }
    if (last >= set->start[v] && CurveSetWalk(set, v, last, 1, to))
      longest = PetscMax(longest, PetscSqr(to[0] - set->X[2 * last]) + PetscSqr(to[1] - set->X[2 * last + 1]));
  }
  return PetscSqrtReal(longest);
}

/* Of a closed curve, to its own images: farther than reach, or over half a period away from all of it. */
static PetscBool IsAlone(const Box *b, const PetscReal period[2], PetscReal reach) {
  for (int d = 0; d < 2; d++) {
    const PetscReal extent = b->high[d] - b->low[d];
    if (period[d] > 0 && extent + reach >= period[d] && 2 * extent >= period[d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Of two, the nearest images. */
static PetscBool BoxesApart(const Box *a, const Box *b, const PetscReal period[2], PetscReal reach) {
  for (int d = 0; d < 2; d++) {
    PetscReal middle = 0.5 * (b->low[d] + b->high[d] - a->low[d] - a->high[d]);
    if (period[d] > 0) middle -= period[d] * PetscFloorReal(middle / period[d] + 0.5);
    if (PetscAbsReal(middle) - 0.5 * (a->high[d] - a->low[d] + b->high[d] - b->low[d]) > reach) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool CurvesAreApart(const CurveSet *set, PetscReal reach) {
  Box box[MOST_CURVES];
  if (set->curves > MOST_CURVES) return PETSC_FALSE;
  for (PetscInt v = 0; v < set->curves; v++) {
    if (CurveSetKind(set, v).type == CURVE_SPANNING) return PETSC_FALSE;
    box[v] = BoxOf(set->start[v + 1] - set->start[v], set->X + 2 * set->start[v]);
  }
  for (PetscInt v = 0; v < set->moving; v++) {
    if (!IsAlone(&box[v], set->period, reach)) return PETSC_FALSE;
    for (PetscInt w = v + 1; w < set->curves; w++)
      if (!BoxesApart(&box[v], &box[w], set->period, reach)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The edges of a closed curve in groups; its points, the first of them once more behind the last. */
typedef struct {
  PetscInt n, groups;
  PetscReal *x, *y;              /* points[n + 2] */
  PetscReal *turn;               /* [n + 1] at each point the tangent of the angle, MOST_TURN or more if it is sharp */
  PetscReal *middle[2], *radius; /* discs, whole vectors of them */
} Groups;

/* Of edges before group k. */
static inline PetscInt Before(const Groups *g, PetscInt k) {
  return k * g->n / g->groups;
}

static PetscErrorCode GroupsCreate(PetscInt n, PetscInt groups, Groups *g) {
  const PetscInt discs = groups + LANES;
  PetscFunctionBeginUser;
  *g = (Groups){.n = n, .groups = groups};
  PetscCall(PetscMalloc6(n + 2, &g->x, n + 2, &g->y, n + 1, &g->turn, discs, &g->middle[0], discs, &g->middle[1], discs,
                         &g->radius));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Points and turns; the square of the shortest edge. */
static PetscReal Unroll(Groups *g, const PetscReal X[]) {
  PetscReal shortest = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < g->n + 2; k++) {
    g->x[k] = X[2 * (k < g->n ? k : k - g->n)];
    g->y[k] = X[2 * (k < g->n ? k : k - g->n) + 1];
  }
  for (PetscInt k = 1; k <= g->n; k++) {
    const PetscReal ax = g->x[k] - g->x[k - 1], ay = g->y[k] - g->y[k - 1], bx = g->x[k + 1] - g->x[k],
                    by = g->y[k + 1] - g->y[k], dot = ax * bx + ay * by, cross = ax * by - ay * bx;
    shortest = PetscMin(shortest, ax * ax + ay * ay);
    g->turn[k] = dot > 0 ? PetscAbsReal(cross) / dot : MOST_TURN;
  }
  g->turn[0] = g->turn[g->n];
  return shortest;
}

/* Whether every arc of two groups turns by less than MOST_TURN; an angle is below its tangent. */
static PetscBool ArcsAreOpen(const Groups *g) {
  PetscReal before = 0;
  for (PetscInt k = -1; k < g->groups; k++) { /* the last one comes before the first */
    const PetscInt from = Before(g, k < 0 ? g->groups - 1 : k), to = Before(g, k < 0 ? g->groups : k + 1);
    PetscReal turn = 0;
    for (PetscInt j = from + 1; j < to; j++) turn += g->turn[j];
    if (before + g->turn[from] + turn >= MOST_TURN) return PETSC_FALSE;
    before = turn;
  }
  return PETSC_TRUE;
}

/* Around each group's points, its last edge's end among them. */
static void MakeDiscs(Groups *g) {
  for (PetscInt k = 0; k < g->groups; k++) {
    const PetscInt from = Before(g, k), to = Before(g, k + 1);
    const PetscReal x = 0.5 * (g->x[from] + g->x[to]), y = 0.5 * (g->y[from] + g->y[to]);
    PetscReal r2 = 0;
    for (PetscInt j = from; j <= to; j++) r2 = PetscMax(r2, PetscSqr(g->x[j] - x) + PetscSqr(g->y[j] - y));
    g->middle[0][k] = x;
    g->middle[1][k] = y;
    g->radius[k] = PetscSqrtReal(r2);
  }
  for (PetscInt k = g->groups; k < g->groups + LANES; k++) g->middle[0][k] = g->middle[1][k] = g->radius[k] = 0;
}

/* Whether the discs of groups that do not follow one another are farther apart than reach. */
static PetscBool DiscsAreApart(const Groups *g, PetscReal reach) {
  for (PetscInt k = 0; k < g->groups; k++) {
    const PetscInt end = k ? g->groups : g->groups - 1; /* the first one follows the last */
    for (PetscInt j = k + 2; j < end; j += LANES) {
      const Lanes x = LanesAt(g->middle[0] + j) - g->middle[0][k], y = LanesAt(g->middle[1] + j) - g->middle[1][k],
                  r = LanesAt(g->radius + j) + (g->radius[k] + reach);
      LanesBits near = (LanesBits)(x * x + y * y <= r * r);
      for (PetscInt q = end - j; q < LANES; q++) near[q] = 0;
      if (LanesAny(near)) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

static PetscErrorCode IsClear(PetscInt n, const PetscReal X[], PetscReal ds, PetscReal reach, PetscBool *clear) {
  const PetscInt between = (PetscInt)PetscMin(n, PetscCeilReal(1.25 * reach / ds)); /* edges: enough for the reach */
  const PetscInt size = PetscMax(PetscMax(2, n / MOST_GROUPS), between);
  Groups g;
  PetscFunctionBeginUser;
  *clear = PETSC_FALSE;
  if (n < 4 * size) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GroupsCreate(n, n / size, &g));
  if (Unroll(&g, X) >= PetscSqr(SHORTEST * ds) && ArcsAreOpen(&g)) {
    MakeDiscs(&g);
    *clear = DiscsAreApart(&g, reach);
  }
  PetscCall(PetscFree6(g.x, g.y, g.turn, g.middle[0], g.middle[1], g.radius));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurvesAreClear(const CurveSet *set, const PetscReal ds[], PetscReal reach, PetscBool *clear) {
  PetscFunctionBeginUser;
  *clear = CurvesAreApart(set, reach);
  for (PetscInt v = 0; v < set->moving && *clear; v++) {
    const PetscInt *start = set->start + v;
    PetscCall(IsClear(start[1] - start[0], set->X + 2 * start[0], ds[v], reach, clear));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
