/* Back end "fftw_tridiagonal": transforms along the rows, tridiagonal solves across them.

   For each mode of a row, lambda/h^2 its eigenvalue, (a0 + nu lambda/h^2 - nu d_yy) x = b is, with r + 1/r = 2 + lambda
   + a0 h^2/nu, r <= 1,
       (nu/(r h^2)) (1 - r S)(1 - r S^-1) x = b,    S the shift by one row,
   that is two recurrences with one constant each, y_j = b_j + r y_{j-1} upwards and z_j = y_j + r z_{j+1} downwards, x
   = (r h^2/nu) z. Precomputed factors of a general tridiagonal matrix would be read from memory twice. What a slab
   needs from outside is y below its first row and z above its last, two numbers a mode: linear in what every slab's
   last y and first z would be without neighbours, which one Allgather tells all. Walls and the periodic seam are such
   neighbours too: x_{-1} = c x_0 is y_{-1} = (c - r) z_0, x_n = c x_{n-1} is z_n = y_{n-1} c/(1 - r c).

   The zero mode of a singular problem has r = 1 and no decay; its column is gathered and solved whole. */
#include "fluid/rowtransform.h"
#include "fluid/fastsolver.h"

#define BLOCK 8        /* modes in a line of the cache */
#define NEGLIGIBLE 43. /* e^-43 = 2e-19: a boundary's influence that far is not felt */

typedef struct {
  RowTransform t;
  PetscInt width;    /* of t, rounded up to blocks */
  PetscReal *y;      /* [rows][width] */
  PetscReal *r;      /* [width] */
  PetscReal *factor; /* [width] of z, with the transform's normalisation */
  PetscReal *gain;   /* [2][width] first z of an empty slab per y below it: of a full block, of the last rank's rows */
  PetscReal *power;  /* [2][width] r^rows, likewise */
  PetscReal *top;    /* [width] z_n over y_{n-1} at a wall */
  PetscReal *bottom; /* [width] y_{-1} over z_0's value without it; periodic: 1/(1 - r^n) */
  PetscInt *reach;   /* [width/BLOCK] rows in which a block's boundary data are felt */
  PetscReal *own, *all; /* [message], [ranks][message]: first z, last y, and the zero mode's column */
  PetscInt message;
  PetscReal *below, *above; /* [ranks][width] y below, z above each slab */
  PetscReal *ends;          /* [2][width] last y and first z of all */
  PetscReal *column;        /* [n_y] zero mode */
  MPI_Request request;
} Tridiagonal;

static PetscInt SlabRows(Grid g, Field f, PetscMPIInt rank) {
  return rank < g->size - 1 ? g->block : g->all_rows[f] - (g->size - 1) * g->block;
}

