#include "curve/packing.h"
#include "curve/crossing.h"
#include <stdint.h>

#define FIRST_SCALE 0.1 /* size of the ellipses at their first, random places */
#define MOST_TRIES 1000 /* random places that are tried for an ellipse */
#define MOST_SWEEPS 3000
#define MORE_SWEEPS 30 /* sweeps after all ellipses have their size */
#define GROWTH 1.2     /* largest factor by which an ellipse grows in a sweep */
#define LATTICE_HALVINGS 40
#define SECTIONS 14 /* golden sections that decide whether a pair is apart */

typedef struct {
  PackingSpec spec;
  PetscInt n;
  Pose *pose;
  PetscReal *axes;  /* [2n] semi-axes, longer by half a gap */
  PetscReal *scale; /* [n] sizes over the full ones */
  PetscReal length[2], longest, step;
  PetscInt cells[2];             /* cells at least twice `longest` wide that hold the centres */
  PetscInt *first, *next, *cell; /* first centre of a cell, or -1; next in the cell of a centre; its cell */
  uint64_t random;
} Packing;

/* A random number in [0, 1) by splitmix64 (Steele, Lea and Flood 2014). */
static PetscReal PackingRandom(Packing *p) {
  uint64_t z = p->random += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (PetscReal)((z ^ (z >> 31)) >> 11) / 9007199254740992.;
}

/* A random direction: a point of the unit disc, moved to the circle. */
static void PackingDirection(Packing *p, PetscReal u[2]) {
  PetscReal square = 0;
  while (square < 1e-4 || square > 1) {
    for (int d = 0; d < 2; d++) u[d] = 2 * PackingRandom(p) - 1;
    square = u[0] * u[0] + u[1] * u[1];
  }
  for (int d = 0; d < 2; d++) u[d] /= PetscSqrtReal(square);
}

/* Whether two ellipses, with the vector d from one centre to the other, are apart (Perram and Wertheim 1985):

     max t (1 - t) d.C^-1 d > 1,   0 < t < 1,   C = (1 - t) A + t B,   A = scale^2 (b^2 I + (a^2 - b^2) u u),

   B likewise of the other ellipse. Golden sections search for t; the first t with a value above 1 proves it. */
static PetscBool EllipsesAreApart(const PetscReal d[2], const PetscReal axes[2][2], const PetscReal *const u[2],
                                  const PetscReal scale[2]) {
  const PetscReal golden = 0.6180339887498949, square = d[0] * d[0] + d[1] * d[1];
  PetscReal A[2][3], reach = 0, core = 0, low = 0, high = 1, f[2] = {0, 0}, t[2];
  for (int k = 0; k < 2; k++) {
    const PetscReal a = scale[k] * axes[k][0], b = scale[k] * axes[k][1], more = a * a - b * b;
    A[k][0] = b * b + more * u[k][0] * u[k][0];
    A[k][1] = more * u[k][0] * u[k][1];
    A[k][2] = b * b + more * u[k][1] * u[k][1];
    reach += PetscMax(a, b);
    core += PetscMin(a, b);
  }
  if (square >= reach * reach) return PETSC_TRUE;
  if (square <= core * core) return PETSC_FALSE;
  for (int it = 0, fresh = 2; it < SECTIONS; it++) {
    t[0] = high - golden * (high - low);
    t[1] = low + golden * (high - low);
    for (int k = 0; k < 2; k++) {
      if (fresh < 2 && k != fresh) continue;
      const PetscReal x = (1 - t[k]) * A[0][0] + t[k] * A[1][0], y = (1 - t[k]) * A[0][2] + t[k] * A[1][2];
      const PetscReal z = (1 - t[k]) * A[0][1] + t[k] * A[1][1];
      const PetscReal form = (y * d[0] * d[0] - 2 * z * d[0] * d[1] + x * d[1] * d[1]) / (x * y - z * z);
      f[k] = t[k] * (1 - t[k]) * form;
      if (f[k] > 1) return PETSC_TRUE;
    }
    fresh = f[0] > f[1] ? 0 : 1;
    if (fresh) {
      low = t[0];
      f[0] = f[1];
    } else {
      high = t[1];
      f[1] = f[0];
    }
  }
  return PETSC_FALSE;
}

