#include "layers/nearimage.h"
#include "base/lanes.h"

/* -S(R) + 2 b^2 D - 2 b SD with R from the source's mirror image, D_ij = s_j (delta_ij/R^2 - 2 R_i R_j/R^4), SD_ij =
   R_n D_ij + s_j (delta_jn R_i - delta_in R_j)/R^2, s = (1, -1). */
void NearImageBlake(Lanes x, Lanes a, Lanes b, Lanes image[IMAGE_PARTS]) {
  static const int place[2][2] = {{IMAGE_TT, IMAGE_TN}, {IMAGE_NT, IMAGE_NN}};
  const Lanes R[2] = {x, a + b}, r2 = R[0] * R[0] + R[1] * R[1], logarithm = -0.5 * LanesLog(r2);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const PetscReal s = j ? -1 : 1;
      const Lanes D = s * ((i == j) / r2 - 2 * R[i] * R[j] / (r2 * r2));
      const Lanes SD = R[1] * D + s * (j * R[i] - i * R[j]) / r2;
      const Lanes S = (i == j) * logarithm + R[i] * R[j] / r2;
      image[place[i][j]] = (-S + 2 * b * b * D - 2 * b * SD) / (4 * PETSC_PI);
    }
}

/* NearImageBlake of one pair. */
static void Blake(const ImagePair *p, PetscReal image[IMAGE_PARTS]) {
  Lanes four[IMAGE_PARTS];
  NearImageBlake(p->x + (Lanes){0}, p->a + (Lanes){0}, p->b + (Lanes){0}, four);
  for (int q = 0; q < IMAGE_PARTS; q++) image[q] = four[q][0];
}

/* What a marker has of a wall: tangential or normal (r = 1) component. */
static ImageRows NearImageRowsOf(NearImage m, int wall, PetscInt i, int r) {
  const ImageEnd *e = &m->end[wall / 2][wall % 2][i];
  return (ImageRows){e->first[r], e->n[r], e->weight[r], &m->stencil[2 * i + (r ? wall / 2 : 1 - wall / 2)]};
}

/* The half-space lattice's mobility of markers i and j near a wall, x cells apart along it. */
static void NearImageHalf(NearImage m, int wall, PetscInt i, PetscInt j, PetscReal x, PetscReal part[IMAGE_PARTS]) {
  const ImageRows a[2] = {NearImageRowsOf(m, wall, i, 0), NearImageRowsOf(m, wall, i, 1)};
  const ImageRows b[2] = {NearImageRowsOf(m, wall, j, 0), NearImageRowsOf(m, wall, j, 1)};
  const Grid g = m->markers->grid;
  const int t = 1 - wall / 2;
  part[IMAGE_TT] = ImageSum(m->table->value[OFFSET_UU], g, t, x, &a[0], &b[0]);
  part[IMAGE_NN] = ImageSum(m->table->value[OFFSET_VV], g, t, x, &a[1], &b[1]);
  part[IMAGE_NT] = ImageSum(m->table->value[OFFSET_VU], g, t, x, &a[1], &b[0]);
  part[IMAGE_TN] = ImageSum(m->table->value[OFFSET_VU], g, t, -x, &b[1], &a[0]);
}

/* One wall's part, added. Stencils that are scaled near the wall take s s' of the half-space's mobility S + Blake -
   C_free - C_image only: the rest comes on top. */
static void NearImageAddWall(NearImage m, int wall, PetscInt i, PetscInt j, const PetscReal d[2], const PetscReal L[4],
                             PetscReal C[4]) {
  const int direction = wall / 2, side = wall % 2;
  const ImageEnd *e = &m->end[direction][side][i], *f = &m->end[direction][side][j];
  const ImagePair p = {d[1 - direction] / m->markers->grid->h, e->y, f->y};
  const PetscBool near = NearImageIsNear(&p), scaled = e->scale < 1 || f->scale < 1 ? PETSC_TRUE : PETSC_FALSE;
  PetscReal blake[IMAGE_PARTS] = {0}, part[IMAGE_PARTS], free[IMAGE_PARTS] = {0};
  if (near || scaled) { /* free: the lattice's mobility without walls, seen from the wall, in cells, of viscosity 1 */
    for (int q = 0; q < IMAGE_PARTS; q++)
      free[q] = (side && force_places.odd[q] ? -m->nu : m->nu) * L[force_places.place[direction][q]];
    free[IMAGE_TT] += m->logarithm;
    free[IMAGE_NN] += m->logarithm;
    Blake(&p, blake);
  }
  if (near) {
    NearImageHalf(m, wall, i, j, p.x, part);
    for (int q = 0; q < IMAGE_PARTS; q++) part[q] = blake[q] + free[q] - part[q];
  } else
    ImageFar(&p, &m->kernel, e->moment, f->moment, part);
  if (!near && scaled) {
    const PetscReal scale[IMAGE_PARTS] = {1, e->scale * f->scale, e->scale, f->scale};
    for (int q = 0; q < IMAGE_PARTS; q++) part[q] += (1 - scale[q]) * (free[q] + blake[q] - part[q]);
  }
  ImageTurn(&force_places, wall, 1 / m->nu, part, C);
}

