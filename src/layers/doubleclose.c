/* The double layer between curves near one another, and of images in a wall near them, on finer points. */
#include "layers/doubleblock.h"

/* Parts in a block: from J_x to u, v, then from J_y. */
static void FreeKernel(const void *pairs, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2],
                       Lanes K[]) {
  Lanes D[3];
  StressletFour(x[0] - y[0], x[1] - y[1], N, D);
  K[0] = D[0];
  K[1] = K[2] = D[2];
  K[3] = D[1];
}

static void WallKernel(const void *pairs, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2],
                       Lanes K[]) {
  const DoublePairs *s = (const DoublePairs *)pairs;
  Lanes seen[3];
  NearImageSeen(s->single->set->markers->grid, wall, x, y, seen);
  for (int q = 0; q < LANES; q++) {
    PetscReal image[2][DIPOLE_COUNT] = {{0}}, M[4];
    DoubleImageExact(s->image, wall, &(ImagePair){seen[0][q], seen[1][q], -seen[2][q]}, image); /* y is mirrored */
    DipoleContract((const PetscReal(*)[DIPOLE_COUNT])image, N, 1, M);
    for (int c = 0; c < 4; c++) K[c][q] = M[c];
  }
}

PetscErrorCode DoubleBlockRefine(const DoublePairs *s, const FinePair *pair, PetscReal value[]) {
  const Layout l = s->single->set->markers->layout;
  const PetscInt n = LayoutCount(l, pair->row), m = LayoutCount(l, pair->column);
  const FineKernel kernel = {4, pair->wall < 0 ? FreeKernel : WallKernel, s, s->normal + 2 * l->start[pair->column]};
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * n * m, &part));
  for (int fine = 1; fine >= 0; fine--) {
    PetscCall(FinePairParts(s->single->set, pair, (PetscBool)fine, &kernel, part));
    for (PetscInt k = 0; k < 4 * n * m; k++) {
      const PetscInt c = k / (n * m), j = k / n % m, i = k % n;
      value[(2 * j + c / 2) * 2 * n + 2 * i + c % 2] += fine ? part[k] : -part[k];
    }
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBlockRefineAtWalls(const DoublePairs *s, const DoubleBlock *b, PetscReal value[]) {
  PetscFunctionBeginUser;
  for (int wall = 0; wall < 4; wall++) {
    FinePair pair = {.row = b->row, .column = b->column, .shift = {b->shift[0], b->shift[1]}};
    if (FinePairAtWall(s->single->set, s->single->bounds, wall, &pair)) PetscCall(DoubleBlockRefine(s, &pair, value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