/* TRUE if ellipse i with this pose and scale is apart from ellipse j and its images. */
static PetscBool PackingIsApart(const Packing *p, PetscInt i, const Pose *at, PetscReal scale, PetscInt j) {
  const PetscReal axes[2][2] = {{p->axes[2 * i], p->axes[2 * i + 1]}, {p->axes[2 * j], p->axes[2 * j + 1]}};
  const PetscReal *const u[2] = {at->along, i == j ? at->along : p->pose[j].along};
  const PetscReal scales[2] = {scale, i == j ? scale : p->scale[j]};
  PetscReal d[2], image[2];
  int images[2];
  for (int k = 0; k < 2; k++) {
    d[k] = i == j ? 0 : p->pose[j].center[k] - at->center[k];
    if (p->spec.periodic[k]) d[k] -= p->length[k] * PetscFloorReal(d[k] / p->length[k] + 0.5);
    images[k] = p->spec.periodic[k] && p->cells[k] < 3 ? 1 : 0;
  }
  for (int m = -images[0]; m <= images[0]; m++)
    for (int n = -images[1]; n <= images[1]; n++) {
      if (i == j && !m && !n) continue;
      image[0] = d[0] + m * p->length[0];
      image[1] = d[1] + n * p->length[1];
      if (!EllipsesAreApart(image, axes, u, scales)) return PETSC_FALSE;
    }
  return PETSC_TRUE;
}

