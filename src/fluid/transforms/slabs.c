#include "fluid/transforms/slabs.h"

#define BLOCK MODE_BLOCK

PetscErrorCode SlabsCreate(ModeFactors factors, Slabs *out) {
  const Grid g = factors->grid;
  const PetscInt w = factors->width, size = g->size, part = (w + size - 1) / size;
  Slabs s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = g;
  s->factors = factors;
  s->rows = g->rows[factors->field];
  s->width = w;
  s->part = part;
  s->begin = PetscMin(g->rank * part, w);
  s->count = PetscMin(part, w - s->begin);
  s->message = 4 * part + 1;
  PetscCall(PetscCalloc5(2 * w, &s->state, 2 * part, &s->last, 2 * part, &s->first, 4 * w + 1, &s->own, w, &s->zero));
  PetscCall(PetscCalloc3(2 * w, &s->below, 2 * w, &s->above, s->rows, &s->stored));
  s->all = s->own;
  s->Y = s->below;
  s->Z = s->above;
  if (size > 1)
    PetscCall(PetscCalloc4(size * s->message, &s->send, size * s->message, &s->all, 2 * size * part, &s->Y,
                           2 * size * part, &s->Z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabsDestroy(Slabs *slabs) {
  Slabs s = *slabs;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->grid->size > 1) PetscCall(PetscFree4(s->send, s->all, s->Y, s->Z));
  PetscCall(PetscFree5(s->state, s->last, s->first, s->own, s->zero));
  PetscCall(PetscFree3(s->below, s->above, s->stored));
  PetscCall(PetscFree(s->y));
  PetscCall(PetscFree(*slabs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabsReserve(Slabs s) {
  PetscFunctionBeginUser;
  if (!s->y) PetscCall(PetscCalloc1(PetscMax(s->rows, 1) * s->width, &s->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first Z and the last Y of this slab where nothing comes in from outside, for the other ranks. */
static void SlabsSummarise(Slabs s) {
  const PetscInt w = s->width;
  for (PetscInt b = 0; b < w / BLOCK; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal z1[BLOCK] = {0}, z2[BLOCK] = {0};
    PetscInt j = PetscMin(s->factors->reach[b], s->rows) - 1;
    while (j >= 0 && s->stored[j] <= b) j--;
    for (; j >= 0; j--) {
      const PetscReal *restrict y = s->stored[j] > b ? s->y + j * w + b * BLOCK : s->zero;
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

/* out += A in, a matrix and a pair for each of the modes that this rank closes. */
static void SlabsAddProduct(Slabs s, const PairMatrix matrix, const PetscReal in[], PetscReal out[]) {
  const PetscInt w = s->width, part = s->part;
  const PetscReal *A = matrix + s->begin;
  for (PetscInt k = 0; k < s->count; k++) {
    out[k] += A[k] * in[k] + A[w + k] * in[part + k];
    out[part + k] += A[2 * w + k] * in[k] + A[3 * w + k] * in[part + k];
  }
}

static void SlabsProduct(Slabs s, const PairMatrix matrix, const PetscReal in[], PetscReal out[]) {
  (void)PetscArrayzero(out, 2 * s->part);
  SlabsAddProduct(s, matrix, in, out);
}

/* From Y below the first slab to Y below every slab and above the last one. */
static void SlabsCarryUp(Slabs s) {
  const PetscMPIInt size = s->grid->size;
  const PetscInt pair = 2 * s->part;
  for (PetscMPIInt q = 0; q < size; q++) {
    PetscReal *out = q + 1 < size ? s->Y + (q + 1) * pair : s->last;
    (void)PetscArraycpy(out, s->all + q * s->message + pair, pair);
    SlabsAddProduct(s, s->factors->power[q == size - 1], s->Y + q * pair, out);
  }
}

/* From Z above the last slab to Z above every slab and in the first row of all. */
static void SlabsCarryDown(Slabs s) {
  const PetscMPIInt size = s->grid->size;
  const PetscInt pair = 2 * s->part;
  for (PetscMPIInt q = size - 1; q >= 0; q--) {
    PetscReal *out = q > 0 ? s->Z + (q - 1) * pair : s->first;
    (void)PetscArraycpy(out, s->all + q * s->message, pair);
    SlabsAddProduct(s, s->factors->gain[q == size - 1], s->Y + q * pair, out);
    SlabsAddProduct(s, s->factors->power[q == size - 1], s->Z + q * pair, out);
  }
}

/* What comes into every slab. At walls, Z above all rows follows from Y there, and Y below all rows from the Z of no Y
   at the bottom. At a seam, Y below all rows follows from Y above them, and Z above from Z below (modefactors.c). */
static void SlabsMatchEnds(Slabs s) {
  const PetscInt pair = 2 * s->part;
  PetscReal *Y = s->Y, *Z = s->Z + (s->grid->size - 1) * pair;
  (void)PetscArrayzero(Y, pair);
  SlabsCarryUp(s);
  if (s->grid->wall[1]) {
    SlabsProduct(s, s->factors->top, s->last, Z);
    SlabsCarryDown(s);
    SlabsProduct(s, s->factors->bottom, s->first, Y);
    SlabsCarryUp(s);
    SlabsProduct(s, s->factors->top, s->last, Z);
  } else {
    SlabsProduct(s, s->factors->bottom, s->last, Y);
    SlabsCarryUp(s);
    (void)PetscArrayzero(Z, pair);
    SlabsCarryDown(s);
    SlabsProduct(s, s->factors->top, s->first, Z);
  }
  SlabsCarryDown(s);
}

/* Number of modes of part q. */
static PetscInt SlabsPartCount(Slabs s, PetscMPIInt q) {
  return PetscMax(0, PetscMin(s->part, s->width - q * s->part));
}

static PetscErrorCode SlabsExchange(Slabs s) {
  const PetscMPIInt n = (PetscMPIInt)s->message;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Alltoall(s->send, n, MPIU_REAL, s->all, n, MPIU_REAL, s->grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Send each rank its part of the modes of this slab. */
static PetscErrorCode SlabsToParts(Slabs s) {
  const PetscInt w = s->width, part = s->part;
  PetscFunctionBeginUser;
  if (s->grid->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscMPIInt q = 0; q < s->grid->size; q++) {
    PetscReal *to = s->send + q * s->message;
    for (int a = 0; a < 4; a++)
      PetscCall(PetscArraycpy(to + a * part, s->own + a * w + PetscMin(q * part, w), SlabsPartCount(s, q)));
    to[4 * part] = s->own[4 * w];
  }
  PetscCall(SlabsExchange(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Send each slab what comes into it, in the modes of this part. */
static PetscErrorCode SlabsToSlabs(Slabs s) {
  const PetscInt w = s->width, part = s->part;
  PetscFunctionBeginUser;
  if (s->grid->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscMPIInt q = 0; q < s->grid->size; q++) {
    PetscCall(PetscArraycpy(s->send + q * s->message, s->Y + 2 * q * part, 2 * part));
    PetscCall(PetscArraycpy(s->send + q * s->message + 2 * part, s->Z + 2 * q * part, 2 * part));
  }
  PetscCall(SlabsExchange(s));
  for (PetscMPIInt q = 0; q < s->grid->size; q++) {
    const PetscReal *from = s->all + q * s->message;
    for (int a = 0; a < 4; a++)
      PetscCall(PetscArraycpy((a < 2 ? s->below : s->above) + a % 2 * w + PetscMin(q * part, w), from + a * part,
                              SlabsPartCount(s, q)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y2 of the rows += factor times the contribution of Y from below. */
static void SlabsAddBelow(Slabs s, PetscReal factor) {
  const PetscInt w = s->width;
  const PetscReal *below = s->below;
  PetscInt most = w; /* modes up to the last in which anything comes in */
  while (most > 0 && below[most - 1] == 0 && below[w + most - 1] == 0) most--;
  const PetscInt blocks = (most + BLOCK - 1) / BLOCK;
  for (PetscInt b = 0; b < blocks; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal y1[BLOCK], y2[BLOCK];
    for (int k = 0; k < BLOCK; k++) {
      y1[k] = factor * below[b * BLOCK + k];
      y2[k] = factor * below[w + b * BLOCK + k];
    }
    for (PetscInt j = 0; j < PetscMin(s->factors->reach[b], s->rows); j++) {
      PetscReal *restrict y = s->y + j * w + b * BLOCK;
      if (s->stored[j] <= b) (void)PetscArrayzero(y, BLOCK);
      for (int k = 0; k < BLOCK; k++) {
        y1[k] *= r1[k];
        y2[k] = y1[k] + r2[k] * y2[k];
        y[k] += y2[k];
      }
    }
  }
  for (PetscInt j = 0, b = blocks; j < s->rows; j++) {
    while (b > 0 && s->factors->reach[b - 1] <= j) b--;
    s->stored[j] = PetscMax(s->stored[j], b);
  }
}

PetscErrorCode SlabsClose(Slabs s, PetscReal *sum) {
  PetscFunctionBeginUser;
  SlabsSummarise(s);
  s->own[4 * s->width] = *sum;
  PetscCall(SlabsToParts(s));
  *sum = 0;
  for (PetscMPIInt q = 0; q < s->grid->size; q++) *sum += s->all[q * s->message + s->message - 1];
  SlabsMatchEnds(s);
  PetscCall(SlabsToSlabs(s));
  SlabsAddBelow(s, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SlabsReopen(Slabs s) {
  SlabsAddBelow(s, -1);
}
