#include "fluid/tridiagonal.h"

#define BLOCK 8        /* modes in a line of the cache */
#define NEGLIGIBLE 43. /* e^-43 = 2e-19: a boundary's influence that far is not felt */

static PetscInt SlabRows(Grid g, Field f, PetscMPIInt rank) {
  return rank < g->size - 1 ? g->block : g->all_rows[f] - (g->size - 1) * g->block;
}

PetscErrorCode TridiagonalSetCoefficients(Tridiagonal d, PetscReal a0, PetscReal nu, PetscBool singular) {
  const Grid g = d->grid;
  const PetscReal h2 = PetscSqr(g->h), c = GridWallFactor(d->field, 1);
  const PetscInt n = g->all_rows[d->field], rows[2] = {g->block, SlabRows(g, d->field, g->size - 1)};
  PetscFunctionBeginUser;
  d->nu = nu;
  d->singular = singular;
  PetscCheck(a0 * nu >= 0, g->comm, PETSC_ERR_ARG_OUTOFRANGE, "a0 %g and nu %g differ in sign", (double)a0, (double)nu);
  for (PetscInt k = 0; k < d->modes; k++) {
    const PetscReal mu = d->lambda[k] + a0 * h2 / nu; /* 2 cosh(theta) - 2 */
    const PetscReal theta = 2 * asinh(0.5 * PetscSqrtReal(mu)), r = PetscExpReal(-theta),
                    q = -expm1(-theta);             /* 1 - r */
    const PetscReal decay = -expm1(-2 * n * theta); /* 1 - r^{2n} */
    d->r[k] = r;
    d->factor[k] = d->scale[k] * r * h2 / nu;
    for (int last = 0; last < 2; last++) {
      d->power[last * d->width + k] = PetscExpReal(-theta * (PetscReal)rows[last]);
      d->gain[last * d->width + k] = theta > 0 ? r * expm1(-2 * rows[last] * theta) / expm1(-2 * theta)
                                               : (PetscReal)rows[last];
    }
    if (singular && k == 0) { /* gathered */
      d->r[k] = d->factor[k] = d->top[k] = d->bottom[k] = 0;
      for (int last = 0; last < 2; last++) d->power[last * d->width + k] = d->gain[last * d->width + k] = 0;
    } else if (!g->wall[1])
      d->bottom[k] = -1 / expm1(-n * theta);
    else if (c > 0) {
      d->top[k] = 1 / q;
      d->bottom[k] = q * (1 + r) / decay;
    } else {
      const PetscReal all = theta > 0 ? r * decay / (-expm1(-2 * theta)) : (PetscReal)n;
      d->top[k] = c / (1 - r * c);
      d->bottom[k] = (c - r) / (1 - (c - r) * (all + PetscExpReal(-2 * n * theta) * d->top[k]));
    }
  }
  for (PetscInt b = 0; b < d->width / BLOCK; b++) {
    d->reach[b] = 1;
    for (PetscInt k = b * BLOCK; k < PetscMin((b + 1) * BLOCK, d->modes); k++) {
      const PetscReal length = d->r[k] > 0 ? NEGLIGIBLE / PetscMax(-PetscLogReal(d->r[k]), 1e-9) : 0;
      d->reach[b] = PetscMax(d->reach[b], (PetscInt)PetscMin(length + 1, (PetscReal)g->rows[d->field]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalReserve(Tridiagonal d) {
  PetscFunctionBeginUser;
  if (!d->y) PetscCall(PetscCalloc1(PetscMax(d->grid->rows[d->field], 1) * d->width, &d->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TridiagonalUp(Tridiagonal d, PetscInt j, const PetscReal b[]) {
  const PetscReal *restrict r = d->r, *restrict from = b;
  PetscReal *restrict y = d->y + j * d->width;
  if (d->singular) d->own[2 * d->width + j] = b[0];
  if (j == 0)
    for (PetscInt k = 0; k < d->modes; k++) y[k] = from[k];
  else {
    const PetscReal *restrict below = y - d->width;
    for (PetscInt k = 0; k < d->modes; k++) y[k] = from[k] + r[k] * below[k];
  }
}

/* What the slab tells: its first z and its last y. */
static void Summarise(Tridiagonal d) {
  const PetscInt rows = d->grid->rows[d->field];
  for (PetscInt b = 0; b < d->width / BLOCK; b++) {
    PetscReal z[BLOCK] = {0};
    const PetscReal *restrict r = d->r + b * BLOCK;
    for (PetscInt j = d->reach[b] - 1; j >= 0; j--)
      for (int k = 0; k < BLOCK; k++) z[k] = d->y[j * d->width + b * BLOCK + k] + r[k] * z[k];
    for (int k = 0; k < BLOCK; k++) d->own[b * BLOCK + k] = z[k];
  }
  for (PetscInt k = 0; k < d->width; k++) d->own[d->width + k] = rows > 0 ? d->y[(rows - 1) * d->width + k] : 0;
}

/* y below and z above every slab, given y below the first and z above the last (in below[0], above[size - 1]); also the
   last y and the first z of all. */
static void Chain(Tridiagonal d) {
  const PetscMPIInt size = d->grid->size;
  const PetscInt w = d->width;
  for (PetscMPIInt q = 0; q < size; q++) {
    const PetscReal *Y = d->all + q * d->message + w, *power = d->power + (q == size - 1) * w, *in = d->below + q * w;
    PetscReal *out = q + 1 < size ? d->below + (q + 1) * w : d->last_y;
    for (PetscInt k = 0; k < w; k++) out[k] = Y[k] + power[k] * in[k];
  }
  if (d->grid->wall[1])
    for (PetscInt k = 0; k < w; k++) d->above[(size - 1) * w + k] = d->top[k] * d->last_y[k];
  for (PetscMPIInt q = size - 1; q >= 0; q--) {
    const PetscReal *Z = d->all + q * d->message, *power = d->power + (q == size - 1) * w;
    const PetscReal *gain = d->gain + (q == size - 1) * w, *y = d->below + q * w, *in = d->above + q * w;
    PetscReal *out = q > 0 ? d->above + (q - 1) * w : d->first_z;
    for (PetscInt k = 0; k < w; k++) out[k] = Z[k] + gain[k] * y[k] + power[k] * in[k];
  }
}

/* Close the chain of slabs at the walls or through the seam. */
static void Close(Tridiagonal d) {
  const PetscInt w = d->width;
  PetscReal *top = d->above + (d->grid->size - 1) * w;
  for (PetscInt k = 0; k < w; k++) d->below[k] = top[k] = 0;
  Chain(d);
  for (PetscInt k = 0; k < w; k++) d->below[k] = d->bottom[k] * (d->grid->wall[1] ? d->first_z[k] : d->last_y[k]);
  Chain(d);
  if (d->grid->wall[1]) return;
  for (PetscInt k = 0; k < w; k++) top[k] = d->bottom[k] * d->first_z[k];
  Chain(d);
}

/* The zero mode's column: -(nu/h^2) second differences = b with mean zero. */
static void ZeroMode(Tridiagonal d) {
  const Grid g = d->grid;
  const PetscInt n = g->all_rows[d->field];
  const PetscReal factor = d->scale[0] * PetscSqr(g->h) / d->nu;
  PetscReal mean = 0, slope = 0, sum = 0, *x = d->column;
  for (PetscInt j = 0; j < n; j++) {
    const PetscMPIInt rank = (PetscMPIInt)(j / g->block);
    x[j] = factor * d->all[rank * d->message + 2 * d->width + j - rank * g->block];
    mean += x[j] / n;
  }
  /* x_{j+1} - x_j = slope_j, slope_j = slope_{j-1} - b_j: none through a wall, any through the seam */
  if (!g->wall[1]) { /* the slopes' mean is zero */
    PetscReal total = 0, at = 0;
    for (PetscInt j = 0; j < n; j++) total += (at -= x[j] - mean) / n;
    slope = -total;
  }
  PetscReal value = 0;
  for (PetscInt j = 0; j < n; j++) {
    slope -= x[j] - mean;
    x[j] = value;
    sum += value / n;
    value += slope;
  }
  for (PetscInt j = 0; j < n; j++) x[j] -= sum;
}

/* y += (y below) r^{j+1} */
static void AddBelow(Tridiagonal d, const PetscReal below[]) {
  for (PetscInt b = 0; b < d->width / BLOCK; b++) {
    const PetscReal *restrict r = d->r + b * BLOCK;
    PetscReal value[BLOCK];
    for (int k = 0; k < BLOCK; k++) value[k] = r[k] * below[b * BLOCK + k];
    for (PetscInt j = 0; j < d->reach[b]; j++) {
      PetscReal *restrict y = d->y + j * d->width + b * BLOCK;
      for (int k = 0; k < BLOCK; k++) {
        y[k] += value[k];
        value[k] *= r[k];
      }
    }
  }
}

/* z is kept in `above`. */
void TridiagonalDown(Tridiagonal d, PetscInt j, PetscReal x[]) {
  const PetscReal *restrict r = d->r, *restrict factor = d->factor, *y = d->y + j * d->width;
  PetscReal *restrict z = d->above + d->grid->rank * d->width;
  for (PetscInt k = 0; k < d->modes; k++) {
    z[k] = y[k] + r[k] * z[k];
    x[k] = factor[k] * z[k];
  }
  if (d->singular) x[0] = d->column[d->grid->first + j];
}

PetscErrorCode TridiagonalBegin(Tridiagonal d) {
  PetscFunctionBeginUser;
  Summarise(d);
  if (d->grid->size > 1)
    PetscCallMPI(MPI_Iallgather(d->own, (PetscMPIInt)d->message, MPIU_REAL, d->all, (PetscMPIInt)d->message, MPIU_REAL,
                                d->grid->comm, &d->request));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalEnd(Tridiagonal d) {
  PetscFunctionBeginUser;
  if (d->grid->size > 1) PetscCallMPI(MPI_Wait(&d->request, MPI_STATUS_IGNORE));
  if (d->singular) ZeroMode(d);
  Close(d);
  AddBelow(d, d->below + d->grid->rank * d->width);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TridiagonalAbove(Tridiagonal d, PetscReal x[]) {
  const PetscReal *z = d->above + d->grid->rank * d->width;
  const PetscInt n = d->grid->all_rows[d->field];
  for (PetscInt k = 0; k < d->modes; k++) x[k] = d->factor[k] * z[k];
  if (d->singular) x[0] = d->column[(d->grid->first + d->grid->rows[d->field]) % n];
}

void TridiagonalBelow(Tridiagonal d, const PetscReal row_0[], PetscReal x[]) {
  const PetscReal *y = d->below + d->grid->rank * d->width;
  const PetscInt n = d->grid->all_rows[d->field];
  for (PetscInt k = 0; k < d->modes; k++) x[k] = d->factor[k] * y[k] + d->r[k] * row_0[k];
  if (d->singular) x[0] = d->column[(d->grid->first + n - 1) % n];
}

void TridiagonalEnds(Tridiagonal d, PetscReal first[], PetscReal last[]) {
  for (PetscInt k = 0; k < d->modes; k++) {
    first[k] = d->factor[k] * d->first_z[k];
    last[k] = d->factor[k] * (1 + d->r[k] * d->top[k]) * d->last_y[k];
  }
  if (!d->singular) return;
  first[0] = d->column[0];
  last[0] = d->column[d->grid->all_rows[d->field] - 1];
}

PetscErrorCode TridiagonalCreate(Grid g, Field field, PetscInt modes, PetscReal lambda[], PetscReal scale[],
                                 Tridiagonal *out) {
  const PetscInt w = (modes + BLOCK - 1) / BLOCK * BLOCK;
  Tridiagonal d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  *out = d;
  d->grid = g;
  d->field = field;
  d->modes = modes;
  d->width = w;
  d->lambda = lambda;
  d->scale = scale;
  d->message = 2 * w + g->block;
  PetscCall(PetscCalloc4(w, &d->r, w, &d->factor, w, &d->top, w, &d->bottom));
  PetscCall(PetscCalloc4(2 * w, &d->gain, 2 * w, &d->power, w, &d->last_y, w, &d->first_z));
  PetscCall(PetscCalloc4(w / BLOCK, &d->reach, g->size * w, &d->below, g->size * w, &d->above, g->all_rows[field],
                         &d->column));
  PetscCall(PetscCalloc1(d->message, &d->own));
  if (g->size > 1)
    PetscCall(PetscCalloc1(g->size * d->message, &d->all));
  else
    d->all = d->own;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalDestroy(Tridiagonal *tridiagonal) {
  Tridiagonal d = *tridiagonal;
  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  if (d->grid->size > 1) PetscCall(PetscFree(d->all));
  PetscCall(PetscFree(d->own));
  PetscCall(PetscFree(d->y));
  PetscCall(PetscFree4(d->r, d->factor, d->top, d->bottom));
  PetscCall(PetscFree4(d->gain, d->power, d->last_y, d->first_z));
  PetscCall(PetscFree4(d->reach, d->below, d->above, d->column));
  PetscCall(PetscFree(*tridiagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
