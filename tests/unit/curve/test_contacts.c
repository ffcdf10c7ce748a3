/* The edge nearest to each point, the gaps of curves and the thinnest film, against the search of all pairs and of
   circles; curves that are open or span a period. */
#include "facts.h"
#include "curve/contacts.h"
#include "curve/crossing.h"

#define POINTS 24
#define CURVES 6

static const PetscInt start[] = {0, POINTS, 2 * POINTS, 3 * POINTS, 4 * POINTS, 5 * POINTS, 6 * POINTS};

typedef struct {
  PetscReal x, y, radius;
} Circle;

static void Place(PetscInt n, const Circle c[], PetscReal X[]) {
  for (PetscInt v = 0; v < n; v++)
    for (PetscInt k = 0; k < POINTS; k++) {
      const PetscReal t = 2 * PETSC_PI * ((PetscReal)k + 0.2 * (PetscReal)v) / POINTS;
      X[2 * (v * POINTS + k)] = c[v].x + c[v].radius * PetscCosReal(t);
      X[2 * (v * POINTS + k) + 1] = c[v].y + c[v].radius * PetscSinReal(t);
    }
}

/* From the nearest point of the edge a b to p. */
static void FromEdge(const PetscReal p[2], const PetscReal a[2], const PetscReal b[2], PetscReal foot[2]) {
  const PetscReal e[2] = {b[0] - a[0], b[1] - a[1]}, d[2] = {p[0] - a[0], p[1] - a[1]};
  const PetscReal at = PetscMax(0, PetscMin(1, TestProduct(2, d, e) / TestProduct(2, e, e)));
  for (int c = 0; c < 2; c++) foot[c] = d[c] - at * e[c];
}

/* Least distance of the point p from the closed polygon Y of n points and its images; own: from images alone. */
static PetscReal Distance(const PetscReal p[2], PetscInt n, const PetscReal Y[], const PetscReal period[2],
                          PetscBool own) {
  PetscReal least = PETSC_MAX_REAL, foot[2];
  for (int q = 0; q < 9; q++) {
    const PetscReal moved[2] = {p[0] - (q % 3 - 1) * period[0], p[1] - (q / 3 - 1) * period[1]};
    for (PetscInt k = 0, l = n - 1; k < n && !(own && moved[0] == p[0] && moved[1] == p[1]); l = k++) {
      FromEdge(moved, Y + 2 * l, Y + 2 * k, foot);
      least = PetscMin(least, PetscHypotReal(foot[0], foot[1]));
    }
  }
  return least;
}

/* How far past their points the normals and weights of contacts lead. */
static PetscReal FeetOff(PetscInt n, const CurveContact c[], const PetscReal X[], const PetscReal period[2]) {
  PetscReal off = 0;
  for (PetscInt k = 0; k < n; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal *x = X + dir, foot = (1 - c[k].at) * x[2 * c[k].edge[0]] + c[k].at * x[2 * c[k].edge[1]];
      const PetscReal miss = x[2 * c[k].point] - foot - c[k].distance * c[k].normal[dir];
      TestWorse(&off, period[dir] > 0 ? remainder(miss, period[dir]) : miss);
    }
  return off;
}

/* Every contact is the nearest edge, its normal and weights lead back to the point, and none is missed. */
static void CheckNearest(PetscReal period_x, PetscReal period_y, PetscReal reach) {
  const Circle circles[CURVES] = {{0, 0, 1},   {2.05, 0.1, 1},  {0.4, 2.2, 1.1},
                                  {5, 5, 0.4}, {2.3, 2.2, 0.7}, {-1.5, 1.4, 0.6}};
  const PetscReal period[2] = {period_x, period_y};
  PetscReal X[2 * CURVES * POINTS], off = 0;
  PetscInt n, wanted = 0;
  CurveContact *c;
  Place(CURVES, circles, X);
  const CurveSet set = {CURVES, CURVES, start, NULL, X, period, PETSC_FALSE};
  TestCall(CurveContacts(&set, reach, 0, NULL, &n, &c));
  for (PetscInt p = 0; p < CURVES * POINTS; p++)
    for (PetscInt w = 0; w < CURVES; w++)
      wanted += Distance(X + 2 * p, POINTS, X + 2 * start[w], period, p / POINTS == w) < reach;
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool own = c[k].curve[0] == c[k].curve[1];
    const PetscReal d = Distance(X + 2 * c[k].point, POINTS, X + 2 * start[c[k].curve[1]], period, own);
    TestWorse(&off, d - PetscAbsReal(c[k].distance));
  }
  const PetscReal away = FeetOff(n, c, X, period);
  CHECK(n == wanted && off < 1e-13 && away < 1e-13,
        "periods %g, %g: %d contacts nearer than %g (%d), off by %.1g, feet by %.1g", period_x, period_y, (int)n, reach,
        (int)wanted, off, away);
  TestCall(PetscFree(c));
}

