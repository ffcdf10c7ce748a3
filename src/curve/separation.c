#include "curve/separation.h"
#include "base/lanes.h"

#define MOST_CURVES 32  /* in most scenes with more curves their boxes overlap */
#define MOST_GROUPS 64  /* about: every group is compared with every other */
#define MOST_TURN 1.85  /* the largest turn T of an arc: cos(T/2) > 0.6 = 1/(2 SHORTEST) */
#define SHORTEST 0.8334 /* length of the shortest edge over ds */

typedef struct {
  PetscReal low[2], high[2];
} Box;

static Box BoxAround(PetscInt n, const PetscReal X[]) {
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

/* Whether the box of a closed curve is farther than reach from its own images, or every image of a point of the curve
   is more than half a period from all of the curve. */
static PetscBool BoxIsAlone(const Box *b, const PetscReal period[2], PetscReal reach) {
  for (int d = 0; d < 2; d++) {
    const PetscReal extent = b->high[d] - b->low[d];
    if (period[d] > 0 && extent + reach >= period[d] && 2 * extent >= period[d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Whether the nearest images of two boxes are farther apart than reach. */
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
    box[v] = BoxAround(set->start[v + 1] - set->start[v], set->X + 2 * set->start[v]);
  }
  for (PetscInt v = 0; v < set->moving; v++) {
    if (!BoxIsAlone(&box[v], set->period, reach)) return PETSC_FALSE;
    for (PetscInt w = v + 1; w < set->curves; w++)
      if (!BoxesApart(&box[v], &box[w], set->period, reach)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The edges of a closed curve in groups, and its points, with the first two again behind the last. */
typedef struct {
  PetscInt n, groups;
  PetscReal *x, *y;              /* points[n + 2] */
  PetscReal *turn;               /* [n + 1] tangent of the angle at each point; MOST_TURN for a sharp angle */
  PetscReal *middle[2], *radius; /* discs, padded to whole vectors */
} Groups;

/* Number of the first edge of group k. */
static inline PetscInt GroupFirst(const Groups *g, PetscInt k) {
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

/* Fill in the points and turns; returns the square of the shortest edge. */
static PetscReal GroupsUnroll(Groups *g, const PetscReal X[]) {
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

/* Whether every arc of two groups turns by less than MOST_TURN. An angle is smaller than its tangent. */
static PetscBool GroupsAreOpen(const Groups *g) {
  PetscReal before = 0;
  for (PetscInt k = -1; k < g->groups; k++) { /* the last group comes before the first */
    const PetscInt from = GroupFirst(g, k < 0 ? g->groups - 1 : k), to = GroupFirst(g, k < 0 ? g->groups : k + 1);
    PetscReal turn = 0;
    for (PetscInt j = from + 1; j < to; j++) turn += g->turn[j];
    if (before + g->turn[from] + turn >= MOST_TURN) return PETSC_FALSE;
    before = turn;
  }
  return PETSC_TRUE;
}

/* Fill in the discs around the points of each group, the end of its last edge included. */
static void GroupsMakeDiscs(Groups *g) {
  for (PetscInt k = 0; k < g->groups; k++) {
    const PetscInt from = GroupFirst(g, k), to = GroupFirst(g, k + 1);
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
static PetscBool GroupsAreApart(const Groups *g, PetscReal reach) {
  for (PetscInt k = 0; k < g->groups; k++) {
    const PetscInt end = k ? g->groups : g->groups - 1; /* the first group follows the last */
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

static PetscErrorCode CurveIsClear(PetscInt n, const PetscReal X[], PetscReal ds, PetscReal reach, PetscBool *clear) {
  const PetscInt between = (PetscInt)PetscMin(
      n, PetscCeilReal(1.25 * reach / ds)); /* edges whose length is more than the reach */
  const PetscInt size = PetscMax(PetscMax(2, n / MOST_GROUPS), between);
  Groups g;
  PetscFunctionBeginUser;
  *clear = PETSC_FALSE;
  if (n < 4 * size) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GroupsCreate(n, n / size, &g));
  if (GroupsUnroll(&g, X) >= PetscSqr(SHORTEST * ds) && GroupsAreOpen(&g)) {
    GroupsMakeDiscs(&g);
    *clear = GroupsAreApart(&g, reach);
  }
  PetscCall(PetscFree6(g.x, g.y, g.turn, g.middle[0], g.middle[1], g.radius));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurvesAreClear(const CurveSet *set, const PetscReal ds[], PetscReal reach, PetscBool *clear) {
  PetscFunctionBeginUser;
  *clear = CurvesAreApart(set, reach);
  for (PetscInt v = 0; v < set->moving && *clear; v++) {
    const PetscInt *start = set->start + v;
    PetscCall(CurveIsClear(start[1] - start[0], set->X + 2 * start[0], ds[v], reach, clear));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
