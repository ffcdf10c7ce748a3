#include "precondition/coarsecorrection.h"
#include "base/lanes.h"
#include "layers/nearblock.h"

#define CELLS 4  /* of the coarse grid: reach */
#define PLACES 4 /* in a cell, in each direction */
#define ANGLES 8 /* in a quarter turn */

/* Stencils of both components of a marker at x, in cells of a lattice without ends. */
static void LatticeStencils(const Kernel *kernel, const PetscReal x[2], PaddedStencil padded[2]) {
  for (int c = 0; c < 2; c++) {
    Stencil s;
    for (int dir = 0; dir < 2; dir++) {
      const PetscBool along = c == dir ? PETSC_TRUE : PETSC_FALSE;
      s.n[dir] = (along ? kernel->along : kernel->across)(x[dir] - (along ? 1.0 : 0.5), &s.first[dir], s.weight[dir]);
    }
    StencilPad(&s, &padded[c]);
  }
}

/* Mean over places in a cell of what the lattice makes of a force along and across the distance r (cells) at an angle.
 */
static void LatticeMean(const OffsetTable *lattice, const Kernel *kernel, PetscReal r, PetscReal angle,
                        PetscReal mean[2]) {
  static const PetscInt none[2] = {0, 0};
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  mean[0] = mean[1] = 0;
  for (int q = 0; q < PLACES * PLACES; q++) {
    const PetscReal from[2] = {(q % PLACES + 0.5) / PLACES, ((PetscReal)(q / PLACES) + 0.5) / PLACES};
    const PetscReal to[2] = {from[0] + r * c, from[1] + r * s};
    PaddedStencil a[2], b[2];
    PetscReal L[4];
    LatticeStencils(kernel, to, a);
    LatticeStencils(kernel, from, b);
    StencilFourSums(lattice, a, b, none, L);
    mean[0] += (c * c * L[0] + s * s * L[1] + c * s * (L[2] + L[3])) / (PLACES * PLACES);
    mean[1] += (s * s * L[0] + c * c * L[1] - c * s * (L[2] + L[3])) / (PLACES * PLACES);
  }
}

/* R by distance: the mean over directions, fading smoothly in the last quarter. */
static void TabulateCorrection(CoarseCorrection s, const OffsetTable *lattice, const Kernel *kernel) {
  const LayerSetting cells = {.nu = 1, .unit = 1}; /* as the lattice's table */
  const PetscReal nu = s->mobility->fluid->nu;
  for (PetscInt k = 0; k < CORRECTION_POINTS; k++) {
    const PetscReal r = CELLS * PetscMax((PetscReal)k, 0.5) / (CORRECTION_POINTS - 1),
                    x = 4 * PetscMax(0, r / CELLS - 0.75);
    const PetscReal fade = (1 - x) * (1 - x) * (1 + 2 * x);
    PetscReal sum[2] = {0, 0}, S[3];
    StokesletOne(&cells, (PetscReal[]){r, 0}, 0, S);
    for (int a = 0; a < ANGLES; a++) {
      PetscReal mean[2];
      LatticeMean(lattice, kernel, r, 0.5 * PETSC_PI * (a + 0.5) / ANGLES, mean);
      for (int c = 0; c < 2; c++) sum[c] += mean[c] / ANGLES;
    }
    s->along[k] = fade * (S[0] - sum[0]) / nu;
    s->across[k] = fade * (S[1] - sum[1]) / nu;
  }
}

PetscErrorCode CoarseCorrectionCreate(Mobility mobility, CoarseGrid coarse, CoarseCorrection *out) {
  const PetscInt M = mobility->bodies->membrane->layout->M;
  CoarseCorrection s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->mobility = mobility;
  s->reach = CELLS * coarse->fluid->grid->h;
  TabulateCorrection(s, &mobility->near->lattice, coarse->markers->kernel);
  PetscCall(PetscCalloc2(2 * M, &s->force, 2 * M, &s->jump));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseCorrectionDestroy(CoarseCorrection *range) {
  PetscFunctionBeginUser;
  if (!*range) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*range)->pair));
  PetscCall(PetscFree2((*range)->force, (*range)->jump));
  PetscCall(PetscFree(*range));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pair of markers i and j, d apart. */
static CorrectionPair CorrectionOf(CoarseCorrection s, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal r2) {
  const PetscReal at = PetscSqrtReal(r2) / s->reach * (CORRECTION_POINTS - 1);
  const PetscInt k = PetscMin((PetscInt)at, CORRECTION_POINTS - 2);
  const PetscReal t = at - (PetscReal)k, across = (1 - t) * s->across[k] + t * s->across[k + 1],
                  along = (1 - t) * s->along[k] + t * s->along[k + 1], both = r2 > 0 ? (along - across) / r2 : 0;
  return (CorrectionPair){i, j, (float)(across + both * d[0] * d[0]), (float)(both * d[0] * d[1]),
                          (float)(across + both * d[1] * d[1])};
}

