#include "precondition/coarsecorrection.h"
#include "base/lanes.h"
#include "layers/nearblock.h"

#define CELLS 4  /* of the coarse grid: reach */
#define ANGLES 8 /* in a quarter turn */

/* R by distance, from L of cells and viscosity 1: the mean over directions, fading smoothly in the last quarter. */
static void TabulateCorrection(CoarseCorrection s, const OffsetTable *L) {
  const LayerSetting cells = {.nu = 1, .unit = 1};
  for (PetscInt k = 0; k < CORRECTION_POINTS; k++) {
    const PetscReal r = CELLS * PetscMax((PetscReal)k, 0.5) / (CORRECTION_POINTS - 1),
                    x = PetscMax(0, 4 * r / CELLS - 3);
    const PetscReal fade = (1 - x) * (1 - x) * (1 + 2 * x) / s->mobility->fluid->nu;
    PetscReal S[3];
    StokesletOne(&cells, (PetscReal[]){r, 0}, 0, S);
    for (int q = 0; q < ANGLES; q++) {
      const PetscReal angle = 0.5 * PETSC_PI * (q + 0.5) / ANGLES, a = PetscCosReal(angle), b = PetscSinReal(angle);
      PetscReal m[3];
      MeanTableAt(L, (PetscReal[]){a * r, b * r}, m);
      S[0] -= (a * a * m[0] + b * b * m[1] + 2 * a * b * m[2]) / ANGLES;
      S[1] -= (b * b * m[0] + a * a * m[1] - 2 * a * b * m[2]) / ANGLES;
    }
    s->along[k] = fade * S[0];
    s->across[k] = fade * S[1];
  }
}

PetscErrorCode CoarseCorrectionCreate(Mobility mobility, CoarseGrid coarse, CoarseCorrection *out) {
  const PetscInt M = mobility->bodies->layout->M;
  CoarseCorrection s;
  OffsetTable L;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->mobility = mobility;
  s->reach = CELLS * coarse->fluid->grid->h;
  PetscCall(MeanTableCreate(&mobility->near->lattice, coarse->markers->kernel, &L));
  TabulateCorrection(s, &L);
  PetscCall(OffsetTableDestroy(&L));
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

/* The pairs of marker i with those of the block's column. */
static PetscErrorCode AddCorrectionRow(CoarseCorrection s, const NearBlock *b, PetscInt i) {
  const Layout l = s->mobility->bodies->layout;
  const NearBounds *column = &s->mobility->near->pairs->bounds[b->column];
  const PetscReal *X = s->mobility->markers->X, x[2] = {X[2 * i] - b->shift[0], X[2 * i + 1] - b->shift[1]};
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++)
    if (x[d] < column->low[d] - s->reach || x[d] > column->high[d] + s->reach) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayReserve((size_t)(s->pairs + LayoutCount(l, b->column)), &s->room, &s->pair));
  for (PetscInt j = l->start[b->column]; j < l->start[b->column + 1]; j++) {
    const PetscReal d[2] = {x[0] - X[2 * j], x[1] - X[2 * j + 1]}, r2 = d[0] * d[0] + d[1] * d[1];
    if (r2 >= s->reach * s->reach) continue;
    const PetscReal at = PetscSqrtReal(r2) / s->reach * (CORRECTION_POINTS - 1);
    const PetscInt k = PetscMin((PetscInt)at, CORRECTION_POINTS - 2);
    const PetscReal t = at - (PetscReal)k, across = (1 - t) * s->across[k] + t * s->across[k + 1],
                    along = (1 - t) * s->along[k] + t * s->along[k + 1], both = r2 > 0 ? (along - across) / r2 : 0;
    s->pair[s->pairs++] = (CorrectionPair){i, j, (float)(across + both * d[0] * d[0]), (float)(both * d[0] * d[1]),
                                           (float)(across + both * d[1] * d[1])};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a block joins a vesicle and another body. */
static PetscBool JoinsVesicle(CoarseCorrection s, const NearBlock *b) {
  return !NearBlockIsSelf(b) && PetscMin(b->row, b->column) < s->mobility->bodies->vesicles;
}

PetscErrorCode CoarseCorrectionPlace(CoarseCorrection s) {
  const NearList *list = &s->mobility->near->list;
  const PetscInt *start = s->mobility->bodies->layout->start;
  PetscFunctionBeginUser;
  s->pairs = 0;
  for (const NearBlock *b = list->block; b < list->block + list->count.blocks; b++)
    for (PetscInt i = start[b->row]; i < start[b->row + 1] && JoinsVesicle(s, b); i++)
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
    Lanes rx, ry, nx, ny, jx, jy, D[3];
    LanesPairs(X + 2 * at, &rx, &ry);
    LanesPairs(N + 2 * at, &nx, &ny);
    LanesPairs(s->jump + 2 * at, &jx, &jy);
    StressletFour(x[0] - rx, x[1] - ry, (const Lanes[2]){nx, ny}, D);
    sum[0] += LanesWhere(so, D[0] * jx + D[2] * jy);
    sum[1] += LanesWhere(so, D[2] * jx + D[1] * jy);
  }
  u[0] += LanesSum(sum[0]);
  u[1] += LanesSum(sum[1]);
}

/* U += D J of the body `column` at own markers of `row`; sign times shift moves the column. */
static void AddJumps(CoarseCorrection s, PetscInt row, PetscInt column, PetscReal sign, const PetscReal shift[2],
                     PetscScalar U[]) {
  const Layout l = s->mobility->bodies->layout;
  const PetscReal *X = s->mobility->markers->X;
  if (column >= s->mobility->bodies->vesicles || s->mobility->contrast->ratio[column] == 1) return;
  if (row < l->own || row >= l->end) return;
  for (PetscInt i = l->start[row]; i < l->start[row + 1]; i++) {
    const PetscReal x[2] = {X[2 * i] - sign * shift[0], X[2 * i + 1] - sign * shift[1]};
    AddJumpsAt(s, x, l->start[column], l->start[column + 1], U + 2 * (i - l->first));
  }
}

PetscErrorCode CoarseCorrectionApply(CoarseCorrection s, const PetscScalar F[], const PetscScalar J[],
                                     PetscScalar U[]) {
  const NearList *list = &s->mobility->near->list;
  const Layout l = s->mobility->bodies->layout;
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
    if (!JoinsVesicle(s, b)) continue;
    AddJumps(s, b->row, b->column, 1, b->shift, U);
    AddJumps(s, b->column, b->row, -1, b->shift, U);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