void NearImageAdd(NearImage m, const PetscBool without[2][2], PetscInt i, PetscInt j, const PetscReal d[2],
                  const PetscReal L[4], PetscReal C[4]) {
  for (int wall = 0; wall < 4; wall++)
    if (m->end[wall / 2][wall % 2] && !(without && without[wall / 2][wall % 2]))
      NearImageAddWall(m, wall, i, j, d, L, C);
}

void NearImageAddBlake(NearImage m, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal alpha, PetscReal C[4]) {
  const PetscReal h = m->markers->grid->h;
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal *y = m->y[wall / 2][wall % 2];
    PetscReal blake[IMAGE_PARTS];
    if (!y) continue;
    Blake(&(ImagePair){d[1 - wall / 2] / h, y[i], y[j]}, blake);
    blake[IMAGE_TT] += m->logarithm;
    blake[IMAGE_NN] += m->logarithm;
    ImageTurn(&force_places, wall, alpha / m->nu, blake, C);
  }
}

NearBounds NearBoundsOf(PetscInt n, const PetscReal X[]) {
  NearBounds b = {{PETSC_MAX_REAL, PETSC_MAX_REAL}, {PETSC_MIN_REAL, PETSC_MIN_REAL}};
  for (PetscInt k = 0; k < 2 * n; k++) {
    b.low[k % 2] = PetscMin(b.low[k % 2], X[k]);
    b.high[k % 2] = PetscMax(b.high[k % 2], X[k]);
  }
  return b;
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

void NearImageAddFar(NearImage m, const PetscBool walls[2][2], const NearImageRow *r) {
  const PetscReal cell = 1 / m->markers->grid->h, over = 1 / m->nu;
  for (int wall = 0; wall < 4; wall++) {
    const int direction = wall / 2;
    const PetscReal *y = m->y[direction][wall % 2], alpha[2] = {over, wall % 2 ? -over : over};
    if (!walls[direction][wall % 2]) continue;
    const Lanes own = y[r->i] + (Lanes){0};
    for (PetscInt k = 0; k < r->n; k += LANES) {
      const Lanes x = cell * LanesAt(r->d[1 - direction] + k), other = LanesAt(y + r->j + k);
      Lanes part[IMAGE_PARTS];
      ImageFarFour(&m->kernel, x, r->back ? other : own, r->back ? own : other, part);
      for (int q = 0; q < IMAGE_PARTS; q++) {
        PetscReal *C = r->C[force_places.place[direction][q]] + k;
        LanesPut(LanesAt(C) + alpha[force_places.odd[q]] * part[q], C);
      }
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
static void NearImageEnd(Markers m, PetscReal y, PetscReal across, ImageEnd *end) {
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
        NearImageEnd(m->markers, y, m->kernel.moment[1].second, &m->end[direction][side][k]);
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearImageCreate(const LayerSetting *set, const ImageTable *table, NearImage *out) {
  const Grid g = set->markers->grid;
  const PetscInt M = set->markers->layout->M;
  NearImage m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->markers = set->markers;
  m->nu = set->nu;
  m->logarithm = PetscLogReal(g->h / set->unit) / (4 * PETSC_PI);
  m->table = table;
  ImageKernelMake(set->markers->kernel, &m->kernel);
  for (int wall = 0; wall < 4; wall++)
    if (g->wall[wall / 2])
      PetscCall(PetscCalloc2(M, &m->end[wall / 2][wall % 2], M + LANES, &m->y[wall / 2][wall % 2]));
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
