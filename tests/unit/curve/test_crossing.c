/* Pairs of near points against the search of all pairs, and closed curves that cross or do not. */
#include "facts.h"
#include "curve/crossing.h"

typedef struct {
  PetscInt n, pairs, repeated;
  PetscReal *seen; /* [n][n] */
} Count;

static PetscBool CountPair(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  Count *c = (Count *)context;
  c->pairs++;
  c->repeated += c->seen[i * c->n + j]++ > 0;
  return PETSC_FALSE;
}

static void CheckPairs(PetscInt n, PetscReal period_x, PetscReal period_y, PetscReal reach) {
  const PetscReal period[2] = {period_x, period_y};
  Count c = {.n = n, .seen = TestReals(n * n)}, again = {.n = n, .seen = TestReals(n * n)};
  PetscInt wanted = 0;
  unsigned seed = 7;
  PetscReal *X = TestRandoms(2 * n, &seed);
  for (PetscInt k = 0; k < 2 * n; k++) X[k] *= 3; /* some are outside of a period */
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
  for (int half = 0; half < 2; half++) {
    const PetscInt part[2] = {half * (n / 3), half ? n : n / 3};
    TestCall(PairsWithin(n, X, part, period, reach, CountPair, &again));
  }
  CHECK(again.pairs == wanted && !again.repeated, "%d points in two parts: %d pairs", (int)n, (int)again.pairs);
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

/* Which of n loops cross, from the third on 9 farther right. */
static void CheckLoops(const char what[], PetscInt n, const Loop loop[], PetscReal period_x, PetscBool smooth,
                       PetscInt first, PetscInt second) {
  const PetscInt start[] = {0, POINTS, 2 * POINTS, 3 * POINTS, 4 * POINTS};
  const PetscReal period[2] = {period_x, 0};
  PetscReal X[8 * POINTS];
  PetscInt pair[2];
  for (PetscInt v = 0; v < n; v++) Place(&loop[v], v < 2 ? 0 : 9, X + 2 * v * POINTS);
  const CurveSet set = {n, n, start, NULL, X, period, smooth};
  TestCall(CurvesCross(&set, pair));
  const PetscInt low = PetscMin(pair[0], pair[1]), high = PetscMax(pair[0], pair[1]);
  CHECK(low == first && high == second, "%s, %s: %d and %d cross", what, smooth ? "curves" : "polygons", (int)low,
        (int)high);
}

#define ELLIPSE                                                                                                        \
  { 0, 0, 1, 0.5, 0, 1 }

void Facts(void) {
  /* the tip of the second of four in the hollow end of the first: chords of the hollow cut into the tip, which must not
     hide the two others, which cross */
  static const Loop behind[4] = {
      {0, 0, 0.4, 1, -0.3, 1}, {0.7105, 0.0785, 0.6, 0.01, 0, 1}, ELLIPSE, {0, 0.99, 1, 0.5, 0, 1}};
  static const struct {
    const char *name;
    Loop loop[2];
    PetscReal period;
    PetscInt pair[2];
  } cases[] = {{"one above the other", {ELLIPSE, {0, 1.001, 1, 0.5, 0, 1}}, 0, {-1, -1}},
               {"a little lower", {ELLIPSE, {0, 0.99, 1, 0.5, 0, 1}}, 0, {0, 1}},
               {"one in the other", {ELLIPSE, {0, 0, 0.5, 0.2, 0, 1}}, 0, {-1, -1}},
               {"two equal ones", {ELLIPSE, ELLIPSE}, 0, {0, 1}},
               {"a figure of eight", {ELLIPSE, {0, 3, 1, 0.5, 0.1, 2}}, 0, {1, 1}},
               {"beside one another", {ELLIPSE, {2.5, 0, 1, 0.5, 0, 1}}, 0, {-1, -1}},
               {"over a seam", {ELLIPSE, {2.5, 0, 1, 0.5, 0, 1}}, 4, {0, 1}},
               {"over its own seam", {ELLIPSE, {0, 1.001, 1, 0.5, 0, 1}}, 1.9, {0, 0}}};
  for (int n = 1; n <= 300; n = 3 * n + 2)
    for (int k = 0; k < 4; k++) CheckPairs(n, k & 1 ? 4 : 0, k & 2 ? 5 : 0, n < 30 ? 1.9 : 0.3);
  CheckPairs(50, 4, 4, 100);
  for (int smooth = 0; smooth < 2; smooth++)
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(cases); k++)
      CheckLoops(cases[k].name, 2, cases[k].loop, cases[k].period, smooth, cases[k].pair[0], cases[k].pair[1]);
  CheckLoops("a tip in a hollow", 2, behind, 0, PETSC_FALSE, 0, 1);
  CheckLoops("a tip in a hollow", 2, behind, 0, PETSC_TRUE, -1, -1);
  CheckLoops("behind a tip in a hollow", 4, behind, 0, PETSC_TRUE, 2, 3);
}
