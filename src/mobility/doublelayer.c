#include "mobility/doublelayer.h"
#include "layers/latticegreen.h"
#include "layers/nearrows.h"

PetscErrorCode DoubleLayerCreate(NearField near, const PetscReal ratio[], DoubleLayer *out) {
  const Layout l = near->set.bodies->layout;
  DoubleLayer s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->near = near;
  PetscCall(PetscMalloc2(l->bodies, &s->ratio, l->bodies, &s->length));
  for (PetscInt v = 0; v < l->bodies; v++) s->ratio[v] = v < near->set.bodies->vesicles ? ratio[v] : 1;
  PetscCall(PetscMalloc2(2 * l->M, &s->normal, l->M, &s->along));
  PetscCall(PetscCalloc3(2 * l->M, &s->jump, 2 * l->M, &s->plain, DIPOLE_COUNT * l->M, &s->tensor));
  PetscCall(PetscCalloc1(2 * l->n + LANES, &s->velocity)); /* whole vectors */
  PetscCall(PetscMalloc1(DIPOLE_COUNT * l->M, &s->dipole));
  if (!near->set.markers->grid->free) {
    PetscCall(PetscCalloc1(DIPOLE_SPOTS * l->M, &s->spot));
    PetscCall(DipoleListCreate(near->set.markers->grid, &s->list));
    PetscCall(LatticeDipoles(BOX_LATTICE_CELLS + OFFSET_LAGS, s->lattice));
  }
  const PairSources from = {.stencil = s->dipole, .normal = s->normal, .along = s->along, .length = s->length};
  PetscCall(LayerPairsCreate(&stresslet, &near->set, s->lattice, NULL, &from, near->pairs, &s->pairs));
  PetscCall(PetvesEvent("DoubleLayer", &s->place));
  PetscCall(PetvesEvent("DoubleLayerApply", &s->apply));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerDestroy(DoubleLayer *layer) {
  DoubleLayer s = *layer;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(s->ratio, s->length));
  PetscCall(PetscFree2(s->normal, s->along));
  PetscCall(PetscFree(s->dipole));
  PetscCall(PetscFree(s->spot));
  PetscCall(StencilRowsDestroy(&s->list));
  PetscCall(PetscFree3(s->jump, s->plain, s->tensor));
  for (int c = 0; c < 2; c++) PetscCall(OffsetTableDestroy(&s->lattice[c]));
  PetscCall(LayerPairsDestroy(&s->pairs));
  PetscCall(BoxPartDestroy(&s->box));
  PetscCall(PetscFree(s->block));
  PetscCall(PetscFree(s->store.value));
  PetscCall(PetscFree(s->velocity));
  PetscCall(PetscFree(*layer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerAddBoxPart(DoubleLayer s, const FluidSpec *spec) {
  const BoxLattice lattice = {.unit = s->near->set.unit, .dipole = s->lattice};
  PetscFunctionBeginUser;
  PetscCall(BoxPartCreate(spec, s->near->set.markers, &lattice, &s->box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normals and dipoles' stencils of the vesicles that have a jump. */
static PetscErrorCode DoubleLayerPlaceSources(DoubleLayer s) {
  const Bodies m = s->near->set.bodies;
  const Markers markers = s->near->set.markers;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt first = l->start[v];
    if (s->ratio[v] == 1) continue;
    PetscCall(DoubleGeometry(m->spectral[v], LayoutCount(l, v), markers->X + 2 * first, s->normal + 2 * first,
                             s->along + first));
    s->length[v] = 0;
    for (PetscInt k = first; k < l->start[v + 1]; k++) {
      Stencil part[DIPOLE_COUNT];
      s->length[v] += s->along[k];
      if (markers->grid->free) continue;
      DipoleStencilsUnwrapped(markers->grid, markers->X + 2 * k, part);
      for (int c = 0; c < DIPOLE_COUNT; c++) StencilPad(&part[c], &s->dipole[DIPOLE_COUNT * k + c]);
      DipoleSpotsOf(markers->grid, s->near->set.nu, part, s->spot + DIPOLE_SPOTS * k);
    }
  }
  if (!markers->grid->free) PetscCall(StencilRowsPlace(s->list, l->M, s->spot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block of the jump of `row` to the velocity of own markers of `column`. */
static PetscErrorCode DoubleLayerAddBlock(DoubleLayer s, PetscInt row, PetscInt column, PetscReal sign,
                                          const PetscReal shift[2]) {
  const Layout l = s->near->set.bodies->layout;
  NearBlock *b;
  PetscFunctionBeginUser;
  if (s->ratio[row] == 1 || column < l->own || column >= l->end) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayReserve((size_t)s->blocks + 1, &s->block_room, &s->block));
  b = &s->block[s->blocks++];
  *b = (NearBlock){.row = row, .column = column, .shift = {sign * shift[0], sign * shift[1]}, .at = s->values};
  s->values += NearBlockValues(l, b);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The near field's pairs, each both ways. */
static PetscErrorCode FindBlocks(DoubleLayer s) {
  const NearField f = s->near;
  PetscFunctionBeginUser;
  s->blocks = 0;
  s->values = 0;
  for (PetscInt k = 0; k < f->list.count.blocks; k++) {
    const NearBlock *b = &f->list.block[k];
    PetscCall(DoubleLayerAddBlock(s, b->column, b->row, -1, b->shift));
    if (!NearBlockIsSelf(b)) PetscCall(DoubleLayerAddBlock(s, b->row, b->column, 1, b->shift));
  }
  PetscCall(ArrayReserve(s->values, &s->store.value_room, &s->store.value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A block's values; or, without lattice, those of D alone. */
static PetscErrorCode FillBlock(DoubleLayer s, const NearBlock *b, PetscBool lattice, NearStore *store) {
  const NearField f = s->near;
  PetscFunctionBeginUser;
  PetscCall(NearBlockFill(s->pairs, b, lattice ? PETSC_FALSE : PETSC_TRUE, store));
  for (PetscInt k = 0; k < f->list.count.closes; k++) { /* those in this block; with a box part all images share one */
    const FinePair *p = &f->list.close[k].fine;
    for (int turned = 0; turned < 2; turned++) {
      FinePair fine = *p;
      if (turned) {
        fine.row = p->column;
        fine.column = p->row;
        for (int d = 0; d < 2; d++) fine.shift[d] = -p->shift[d];
      }
      if (b->column != fine.row || b->row != fine.column) continue;
      if (!f->box && (b->shift[0] != -fine.shift[0] || b->shift[1] != -fine.shift[1])) continue;
      PetscCall(NearBlockRefine(s->pairs, b, &fine, store));
      break;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerPlace(DoubleLayer s) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(s->place, 0, 0, 0, 0));
  PetscCall(DoubleLayerPlaceSources(s));
  if (s->box) PetscCall(BoxPartPlace(s->box));
  PetscCall(LayerPairsPlace(s->pairs));
  PetscCall(FindBlocks(s));
  for (PetscInt k = 0; k < s->blocks; k++) PetscCall(FillBlock(s, &s->block[k], PETSC_TRUE, &s->store));
  PetscCall(PetscLogEventEnd(s->place, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The jump of markers that move with U, and tensors of its dipoles, less its flux; zero where there is no jump, as for
   a ratio of 1, which has no normals. */
static PetscErrorCode DoubleLayerSetDipoles(DoubleLayer s, Vec U) {
  const Layout l = s->near->set.bodies->membrane->layout; /* obstacles, whose J is zero, come behind */
  PetscFunctionBeginUser;
  PetscCall(LayoutGatherVec(l, U, s->plain));
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt first = 2 * l->start[v], end = 2 * l->start[v + 1];
    PetscReal flux = 0;
    for (PetscInt k = first; k < end; k++) s->jump[k] = s->plain[k] *= 1 - s->ratio[v];
    for (PetscInt k = first; k < end && s->ratio[v] != 1; k++) flux += s->normal[k] * s->plain[k];
    for (PetscInt k = first; k < end && s->ratio[v] != 1; k++)
      s->jump[k] -= flux / s->length[v] * s->normal[k] / s->along[k / 2];
  }
  for (PetscInt k = 0; k < s->near->set.bodies->layout->M; k++) {
    const PetscReal *J = s->jump + 2 * k, *N = s->normal + 2 * k;
    const PetscBool none = J[0] == 0 && J[1] == 0;
    PetscReal *T = s->tensor + DIPOLE_COUNT * k;
    T[DIPOLE_XX] = none ? 0 : 2 * J[0] * N[0];
    T[DIPOLE_YY] = none ? 0 : 2 * J[1] * N[1];
    T[DIPOLE_XY] = none ? 0 : J[0] * N[1] + J[1] * N[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean += that of the dipoles that have been set. */
static void DoubleLayerAddMean(DoubleLayer s, PetscReal mean[2]) {
  const NearField f = s->near;
  const Grid g = f->set.markers->grid;
  const PetscReal area = (g->hi[0] - g->lo[0]) * (g->hi[1] - g->lo[1]);
  for (PetscInt k = 0; k < 2 * f->set.bodies->layout->M; k++) {
    const PetscReal *T = s->tensor + DIPOLE_COUNT * (k / 2);
    mean[k % 2] -= f->set.markers->X[k] * 0.5 * (T[DIPOLE_XX] + T[DIPOLE_YY]) / area;
  }
}

PetscErrorCode DoubleLayerApply(DoubleLayer s, PetscReal alpha, Vec U, PetscScalar y[]) {
  const Layout l = s->near->set.bodies->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(s->apply, 0, 0, 0, 0));
  PetscCall(DoubleLayerSetDipoles(s, U));
  PetscCall(PetscArrayzero(s->velocity, 2 * l->n + LANES));
  for (PetscInt k = 0; k < s->blocks; k++) NearBlockApply(l, &s->block[k], &s->store, alpha, s->plain, s->velocity);
  for (PetscInt k = 0; k < 2 * l->n; k++) y[k] += s->velocity[k];
  if (s->box) PetscCall(BoxPartApply(s->box, alpha, s->tensor + DIPOLE_COUNT * l->first, y));
  PetscCall(PetscLogEventEnd(s->apply, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerMean(DoubleLayer s, Vec U, PetscReal mean[2]) {
  PetscFunctionBeginUser;
  PetscCall(DoubleLayerSetDipoles(s, U));
  DoubleLayerAddMean(s, mean);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerSpread(DoubleLayer s, Vec U, Forcing *f) {
  PetscFunctionBeginUser;
  if (s->near->set.markers->grid->free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DoubleLayerSetDipoles(s, U));
  DoubleLayerAddMean(s, f->mean);
  ForcingNote(f, &s->near->set.markers->window);
  PetscCall(DipoleListSpread(s->list, s->tensor, f->values, f->source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerRows(DoubleLayer s, Vec U, PetscBool own, const PetscReal profile[], DipoleRows rows) {
  PetscReal mean[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(DoubleLayerSetDipoles(s, U));
  DoubleLayerAddMean(s, mean);
  PetscCall(DipoleRowsSet(rows, s->list, s->tensor, own, profile, mean));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerStress(DoubleLayer s, Vec U, PetscReal sum[3], PetscReal shortfall[2]) {
  const Markers m = s->near->set.markers;
  PetscFunctionBeginUser;
  PetscCall(DoubleLayerSetDipoles(s, U));
  for (PetscInt k = 0; k < s->near->set.bodies->layout->M; k++) {
    const PetscReal *T = s->tensor + DIPOLE_COUNT * k;
    PetscReal part[2];
    DipoleShortfall(m->grid, s->near->set.nu, m->X + 2 * k, T, 1, part);
    for (int q = 0; q < 3; q++) sum[q] += s->near->set.nu * T[q];
    for (int c = 0; c < 2; c++) shortfall[c] += part[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleLayerAdd(DoubleLayer s, PetscReal scale, PetscBool lattice, PetscInt first, PetscInt n,
                              PetscReal out[]) {
  const Layout l = s->near->set.bodies->layout;
  const MarkerRange range = {first, n};
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->blocks; k++) {
    NearBlock b = s->block[k];
    NearStore store = s->store, free = {0};
    if (!NearBlockMeets(l, &b, &range, &range)) continue;
    if (!lattice && !s->near->set.markers->grid->free) {
      b.at = 0;
      PetscCall(PetscMalloc1(NearBlockValues(l, &b), &free.value));
      PetscCall(FillBlock(s, &b, PETSC_FALSE, &free));
      store = free;
    }
    NearBlockAdd(l, &b, &store, scale * (1 - s->ratio[b.row]), &range, &range, out);
    PetscCall(PetscFree(free.value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
