/* With P the trigonometric interpolation from a curve's n markers to f n points, an image B between two curves becomes
   P_a^T B_fine P_b/(f_a f_b): symmetric by construction. Only points that are near the others' images need it: chi(R) B
   is exchanged, chi a smooth window. */
#include "coupling/wallclose.h"

#define CLOSE 2      /* spacings from a curve to an image, below which finer points are needed */
#define FINE 2.5     /* fine points from a curve to an image */
#define MOST_FINE 64 /* times the markers */
#define WINDOW 8     /* spacings: chi is zero beyond, and 1 up to a third of it */

/* A curve's points at f times its markers, seen from a wall in cells: along it and from it; and those that count. */
typedef struct {
  PetscInt n, f, count;
  PetscReal *weight; /* [f n] P by index difference: P_qk = weight[(q - f k) mod f n] */
  PetscReal *x;      /* [f n][2] */
  PetscInt *used;
} WallCurve;

/* Cardinal function of trigonometric interpolation on n points. */
static PetscReal Cardinal(PetscInt n, PetscReal t) {
  const PetscReal s = PetscSinReal(0.5 * t);
  if (PetscAbsReal(s) < 1e-14) return 1;
  return PetscSinReal(0.5 * n * t) / (n * (n % 2 ? s : PetscTanReal(0.5 * t)));
}

static PetscErrorCode CreateCurve(NearField f, PetscInt v, const PetscReal shift[2], int direction, int side,
                                  PetscInt factor, WallCurve *c) {
  const Grid g = f->markers->grid;
  const PetscInt n = LayoutCount(f->membrane->layout, v), Q = n * factor;
  const PetscReal *X = f->markers->X + 2 * f->membrane->layout->start[v];
  PetscFunctionBeginUser;
  *c = (WallCurve){.n = n, .f = factor};
  PetscCall(PetscMalloc3(Q, &c->weight, 2 * Q, &c->x, Q, &c->used));
  for (PetscInt q = 0; q < Q; q++) c->weight[q] = Cardinal(n, 2 * PETSC_PI * q / Q);
  for (PetscInt q = 0; q < Q; q++) {
    PetscReal x[2] = {shift[0], shift[1]};
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal weight = c->weight[((q - factor * k) % Q + Q) % Q];
      for (int d = 0; d < 2; d++) x[d] += weight * X[2 * k + d];
    }
    c->x[2 * q] = x[1 - direction] / g->h;
    c->x[2 * q + 1] = (side ? g->hi[direction] - x[direction] : x[direction] - g->lo[direction]) / g->h;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyCurve(WallCurve *c) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(c->weight, c->x, c->used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From a point to another one's image. */
static PetscReal Distance(const PetscReal a[2], const PetscReal b[2]) {
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] + b[1]));
}

/* The points of a with an image of a point of b in the window. */
static void SelectPoints(WallCurve *a, const WallCurve *b, PetscReal window) {
  for (PetscInt p = 0; p < a->n * a->f; p++)
    for (PetscInt q = 0; q < b->n * b->f; q++)
      if (Distance(a->x + 2 * p, b->x + 2 * q) < window) {
        a->used[a->count++] = p;
        break;
      }
}

/* The window times Blake's image at fine points: G of each part [count_a][count_b]. */
static void Images(const WallCurve *a, const WallCurve *b, PetscReal window, PetscReal *G[IMAGE_PARTS]) {
  for (PetscInt p = 0; p < a->count; p++)
    for (PetscInt q = 0; q < b->count; q++) {
      const PetscReal *x = a->x + 2 * a->used[p], *y = b->x + 2 * b->used[q];
      const PetscReal t = PetscMin(1, PetscMax(0, (Distance(x, y) / window - 1. / 3) * 1.5));
      const ImagePair pair = {x[0] - y[0], x[1], y[1]};
      PetscReal image[IMAGE_PARTS];
      NearImageBlake(&pair, image);
      for (int c = 0; c < IMAGE_PARTS; c++) G[c][p * b->count + q] = (1 - t * t * (3 - 2 * t)) * image[c];
    }
}

