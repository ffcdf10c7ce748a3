#include "coupling/boxregion.h"
#include "coupling/blas.h"

#define MARGIN 1.15   /* of a square's side over its markers' extent */
#define RATIO 1.26    /* of one side to the next */
#define CENTRES 8     /* in a side: what a centre is off by goes into the margin */
#define LARGEST 0.5   /* side, of the box's */
#define SMALLEST 1e-4 /* of the largest: eigenvalues below it are dropped */
#define OFF 0.01      /* of D's largest value; tables of cells h and h/2 differ by .02 to .07 */
#define CHECKS 3      /* points in a direction where a square is compared with the whole */

/* The square about the markers. */
static void Around(const BoxRegion *r, PetscInt M, const PetscReal X[], PetscReal centre[2], PetscReal *side) {
  PetscReal low[2] = {X[0], X[1]}, high[2] = {X[0], X[1]};
  for (PetscInt k = 1; k < M; k++)
    for (int d = 0; d < 2; d++) {
      low[d] = PetscMin(low[d], X[2 * k + d]);
      high[d] = PetscMax(high[d], X[2 * k + d]);
    }
  const PetscReal least = MARGIN * PetscMax(high[0] - low[0], high[1] - low[1]), h = r->grid->h;
  *side = h * PetscPowReal(RATIO, PetscCeilReal(PetscLogReal(PetscMax(least / h, 1)) / PetscLogReal(RATIO)));
  for (int d = 0; d < 2; d++) {
    const PetscReal spacing = *side / CENTRES, from = r->grid->lo[d];
    centre[d] = from + spacing * PetscFloorReal(0.5 + (0.5 * (low[d] + high[d]) - from) / spacing);
  }
}