#define FOLDED 90

/* Of a thin curve bent to a ring that is open by a narrow gap, each point has the nearest edge across the inside and
   that across the outside, of those at least twice the reach from it along the curve; neither curves that may not touch
   themselves nor a circle have any. */
static void CheckOwn(PetscReal thick, PetscReal open, PetscReal reach) {
  const PetscInt whole[2] = {0, FOLDED};
  const PetscReal none[2] = {0, 0}, ds = 0.07;
  PetscReal X[2 * FOLDED], off = 0;
  PetscInt n, idle, wanted = 0, types[3] = {0, 0, 0};
  CurveContact *c;
  for (PetscInt k = 0; k < FOLDED; k++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)k / FOLDED, r = 0.5 + 0.5 * thick * PetscSinReal(t),
                    phi = (open - PETSC_PI) * PetscCosReal(t);
    X[2 * k] = r * PetscCosReal(phi);
    X[2 * k + 1] = r * PetscSinReal(phi);
  }
  const CurveSet set = {1, 1, whole, NULL, X, none, PETSC_FALSE};
  TestCall(CurveContacts(&set, reach, 0, NULL, &idle, &c));
  TestCall(PetscFree(c));
  TestCall(CurveContacts(&set, reach, 1, &ds, &n, &c));
  for (PetscInt p = 0, found = 0; p < FOLDED; p++) {
    const PetscReal *before = X + 2 * ((p + FOLDED - 1) % FOLDED), *after = X + 2 * ((p + 1) % FOLDED),
                    out[2] = {after[1] - before[1], before[0] - after[0]};
    PetscReal least[2] = {reach, reach};
    for (PetscInt q = 0; q < FOLDED; q++) {
      const PetscInt on = (q - p + FOLDED) % FOLDED;
      PetscReal foot[2];
      FromEdge(X + 2 * p, X + 2 * q, X + 2 * ((q + 1) % FOLDED), foot);
      const int side = foot[0] * out[0] + foot[1] * out[1] > 0 ? 0 : 1;
      if (PetscMin(on, FOLDED - 1 - on) * ds >= 2 * reach)
        least[side] = PetscMin(least[side], PetscHypotReal(foot[0], foot[1]));
    }
    for (int side = 0; side < 2; side++) {
      if (least[side] == reach) continue;
      wanted++;
      while (found < n && (c[found].point < p || (c[found].point == p && (int)c[found].type < 1 + side))) found++;
      TestWorse(&off, found < n && c[found].point == p ? c[found].distance - least[side] : 1);
    }
  }
  for (PetscInt k = 0; k < n; k++) types[c[k].type]++;
  const PetscReal away = FeetOff(n, c, X, none);
  CHECK(n == wanted && !idle && !types[CONTACT_BETWEEN] && off < 1e-13 && away < 1e-13 &&
            (types[CONTACT_INSIDE] == FOLDED) == (thick < reach) &&
            (types[CONTACT_OUTSIDE] > 20) == (open < 0.5 * reach),
        "a curve %g thick, open by %g: %d points across the inside, %d across the outside (%d), off by %.1g, feet by "
        "%.1g",
        thick, open, (int)types[CONTACT_INSIDE], (int)types[CONTACT_OUTSIDE], (int)wanted, off, away);
  TestCall(PetscFree(c));
}

/* Two circles, on a line through both centres or over a seam, that overlap by -gap where it is
   negative. */
static void CheckGap(PetscReal gap, PetscReal period, PetscReal tolerance) {
  const Circle circles[2] = {{0.3, 0, 1}, {period > 0 ? 0.3 + 2 + gap - period : 2.3 + gap, 0, 1}};
  const PetscReal periods[2] = {period, 0};
  PetscReal X[4 * POINTS], least;
  CurveGap *gaps;
  PetscInt n;
  Place(2, circles, X);
  const CurveSet set = {2, 2, start, NULL, X, periods, PETSC_TRUE};
  TestCall(CurveGaps(&set, 0.2, &n, &gaps));
  TestCall(CurveLeastGap(&set, &least));
  const PetscReal found = n ? gaps[0].distance : NAN;
  CHECK(n == (gap < 0.2) && (!n || PetscAbsReal(found - gap) < tolerance) && PetscAbsReal(least - gap) < tolerance,
        "circles %g apart, period %g: %g, least of all %g", gap, period, found, least);
  if (n) CHECK(gaps[0].curve[0] == 0 && gaps[0].curve[1] == 1, "   of the two");
  TestCall(PetscFree(gaps));
}

