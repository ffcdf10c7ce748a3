#include "space/crosslayer.h"
#include "base/agree.h"
#include "base/lanes.h"
#include "sphere/spherelayer.h"

PetscErrorCode ShareGather(const VesicleShare *s, PetscInt each, const PetscReal own[], PetscReal all[]) {
  PetscMPIInt n;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(s->vesicles * each, &n));
  PetscCall(PetscArrayzero(all, n));
  PetscCall(PetscArraycpy(all + s->first * each, own, s->own * each));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, n, MPIU_REAL, MPI_SUM, s->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerCreate(Sphere fields, VesicleShare share, PetscReal nu, Contact3Law law, PetscInt kernels,
                                CrossLayer *out) {
  CrossLayer c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->fields = c->sphere = fields;
  if (fields->symmetry != SPHERE_WHOLE) PetscCall(SphereCreate(fields->p, SPHERE_WHOLE, &c->sphere));
  c->share = share;
  c->nu = nu;
  c->law = law;
  const PetscInt n = 3 * share.vesicles * c->sphere->shape.grid.n;
  PetscCall(PetscMalloc4(share.vesicles * c->sphere->size, &c->X, n, &c->points, kernels > STRESSLET ? n : 0,
                         &c->normals, share.own * share.vesicles, &c->pair));
  PetscCall(PetscCalloc1(share.vesicles, &c->surface));
  for (PetscInt v = 0; v < share.vesicles; v++) PetscCall(SurfaceCreate(c->sphere, &c->surface[v]));
  PetscCall(NearTablesCreate(kernels, &c->tables));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* No pair is near. */
static PetscErrorCode CrossForgetPairs(CrossLayer c) {
  PetscFunctionBeginUser;
  for (CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++) {
    PetscCall(Contact3Destroy(&pair->contact));
    PetscCall(NearPairDestroy(&pair->near));
  }
  c->pairs = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerDestroy(CrossLayer *cross) {
  CrossLayer c = *cross;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CrossForgetPairs(c));
  PetscCall(NearTablesDestroy(&c->tables));
  for (PetscInt v = 0; v < c->share.vesicles; v++) PetscCall(SurfaceDestroy(&c->surface[v]));
  PetscCall(PetscFree(c->surface));
  PetscCall(PetscFree4(c->X, c->points, c->normals, c->pair));
  if (c->sphere != c->fields) PetscCall(SphereDestroy(&c->sphere));
  PetscCall(PetscFree(*cross));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whole[vesicles][3 count] on every rank of the fields own[own][size]. */
static PetscErrorCode CrossGather(CrossLayer c, const PetscReal own[], PetscReal whole[]) {
  const PetscInt size = c->sphere->size;
  PetscReal *here;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->share.own * size, &here));
  for (PetscInt v = 0; v < c->share.own; v++) SphereUnfold(c->fields, 3, own + v * c->fields->size, here + v * size);
  PetscCall(ShareGather(&c->share, size, here, whole));
  PetscCall(PetscFree(here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* own[own][size] += the fields whole[own][3 count]. */
static PetscErrorCode CrossAddFields(CrossLayer c, const PetscReal whole[], PetscReal own[]) {
  const PetscInt size = c->fields->size;
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, &part));
  for (PetscInt v = 0; v < c->share.own; v++) {
    SphereFold(c->fields, whole + v * c->sphere->size, part);
    for (PetscInt k = 0; k < size; k++) own[v * size + k] += part[k];
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A surface as its neighbours see it from afar. */
typedef struct {
  PetscReal center[3], radius; /* of a ball around it */
  PetscReal spacing;           /* the largest one of the grid of degree p */
} Outline;

static Outline OutlineOf(CrossLayer c, PetscInt v) {
  const Surface s = c->surface[v];
  Outline o = {.radius = 0};
  for (int d = 0; d < 3; d++) o.center[d] = c->X[(v * 3 + d) * c->sphere->count] / PetscSqrtReal(4 * PETSC_PI);
  for (PetscInt i = 0; i < s->n; i++) {
    PetscReal r2 = 0, along[2] = {0, 0};
    for (int d = 0; d < 3; d++) {
      r2 += PetscSqr(s->D[HARMONIC][d * s->n + i] - o.center[d]);
      along[0] += PetscSqr(s->D[HARMONIC_T][d * s->n + i]);
      along[1] += PetscSqr(s->D[HARMONIC_P][d * s->n + i]);
    }
    o.radius = PetscMax(o.radius, PetscSqrtReal(r2));
    o.spacing = PetscMax(o.spacing, PetscSqrtReal(PetscMax(along[0], along[1])) * PETSC_PI / (c->sphere->p + 1));
  }
  return o;
}

/* Distance of the balls around two surfaces. */
static PetscReal OutlineApart(const Outline *a, const Outline *b) {
  PetscReal apart = 0;
  for (int d = 0; d < 3; d++) apart += PetscSqr(a->center[d] - b->center[d]);
  return PetscSqrtReal(apart) - a->radius - b->radius;
}

/* How far point i of a is outside b, along the normal at the point j of b. */
static PetscReal CrossOutside(Surface a, PetscInt i, Surface b, PetscInt j) {
  PetscReal along = 0;
  for (PetscInt d = 0; d < 3; d++)
    along += (a->D[HARMONIC][d * a->n + i] - b->D[HARMONIC][d * b->n + j]) * b->normal[d * b->n + j];
  return along;
}

/* The gap of two surfaces: at the nearest points of their fine grids, along the normal. Where they overlap it is
   negative, the depth of a point of a below the point of b that is nearest to it. */
static PetscReal CrossGap(Surface a, Surface b) {
  const PetscReal *X = a->D[HARMONIC], *Y = b->D[HARMONIC];
  const PetscInt n = a->n;
  PetscReal least = PETSC_MAX_REAL, deepest = 0;
  PetscInt at[2] = {0, 0};
  for (PetscInt i = 0; i < n; i++) {
    PetscReal nearest = PETSC_MAX_REAL;
    PetscInt k = 0;
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal r2 = PetscSqr(X[i] - Y[j]) + PetscSqr(X[n + i] - Y[n + j]) +
                           PetscSqr(X[2 * n + i] - Y[2 * n + j]);
      if (r2 >= nearest) continue;
      nearest = r2;
      k = j;
    }
    const PetscReal outside = CrossOutside(a, i, b, k);
    if (outside < -0.5 * PetscSqrtReal(nearest)) deepest = PetscMin(deepest, outside);
    if (nearest >= least) continue;
    least = nearest;
    at[0] = i;
    at[1] = k;
  }
  return deepest < 0 ? deepest : PetscMin(CrossOutside(a, at[0], b, at[1]), CrossOutside(b, at[1], a, at[0]));
}

static PetscBool ShareOwns(const VesicleShare *s, PetscInt v) {
  return (PetscBool)(v >= s->first && v < s->first + s->own);
}

/* The least gap of the own surfaces, and the pairs that are near. Of surfaces so far apart that it does not matter the
   gap is that of the balls around them. */
static PetscErrorCode CrossFindPairs(CrossLayer c) {
  const VesicleShare *s = &c->share;
  Outline *outline;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->vesicles, &outline));
  for (PetscInt v = 0; v < s->vesicles; v++) outline[v] = OutlineOf(c, v);
  c->gap = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < s->vesicles; v++)
    for (PetscInt w = v + 1; w < s->vesicles; w++) {
      const PetscReal spacing = PetscMax(outline[v].spacing, outline[w].spacing);
      PetscReal gap = OutlineApart(&outline[v], &outline[w]);
      if (!ShareOwns(s, v) && !ShareOwns(s, w)) continue;
      if (gap <= NearReach(spacing)) {
        gap = CrossGap(c->surface[v], c->surface[w]);
        c->pair[c->pairs++] = (CrossPair){.surface = {v, w}, .spacing = spacing};
      }
      if (gap >= c->gap) continue;
      c->gap = gap;
      c->nearest[0] = v;
      c->nearest[1] = w;
    }
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

