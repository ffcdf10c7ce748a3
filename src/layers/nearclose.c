/* The single layer between curves near one another, and of images in a wall near them, on finer points. */
#include "layers/nearblock.h"

static void FreeKernel(const void *set, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2],
                       Lanes K[]) {
  StokesletFour((const LayerSetting *)set, x[0] - y[0], x[1] - y[1], K);
}

static void WallKernel(const void *set, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2],
                       Lanes K[]) {
  Lanes seen[3];
  NearImageSeen(((const LayerSetting *)set)->markers->grid, wall, x, y, seen);
  NearImageBlake(seen[0], seen[1], -seen[2], K); /* y is mirrored */
}

/* The block += scale times parts xx, yy, xy, yx, [n_column][n_row] each; where it is of a body with itself, of one of
   the two of each pair. */
static void Add(Layout l, const NearBlock *b, PetscReal scale, const PetscReal *const part[4], NearStore *s) {
  static const int place[4] = {0, 2, 3, 1}; /* xx, xy of the x row, yx, yy of the y row */
  const PetscInt rows = LayoutCount(l, b->row);
  NearRow r = NearBlockBegin(l, b);
  do
    for (PetscInt k = 0; k < r.count; k++) {
      const PetscInt from = (r.column + k - l->start[b->column]) * rows + r.row - l->start[b->row];
      const PetscReal alpha = NearBlockIsSelf(b) && !k ? 0.5 * scale : scale;
      for (int q = 0; q < 4; q++) {
        const size_t at = r.at + q / 2 * r.stride + 2 * k + q % 2;
        if (b->single)
          s->single[at] = (float)(s->single[at] + alpha * part[place[q]][from]);
        else
          s->value[at] += alpha * part[place[q]][from];
      }
    }
  while (NearBlockNext(l, b, &r));
}

PetscErrorCode NearBlockRefine(SinglePairs f, const NearBlock *b, const FinePair *pair, NearStore *s) {
  const Layout l = f->set->markers->layout;
  const int direction = pair->wall / 2, side = pair->wall % 2;
  const PetscInt n = LayoutCount(l, b->row) * LayoutCount(l, b->column);
  const FineKernel kernel = {pair->wall < 0 ? 3 : IMAGE_PARTS, pair->wall < 0 ? FreeKernel : WallKernel, f->set, NULL};
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(IMAGE_PARTS * n, &part));
  const PetscReal *p = part, *tt = p + IMAGE_TT * n, *nn = p + IMAGE_NN * n, *nt = p + IMAGE_NT * n,
                  *tn = p + IMAGE_TN * n;
  for (int fine = 1; fine >= 0; fine--) {
    const PetscReal sign = fine ? 1 : -1;
    PetscCall(FinePairParts(f->set, pair, (PetscBool)fine, &kernel, part));
    for (PetscInt k = IMAGE_NT * n; k < IMAGE_PARTS * n && pair->wall >= 0 && side; k++) part[k] *= -1;
    if (pair->wall < 0)
      Add(l, b, sign, (const PetscReal *[]){p, p + n, p + 2 * n, p + 2 * n}, s);
    else /* the wall's directions turned to x and y */
      Add(l, b, sign / f->set->nu,
          direction ? (const PetscReal *[]){tt, nn, tn, nt} : (const PetscReal *[]){nn, tt, nt, tn}, s);
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearBlockRefineAtWalls(SinglePairs f, const NearBlock *b, NearStore *s) {
  const CurveKind *kind = f->set->bodies->kind;
  PetscFunctionBeginUser;
  if (kind[b->row].type != CURVE_CLOSED || kind[b->column].type != CURVE_CLOSED) PetscFunctionReturn(PETSC_SUCCESS);
  for (int wall = 0; wall < 4; wall++) {
    FinePair pair = {.row = b->row, .column = b->column, .shift = {b->shift[0], b->shift[1]}};
    if (FinePairAtWall(f->set, f->bounds, wall, &pair)) PetscCall(NearBlockRefine(f, b, &pair, s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
