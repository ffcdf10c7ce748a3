#include "layers/layerpairs.h"

PetscErrorCode LayerPairsCreate(const PairKernel *kernel, const LayerSetting *set, const OffsetTable *lattice,
                                const ImageTable *half, const PairSources *from, LayerPairs velocities,
                                LayerPairs *out) {
  const Layout l = set->markers->layout;
  LayerPairs f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->kernel = kernel;
  f->set = set;
  f->lattice = lattice;
  f->owner = velocities ? PETSC_FALSE : PETSC_TRUE;
  if (from) f->from = *from;
  if (f->owner)
    PetscCall(PetscMalloc2(2 * l->M, &f->stencil, l->bodies, &f->bounds));
  else {
    f->stencil = velocities->stencil;
    f->bounds = velocities->bounds;
  }
  if (!set->markers->grid->free)
    PetscCall(WallImageCreate(kernel, set, lattice, half, velocities ? velocities->image : NULL, &f->image));
  if (kernel->create) PetscCall(kernel->create(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayerPairsDestroy(LayerPairs *pairs) {
  LayerPairs f = *pairs;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < f->set->markers->layout->bodies && f->logarithm; v++) PetscCall(PetscFree(f->logarithm[v]));
  PetscCall(PetscFree(f->logarithm));
  if (f->owner) PetscCall(PetscFree2(f->stencil, f->bounds));
  for (int c = 0; c < 4; c++) PetscCall(PetscFree(f->fourth[c / 2][c % 2]));
  PetscCall(WallImageDestroy(&f->image));
  PetscCall(PetscFree(*pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayerPairsPlace(LayerPairs f) {
  const Markers m = f->set->markers;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->layout->bodies && f->owner; v++)
    f->bounds[v] = NearBoundsOf(LayoutCount(m->layout, v), m->X + 2 * m->layout->start[v]);
  for (PetscInt k = 0; k < m->layout->M && f->owner && !m->grid->free; k++) {
    for (int c = 0; c < 2; c++) StencilPad(&m->plain[2 * k + c], &f->stencil[2 * k + c]);
    StencilUnwrap(m->grid, m->X + 2 * k, &f->stencil[2 * k]);
  }
  if (f->kernel->place && !m->grid->free) f->kernel->place(f);
  if (f->image) PetscCall(WallImagePlace(f->image, f->stencil, f->from.stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void LayerPairLattice(LayerPairs f, PetscReal reach, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[]) {
  const PetscReal *X = f->set->markers->X, cell = 1 / f->set->markers->grid->h;
  const Lanes x = d[0] - (Lanes){0}, y = d[1] - (Lanes){0};
  Lanes K[PAIR_PARTS], C[PAIR_PARTS];
  PetscInt cells[2];
  for (int dir = 0; dir < 2; dir++) /* of the periods between image and marker */
    cells[dir] = (PetscInt)rint((d[dir] - (X[2 * i + dir] - X[2 * j + dir])) * cell);
  if (cell * cell * (d[0] * d[0] + d[1] * d[1]) <= reach * reach) {
    f->kernel->sums(f, i, j, cells, L);
    return;
  }
  f->kernel->parts(f->set, x, y, K);
  f->kernel->far(f, i, j, PETSC_FALSE, cell * x, cell * y, C);
  for (int q = 0; q < f->kernel->places.parts; q++) L[q] = K[q][0] - C[q][0];
}

PetscErrorCode LayerSelf(const PairKernel *kernel, const LayerSetting *set, Spectral spectral, PetscInt n,
                         const PetscReal X[], const PetscReal normal[], PetscReal K[]) {
  const CurveKind closed = {.type = CURVE_CLOSED};
  PetscReal *logarithm, *diagonal;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &logarithm, 3 * n, &diagonal));
  if (kernel->logarithm) kernel->logarithm(CURVE_CLOSED, n, logarithm);
  PetscCall(kernel->diagonal(set, &closed, spectral, n, X, logarithm, diagonal));
  for (PetscInt j = 0; j < n; j++) {
    const Lanes N[2] = {(normal ? normal[2 * j] : 0) - (Lanes){0}, (normal ? normal[2 * j + 1] : 0) - (Lanes){0}};
    for (PetscInt i = 0; i < n; i++) {
      PetscReal *at = K + 2 * j * 2 * n + 2 * i, pair[3];
      Lanes four[3];
      PairFree(kernel, set, X[2 * i] - X[2 * j] - (Lanes){0}, X[2 * i + 1] - X[2 * j + 1] - (Lanes){0}, N, four);
      for (int q = 0; q < 3; q++) {
        pair[q] = four[q][0] + (q < 2 ? logarithm[PetscAbsInt(i - j)] / set->nu : 0);
        if (i == j) pair[q] = diagonal[3 * i + q];
      }
      at[0] = pair[0];
      at[2 * n + 1] = pair[1];
      at[1] = at[2 * n] = pair[2];
    }
  }
  PetscCall(PetscFree2(logarithm, diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleGeometry(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal normal[],
                              PetscReal along[]) {
  PetscReal *T;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &T));
  SpectralDerivative(spectral, 1, 1, X, T);
  for (PetscInt k = 0; k < n; k++) {
    normal[2 * k] = T[2 * k + 1];
    normal[2 * k + 1] = -T[2 * k];
    along[k] = PetscHypotReal(T[2 * k], T[2 * k + 1]);
  }
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}
