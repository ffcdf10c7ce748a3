#include "fluid/transforms/tridiagonal.h"

#define NEGLIGIBLE 43. /* e^-43 = 2e-19: what comes in from that far is lost in rounding */

void TridiagonalUp(Tridiagonal d, PetscInt j, const PetscReal b[]) {
  const Slabs s = d->slabs;
  const PetscReal *restrict r = d->factors->r[0], *restrict from = b;
  const PetscReal *below = j > 0 ? s->y + (j - 1) * s->width : s->zero;
  PetscReal *restrict y = s->y + j * s->width;
  if (d->singular) d->column[d->factors->grid->first + j] = b[0];
  for (PetscInt k = 0; k < d->factors->modes; k++) y[k] = from[k] + r[k] * below[k];
  SlabsStore(s, j, s->width / MODE_BLOCK);
}

/* The zero mode of a singular problem, on every rank: -(nu/h^2) (x_{j+1} - 2 x_j + x_{j-1}) = b_j - mean(b), summed up
   twice, with mean zero. */
static PetscErrorCode ZeroMode(Tridiagonal d) {
  const Grid g = d->factors->grid;
  const PetscInt n = g->all_rows[d->factors->field];
  const PetscReal factor = d->factors->scale[0] * PetscSqr(g->h) / d->nu;
  PetscReal mean = 0, slope = 0, value = 0, sum = 0, *x = d->column;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allgather(MPI_IN_PLACE, 0, MPIU_REAL, x, (PetscMPIInt)g->block, MPIU_REAL, g->comm));
  for (PetscInt j = 0; j < n; j++) {
    x[j] *= factor;
    mean += x[j] / n;
  }
  /* x_{j+1} - x_j = slope_j, slope_j = slope_{j-1} - b_j: none through a wall, any through the seam */
  if (!g->wall[1]) { /* the slopes' mean is zero */
    PetscReal total = 0, at = 0;
    for (PetscInt j = 0; j < n; j++) total += (at -= x[j] - mean) / n;
    slope = -total;
  }
  for (PetscInt j = 0; j < n; j++) {
    slope -= x[j] - mean;
    x[j] = value;
    sum += value / n;
    value += slope;
  }
  for (PetscInt j = 0; j < n; j++) x[j] -= sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalEnd(Tridiagonal d) {
  const Slabs s = d->slabs;
  PetscReal none = 0;
  PetscFunctionBeginUser;
  if (d->singular) PetscCall(ZeroMode(d));
  for (int c = 0; c < 2; c++)
    PetscCall(PetscArraycpy(s->state + c * s->width, s->y + (s->rows - 1) * s->width, s->width));
  PetscCall(SlabsClose(s, &none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* z of the row above is in `above`, and z of this row takes its place. */
void TridiagonalDown(Tridiagonal d, PetscInt j, PetscReal x[]) {
  const PetscReal *restrict r = d->factors->r[0], *restrict factor = d->factors->factor;
  const PetscReal *restrict y = d->slabs->y + j * d->slabs->width;
  PetscReal *restrict z = d->slabs->above;
  for (PetscInt k = 0; k < d->factors->modes; k++) {
    z[k] = y[k] + r[k] * z[k];
    x[k] = factor[k] * z[k];
  }
  if (d->singular) x[0] = d->column[d->factors->grid->first + j];
}

/* The zero mode of a singular problem is solved by itself: the recurrences give zero.

   Walls: the missing neighbour is c times the entry, x_{-1} = c x_0 and x_n = c x_{n-1}, n rows in all. Put into the
   recurrences this is
       y_{-1} = (c - r) z_0,      z_n = c/(1 - r c) y_{n-1}. */
PetscErrorCode TridiagonalSetCoefficients(Tridiagonal d, PetscReal a0, PetscReal nu, PetscBool singular) {
  const ModeFactors f = d->factors;
  const PetscReal h2 = PetscSqr(f->grid->h), c = GridWallFactor(f->field, 1);
  PetscFunctionBeginUser;
  PetscCheck(a0 * nu >= 0, f->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "a0 %g and nu %g differ in sign", (double)a0,
             (double)nu);
  d->nu = nu;
  d->singular = singular;
  for (PetscInt k = 0; k < f->modes; k++) {
    const PetscBool zero = singular && k == 0;
    const PetscReal theta = zero ? INFINITY : ModeTheta(f->lambda[k] + a0 * h2 / nu), r = PetscExpReal(-theta);
    const PetscReal bottom = c > 0 ? -expm1(-theta) : c - r, top = c > 0 ? -1 / expm1(-theta) : c / (1 - r * c);
    ModeFactorsSet(f, k, (PetscReal[]){theta, INFINITY}, zero ? 0 : f->scale[k] * r * h2 / nu,
                   (ModePair){{{bottom, 0}, {bottom, 0}}}, (ModePair){{{top, 0}, {top, 0}}});
  }
  ModeFactorsReach(f, NEGLIGIBLE, f->grid->rows[f->field]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalCreate(Grid g, Field field, PetscInt modes, const PetscReal lambda[], const PetscReal scale[],
                                 Tridiagonal *out) {
  Tridiagonal d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  *out = d;
  PetscCall(ModeFactorsCreate(g, field, modes, lambda, scale, &d->factors));
  PetscCall(SlabsCreate(d->factors, &d->slabs));
  PetscCall(PetscMalloc1(g->size * g->block, &d->column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalDestroy(Tridiagonal *tridiagonal) {
  PetscFunctionBeginUser;
  if (!*tridiagonal) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SlabsDestroy(&(*tridiagonal)->slabs));
  PetscCall(ModeFactorsDestroy(&(*tridiagonal)->factors));
  PetscCall(PetscFree((*tridiagonal)->column));
  PetscCall(PetscFree(*tridiagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
