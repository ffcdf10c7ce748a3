/* What fills a row of a block (nearblock.h) with pairs of a source and a response, a few at once: loops over four
   pairs, which each kernel's file instantiates with its own functions, so that the compiler sees through them. Nothing
   crosses ranks. */
#pragma once
#include "layers/layerpairs.h"

#define PAIR_INLINE __attribute__((always_inline)) static inline

/* Some pairs of a row: marker i with markers j .. j + n - 1 of a body that is moved by `shift` (length). The row is the
   source where it has normals, and of a symmetric kernel where its body is not the first of the two. All arrays have
   room for whole vectors. */
#define CHUNK 96
struct _p_PairChunk {
  PetscInt i, j, n, column; /* column: the body of the j */
  PetscReal shift[2];
  PetscBool half, back, exact;
  PetscBool plain, alone;     /* far from all walls; no j is within the stencils' reach */
  PetscBool walls[4], off[4]; /* whose images count; from which it is far */
  PetscReal reach;            /* of stencils' sums (length) */
  Lanes N[2];                 /* of the source */
  PetscReal *shared[4];       /* [column] L of the row by faces that markers share (dipolefaces.h); NULL: by pairs */
  PetscReal *flux[2];         /* [column] SUM L n; NULL: not wanted */
  PetscReal d[2][CHUNK];      /* from source to response */
  PetscReal part[CHUNK], K[4][CHUNK], C[4][CHUNK]; /* K: with flux, else not set; what is kept of C */
};

/* K of four pairs; none of a marker with itself. */
PAIR_INLINE void PairChunkFree(const PairKernel *const kernel, LayerPairs f, const PairChunk *c, PetscInt k,
                               Lanes K[4]) {
  const Lanes x = LanesAt(c->d[0] + k), y = LanesAt(c->d[1] + k);
  const LanesBits apart = (LanesBits)(x * x + y * y > 0);
  Lanes three[3];
  PairFree(kernel, f->set, x, y, c->N, three);
  for (int q = 0; q < 4; q++) K[q] = LanesWhere(apart, three[PetscMin(q, 2)]);
}

/* K of all pairs, with the exact images in walls. */
PAIR_INLINE void PairChunkExact(const PairKernel *const kernel, LayerPairs f, const PairChunk *c,
                                PetscReal to[4][CHUNK]) {
  const PetscReal cell = 1 / f->set->markers->grid->h;
  for (PetscInt k = 0; k < c->n; k += LANES) {
    Lanes K[4], part[PAIR_PARTS], image[4];
    PairChunkFree(kernel, f, c, k, K);
    for (int wall = 0; wall < 4; wall++) {
      if (!c->walls[wall]) continue;
      const PetscReal *y = f->image->y[wall];
      const Lanes one = y[c->i] + (Lanes){0}, other = LanesAt(y + c->j + k);
      WallImageFour(
          kernel, f->image, wall, PETSC_TRUE,
          (const Lanes[]){cell * LanesAt(c->d[1 - wall / 2] + k), c->back ? other : one, c->back ? one : other}, part);
      kernel->contract(part, c->N, image);
      for (int q = 0; q < 4; q++) K[q] += image[q];
    }
    for (int q = 0; q < 4; q++) LanesPut(K[q], to[q] + k);
  }
}

/* All pairs as if they were distant. */
PAIR_INLINE void PairChunkFar(const PairKernel *const kernel, LayerPairs f, PairChunk *c) {
  const PetscReal cell = 1 / f->set->markers->grid->h;
  for (PetscInt k = 0; k < c->n; k += LANES) {
    Lanes part[PAIR_PARTS], C[4];
    kernel->far(f, c->i, c->j + k, c->back, cell * LanesAt(c->d[0] + k), cell * LanesAt(c->d[1] + k), part);
    kernel->contract(part, c->N, C);
    for (int q = 0; q < 4; q++) LanesPut(C[q], c->C[q] + k);
  }
}

/* L of four pairs by parts, and what walls that are near add to C: closed forms for distant ones, sums for others. */
PAIR_INLINE void PairChunkParts(const PairKernel *const kernel, LayerPairs f, const PairChunk *c, PetscInt k,
                                LanesBits near, Lanes L[], Lanes wall[]) {
  const int parts = kernel->places.parts;
  const PetscReal cell = 1 / f->set->markers->grid->h, cells = cell * c->reach;
  const Lanes x = LanesAt(c->d[0] + k), y = LanesAt(c->d[1] + k);
  Lanes C[PAIR_PARTS];
  for (int q = 0; q < parts; q++) L[q] = wall[q] = (Lanes){0};
  if (!c->plain && LanesAny(~near)) {
    kernel->parts(f->set, x, y, L);
    kernel->far(f, c->i, c->j + k, c->back, cell * x, cell * y, C);
    for (int q = 0; q < parts; q++) L[q] -= C[q];
  }
  for (int t = 0; t < LANES && k + t < c->n; t++) {
    const PetscInt j = c->j + k + t, from = c->back ? c->i : j, to = c->back ? j : c->i;
    const PetscReal d[2] = {x[t], y[t]};
    PetscReal own[PAIR_PARTS], add[PAIR_PARTS] = {0};
    if (c->plain && !near[t]) continue;
    if (near[t]) {
      LayerPairLattice(f, cells, to, from, d, own);
      for (int q = 0; q < parts; q++) L[q][t] = own[q];
    }
    if (c->plain) continue;
    for (int q = 0; q < parts; q++) own[q] = L[q][t];
    WallImageAdd(f->image, c->off, to, from, d, own, add);
    for (int q = 0; q < parts; q++) wall[q][t] = add[q];
  }
}

