#include "layers/boxaxis.h"
#include "base/lanes.h"

void BoxAxisPeriodic(PetscInt places, PetscInt modes, PetscReal low, PetscReal high, BoxAxis *a) {
  a->wall = PETSC_FALSE;
  a->low = low;
  a->high = high;
  a->places = a->pairs = places;
  a->modes = modes;
  for (PetscInt k = 0; k < places; k++) a->place[k] = low + (high - low) * k / places;
}

void BoxAxisStretch(PetscReal from, PetscReal factor, BoxAxis *a) {
  a->low = from + factor * (a->low - from);
  a->high = from + factor * (a->high - from);
  for (PetscInt k = 0; k < a->places; k++) a->place[k] = from + factor * (a->place[k] - from);
}

void BoxAxisChebyshev(PetscInt places, PetscReal low, PetscReal high, BoxAxis *a) {
  a->wall = PETSC_TRUE;
  a->low = low;
  a->high = high;
  a->modes = 0;
  a->places = places;
  a->pairs = places * places;
  for (PetscInt k = 0; k < places; k++) {
    const PetscReal angle = PETSC_PI * (k + 0.5) / places;
    a->place[k] = 0.5 * (low + high) + 0.5 * (high - low) * -PetscCosReal(angle);
    a->weight[k] = (k % 2 ? -1 : 1) * PetscSinReal(angle);
  }
}

void BoxAxisPolynomials(const BoxAxis *a, PetscReal x, PetscReal values[]) {
  const PetscInt n = a->places;
  PetscReal plain[BOX_WALL_PLACES], sum = 0;
  PetscInt at = -1;
  for (PetscInt k = 0; k < n; k++) { /* the second barycentric formula */
    const PetscReal off = x - a->place[k];
    if (PetscAbsReal(off) < 1e-14 * (a->high - a->low)) at = k;
    plain[k] = a->weight[k] / off;
    sum += plain[k];
  }
  for (PetscInt k = 0; k < n; k++) plain[k] = at < 0 ? plain[k] / sum : k == at;
  for (PetscInt k = 0; k < n / 2; k++) {
    values[k] = PetscSqrtReal(0.5) * (plain[k] + plain[n - 1 - k]);
    values[n / 2 + k] = PetscSqrtReal(0.5) * (plain[k] - plain[n - 1 - k]);
  }
}

/* erf(x) for |x| <= MOST, to 3e-16: x times Taylor's series in x^2 about the middle, MOST^2/2. */
#define MOST 3.45
static inline Lanes ErrorFunction(Lanes x) {
  static const PetscReal c[] = {
      0.4096871806568302,     -0.20337523883853242,    0.14816216572681717,    -0.11480094516513387,
      0.08755517308513439,    -0.06345060368125163,    0.04293871232738622,    -0.026928252924498523,
      0.015616554620630413,   -0.008382001952280116,   0.004173761035058733,   -0.0019340333241298444,
      0.0008367711230761435,  -0.00033916439925182906, 0.00012920496123476147, -4.640256056758701e-05,
      1.575580850075141e-05,  -5.071420337070632e-06,  1.551235365829322e-06,  -4.519327701165579e-07,
      1.2567031363593268e-07, -3.341957656477159e-08,  8.514578716704752e-09,  -2.081840882473578e-09,
      4.892501384847702e-10,  -1.1067353873505647e-10, 2.413093254679254e-11,  -5.077751654434495e-12,
      1.0324056274665673e-12, -2.0304549295720047e-13, 3.866817897200919e-14,  -7.137694955632355e-15,
      1.2782273600324967e-15, -2.2227135329556165e-16};
  const int terms = sizeof(c) / sizeof(*c);
  const Lanes s = x * x * (2 / (MOST * MOST)) - 1;
  Lanes sum = c[terms - 1] + (Lanes){0};
  for (int k = terms - 2; k >= 0; k--) sum = sum * s + c[k];
  return x * sum;
}

#define TIE 1e-10 /* of a period: of two images that are as near but for rounding, always the one at -period/2 */

/* Along one period, distances d become the nearest images' and part is multiplied by erfc/2, which falls from 1 about
   BOX_FADED of a period. */
static inline void BoxNearestImage(Lanes period, Lanes *d, Lanes *part) {
  const PetscReal whole = 6755399441055744.; /* 3 2^51: beside it the last bit is 1 */
  const Lanes one = 1 + (Lanes){0}, x = *d / period, from = x - ((x + whole) - whole);
  const Lanes off = from - LanesWhere((LanesBits)(from >= 0.5 - TIE), one);
  const Lanes size = LanesWhere((LanesBits)(off > 0), 2 * off) - off;
  *d -= period * (x - off);
  *part *= 0.5 - 0.5 * ErrorFunction((size - BOX_FADED) * (MOST / BOX_FADED));
}

void BoxImageRow(const BoxAxis axis[2], PetscInt n, PetscReal *const d[2], PetscReal part[]) {
  for (PetscInt k = 0; k < n; k += LANES) {
    Lanes all = 1 + (Lanes){0};
    for (int dir = 0; dir < 2; dir++) {
      Lanes x = LanesAt(d[dir] + k);
      if (axis[dir].wall) continue;
      BoxNearestImage(axis[dir].high - axis[dir].low + (Lanes){0}, &x, &all);
      LanesPut(x, d[dir] + k);
    }
    LanesPut(all, part + k);
  }
}

PetscReal BoxImage(const BoxAxis axis[2], PetscReal d[2]) {
  PetscReal x[LANES] = {d[0]}, y[LANES] = {d[1]}, part[LANES];
  PetscReal *const row[2] = {x, y};
  BoxImageRow(axis, 1, row, part);
  d[0] = x[0];
  d[1] = y[0];
  return part[0];
}
