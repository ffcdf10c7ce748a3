/* Only near pairs need finer points: chi(r) S is exchanged, chi a smooth window. */
#include "coupling/nearclose.h"
#include "coupling/finecurve.h"
#include "coupling/nearblock.h"

#define CLOSE 1.3    /* spacings: gaps below it need finer points */
#define FINE 2.5     /* fine points a gap */
#define MOST_FINE 64 /* times the markers */
#define PROBE 4      /* times the markers, for measuring the gap */
#define WINDOW 8     /* spacings */

/* chi times the Stokeslet from y to x: xx, yy, xy. */
static void Windowed(NearField f, PetscReal window, const PetscReal x[2], const PetscReal y[2], PetscReal S[3]) {
  const PetscReal d[2] = {x[0] - y[0], x[1] - y[1]}, r2 = d[0] * d[0] + d[1] * d[1];
  const PetscReal factor = FineWindow(PetscSqrtReal(r2), window) / (4 * PETSC_PI * f->nu);
  const PetscReal logarithm = -0.5 * PetscLogReal(r2 / PetscSqr(f->unit));
  S[0] = factor * (logarithm + d[0] * d[0] / r2);
  S[1] = factor * (logarithm + d[1] * d[1] / r2);
  S[2] = factor * d[0] * d[1] / r2;
}

/* The block of curves at `factor` times their markers, windowed, added with a sign. */
static PetscErrorCode AddAt(NearField f, const NearClose *close, PetscInt factor, PetscReal window, PetscReal sign) {
  const NearBlock *block = &f->block[close->block];
  const PetscReal none[2] = {0, 0};
  PetscReal *K[3], *part[3];
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(f, block->row, none, factor, &a));
  PetscCall(FineCurveCreate(f, block->column, close->shift, factor, &b));
  PetscCall(FineCurvePair(&a, &b, window));
  for (int c = 0; c < 3; c++) PetscCall(PetscMalloc2(a.count * b.count, &K[c], a.n * b.n, &part[c]));
  for (PetscInt q = 0; q < b.count; q++)
    for (PetscInt p = 0; p < a.count; p++) {
      PetscReal S[3];
      Windowed(f, window, a.x + 2 * a.used[p], b.x + 2 * b.used[q], S);
      for (int c = 0; c < 3; c++) K[c][q * a.count + p] = S[c];
    }
  for (int c = 0; c < 3; c++) PetscCall(FineCurveProject(&a, &b, K[c], part[c]));
  NearBlockAdd(f, block, sign, (PetscReal *[4]){part[0], part[1], part[2], part[2]});
  for (int c = 0; c < 3; c++) PetscCall(PetscFree2(K[c], part[c]));
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The larger spacing of two vesicles' markers. */
static PetscReal Spacing(NearField f, PetscInt v, PetscInt w) {
  return PetscMax(f->bodies->ds[v], f->bodies->ds[w]);
}

PetscErrorCode NearCloseGap(NearField f, PetscInt row, PetscInt column, const PetscReal shift[2], PetscReal *gap,
                            PetscBool *close) {
  const PetscReal ds = Spacing(f, row, column), none[2] = {0, 0};
  FineCurve a, b;
  PetscFunctionBeginUser;
  if (*gap <= (CLOSE + 1) * ds) { /* where markers are farther, so are the curves */
    PetscCall(FineCurveCreate(f, row, none, PROBE, &a));
    PetscCall(FineCurveCreate(f, column, shift, PROBE, &b));
    *gap = FineCurveGap(&a, &b);
    PetscCall(FineCurveDestroy(&a));
    PetscCall(FineCurveDestroy(&b));
  }
  *close = *gap <= CLOSE * ds ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void NearCloseFineness(NearField f, const NearClose *close, PetscInt *factor, PetscReal *window) {
  const NearBlock *block = &f->block[close->block];
  const PetscReal ds = Spacing(f, block->row, block->column);
  const PetscReal times = FINE * ds / PetscMax(close->gap, FINE * ds / MOST_FINE);
  *factor = (PetscInt)PetscMin(MOST_FINE, PetscCeilReal(times));
  *window = WINDOW * ds;
}

PetscErrorCode NearCloseAdd(NearField f, const NearClose *close) {
  PetscInt factor;
  PetscReal window;
  PetscFunctionBeginUser;
  NearCloseFineness(f, close, &factor, &window);
  PetscCall(AddAt(f, close, factor, window, 1));
  PetscCall(AddAt(f, close, 1, window, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}
