/* The numbers of the near field: pairs of markers. */
#pragma once
#include "coupling/nearfield.h"

#define NEAR_REACH 24        /* cells between two vesicles up to which they have a block */
#define NEAR_MANY 16         /* vesicles: with more of them, */
#define NEAR_SINGLE 4        /* cells between two from which on their block is in single precision */
#define NEAR_IMAGE_REACH 300 /* cells between a vesicle and another one's image in a wall: beyond, none */

/* NearBlockIsSelf - whether it is of a vesicle with itself, not with an image. */
static inline PetscBool NearBlockIsSelf(const NearBlock *b) {
  return b->row == b->column && b->shift[0] == 0 && b->shift[1] == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* One marker's two rows of a block, the y row a stride behind. */
typedef struct {
  PetscInt row, column, count; /* marker; the first of the columns' markers, how many */
  PetscInt stride;             /* whole vectors, zeros behind the last marker */
  size_t at;                   /* in the store's value, or single */
} NearRow;

/* NearBlockBegin - of a block's first marker; NearBlockNext - of the next one; false when there is none. */
static inline PetscInt NearStride(PetscInt count) {
  return 4 * ((count + 1) / 2);
}
static inline NearRow NearBlockBegin(Layout l, const NearBlock *b) {
  const PetscInt count = LayoutCount(l, b->column);
  return (NearRow){l->start[b->row], l->start[b->column], count, NearStride(count), b->at};
}
static inline PetscBool NearBlockNext(Layout l, const NearBlock *b, NearRow *r) {
  r->at += 2 * (size_t)r->stride;
  if (++r->row == l->start[b->row + 1]) return PETSC_FALSE;
  if (NearBlockIsSelf(b)) {
    r->column++;
    r->stride = NearStride(--r->count);
  }
  return PETSC_TRUE;
}

/* NearValue - a block's value at this place. NearValueAdd - it += x. */
static inline PetscReal NearValue(NearField f, const NearBlock *b, size_t at) {
  return b->single ? f->store.single[at] : f->store.value[at];
}
static inline void NearValueAdd(NearField f, const NearBlock *b, size_t at, PetscReal x) {
  if (b->single)
    f->store.single[at] = (float)(f->store.single[at] + x);
  else
    f->store.value[at] += x;
}

/* NearBlockFill - the values of the block at the present markers, close curves not yet refined (nearclose.h). Not
   collective. */
PETSC_EXTERN PetscErrorCode NearBlockFill(NearField near, const NearBlock *block);

/* NearBlockAdd - the block += parts xx, yy, xy, yx, [n_column][n_row] each; where it is of a vesicle with itself, of
   one of the two of each pair. Not collective. */
PETSC_EXTERN void NearBlockAdd(NearField near, const NearBlock *block, PetscReal scale, PetscReal *const part[4]);

/* NearLatticePair - L of markers i and j, d = X_i - X_j (length) that of the image meant: xx, yy, xy, yx. By stencils
   as far as the table goes, by closed form beyond. Of `near` it reads markers, stencil, lattice, far and nu. Not
   collective. */
PETSC_EXTERN void NearLatticePair(NearField near, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]);