/* One circle alone has no gap, with an image it has that to it. */
static void CheckAlone(void) {
  const PetscReal box[2][2] = {{0, 0}, {5, 2.25}};
  PetscReal X[2 * POINTS], gap[2];
  Place(1, &(Circle){0, 0, 1}, X);
  for (int k = 0; k < 2; k++) TestCall(CurveLeastGap(&(CurveSet){1, 1, start, NULL, X, box[k], PETSC_TRUE}, &gap[k]));
  CHECK(PetscIsNanReal(gap[0]) && PetscAbsReal(gap[1] - 0.25) < 1e-3, "one circle: %g alone, %g to its image", gap[0],
        gap[1]);
}

/* Circles with a film between the first two (0.1), to the wall x_max (0.14) and, where y is periodic, from the lowest
   to the highest (0.05). Against the spacings the first or the last is thinnest, or that of the wall where the others
   have more points. */
static void CheckFilm(PetscBool images, PetscReal coarse, PetscInt v, PetscInt w, PetscReal thickness) {
  const Circle circles[4] = {{-1.6, 0, 1}, {0.5, 0, 1}, {2.36, 0, 0.5}, {-1.6, 2.475, 0.475}};
  const CurveRoom room = {
      .box = {-4, 3, -1.05, 2.95}, .period = {0, images ? 4 : 0}, .wall = {PETSC_TRUE, PETSC_FALSE}};
  PetscReal X[8 * POINTS], ds[4];
  CurveFilm film;
  Place(4, circles, X);
  for (int k = 0; k < 4; k++) ds[k] = (k == 2 ? 1 : coarse) * 2 * PETSC_PI * circles[k].radius / POINTS;
  const CurveSet set = {4, 4, start, NULL, X, room.period, PETSC_TRUE};
  TestCall(CurveThinnestFilm(&set, ds, &room, 2, &film));
  const PetscReal spacing = PetscMax(ds[v], w < 0 ? 0 : ds[w]);
  CHECK(film.pair[0] == v && film.pair[1] == w && PetscAbsReal(film.thickness - thickness) < 6e-3 &&
            PetscAbsReal(film.spacings * spacing - film.thickness) < 1e-14,
        "film of %d and %d: %g thick, %g spacings", (int)film.pair[0], (int)film.pair[1], film.thickness,
        film.spacings);
  TestCall(CurveThinnestFilm(&set, ds, &room, 0.9 * film.spacings, &film));
  CHECK(film.pair[0] == 0 && film.pair[1] == 0 && film.thickness == 0, "   none below that");
}

/* A circle against a curve that does not move, `gap` below its lowest point: half a circle, open, with its solid
   within, or a line across the period, with its solid below or (back) above, near whose end the circle is. */
static void CheckSolid(CurveType type, PetscBool back, PetscReal gap) {
  const PetscBool open = type == CURVE_OPEN;
  const PetscReal period[2] = {open ? 0 : 6, 0}, along = back ? 6 : -6;
  const CurveKind kind[2] = {{CURVE_CLOSED}, {type, {open ? 0 : along, 0}}};
  PetscReal X[4 * POINTS];
  CurveGap *gaps;
  PetscInt n;
  Place(1, &(Circle){open ? 0.3 : 2.9, 0, 1}, X);
  for (PetscInt k = 0; k < POINTS; k++) {
    const PetscReal t = PETSC_PI * (PetscReal)k / (POINTS - 1);
    X[2 * (POINTS + k)] = open ? 0.3 + 2 * PetscCosReal(t) : along * ((PetscReal)k / POINTS - 0.5);
    X[2 * (POINTS + k) + 1] = -1 - gap - (open ? 2 - 2 * PetscSinReal(t) : 0);
  }
  const CurveSet set = {2, 1, start, kind, X, period, PETSC_TRUE};
  TestCall(CurveGaps(&set, 0.2, &n, &gaps));
  const PetscReal found = n ? gaps[0].distance : NAN;
  CHECK(n == 1 && gaps[0].curve[0] == 0 && gaps[0].curve[1] == 1 &&
            (back ? found < -gap + 1e-3 : PetscAbsReal(found - gap) < 6e-3),
        "a circle %g from a curve that %s%s: %g", gap, open ? "is open" : "spans the period",
        back ? ", on its solid's side" : "", found);
  TestCall(PetscFree(gaps));
}

