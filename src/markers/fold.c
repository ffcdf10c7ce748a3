#include "markers/fold.h"

/* Take the first `cut` entries off. */
static void Cut(PetscInt cut, PetscInt *first, PetscInt *n, PetscReal w[]) {
  *n -= cut;
  for (PetscInt k = 0; k < *n; k++) w[k] = w[k + cut];
  *first += cut;
}

/* The parabola through entries 0, 1 and 2 at an entry below them: 3, -3 and 1 of them at entry -1. */
static void FoldSmoothly(PetscInt cut, PetscInt *first, PetscInt *n, PetscReal w[]) {
  PetscReal add[3] = {0, 0, 0};
  for (PetscInt k = 0; k < cut; k++) {
    const PetscReal c = *first + k;
    add[0] += w[k] * (c - 1) * (c - 2) / 2;
    add[1] -= w[k] * c * (c - 2);
    add[2] += w[k] * c * (c - 1) / 2;
  }
  Cut(cut, first, n, w);
  for (; *n < 3; (*n)++) w[*n] = 0;
  for (int k = 0; k < 3; k++) w[k] += add[k];
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
