#include "markers/wallfold.h"

#define FOLD_ENTRIES 5 /* entries that a smooth fold goes to */

/* Remove the first `cut` entries. */
static void FoldCut(PetscInt cut, PetscInt *first, PetscInt *n, PetscReal w[]) {
  *n -= cut;
  for (PetscInt k = 0; k < *n; k++) w[k] = w[k + cut];
  *first += cut;
}

/* Fold the first `cut` entries by the polynomial through entries 0 to 4, whose value at entry -1 is

     5 f_0 - 10 f_1 + 10 f_2 - 5 f_3 + f_4. */
static void FoldSmoothly(PetscInt cut, PetscInt *first, PetscInt *n, PetscReal w[]) {
  PetscReal add[FOLD_ENTRIES] = {0};
  for (PetscInt k = 0; k < cut; k++)
    for (int j = 0; j < FOLD_ENTRIES; j++) {
      PetscReal value = w[k];
      for (int i = 0; i < FOLD_ENTRIES; i++)
        if (i != j) value *= (PetscReal)(*first + k - i) / (j - i);
      add[j] += value;
    }
  FoldCut(cut, first, n, w);
  for (; *n < FOLD_ENTRIES; (*n)++) w[*n] = 0;
  for (int j = 0; j < FOLD_ENTRIES; j++) w[j] += add[j];
}

void FoldLow(FoldKind kind, PetscInt *first, PetscInt *n, PetscReal w[]) {
  const PetscInt cut = PetscMin(-*first, *n);
  if (cut <= 0) return;
  if (kind == FOLD_SMOOTH) {
    FoldSmoothly(cut, first, n, w);
    return;
  }
  for (PetscInt k = 0; k < cut; k++) {
    const PetscInt mirror = (kind == FOLD_EVEN ? -2 : -1) - (*first + k), to = mirror - *first;
    if (mirror >= 0 && to < *n) w[to] += kind == FOLD_EVEN ? w[k] : -w[k];
  }
  FoldCut(cut, first, n, w);
}

/* Reverse the order of entries, so that entry `last` becomes 0. */
static void FoldReverse(PetscInt last, PetscInt *first, PetscInt n, PetscReal w[]) {
  *first = last - (*first + n - 1);
  for (PetscInt k = 0; k < n / 2; k++) {
    const PetscReal kept = w[k];
    w[k] = w[n - 1 - k];
    w[n - 1 - k] = kept;
  }
}

void FoldHigh(FoldKind kind, PetscInt last, PetscInt *first, PetscInt *n, PetscReal w[]) {
  if (*first + *n - 1 <= last) return;
  FoldReverse(last, first, *n, w);
  FoldLow(kind, first, n, w);
  FoldReverse(last, first, *n, w);
}

PetscReal WallScale(const Kernel *kernel, PetscReal y) {
  if (y >= FOLD_SCALED) return 1;
  const PetscReal t = PetscMax(0, y - (FOLD_SCALED - 1));
  const PetscReal moment = KernelSecondMoment(kernel->along) * (1 - t * t * (3 - 2 * t));
  return y * y / (y * y + moment);
}
