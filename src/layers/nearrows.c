#include "layers/nearrows.h"

static inline PetscBool IsOwn(Layout l, PetscInt body) {
  return body >= l->own && body < l->end;
}

/* NearBlockApply with what the compiler has to know. */
static inline void ApplyBlock(Layout l, const NearBlock *b, const PetscBool symmetric, BlockRows values,
                              PetscReal alpha, const PetscScalar source[], PetscScalar velocity[]) {
  const PetscBool back = IsOwn(l, b->column);
  PetscInt rows;
  NearRow r = NearBlockBegin(l, b);
  do {
    PetscScalar *own = symmetric ? velocity + 2 * (r.row - l->first) : NULL;
    PetscScalar *other = back ? velocity + 2 * (r.column - l->first) : NULL;
    values.at = r.at;
    values.stride = r.stride;
    rows = NearBlockIsHalf(b) || r.row + 2 > l->start[b->row + 1] ? 1 : 2;
    if (rows == 2)
      ApplyRows(2, values, alpha, source + 2 * r.row, source + 2 * r.column, own, other);
    else
      ApplyRows(1, values, alpha, source + 2 * r.row, source + 2 * r.column, own, other);
  } while ((rows == 1 || NearBlockNext(l, b, &r)) && NearBlockNext(l, b, &r));
}

void NearBlockApply(Layout l, const NearBlock *b, const NearStore *s, PetscReal alpha, const PetscScalar source[],
                    PetscScalar velocity[]) {
  if (!b->symmetric)
    ApplyBlock(l, b, PETSC_FALSE, (BlockRows){.value = s->value}, alpha, source, velocity);
  else if (b->single)
    ApplyBlock(l, b, PETSC_TRUE, (BlockRows){PETSC_TRUE, s->single}, alpha, source, velocity);
  else
    ApplyBlock(l, b, PETSC_TRUE, (BlockRows){.value = s->value}, alpha, source, velocity);
}

/* The place of row i and column j in a matrix between two ranges. */
static inline PetscInt EntryAt(const MarkerRange *rows, const MarkerRange *columns, PetscInt i, PetscInt j) {
  return (j - 2 * columns->first) * 2 * rows->n + i - 2 * rows->first;
}

void NearBlockAdd(Layout l, const NearBlock *b, const NearStore *s, PetscReal scale, const MarkerRange *rows,
                  const MarkerRange *columns, PetscReal out[]) {
  const PetscBool there = b->symmetric && MarkerRangeHolds(l, b->row, rows) && MarkerRangeHolds(l, b->column, columns);
  const PetscBool back = IsOwn(l, b->column) && MarkerRangeHolds(l, b->column, rows) &&
                         MarkerRangeHolds(l, b->row, columns);
  NearRow r = NearBlockBegin(l, b);
  if (!there && !back) return;
  do
    for (PetscInt k = 0; k < 2 * r.count; k++)
      for (int c = 0; c < 2; c++) {
        const size_t at = r.at + (size_t)(c * r.stride + k);
        const PetscReal value = scale * (b->single ? s->single[at] : s->value[at]);
        const PetscInt i = 2 * r.row + c, j = 2 * r.column + k;
        if (there) out[EntryAt(rows, columns, i, j)] += value;
        if (back) out[EntryAt(rows, columns, j, i)] += value;
      }
  while (NearBlockNext(l, b, &r));
}
