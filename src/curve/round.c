#include "curve/round.h"
#include "base/lanes.h"

#define ROW 3            /* vectors of two points each whose sums are taken at once: as many as registers hold */
#define POINTS (2 * ROW) /* in them */
#define TURN (2 * ROW)   /* distances after which all registers are as before */

/* sum += those over `count` entries that are a vector apart, one after the other from x on or (not ahead) back, with
   every `stride`-th weight; of even and of odd ones apart, so that no sum waits for the one before. For successive ones
   the vectors are the same but for one: they stay where they are, and their places go round. */
static inline void AddTurns(const int ahead, PetscInt count, const PetscReal weight[], PetscInt stride,
                            const PetscReal *x, Lanes sum[2][ROW]) {
  const PetscInt step = ahead ? LANES : -LANES;
  PetscInt p = 0;
  Lanes v[ROW];
  for (int r = 0; r < ROW; r++) v[r] = LanesAt(x + LANES * r);
  for (; p + TURN <= count; p += TURN, x += step * TURN)
#pragma GCC unroll 6
    for (int u = 0; u < TURN; u++) {
      if (ahead)
        v[(ROW - 1 + u) % ROW] = LanesAt(x + step * u + LANES * (ROW - 1));
      else
        v[(TURN - u) % ROW] = LanesAt(x + step * u);
#pragma GCC unroll 3
      for (int r = 0; r < ROW; r++) sum[u % 2][r] += weight[(p + u) * stride] * v[(ahead ? r + u : r - u + TURN) % ROW];
    }
  for (; p < count; p++, x += step)
    for (int r = 0; r < ROW; r++) sum[0][r] += weight[p * stride] * LanesAt(x + LANES * r);
}

void ConvolveRound(PetscInt n, int each, PetscBool ahead, const PetscReal weight[], const PetscReal twice[],
                   PetscReal sum[]) {
  const PetscInt width = each * n, stride = LANES / each;
  for (PetscInt i = 0; i < width; i += LANES * ROW) {
    Lanes row[2][ROW] = {{{0}}};
    for (PetscInt q = 0; q < PetscMin(stride, n); q++) {
      const PetscInt count = (n - q + stride - 1) / stride;
      if (ahead)
        AddTurns(1, count, weight + q, stride, twice + i + q * each, row);
      else
        AddTurns(0, count, weight + q, stride, twice + width + i - q * each, row);
    }
    for (int r = 0; r < ROW; r++) LanesPut(row[0][r] + row[1][r], sum + i + LANES * r);
  }
}

struct _p_RoundWeights {
  PetscInt n, pairs;
  PetscBool odd;
  PetscReal *weight[2]; /* [pairs] of even and of odd distances, 2p and 2p + 1, zeros behind the last: whole TURNs */
};

/* Distances 2p and 2p + 1 up to n/2, in whole TURNs. */
static PetscInt Pairs(PetscInt n) {
  return TURN * ((n / 2 + 2 * TURN) / (2 * TURN));
}

PetscErrorCode RoundWeightsCreate(PetscInt n, PetscBool odd, const PetscReal weight[], RoundWeights *out) {
  RoundWeights w;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  *out = w;
  w->n = n;
  w->odd = odd;
  w->pairs = Pairs(n);
  PetscCall(PetscCalloc2(w->pairs, &w->weight[0], w->pairs, &w->weight[1]));
  for (PetscInt q = odd ? 1 : 0; 2 * q <= n; q++) /* what is its own opposite is met from both sides */
    w->weight[q % 2][q / 2] = q == 0 || 2 * q == n ? 0.5 * weight[q] * !odd : weight[q];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RoundWeightsDestroy(RoundWeights *w) {
  PetscFunctionBeginUser;
  if (!*w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*w)->weight[0], (*w)->weight[1]));
  PetscCall(PetscFree(*w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt RoundRoom(PetscInt n) {
  return 2 * (n + POINTS + 4 * Pairs(n));
}

void RoundUnroll(PetscInt n, const PetscReal X[], PetscReal points[]) {
  const PetscInt ahead = 2 * Pairs(n), all = RoundRoom(n) / 2;
  PetscReal *x = points + 2 * ahead;
  for (PetscInt k = 0; k < 2 * n; k++) x[k] = X[k] - X[k % 2];
  for (PetscInt k = 0; k < 2 * (all - ahead - n); k++) x[2 * n + k] = x[k];
  for (PetscInt k = -1; k >= -2 * ahead; k--) x[k] = x[k + 2 * n];
}

/* sum += those over the distances 2p + first at the points x of a ROW, as AddTurns. */
static inline void AddRow(const int odd, PetscInt pairs, const PetscReal weight[], const PetscReal *x, int first,
                          Lanes sum[2][ROW]) {
  const PetscReal *before = x - 2 * first, *behind = x + 2 * first;
  Lanes b[ROW], f[ROW];
  for (int r = 1; r < ROW; r++) b[r] = LanesAt(before + LANES * r);
  for (int r = 0; r < ROW - 1; r++) f[r] = LanesAt(behind + LANES * r);
  for (PetscInt p = 0; p < pairs; p += TURN, before -= LANES * TURN, behind += LANES * TURN)
#pragma GCC unroll 6
    for (int u = 0; u < TURN; u++) {
      b[(TURN - u) % ROW] = LanesAt(before - LANES * u);
      f[(ROW - 1 + u) % ROW] = LanesAt(behind + LANES * (ROW - 1 + u));
#pragma GCC unroll 3
      for (int r = 0; r < ROW; r++) {
        const Lanes one = b[(r - u + TURN) % ROW], other = f[(r + u) % ROW];
        sum[u % 2][r] += weight[p + u] * (odd ? one - other : one + other);
      }
    }
}

void RoundSums(RoundWeights w, const PetscReal points[], PetscReal sum[]) {
  const PetscReal *x = points + 4 * w->pairs;
  for (PetscInt k = 0; k < w->n; k += POINTS, x += 2 * POINTS) {
    Lanes row[2][ROW] = {{{0}}};
    for (int first = 0; first < 2; first++)
      if (w->odd)
        AddRow(1, w->pairs, w->weight[first], x, first, row);
      else
        AddRow(0, w->pairs, w->weight[first], x, first, row);
    for (int r = 0; r < ROW; r++) LanesPut(row[0][r] + row[1][r], sum + 2 * k + LANES * r);
  }
}
