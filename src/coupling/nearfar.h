/* C = S - L of distant markers in closed form: what smoothing by the kernel and dispersion by the lattice take from the
   Stokeslet, to the order h^2/r^2 or h^6/r^6 (docs/nearfield.md, Distant pairs).
   With phi the angle of r, in cells, xx:      SUM_n p_n(1/r^2) cos n phi,     n = 2, 4 .. 14 yy:      the same with
   -p_n where n/2 is odd xy, yx:  SUM_n q_n(1/r^2) sin n phi,     n = 2, 6, 10, 14. */
#pragma once
#include "base/lanes.h"
#include "kernel/kernel.h"

#define NEAR_FAR_ORDERS 3 /* powers of 1/r^2, from the first on */
#define NEAR_FAR_WAVES 7  /* n = 2, 4 .. 14; power m has n = 2 m .. 4 m + 2 */

typedef struct {
  PetscReal p[NEAR_FAR_WAVES][NEAR_FAR_ORDERS], q[NEAR_FAR_WAVES][NEAR_FAR_ORDERS];
  PetscReal reach; /* cells from which on it is taken */
} NearFar;

/* NearFarMake - of a kernel, for markers of one vesicle and for those of two, in runs of few or of many vesicles. Not
   collective. */
enum { NEAR_ONE, NEAR_TWO };
PETSC_EXTERN void NearFarMake(const Kernel *kernel, PetscBool many, NearFar far[2]);

/* NearFarPairs - C of four pairs, (x, y) apart (cells), times scale: xx, yy, xy. Not collective. */
static inline void NearFarPairs(const NearFar *f, PetscReal scale, Lanes x, Lanes y, Lanes C[3]) {
  const Lanes over = 1 / (x * x + y * y), c2 = (x * x - y * y) * over, s2 = 2 * x * y * over;
  const Lanes c4 = 2 * c2 * c2 - 1, twice = c4 + c4, c6 = (twice - 1) * c2, s6 = (twice + 1) * s2, c8 = twice * c4 - 1;
  const Lanes c10 = twice * c6 - c2, s10 = twice * s6 - s2, c12 = twice * c8 - c4, c14 = twice * c10 - c6,
              s14 = twice * s10 - s6;
  const PetscReal(*p)[NEAR_FAR_ORDERS] = f->p, (*q)[NEAR_FAR_ORDERS] = f->q;
  const Lanes even1 = p[1][0] * c4, even2 = p[1][1] * c4 + p[3][1] * c8, even3 = p[3][2] * c8 + p[5][2] * c12;
  const Lanes odd1 = p[0][0] * c2 + p[2][0] * c6, odd2 = p[2][1] * c6 + p[4][1] * c10,
              odd3 = p[2][2] * c6 + p[4][2] * c10 + p[6][2] * c14;
  const Lanes both1 = q[0][0] * s2 + q[2][0] * s6, both2 = q[2][1] * s6 + q[4][1] * s10,
              both3 = q[2][2] * s6 + q[4][2] * s10 + q[6][2] * s14;
  const Lanes factor = scale * over, even = even1 + over * (even2 + over * even3),
              odd = odd1 + over * (odd2 + over * odd3);
  C[0] = factor * (even + odd);
  C[1] = factor * (even - odd);
  C[2] = factor * (both1 + over * (both2 + over * both3));
}
