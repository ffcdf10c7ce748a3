/* Images that are nearer to a curve than its markers are to one another: chi(R) times Blake's image is exchanged
   between markers and finer points, R the distance to the image and chi a smooth window. */
#include "coupling/wallclose.h"
#include "coupling/finecurve.h"
#include "coupling/nearblock.h"

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

/* The block of images in one wall at `factor` times the markers, windowed, times alpha. */
static PetscErrorCode AddAt(NearField f, const NearBlock *block, int direction, int side, PetscInt factor,
                            PetscReal window, PetscReal alpha) {
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
  if (side) /* the wall's directions turned to x and y */
    for (int c = IMAGE_NT; c <= IMAGE_TN; c++)
      for (PetscInt k = 0; k < a.n * b.n; k++) part[c][k] *= -1;
  NearBlockAdd(f, block, alpha / f->nu,
               direction ? (PetscReal *[4]){part[IMAGE_TT], part[IMAGE_NN], part[IMAGE_TN], part[IMAGE_NT]}
                         : (PetscReal *[4]){part[IMAGE_NN], part[IMAGE_TT], part[IMAGE_NT], part[IMAGE_TN]});
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(PetscFree2(K[c], part[c]));
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool WallIsClose(NearField f, PetscInt row, PetscInt column, int direction, int side, WallCloseness *close) {
  const PetscReal ds = PetscMax(f->bodies->ds[row], f->bodies->ds[column]);
  const PetscReal gap = NearImageGap(f->markers->grid, direction, side, &f->bounds[row], &f->bounds[column]);
  *close = (WallCloseness){1, WINDOW * ds};
  if (gap > CLOSE * ds) return PETSC_FALSE;
  close->factor = (PetscInt)PetscMin(MOST_FINE, PetscCeilReal(FINE * ds / gap));
  return PETSC_TRUE;
}

PetscErrorCode NearBlockRefineAtWalls(NearField f, const NearBlock *b) {
  WallCloseness close;
  PetscFunctionBeginUser;
  for (int end = 0; end < 2; end++)
    if (f->bodies->kind[end ? b->column : b->row].type != CURVE_CLOSED) PetscFunctionReturn(PETSC_SUCCESS);
  for (int wall = 0; wall < 4; wall++) {
    const int direction = wall / 2, side = wall % 2;
    if (!f->image->end[direction][side]) continue;
    if (!WallIsClose(f, b->row, b->column, direction, side, &close)) continue;
    PetscCall(AddAt(f, b, direction, side, close.factor, close.window, 1));
    PetscCall(AddAt(f, b, direction, side, 1, close.window, -1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
