#include "fluid/streamslabs.h"
#include "fluid/tridiagonal.h"

#define BLOCK TRIDIAGONAL_BLOCK

PetscErrorCode StreamSlabsCreate(Grid g, StreamFactors factors, StreamSlabs *out) {
  const PetscInt w = factors->width;
  StreamSlabs s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = g;
  s->factors = factors;
  s->rows = g->rows[FIELD_V]; /* nodes are level with v */
  s->width = w;
  s->message = 4 * w + 1;
  PetscCall(PetscCalloc5(2 * w, &s->state, 2 * w, &s->last, 2 * w, &s->first, s->message, &s->own, w, &s->zero));
  PetscCall(PetscCalloc3(2 * g->size * w, &s->below, 2 * g->size * w, &s->above, s->rows, &s->alive));
  s->all = s->own;
  if (g->size > 1) PetscCall(PetscCalloc1(g->size * s->message, &s->all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamSlabsDestroy(StreamSlabs *slabs) {
  StreamSlabs s = *slabs;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->grid->size > 1) PetscCall(PetscFree(s->all));
  PetscCall(PetscFree5(s->state, s->last, s->first, s->own, s->zero));
  PetscCall(PetscFree3(s->below, s->above, s->alive));
  PetscCall(PetscFree(s->y));
  PetscCall(PetscFree(*slabs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamSlabsReserve(StreamSlabs s) {
  PetscFunctionBeginUser;
  if (!s->y) PetscCall(PetscMalloc1(PetscMax(s->rows, 1) * s->width, &s->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What this slab tells the others: its first Z and its last Y, both for nothing coming in from outside. */
static void Summarise(StreamSlabs s) {
  const PetscInt w = s->width;
  for (PetscInt b = 0; b < w / BLOCK; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal z1[BLOCK] = {0}, z2[BLOCK] = {0};
    PetscInt j = PetscMin(s->factors->reach[b], s->rows) - 1;
    while (j >= 0 && s->alive[j] <= b) j--;
    for (; j >= 0; j--) {
      const PetscReal *restrict y = s->alive[j] > b ? s->y + j * w + b * BLOCK : s->zero;
      for (int k = 0; k < BLOCK; k++) {
        z1[k] = y[k] + r1[k] * z1[k];
        z2[k] = z1[k] + r2[k] * z2[k];
      }
    }
    (void)PetscArraycpy(s->own + b * BLOCK, z1, BLOCK);
    (void)PetscArraycpy(s->own + w + b * BLOCK, z2, BLOCK);
  }
  (void)PetscArraycpy(s->own + 2 * w, s->state, 2 * w);
}

/* out += A in, a matrix and a pair a mode. */
static void AddProduct(PetscInt w, const PairMatrix A, const PetscReal in[], PetscReal out[]) {
  for (PetscInt k = 0; k < w; k++) {
    out[k] += A[k] * in[k] + A[w + k] * in[w + k];
    out[w + k] += A[2 * w + k] * in[k] + A[3 * w + k] * in[w + k];
  }
}

static void Product(PetscInt w, const PairMatrix A, const PetscReal in[], PetscReal out[]) {
  (void)PetscArrayzero(out, 2 * w);
  AddProduct(w, A, in, out);
}

/* From Y below the first slab to Y below every slab and above the last. */
static void CarryUp(StreamSlabs s) {
  const PetscMPIInt size = s->grid->size;
  const PetscInt w = s->width;
  for (PetscMPIInt q = 0; q < size; q++) {
    PetscReal *out = q + 1 < size ? s->below + 2 * (q + 1) * w : s->last;
    (void)PetscArraycpy(out, s->all + q * s->message + 2 * w, 2 * w);
    AddProduct(w, s->factors->power[q == size - 1], s->below + 2 * q * w, out);
  }
}

/* From Z above the last slab to Z above every slab and in the first row of all. */
static void CarryDown(StreamSlabs s) {
  const PetscMPIInt size = s->grid->size;
  const PetscInt w = s->width;
  for (PetscMPIInt q = size - 1; q >= 0; q--) {
    PetscReal *out = q > 0 ? s->above + 2 * (q - 1) * w : s->first;
    (void)PetscArraycpy(out, s->all + q * s->message, 2 * w);
    AddProduct(w, s->factors->gain[q == size - 1], s->below + 2 * q * w, out);
    AddProduct(w, s->factors->power[q == size - 1], s->above + 2 * q * w, out);
  }
}

/* What comes into every slab. Walls: Z above all rows follows from Y there, and Y below them from Z for nothing coming
   in at the bottom. Seam: Y below follows from Y above for nothing coming in, then Z likewise (streamfactors.c). */
static void Close(StreamSlabs s) {
  const PetscInt w = s->width;
  PetscReal *Y = s->below, *Z = s->above + 2 * (s->grid->size - 1) * w;
  (void)PetscArrayzero(Y, 2 * w);
  CarryUp(s);
  if (s->grid->wall[1]) {
    Product(w, s->factors->top, s->last, Z);
    CarryDown(s);
    Product(w, s->factors->bottom, s->first, Y);
    CarryUp(s);
    Product(w, s->factors->top, s->last, Z);
  } else {
    Product(w, s->factors->bottom, s->last, Y);
    CarryUp(s);
    (void)PetscArrayzero(Z, 2 * w);
    CarryDown(s);
    Product(w, s->factors->top, s->first, Z);
  }
  CarryDown(s);
}

/* Blocks that anything comes in of from below. */
static PetscInt BlocksBelow(StreamSlabs s) {
  const PetscReal *y1 = s->below + 2 * s->grid->rank * s->width, *y2 = y1 + s->width;
  PetscInt k = s->width;
  while (k > 0 && y1[k - 1] == 0 && y2[k - 1] == 0) k--;
  return (k + BLOCK - 1) / BLOCK;
}

/* y2 of the rows += factor times what Y from below becomes there. */
static void AddBelow(StreamSlabs s, PetscReal factor) {
  const PetscInt w = s->width, blocks = BlocksBelow(s);
  const PetscReal *below = s->below + 2 * s->grid->rank * w;
  for (PetscInt b = 0; b < blocks; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal y1[BLOCK], y2[BLOCK];
    for (int k = 0; k < BLOCK; k++) {
      y1[k] = factor * below[b * BLOCK + k];
      y2[k] = factor * below[w + b * BLOCK + k];
    }
    for (PetscInt j = 0; j < PetscMin(s->factors->reach[b], s->rows); j++) {
      PetscReal *restrict y = s->y + j * w + b * BLOCK;
      if (s->alive[j] <= b) (void)PetscArrayzero(y, BLOCK);
      for (int k = 0; k < BLOCK; k++) {
        y1[k] *= r1[k];
        y2[k] = y1[k] + r2[k] * y2[k];
        y[k] += y2[k];
      }
    }
  }
  for (PetscInt j = 0, b = blocks; j < s->rows; j++) {
    while (b > 0 && s->factors->reach[b - 1] <= j) b--;
    s->alive[j] = PetscMax(s->alive[j], b);
  }
}

PetscErrorCode StreamSlabsClose(StreamSlabs s, PetscReal *sum) {
  PetscFunctionBeginUser;
  Summarise(s);
  s->own[4 * s->width] = *sum;
  if (s->grid->size > 1)
    PetscCallMPI(MPI_Allgather(s->own, (PetscMPIInt)s->message, MPIU_REAL, s->all, (PetscMPIInt)s->message, MPIU_REAL,
                               s->grid->comm));
  *sum = 0;
  for (PetscMPIInt q = 0; q < s->grid->size; q++) *sum += s->all[q * s->message + 4 * s->width];
  Close(s);
  AddBelow(s, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void StreamSlabsReopen(StreamSlabs s) {
  AddBelow(s, -1);
}
