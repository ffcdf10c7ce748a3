#include "space/nearlayer.h"
#include "numerics/blas.h"

#define WIDTH 0.8  /* delta_0 over the spacing */
#define REACH 3.0  /* of a short part, over its width */
#define NODES 3000 /* of the tables of the short part, over its reach */
#define CELL 1.2   /* how much nearer than their cells two points can be, over the spacing of the cells */

PetscReal NearReach(PetscReal spacing) {
  return REACH * WIDTH * spacing;
}

PetscErrorCode NearTablesCreate(NearTables *t) {
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(NODES + 1, &t->isotropic, NODES + 1, &t->along));
  for (PetscInt k = 0; k <= NODES; k++) {
    const PetscReal r = REACH * (PetscReal)k / NODES, g = 2 / PetscSqrtReal(PETSC_PI) * r * PetscExpReal(-r * r);
    t->isotropic[k] = erfc(r) - g;
    t->along[k] = erfc(r) + g;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearTablesDestroy(NearTables *t) {
  PetscFunctionBeginUser;
  for (int level = 0; level < NEAR_LEVELS; level++)
    if (t->grid[level].n) PetscCall(SphereGridDestroy(&t->grid[level]));
  PetscCall(PetscFree2(t->isotropic, t->along));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every how many longitudes a latitude of level k has a point, so that points crowd at no pole: the largest power of 2
   up to 1/sin(theta), 2^k at most. A row of the next level has twice as many at most. */
static PetscInt NearStride(PetscInt k, PetscReal theta) {
  PetscInt stride = 1;
  while (k-- > 0 && 2 * stride * PetscSinReal(theta) <= 1) stride *= 2;
  return stride;
}

/* Of points whose numbers are set. */
static PetscErrorCode NearPatchCreate(Sphere s, PetscInt k, const SphereGrid *grid, const PetscReal c[], NearPatch *p) {
  PetscReal *phi;
  PetscFunctionBeginUser;
  PetscCall(
      PetscMalloc5(s->count * p->n, &p->Y, 3 * p->n, &p->X, p->n, &p->weight, p->n, &p->distance, p->n, &p->theta));
  PetscCall(PetscMalloc1(p->n, &phi));
  for (PetscInt i = 0; i < p->n; i++) {
    p->theta[i] = grid->theta[p->point[i]];
    phi[i] = grid->phi[p->point[i]];
    p->weight[i] = (PetscReal)NearStride(k, p->theta[i]) * grid->weight[p->point[i]];
  }
  PetscCall(HarmonicsAt(s->p, p->n, p->theta, phi, 1, p->Y));
  PetscCall(DenseProduct(PETSC_FALSE, p->n, 3, s->count, p->Y, c, p->X));
  PetscCall(PetscFree(phi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NearPatchDestroy(NearPatch *p) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->point));
  PetscCall(PetscFree5(p->Y, p->X, p->weight, p->distance, p->theta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All points of the grid of degree p. */
static PetscErrorCode NearPatchWhole(Sphere s, const PetscReal c[], NearPatch *p) {
  PetscFunctionBeginUser;
  p->n = s->shape.grid.n;
  PetscCall(PetscMalloc1(p->n, &p->point));
  for (PetscInt i = 0; i < p->n; i++) p->point[i] = i;
  PetscCall(NearPatchCreate(s, 0, &s->shape.grid, c, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The points of level k in the cells of those points of the level before that are nearer to the other surface than
   `within`. */
static PetscErrorCode NearPatchRefine(Sphere s, const NearPatch *coarse, PetscReal within, PetscInt k,
                                      const SphereGrid *grid, const PetscReal c[], NearPatch *p) {
  const PetscInt around = 2 * grid->q + 2;
  PetscFunctionBeginUser;
  p->n = 0;
  PetscCall(PetscMalloc1(8 * coarse->n, &p->point));
  for (PetscInt i = 0; i < coarse->n; i++) {
    const PetscInt latitude = coarse->point[i] / (around / 2), longitude = coarse->point[i] % (around / 2);
    if (coarse->distance[i] > within) continue;
    const PetscInt cell = 2 * NearStride(k - 1, coarse->theta[i]);
    for (PetscInt row = 2 * latitude; row < 2 * latitude + 2; row++)
      for (PetscInt m = 0; m < cell; m += NearStride(k, grid->theta[row * around]))
        p->point[p->n++] = row * around + 2 * longitude + m;
  }
  PetscCall(NearPatchCreate(s, k, grid, c, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r2[n] = squares of the distances of the points of a patch to x. */
static void NearDistances(const NearPatch *p, const PetscReal x[3], PetscReal r2[]) {
  for (PetscInt j = 0; j < p->n; j++)
    r2[j] = PetscSqr(p->X[j] - x[0]) + PetscSqr(p->X[p->n + j] - x[1]) + PetscSqr(p->X[2 * p->n + j] - x[2]);
}

/* Distances of the points to the other patch, the least one, and room for an entry of each pair within reach. */
static PetscErrorCode NearLevelMeasure(NearLevel *l, PetscReal reach, PetscReal *least) {
  const NearPatch *a = &l->patch[0], *b = &l->patch[1];
  PetscInt pairs = 0;
  PetscReal *r2;
  PetscFunctionBeginUser;
  l->reach = reach;
  PetscCall(PetscMalloc1(b->n, &r2));
  for (PetscInt j = 0; j < b->n; j++) b->distance[j] = PETSC_MAX_REAL;
  *least = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < a->n; i++) {
    PetscReal nearest = PETSC_MAX_REAL;
    NearDistances(b, (PetscReal[]){a->X[i], a->X[a->n + i], a->X[2 * a->n + i]}, r2);
    for (PetscInt j = 0; j < b->n; j++) {
      nearest = PetscMin(nearest, r2[j]);
      b->distance[j] = PetscMin(b->distance[j], r2[j]);
      pairs += r2[j] < reach * reach;
    }
    a->distance[i] = PetscSqrtReal(nearest);
    *least = PetscMin(*least, a->distance[i]);
  }
  for (PetscInt j = 0; j < b->n; j++) b->distance[j] = PetscSqrtReal(b->distance[j]);
  PetscCall(PetscFree(r2));
  PetscCall(PetscMalloc1(pairs, &l->entry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a I + b d d += scale L(width) at the distance r. */
static void NearAddShort(const NearTables *t, PetscReal scale, PetscReal width, PetscReal r, NearEntry *e) {
  const PetscReal at = r / (width * REACH) * NODES;
  if (at >= NODES) return;
  const PetscInt k = (PetscInt)at;
  const PetscReal part = at - (PetscReal)k, over = scale / (8 * PETSC_PI * r);
  e->a += over * (t->isotropic[k] + part * (t->isotropic[k + 1] - t->isotropic[k]));
  e->b += over / (r * r) * (t->along[k] + part * (t->along[k + 1] - t->along[k]));
}

/* The entries: scale L(width) - L(less), where `less` is not 0. */
static PetscErrorCode NearLevelFill(NearLevel *l, const NearTables *t, PetscReal scale, PetscReal width,
                                    PetscReal less) {
  const NearPatch *a = &l->patch[0], *b = &l->patch[1];
  const PetscReal reach = REACH * width;
  PetscReal *r2;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n, &r2));
  for (PetscInt i = 0; i < a->n; i++) {
    if (a->distance[i] >= reach) continue;
    NearDistances(b, (PetscReal[]){a->X[i], a->X[a->n + i], a->X[2 * a->n + i]}, r2);
    for (PetscInt j = 0; j < b->n; j++) {
      if (r2[j] >= reach * reach) continue;
      NearEntry *e = &l->entry[l->entries++];
      *e = (NearEntry){.i = i, .j = j};
      NearAddShort(t, scale, width, PetscSqrtReal(r2[j]), e);
      if (less > 0) NearAddShort(t, -scale, less, PetscSqrtReal(r2[j]), e);
    }
  }
  PetscCall(PetscFree(r2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearPairCreate(Sphere sphere, NearTables *t, PetscReal spacing, const PetscReal c1[],
                              const PetscReal c2[], NearPair *out) {
  const PetscReal *c[2] = {c1, c2};
  PetscReal width = WIDTH * spacing, least = 0;
  NearPair pair;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&pair));
  *out = pair;
  pair->sphere = sphere;
  pair->levels = 1;
  for (int side = 0; side < 2; side++) PetscCall(NearPatchWhole(sphere, c[side], &pair->level[0].patch[side]));
  PetscCall(NearLevelMeasure(&pair->level[0], REACH * width, &least));
  PetscCall(NearLevelFill(&pair->level[0], t, -1, width, 0));
  PetscBool last = (PetscBool)(least > REACH * width);
  for (PetscInt k = 1; !last; k++, spacing /= 2, width /= 2) {
    const NearLevel *before = &pair->level[k - 1];
    NearLevel *l = &pair->level[k];
    if (!t->grid[k].n) PetscCall(SphereGridCreate(((sphere->p + 1) << k) - 1, GRID_WHOLE, &t->grid[k]));
    for (int side = 0; side < 2; side++)
      PetscCall(NearPatchRefine(sphere, &before->patch[side], REACH * width + CELL * spacing, k, &t->grid[k], c[side],
                                &l->patch[side]));
    pair->levels = k + 1;
    PetscCall(NearLevelMeasure(l, REACH * width, &least));
    last = (PetscBool)(k == NEAR_LEVELS - 1 || least > REACH * width / 2);
    PetscCall(NearLevelFill(l, t, 1, width, last ? 0 : width / 2));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearPairDestroy(NearPair *pair) {
  NearPair p = *pair;
  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < p->levels; k++) {
    for (int side = 0; side < 2; side++) PetscCall(NearPatchDestroy(&p->level[k].patch[side]));
    PetscCall(PetscFree(p->level[k].entry));
  }
  PetscCall(PetscFree(*pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The forces of both patches, by their weights; F, f[side]. */
static PetscErrorCode NearForces(const NearPatch *p, PetscInt count, const PetscReal F[], PetscReal f[]) {
  PetscFunctionBeginUser;
  PetscCall(DenseProduct(PETSC_FALSE, p->n, 3, count, p->Y, F, f));
  for (PetscInt i = 0; i < 3 * p->n; i++) f[i] *= p->weight[i % p->n];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearPairAdd(NearPair pair, const PetscReal *const F[2], PetscReal *const U[2]) {
  const PetscInt count = pair->sphere->count;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < pair->levels; k++) {
    const NearLevel *l = &pair->level[k];
    const NearPatch *a = &l->patch[0], *b = &l->patch[1];
    PetscReal *f[2], *u[2];
    PetscCall(PetscMalloc2(3 * a->n, &f[0], 3 * b->n, &f[1]));
    PetscCall(PetscCalloc2(3 * a->n, &u[0], 3 * b->n, &u[1]));
    for (int side = 0; side < 2; side++) PetscCall(NearForces(&l->patch[side], count, F[side], f[side]));
    for (const NearEntry *e = l->entry; e < l->entry + l->entries; e++) {
      PetscReal d[3], along[2] = {0, 0};
      for (int q = 0; q < 3; q++) {
        d[q] = a->X[q * a->n + e->i] - b->X[q * b->n + e->j];
        along[0] += e->b * d[q] * f[1][q * b->n + e->j];
        along[1] += e->b * d[q] * f[0][q * a->n + e->i];
      }
      for (int q = 0; q < 3; q++) {
        u[0][q * a->n + e->i] += e->a * f[1][q * b->n + e->j] + along[0] * d[q];
        u[1][q * b->n + e->j] += e->a * f[0][q * a->n + e->i] + along[1] * d[q];
      }
    }
    for (int side = 0; side < 2; side++) {
      const NearPatch *p = &l->patch[side];
      for (PetscInt i = 0; i < 3 * p->n; i++) u[side][i] *= p->weight[i % p->n];
      if (U[side])
        PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){p->Y, p->n, count, p->n},
                                     (DenseView){u[side], p->n, 3, p->n}, 1, U[side], count));
    }
    PetscCall(PetscFree2(f[0], f[1]));
    PetscCall(PetscFree2(u[0], u[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
