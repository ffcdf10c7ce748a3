#include "space/crosslayer.h"
#include "base/agree.h"
#include "base/lanes.h"
#include "sphere/surface.h"

#define FINENESS 2.5 /* degree of a grid, over p times spacing over gap */
static const PetscReal finer[CROSS_LEVELS] = {1, 1.5, 2, 3, 4, 6, 9};

PetscErrorCode ShareGather(const VesicleShare *s, PetscInt each, const PetscReal own[], PetscReal all[]) {
  PetscMPIInt n;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(s->vesicles * each, &n));
  PetscCall(PetscArrayzero(all, n));
  PetscCall(PetscArraycpy(all + s->first * each, own, s->own * each));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, n, MPIU_REAL, MPI_SUM, s->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ShareScatter(const VesicleShare *s, PetscInt each, const PetscReal all[], PetscReal own[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(own, all + s->first * each, s->own * each));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerCreate(Sphere sphere, VesicleShare share, PetscReal nu, CrossLayer *out) {
  CrossLayer c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->sphere = sphere;
  c->share = share;
  c->nu = nu;
  PetscCall(PetscMalloc2(share.vesicles * 3 * sphere->count, &c->X, share.own * (share.vesicles - 1), &c->pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerDestroy(CrossLayer *cross) {
  CrossLayer c = *cross;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (int level = 0; level < CROSS_LEVELS; level++) {
    PetscCall(PetscFree(c->points[level]));
    if (c->table[level].part[0]) PetscCall(SphereTableDestroy(&c->table[level]));
  }
  PetscCall(PetscFree2(c->X, c->pair));
  PetscCall(PetscFree(*cross));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A surface as its neighbours see it. */
typedef struct {
  PetscReal *X, *normal; /* [3][n] points of the fine grid, unit normals */
  PetscReal center[3], radius;
  PetscReal spacing; /* on the grid of degree p */
} Outline;

static PetscErrorCode OutlineMake(CrossLayer c, Surface s, PetscInt v, Outline *o) {
  PetscFunctionBeginUser;
  PetscCall(SurfacePlace(s, c->X + v * 3 * c->sphere->count, PETSC_FALSE));
  PetscCall(PetscMalloc2(3 * s->n, &o->X, 3 * s->n, &o->normal));
  PetscCall(PetscArraycpy(o->X, s->D[HARMONIC], 3 * s->n));
  PetscCall(PetscArraycpy(o->normal, s->normal, 3 * s->n));
  o->spacing = PetscSqrtReal(s->area / (PetscReal)c->sphere->shape.grid.n);
  for (int d = 0; d < 3; d++) o->center[d] = c->X[(v * 3 + d) * c->sphere->count] / PetscSqrtReal(4 * PETSC_PI);
  o->radius = 0;
  for (PetscInt i = 0; i < s->n; i++) {
    PetscReal r2 = 0;
    for (int d = 0; d < 3; d++) r2 += PetscSqr(o->X[d * s->n + i] - o->center[d]);
    o->radius = PetscMax(o->radius, PetscSqrtReal(r2));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The gap of two surfaces: at the nearest points of their fine grids, along the normal; negative where they overlap. Of
   surfaces so far apart that it does not matter, the gap of the balls around them. */
static PetscReal OutlineGap(PetscInt n, const Outline *a, const Outline *b) {
  PetscReal least = PETSC_MAX_REAL, apart = 0;
  PetscInt at[2] = {0, 0};
  for (int d = 0; d < 3; d++) apart += PetscSqr(a->center[d] - b->center[d]);
  apart = PetscSqrtReal(apart) - a->radius - b->radius;
  if (apart > FINENESS * PetscMax(a->spacing, b->spacing)) return apart;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal x = a->X[i] - b->X[j], y = a->X[n + i] - b->X[n + j], z = a->X[2 * n + i] - b->X[2 * n + j],
                      r2 = x * x + y * y + z * z;
      if (r2 >= least) continue;
      least = r2;
      at[0] = i;
      at[1] = j;
    }
  PetscReal along[2] = {0, 0};
  for (int d = 0; d < 3; d++) {
    const PetscReal from_b = a->X[d * n + at[0]] - b->X[d * n + at[1]];
    along[0] -= from_b * a->normal[d * n + at[0]];
    along[1] += from_b * b->normal[d * n + at[1]];
  }
  return PetscMin(along[0], along[1]);
}

/* Which level a pair has: the first that is fine enough. */
static PetscInt CrossLevel(PetscInt p, PetscReal spacing, PetscReal gap) {
  PetscInt level = 0;
  while (level < CROSS_LEVELS - 1 && finer[level] * gap < FINENESS * spacing) level++;
  return level;
}

static PetscErrorCode CrossFindPairs(CrossLayer c) {
  const VesicleShare *s = &c->share;
  Outline *outline;
  Surface surface;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->vesicles, &outline));
  PetscCall(SurfaceCreate(c->sphere, &surface));
  for (PetscInt v = 0; v < s->vesicles; v++) PetscCall(OutlineMake(c, surface, v, &outline[v]));
  c->pairs = 0;
  c->gap = PETSC_MAX_REAL;
  for (PetscInt v = s->first; v < s->first + s->own; v++)
    for (PetscInt w = 0; w < s->vesicles; w++) {
      if (w == v) continue;
      const PetscReal gap = OutlineGap(surface->n, &outline[PetscMin(v, w)], &outline[PetscMax(v, w)]);
      const PetscReal spacing = PetscMax(outline[v].spacing, outline[w].spacing);
      c->pair[c->pairs++] = (CrossPair){v - s->first, w, CrossLevel(c->sphere->p, spacing, gap)};
      if (gap >= c->gap) continue;
      c->gap = gap;
      c->nearest[0] = PetscMin(v, w);
      c->nearest[1] = PetscMax(v, w);
    }
  for (PetscInt v = 0; v < s->vesicles; v++) PetscCall(PetscFree2(outline[v].X, outline[v].normal));
  PetscCall(SurfaceDestroy(&surface));
  PetscCall(PetscFree(outline));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The least gap of all ranks, and whose it is. */
static PetscErrorCode CrossAgreeGap(CrossLayer c) {
  PetscReal nearest = -c->gap;
  PetscMPIInt whose;
  PetscFunctionBeginUser;
  PetscCall(AgreeLargest(c->share.comm, &nearest, &whose));
  c->gap = -nearest;
  PetscCallMPI(MPI_Bcast(c->nearest, 2, MPIU_INT, whose, c->share.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerPlace(CrossLayer c, const PetscReal X[]) {
  const PetscInt size = 3 * c->sphere->count;
  PetscFunctionBeginUser;
  PetscCall(ShareGather(&c->share, size, X, c->X));
  PetscCall(CrossFindPairs(c));
  PetscCall(CrossAgreeGap(c));
  for (int level = 0; level < CROSS_LEVELS; level++) PetscCall(PetscFree(c->points[level]));
  for (PetscInt k = 0; k < c->pairs; k++) {
    const PetscInt level = c->pair[k].level;
    SphereTable *table = &c->table[level];
    if (!table->part[0]) PetscCall(SphereTableCreate(c->sphere->p, (PetscInt)(finer[level] * c->sphere->p), 1, table));
    if (c->points[level]) continue;
    PetscCall(PetscMalloc1(c->share.vesicles * 3 * table->grid.n, &c->points[level]));
    PetscCall(SphereTableValues(table, HARMONIC, c->sphere->count, 3 * c->share.vesicles, c->X, c->points[level]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u[3][n] += Stokeslets of the forces f[3][n] at Y[3][n], at the points X[3][n]; 8 pi nu times the velocity. The last
   four sources overlap others, of which they take nothing. */
static void CrossAddStokeslets(PetscInt n, const PetscReal X[], const PetscReal Y[], const PetscReal f[],
                               PetscReal u[]) {
  const Lanes order = {0, 1, 2, 3};
  for (PetscInt i = 0; i < n; i++) {
    Lanes sum[3] = {{0}, {0}, {0}};
    for (PetscInt k = 0; k < n; k += LANES) {
      const PetscInt j = PetscMin(k, n - LANES);
      const LanesBits so = (LanesBits)(order >= (Lanes){0} + (PetscReal)(k - j));
      const Lanes x = X[i] - LanesAt(Y + j), y = X[n + i] - LanesAt(Y + n + j),
                  z = X[2 * n + i] - LanesAt(Y + 2 * n + j), r2 = x * x + y * y + z * z, fx = LanesAt(f + j),
                  fy = LanesAt(f + n + j), fz = LanesAt(f + 2 * n + j);
      const Lanes root = {PetscSqrtReal(r2[0]), PetscSqrtReal(r2[1]), PetscSqrtReal(r2[2]), PetscSqrtReal(r2[3])},
                  over = LanesWhere(so, 1 / root);
      const Lanes along = (x * fx + y * fy + z * fz) * over * over * over;
      sum[0] += fx * over + along * x;
      sum[1] += fy * over + along * y;
      sum[2] += fz * over + along * z;
    }
    for (int d = 0; d < 3; d++) u[d * n + i] += LanesSum(sum[d]);
  }
}

/* U += what the pairs of one level do. */
static PetscErrorCode CrossAddLevel(CrossLayer c, PetscInt level, const PetscReal F[], PetscReal U[]) {
  const SphereTable *table = &c->table[level];
  const PetscInt n = table->grid.n, count = c->sphere->count, size = 3 * count;
  PetscReal *f, *u, *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(c->share.vesicles * 3 * n, &f, 3 * n, &u, size, &part));
  PetscCall(SphereTableValues(table, HARMONIC, count, 3 * c->share.vesicles, F, f));
  for (PetscInt k = 0; k < c->share.vesicles * 3; k++)
    for (PetscInt i = 0; i < n; i++) f[k * n + i] *= table->grid.weight[i] / (8 * PETSC_PI * c->nu);
  for (PetscInt v = 0; v < c->share.own; v++) {
    const PetscReal *X = c->points[level] + (c->share.first + v) * 3 * n;
    PetscBool any = PETSC_FALSE;
    PetscCall(PetscArrayzero(u, 3 * n));
    for (const CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++) {
      if (pair->own != v || pair->level != level) continue;
      CrossAddStokeslets(n, X, c->points[level] + pair->other * 3 * n, f + pair->other * 3 * n, u);
      any = PETSC_TRUE;
    }
    if (any) PetscCall(SphereTableProject(table, count, 3, u, part));
    for (PetscInt k = 0; k < size && any; k++) U[v * size + k] += part[k];
  }
  PetscCall(PetscFree3(f, u, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerAdd(CrossLayer c, const PetscReal F[], PetscReal U[]) {
  const PetscInt size = 3 * c->sphere->count;
  PetscReal *all;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->share.vesicles * size, &all));
  PetscCall(ShareGather(&c->share, size, F, all));
  for (PetscInt level = 0; level < CROSS_LEVELS; level++)
    if (c->points[level]) PetscCall(CrossAddLevel(c, level, all, U));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