static PetscBool PackingClearsWalls(const Packing *p, PetscInt i, const Pose *at, PetscReal scale) {
  for (int d = 0; d < 2; d++) {
    const PetscReal a = p->axes[2 * i] * at->along[d], b = p->axes[2 * i + 1] * at->along[1 - d];
    const PetscReal room = scale * (PetscSqrtReal(a * a + b * b) + p->spec.wall_gap - p->spec.gap / 2);
    if (p->spec.periodic[d]) continue;
    if (at->center[d] - room < p->spec.box[2 * d] || at->center[d] + room > p->spec.box[2 * d + 1]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscInt PackingCell(const Packing *p, int d, PetscReal x) {
  const PetscInt k = (PetscInt)PetscFloorReal((x - p->spec.box[2 * d]) / p->length[d] * p->cells[d]);
  return PetscMax(0, PetscMin(p->cells[d] - 1, k));
}

static PetscBool PackingFits(const Packing *p, PetscInt i, const Pose *at, PetscReal scale) {
  PetscInt around[2][3];
  int count[2];
  for (int d = 0; d < 2; d++)
    count[d] = CellsAround(p->spec.periodic[d], p->cells[d], PackingCell(p, d, at->center[d]), around[d]);
  if (!PackingClearsWalls(p, i, at, scale)) return PETSC_FALSE;
  if (!PackingIsApart(p, i, at, scale, i)) return PETSC_FALSE;
  for (int k = 0; k < count[0] * count[1]; k++) {
    const PetscInt cell = around[1][k / count[0]] * p->cells[0] + around[0][k % count[0]];
    for (PetscInt j = p->first[cell]; j >= 0; j = p->next[j])
      if (j != i && !PackingIsApart(p, i, at, scale, j)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Give ellipse i this pose and scale, and put it into its cell. */
static void PackingPut(Packing *p, PetscInt i, const Pose *at, PetscReal scale) {
  const PetscInt cell = PackingCell(p, 1, at->center[1]) * p->cells[0] + PackingCell(p, 0, at->center[0]);
  p->pose[i] = *at;
  p->scale[i] = scale;
  if (p->cell[i] == cell) return;
  if (p->cell[i] >= 0) {
    PetscInt *to = &p->first[p->cell[i]];
    while (*to != i) to = &p->next[*to];
    *to = p->next[i];
  }
  p->cell[i] = cell;
  p->next[i] = p->first[cell];
  p->first[cell] = i;
}

/* Both semi-axes are made longer by

     e = gap/2 (a + b)/(2 root(a b)).

   The longer ellipse is then at least gap/2 from the tangent of the ellipse in every direction (c, s),

     e (a c^2 + b s^2)/root(a^2 c^2 + b^2 s^2) >= gap/2. */
static PetscErrorCode PackingBegin(Packing *p, const PackingSpec *spec, PetscInt n, const PetscReal axes[],
                                   Pose pose[]) {
  PetscFunctionBeginUser;
  p->spec = *spec;
  p->n = n;
  p->pose = pose;
  p->longest = 0;
  p->random = (uint64_t)spec->seed;
  PetscCall(PetscMalloc4(2 * n, &p->axes, n, &p->scale, n, &p->next, n, &p->cell));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal a = axes[2 * i], b = axes[2 * i + 1], more = spec->gap / 2 * (a + b) / (2 * PetscSqrtReal(a * b));
    p->axes[2 * i] = a + more;
    p->axes[2 * i + 1] = b + more;
    p->longest = PetscMax(p->longest, PetscMax(a, b) + more);
    p->cell[i] = -1;
  }
  p->step = p->longest;
  for (int d = 0; d < 2; d++) {
    p->length[d] = spec->box[2 * d + 1] - spec->box[2 * d];
    p->cells[d] = PetscMax(1, (PetscInt)PetscMin(2 * PetscSqrtReal(n) + 1, p->length[d] / (2 * p->longest)));
  }
  PetscCall(PetscMalloc1(p->cells[0] * p->cells[1], &p->first));
  for (PetscInt k = 0; k < p->cells[0] * p->cells[1]; k++) p->first[k] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PackingEnd(Packing *p) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(p->axes, p->scale, p->next, p->cell));
  PetscCall(PetscFree(p->first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shift and turn ellipse i at random; whether it has room there. */
static PetscBool PackingMove(Packing *p, PetscInt i) {
  Pose at = p->pose[i];
  const PetscReal turn = 2 * (PackingRandom(p) - 0.5) * p->step / p->longest, x = at.along[0], y = at.along[1];
  const PetscReal norm = PetscSqrtReal(1 + turn * turn);
  for (int d = 0; d < 2; d++) {
    at.center[d] += 2 * (PackingRandom(p) - 0.5) * p->step;
    if (p->spec.periodic[d])
      at.center[d] -= p->length[d] * PetscFloorReal((at.center[d] - p->spec.box[2 * d]) / p->length[d]);
  }
  at.along[0] = (x - turn * y) / norm;
  at.along[1] = (y + turn * x) / norm;
  if (!PackingFits(p, i, &at, p->scale[i])) return PETSC_FALSE;
  PackingPut(p, i, &at, p->scale[i]);
  return PETSC_TRUE;
}

/* Enlarge ellipse i by as much as a sweep allows, or by an eighth of that. */
static void PackingGrow(Packing *p, PetscInt i) {
  const PetscReal most = PetscMin(1, p->scale[i] * GROWTH), some = p->scale[i] + (most - p->scale[i]) / 8;
  if (p->scale[i] >= 1) return;
  if (PackingFits(p, i, &p->pose[i], most))
    p->scale[i] = most;
  else if (PackingFits(p, i, &p->pose[i], some))
    p->scale[i] = some;
}

/* Move and enlarge every ellipse; returns the part of the area that ellipses of full size have. The length of moves is
   adjusted until a third to a half of them have room. */
static PetscReal PackingSweep(Packing *p) {
  PetscInt taken = 0;
  PetscReal area = 0, full = 0;
  for (PetscInt i = 0; i < p->n; i++) {
    taken += PackingMove(p, i) ? 1 : 0;
    PackingGrow(p, i);
  }
  for (PetscInt i = 0; i < p->n; i++) {
    area += p->axes[2 * i] * p->axes[2 * i + 1];
    if (p->scale[i] >= 1) full += p->axes[2 * i] * p->axes[2 * i + 1];
  }
  if (2 * taken > p->n) p->step = PetscMin(1.1 * p->step, p->longest);
  if (3 * taken < p->n) p->step /= 1.1;
  return full / area;
}

/* Put small ellipses at random places; whether all have room. */
static PetscBool PackingStart(Packing *p) {
  for (PetscInt i = 0; i < p->n; i++) {
    Pose at;
    PetscInt left = MOST_TRIES;
    do {
      for (int d = 0; d < 2; d++) at.center[d] = p->spec.box[2 * d] + PackingRandom(p) * p->length[d];
      PackingDirection(p, at.along);
    } while (!PackingFits(p, i, &at, FIRST_SCALE) && --left);
    if (!left) return PETSC_FALSE;
    PackingPut(p, i, &at, FIRST_SCALE);
  }
  return PETSC_TRUE;
}

PetscErrorCode PackRandomly(const PackingSpec *spec, PetscInt n, const PetscReal axes[], Pose pose[], PetscReal *part) {
  Packing p;
  PetscFunctionBeginUser;
  PetscCall(PackingBegin(&p, spec, n, axes, pose));
  *part = 0;
  if (PackingStart(&p))
    for (PetscInt k = 0; k < MOST_SWEEPS && *part < 1; k++) *part = PackingSweep(&p);
  for (PetscInt k = 0; k < MORE_SWEEPS && *part >= 1; k++) *part = PackingSweep(&p);
  PetscCall(PackingEnd(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Length along d that lattice cells fill: less than the box where ellipses keep more distance from walls than from one
   another. */
static PetscReal LatticeRoom(const Packing *p, int d) {
  return p->length[d] - (p->spec.periodic[d] ? 0 : 2 * p->spec.wall_gap - p->spec.gap);
}

/* Columns of the lattice whose cells are largest over the extent of the longest ellipse in x and y. */
static PetscInt LatticeColumns(const Packing *p, const PetscReal along[2]) {
  PetscReal best = 0, extent[2] = {0, 0};
  PetscInt columns = 1;
  for (PetscInt i = 0; i < p->n; i++)
    for (int d = 0; d < 2; d++) {
      const PetscReal a = p->axes[2 * i] * along[d], b = p->axes[2 * i + 1] * along[1 - d];
      extent[d] = PetscMax(extent[d], PetscSqrtReal(a * a + b * b));
    }
  for (PetscInt k = 1; k <= p->n; k++) {
    const PetscReal x = LatticeRoom(p, 0) / (k * extent[0]), y = LatticeRoom(p, 1) / (((p->n + k - 1) / k) * extent[1]);
    if (PetscMin(x, y) <= best) continue;
    best = PetscMin(x, y);
    columns = k;
  }
  return columns;
}

static PetscBool LatticeFits(Packing *p, PetscReal scale) {
  for (PetscInt i = 0; i < p->n; i++) p->scale[i] = scale;
  for (PetscInt i = 0; i < p->n; i++)
    if (!PackingFits(p, i, &p->pose[i], scale)) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode PackLattice(const PackingSpec *spec, PetscInt n, const PetscReal axes[], const PetscReal along[2],
                           Pose pose[], PetscReal *part) {
  PetscReal low = 0, high = 1;
  Packing p;
  PetscFunctionBeginUser;
  PetscCall(PackingBegin(&p, spec, n, axes, pose));
  const PetscInt columns = LatticeColumns(&p, along), rows = (n + columns - 1) / columns;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal at_x = (i % columns + 0.5) / columns - 0.5, at_y = (i / columns + 0.5) / rows - 0.5;
    const Pose at = {{0.5 * (spec->box[0] + spec->box[1]) + at_x * LatticeRoom(&p, 0),
                      0.5 * (spec->box[2] + spec->box[3]) + at_y * LatticeRoom(&p, 1)},
                     {along[0], along[1]}};
    PackingPut(&p, i, &at, 1);
  }
  if (LatticeFits(&p, 1)) low = 1;
  for (int k = 0; k < LATTICE_HALVINGS && low < high; k++) {
    const PetscReal middle = 0.5 * (low + high);
    if (LatticeFits(&p, middle))
      low = middle;
    else
      high = middle;
  }
  *part = low * low;
  PetscCall(PackingEnd(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
