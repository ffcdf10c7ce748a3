#include "coupling/nearimage.h"
#include "base/lanes.h"

/* -S(R) + 2 b^2 D - 2 b SD with R from the source's mirror image, D_ij = s_j (delta_ij/R^2 - 2 R_i R_j/R^4), SD_ij =
   R_n D_ij + s_j (delta_jn R_i - delta_in R_j)/R^2, s = (1, -1). */
void NearImageBlake(const ImagePair *p, PetscReal image[IMAGE_PARTS]) {
  const PetscReal b = p->b, R[2] = {p->x, p->a + b}, r2 = R[0] * R[0] + R[1] * R[1];
  const PetscReal logarithm = -0.5 * PetscLogReal(r2);
  static const int place[2][2] = {{IMAGE_TT, IMAGE_TN}, {IMAGE_NT, IMAGE_NN}};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const PetscReal s = j ? -1 : 1, D = s * ((i == j) / r2 - 2 * R[i] * R[j] / (r2 * r2));
      const PetscReal SD = R[1] * D + s * (j * R[i] - i * R[j]) / r2;
      const PetscReal S = (i == j) * logarithm + R[i] * R[j] / r2;
      image[place[i][j]] = (-S + 2 * b * b * D - 2 * b * SD) / (4 * PETSC_PI);
    }
}

void NearImageTurn(int direction, int side, PetscReal alpha, const PetscReal part[IMAGE_PARTS], PetscReal C[4]) {
  const int place[IMAGE_PARTS] = {1 - direction, direction, direction ? 3 : 2, direction ? 2 : 3};
  for (int q = 0; q < IMAGE_PARTS; q++) C[place[q]] += (side && q >= IMAGE_NT ? -alpha : alpha) * part[q];
}

/* Sum of one part over two stencils against the half-space table; response comp r (0 t, 1 n) of i, source comp s of j.
 */
static PetscReal HalfSum(NearImage m, int direction, OffsetBlock b, const ImageEnd *e, PetscInt i, int r,
                         const ImageEnd *f, PetscInt j, int s, PetscReal x) {
  const int t = 1 - direction;
  const ImageRows row = {e->first[r], e->n[r], e->weight[r]}, source = {f->first[s], f->n[s], f->weight[s]};
  return ImageSum(m->table->value[b], m->markers->grid, t, x, &m->stencil[2 * i + (r ? direction : t)], &row,
                  &m->stencil[2 * j + (s ? direction : t)], &source);
}

/* The half-space lattice's mobility of a pair near the wall. */
static void Half(NearImage m, int direction, const ImagePair *p, PetscInt i, PetscInt j, const ImageEnd *e,
                 const ImageEnd *f, PetscReal C[IMAGE_PARTS]) {
  C[IMAGE_TT] = HalfSum(m, direction, OFFSET_UU, e, i, 0, f, j, 0, p->x);
  C[IMAGE_NN] = HalfSum(m, direction, OFFSET_VV, e, i, 1, f, j, 1, p->x);
  C[IMAGE_NT] = HalfSum(m, direction, OFFSET_VU, e, i, 1, f, j, 0, p->x);
  C[IMAGE_TN] = HalfSum(m, direction, OFFSET_VU, f, j, 1, e, i, 0, -p->x);
}

/* The free lattice's mobility seen from a wall, in cells and of viscosity 1. */
static void FreePart(NearImage m, int direction, int side, const PetscReal L[4], PetscReal free[IMAGE_PARTS]) {
  const int place[IMAGE_PARTS] = {1 - direction, direction, direction ? 3 : 2, direction ? 2 : 3};
  for (int q = 0; q < IMAGE_PARTS; q++) free[q] = (side && q >= IMAGE_NT ? -m->nu : m->nu) * L[place[q]];
  free[IMAGE_TT] += m->logarithm;
  free[IMAGE_NN] += m->logarithm;
}

/* One wall's part, added. Stencils that are scaled near the wall take s s' of the half-space's mobility S + Blake -
   C_free - C_image only: the rest comes on top. */
