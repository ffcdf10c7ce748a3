/* Pairs of near points against the search of all pairs, and closed curves that cross or do not. */
#include "facts.h"
#include "curve/crossing.h"

typedef struct {
  PetscInt pairs, repeated;
  char *seen; /* [n][n] */
  PetscInt n;
} Count;

static PetscBool CountPair(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  Count *c = (Count *)context;
  c->pairs++;
  if (c->seen[i * c->n + j]++) c->repeated++;
  return PETSC_FALSE;
}

static void CheckPairs(PetscInt n, PetscReal period_x, PetscReal period_y, PetscReal reach) {
  const PetscReal period[2] = {period_x, period_y};
  Count c = {.n = n};
  PetscInt wanted = 0;
  unsigned seed = 7;
  PetscReal *X = TestReals(2 * n);
  TestCall(PetscCalloc1(n * n, &c.seen));
  for (PetscInt k = 0; k < 2 * n; k++) X[k] = 3 * TestRandom(&seed); /* some are outside of a period */
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = i + 1; j < n; j++) {
      PetscReal square = 0;
      for (int dir = 0; dir < 2; dir++) {
        PetscReal d = X[2 * j + dir] - X[2 * i + dir];
        if (period[dir] > 0) d = remainder(d, period[dir]);
        square += d * d;
      }
      if (square < reach * reach) wanted++;
    }
  TestCall(PairsWithin(n, X, NULL, period, reach, CountPair, &c));
  CHECK(c.pairs == wanted && !c.repeated, "%d points, periods %g and %g: %d pairs nearer than %g, %d by the cells",
        (int)n, period_x, period_y, (int)wanted, reach, (int)c.pairs);
  TestCall(PetscArrayzero(c.seen, n * n));
  c.pairs = 0;
  for (int half = 0; half < 2; half++) {
    const PetscInt part[2] = {half * (n / 3), half ? n : n / 3};
    TestCall(PairsWithin(n, X, part, period, reach, CountPair, &c));
  }
  CHECK(c.pairs == wanted && !c.repeated, "%d points in two parts: %d pairs", (int)n, (int)c.pairs);
  TestCall(PetscFree(c.seen));
}

#define POINTS 40

/* x = x0 + a cos t + waist cos 3t, y = y0 + b sin(fold t): an ellipse, a dumbbell, with fold 2 a figure of eight. */
typedef struct {
  PetscReal x, y, a, b, waist;
  int fold;
} Loop;

static void Place(const Loop *loop, PetscReal away, PetscReal X[]) {
  for (int k = 0; k < POINTS; k++) {
    const PetscReal t = 2 * PETSC_PI * k / POINTS;
    X[2 * k] = loop->x + away + loop->a * PetscCosReal(t) + loop->waist * PetscCosReal(3 * t);
    X[2 * k + 1] = loop->y + loop->b * PetscSinReal(loop->fold * t);
  }
}

static void CheckLoops(const char what[], const Loop loop[2], PetscReal period_x, PetscBool smooth, PetscInt first,
                       PetscInt second) {
  const PetscInt start[3] = {0, POINTS, 2 * POINTS};
  const PetscReal period[2] = {period_x, 0};
  PetscReal X[4 * POINTS];
  PetscInt pair[2];
  for (int v = 0; v < 2; v++) Place(&loop[v], 0, X + 2 * v * POINTS);
  const CurveSet set = {2, 2, start, NULL, X, period, smooth};
  TestCall(CurvesCross(&set, pair));
  const PetscInt low = PetscMin(pair[0], pair[1]), high = PetscMax(pair[0], pair[1]);
  CHECK(low == first && high == second, "%s, %s: %d and %d cross", what, smooth ? "curves" : "polygons", (int)low,
        (int)high);
}

/* The tip in the hollow, first in order, must not hide two others that cross. */
static void CheckBehind(const Loop nested[2], const Loop over[2]) {
  const PetscInt start[5] = {0, POINTS, 2 * POINTS, 3 * POINTS, 4 * POINTS};
  const PetscReal period[2] = {0, 0};
  PetscReal X[8 * POINTS];
  PetscInt pair[2];
  for (int v = 0; v < 4; v++) Place(v < 2 ? &nested[v] : &over[v - 2], v < 2 ? 0 : 9, X + 2 * v * POINTS);
  const CurveSet set = {4, 4, start, NULL, X, period, PETSC_TRUE};
  TestCall(CurvesCross(&set, pair));
  CHECK(PetscMin(pair[0], pair[1]) == 2 && PetscMax(pair[0], pair[1]) == 3, "behind a tip in a hollow: %d and %d cross",
        (int)pair[0], (int)pair[1]);
}

void Facts(void) {
  static const Loop apart[2] = {{0, 0, 1, 0.5, 0, 1}, {0, 1.001, 1, 0.5, 0, 1}},
                    over[2] = {{0, 0, 1, 0.5, 0, 1}, {0, 0.99, 1, 0.5, 0, 1}},
                    inside[2] = {{0, 0, 1, 0.5, 0, 1}, {0, 0, 0.5, 0.2, 0, 1}},
                    eight[2] = {{0, 0, 1, 0.5, 0, 1}, {0, 3, 1, 0.5, 0.1, 2}},
                    same[2] = {{0, 0, 1, 0.5, 0, 1}, {0, 0, 1, 0.5, 0, 1}},
                    seam[2] = {{0, 0, 1, 0.5, 0, 1}, {2.5, 0, 1, 0.5, 0, 1}},
                    /* the right-hand one's tip in the other's hollow end: chords of the hollow cut into the tip */
      nested[2] = {{0, 0, 0.4, 1, -0.3, 1}, {0.7105, 0.0785, 0.6, 0.01, 0, 1}};
  for (int n = 1; n <= 300; n = 3 * n + 2)
    for (int k = 0; k < 4; k++) CheckPairs(n, k & 1 ? 4 : 0, k & 2 ? 5 : 0, n < 30 ? 1.9 : 0.3);
  CheckPairs(50, 4, 4, 100);
  for (int smooth = 0; smooth < 2; smooth++) {
    const PetscBool curves = smooth ? PETSC_TRUE : PETSC_FALSE;
    CheckLoops("one above the other", apart, 0, curves, -1, -1);
    CheckLoops("a little lower", over, 0, curves, 0, 1);
    CheckLoops("one in the other", inside, 0, curves, -1, -1);
    CheckLoops("two equal ones", same, 0, curves, 0, 1);
    CheckLoops("a figure of eight", eight, 0, curves, 1, 1);
    CheckLoops("beside one another", seam, 0, curves, -1, -1);
    CheckLoops("over a seam", seam, 4, curves, 0, 1);
    CheckLoops("over its own seam", apart, 1.9, curves, 0, 0);
  }
  CheckLoops("a tip in a hollow", nested, 0, PETSC_FALSE, 0, 1);
  CheckLoops("a tip in a hollow", nested, 0, PETSC_TRUE, -1, -1);
  CheckBehind(nested, over);
}
