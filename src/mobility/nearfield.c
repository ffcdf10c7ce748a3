#include "mobility/nearfield.h"
#include "base/agree.h"
#include "layers/latticegreen.h"
#include "layers/nearrows.h"

PetscErrorCode NearFieldCreate(Markers markers, Bodies bodies, PetscReal nu, NearField *out) {
  const Layout l = bodies->layout;
  const Grid g = markers->grid;
  NearField f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->set = (LayerSetting){.markers = markers, .bodies = bodies, .nu = nu, .unit = g->h};
  if (!g->free) PetscCall(LatticeStokeslet(BOX_LATTICE_CELLS + OFFSET_LAGS, &f->lattice));
  PetscCall(LayerPairsCreate(&stokeslet, &f->set, &f->lattice, NULL, NULL, NULL, &f->pairs));
  PetscCall(NearListCreate(f->pairs, &f->list));
  PetscCall(PetscCalloc2(2 * l->M + LANES, &f->force, 2 * l->n + LANES, &f->velocity)); /* whole vectors */
  PetscCall(PetvesEvent("NearField", &f->event[0]));
  PetscCall(PetvesEvent("NearFieldApply", &f->event[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldDestroy(NearField *near) {
  NearField f = *near;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NearListDestroy(&f->list));
  PetscCall(PetscFree(f->store.value));
  PetscCall(PetscFree(f->store.single));
  PetscCall(PetscFree2(f->force, f->velocity));
  PetscCall(LayerPairsDestroy(&f->pairs));
  PetscCall(OffsetTableDestroy(&f->lattice));
  PetscCall(BoxPartDestroy(&f->box));
  PetscCall(PetscFree(*near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldCreateBoxPart(NearField f, const FluidSpec *spec, PetscBool whole, BoxPart *box) {
  const BoxLattice lattice = {
      .unit = f->set.unit, .stokeslet = &f->lattice, .half = f->pairs->image->table, .whole = whole};
  PetscFunctionBeginUser;
  PetscCall(BoxPartCreate(spec, f->set.markers, &lattice, box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldAddBoxPart(NearField f, const FluidSpec *spec) {
  PetscFunctionBeginUser;
  PetscCall(NearFieldCreateBoxPart(f, spec, PETSC_FALSE, &f->box));
  f->set.box = f->box->axis;
  if (spec->inertia == INERTIA_NONE) MarkersLeaveUnscaled(f->set.markers);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A distant pair's block, in a store of its own. */
static NearBlock DistantBlock(NearField f, PetscInt pair) {
  const NearDistantPair *p = &f->list.distant->pair[pair];
  return (NearBlock){.row = p->row, .column = p->column, .shift = {p->shift[0], p->shift[1]}, .symmetric = PETSC_TRUE};
}

/* Distant pairs, once; crossed: with another rank's marker. */
static PetscErrorCode PlaceDistant(NearField f, PetscBool *crossed) {
  const Layout l = f->set.bodies->layout;
  NearDistant d = f->list.distant;
  NearStore store = {0};
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < d->pairs; k++)
    if (d->pair[k].column < l->own || d->pair[k].column >= l->end) *crossed = PETSC_TRUE;
  if (d->value || !d->pairs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NearDistantMake(d));
  for (PetscInt k = 0; k < d->pairs; k++) {
    const NearBlock block = DistantBlock(f, k);
    PetscCall(PetscMalloc1(NearBlockValues(l, &block), &store.value));
    PetscCall(NearBlockFill(f->pairs, &block, PETSC_FALSE, &store));
    PetscCall(NearDistantFill(d, k, NearStride(LayoutCount(l, block.column)), store.value));
    PetscCall(PetscFree(store.value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldPlace(NearField f) {
  const Layout l = f->set.bodies->layout;
  NearStore *s = &f->store;
  PetscBool crossed = PETSC_FALSE;
  PetscInt first;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(f->event[0], 0, 0, 0, 0));
  if (f->box) PetscCall(BoxPartPlace(f->box));
  PetscCall(LayerPairsPlace(f->pairs));
  PetscCall(NearListFind(&f->list, &first));
  PetscCall(ArrayReserve(f->list.count.values, &s->value_room, &s->value));
  PetscCall(ArrayReserve(f->list.count.singles, &s->single_room, &s->single));
  for (PetscInt k = 0; k < f->list.count.blocks; k++) {
    const NearBlock *b = &f->list.block[k];
    if (b->column < l->own || b->column >= l->end) crossed = PETSC_TRUE;
    if (k < first) continue;
    PetscCall(NearBlockFill(f->pairs, b, PETSC_FALSE, s));
  }
  for (PetscInt k = 0; k < f->list.count.closes; k++)
    if (f->list.close[k].block >= first)
      PetscCall(NearBlockRefine(f->pairs, &f->list.block[f->list.close[k].block], &f->list.close[k].fine, s));
  PetscCall(PlaceDistant(f, &crossed));
  PetscCall(AgreeFlag(l->comm, crossed, &f->crossed));
  PetscCall(PetscLogEventEnd(f->event[0], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldApply(NearField f, PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  const Layout l = f->set.bodies->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(f->event[1], 0, 0, 0, 0));
  if (f->crossed)
    PetscCall(LayoutGather(l, 2, F, f->force));
  else
    PetscCall(PetscArraycpy(f->force + 2 * l->first, F, 2 * l->n));
  PetscCall(PetscArrayzero(f->velocity, 2 * l->n + LANES));
  for (PetscInt k = 0; k < f->list.count.blocks; k++)
    NearBlockApply(l, &f->list.block[k], &f->store, alpha, f->force, f->velocity);
  PetscCall(NearDistantApply(f->list.distant, alpha, f->force, f->velocity));
  for (PetscInt k = 0; k < 2 * l->n; k++) U[k] += f->velocity[k];
  if (f->box) PetscCall(BoxPartApply(f->box, alpha, F, U));
  PetscCall(PetscLogEventEnd(f->event[1], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first block, after the fixed ones, of the vesicle that a marker belongs to, or of a later one. */
static PetscInt FirstBlock(NearField f, PetscInt marker) {
  const PetscInt *start = f->set.bodies->layout->start;
  PetscInt low = f->list.fixed.blocks, high = f->list.count.blocks;
  while (low < high) {
    const PetscInt middle = (low + high) / 2;
    if (start[f->list.block[middle].row] < marker)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

PetscErrorCode NearFieldAdd(NearField f, PetscReal scale, PetscBool box, const MarkerRange *rows,
                            const MarkerRange *columns, PetscReal out[]) {
  const Layout l = f->set.bodies->layout;
  const PetscInt from = PetscMin(rows->first, columns->first);
  const PetscInt to = PetscMax(rows->first + rows->n, columns->first + columns->n);
  NearStore store = {0};
  NearBlock block;
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < f->list.fixed.blocks; b++)
    NearBlockAdd(l, &f->list.block[b], &f->store, scale, rows, columns, out);
  for (PetscInt b = FirstBlock(f, from); b < f->list.count.blocks && l->start[f->list.block[b].row] < to; b++)
    NearBlockAdd(l, &f->list.block[b], &f->store, scale, rows, columns, out);
  for (PetscInt k = 0; k < f->list.distant->pairs; k++) { /* whose block is made for that */
    block = DistantBlock(f, k);
    if (!NearBlockMeets(l, &block, rows, columns)) continue;
    PetscCall(PetscMalloc1(NearBlockValues(l, &block), &store.value));
    PetscCall(NearDistantExpand(f->list.distant, k, NearStride(LayoutCount(l, block.column)), store.value));
    NearBlockAdd(l, &block, &store, scale, rows, columns, out);
    PetscCall(PetscFree(store.value));
  }
  if (f->box && box) PetscCall(BoxPartAdd(f->box, scale, rows, columns, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}