static void AddWall(NearImage m, int direction, int side, PetscInt i, PetscInt j, const PetscReal d[2],
                    const PetscReal L[4], PetscReal C[4]) {
  const ImageEnd *e = &m->end[direction][side][i], *f = &m->end[direction][side][j];
  const ImagePair p = {d[1 - direction] / m->markers->grid->h, e->y, f->y};
  const PetscBool near = NearImageIsNear(&p);
  PetscReal blake[IMAGE_PARTS] = {0}, part[IMAGE_PARTS], free[IMAGE_PARTS] = {0};
  if (near || e->scale < 1 || f->scale < 1) {
    FreePart(m, direction, side, L, free);
    NearImageBlake(&p, blake);
  }
  if (near) {
    Half(m, direction, &p, i, j, e, f, part);
    for (int q = 0; q < IMAGE_PARTS; q++) part[q] = blake[q] + free[q] - part[q];
  } else
    ImageFar(&p, &m->kernel, e->moment, f->moment, part);
  if (!near && (e->scale < 1 || f->scale < 1)) {
    const PetscReal scale[IMAGE_PARTS] = {1, e->scale * f->scale, e->scale, f->scale};
    for (int q = 0; q < IMAGE_PARTS; q++) part[q] += (1 - scale[q]) * (free[q] + blake[q] - part[q]);
  }
  NearImageTurn(direction, side, 1 / m->nu, part, C);
}

void NearImageAdd(NearImage m, const PetscBool without[2][2], PetscInt i, PetscInt j, const PetscReal d[2],
                  const PetscReal L[4], PetscReal C[4]) {
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2; side++)
      if (m->end[direction][side] && !(without && without[direction][side])) AddWall(m, direction, side, i, j, d, L, C);
}

void NearImageAddBlake(NearImage m, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal alpha, PetscReal C[4]) {
  const PetscReal h = m->markers->grid->h;
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2; side++) {
      const PetscReal *y = m->y[direction][side];
      PetscReal blake[IMAGE_PARTS];
      if (!y) continue;
      NearImageBlake(&(ImagePair){d[1 - direction] / h, y[i], y[j]}, blake);
      blake[IMAGE_TT] += m->logarithm;
      blake[IMAGE_NN] += m->logarithm;
      NearImageTurn(direction, side, alpha / m->nu, blake, C);
    }
}

PetscReal NearImageGap(Grid g, int direction, int side, const NearBounds *a, const NearBounds *b) {
  if (side) return 2 * g->hi[direction] - a->high[direction] - b->high[direction];
  return a->low[direction] + b->low[direction] - 2 * g->lo[direction];
}

PetscBool NearImageIsFar(NearImage m, const PetscReal X[2], const NearBounds *box, PetscBool far[2][2]) {
  const Grid g = m->markers->grid;
  const NearBounds at = {{X[0], X[1]}, {X[0], X[1]}};
  PetscBool all = PETSC_TRUE;
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2; side++) {
      const PetscReal off = PetscMin(NearImageGap(g, dir, side, &at, &at), NearImageGap(g, dir, side, box, box));
      const PetscBool near = off < 2 * FOLD_SCALED * g->h || NearImageGap(g, dir, side, &at, box) < IMAGE_OFF * g->h
                                 ? PETSC_TRUE
                                 : PETSC_FALSE;
      if (g->wall[dir] && near) all = PETSC_FALSE;
      if (far) far[dir][side] = g->wall[dir] && near ? PETSC_FALSE : PETSC_TRUE;
    }
  return all;
}

/* One wall's part, added; d along the wall. */
static void AddFarWall(NearImage m, int direction, int side, PetscInt i, PetscInt j, PetscInt n, PetscBool back,
                       const PetscReal d[], PetscReal *const C[4]) {
  const PetscReal cell = 1 / m->markers->grid->h, over = 1 / m->nu, *y = m->y[direction][side];
  const PetscReal alpha[2] = {over, side ? -over : over};
  const int place[IMAGE_PARTS] = {1 - direction, direction, direction ? 3 : 2, direction ? 2 : 3};
  const Lanes own = y[i] + (Lanes){0};
  for (PetscInt k = 0; k < n; k += LANES) {
    const Lanes x = cell * LanesAt(d + k), other = LanesAt(y + j + k);
    Lanes part[IMAGE_PARTS];
    ImageFarFour(&m->kernel, x, back ? other : own, back ? own : other, part);
    for (int q = 0; q < IMAGE_PARTS; q++)
      LanesPut(LanesAt(C[place[q]] + k) + alpha[q >= IMAGE_NT] * part[q], C[place[q]] + k);
  }
}

void NearImageAddFar(NearImage m, const PetscBool walls[2][2], const PetscBool far[2][2], PetscInt i, PetscInt j,
                     PetscInt n, PetscBool back, const PetscReal x[], const PetscReal y[], PetscReal *const C[4]) {
  for (int wall = 0; wall < 4; wall++)
    if (walls[wall / 2][wall % 2] && far[wall / 2][wall % 2])
      AddFarWall(m, wall / 2, wall % 2, i, j, n, back, wall / 2 ? x : y, C);
}