/* A line that comes back over itself crosses itself, one across a period does not cross its image. */
static void CheckLine(PetscReal swing, PetscBool crosses) {
  const PetscReal period[2] = {6, 0};
  const CurveKind kind = {CURVE_SPANNING, {6, 0}};
  PetscReal X[2 * POINTS];
  PetscInt pair[2];
  for (PetscInt k = 0; k < POINTS; k++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)k / POINTS;
    X[2 * k] = 6 * (PetscReal)k / POINTS + swing * PetscSinReal(2 * t);
    X[2 * k + 1] = PetscCosReal(t);
  }
  const CurveSet set = {1, 1, start, &kind, X, period, PETSC_TRUE};
  TestCall(CurvesCross(&set, pair));
  CHECK((pair[0] >= 0) == crosses, "a line across a period that swings by %g %s itself", swing,
        pair[0] >= 0 ? "crosses" : "does not cross");
}

#define TIMES 5

/* Of an open curve polynomials of fifth degree are exact; forces on finer points keep their sum. */
static void CheckOpen(void) {
  const CurveKind open = {.type = CURVE_OPEN};
  PetscReal X[2 * POINTS], T[2 * POINTS], Y[2 * POINTS * TIMES], weight[POINTS];
  PetscReal off[2] = {0, 0}, sums = 0, least = 0;
  for (PetscInt k = 0; k < POINTS; k++) {
    X[2 * k] = PetscPowRealInt(0.1 * (PetscReal)k, 5);
    X[2 * k + 1] = (PetscReal)k;
  }
  TestCall(CurveTangents(&open, NULL, POINTS, X, T));
  TestCall(CurveFinePoints(&open, POINTS, X, TIMES, Y));
  for (PetscInt k = 0; k < POINTS; k++)
    TestWorse(&off[0], PetscAbsReal(T[2 * k] - 0.5 * PetscPowRealInt(0.1 * k, 4)) + PetscAbsReal(T[2 * k + 1] - 1));
  for (PetscInt q = 0; q < POINTS * TIMES; q++) {
    const PetscReal t = CurveFinePlace(&open, TIMES, q);
    PetscReal sum = 0;
    TestWorse(&off[1], PetscAbsReal(Y[2 * q] - PetscPowRealInt(0.1 * t, 5)) + PetscAbsReal(Y[2 * q + 1] - t));
    CurveOpenWeights(POINTS, TIMES, q, weight);
    for (PetscInt k = 0; k < POINTS; k++) {
      sum += weight[k];
      if (t < 4 || t > POINTS - 5) least = PetscMin(least, weight[k]);
    }
    TestWorse(&sums, sum - 1);
  }
  CHECK(off[0] < 1e-9 && off[1] < 1e-9 && sums < 1e-13 && least >= 0,
        "an open curve: tangents off by %.1e, points by %.1e, sums of weights by %.1e, least one near ends %g", off[0],
        off[1], sums, least);
}

void Facts(void) {
  for (int k = 0; k < 4; k++) CheckNearest(k & 1 ? 5.3 : 0, k & 2 ? 6.5 : 0, k < 2 ? 0.4 : 0.15);
  for (int k = 0; k < 2; k++) {
    CheckGap(0.15, k ? 7 : 0, 6e-3);
    CheckGap(0.02, k ? 7 : 0, 2e-3);
    CheckGap(-0.02, k ? 7 : 0, 2e-3);
    CheckGap(1.5, k ? 9 : 0, 2e-3);
  }
  for (int k = 0; k < 2; k++) {
    CheckSolid(CURVE_OPEN, PETSC_FALSE, k ? 0.15 : 0.02);
    CheckSolid(CURVE_SPANNING, PETSC_FALSE, k ? 0.15 : 0.02);
    CheckLine(k ? 2.5 : 0.3, k);
  }
  CheckSolid(CURVE_SPANNING, PETSC_TRUE, 0.02);
  for (int k = 0; k < 4; k++) CheckOwn(k & 1 ? 0.3 : 0.15, k & 2 ? 0.5 : 0.06, 0.2);
  CheckOpen();
  CheckAlone();
  CheckFilm(PETSC_FALSE, 1, 0, 1, 0.1);
  CheckFilm(PETSC_TRUE, 1, 0, 3, 0.05);
  CheckFilm(PETSC_FALSE, 1.0 / 3, 2, -2, 0.14);
}