static PetscErrorCode SetCoefficients_Tridiagonal(FastSolver s) {
  Tridiagonal *d = (Tridiagonal *)s->data;
  const Grid g = s->grid;
  const PetscReal h2 = PetscSqr(g->h), c = GridWallFactor(s->field, 1);
  const PetscInt n = g->all_rows[s->field], rows[2] = {g->block, SlabRows(g, s->field, g->size - 1)};
  PetscFunctionBeginUser;
  PetscCheck(s->a0 * s->nu >= 0, g->comm, PETSC_ERR_ARG_OUTOFRANGE, "a0 %g and nu %g differ in sign", (double)s->a0,
             (double)s->nu);
  for (PetscInt k = 0; k < d->t->width; k++) {
    const PetscReal mu = d->t->lambda[k] + s->a0 * h2 / s->nu; /* 2 cosh(theta) - 2 */
    const PetscReal theta = 2 * asinh(0.5 * PetscSqrtReal(mu)), r = PetscExpReal(-theta),
                    q = -expm1(-theta);             /* 1 - r */
    const PetscReal decay = -expm1(-2 * n * theta); /* 1 - r^{2n} */
    d->r[k] = r;
    d->factor[k] = d->t->scale[k] * r * h2 / s->nu;
    for (int last = 0; last < 2; last++) {
      d->power[last * d->width + k] = PetscExpReal(-theta * (PetscReal)rows[last]);
      d->gain[last * d->width + k] = theta > 0 ? r * expm1(-2 * rows[last] * theta) / expm1(-2 * theta)
                                               : (PetscReal)rows[last];
    }
    if (s->singular && k == 0) { /* gathered */
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
    for (PetscInt k = b * BLOCK; k < PetscMin((b + 1) * BLOCK, d->t->width); k++) {
      const PetscReal length = d->r[k] > 0 ? NEGLIGIBLE / PetscMax(-PetscLogReal(d->r[k]), 1e-9) : 0;
      d->reach[b] = PetscMax(d->reach[b], (PetscInt)PetscMin(length + 1, (PetscReal)g->rows[s->field]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Transform and go up: y without a neighbour below. */
static void Upwards(FastSolver s, Tridiagonal *d, const PetscScalar b[]) {
  const PetscInt rows = s->grid->rows[s->field], columns = s->grid->columns[s->field], width = d->t->width;
  const PetscReal *restrict r = d->r, *restrict modes = d->t->modes;
  for (PetscInt j = 0; j < rows; j++) {
    PetscReal *restrict y = d->y + j * d->width;
    RowTransformForward(d->t, b + j * columns);
    if (s->singular) d->own[2 * d->width + j] = modes[0];
    if (j == 0)
      for (PetscInt k = 0; k < width; k++) y[k] = modes[k];
    else {
      const PetscReal *restrict below = y - d->width;
      for (PetscInt k = 0; k < width; k++) y[k] = modes[k] + r[k] * below[k];
    }
  }
}

/* What the slab tells: its first z and its last y. */
static void Summarise(FastSolver s, Tridiagonal *d) {
  const PetscInt rows = s->grid->rows[s->field];
  for (PetscInt b = 0; b < d->width / BLOCK; b++) {
    PetscReal z[BLOCK] = {0};
    const PetscReal *restrict r = d->r + b * BLOCK;
    for (PetscInt j = d->reach[b] - 1; j >= 0; j--)
      for (int k = 0; k < BLOCK; k++) z[k] = d->y[j * d->width + b * BLOCK + k] + r[k] * z[k];
    for (int k = 0; k < BLOCK; k++) d->own[b * BLOCK + k] = z[k];
  }
  for (PetscInt k = 0; k < d->width; k++) d->own[d->width + k] = rows > 0 ? d->y[(rows - 1) * d->width + k] : 0;
}

/* y below and z above every slab, given y below the first and z above the last (in below[0], above[size - 1]); returns
   the last y and the first z of all in out. */
static void Chain(FastSolver s, Tridiagonal *d, PetscReal last_y[], PetscReal first_z[]) {
  const PetscMPIInt size = s->grid->size;
  const PetscInt w = d->width;
  for (PetscMPIInt q = 0; q < size; q++) {
    const PetscReal *Y = d->all + q * d->message + w, *power = d->power + (q == size - 1) * w, *in = d->below + q * w;
    PetscReal *out = q + 1 < size ? d->below + (q + 1) * w : last_y;
    for (PetscInt k = 0; k < w; k++) out[k] = Y[k] + power[k] * in[k];
  }
  if (s->grid->wall[1])
    for (PetscInt k = 0; k < w; k++) d->above[(size - 1) * w + k] = d->top[k] * last_y[k];
  for (PetscMPIInt q = size - 1; q >= 0; q--) {
    const PetscReal *Z = d->all + q * d->message, *power = d->power + (q == size - 1) * w;
    const PetscReal *gain = d->gain + (q == size - 1) * w, *y = d->below + q * w, *in = d->above + q * w;
    PetscReal *out = q > 0 ? d->above + (q - 1) * w : first_z;
    for (PetscInt k = 0; k < w; k++) out[k] = Z[k] + gain[k] * y[k] + power[k] * in[k];
  }
}

/* Close the chain of slabs at the walls or through the seam. */
static void Close(FastSolver s, Tridiagonal *d) {
  const PetscInt w = d->width;
  PetscReal *last_y = d->ends, *first_z = d->ends + w, *top = d->above + (s->grid->size - 1) * w;
  for (PetscInt k = 0; k < w; k++) d->below[k] = top[k] = 0;
  Chain(s, d, last_y, first_z);
  for (PetscInt k = 0; k < w; k++) d->below[k] = d->bottom[k] * (s->grid->wall[1] ? first_z[k] : last_y[k]);
  Chain(s, d, last_y, first_z);
  if (s->grid->wall[1]) return;
  for (PetscInt k = 0; k < w; k++) top[k] = d->bottom[k] * first_z[k];
  Chain(s, d, last_y, first_z);
}

/* The zero mode's column: -(nu/h^2) second differences = b with mean zero. */
static void ZeroMode(FastSolver s, Tridiagonal *d) {
  const Grid g = s->grid;
  const PetscInt n = g->all_rows[s->field];
  const PetscReal factor = d->t->scale[0] * PetscSqr(g->h) / s->nu;
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
static void AddBelow(Tridiagonal *d, const PetscReal below[]) {
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

/* Go down and transform back; z is kept in the row above (which is done with), the first in `above`. */
static void Downwards(FastSolver s, Tridiagonal *d, PetscReal above[], PetscScalar x[]) {
  const PetscInt rows = s->grid->rows[s->field], columns = s->grid->columns[s->field], width = d->t->width;
  const PetscReal *restrict r = d->r, *restrict factor = d->factor;
  PetscReal *restrict modes = d->t->modes, *restrict z = above;
  for (PetscInt j = rows - 1; j >= 0; j--) {
    const PetscReal *restrict y = d->y + j * d->width;
    for (PetscInt k = 0; k < width; k++) {
      z[k] = y[k] + r[k] * z[k];
      modes[k] = factor[k] * z[k];
    }
    if (s->singular) modes[0] = d->column[s->grid->first + j];
    RowTransformBackward(d->t, x + j * columns);
  }
}

static PetscErrorCode Begin_Tridiagonal(FastSolver s, const PetscScalar b[]) {
  Tridiagonal *d = (Tridiagonal *)s->data;
  PetscFunctionBeginUser;
  Upwards(s, d, b);
  Summarise(s, d);
  if (s->grid->size > 1)
    PetscCallMPI(MPI_Iallgather(d->own, (PetscMPIInt)d->message, MPIU_REAL, d->all, (PetscMPIInt)d->message, MPIU_REAL,
                                s->grid->comm, &d->request));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode End_Tridiagonal(FastSolver s, PetscScalar x[]) {
  Tridiagonal *d = (Tridiagonal *)s->data;
  const PetscMPIInt rank = s->grid->rank;
  PetscFunctionBeginUser;
  if (s->grid->size > 1) PetscCallMPI(MPI_Wait(&d->request, MPI_STATUS_IGNORE));
  if (s->singular) ZeroMode(s, d);
  Close(s, d);
  AddBelow(d, d->below + rank * d->width);
  Downwards(s, d, d->above + rank * d->width, x);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Tridiagonal(FastSolver s) {
  Tridiagonal *d = (Tridiagonal *)s->data;
  PetscReal **all[] = {&d->y,      &d->r,   &d->factor, &d->gain,  &d->power, &d->top,
                       &d->bottom, &d->own, &d->below,  &d->above, &d->ends,  &d->column};
  PetscFunctionBeginUser;
  if (s->grid->size > 1) PetscCall(PetscFree(d->all));
  for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++) PetscCall(PetscFree(*all[i]));
  PetscCall(PetscFree(d->reach));
  PetscCall(RowTransformDestroy(&d->t));
  PetscCall(PetscFree(s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverCreate_Tridiagonal(FastSolver s, PetscInt plan) {
  const unsigned efforts[] = {FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT};
  const Grid g = s->grid;
  Tridiagonal *d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  s->data = d;
  s->begin = Begin_Tridiagonal;
  s->end = End_Tridiagonal;
  s->setcoefficients = SetCoefficients_Tridiagonal;
  s->destroy = Destroy_Tridiagonal;
  PetscCall(RowTransformCreate(g, s->field, efforts[plan], &d->t));
  const PetscInt w = d->width = (d->t->width + BLOCK - 1) / BLOCK * BLOCK, rows = g->rows[s->field];
  d->message = 2 * w + g->block;
  PetscCall(PetscCalloc1(PetscMax(rows, 1) * w, &d->y));
  PetscCall(PetscCalloc1(w, &d->r));
  PetscCall(PetscCalloc1(w, &d->factor));
  PetscCall(PetscCalloc1(2 * w, &d->gain));
  PetscCall(PetscCalloc1(2 * w, &d->power));
  PetscCall(PetscCalloc1(w, &d->top));
  PetscCall(PetscCalloc1(w, &d->bottom));
  PetscCall(PetscCalloc1(w / BLOCK, &d->reach));
  PetscCall(PetscCalloc1(d->message, &d->own));
  PetscCall(PetscCalloc1(g->size * w, &d->below));
  PetscCall(PetscCalloc1(g->size * w, &d->above));
  PetscCall(PetscCalloc1(2 * w, &d->ends));
  PetscCall(PetscCalloc1(g->all_rows[s->field], &d->column));
  if (g->size > 1)
    PetscCall(PetscCalloc1(g->size * d->message, &d->all));
  else
    d->all = d->own;
  PetscFunctionReturn(PETSC_SUCCESS);
}
