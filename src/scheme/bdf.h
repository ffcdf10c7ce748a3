/* Backward differentiation formulas with variable steps: du/dt ~ a0 u - uhat, uhat = SUM history_j u_j, and the
   extrapolation u* = SUM star_j u_j, j = 0 the present state, 1 the one before it, and so on. */
#pragma once
#include "base/base.h"

#define BDF_MOST 3
#define BDF_STATES 6 /* that an extrapolation goes by at most */

typedef struct {
  PetscInt order;              /* 1 to BDF_MOST: the number of states that are used */
  PetscReal a0;                /* leading coefficient (1/time) */
  PetscReal history[BDF_MOST]; /* (1/time) */
  PetscReal star[BDF_MOST];
} BDF;

/* BDFExtrapolation - weights star[n] of the polynomial through n states at the end of the step step[0], step[j] being
   the step that led from state j to state j - 1 (time). */
static inline void BDFExtrapolation(PetscInt n, const PetscReal step[], PetscReal star[]) {
  PetscReal back[BDF_STATES] = {step[0]};
  for (PetscInt j = 1; j < n; j++) back[j] = back[j - 1] + step[j];
  for (PetscInt j = 0; j < n; j++) {
    star[j] = 1;
    for (PetscInt i = 0; i < n; i++)
      if (i != j) star[j] *= back[i] / (back[i] - back[j]);
  }
}

/* BDFFit - the same of the cubic that is closest to n > 4 states in the mean square: the sum of its orthogonal
   polynomials p at the states, q at the end of the step, by their recurrence. */
static inline void BDFFit(PetscInt n, const PetscReal step[], PetscReal star[]) {
  PetscReal back[BDF_STATES] = {0}, p[BDF_STATES], p_last[BDF_STATES] = {0}, q = 1, q_last = 0, norm_last = 1;
  for (PetscInt j = 0; j < n; j++) {
    back[j] = step[j] / step[0] + (j > 0 ? back[j - 1] : 0);
    p[j] = 1;
    star[j] = 0;
  }
  for (PetscInt degree = 0; degree <= 3; degree++) {
    PetscReal norm = 0, mean = 0;
    for (PetscInt j = 0; j < n; j++) {
      norm += p[j] * p[j];
      mean += back[j] * p[j] * p[j];
    }
    mean /= norm;
    const PetscReal lower = degree > 0 ? norm / norm_last : 0, q_now = q;
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal now = p[j];
      star[j] += q * now / norm;
      p[j] = (back[j] - mean) * now - lower * p_last[j];
      p_last[j] = now;
    }
    q = -mean * q_now - lower * q_last;
    q_last = q_now;
    norm_last = norm;
  }
}

/* BDFGuess - weights star[n] of a first guess that goes by n states: by all that an extrapolation goes by at most, the
   cubic that is closest to them, as the states' own errors weigh less in it; by fewer, the polynomial through them. */
static inline void BDFGuess(PetscInt n, const PetscReal step[], PetscReal star[]) {
  if (n == BDF_STATES)
    BDFFit(n, step, star);
  else
    BDFExtrapolation(n, step, star);
}

/* BDFCoefficients - exact for polynomials of degree `order` through the new time and that many states. For equal steps
   order 2 is a0 = 3/(2dt), uhat = (2u - u_old/2)/dt, u* = 2u - u_old. */
static inline BDF BDFCoefficients(PetscInt order, const PetscReal step[]) {
  BDF b = {.order = order};
  PetscReal back = 0;
  BDFExtrapolation(order, step, b.star);
  for (PetscInt j = 0; j < order; j++) { /* the derivative at the new time of the polynomial that is 1 at one state */
    back += step[j];
    b.a0 += 1 / back;
    b.history[j] = b.star[j] / back;
  }
  return b;
}

/* Adams formulas with variable steps, for what moves with a rate q that depends on its place: from the present y,

       y* = y + SUM star_j q_j,     y_new = y + end q_new + SUM history_j q_j.

   The sums are the integrals over the step of the polynomials through the rates of the states, without and with the
   new one. */
typedef struct {
  PetscInt known;           /* states whose rates are used: 0 (y* = y, backward Euler) to BDF_MOST */
  PetscReal star[BDF_MOST]; /* (time) */
  PetscReal end;            /* (time) */
  PetscReal history[BDF_MOST];
} Adams;

/* AdamsCoefficients - for steps as in BDFExtrapolation. The two points of Gauss are exact for a cubic. For equal steps
   and two states y* = y + dt (3q - q_old)/2, y_new = y + dt (5q_new + 8q - q_old)/12. */
static inline Adams AdamsCoefficients(PetscInt known, const PetscReal step[]) {
  Adams a = {.known = known};
  for (int point = -1; point <= 1; point += 2) {
    const PetscReal at = 0.5 + point / PetscSqrtReal(12);
    PetscReal past[BDF_STATES], all[BDF_STATES] = {(at - 1) * step[0]}, star[BDF_STATES];
    for (PetscInt j = 0; j < known; j++) past[j] = all[j + 1] = step[j];
    past[0] = at * step[0];
    BDFExtrapolation(known, past, star);
    for (PetscInt j = 0; j < known; j++) a.star[j] += step[0] / 2 * star[j];
    BDFExtrapolation(known + 1, all, star);
    a.end += step[0] / 2 * star[0];
    for (PetscInt j = 0; j < known; j++) a.history[j] += step[0] / 2 * star[j + 1];
  }
  return a;
}
