/* Images that are nearer to a curve than its markers are to one another: chi(R) times Blake's image is exchanged
   between markers and finer points, R the distance to the image and chi a smooth window. */
#include "coupling/wallclose.h"
#include "coupling/finecurve.h"

#define CLOSE 2      /* spacings from a curve to an image, below which finer points are needed */
#define FINE 2.5     /* fine points from a curve to an image */
#define MOST_FINE 64 /* times the markers */
#define WINDOW 8     /* spacings */

/* Place of a wall whose normal is in `direction`. */
static PetscReal WallPlace(Grid g, int direction, int side) {
  return side ? g->hi[direction] : g->lo[direction];
}

/* chi times Blake's image for all pairs of points in use, b's being mirrored: K of each part [count_b][count_a]. */
static void Images(Grid g, int direction, int side, const FineCurve *a, const FineCurve *b, PetscReal window,
                   PetscReal *K[IMAGE_PARTS]) {
  const PetscReal wall = WallPlace(g, direction, side), inward = (side ? -1 : 1) / g->h;
  for (PetscInt q = 0; q < b->count; q++)
    for (PetscInt p = 0; p < a->count; p++) {
      const PetscReal *x = a->x + 2 * a->used[p], *y = b->x + 2 * b->used[q];
      const PetscReal R = PetscSqrtReal(PetscSqr(x[0] - y[0]) + PetscSqr(x[1] - y[1])), chi = FineWindow(R, window);
      const ImagePair pair = {(x[1 - direction] - y[1 - direction]) / g->h, inward * (x[direction] - wall),
                              inward * (wall - y[direction])};
      PetscReal image[IMAGE_PARTS];
      NearImageBlake(&pair, image);
      for (int c = 0; c < IMAGE_PARTS; c++) K[c][q * a->count + p] = chi * image[c];
    }
}

/* block += the parts [n_b][n_a], turned from the wall's directions to x and y. */
static void AddParts(NearBlock *block, const FineCurve *a, const FineCurve *b, int direction, int side,
                     PetscReal factor, PetscReal *part[IMAGE_PARTS]) {
  for (PetscInt j = 0; j < b->n; j++)
    for (PetscInt i = 0; i < a->n; i++) {
      PetscReal C[4] = {0, 0, 0, 0}, one[IMAGE_PARTS], *at = block->C + 4 * j * a->n + 2 * i;
      for (int c = 0; c < IMAGE_PARTS; c++) one[c] = part[c][j * a->n + i];
      NearImageTurn(direction, side, factor, one, C);
      at[0] += C[0];
      at[1] += C[3];
      at[2 * a->n] += C[2];
      at[2 * a->n + 1] += C[1];
    }
}

/* The block of images in one wall at `factor` times the markers, windowed, times alpha. */
static PetscErrorCode AddAt(NearField f, NearBlock *block, int direction, int side, PetscInt factor, PetscReal window,
                            PetscReal alpha) {
  const Grid g = f->markers->grid;
  const PetscReal none[2] = {0, 0};
  PetscReal *K[IMAGE_PARTS], *part[IMAGE_PARTS];
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(f, block->row, none, factor, &a));
  PetscCall(FineCurveCreate(f, block->column, block->shift, factor, &b));
  FineCurveReflect(&b, direction, WallPlace(g, direction, side));
  PetscCall(FineCurvePair(&a, &b, window));
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(PetscMalloc2(a.count * b.count, &K[c], a.n * b.n, &part[c]));
  Images(g, direction, side, &a, &b, window, K);
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(FineCurveProject(&a, &b, K[c], part[c]));
  AddParts(block, &a, &b, direction, side, alpha / f->nu, part);
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(PetscFree2(K[c], part[c]));
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells from the wall to the nearest marker of a vesicle. */
static PetscReal Nearest(NearField f, PetscInt v, const ImageEnd end[]) {
  const Layout l = f->membrane->layout;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt k = l->start[v]; k < l->start[v + 1]; k++) least = PetscMin(least, end[k].y);
  return least;
}

PetscErrorCode NearBlockRefineAtWalls(NearField f, NearBlock *block) {
  const PetscReal h = f->markers->grid->h, ds = PetscMax(f->membrane->ds[block->row], f->membrane->ds[block->column]);
  PetscFunctionBeginUser;
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2; side++) {
      const ImageEnd *end = f->image->end[direction][side];
      if (!end) continue;
      const PetscReal gap = h * (Nearest(f, block->row, end) + Nearest(f, block->column, end));
      if (gap > CLOSE * ds) continue;
      const PetscInt factor = (PetscInt)PetscMin(MOST_FINE, PetscCeilReal(FINE * ds / gap));
      PetscCall(AddAt(f, block, direction, side, factor, WINDOW * ds, 1));
      PetscCall(AddAt(f, block, direction, side, 1, WINDOW * ds, -1));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
