#include "fluid/transforms/tridiagonal.h"

#define BLOCK TRIDIAGONAL_BLOCK

PetscErrorCode TridiagonalReserve(Tridiagonal d) {
  PetscFunctionBeginUser;
  if (!d->y) PetscCall(PetscCalloc1(PetscMax(d->grid->rows[d->field], 1) * d->width, &d->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TridiagonalUp(Tridiagonal d, PetscInt j, const PetscReal b[]) {
  const PetscReal *restrict r = d->factors.r, *restrict from = b;
  PetscReal *restrict y = d->y + j * d->width;
  if (d->singular) d->message.own[2 * d->width + j] = b[0];
  if (j == 0)
    for (PetscInt k = 0; k < d->modes; k++) y[k] = from[k];
  else {
    const PetscReal *restrict below = y - d->width;
    for (PetscInt k = 0; k < d->modes; k++) y[k] = from[k] + r[k] * below[k];
  }
}

/* What this slab tells the others: its first z and its last y, both for nothing coming in from outside. Rows beyond the
   reach of a block do not matter for its first z. */
static void TridiagonalSummarise(Tridiagonal d) {
  const PetscInt rows = d->grid->rows[d->field];
  PetscReal *first_z = d->message.own, *last_y = first_z + d->width;
  for (PetscInt b = 0; b < d->width / BLOCK; b++) {
    PetscReal z[BLOCK] = {0};
    const PetscReal *restrict r = d->factors.r + b * BLOCK;
    for (PetscInt j = d->reach[b] - 1; j >= 0; j--)
      for (int k = 0; k < BLOCK; k++) z[k] = d->y[j * d->width + b * BLOCK + k] + r[k] * z[k];
    for (int k = 0; k < BLOCK; k++) first_z[b * BLOCK + k] = z[k];
  }
  for (PetscInt k = 0; k < d->width; k++) last_y[k] = rows > 0 ? d->y[(rows - 1) * d->width + k] : 0;
}

/* From y below the first slab, in ends.below[0], to y below every slab and above the last: what leaves a slab of m rows
   is its own last y and r^m times what came in. */
static void TridiagonalCarryUp(Tridiagonal d) {
  const PetscMPIInt size = d->grid->size;
  const PetscInt w = d->width;
  for (PetscMPIInt q = 0; q < size; q++) {
    const PetscReal *own = d->message.all + q * d->message.size + w, *in = d->ends.below + q * w;
    const PetscReal *power = d->factors.power[q == size - 1];
    PetscReal *out = q + 1 < size ? d->ends.below + (q + 1) * w : d->ends.last_y;
    for (PetscInt k = 0; k < w; k++) out[k] = own[k] + power[k] * in[k];
  }
}

/* From z above the last slab, in ends.above[size - 1], to z above every slab and in the first row of all: a slab's
   first z is its own, the gain times y that came in from below, and r^m times z that came in from above. */
static void TridiagonalCarryDown(Tridiagonal d) {
  const PetscMPIInt size = d->grid->size;
  const PetscInt w = d->width;
  for (PetscMPIInt q = size - 1; q >= 0; q--) {
    const PetscReal *own = d->message.all + q * d->message.size, *y = d->ends.below + q * w;
    const PetscReal *in = d->ends.above + q * w;
    const PetscReal *power = d->factors.power[q == size - 1], *gain = d->factors.gain[q == size - 1];
    PetscReal *out = q > 0 ? d->ends.above + (q - 1) * w : d->ends.first_z;
    for (PetscInt k = 0; k < w; k++) out[k] = own[k] + gain[k] * y[k] + power[k] * in[k];
  }
}

/* y below the first row of all and z above the last, and with them what comes into every slab. Both follow from a first
   pass with nothing coming in at the bottom (modefactors.c has the equations). */
static void TridiagonalMatchEnds(Tridiagonal d) {
  const PetscInt w = d->width;
  const PetscBool walls = d->grid->wall[1];
  const PetscReal *bottom = d->factors.bottom, *top = d->factors.top;
  PetscReal *y = d->ends.below, *z = d->ends.above + (d->grid->size - 1) * w;
  for (PetscInt k = 0; k < w; k++) y[k] = 0;
  TridiagonalCarryUp(d);
  if (walls) { /* y_{-1} follows from z_0, z_n from y_{n-1} */
    for (PetscInt k = 0; k < w; k++) z[k] = top[k] * d->ends.last_y[k];
    TridiagonalCarryDown(d);
    for (PetscInt k = 0; k < w; k++) y[k] = bottom[k] * d->ends.first_z[k];
    TridiagonalCarryUp(d);
    for (PetscInt k = 0; k < w; k++) z[k] = top[k] * d->ends.last_y[k];
  } else { /* y_{-1} follows from y_{n-1}, then z_n from z_0 */
    for (PetscInt k = 0; k < w; k++) y[k] = bottom[k] * d->ends.last_y[k];
    TridiagonalCarryUp(d);
    for (PetscInt k = 0; k < w; k++) z[k] = 0;
    TridiagonalCarryDown(d);
    for (PetscInt k = 0; k < w; k++) z[k] = bottom[k] * d->ends.first_z[k];
  }
  TridiagonalCarryDown(d);
}

/* The zero mode of a singular problem, on every rank: -(nu/h^2) (x_{j+1} - 2 x_j + x_{j-1}) = b_j - mean(b), summed up
   twice, with mean zero. */
static void ZeroMode(Tridiagonal d) {
  const Grid g = d->grid;
  const PetscInt n = g->all_rows[d->field];
  const PetscReal factor = d->scale[0] * PetscSqr(g->h) / d->nu;
  PetscReal mean = 0, slope = 0, sum = 0, *x = d->column;
  for (PetscInt j = 0; j < n; j++) {
    const PetscMPIInt rank = (PetscMPIInt)(j / g->block);
    x[j] = factor * d->message.all[rank * d->message.size + 2 * d->width + j - rank * g->block];
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

/* y_j += r^{j+1} times what came in from below. */
static void TridiagonalAddBelow(Tridiagonal d, const PetscReal below[]) {
  for (PetscInt b = 0; b < d->width / BLOCK; b++) {
    const PetscReal *restrict r = d->factors.r + b * BLOCK;
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

/* z of the row above is in ends.above, and z of this row takes its place. */
void TridiagonalDown(Tridiagonal d, PetscInt j, PetscReal x[]) {
  const PetscReal *restrict r = d->factors.r, *restrict factor = d->factors.factor, *y = d->y + j * d->width;
  PetscReal *restrict z = d->ends.above + d->grid->rank * d->width;
  for (PetscInt k = 0; k < d->modes; k++) {
    z[k] = y[k] + r[k] * z[k];
    x[k] = factor[k] * z[k];
  }
  if (d->singular) x[0] = d->column[d->grid->first + j];
}

PetscErrorCode TridiagonalBegin(Tridiagonal d) {
  SlabMessage *m = &d->message;
  PetscFunctionBeginUser;
  TridiagonalSummarise(d);
  if (d->grid->size > 1)
    PetscCallMPI(MPI_Iallgather(m->own, (PetscMPIInt)m->size, MPIU_REAL, m->all, (PetscMPIInt)m->size, MPIU_REAL,
                                d->grid->comm, &m->request));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalEnd(Tridiagonal d) {
  PetscFunctionBeginUser;
  if (d->grid->size > 1) PetscCallMPI(MPI_Wait(&d->message.request, MPI_STATUS_IGNORE));
  if (d->singular) ZeroMode(d);
  TridiagonalMatchEnds(d);
  TridiagonalAddBelow(d, d->ends.below + d->grid->rank * d->width);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalCreate(Grid g, Field field, PetscInt modes, PetscReal lambda[], PetscReal scale[],
                                 Tridiagonal *out) {
  const PetscInt w = (modes + BLOCK - 1) / BLOCK * BLOCK;
  Tridiagonal d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  *out = d;
  ModeFactors *f = &d->factors;
  d->grid = g;
  d->field = field;
  d->modes = modes;
  d->width = w;
  d->lambda = lambda;
  d->scale = scale;
  PetscCall(PetscCalloc4(w, &f->r, w, &f->factor, w, &f->top, w, &f->bottom));
  for (int last = 0; last < 2; last++) PetscCall(PetscCalloc2(w, &f->power[last], w, &f->gain[last]));
  PetscCall(
      PetscCalloc4(g->size * w, &d->ends.below, g->size * w, &d->ends.above, w, &d->ends.last_y, w, &d->ends.first_z));
  PetscCall(PetscCalloc2(w / BLOCK, &d->reach, g->all_rows[field], &d->column));
  d->message.size = 2 * w + g->block;
  PetscCall(PetscCalloc1(d->message.size, &d->message.own));
  d->message.all = d->message.own;
  if (g->size > 1) PetscCall(PetscCalloc1(g->size * d->message.size, &d->message.all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TridiagonalDestroy(Tridiagonal *tridiagonal) {
  Tridiagonal d = *tridiagonal;
  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  ModeFactors *f = &d->factors;
  if (d->grid->size > 1) PetscCall(PetscFree(d->message.all));
  PetscCall(PetscFree(d->message.own));
  PetscCall(PetscFree(d->y));
  PetscCall(PetscFree4(f->r, f->factor, f->top, f->bottom));
  for (int last = 0; last < 2; last++) PetscCall(PetscFree2(f->power[last], f->gain[last]));
  PetscCall(PetscFree4(d->ends.below, d->ends.above, d->ends.last_y, d->ends.first_z));
  PetscCall(PetscFree2(d->reach, d->column));
  PetscCall(PetscFree(*tridiagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