PetscErrorCode CrossLayerMeasure(CrossLayer c, const PetscReal X[]) {
  PetscFunctionBeginUser;
  PetscCall(CrossForgetPairs(c));
  PetscCall(CrossGather(c, X, c->X));
  for (PetscInt v = 0; v < c->share.vesicles; v++)
    PetscCall(SurfacePlace(c->surface[v], c->X + v * c->sphere->size, PETSC_FALSE));
  PetscCall(CrossFindPairs(c));
  PetscCall(CrossAgreeGap(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Contacts of the near pairs. */
static PetscErrorCode CrossFindContacts(CrossLayer c) {
  const PetscInt count = c->sphere->count;
  PetscReal *J;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * count, &J));
  for (CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++) {
    for (int side = 0; side < 2; side++)
      PetscCall(SphereTableProject(&c->sphere->fine, count, 1, c->surface[pair->surface[side]]->J, J + side * count));
    PetscCall(Contact3Create(&c->law, pair->near, J, J + count, &pair->contact));
  }
  PetscCall(PetscFree(J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerPlace(CrossLayer c, const PetscReal X[]) {
  const PetscInt count = c->sphere->count;
  PetscFunctionBeginUser;
  PetscCall(CrossLayerMeasure(c, X));
  if (c->gap <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphereTableValues(&c->sphere->shape, HARMONIC, count, 3 * c->share.vesicles, c->X, c->points));
  for (PetscInt v = 0; v < c->share.vesicles && c->tables.kernels > STRESSLET; v++)
    PetscCall(LayerNormals(&c->sphere->shape, c->X + v * 3 * count, c->normals + v * 3 * c->sphere->shape.grid.n));
  for (CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++)
    PetscCall(NearPairCreate(c->sphere, &c->tables, pair->spacing, c->X + pair->surface[0] * 3 * count,
                             c->X + pair->surface[1] * 3 * count, &pair->near));
  if (c->law.stress > 0) PetscCall(CrossFindContacts(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u[3][n] += Stokeslets of the forces f[3][n] at Y[3][n], or stresslets of the velocities f with the normals
   normal[3][n] (NULL: Stokeslets), at the points X[3][n]; 8 pi times the velocity. The last four sources overlap
   others, of which they take nothing. */
static void CrossAddPoints(PetscInt n, const PetscReal X[], const PetscReal Y[], const PetscReal f[],
                           const PetscReal *normal, PetscReal u[]) {
  const Lanes order = {0, 1, 2, 3}, none = {0};
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
      Lanes along = (x * fx + y * fy + z * fz) * over * over * over, isotropic = over;
      if (normal) {
        along *= -6 * over * over *
                 (x * LanesAt(normal + j) + y * LanesAt(normal + n + j) + z * LanesAt(normal + 2 * n + j));
        isotropic = none;
      }
      sum[0] += fx * isotropic + along * x;
      sum[1] += fy * isotropic + along * y;
      sum[2] += fz * isotropic + along * z;
    }
    for (int d = 0; d < 3; d++) u[d * n + i] += LanesSum(sum[d]);
  }
}

/* U[own] += what all other vesicles' grids of degree p do, of viscosity 1; F[vesicles]. */
static PetscErrorCode CrossAddGrids(CrossLayer c, NearKernel kernel, const PetscReal F[], PetscReal U[]) {
  const SphereTable *table = &c->sphere->shape;
  const PetscInt n = table->grid.n, count = c->sphere->count, all = 3 * c->share.vesicles;
  PetscReal *f, *u;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(all * n, &f, 3 * n, &u));
  PetscCall(SphereTableValues(table, HARMONIC, count, all, F, f));
  for (PetscInt k = 0; k < all * n; k++) f[k] *= table->grid.weight[k % n] / (8 * PETSC_PI);
  for (PetscInt v = 0; v < c->share.own; v++) {
    const PetscInt self = c->share.first + v;
    PetscCall(PetscArrayzero(u, 3 * n));
    for (PetscInt w = 0; w < c->share.vesicles; w++)
      if (w != self)
        CrossAddPoints(n, c->points + self * 3 * n, c->points + w * 3 * n, f + w * 3 * n,
                       kernel == STRESSLET ? c->normals + w * 3 * n : NULL, u);
    PetscCall(SphereFieldAdd(table, u, U + v * 3 * count));
  }
  PetscCall(PetscFree2(f, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a pair's surfaces have of the fields all[vesicles] and, where they are own, whole[own]. */
static void CrossSides(CrossLayer c, const CrossPair *pair, const PetscReal all[], const PetscReal *in[2],
                       PetscReal whole[], PetscReal *out[2]) {
  for (int side = 0; side < 2; side++) {
    const PetscInt v = pair->surface[side], own = v - c->share.first;
    in[side] = all + v * c->sphere->size;
    out[side] = ShareOwns(&c->share, v) ? whole + own * c->sphere->size : NULL;
  }
}

PetscErrorCode CrossLayerAdd(CrossLayer c, NearKernel kernel, const PetscReal F[], PetscReal U[]) {
  const VesicleShare *s = &c->share;
  const PetscInt size = 3 * c->sphere->count;
  PetscReal *all, *whole;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->vesicles * size, &all));
  PetscCall(PetscCalloc1(s->own * size, &whole));
  PetscCall(CrossGather(c, F, all));
  for (PetscInt k = 0; k < s->vesicles * size && kernel == STOKESLET; k++) all[k] /= c->nu;
  PetscCall(CrossAddGrids(c, kernel, all, whole));
  for (const CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++) {
    const PetscReal *f[2];
    PetscReal *u[2];
    CrossSides(c, pair, all, f, whole, u);
    PetscCall(NearPairAdd(pair->near, kernel, f, u));
  }
  PetscCall(CrossAddFields(c, whole, U));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerEnergy(CrossLayer c, PetscReal *energy) {
  PetscFunctionBeginUser;
  *energy = 0;
  for (const CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++)
    if (ShareOwns(&c->share, pair->surface[0])) *energy += pair->contact.energy;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, c->share.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CrossLayerAddContact(CrossLayer c, PetscBool gradient, const PetscReal change[], PetscReal G[]) {
  const PetscInt size = c->sphere->size;
  PetscReal *all, *whole;
  PetscFunctionBeginUser;
  if (c->law.stress <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(c->share.vesicles * size, &all));
  PetscCall(PetscCalloc1(c->share.own * size, &whole));
  PetscCall(CrossGather(c, change, all));
  for (const CrossPair *pair = c->pair; pair < c->pair + c->pairs; pair++) {
    const PetscReal *moved[2];
    PetscReal *g[2];
    CrossSides(c, pair, all, moved, whole, g);
    PetscCall(Contact3Add(&pair->contact, c->sphere->count, gradient, moved, g));
  }
  PetscCall(CrossAddFields(c, whole, G));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}
