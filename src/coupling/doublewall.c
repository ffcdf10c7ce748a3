/* As wallclose.c: chi(R) times the exact image is exchanged between markers and finer points. */
#include "coupling/doublewall.h"
#include "coupling/doubleclose.h"
#include "coupling/finecurve.h"
#include "coupling/wallclose.h"

/* chi times the image's response of a's points in use to J at b's, which are mirrored, of normals N: [4][count_b]
   [count_a], as DipoleContract. */
static void Images(DoubleLayer s, int direction, int side, const FineCurve *a, const FineCurve *b, const PetscReal N[],
                   PetscReal window, PetscReal *const K[4]) {
  const Grid g = s->near->markers->grid;
  const PetscReal wall = side ? g->hi[direction] : g->lo[direction], inward = (side ? -1 : 1) / g->h;
  for (PetscInt q = 0; q < b->count; q++)
    for (PetscInt p = 0; p < a->count; p++) {
      const PetscReal *x = a->x + 2 * a->used[p], *y = b->x + 2 * b->used[q];
      const PetscReal R = PetscHypotReal(x[0] - y[0], x[1] - y[1]);
      const ImagePair pair = {(x[1 - direction] - y[1 - direction]) / g->h, inward * (x[direction] - wall),
                              inward * (wall - y[direction])};
      PetscReal image[2][DIPOLE_COUNT] = {{0}}, M[4];
      DoubleImageExact(s->image, direction, side, &pair, image);
      DipoleContract((const PetscReal(*)[DIPOLE_COUNT])image, N + 2 * q, FineWindow(R, window), M);
      for (int c = 0; c < 4; c++) K[c][q * a->count + p] = M[c];
    }
}

/* The images in one wall at `factor` times the markers, windowed, times sign. */
static PetscErrorCode AddAt(DoubleLayer s, const DoubleBlock *block, int direction, int side,
                            const WallCloseness *close, PetscBool fine, PetscReal value[]) {
  const Grid g = s->near->markers->grid;
  const PetscReal none[2] = {0, 0}, sign = fine ? 1 : -1;
  const PetscInt factor = fine ? close->factor : 1;
  PetscReal *K[4], *part[4], *N;
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(s->near, block->row, none, factor, &a));
  PetscCall(FineCurveCreate(s->near, block->column, block->shift, factor, &b));
  FineCurveReflect(&b, direction, side ? g->hi[direction] : g->lo[direction]);
  PetscCall(FineCurvePair(&a, &b, close->window));
  PetscCall(PetscMalloc1(2 * b.count, &N));
  for (int c = 0; c < 4; c++) PetscCall(PetscMalloc2(a.count * b.count, &K[c], a.n * b.n, &part[c]));
  DoubleCloseNormals(&b, s->normal + 2 * s->near->bodies->layout->start[block->column], N);
  Images(s, direction, side, &a, &b, N, close->window, K);
  for (int c = 0; c < 4; c++) {
    PetscCall(FineCurveProject(&a, &b, K[c], part[c]));
    for (PetscInt j = 0; j < b.n; j++)
      for (PetscInt i = 0; i < a.n; i++)
        value[(2 * j + c / 2) * 2 * a.n + 2 * i + c % 2] += sign * part[c][j * a.n + i];
    PetscCall(PetscFree2(K[c], part[c]));
  }
  PetscCall(PetscFree(N));
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleWallAdd(DoubleLayer s, const DoubleBlock *b, PetscReal value[]) {
  WallCloseness close;
  PetscFunctionBeginUser;
  for (int wall = 0; wall < 4 && s->image; wall++) {
    if (!s->image->end[wall / 2][wall % 2]) continue;
    if (!WallIsClose(s->near, b->row, b->column, wall / 2, wall % 2, &close)) continue;
    PetscCall(AddAt(s, b, wall / 2, wall % 2, &close, PETSC_TRUE, value));
    PetscCall(AddAt(s, b, wall / 2, wall % 2, &close, PETSC_FALSE, value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
