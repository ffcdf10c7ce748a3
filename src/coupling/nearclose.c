/* Only near pairs need finer points: chi(r) S is exchanged, chi a smooth window. */
#include "coupling/nearclose.h"
#include "coupling/finecurve.h"

#define CLOSE 1.3    /* spacings: gaps below it need finer points */
#define FINE 2.5     /* fine points a gap */
#define MOST_FINE 64 /* times the markers */
#define PROBE 4      /* times the markers, for measuring the gap */
#define WINDOW 8     /* spacings */

/* chi times the Stokeslet from y to x: xx, yy, xy. */
static void Windowed(PetscReal nu, PetscReal window, const PetscReal x[2], const PetscReal y[2], PetscReal S[3]) {
  const PetscReal d[2] = {x[0] - y[0], x[1] - y[1]}, r2 = d[0] * d[0] + d[1] * d[1];
  const PetscReal factor = FineWindow(PetscSqrtReal(r2), window) / (4 * PETSC_PI * nu);
  const PetscReal logarithm = -0.5 * PetscLogReal(r2);
  S[0] = factor * (logarithm + d[0] * d[0] / r2);
  S[1] = factor * (logarithm + d[1] * d[1] / r2);
  S[2] = factor * d[0] * d[1] / r2;
}

/* block += sign times part [columns][rows] of component c (0 xx, 1 yy, 2 xy and yx). */
static void AddComponent(const NearBlock *b, PetscInt rows, PetscInt columns, int c, PetscReal sign,
                         const PetscReal part[]) {
  const PetscInt place = c == 1 ? 2 * rows + 1 : (c == 2 ? 2 * rows : 0);
  for (PetscInt j = 0; j < columns; j++)
    for (PetscInt i = 0; i < rows; i++) {
      PetscReal *at = b->C + 2 * j * 2 * rows + 2 * i;
      at[place] += sign * part[j * rows + i];
      if (c == 2) at[1] += sign * part[j * rows + i];
    }
}

/* The block of curves at `factor` times their markers, windowed, added with a sign. */
static PetscErrorCode AddAt(NearField f, const NearBlock *block, PetscInt factor, PetscReal window, PetscReal sign) {
  const PetscReal none[2] = {0, 0};
  PetscReal *K[3], *part;
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(f, block->row, none, factor, &a));
  PetscCall(FineCurveCreate(f, block->column, block->shift, factor, &b));
  PetscCall(FineCurvePair(&a, &b, window));
  const PetscInt size = a.count * b.count;
  PetscCall(PetscMalloc4(size, &K[0], size, &K[1], size, &K[2], a.n * b.n, &part));
  for (PetscInt q = 0; q < b.count; q++)
    for (PetscInt p = 0; p < a.count; p++) {
      PetscReal S[3];
      Windowed(f->nu, window, a.x + 2 * a.used[p], b.x + 2 * b.used[q], S);
      for (int c = 0; c < 3; c++) K[c][q * a.count + p] = S[c];
    }
  for (int c = 0; c < 3; c++) {
    PetscCall(FineCurveProject(&a, &b, K[c], part));
    AddComponent(block, a.n, b.n, c, sign, part);
  }
  PetscCall(PetscFree4(K[0], K[1], K[2], part));
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Least distance of the block's curves at `factor` times their markers. */
static PetscErrorCode Gap(NearField f, const NearBlock *block, PetscInt factor, PetscReal *gap) {
  const PetscReal none[2] = {0, 0};
  FineCurve a, b;
  PetscFunctionBeginUser;
  PetscCall(FineCurveCreate(f, block->row, none, factor, &a));
  PetscCall(FineCurveCreate(f, block->column, block->shift, factor, &b));
  *gap = FineCurveGap(&a, &b);
  PetscCall(FineCurveDestroy(&a));
  PetscCall(FineCurveDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearBlockRefine(NearField f, const NearBlock *image) {
  const PetscReal ds = PetscMax(f->membrane->ds[image->row], f->membrane->ds[image->column]);
  PetscReal gap;
  PetscFunctionBeginUser;
  PetscCall(Gap(f, image, 1, &gap)); /* of markers: where it is wide, so is that of the curves */
  if (gap > (CLOSE + 1) * ds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Gap(f, image, PROBE, &gap));
  if (gap > CLOSE * ds) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt factor = (PetscInt)PetscMin(MOST_FINE,
                                             PetscCeilReal(FINE * ds / PetscMax(gap, FINE * ds / MOST_FINE)));
  PetscCall(AddAt(f, image, factor, WINDOW * ds, 1));
  PetscCall(AddAt(f, image, 1, WINDOW * ds, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}