/* Pairs within the stencils' reach, or all where walls are near. */
PAIR_INLINE void PairChunkNear(const PairKernel *const kernel, LayerPairs f, PairChunk *c) {
  for (PetscInt k = 0; k < c->n; k += LANES) {
    const Lanes x = LanesAt(c->d[0] + k), y = LanesAt(c->d[1] + k);
    const LanesBits near = (LanesBits)(x * x + y * y <= c->reach * c->reach);
    const LanesBits meant = c->plain ? near : ~(LanesBits){0};
    Lanes K[4], part[PAIR_PARTS], wall[PAIR_PARTS], L[4], W[4];
    if (c->plain && !LanesAny(near)) continue;
    PairChunkFree(kernel, f, c, k, K);
    PairChunkParts(kernel, f, c, k, near, part, wall);
    kernel->contract(part, c->N, L);
    kernel->contract(wall, c->N, W);
    for (int q = 0; q < 4; q++) {
      Lanes C = LanesWhere(meant, K[q] - L[q] + W[q]);
      if (c->plain) C += LanesWhere(~near, LanesAt(c->C[q] + k));
      LanesPut(C, c->C[q] + k);
    }
  }
}

/* All pairs with L of shared faces. */
PAIR_INLINE void PairChunkShared(const PairKernel *const kernel, LayerPairs f, PairChunk *c) {
  const PetscInt at = c->j - f->set->markers->layout->start[c->column];
  for (PetscInt k = 0; k < c->n; k += LANES) {
    Lanes K[4];
    PairChunkFree(kernel, f, c, k, K);
    for (int q = 0; q < 4; q++) LanesPut(K[q] - LanesAt(c->shared[q] + at + k), c->C[q] + k);
  }
}

/* C of the images in walls that are far. */
PAIR_INLINE void PairChunkImages(const PairKernel *const kernel, LayerPairs f, PairChunk *c) {
  const PetscReal cell = 1 / f->set->markers->grid->h;
  for (int wall = 0; wall < 4; wall++) {
    if (!c->walls[wall] || !c->off[wall]) continue;
    const PetscReal *y = f->image->y[wall];
    const Lanes one = y[c->i] + (Lanes){0};
    for (PetscInt k = 0; k < c->n; k += LANES) {
      const Lanes other = LanesAt(y + c->j + k);
      Lanes part[PAIR_PARTS], C[4];
      WallImageFour(
          kernel, f->image, wall, PETSC_FALSE,
          (const Lanes[]){cell * LanesAt(c->d[1 - wall / 2] + k), c->back ? other : one, c->back ? one : other}, part);
      kernel->contract(part, c->N, C);
      for (int q = 0; q < 4; q++) LanesPut(LanesAt(c->C[q] + k) + C[q], c->C[q] + k);
    }
  }
}

/* flux += L n, L = K - C. */
PAIR_INLINE void PairChunkFlux(const PairKernel *const kernel, LayerPairs f, PairChunk *c) {
  const PetscReal over = 1 / f->from.along[c->i];
  const PetscInt at = c->j - f->set->markers->layout->start[c->column];
  PairChunkExact(kernel, f, c, c->K);
  for (PetscInt k = 0; k < c->n; k += LANES)
    for (int dir = 0; dir < 2; dir++) {
      const int to[2] = {dir ? 3 : 0, dir ? 1 : 2};
      Lanes sum = LanesAt(c->flux[dir] + at + k);
      for (int q = 0; q < 2; q++)
        sum += LanesAt(c->part + k) * over * c->N[q] * (LanesAt(c->K[to[q]] + k) - LanesAt(c->C[to[q]] + k));
      LanesPut(sum, c->flux[dir] + at + k);
    }
}

/* PairChunkFill - C of a chunk whose distances are set. Not collective. */
PAIR_INLINE void PairChunkFill(const PairKernel *const kernel, LayerPairs f, PairChunk *c) {
  if (c->exact) {
    PairChunkExact(kernel, f, c, c->C);
    return;
  }
  if (c->plain && c->shared[0])
    PairChunkShared(kernel, f, c);
  else {
    if (c->plain) PairChunkFar(kernel, f, c);
    if (!c->plain || !c->alone) PairChunkNear(kernel, f, c);
  }
  PairChunkImages(kernel, f, c);
  if (c->flux[0]) PairChunkFlux(kernel, f, c);
}
