#include "coupling/offsets.h"

PetscErrorCode OffsetTableCreate(const PetscInt size[2], OffsetTable *t) {
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) t->size[d] = size[d];
  for (int b = 0; b < OFFSET_COUNT; b++) PetscCall(PetscCalloc1((2 * size[0] + 1) * (2 * size[1] + 1), &t->value[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OffsetTableDestroy(OffsetTable *t) {
  PetscFunctionBeginUser;
  for (int b = 0; b < OFFSET_COUNT; b++) PetscCall(PetscFree(t->value[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void StencilPad(const Stencil *s, PaddedStencil *p) {
  for (int dir = 0; dir < 2; dir++) {
    for (int i = 0; i < 3 * KERNEL_MAX_POINTS; i++) p->weight[dir][i] = 0;
    for (PetscInt i = 0; i < s->n[dir]; i++) p->weight[dir][KERNEL_MAX_POINTS + i] = s->weight[dir][i];
    p->first[dir] = s->first[dir];
  }
}

PetscInt StencilLagWeights(int dir, const PaddedStencil *response, const PaddedStencil *source,
                           PetscReal weight[restrict OFFSET_LAGS]) {
  const PetscReal *restrict a = response->weight[dir] + 1, *restrict b = source->weight[dir] + KERNEL_MAX_POINTS;
  for (int q = 0; q < OFFSET_LAGS; q++) {
    PetscReal sum = 0;
    for (int j = 0; j < KERNEL_MAX_POINTS; j++) sum += a[q + j] * b[j];
    weight[q] = sum;
  }
  return response->first[dir] - source->first[dir] - (KERNEL_MAX_POINTS - 1);
}

/* First offset, shifted, inside the table. */
static inline PetscInt LagWeights(const OffsetTable *t, int dir, const PaddedStencil *response,
                                  const PaddedStencil *source, PetscInt shift, PetscReal weight[OFFSET_LAGS]) {
  const PetscInt first = StencilLagWeights(dir, response, source, weight) + shift;
  return PetscMax(-t->size[dir], PetscMin(first, t->size[dir] - OFFSET_LAGS + 1));
}

PetscReal StencilPairSum(const OffsetTable *t, OffsetBlock b, const PaddedStencil *response,
                         const PaddedStencil *source, const PetscInt shift[2]) {
  const PetscInt width = 2 * t->size[0] + 1;
  PetscReal wx[OFFSET_LAGS], wy[OFFSET_LAGS], line[OFFSET_LAGS] = {0}, sum = 0;
  const PetscInt i0 = LagWeights(t, 0, response, source, shift[0], wx);
  const PetscInt j0 = LagWeights(t, 1, response, source, shift[1], wy);
  const PetscReal *row = t->value[b] + (j0 + t->size[1]) * width + i0 + t->size[0];
  for (int j = 0; j < OFFSET_LAGS; j++, row += width)
    for (int i = 0; i < OFFSET_LAGS; i++) line[i] += wy[j] * row[i];
  for (int i = 0; i < OFFSET_LAGS; i++) sum += wx[i] * line[i];
  return sum;
}

PetscReal StencilImageSum(Grid g, const OffsetTable *t, OffsetBlock block, const PaddedStencil *a,
                          const PaddedStencil *b, const PetscReal d[2]) {
  PetscInt cells[2];
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal off = d[dir] / g->h - (PetscReal)(a->first[dir] - b->first[dir]);
    cells[dir] = g->n[dir] * (PetscInt)PetscFloorReal(off / g->n[dir] + 0.5);
  }
  return StencilPairSum(t, block, a, b, cells);
}
