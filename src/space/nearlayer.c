#include "space/nearlayer.h"
#include "sphere/spherelayer.h"

#define WIDTH 0.8  /* delta_0 over the spacing */
#define REACH 3.0  /* of a short part, over its width */
#define NODES 3000 /* of the tables of the short part, over its reach */
#define CELL 1.2   /* how much nearer than their cells two points can be, over the spacing of the cells */

PetscReal NearReach(PetscReal spacing) {
  return REACH * WIDTH * spacing;
}

PetscErrorCode NearTablesCreate(PetscInt kernels, NearTables *t) {
  PetscFunctionBeginUser;
  t->kernels = kernels;
  for (int q = 0; q < NEAR_KERNELS; q++) PetscCall(PetscMalloc2(NODES + 1, &t->isotropic[q], NODES + 1, &t->along[q]));
  for (PetscInt k = 0; k <= NODES; k++) {
    const PetscReal r = REACH * (PetscReal)k / NODES, g = 2 / PetscSqrtReal(PETSC_PI) * r * PetscExpReal(-r * r);
    t->isotropic[STOKESLET][k] = erfc(r) - g;
    t->along[STOKESLET][k] = erfc(r) + g;
    t->isotropic[STRESSLET][k] = r * r * (t->along[STOKESLET][k] - t->isotropic[STOKESLET][k]);
    t->along[STRESSLET][k] = -6 * t->along[STOKESLET][k] - 2 * t->isotropic[STRESSLET][k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearTablesDestroy(NearTables *t) {
  PetscFunctionBeginUser;
  for (int level = 0; level < NEAR_LEVELS; level++)
    if (t->grid[level].n) PetscCall(SphereGridDestroy(&t->grid[level]));
  for (int q = 0; q < NEAR_KERNELS; q++) PetscCall(PetscFree2(t->isotropic[q], t->along[q]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every how many longitudes a latitude of level k has a point, so that points crowd at no pole: the largest power of 2
   up to 1/sin(theta), 2^k at most. A row of the next level has twice as many at most. */
static PetscInt NearStride(PetscInt k, PetscReal theta) {
  PetscInt stride = 1;
  while (k-- > 0 && 2 * stride * PetscSinReal(theta) <= 1) stride *= 2;
  return stride;
}

/* Of points of level k whose numbers are set. */
static PetscErrorCode NearPatchCreate(Sphere s, const NearTables *t, PetscInt k, const PetscReal c[], NearPatch *p) {
  const SphereGrid *grid = k ? &t->grid[k] : &s->shape.grid;
  const PetscInt parts = t->kernels > STRESSLET ? HARMONIC_P + 1 : 1;
  PetscReal *theta, *phi, *weight;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(p->n, &theta, p->n, &phi, p->n, &weight));
  for (PetscInt i = 0; i < p->n; i++) {
    theta[i] = grid->theta[p->point[i]];
    phi[i] = grid->phi[p->point[i]];
    weight[i] = (PetscReal)NearStride(k, theta[i]) * grid->weight[p->point[i]];
  }
  PetscCall(SphereTableAt(s->p, p->n, theta, phi, weight, parts, &p->table));
  PetscCall(PetscFree3(theta, phi, weight));
  PetscCall(PetscMalloc3(3 * p->n, &p->X, 3 * p->n, &p->normal, p->n, &p->distance));
  PetscCall(SphereFieldValues(&p->table, HARMONIC, c, p->X));
  if (parts > 1) PetscCall(LayerNormals(&p->table, c, p->normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NearPatchDestroy(NearPatch *p) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->point));
  PetscCall(PetscFree3(p->X, p->normal, p->distance));
  PetscCall(SphereTableDestroy(&p->table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All points of the grid of degree p. */
static PetscErrorCode NearPatchWhole(Sphere s, const NearTables *t, const PetscReal c[], NearPatch *p) {
  PetscFunctionBeginUser;
  p->n = s->shape.grid.n;
  PetscCall(PetscMalloc1(p->n, &p->point));
  for (PetscInt i = 0; i < p->n; i++) p->point[i] = i;
  PetscCall(NearPatchCreate(s, t, 0, c, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The points of level k in the cells of those points of the level before that are nearer to the other surface than
   `within`. */
static PetscErrorCode NearPatchRefine(Sphere s, const NearTables *t, const NearPatch *coarse, PetscReal within,
                                      PetscInt k, const PetscReal c[], NearPatch *p) {
  const SphereGrid *grid = &t->grid[k];
  const PetscInt around = 2 * grid->q + 2;
  PetscFunctionBeginUser;
  p->n = 0;
  PetscCall(PetscMalloc1(8 * coarse->n, &p->point));
  for (PetscInt i = 0; i < coarse->n; i++) {
    const PetscInt latitude = coarse->point[i] / (around / 2), longitude = coarse->point[i] % (around / 2);
    if (coarse->distance[i] > within) continue;
    const PetscInt cell = 2 * NearStride(k - 1, coarse->table.grid.theta[i]);
    for (PetscInt row = 2 * latitude; row < 2 * latitude + 2; row++)
      for (PetscInt m = 0; m < cell; m += NearStride(k, grid->theta[row * around]))
        p->point[p->n++] = row * around + 2 * longitude + m;
  }
  PetscCall(NearPatchCreate(s, t, k, c, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r2[n] = squares of the distances of the points of a patch to x. */
static void NearDistances(const NearPatch *p, const PetscReal x[3], PetscReal r2[]) {
  for (PetscInt j = 0; j < p->n; j++)
    r2[j] = PetscSqr(p->X[j] - x[0]) + PetscSqr(p->X[p->n + j] - x[1]) + PetscSqr(p->X[2 * p->n + j] - x[2]);
}

/* Distances of the points to the other patch, the least one, and entries of each pair within reach. */
static PetscErrorCode NearLevelMeasure(NearLevel *l, PetscReal reach, PetscReal *least) {
  const NearPatch *a = &l->patch[0], *b = &l->patch[1];
  PetscInt room = 0;
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
    }
    a->distance[i] = PetscSqrtReal(nearest);
    *least = PetscMin(*least, a->distance[i]);
    if (room < l->entries + b->n) {
      room = 2 * (l->entries + b->n);
      PetscCall(PetscRealloc(room * sizeof(NearEntry), &l->entry[STOKESLET]));
    }
    for (PetscInt j = 0; j < b->n && nearest < reach * reach; j++)
      if (r2[j] < reach * reach) l->entry[STOKESLET][l->entries++] = (NearEntry){.i = i, .j = j};
  }
  for (PetscInt j = 0; j < b->n; j++) b->distance[j] = PetscSqrtReal(b->distance[j]);
  PetscCall(PetscFree(r2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal NearEntryDistance(const NearLevel *l, const NearEntry *e) {
  const NearPatch *a = &l->patch[0], *b = &l->patch[1];
  PetscReal r2 = 0;
  for (int q = 0; q < 3; q++) r2 += PetscSqr(a->X[q * a->n + e->i] - b->X[q * b->n + e->j]);
  return PetscSqrtReal(r2);
}

/* The factors += scale times those of L(width), or its stresslet, at the distance r. */
static void NearAddShort(const NearTables *t, PetscInt kernel, PetscReal scale, PetscReal width, PetscReal r,
                         NearEntry *e) {
  const PetscReal at = r / (width * REACH) * NODES;
  if (at >= NODES) return;
  const PetscInt k = (PetscInt)at;
  const PetscReal part = at - (PetscReal)k, over = scale / (8 * PETSC_PI * r) / (kernel == STRESSLET ? r * r : 1),
                  *isotropic = t->isotropic[kernel] + k, *along = t->along[kernel] + k;
  e->a += over * (isotropic[0] + part * (isotropic[1] - isotropic[0]));
  e->b += over / (r * r) * (along[0] + part * (along[1] - along[0]));
}

/* The factors of each kernel: scale L(width) - L(less), where `less` is not 0. */
static PetscErrorCode NearLevelFill(NearLevel *l, const NearTables *t, PetscReal scale, PetscReal width,
                                    PetscReal less) {
  PetscFunctionBeginUser;
  if (t->kernels > STRESSLET) {
    PetscCall(PetscMalloc1(l->entries, &l->entry[STRESSLET]));
    PetscCall(PetscArraycpy(l->entry[STRESSLET], l->entry[STOKESLET], l->entries));
  }
  for (PetscInt q = 0; q < t->kernels; q++)
    for (NearEntry *e = l->entry[q]; e < l->entry[q] + l->entries; e++) {
      const PetscReal r = NearEntryDistance(l, e);
      NearAddShort(t, q, scale, width, r, e);
      if (less > 0) NearAddShort(t, q, -scale, less, r, e);
    }
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
  for (int side = 0; side < 2; side++) PetscCall(NearPatchWhole(sphere, t, c[side], &pair->level[0].patch[side]));
  PetscCall(NearLevelMeasure(&pair->level[0], REACH * width, &least));
  PetscCall(NearLevelFill(&pair->level[0], t, -1, width, 0));
  PetscBool last = (PetscBool)(least > REACH * width);
  for (PetscInt k = 1; !last; k++, spacing /= 2, width /= 2) {
    const NearLevel *before = &pair->level[k - 1];
    NearLevel *l = &pair->level[k];
    if (!t->grid[k].n) PetscCall(SphereGridCreate(((sphere->p + 1) << k) - 1, GRID_WHOLE, &t->grid[k]));
    for (int side = 0; side < 2; side++)
      PetscCall(NearPatchRefine(sphere, t, &before->patch[side], REACH * width + CELL * spacing, k, c[side],
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
    for (int q = 0; q < NEAR_KERNELS; q++) PetscCall(PetscFree(p->level[k].entry[q]));
  }
  PetscCall(PetscFree(*pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u += a kernel at the distance d from a source of the strength f, with the normal `normal` (NULL: a Stokeslet); f and
   normal have their components n numbers apart, u as many as there are targets. */
static inline void NearAct(const NearEntry *e, const PetscReal d[3], PetscInt n, const PetscReal f[],
                           const PetscReal *normal, PetscInt targets, PetscReal u[]) {
  PetscReal along = 0, df = 0, dn = 0, fn = 0;
  for (int q = 0; q < 3; q++) along += e->b * d[q] * f[q * n];
  if (!normal) {
    for (int q = 0; q < 3; q++) u[q * targets] += e->a * f[q * n] + along * d[q];
    return;
  }
  for (int q = 0; q < 3; q++) {
    df += d[q] * f[q * n];
    dn += d[q] * normal[q * n];
    fn += f[q * n] * normal[q * n];
  }
  for (int q = 0; q < 3; q++)
    u[q * targets] += e->a * (f[q * n] * dn + normal[q * n] * df + d[q] * fn) + along * dn * d[q];
}

PetscErrorCode NearPairAdd(NearPair pair, NearKernel kernel, const PetscReal *const F[2], PetscReal *const U[2]) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < pair->levels; k++) {
    const NearLevel *l = &pair->level[k];
    const NearPatch *a = &l->patch[0], *b = &l->patch[1];
    PetscReal *f[2], *u[2];
    PetscCall(PetscMalloc2(3 * a->n, &f[0], 3 * b->n, &f[1]));
    PetscCall(PetscCalloc2(3 * a->n, &u[0], 3 * b->n, &u[1]));
    for (int side = 0; side < 2; side++) {
      const SphereTable *table = &l->patch[side].table;
      PetscCall(SphereFieldValues(table, HARMONIC, F[side], f[side]));
      for (PetscInt i = 0; i < 3 * table->grid.n; i++) f[side][i] *= table->grid.weight[i % table->grid.n];
    }
    for (const NearEntry *e = l->entry[kernel]; e < l->entry[kernel] + l->entries; e++) {
      PetscReal d[3], back[3];
      for (int q = 0; q < 3; q++) {
        d[q] = a->X[q * a->n + e->i] - b->X[q * b->n + e->j];
        back[q] = -d[q];
      }
      NearAct(e, d, b->n, f[1] + e->j, kernel == STRESSLET ? b->normal + e->j : NULL, a->n, u[0] + e->i);
      NearAct(e, back, a->n, f[0] + e->i, kernel == STRESSLET ? a->normal + e->i : NULL, b->n, u[1] + e->j);
    }
    for (int side = 0; side < 2; side++)
      if (U[side]) PetscCall(SphereFieldAdd(&l->patch[side].table, u[side], U[side]));
    PetscCall(PetscFree2(f[0], f[1]));
    PetscCall(PetscFree2(u[0], u[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
