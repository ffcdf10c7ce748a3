#include "coupling/nearfield.h"
#include "base/agree.h"
#include "coupling/nearblock.h"
#include "coupling/nearclose.h"
#include "coupling/nearpairs.h"
#include "coupling/nearrows.h"
#include "coupling/wallclose.h"

/* Weights of ln(4 sin^2(t/2)) in Kress' quadrature on n points, by index difference; less that logarithm and times -1/2
   but at 0. */
static void Kress(PetscInt n, PetscReal k[]) {
  for (PetscInt d = 0; d < n; d++) {
    k[d] = 0;
    for (PetscInt m = 1; m <= (n - 1) / 2; m++) k[d] -= 2 * PetscCosReal(2 * PETSC_PI * ((m * d) % n) / n) / m;
    if (n % 2 == 0) k[d] -= (d % 2 ? -2.0 : 2.0) / n;
    if (d) k[d] = -0.5 * (k[d] - PetscLogReal(4 * PetscSqr(PetscSinReal(PETSC_PI * d / n))));
  }
}

#define ZETA 0.0304484570583 /* -zeta'(-2) */

/* The same of an open curve, of the trapezoidal rule with three corrected weights: on the diagonal ln(2 pi/ds) - 2
   ZETA, beside it ZETA. It has no corrections at the ends, where the force fades. */
static void Zeta(PetscInt n, PetscReal k[]) {
  for (PetscInt d = 0; d < n; d++) k[d] = 0;
  k[0] = 4 * ZETA;
  k[1] = ZETA;
}

