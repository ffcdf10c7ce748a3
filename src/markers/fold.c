#include "markers/fold.h"

#define FOLD_ENTRIES 5 /* that a smooth fold goes to */

/* Take the first `cut` entries off. */
static void Cut(PetscInt cut, PetscInt *first, PetscInt *n, PetscReal w[]) {
  *n -= cut;
  for (PetscInt k = 0; k < *n; k++) w[k] = w[k + cut];
  *first += cut;
}

/* The polynomial through entries 0 to 4 at an entry below them: 5, -10, 10, -5 and 1 of them at entry -1. */
static void FoldSmoothly(PetscInt cut, PetscInt *first, PetscInt *n, PetscReal w[]) {
  PetscReal add[FOLD_ENTRIES] = {0};
  for (PetscInt k = 0; k < cut; k++)
    for (int j = 0; j < FOLD_ENTRIES; j++) {
      PetscReal value = w[k];
      for (int i = 0; i < FOLD_ENTRIES; i++)
        if (i != j) value *= (PetscReal)(*first + k - i) / (j - i);
      add[j] += value;
    }
  Cut(cut, first, n, w);
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
  Cut(cut, first, n, w);
}

/* Count the entries from the other end, `last` becoming 0. */
static void Reverse(PetscInt last, PetscInt *first, PetscInt n, PetscReal w[]) {
  *first = last - (*first + n - 1);
  for (PetscInt k = 0; k < n / 2; k++) {
    const PetscReal kept = w[k];
    w[k] = w[n - 1 - k];
    w[n - 1 - k] = kept;
  }
}

void FoldHigh(FoldKind kind, PetscInt last, PetscInt *first, PetscInt *n, PetscReal w[]) {
  if (*first + *n - 1 <= last) return;
  Reverse(last, first, *n, w);
  FoldLow(kind, first, n, w);
  Reverse(last, first, *n, w);
}

PetscReal WallScale(const Kernel *kernel, PetscReal y) {
  if (y >= FOLD_SCALED) return 1;
  const PetscReal t = PetscMax(0, y - (FOLD_SCALED - 1));
  const PetscReal moment = KernelSecondMoment(kernel->along) * (1 - t * t * (3 - 2 * t));
  return y * y / (y * y + moment);
}