void NearImageFar(const void *image, PetscInt n, const PetscReal X[], const PetscReal Y[2], PetscReal V[]) {
  const struct _p_NearImage *m = image;
  const Grid g = m->markers->grid;
  (void)PetscArrayzero(V, 4 * n);
  for (int wall = 0; wall < 4; wall++) {
    const int direction = wall / 2, side = wall % 2, t = 1 - direction;
    const int place[IMAGE_PARTS] = {t * 3, direction * 3, direction ? 2 : 1, direction ? 1 : 2}; /* response, source */
    if (!g->wall[direction]) continue;
    for (PetscInt k = 0; k < n; k += LANES) {
      const Lanes b = NearImageOff(g, direction, side, Y) + (Lanes){0};
      Lanes x, a, part[IMAGE_PARTS];
      for (int q = 0; q < LANES; q++) {
        const PetscReal *at = X + 2 * PetscMin(k + q, n - 1);
        x[q] = (at[t] - Y[t]) / g->h;
        a[q] = NearImageOff(g, direction, side, at);
      }
      ImageFarFour(&m->kernel, x, a, b, part);
      for (int q = 0; q < IMAGE_PARTS; q++)
        for (PetscInt l = 0; l < LANES && k + l < n; l++)
          V[place[q] * n + k + l] += (side && q >= IMAGE_NT ? -1 : 1) / m->nu * part[q][l];
    }
  }
}

/* SUM w [c|c| - sgn(c)/4] - y^2 + 1/4 over the tangential stencil's rows at c from the wall, before it is folded. */
static PetscReal OddMoment(PetscReal y, PetscInt first, PetscInt n, const PetscReal w[]) {
  PetscReal sum = 0.25 - y * y;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal c = first + k + 0.5;
    sum += w[k] * (c > 0 ? c * c - 0.25 : 0.25 - c * c);
  }
  return sum;
}

/* Where a marker, y cells away, sees a wall; without weights where it is far. */
static void MakeEnd(Markers m, PetscReal y, PetscReal across, ImageEnd *end) {
  if (y >= IMAGE_CELLS) {
    end->y = y;
    end->scale = m->scaled ? WallScale(m->kernel, y) : 1;
    end->moment = across;
    end->n[0] = end->n[1] = 0;
    return;
  }
  ImageEnd e = {.y = y, .scale = m->scaled ? WallScale(m->kernel, y) : 1, .moment = across};
  for (int comp = 0; comp < 2; comp++) { /* entries as in the grid: t at j + 1/2, n at j + 1, row j + 1 of the table */
    e.n[comp] = (comp ? m->kernel->along : m->kernel->across)(y - (comp ? 1 : 0.5), &e.first[comp], e.weight[comp]);
    if (!comp && e.first[0] < 0) e.moment = OddMoment(y, e.first[0], e.n[0], e.weight[0]);
    FoldLow(comp ? FOLD_EVEN : FOLD_ODD, &e.first[comp], &e.n[comp], e.weight[comp]);
    if (comp) e.first[1]++;
  }
  for (PetscInt k = 0; k < e.n[1]; k++) e.weight[1][k] *= e.scale;
  *end = e;
}

PetscErrorCode NearImagePlace(NearImage m, const PaddedStencil stencil[]) {
  const Grid g = m->markers->grid;
  const PetscInt M = m->markers->layout->M;
  PetscFunctionBeginUser;
  if (!m->table) PetscFunctionReturn(PETSC_SUCCESS);
  m->stencil = stencil;
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2 && g->wall[direction]; side++)
      for (PetscInt k = 0; k < M; k++) {
        const PetscReal y = NearImageOff(g, direction, side, m->markers->X + 2 * k);
        m->y[direction][side][k] = y;
        MakeEnd(m->markers, y, m->kernel.moment[1].second, &m->end[direction][side][k]);
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearImageCreate(Markers markers, PetscReal nu, PetscReal unit, const ImageTable *table, NearImage *out) {
  const PetscInt M = markers->layout->M;
  NearImage m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->markers = markers;
  m->nu = nu;
  m->logarithm = NearLogarithm(markers, unit);
  m->table = table;
  ImageKernelMake(markers->kernel, &m->kernel);
  if (!markers->grid->wall[0] && !markers->grid->wall[1]) PetscFunctionReturn(PETSC_SUCCESS);
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2 && markers->grid->wall[direction]; side++)
      PetscCall(PetscCalloc2(M, &m->end[direction][side], M + LANES, &m->y[direction][side]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearImageDestroy(NearImage *image) {
  NearImage m = *image;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  for (int direction = 0; direction < 2; direction++)
    for (int side = 0; side < 2; side++) PetscCall(PetscFree2(m->end[direction][side], m->y[direction][side]));
  PetscCall(PetscFree(*image));
  PetscFunctionReturn(PETSC_SUCCESS);
}
