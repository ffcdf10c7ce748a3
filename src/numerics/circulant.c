#include "numerics/circulant.h"
#include "base/lanes.h"

#define CIRCULANT_ROW 3 /* vectors of two points each whose sums are taken at once: as many as registers hold */
#define CIRCULANT_TURN (2 * CIRCULANT_ROW) /* values of p after which every vector is in its first register again */

/* sum += SUM_p weight_{p stride} (CIRCULANT_ROW vectors from x + p step on), p < count, where step is a vector ahead or
   back. The sums over even and over odd p are apart, so that no sum waits for the one before. From p to p + 1 all
   vectors but one are the same: they stay in their registers, and the place of the first goes round. */
static inline void CirculantAddTurns(const int ahead, PetscInt count, const PetscReal weight[], PetscInt stride,
                                     const PetscReal *x, Lanes sum[2][CIRCULANT_ROW]) {
  const PetscInt step = ahead ? LANES : -LANES;
  PetscInt p = 0;
  Lanes v[CIRCULANT_ROW];
  for (int r = 0; r < CIRCULANT_ROW; r++) v[r] = LanesAt(x + LANES * r);
  for (; p + CIRCULANT_TURN <= count; p += CIRCULANT_TURN, x += step * CIRCULANT_TURN)
#pragma GCC unroll 6
    for (int u = 0; u < CIRCULANT_TURN; u++) {
      if (ahead)
        v[(CIRCULANT_ROW - 1 + u) % CIRCULANT_ROW] = LanesAt(x + step * u + LANES * (CIRCULANT_ROW - 1));
      else
        v[(CIRCULANT_TURN - u) % CIRCULANT_ROW] = LanesAt(x + step * u);
#pragma GCC unroll 3
      for (int r = 0; r < CIRCULANT_ROW; r++)
        sum[u % 2][r] += weight[(p + u) * stride] * v[(ahead ? r + u : r - u + CIRCULANT_TURN) % CIRCULANT_ROW];
    }
  for (; p < count; p++, x += step)
    for (int r = 0; r < CIRCULANT_ROW; r++) sum[0][r] += weight[p * stride] * LanesAt(x + LANES * r);
}

void CirculantConvolve(PetscInt n, int each, PetscBool ahead, const PetscReal weight[], const PetscReal twice[],
                       PetscReal sum[]) {
  const PetscInt width = each * n, stride = LANES / each;
  for (PetscInt i = 0; i < width; i += LANES * CIRCULANT_ROW) {
    Lanes row[2][CIRCULANT_ROW] = {{{0}}};
    for (PetscInt q = 0; q < PetscMin(stride, n); q++) {
      const PetscInt count = (n - q + stride - 1) / stride;
      if (ahead)
        CirculantAddTurns(1, count, weight + q, stride, twice + i + q * each, row);
      else
        CirculantAddTurns(0, count, weight + q, stride, twice + width + i - q * each, row);
    }
    for (int r = 0; r < CIRCULANT_ROW; r++) LanesPut(row[0][r] + row[1][r], sum + i + LANES * r);
  }
}