/* The pairs of marker i with those of the block's column. */
static PetscErrorCode AddCorrectionRow(CoarseCorrection s, const NearBlock *b, PetscInt i) {
  const Layout l = s->mobility->bodies->membrane->layout;
  const NearBounds *column = &s->mobility->near->pairs->bounds[b->column];
  const PetscReal *X = s->mobility->markers->X, x[2] = {X[2 * i] - b->shift[0], X[2 * i + 1] - b->shift[1]};
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++)
    if (x[d] < column->low[d] - s->reach || x[d] > column->high[d] + s->reach) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayReserve((size_t)(s->pairs + LayoutCount(l, b->column)), &s->room, &s->pair));
  for (PetscInt j = l->start[b->column]; j < l->start[b->column + 1]; j++) {
    const PetscReal d[2] = {x[0] - X[2 * j], x[1] - X[2 * j + 1]}, r2 = d[0] * d[0] + d[1] * d[1];
    if (r2 < s->reach * s->reach) s->pair[s->pairs++] = CorrectionOf(s, i, j, d, r2);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a block joins two vesicles. */
static PetscBool JoinsVesicles(CoarseCorrection s, const NearBlock *b) {
  return !NearBlockIsSelf(b) && PetscMax(b->row, b->column) < s->mobility->bodies->vesicles ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode CoarseCorrectionPlace(CoarseCorrection s) {
  const NearList *list = &s->mobility->near->list;
  const PetscInt *start = s->mobility->bodies->layout->start;
  PetscFunctionBeginUser;
  s->pairs = 0;
  for (const NearBlock *b = list->block; b < list->block + list->count.blocks; b++)
    for (PetscInt i = start[b->row]; i < start[b->row + 1] && JoinsVesicles(s, b); i++)
      PetscCall(AddCorrectionRow(s, b, i));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u -= R f of one marker. */
static inline void TakeCorrection(const CorrectionPair *p, const PetscScalar f[2], PetscScalar u[2]) {
  u[0] -= p->xx * f[0] + p->xy * f[1];
  u[1] -= p->xy * f[0] + p->yy * f[1];
}

/* u += D J at x of the markers first .. end - 1, of which the last four overlap others. */
static void AddJumpsAt(CoarseCorrection s, const PetscReal x[2], PetscInt first, PetscInt end, PetscScalar u[2]) {
  const PetscReal *X = s->mobility->markers->X, *N = s->mobility->contrast->normal;
  const Lanes order = {0, 1, 2, 3};
  Lanes sum[2] = {{0}, {0}};
  for (PetscInt k = first; k < end; k += LANES) {
    const PetscInt at = PetscMin(k, end - LANES);
    const LanesBits so = (LanesBits)(order >= (Lanes){0} + (PetscReal)(k - at));
    Lanes rx, ry, nx, ny, jx, jy;
    LanesPairs(X + 2 * at, &rx, &ry);
    LanesPairs(N + 2 * at, &nx, &ny);
    LanesPairs(s->jump + 2 * at, &jx, &jy);
    rx -= x[0];
    ry -= x[1];
    const Lanes r2 = rx * rx + ry * ry, q = LanesWhere(so, (rx * nx + ry * ny) * (rx * jx + ry * jy) / (r2 * r2));
    sum[0] += q * rx;
    sum[1] += q * ry;
  }
  u[0] -= LanesSum(sum[0]) / PETSC_PI;
  u[1] -= LanesSum(sum[1]) / PETSC_PI;
}

/* U += D J of the vesicle `column` at own markers of `row`; sign times shift moves the column. */
static void AddJumps(CoarseCorrection s, PetscInt row, PetscInt column, PetscReal sign, const PetscReal shift[2],
                     PetscScalar U[]) {
  const Layout l = s->mobility->bodies->layout;
  const PetscReal *X = s->mobility->markers->X;
  if (s->mobility->contrast->ratio[column] == 1 || row < l->own || row >= l->end) return;
  for (PetscInt i = l->start[row]; i < l->start[row + 1]; i++) {
    const PetscReal x[2] = {X[2 * i] - sign * shift[0], X[2 * i + 1] - sign * shift[1]};
    AddJumpsAt(s, x, l->start[column], l->start[column + 1], U + 2 * (i - l->first));
  }
}

PetscErrorCode CoarseCorrectionApply(CoarseCorrection s, const PetscScalar F[], const PetscScalar J[],
                                     PetscScalar U[]) {
  const NearList *list = &s->mobility->near->list;
  const Layout l = s->mobility->bodies->membrane->layout;
  const PetscInt first = l->first, end = l->first + l->n;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(l, 2, F, s->force));
  for (PetscInt k = 0; k < s->pairs; k++) {
    const CorrectionPair *p = &s->pair[k];
    TakeCorrection(p, s->force + 2 * p->j, U + 2 * (p->i - first));
    if (p->j >= first && p->j < end) TakeCorrection(p, s->force + 2 * p->i, U + 2 * (p->j - first));
  }
  if (!J) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayoutGather(l, 2, J, s->jump));
  for (const NearBlock *b = list->block; b < list->block + list->count.blocks; b++) {
    if (!JoinsVesicles(s, b)) continue;
    AddJumps(s, b->row, b->column, 1, b->shift, U);
    AddJumps(s, b->column, b->row, -1, b->shift, U);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
