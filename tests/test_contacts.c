/* The edge nearest to each point, the gaps of curves and the thinnest film, against the search of all pairs and of
 * circles. */
#include "check.h"
#include "curve/contacts.h"

#define POINTS 24
#define CURVES 6
#define START                                                                                                          \
  { 0, POINTS, 2 * POINTS, 3 * POINTS, 4 * POINTS, 5 * POINTS, 6 * POINTS }

typedef struct {
  PetscReal x, y, radius;
} Circle;

static void Place(PetscInt n, const Circle c[], PetscInt points, PetscReal X[]) {
  for (PetscInt v = 0; v < n; v++)
    for (PetscInt k = 0; k < points; k++) {
      const PetscReal t = 2 * PETSC_PI * ((PetscReal)k + 0.2 * (PetscReal)v) / (PetscReal)points;
      X[2 * (v * points + k)] = c[v].x + c[v].radius * PetscCosReal(t);
      X[2 * (v * points + k) + 1] = c[v].y + c[v].radius * PetscSinReal(t);
    }
}

/* Least distance of the point p from the closed polygon Y of n points, moved to the nearest image. */
static PetscReal Distance(const PetscReal p[2], PetscInt n, const PetscReal Y[], const PetscReal period[2],
                          PetscBool own) {
  PetscReal least = PETSC_MAX_REAL;
  for (int a = -1; a <= 1; a++)
    for (int b = -1; b <= 1; b++)
      for (PetscInt k = 0, l = n - 1; k < n; l = k++) {
        const PetscReal shift[2] = {a * period[0], b * period[1]};
        PetscReal e[2], d[2], at = 0, square = 0;
        if (own && shift[0] == 0 && shift[1] == 0) continue;
        for (int c = 0; c < 2; c++) {
          e[c] = Y[2 * k + c] - Y[2 * l + c];
          d[c] = p[c] - Y[2 * l + c] - shift[c];
          at += d[c] * e[c];
          square += e[c] * e[c];
        }
        at = PetscMax(0, PetscMin(1, at / square));
        least = PetscMin(least, PetscHypotReal(d[0] - at * e[0], d[1] - at * e[1]));
      }
  return least;
}