/* R[n][columns] += P^T G/f of the curve's points that count, G[count][columns]. */
static void Project(const WallCurve *c, PetscInt columns, const PetscReal G[], PetscReal R[]) {
  const PetscInt Q = c->n * c->f;
  for (PetscInt p = 0; p < c->count; p++)
    for (PetscInt k = 0; k < c->n; k++) {
      const PetscReal weight = c->weight[((c->used[p] - c->f * k) % Q + Q) % Q] / c->f;
      for (PetscInt q = 0; q < columns; q++) R[k * columns + q] += weight * G[p * columns + q];
    }
}

static void Transpose(PetscInt rows, PetscInt columns, const PetscReal A[], PetscReal T[]) {
  for (PetscInt i = 0; i < rows; i++)
    for (PetscInt j = 0; j < columns; j++) T[j * rows + i] = A[i * columns + j];
}

/* part[n_b][n_a] of each part: P_a^T (chi B) P_b, transposed. */
static PetscErrorCode ProjectedImages(const WallCurve *a, const WallCurve *b, PetscReal window,
                                      PetscReal *part[IMAGE_PARTS]) {
  PetscReal *G[IMAGE_PARTS], *half, *turned;
  PetscFunctionBeginUser;
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(PetscMalloc1(a->count * b->count, &G[c]));
  PetscCall(PetscMalloc2(a->n * b->count, &half, a->n * b->count, &turned));
  Images(a, b, window, G);
  for (int c = 0; c < IMAGE_PARTS; c++) {
    PetscCall(PetscArrayzero(half, a->n * b->count));
    PetscCall(PetscArrayzero(part[c], a->n * b->n));
    Project(a, b->count, G[c], half);
    Transpose(a->n, b->count, half, turned);
    Project(b, a->n, turned, part[c]);
    PetscCall(PetscFree(G[c]));
  }
  PetscCall(PetscFree2(half, turned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block of images in one wall at `factor` times the markers, windowed, times alpha. */
static PetscErrorCode AddAt(NearField f, NearBlock *block, int direction, int side, PetscInt factor, PetscReal window,
                            PetscReal alpha) {
  const PetscReal none[2] = {0, 0};
  PetscReal *part[IMAGE_PARTS];
  WallCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(CreateCurve(f, block->row, none, direction, side, factor, &a));
  PetscCall(CreateCurve(f, block->column, block->shift, direction, side, factor, &b));
  SelectPoints(&a, &b, window);
  SelectPoints(&b, &a, window);
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(PetscMalloc1(a.n * b.n, &part[c]));
  PetscCall(ProjectedImages(&a, &b, window, part));
  for (PetscInt j = 0; j < b.n; j++)
    for (PetscInt i = 0; i < a.n; i++) {
      PetscReal C[4] = {0, 0, 0, 0}, one[IMAGE_PARTS], *at = block->C + 4 * j * a.n + 2 * i;
      for (int c = 0; c < IMAGE_PARTS; c++) one[c] = part[c][j * a.n + i];
      NearImageTurn(direction, side, alpha / f->nu, one, C);
      at[0] += C[0];
      at[1] += C[3];
      at[2 * a.n] += C[2];
      at[2 * a.n + 1] += C[1];
    }
  for (int c = 0; c < IMAGE_PARTS; c++) PetscCall(PetscFree(part[c]));
  PetscCall(DestroyCurve(&a));
  PetscCall(DestroyCurve(&b));
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
  const PetscReal ds = PetscMax(f->membrane->ds[block->row], f->membrane->ds[block->column]) / f->markers->grid->h;
  PetscFunctionBeginUser;
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2; side++) {
      const ImageEnd *end = f->image->end[direction][side];
      if (!end) continue;
      const PetscReal gap = Nearest(f, block->row, end) + Nearest(f, block->column, end);
      if (gap > CLOSE * ds) continue;
      const PetscInt factor = (PetscInt)PetscMin(MOST_FINE, PetscCeilReal(FINE * ds / gap));
      PetscCall(AddAt(f, block, direction, side, factor, WINDOW * ds, 1));
      PetscCall(AddAt(f, block, direction, side, 1, WINDOW * ds, -1));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
