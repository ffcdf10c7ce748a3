/* The constants of the recurrences in tridiagonal.c. With r = e^{-theta}, r + 1/r - 2 = 4 sinh(theta/2)^2 gives theta.
   Long waves have theta near 0 and r near 1; asinh and expm1 keep their digits where 1 - r would lose them. */
#include "fluid/transforms/tridiagonal.h"

#define NEGLIGIBLE 43. /* e^-43 = 2e-19: what comes in from that far is lost in rounding */

/* Rows of a slab: the first ranks have full height, the last one what is left. */
static PetscInt SlabRows(const Tridiagonal d, int last) {
  const Grid g = d->grid;
  return last ? g->all_rows[d->field] - (g->size - 1) * g->block : g->block;
}

/* r, x over z, and what a slab does to what comes in. A slab of m rows without right-hand side turns y = 1 below it
   into y_j = r^{j+1}, so that its first z is SUM r^{2j+1} = r (1 - r^{2m})/(1 - r^2), m for r = 1. */
static void SetRecurrences(Tridiagonal d, PetscInt k, PetscReal theta) {
  const ModeFactors *f = &d->factors;
  const PetscReal r = PetscExpReal(-theta);
  f->r[k] = r;
  f->factor[k] = d->scale[k] * r * PetscSqr(d->grid->h) / d->nu;
  for (int last = 0; last < 2; last++) {
    const PetscInt m = SlabRows(d, last);
    f->power[last][k] = PetscExpReal(-theta * (PetscReal)m);
    f->gain[last][k] = theta > 0 ? r * expm1(-2 * m * theta) / expm1(-2 * theta) : (PetscReal)m;
  }
}

/* Walls: the missing neighbour is c times the entry, x_{-1} = c x_0 and x_n = c x_{n-1}, n rows in all. Put into the
   recurrences this is
       z_n = c/(1 - r c) y_{n-1},      y_{-1} = (c - r) z_0.
   z_0 itself grows with y_{-1}: z_0 = Z + D y_{-1}, Z being z_0 for y_{-1} = 0, and D the gain of all n rows plus what
   comes back from the upper wall, r^{2n} c/(1 - r c). So y_{-1} = (c - r)/(1 - (c - r) D) Z, which for c = 1 is
   (1 - r^2)/(1 - r^{2n}) Z. */
static void SetWalls(Tridiagonal d, PetscInt k, PetscReal theta) {
  const ModeFactors *f = &d->factors;
  const PetscInt n = d->grid->all_rows[d->field];
  const PetscReal c = GridWallFactor(d->field, 1), r = f->r[k], decay = -expm1(-2 * n * theta); /* 1 - r^{2n} */
  if (c > 0) {
    const PetscReal q = -expm1(-theta); /* 1 - r */
    f->top[k] = 1 / q;
    f->bottom[k] = q * (1 + r) / decay;
  } else {
    const PetscReal all = theta > 0 ? r * decay / (-expm1(-2 * theta)) : (PetscReal)n;
    f->top[k] = c / (1 - r * c);
    f->bottom[k] = (c - r) / (1 - (c - r) * (all + PetscExpReal(-2 * n * theta) * f->top[k]));
  }
}

/* The seam: y_{-1} = y_{n-1} = Y + r^n y_{-1}, Y being y_{n-1} for y_{-1} = 0; z_n in the same way from z_0. */
static void SetSeam(Tridiagonal d, PetscInt k, PetscReal theta) {
  d->factors.bottom[k] = -1 / expm1(-d->grid->all_rows[d->field] * theta);
}

/* The zero mode of a singular problem is solved by itself: the recurrences give zero. */
static void ClearMode(Tridiagonal d, PetscInt k) {
  const ModeFactors *f = &d->factors;
  f->r[k] = f->factor[k] = f->top[k] = f->bottom[k] = 0;
  for (int last = 0; last < 2; last++) f->power[last][k] = f->gain[last][k] = 0;
}

void TridiagonalReach(PetscInt width, const PetscReal r[], PetscReal negligible, PetscInt most, PetscInt reach[]) {
  for (PetscInt b = 0; b < width / TRIDIAGONAL_BLOCK; b++) {
    reach[b] = 1;
    for (PetscInt k = b * TRIDIAGONAL_BLOCK; k < (b + 1) * TRIDIAGONAL_BLOCK; k++) {
      const PetscReal rows = r[k] > 0 ? negligible / PetscMax(-PetscLogReal(r[k]), 1e-9) : 0;
      reach[b] = PetscMax(reach[b], (PetscInt)PetscMin(rows + 1, (PetscReal)most));
    }
  }
}

PetscErrorCode TridiagonalSetCoefficients(Tridiagonal d, PetscReal a0, PetscReal nu, PetscBool singular) {
  const PetscReal h2 = PetscSqr(d->grid->h);
  PetscFunctionBeginUser;
  PetscCheck(a0 * nu >= 0, d->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "a0 %g and nu %g differ in sign", (double)a0,
             (double)nu);
  d->nu = nu;
  d->singular = singular;
  for (PetscInt k = 0; k < d->modes; k++) {
    const PetscReal theta = 2 * asinh(0.5 * PetscSqrtReal(d->lambda[k] + a0 * h2 / nu));
    SetRecurrences(d, k, theta);
    if (d->grid->wall[1])
      SetWalls(d, k, theta);
    else
      SetSeam(d, k, theta);
  }
  if (singular) ClearMode(d, 0);
  TridiagonalReach(d->width, d->factors.r, NEGLIGIBLE, d->grid->rows[d->field], d->reach);
  PetscFunctionReturn(PETSC_SUCCESS);
}
