#include "numerics/circulant.h"
#include "base/lanes.h"

#define CIRCULANT_ROW 3 /* vectors of two points each whose sums are taken at once: as many as registers hold */
#define CIRCULANT_POINTS (2 * CIRCULANT_ROW) /* points in these vectors */
#define CIRCULANT_TURN (2 * CIRCULANT_ROW)   /* values of p after which every vector is in its first register again */

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

struct _p_CirculantWeights {
  PetscInt n, pairs;
  PetscBool odd;
  PetscReal *weight[2]; /* [pairs] of even and of odd q, q = 2p and 2p + 1; zeros behind the last */
};

/* Values of p, q = 2p and 2p + 1 up to n/2, rounded up to a multiple of CIRCULANT_TURN. */
static PetscInt CirculantPairs(PetscInt n) {
  return CIRCULANT_TURN * ((n / 2 + 2 * CIRCULANT_TURN) / (2 * CIRCULANT_TURN));
}

PetscErrorCode CirculantWeightsCreate(PetscInt n, PetscBool odd, const PetscReal weight[], CirculantWeights *out) {
  CirculantWeights w;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  *out = w;
  w->n = n;
  w->odd = odd;
  w->pairs = CirculantPairs(n);
  PetscCall(PetscCalloc2(w->pairs, &w->weight[0], w->pairs, &w->weight[1]));
  for (PetscInt q = odd ? 1 : 0; 2 * q <= n; q++) /* q = 0 and q = n/2 are met from both sides */
    w->weight[q % 2][q / 2] = q == 0 || 2 * q == n ? 0.5 * weight[q] * !odd : weight[q];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CirculantWeightsDestroy(CirculantWeights *w) {
  PetscFunctionBeginUser;
  if (!*w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*w)->weight[0], (*w)->weight[1]));
  PetscCall(PetscFree(*w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt CirculantRoom(PetscInt n) {
  return 2 * (n + CIRCULANT_POINTS + 4 * CirculantPairs(n));
}

void CirculantUnroll(PetscInt n, const PetscReal X[], PetscReal points[]) {
  const PetscInt ahead = 2 * CirculantPairs(n), all = CirculantRoom(n) / 2;
  PetscReal *x = points + 2 * ahead;
  for (PetscInt k = 0; k < 2 * n; k++) x[k] = X[k] - X[k % 2];
  for (PetscInt k = 0; k < 2 * (all - ahead - n); k++) x[2 * n + k] = x[k];
  for (PetscInt k = -1; k >= -2 * ahead; k--) x[k] = x[k + 2 * n];
}

/* sum += the terms q = 2p + first of the sums at the points x. Vectors are kept in registers, and their places go
   round, as in CirculantAddTurns. */
static inline void CirculantAddRow(const int odd, PetscInt pairs, const PetscReal weight[], const PetscReal *x,
                                   int first, Lanes sum[2][CIRCULANT_ROW]) {
  const PetscReal *before = x - 2 * first, *behind = x + 2 * first;
  Lanes b[CIRCULANT_ROW], f[CIRCULANT_ROW];
  for (int r = 1; r < CIRCULANT_ROW; r++) b[r] = LanesAt(before + LANES * r);
  for (int r = 0; r < CIRCULANT_ROW - 1; r++) f[r] = LanesAt(behind + LANES * r);
  for (PetscInt p = 0; p < pairs;
       p += CIRCULANT_TURN, before -= LANES * CIRCULANT_TURN, behind += LANES * CIRCULANT_TURN)
#pragma GCC unroll 6
    for (int u = 0; u < CIRCULANT_TURN; u++) {
      b[(CIRCULANT_TURN - u) % CIRCULANT_ROW] = LanesAt(before - LANES * u);
      f[(CIRCULANT_ROW - 1 + u) % CIRCULANT_ROW] = LanesAt(behind + LANES * (CIRCULANT_ROW - 1 + u));
#pragma GCC unroll 3
      for (int r = 0; r < CIRCULANT_ROW; r++) {
        const Lanes one = b[(r - u + CIRCULANT_TURN) % CIRCULANT_ROW], other = f[(r + u) % CIRCULANT_ROW];
        sum[u % 2][r] += weight[p + u] * (odd ? one - other : one + other);
      }
    }
}

void CirculantSums(CirculantWeights w, const PetscReal points[], PetscReal sum[]) {
  const PetscReal *x = points + 4 * w->pairs;
  for (PetscInt k = 0; k < w->n; k += CIRCULANT_POINTS, x += 2 * CIRCULANT_POINTS) {
    Lanes row[2][CIRCULANT_ROW] = {{{0}}};
    for (int first = 0; first < 2; first++)
      if (w->odd)
        CirculantAddRow(1, w->pairs, w->weight[first], x, first, row);
      else
        CirculantAddRow(0, w->pairs, w->weight[first], x, first, row);
    for (int r = 0; r < CIRCULANT_ROW; r++) LanesPut(row[0][r] + row[1][r], sum + 2 * k + LANES * r);
  }
}
