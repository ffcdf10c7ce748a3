#include "coupling/nearfield.h"
#include "base/agree.h"
#include "coupling/blas.h"
#include "coupling/nearblock.h"
#include "coupling/nearclose.h"

#define REACH 24      /* cells between vesicles up to which they have blocks */
#define MOST_IMAGES 9 /* of a vesicle around another */

/* Weights of ln(4 sin^2(t/2)) in Kress' quadrature on n points, by index difference. */
static void Kress(PetscInt n, PetscReal k[]) {
  for (PetscInt d = 0; d < n; d++) {
    k[d] = 0;
    for (PetscInt m = 1; m <= (n - 1) / 2; m++) k[d] -= 2 * PetscCosReal(2 * PETSC_PI * ((m * d) % n) / n) / m;
    if (n % 2 == 0) k[d] -= (d % 2 ? -2.0 : 2.0) / n;
  }
}

PetscErrorCode NearFieldCreate(Markers markers, Membrane m, PetscReal nu, NearField *out) {
  const Layout l = m->layout;
  NearField f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->markers = markers;
  f->membrane = m;
  f->nu = nu;
  f->free = markers->grid->free;
  if (!f->free) PetscCall(LatticeStokeslet(NEAR_CELLS + OFFSET_LAGS, &f->lattice));
  if (!f->free) PetscCall(NearImageCreate(markers, nu, &f->lattice, &f->image));
  NearFarCoefficients(markers->kernel, f->far);
  PetscCall(PetscCalloc1(l->bodies, &f->kress));
  for (PetscInt v = l->own; v < l->end; v++) {
    PetscCall(PetscMalloc1(LayoutCount(l, v), &f->kress[v]));
    Kress(LayoutCount(l, v), f->kress[v]);
  }
  PetscCall(PetscMalloc2(2 * l->M, &f->stencil, 2 * l->M, &f->force));
  PetscCall(PetvesEvent("NearField", &f->event));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeBlocks(NearField f) {
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < f->count; b++) PetscCall(PetscFree(f->block[b].C));
  f->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldDestroy(NearField *near) {
  NearField f = *near;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeBlocks(f));
  PetscCall(PetscFree(f->block));
  for (PetscInt v = 0; v < f->membrane->layout->bodies; v++) PetscCall(PetscFree(f->kress[v]));
  PetscCall(PetscFree(f->kress));
  PetscCall(PetscFree2(f->stencil, f->force));
  PetscCall(NearImageDestroy(&f->image));
  PetscCall(OffsetTableDestroy(&f->lattice));
  PetscCall(BoxPartDestroy(&f->box));
  PetscCall(PetscFree(*near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldAddBoxPart(NearField f, const FluidSpec *spec) {
  PetscFunctionBeginUser;
  PetscCall(BoxPartCreate(spec, f->markers, &f->box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A block between own vesicle v and the image of w moved by shift, and its matrix. */
static PetscErrorCode AddBlock(NearField f, PetscInt v, PetscInt w, const PetscReal shift[2]) {
  const Layout l = f->membrane->layout;
  NearBlock *b;
  PetscFunctionBeginUser;
  if (f->count == f->room) {
    PetscInt room = PetscMax(8, 2 * f->room);
    NearBlock *more;
    PetscCall(PetscCalloc1(room, &more));
    if (f->count) PetscCall(PetscArraycpy(more, f->block, f->count));
    PetscCall(PetscFree(f->block));
    f->block = more;
    f->room = room;
  }
  b = &f->block[f->count++];
  *b = (NearBlock){.row = v, .column = w, .shift = {shift[0], shift[1]}};
  PetscCall(PetscMalloc1(4 * LayoutCount(l, v) * LayoutCount(l, w), &b->C));
  PetscCall(NearBlockFill(f, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the image of w moved by shift is v itself. */
static PetscBool IsSelf(PetscInt v, PetscInt w, const PetscReal shift[2]) {
  return v == w && shift[0] == 0 && shift[1] == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Square of the least distance (length^2) between markers of v and of w moved by shift. */
static PetscReal Apart(NearField f, PetscInt v, PetscInt w, const PetscReal shift[2]) {
  const Layout l = f->membrane->layout;
  const PetscReal *X = f->markers->X;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt i = l->start[v]; i < l->start[v + 1]; i++)
    for (PetscInt j = l->start[w]; j < l->start[w + 1]; j++) {
      const PetscReal dx = X[2 * i] - X[2 * j] - shift[0], dy = X[2 * i + 1] - X[2 * j + 1] - shift[1];
      least = PetscMin(least, dx * dx + dy * dy);
    }
  return least;
}

/* Shifts of w's images within REACH cells of v, in unbounded fluid at any distance, of the one whose first marker is
   nearest and its neighbours: the nearest first. */
static PetscInt Images(NearField f, PetscInt v, PetscInt w, PetscReal image[MOST_IMAGES][2]) {
  const Grid g = f->markers->grid;
  const Layout l = f->membrane->layout;
  const PetscReal *X = f->markers->X, reach = f->free ? PETSC_MAX_REAL : PetscSqr(REACH * g->h);
  PetscInt around[2], count = 0;
  PetscReal middle[2], box[2], least = reach;
  for (int d = 0; d < 2; d++) {
    box[d] = g->hi[d] - g->lo[d];
    around[d] = g->wall[d] ? 0 : 1;
    middle[d] = around[d] * PetscFloorReal((X[2 * l->start[v] + d] - X[2 * l->start[w] + d]) / box[d] + 0.5);
  }
  for (PetscInt q = -around[1]; q <= around[1]; q++)
    for (PetscInt p = -around[0]; p <= around[0]; p++) {
      const PetscReal shift[2] = {(middle[0] + p) * box[0], (middle[1] + q) * box[1]};
      const PetscReal apart = IsSelf(v, w, shift) ? 0 : Apart(f, v, w, shift);
      if (apart >= reach) continue;
      const PetscInt at = apart < least ? 0 : count;
      for (int d = 0; d < 2; d++) {
        if (at < count) image[count][d] = image[at][d];
        image[at][d] = shift[d];
      }
      least = PetscMin(least, apart);
      count++;
    }
  return count;
}

/* A block for each image; with a box part one, of the images nearest to each marker, named after the nearest, in which
   all close images are refined. */
static PetscErrorCode AddPair(NearField f, PetscInt v, PetscInt w) {
  PetscReal image[MOST_IMAGES][2];
  PetscFunctionBeginUser;
  const PetscInt count = Images(f, v, w, image);
  for (PetscInt k = 0; k < count; k++) {
    if (!f->box || !k) PetscCall(AddBlock(f, v, w, image[k]));
    const NearBlock at = {.row = v, .column = w, .shift = {image[k][0], image[k][1]}, .C = f->block[f->count - 1].C};
    if (!IsSelf(v, w, image[k])) PetscCall(NearBlockRefine(f, &at));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldPlace(NearField f) {
  const Layout l = f->membrane->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(f->event, 0, 0, 0, 0));
  PetscCall(FreeBlocks(f));
  for (PetscInt k = 0; k < 2 * l->M && !f->free; k++) StencilPad(&f->markers->plain[k], &f->stencil[k]);
  if (f->image) PetscCall(NearImagePlace(f->image, f->stencil));
  for (PetscInt v = l->own; v < l->end; v++)
    for (PetscInt w = 0; w < l->bodies; w++) PetscCall(AddPair(f, v, w));
  if (f->box) BoxPartPlace(f->box);
  PetscCall(AgreeFlag(l->comm, f->count > l->end - l->own ? PETSC_TRUE : PETSC_FALSE, &f->crossed));
  PetscCall(PetscLogEventEnd(f->event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearFieldApply(NearField f, PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  const Layout l = f->membrane->layout;
  PetscFunctionBeginUser;
  if (f->crossed)
    PetscCall(LayoutGather(l, 2, F, f->force));
  else
    PetscCall(PetscArraycpy(f->force + 2 * l->first, F, 2 * l->n));
  for (PetscInt k = 0; k < f->count; k++) {
    const NearBlock *b = &f->block[k];
    PetscCall(DenseMultAdd(2 * LayoutCount(l, b->row), 2 * LayoutCount(l, b->column), alpha, b->C,
                           f->force + 2 * l->start[b->column], U + 2 * LayoutOffset(l, b->row)));
  }
  if (f->box) PetscCall(BoxPartApply(f->box, alpha, F, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}
