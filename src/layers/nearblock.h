/* Blocks of C = K - L (layerpairs.h) between the markers of two bodies, or of one and an image of the other. Of a
   symmetric kernel a block is the velocities of the row's markers by forces on those of the column, and the other way
   round,

       U_v += C_vw F_w,     U_w += C_vw^T F_v,

   so that each pair of bodies has one block. It lies in rows, two for each marker of the first body, its x and its y
   velocity, with columns interlaced. A body's block with itself has of each row what is right of the diagonal, and of a
   marker with itself the half. Of another kernel the row's markers are the sources, two rows for each, of J_x and of
   J_y, and the columns the responses; C is then

       C = K - L Q,

   Q what takes the net flux SUM w J.n off a body, as spreading on the grid does. Nothing crosses ranks: a block is in
   the store of the rank that owns its first body, or its responses. */
#pragma once
#include "layers/finecurve.h"
#include "layers/layerpairs.h"

typedef struct {
  PetscInt row, column; /* bodies */
  PetscReal shift[2];   /* of the column's image (length) */
  PetscBool symmetric;  /* its kernel */
  PetscBool single;     /* in single precision */
  size_t at;            /* in the store's value, or single */
} NearBlock;

/* The blocks' values in double and in single precision, and room for so many. */
typedef struct {
  PetscReal *value;
  float *single;
  size_t value_room, single_room;
} NearStore;

/* NearBlockIsSelf - whether it is of a body with itself, not with an image. */
static inline PetscBool NearBlockIsSelf(const NearBlock *b) {
  return b->row == b->column && b->shift[0] == 0 && b->shift[1] == 0;
}

/* NearBlockIsHalf - whether its rows are what is right of the diagonal. */
static inline PetscBool NearBlockIsHalf(const NearBlock *b) {
  return b->symmetric && NearBlockIsSelf(b);
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
  if (NearBlockIsHalf(b)) {
    r->column++;
    r->stride = NearStride(--r->count);
  }
  return PETSC_TRUE;
}

/* NearBlockValues - how many a block has.

   NearBlockFill - the values of a block where the pairs have been placed, with finer points of images in walls that are
   near; exact: K and its exact images in walls alone, as in unbounded fluid. NearBlockRefine - to the block the
   difference between finer points of two curves near one another, or of one and an image, and their markers; fine: the
   responses' curve, then the sources'. Not collective. */
PETSC_EXTERN size_t NearBlockValues(Layout layout, const NearBlock *block);
PETSC_EXTERN PetscErrorCode NearBlockFill(LayerPairs pairs, const NearBlock *block, PetscBool exact, NearStore *store);
PETSC_EXTERN PetscErrorCode NearBlockRefine(LayerPairs pairs, const NearBlock *block, const FinePair *fine,
                                            NearStore *store);
