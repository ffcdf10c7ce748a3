#include "mobility/nearpairs.h"
#include "curve/crossing.h"

#define MANY 16  /* vesicles: with more of them, */
#define SINGLE 4 /* cells between two from which on their block is in single precision */

/* Two vesicles far apart do not feel the grid in one another, as their forces add up to zero; those of obstacles do
 * not. */
static PetscReal Reach(NearList *f, PetscInt v, PetscInt w) {
  return f->pairs->set->markers->grid->free || PetscMax(v, w) >= f->pairs->set->bodies->vesicles
             ? PETSC_MAX_REAL
             : NEAR_REACH * f->pairs->set->markers->grid->h;
}

/* Whether b moved by shift comes as near as `reach` to a. */
static PetscBool Meet(const NearBounds *a, const NearBounds *b, const PetscReal shift[2], PetscReal reach) {
  for (int d = 0; d < 2; d++)
    if (b->low[d] + shift[d] - a->high[d] >= reach || a->low[d] - b->high[d] - shift[d] >= reach) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The block of own vesicle v and the image of w moved by shift, with room for its values. With many
   vesicles values that are far from large are in single precision. */
static PetscErrorCode NearListAddBlock(NearList *f, PetscInt v, PetscInt w, const PetscReal shift[2], PetscReal gap) {
  const Layout l = f->pairs->set->bodies->layout;
  const PetscBool many = l->bodies > MANY;
  const PetscBool single = many && !f->pairs->set->markers->grid->free &&
                           gap >= SINGLE * f->pairs->set->markers->grid->h;
  size_t *values = single ? &f->count.singles : &f->count.values;
  NearBlock *b;
  PetscFunctionBeginUser;
  PetscCall(ArrayReserve((size_t)f->count.blocks + 1, &f->block_room, &f->block));
  b = &f->block[f->count.blocks++];
  *b = (NearBlock){
      .row = v, .column = w, .shift = {shift[0], shift[1]}, .symmetric = PETSC_TRUE, .single = single, .at = *values};
  *values += NearBlockValues(l, b);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Least distance (length) between markers of v and of w moved by shift, where it is below reach. */
static PetscReal NearListGap(NearList *f, PetscInt v, PetscInt w, const PetscReal shift[2], PetscReal reach) {
  const Layout l = f->pairs->set->bodies->layout;
  const PetscReal *X = f->pairs->set->markers->X, none[2] = {0, 0};
  PetscReal least = f->pairs->set->markers->grid->free ? reach : reach * reach;
  for (PetscInt i = l->start[v]; i < l->start[v + 1]; i++) {
    const PetscReal x = X[2 * i] - shift[0], y = X[2 * i + 1] - shift[1];
    const NearBounds at = {{x, y}, {x, y}};
    if (!Meet(&at, &f->pairs->bounds[w], none, reach)) continue;
    for (PetscInt j = l->start[w]; j < l->start[w + 1]; j++) {
      const PetscReal dx = x - X[2 * j], dy = y - X[2 * j + 1];
      least = PetscMin(least, dx * dx + dy * dy);
    }
  }
  return PetscSqrtReal(least);
}

/* An image of w near v. */
typedef struct {
  PetscReal shift[2], gap;
  PetscBool close;
} Image;
#define MOST_IMAGES 9

/* The images of w near v, the nearest first; of v's own without a box part one of each two that are opposite. */
static PetscErrorCode Images(NearList *f, PetscInt v, PetscInt w, Image image[MOST_IMAGES], int *count) {
  const Grid g = f->pairs->set->markers->grid;
  const NearBounds *a = &f->pairs->bounds[v], *b = &f->pairs->bounds[w];
  const PetscReal reach = Reach(f, v, w);
  PetscInt around[2];
  const CurveKind *kind = &f->pairs->set->bodies->kind[v];
  PetscReal middle[2], period[2];
  PetscFunctionBeginUser;
  *count = 0;
  for (int d = 0; d < 2; d++) {
    period[d] = g->hi[d] - g->lo[d];
    around[d] = g->wall[d] ? 0 : 1;
    middle[d] = around[d] * PetscFloorReal(0.5 * (a->low[d] + a->high[d] - b->low[d] - b->high[d]) / period[d] + 0.5);
  }
  for (PetscInt q = -around[1]; q <= around[1]; q++)
    for (PetscInt p = -around[0]; p <= around[0]; p++) {
      Image one = {.shift = {(middle[0] + p) * period[0], (middle[1] + q) * period[1]}};
      const PetscBool along = kind->span[0] != 0 ? q == 0 : p == 0; /* where a spanning curve goes on */
      if (v == w && kind->type == CURVE_SPANNING && along) continue;
      if (v == w && ((!p && !q) || (!f->pairs->set->box && (q < 0 || (q == 0 && p < 0))))) continue;
      if (!Meet(a, b, one.shift, reach)) continue;
      one.gap = NearListGap(f, v, w, one.shift, reach);
      if (!f->pairs->set->markers->grid->free && one.gap >= reach) continue;
      PetscCall(FinePairGap(f->pairs->set, v, w, one.shift, &one.gap, &one.close));
      image[*count] = one;
      if (one.gap < image[0].gap) {
        image[*count] = image[0];
        image[0] = one;
      }
      (*count)++;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether what w does to v is smooth along both: obstacles that rest, as far from one another as the larger one is
   wide, and off walls. */
static PetscBool AreDistant(NearList *f, PetscInt v, PetscInt w, PetscReal gap) {
  const Bodies m = f->pairs->set->bodies;
  const PetscInt body[2] = {v, w};
  PetscReal least = f->pairs->kernel->reach[NEAR_TWO] * f->pairs->set->markers->grid->h;
  if (v == w || !f->pairs->set->box || !m->resting[v] || !m->resting[w]) return PETSC_FALSE;
  for (int end = 0; end < 2; end++) {
    const PetscInt one = body[end];
    const NearBounds *b = &f->pairs->bounds[one];
    if (m->kind[one].type != CURVE_CLOSED) return PETSC_FALSE;
    least = PetscMax(least, PetscHypotReal(b->high[0] - b->low[0], b->high[1] - b->low[1]));
    for (PetscInt k = m->layout->start[one]; k < m->layout->start[one + 1]; k++)
      if (!WallsAreFar(f->pairs->set->markers->grid, f->pairs->set->markers->X + 2 * k,
                       &f->pairs->bounds[body[1 - end]], NULL))
        return PETSC_FALSE;
  }
  return gap >= least;
}

/* A block for each image of w; with a box part one, of the images nearest to each marker, named after the nearest, in
   which all close images are refined; v's own are in its block with itself. */
static PetscErrorCode NearListAddImages(NearList *f, PetscInt v, PetscInt w) {
  Image image[MOST_IMAGES];
  PetscBool distant = PETSC_FALSE;
  int count;
  PetscFunctionBeginUser;
  PetscCall(Images(f, v, w, image, &count));
  if (count && AreDistant(f, v, w, image[0].gap))
    PetscCall(NearDistantAdd(f->distant, f->pairs->set->markers->X, v, w, image[0].shift, &distant));
  if (distant) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < count; k++) {
    if (!f->pairs->set->box || (!k && v != w)) PetscCall(NearListAddBlock(f, v, w, image[k].shift, image[k].gap));
    if (!image[k].close) continue;
    PetscCall(ArrayReserve((size_t)f->count.closes + 1, &f->close_room, &f->close));
    f->close[f->count.closes++] = (NearClose){f->count.blocks - 1,
                                              FinePairMake(f->pairs->set, v, w, image[k].shift, image[k].gap)};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pairs of bodies with an own one among them: of two that rest, or all others. */
typedef struct {
  Layout layout;
  const PetscBool *resting; /* [bodies] */
  PetscBool fixed;
  PetscInt (*pair)[2], count;
  size_t room;
  PetscErrorCode error;
} Candidates;

static PetscBool Keep(void *context, PetscInt v, PetscInt w, const PetscReal d[2]) {
  Candidates *c = (Candidates *)context;
  const Layout l = c->layout;
  const PetscBool first = v >= l->own && v < l->end;
  if (!first && (w < l->own || w >= l->end)) return PETSC_FALSE;
  if ((c->resting[v] && c->resting[w]) != c->fixed) return PETSC_FALSE;
  c->error = ArrayReserve((size_t)c->count + 1, &c->room, &c->pair);
  if (c->error) return PETSC_TRUE;
  c->pair[c->count][0] = first ? v : w;
  c->pair[c->count++][1] = first ? w : v;
  return PETSC_FALSE;
}

static PetscErrorCode FindCandidates(NearList *f, Candidates *c) {
  const Grid g = f->pairs->set->markers->grid;
  const PetscInt bodies = c->layout->bodies;
  const PetscReal reach = Reach(f, 0, bodies - 1);
  PetscReal *middle, period[2], widest = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * bodies, &middle));
  for (int d = 0; d < 2; d++) period[d] = g->wall[d] ? 0 : g->hi[d] - g->lo[d];
  for (PetscInt v = 0; v < bodies; v++) {
    const NearBounds *b = &f->pairs->bounds[v];
    for (int d = 0; d < 2; d++) middle[2 * v + d] = 0.5 * (b->low[d] + b->high[d]);
    widest = PetscMax(widest, PetscHypotReal(b->high[0] - b->low[0], b->high[1] - b->low[1]));
  }
  PetscCall(PairsWithin(bodies, middle, NULL, period, reach == PETSC_MAX_REAL ? reach : widest + reach, Keep, c));
  PetscCall(PetscFree(middle));
  PetscCall(c->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int ByRow(const void *a, const void *b) {
  const PetscInt *p = (const PetscInt *)a, *q = (const PetscInt *)b;
  const PetscInt first = p[0] != q[0] ? p[0] - q[0] : p[1] - q[1];
  return (first > 0) - (first < 0);
}

/* The fixed blocks, or the others, behind those there are. */
static PetscErrorCode AddBlocks(NearList *f, PetscBool fixed) {
  const Layout l = f->pairs->set->bodies->layout;
  const PetscReal none[2] = {0, 0};
  Candidates c = {.layout = l, .resting = f->pairs->set->bodies->resting, .fixed = fixed};
  PetscInt k = 0;
  PetscFunctionBeginUser;
  PetscCall(FindCandidates(f, &c));
  if (c.count) qsort(c.pair, (size_t)c.count, sizeof(*c.pair), ByRow);
  for (PetscInt v = l->own; v < l->end; v++) {
    if (c.resting[v] == fixed) {
      PetscCall(NearListAddBlock(f, v, v, none, 0));
      PetscCall(NearListAddImages(f, v, v));
    }
    for (; k < c.count && c.pair[k][0] == v; k++) PetscCall(NearListAddImages(f, v, c.pair[k][1]));
  }
  PetscCall(PetscFree(c.pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearListCreate(LayerPairs pairs, NearList *f) {
  PetscFunctionBeginUser;
  *f = (NearList){.pairs = pairs};
  PetscCall(NearDistantCreate(pairs->set->bodies->layout, &f->distant));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearListDestroy(NearList *f) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(f->block));
  PetscCall(PetscFree(f->close));
  PetscCall(NearDistantDestroy(&f->distant));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearListFind(NearList *f, PetscInt *first) {
  PetscFunctionBeginUser;
  f->count = f->fixed;
  *first = f->fixed.blocks;
  if (!f->made) {
    PetscCall(AddBlocks(f, PETSC_TRUE));
    f->fixed = f->count;
    f->made = PETSC_TRUE;
  }
  PetscCall(AddBlocks(f, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
