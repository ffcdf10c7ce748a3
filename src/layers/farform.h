/* C = SL - SL_h of distant markers in closed form: what smoothing by the regularised delta function and dispersion by
   the lattice take from the Stokeslet, to the order h^6/r^6 (docs/nearfield.md, Distant pairs). With phi the angle of
   r, lengths in cells,

       xx:      SUM_n p_n(1/r^2) cos n phi,        n = 2, 4 .. 14
       yy:      SUM_n -+p_n(1/r^2) cos n phi,      minus where n/2 is odd
       xy, yx:  SUM_n q_n(1/r^2) sin n phi,        n = 2, 6, 10, 14.

   The coefficients p_n, q_n follow from the moments of the delta function's weights alone. Nothing crosses ranks. */
#pragma once
#include "base/lanes.h"
#include "kernel/kernel.h"

#define NEAR_FAR_ORDERS 3 /* powers of 1/r^2, from the first on */
#define NEAR_FAR_WAVES 7  /* n = 2, 4 .. 14; power m has n = 2 m .. 4 m + 2 */

typedef struct {
  PetscReal fourth[2]; /* mean fourth moments of the weights along a component's direction and across it */
  PetscReal p[NEAR_FAR_WAVES][NEAR_FAR_ORDERS], q[NEAR_FAR_WAVES][NEAR_FAR_ORDERS];
} NearFar;

/* NearFarMake - of a kernel. Not collective. */
PETSC_EXTERN void NearFarMake(const Kernel *kernel, NearFar *far);

/* NearFarPairs - C of four pairs, (x, y) apart (cells), times scale: xx, yy, xy, yx. fourth: by how much the fourth
   moments of the two stencils that meet in each of them are above the mean, added, along x and along y. What is left
   out is 2.6e-7 or less. Not collective. */
__attribute__((always_inline)) static inline void NearFarPairs(const NearFar *f, PetscReal scale, Lanes x, Lanes y,
                                                               const Lanes fourth[4][2], Lanes C[4]) {
  const PetscReal(*p)[NEAR_FAR_ORDERS] = f->p, (*q)[NEAR_FAR_ORDERS] = f->q;
  const Lanes over = 1 / (x * x + y * y), c2 = (x * x - y * y) * over, s2 = 2 * x * y * over;
  const Lanes c4 = 2 * c2 * c2 - 1, twice = c4 + c4, c6 = (twice - 1) * c2, s6 = (twice + 1) * s2, c8 = twice * c4 - 1,
              c10 = twice * c6 - c2, s10 = twice * s6 - s2, c12 = twice * c8 - c4, c14 = twice * c10 - c6,
              s14 = twice * s10 - s6, factor = scale * over;
  const Lanes even = p[1][0] * c4 + over * (p[1][1] * c4 + p[3][1] * c8 + over * (p[3][2] * c8 + p[5][2] * c12));
  const Lanes odd = p[0][0] * c2 + p[2][0] * c6 +
                    over * (p[2][1] * c6 + p[4][1] * c10 + over * (p[2][2] * c6 + p[4][2] * c10 + p[6][2] * c14));
  const Lanes both = q[0][0] * s2 + q[2][0] * s6 +
                     over * (q[2][1] * s6 + q[4][1] * s10 + over * (q[2][2] * s6 + q[4][2] * s10 + q[6][2] * s14));
  const Lanes place = (1 / (48 * PETSC_PI)) * factor * over, s4 = 2 * s2 * c2, plus = 6 * (s6 + s4),
              minus = 6 * (s6 - s4), three = 3 * c4, six = 6 * c6;
  C[0] = factor * (even + odd) - place * (fourth[0][0] * (six - three) + fourth[0][1] * (3 * three + six));
  C[1] = factor * (even - odd) - place * (fourth[1][0] * (3 * three - six) - fourth[1][1] * (three + six));
  for (int c = 2; c < 4; c++) C[c] = factor * both - place * (fourth[c][0] * minus + fourth[c][1] * plus);
}