/* The lattice's tables, for pairs, their images in walls and the box part. */
static PetscErrorCode MakeLattice(NearField f) {
  const Grid g = f->markers->grid;
  ImageTable *half = NULL;
  PetscFunctionBeginUser;
  PetscCall(LatticeStokeslet(BOX_LATTICE_CELLS + OFFSET_LAGS, &f->lattice));
  if (g->wall[0] || g->wall[1]) {
    PetscCall(PetscNew(&half));
    PetscCall(ImageTableFill(&f->lattice, half));
  }
  PetscCall(NearImageCreate(f->markers, f->nu, f->unit, half, &f->image));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldCreate(Markers markers, Bodies bodies, PetscReal nu, NearField *out) {
  const Layout l = bodies->layout;
  NearField f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->markers = markers;
  f->bodies = bodies;
  f->nu = nu;
  f->unit = markers->grid->h;
  f->free = markers->grid->free;
  NearFarMake(markers->kernel, f->far);
  if (!f->free) PetscCall(MakeLattice(f));
  PetscCall(PetscCalloc1(l->bodies, &f->kress));
  for (PetscInt v = l->own; v < l->end; v++) {
    PetscCall(PetscMalloc1(LayoutCount(l, v), &f->kress[v]));
    (bodies->kind[v].type == CURVE_OPEN ? Zeta : Kress)(LayoutCount(l, v), f->kress[v]);
  }
  PetscCall(NearDistantCreate(l, &f->fixed.distant));
  PetscCall(PetscMalloc2(2 * l->M, &f->stencil, l->bodies, &f->bounds));
  for (int c = 0; c < 4; c++) PetscCall(PetscCalloc1(l->M + LANES, &f->fourth[c / 2][c % 2]));
  PetscCall(PetscCalloc2(2 * l->M + LANES, &f->force, 2 * l->n + LANES, &f->velocity)); /* whole vectors */
  PetscCall(PetvesEvent("NearField", &f->event[0]));
  PetscCall(PetvesEvent("NearFieldApply", &f->event[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldDestroy(NearField *near) {
  NearField f = *near;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(f->block));
  PetscCall(PetscFree(f->close));
  PetscCall(NearDistantDestroy(&f->fixed.distant));
  PetscCall(PetscFree(f->store.value));
  PetscCall(PetscFree(f->store.single));
  for (PetscInt v = 0; v < f->bodies->layout->bodies; v++) PetscCall(PetscFree(f->kress[v]));
  PetscCall(PetscFree(f->kress));
  PetscCall(PetscFree2(f->stencil, f->bounds));
  for (int c = 0; c < 4; c++) PetscCall(PetscFree(f->fourth[c / 2][c % 2]));
  PetscCall(PetscFree2(f->force, f->velocity));
  if (f->image) PetscCall(PetscFree(f->image->table));
  PetscCall(NearImageDestroy(&f->image));
  PetscCall(OffsetTableDestroy(&f->lattice));
  PetscCall(BoxPartDestroy(&f->box));
  PetscCall(PetscFree(*near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldCreateBoxPart(NearField f, const FluidSpec *spec, PetscBool whole, BoxPart *box) {
  const BoxLattice lattice = {
      .unit = f->unit, .stokeslet = &f->lattice, .half = f->image ? f->image->table : NULL, .whole = whole};
  PetscFunctionBeginUser;
  PetscCall(BoxPartCreate(spec, f->markers, &lattice, box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldAddBoxPart(NearField f, const FluidSpec *spec) {
  PetscFunctionBeginUser;
  PetscCall(NearFieldCreateBoxPart(f, spec, PETSC_FALSE, &f->box));
  /* not with obstacles, whose pairs are made once */
  if (f->image && f->bodies->vesicles == f->bodies->layout->bodies) BoxPartTakeImages(f->box, f->image, NearImageFar);
  if (spec->inertia == INERTIA_NONE) MarkersLeaveUnscaled(f->markers);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stencils of the vesicles that blocks are of, each once. */
static PetscErrorCode PlaceStencils(NearField f) {
  const Layout l = f->bodies->layout;
  PetscBool *done;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(l->bodies, &done));
  for (PetscInt b = 0; b < f->blocks; b++)
    for (int end = 0; end < 2; end++) {
      const PetscInt v = end ? f->block[b].column : f->block[b].row;
      for (PetscInt k = l->start[v]; k < l->start[v + 1] && !done[v]; k++) {
        PaddedStencil *s = &f->stencil[2 * k];
        for (int c = 0; c < 2; c++) StencilPad(&f->markers->plain[2 * k + c], &s[c]);
        StencilUnwrap(f->markers->grid, f->markers->X + 2 * k, s);
        for (int c = 0; c < 4; c++)
          f->fourth[c / 2][c % 2][k] = s[c / 2].fourth[c % 2] - f->far[NEAR_ONE].fourth[c / 2 != c % 2];
      }
      done[v] = PETSC_TRUE;
    }
  PetscCall(PetscFree(done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for so many values of this size, and a quarter more where it has to be made anew; the first `kept` stay. */
static PetscErrorCode Room(size_t count, size_t kept, size_t size, size_t *room, void **values) {
  void *more;
  PetscFunctionBeginUser;
  if (count <= *room) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc((count + count / 4) * size, &more));
  PetscCall(PetscMemcpy(more, *values, PetscMin(kept, *room) * size));
  PetscCall(PetscFree(*values));
  *room = count + count / 4;
  *values = more;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C of a distant pair as a block in double precision, and where it is: in a store of its own. */
static PetscErrorCode FillDistant(NearField f, PetscInt pair) {
  const NearDistantPair *p = &f->fixed.distant->pair[pair];
  const NearBlock block = {.row = p->row, .column = p->column, .shift = {p->shift[0], p->shift[1]}};
  const NearStore kept = f->store;
  const NearRow r = NearBlockBegin(f->bodies->layout, &block);
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * LayoutCount(f->bodies->layout, p->row) * r.stride, &f->store.value));
  PetscCall(NearBlockFill(f, &block));
  PetscCall(NearDistantFill(f->fixed.distant, pair, r.stride, f->store.value));
  PetscCall(PetscFree(f->store.value));
  f->store = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distant pairs, once; crossed: with another rank's marker. */
static PetscErrorCode PlaceDistant(NearField f, PetscBool *crossed) {
  const Layout l = f->bodies->layout;
  NearDistant d = f->fixed.distant;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < d->pairs; k++)
    if (d->pair[k].column < l->own || d->pair[k].column >= l->end) *crossed = PETSC_TRUE;
  if (d->value || !d->pairs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NearDistantMake(d));
  for (PetscInt k = 0; k < d->pairs; k++) PetscCall(FillDistant(f, k));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldPlace(NearField f) {
  const Layout l = f->bodies->layout;
  NearStore *s = &f->store;
  PetscBool crossed = PETSC_FALSE;
  PetscInt first;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(f->event[0], 0, 0, 0, 0));
  PetscCall(NearPairsFind(f, &first));
  PetscCall(Room(s->values, f->fixed.values, sizeof(PetscReal), &s->value_room, (void **)&s->value));
  PetscCall(Room(s->singles, f->fixed.singles, sizeof(float), &s->single_room, (void **)&s->single));
  if (!f->free) PetscCall(PlaceStencils(f));
  if (f->image) PetscCall(NearImagePlace(f->image, f->stencil));
  if (f->box) PetscCall(BoxPartPlace(f->box)); /* before the blocks, which may leave images to it */
  for (PetscInt k = 0; k < f->blocks; k++) {
    const NearBlock *b = &f->block[k];
    if (b->column < l->own || b->column >= l->end) crossed = PETSC_TRUE;
    if (k < first) continue;
    PetscCall(NearBlockFill(f, b));
    if (f->image) PetscCall(NearBlockRefineAtWalls(f, b));
  }
  for (PetscInt k = 0; k < f->closes; k++)
    if (f->close[k].block >= first) PetscCall(NearCloseAdd(f, &f->close[k]));
  PetscCall(PlaceDistant(f, &crossed));
  PetscCall(AgreeFlag(l->comm, crossed, &f->crossed));
  PetscCall(PetscLogEventEnd(f->event[0], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* velocity[2n] += alpha C force[2M] of one block: both ways where both vesicles are own ones. */
static inline void ApplyBlock(NearField f, const NearBlock *b, const PetscBool single, const void *value,
                              PetscReal alpha, const PetscScalar force[], PetscScalar velocity[]) {
  const Layout l = f->bodies->layout;
  const PetscBool both = b->column >= l->own && b->column < l->end ? PETSC_TRUE : PETSC_FALSE;
  PetscInt rows;
  NearRow r = NearBlockBegin(l, b);
  do {
    PetscScalar *other = both ? velocity + 2 * (r.column - l->first) : NULL, *own = velocity + 2 * (r.row - l->first);
    rows = NearBlockIsSelf(b) || r.row + 2 > l->start[b->row + 1] ? 1 : 2;
    if (rows == 2)
      ApplyRows(2, single, value, r.at, r.stride, alpha, both, force + 2 * r.row, force + 2 * r.column, own, other);
    else
      ApplyRows(1, single, value, r.at, r.stride, alpha, both, force + 2 * r.row, force + 2 * r.column, own, other);
  } while ((rows == 1 || NearBlockNext(l, b, &r)) && NearBlockNext(l, b, &r));
}

PetscErrorCode NearFieldApply(NearField f, PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  const Layout l = f->bodies->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(f->event[1], 0, 0, 0, 0));
  if (f->crossed)
    PetscCall(LayoutGather(l, 2, F, f->force));
  else
    PetscCall(PetscArraycpy(f->force + 2 * l->first, F, 2 * l->n));
  PetscCall(PetscArrayzero(f->velocity, 2 * l->n + LANES));
  for (PetscInt k = 0; k < f->blocks; k++) {
    const NearBlock *b = &f->block[k];
    if (b->single)
      ApplyBlock(f, b, PETSC_TRUE, f->store.single, alpha, f->force, f->velocity);
    else
      ApplyBlock(f, b, PETSC_FALSE, f->store.value, alpha, f->force, f->velocity);
  }
  PetscCall(NearDistantApply(f->fixed.distant, alpha, f->force, f->velocity));
  for (PetscInt k = 0; k < 2 * l->n; k++) U[k] += f->velocity[k];
  if (f->box) PetscCall(BoxPartApply(f->box, alpha, F, U));
  PetscCall(PetscLogEventEnd(f->event[1], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The place of row i and column j in a matrix between two ranges. */
static inline PetscInt Place(const MarkerRange *rows, const MarkerRange *columns, PetscInt i, PetscInt j) {
  return (j - 2 * columns->first) * 2 * rows->n + i - 2 * rows->first;
}

/* Whether a body is in a range, which is of whole bodies. */
static inline PetscBool Within(Layout l, PetscInt body, const MarkerRange *range) {
  return l->start[body] >= range->first && l->start[body] < range->first + range->n ? PETSC_TRUE : PETSC_FALSE;
}

/* out += scale times a block, in its own rows. */
static void AddBlock(NearField f, const NearBlock *b, PetscReal scale, const MarkerRange *rows,
                     const MarkerRange *columns, PetscReal out[]) {
  const Layout l = f->bodies->layout;
  const PetscBool both = b->column >= l->own && b->column < l->end ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool there = Within(l, b->row, rows) && Within(l, b->column, columns) ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool back = both && Within(l, b->column, rows) && Within(l, b->row, columns) ? PETSC_TRUE : PETSC_FALSE;
  NearRow r = NearBlockBegin(l, b);
  if (!there && !back) return;
  do
    for (PetscInt k = 0; k < 2 * r.count; k++)
      for (int c = 0; c < 2; c++) {
        const PetscReal value = scale * NearValue(f, b, r.at + c * r.stride + k);
        const PetscInt i = 2 * r.row + c, j = 2 * r.column + k;
        if (there) out[Place(rows, columns, i, j)] += value;
        if (back) out[Place(rows, columns, j, i)] += value;
      }
  while (NearBlockNext(l, b, &r));
}

/* The same of a distant pair, whose block is made for that. */
static PetscErrorCode AddDistant(NearField f, PetscInt pair, PetscReal scale, const MarkerRange *rows,
                                 const MarkerRange *columns, PetscReal out[]) {
  const Layout l = f->bodies->layout;
  const NearDistantPair *p = &f->fixed.distant->pair[pair];
  const NearBlock block = {.row = p->row, .column = p->column, .shift = {p->shift[0], p->shift[1]}};
  const NearStore kept = f->store;
  const NearRow r = NearBlockBegin(l, &block);
  PetscFunctionBeginUser;
  if (!(Within(l, p->row, rows) && Within(l, p->column, columns)) &&
      !(Within(l, p->row, columns) && Within(l, p->column, rows)))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * LayoutCount(l, p->row) * r.stride, &f->store.value));
  PetscCall(NearDistantExpand(f->fixed.distant, pair, r.stride, f->store.value));
  AddBlock(f, &block, scale, rows, columns, out);
  PetscCall(PetscFree(f->store.value));
  f->store = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first block, after the fixed ones, of the vesicle that a marker belongs to, or of a later one. */
static PetscInt FirstBlock(NearField f, PetscInt marker) {
  const PetscInt *start = f->bodies->layout->start;
  PetscInt low = f->fixed.blocks, high = f->blocks;
  while (low < high) {
    const PetscInt middle = (low + high) / 2;
    if (start[f->block[middle].row] < marker)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

PetscErrorCode NearFieldAddBetween(NearField f, PetscReal scale, PetscBool box, const MarkerRange *rows,
                                   const MarkerRange *columns, PetscReal out[]) {
  const Layout l = f->bodies->layout;
  const PetscInt from = PetscMin(rows->first, columns->first);
  const PetscInt to = PetscMax(rows->first + rows->n, columns->first + columns->n);
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < f->fixed.blocks; b++) AddBlock(f, &f->block[b], scale, rows, columns, out);
  for (PetscInt b = FirstBlock(f, from); b < f->blocks && l->start[f->block[b].row] < to; b++)
    AddBlock(f, &f->block[b], scale, rows, columns, out);
  for (PetscInt k = 0; k < f->fixed.distant->pairs; k++) PetscCall(AddDistant(f, k, scale, rows, columns, out));
  if (f->box && box) PetscCall(BoxPartAdd(f->box, scale, rows, columns, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldAdd(NearField f, PetscReal scale, PetscBool box, PetscInt first, PetscInt n, PetscReal out[]) {
  const MarkerRange range = {first, n};
  PetscFunctionBeginUser;
  PetscCall(NearFieldAddBetween(f, scale, box, &range, &range, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}