/* Every contact is the nearest edge, its normal and weights lead back to the point, and none is missed. */
static PetscErrorCode CheckNearest(PetscReal period_x, PetscReal period_y, PetscReal reach) {
  const Circle circles[CURVES] = {{0, 0, 1},   {2.05, 0.1, 1},  {0.4, 2.2, 1.1},
                                  {5, 5, 0.4}, {2.3, 2.2, 0.7}, {-1.5, 1.4, 0.6}};
  const PetscInt start[CURVES + 1] = START;
  const PetscReal period[2] = {period_x, period_y};
  PetscReal X[2 * CURVES * POINTS], off = 0, away = 0;
  PetscInt n, wanted = 0;
  CurveContact *c;
  PetscFunctionBeginUser;
  Place(CURVES, circles, POINTS, X);
  const CurveSet set = {CURVES, CURVES, start, NULL, X, period, PETSC_FALSE};
  PetscCall(CurveContacts(&set, reach, &n, &c));
  for (PetscInt p = 0; p < CURVES * POINTS; p++)
    for (PetscInt w = 0; w < CURVES; w++)
      wanted += Distance(X + 2 * p, POINTS, X + 2 * start[w], period, p / POINTS == w ? PETSC_TRUE : PETSC_FALSE) <
                        reach
                    ? 1
                    : 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool own = c[k].curve[0] == c[k].curve[1] ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal d = Distance(X + 2 * c[k].point, POINTS, X + 2 * start[c[k].curve[1]], period, own);
    off = PetscMax(off, PetscAbsReal(d - PetscAbsReal(c[k].distance)));
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal foot = (1 - c[k].at) * X[2 * c[k].edge[0] + dir] + c[k].at * X[2 * c[k].edge[1] + dir];
      PetscReal miss = X[2 * c[k].point + dir] - foot - c[k].distance * c[k].normal[dir];
      if (period[dir] > 0) miss = remainder(miss, period[dir]);
      away = PetscMax(away, PetscAbsReal(miss));
    }
  }
  CHECK(n == wanted && off < 1e-13 && away < 1e-13,
        "periods %g, %g: %d contacts nearer than %g (%d), off by %.1g, feet by %.1g", period_x, period_y, (int)n, reach,
        (int)wanted, off, away);
  PetscCall(PetscFree(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two circles, on a line through both centres or over a seam, that overlap by -gap where it is
   negative. */
static PetscErrorCode CheckGap(PetscReal gap, PetscReal period, PetscReal tolerance) {
  const Circle circles[2] = {{0.3, 0, 1}, {period > 0 ? 0.3 + 2 + gap - period : 2.3 + gap, 0, 1}};
  const PetscInt start[3] = {0, POINTS, 2 * POINTS};
  const PetscReal periods[2] = {period, 0};
  PetscReal X[4 * POINTS], least;
  CurveGap *gaps;
  PetscInt n;
  PetscFunctionBeginUser;
  Place(2, circles, POINTS, X);
  const CurveSet set = {2, 2, start, NULL, X, periods, PETSC_TRUE};
  PetscCall(CurveGaps(&set, 0.2, &n, &gaps));
  PetscCall(CurveLeastGap(&set, &least));
  const PetscReal found = n ? gaps[0].distance : NAN;
  CHECK(n == (gap < 0.2) && (!n || PetscAbsReal(found - gap) < tolerance) && PetscAbsReal(least - gap) < tolerance,
        "circles %g apart, period %g: %g, least of all %g", gap, period, found, least);
  if (n) CHECK(gaps[0].curve[0] == 0 && gaps[0].curve[1] == 1, "   of the two");
  PetscCall(PetscFree(gaps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One circle alone has no gap, with an image it has that to it. */
static PetscErrorCode CheckAlone(void) {
  const Circle circle = {0, 0, 1};
  const PetscInt start[2] = {0, POINTS};
  const PetscReal none[2] = {0, 0}, box[2] = {5, 2.25};
  PetscReal X[2 * POINTS], gap[2];
  PetscFunctionBeginUser;
  Place(1, &circle, POINTS, X);
  const CurveSet sets[2] = {{1, 1, start, NULL, X, none, PETSC_TRUE}, {1, 1, start, NULL, X, box, PETSC_TRUE}};
  for (int k = 0; k < 2; k++) PetscCall(CurveLeastGap(&sets[k], &gap[k]));
  CHECK(PetscIsNanReal(gap[0]) && PetscAbsReal(gap[1] - 0.25) < 1e-3, "one circle: %g alone, %g to its image", gap[0],
        gap[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Circles with a film between the first two (0.1), to the wall x_max (0.14) and, where y is periodic, from the lowest
   to the highest (0.05). Against the spacings the first or the last is thinnest, or that of the wall where the others
   have more points. */
static PetscErrorCode CheckFilm(PetscBool images, PetscReal coarse, PetscInt v, PetscInt w, PetscReal thickness) {
  const Circle circles[4] = {{-1.6, 0, 1}, {0.5, 0, 1}, {2.36, 0, 0.5}, {-1.6, 2.475, 0.475}};
  const PetscInt start[5] = {0, POINTS, 2 * POINTS, 3 * POINTS, 4 * POINTS};
  const CurveRoom room = {
      .box = {-4, 3, -1.05, 2.95}, .period = {0, images ? 4 : 0}, .wall = {PETSC_TRUE, PETSC_FALSE}};
  PetscReal X[8 * POINTS], ds[4];
  CurveFilm film;
  PetscFunctionBeginUser;
  Place(4, circles, POINTS, X);
  for (int k = 0; k < 4; k++) ds[k] = (k == 2 ? 1 : coarse) * 2 * PETSC_PI * circles[k].radius / POINTS;
  const CurveSet set = {4, 4, start, NULL, X, room.period, PETSC_TRUE};
  PetscCall(CurveThinnestFilm(&set, ds, &room, 2, &film));
  const PetscReal spacing = PetscMax(ds[v], w < 0 ? 0 : ds[w]);
  CHECK(film.pair[0] == v && film.pair[1] == w && PetscAbsReal(film.thickness - thickness) < 6e-3 &&
            PetscAbsReal(film.spacings * spacing - film.thickness) < 1e-14,
        "film of %d and %d: %g thick, %g spacings", (int)film.pair[0], (int)film.pair[1], film.thickness,
        film.spacings);
  PetscCall(CurveThinnestFilm(&set, ds, &room, 0.9 * film.spacings, &film));
  CHECK(film.pair[0] == 0 && film.pair[1] == 0 && film.thickness == 0, "   none below that");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) PetscCall(CheckNearest(k & 1 ? 5.3 : 0, k & 2 ? 6.5 : 0, k < 2 ? 0.4 : 0.15));
  for (int k = 0; k < 2; k++) {
    PetscCall(CheckGap(0.15, k ? 7 : 0, 6e-3));
    PetscCall(CheckGap(0.02, k ? 7 : 0, 2e-3));
    PetscCall(CheckGap(-0.02, k ? 7 : 0, 2e-3));
    PetscCall(CheckGap(1.5, k ? 9 : 0, 2e-3));
  }
  PetscCall(CheckAlone());
  PetscCall(CheckFilm(PETSC_FALSE, 1, 0, 1, 0.1));
  PetscCall(CheckFilm(PETSC_TRUE, 1, 0, 3, 0.05));
  PetscCall(CheckFilm(PETSC_FALSE, 1.0 / 3, 2, -2, 0.14));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
