/* Which bodies the near field joins: the list of blocks (nearblock.h), found by cells in a time in proportion to the
   bodies. Every pair of bodies, or of images, is listed once by each rank that owns one of the two: two own ones in the
   first one's rows. Nothing crosses ranks. */
#pragma once
#include "layers/nearblock.h"
#include "mobility/neardistant.h"

#define NEAR_REACH 24 /* cells between two vesicles up to which they have a block */

/* An image of the block's column so near to its row that both need finer points. */
typedef struct {
  PetscInt block;
  FinePair fine;
} NearClose;

/* Entries of the list, and values of its blocks in double and in single precision. */
typedef struct {
  PetscInt blocks, closes;
  size_t values, singles;
} NearCounts;

/* What two obstacles that rest do to one another stays as it is: these come first, and distant pairs among them are
   apart. */
typedef struct {
  LayerPairs pairs; /* borrowed */
  NearBlock *block; /* fixed ones, then others in the order of their rows */
  NearClose *close;
  NearDistant distant;
  NearCounts count, fixed;
  size_t block_room, close_room;
  PetscBool made; /* the fixed ones */
} NearList;

/* NearListCreate - empty. NearListFind - the blocks where the pairs have been placed, without their values; those of
   two obstacles that rest are found the first time. `first`: the first of all blocks that has to get its values. Not
   collective. */
PETSC_EXTERN PetscErrorCode NearListCreate(LayerPairs pairs, NearList *list);
PETSC_EXTERN PetscErrorCode NearListDestroy(NearList *list);
PETSC_EXTERN PetscErrorCode NearListFind(NearList *list, PetscInt *first);
