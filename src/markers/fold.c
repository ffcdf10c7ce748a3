#include "markers/fold.h"

void FoldLow(PetscBool normal, PetscInt *first, PetscInt *n, PetscReal w[]) {
  const PetscInt cut = PetscMin(-*first, *n);
  if (cut <= 0) return;
  for (PetscInt k = 0; k < cut; k++) {
    const PetscInt mirror = (normal ? -2 : -1) - (*first + k), to = mirror - *first;
    if (mirror >= 0 && to < *n) w[to] += normal ? w[k] : -w[k];
  }
  *n -= cut;
  for (PetscInt k = 0; k < *n; k++) w[k] = w[k + cut];
  *first += cut;
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

void FoldHigh(PetscBool normal, PetscInt cells, PetscInt *first, PetscInt *n, PetscReal w[]) {
  const PetscInt last = normal ? cells - 2 : cells - 1;
  if (*first + *n - 1 <= last) return;
  Reverse(last, first, *n, w);
  FoldLow(normal, first, n, w);
  Reverse(last, first, *n, w);
}

PetscReal WallScale(const Kernel *kernel, PetscReal y) {
  if (y >= FOLD_SCALED) return 1;
  const PetscReal t = PetscMax(0, y - (FOLD_SCALED - 1));
  const PetscReal moment = KernelSecondMoment(kernel->along) * (1 - t * t * (3 - 2 * t));
  return y * y / (y * y + moment);
}