/* Whether the whole table, which must reach all of the square, may be made smaller there. */
static PetscBool IsWithin(const BoxRegion *r, const PetscReal centre[2], PetscReal side) {
  for (int d = 0; d < 2; d++) {
    const BoxAxis *a = &r->whole->axis[d];
    if (side > LARGEST * (r->grid->hi[d] - r->grid->lo[d])) return PETSC_FALSE;
    if (a->wall && (centre[d] - 0.5 * side < a->low || centre[d] + 0.5 * side > a->high)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Rows [2][functions][rank of the whole] of the square's functions, from those of its places. */
static PetscErrorCode FunctionRows(const BoxRegion *r, const BoxTable *t, PetscReal A[]) {
  const PetscInt n = BOX_REGION_PLACES, rank = r->whole->rank;
  PetscReal *rows, value[2][BOX_REGION_PLACES];
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(A, 2 * n * n * rank));
  PetscCall(PetscMalloc1(2 * rank, &rows));
  for (PetscInt k = 0; k < n * n; k++) {
    const PetscReal X[2] = {t->axis[0].place[k / n], t->axis[1].place[k % n]};
    BoxTableRows(r->whole, X, 1, 0, 2, rows);
    for (int d = 0; d < 2; d++) BoxTableFunctions(t, d, X[d], value[d]);
    for (PetscInt f = 0; f < n * n; f++) {
      const PetscReal weight = value[0][f / n] * value[1][f % n];
      for (int c = 0; c < 2 && weight != 0; c++)
        for (PetscInt m = 0; m < rank; m++) A[(c * n * n + f) * rank + m] += weight * rows[c * rank + m];
    }
  }
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D = A l A^T between the square's functions, into Q of its one block. */
static PetscErrorCode BetweenFunctions(const BoxRegion *r, BoxTable *t) {
  const PetscInt size = 2 * t->functions[0] * t->functions[1], rank = r->whole->rank;
  PetscReal *A, *lA;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(size * rank, &A, size * rank, &lA));
  PetscCall(FunctionRows(r, t, A));
  for (PetscInt k = 0; k < size * rank; k++) lA[k] = r->whole->l[k % rank] * A[k];
  PetscCall(DenseProduct(PETSC_TRUE, size, size, rank, A, lA, t->block->Q));
  PetscCall(PetscFree2(A, lA));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest D_whole - D_square between CHECKS x CHECKS points of the square where interpolation is worst, over the
   largest D_whole. */
static PetscErrorCode OffBy(const BoxRegion *r, const BoxTable *t, PetscReal *off) {
  const PetscInt points = CHECKS * CHECKS;
  const BoxTable *of[2] = {r->whole, t};
  PetscReal *rows[2], most = 0, largest = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * points * of[0]->rank, &rows[0], 2 * points * of[1]->rank, &rows[1]));
  for (PetscInt k = 0; k < points; k++) {
    PetscReal X[2];
    for (int d = 0; d < 2; d++) {
      const PetscReal part = (PetscReal)(d ? k % CHECKS : k / CHECKS) / (CHECKS - 1);
      X[d] = t->axis[d].low + part * (t->axis[d].high - t->axis[d].low);
    }
    for (int q = 0; q < 2; q++) BoxTableRows(of[q], X, 1, 0, 2, rows[q] + 2 * k * of[q]->rank);
  }
  for (PetscInt i = 0; i < 2 * points; i++)
    for (PetscInt j = 0; j <= i; j++) {
      PetscReal D[2];
      for (int q = 0; q < 2; q++) {
        const PetscInt n = of[q]->rank;
        D[q] = BoxProduct(n, of[q]->l, rows[q] + i * n, rows[q] + j * n);
      }
      most = PetscMax(most, PetscAbsReal(D[0] - D[1]));
      largest = PetscMax(largest, PetscAbsReal(D[0]));
    }
  PetscCall(PetscFree2(rows[0], rows[1]));
  *off = most / largest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The square's axes about its centre. */
static void MakeAxes(const PetscReal centre[2], PetscReal side, BoxTable *t) {
  for (int d = 0; d < 2; d++)
    BoxAxisChebyshev(BOX_REGION_PLACES, centre[d] - 0.5 * side, centre[d] + 0.5 * side, &t->axis[d]);
}

/* The square's table. D depends on offsets along a period alone, so there it is made about the same place always. */
static PetscErrorCode MakeTable(const BoxRegion *r, BoxSquare *s) {
  const PetscInt n = BOX_REGION_PLACES;
  BoxTable *t = &s->table;
  PetscReal fixed[2], off = 0;
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) fixed[d] = r->whole->axis[d].wall ? s->centre[d] : r->grid->lo[d];
  *t = (BoxTable){.components = 2, .functions = {n, n}, .blocks = 1, .H = r->whole->H};
  MakeAxes(fixed, s->side, t);
  PetscCall(PetscCalloc1(1, &t->block));
  t->block->n[0] = t->block->n[1] = n;
  PetscCall(PetscMalloc1(PetscSqr(2 * n * n), &t->block->Q));
  PetscCall(BetweenFunctions(r, t));
  PetscCall(BoxTableDecompose(r->comm, SMALLEST, t));
  PetscCall(OffBy(r, t, &off));
  s->right = off < OFF && t->rank < r->whole->rank ? PETSC_TRUE : PETSC_FALSE;
  MakeAxes(s->centre, s->side, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the square is where it should be; along a period it goes there, and has moved. */
static PetscBool IsThere(const BoxRegion *r, const PetscReal centre[2], PetscReal side, BoxSquare *s,
                         PetscBool *moved) {
  if (s->side != side) return PETSC_FALSE;
  for (int d = 0; d < 2; d++)
    if (r->whole->axis[d].wall && s->centre[d] != centre[d]) return PETSC_FALSE;
  if (s->centre[0] == centre[0] && s->centre[1] == centre[1]) return PETSC_TRUE;
  *moved = PETSC_TRUE;
  for (int d = 0; d < 2; d++) s->centre[d] = centre[d];
  MakeAxes(centre, side, &s->table);
  return PETSC_TRUE;
}

/* The square that is there becomes the first; if it is new, in the place of the older one. */
static PetscErrorCode Take(BoxRegion *r, const PetscReal centre[2], PetscReal side, PetscBool *moved) {
  BoxSquare *s = r->square;
  PetscFunctionBeginUser;
  if (IsThere(r, centre, side, &s[0], moved)) PetscFunctionReturn(PETSC_SUCCESS);
  const BoxSquare other = s[1];
  *moved = PETSC_TRUE;
  s[1] = s[0];
  s[0] = other;
  if (IsThere(r, centre, side, &s[0], moved)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxTableDestroy(&s[0].table));
  s[0] = (BoxSquare){.centre = {centre[0], centre[1]}, .side = side};
  PetscCall(MakeTable(r, &s[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxRegionAt(BoxRegion *r, PetscInt M, const PetscReal X[], const BoxTable **table, PetscBool *moved) {
  const BoxTable *before = *table;
  PetscReal centre[2], side;
  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  *table = r->whole;
  if (M) {
    Around(r, M, X, centre, &side);
    if (IsWithin(r, centre, side)) {
      PetscCall(Take(r, centre, side, moved));
      if (r->square[0].right) *table = &r->square[0].table;
    }
  }
  if (*table != before) *moved = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxRegionDestroy(BoxRegion *r) {
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(BoxTableDestroy(&r->square[k].table));
  PetscFunctionReturn(PETSC_SUCCESS);
}
