#include "problem/contrast.h"

PetscErrorCode ContrastTread(Membrane m, PetscInt vesicle, PetscInt end, const PetscReal treading[], PetscReal a0,
                             PetscInt columns, PetscReal out[]) {
  const PetscInt first = m->layout->start[vesicle], n = 2 * (m->layout->start[end] - first);
  PetscReal *x;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &x));
  for (PetscInt r = 0; r < columns; r++) {
    PetscCall(PetscArraycpy(x, out + r * n, n));
    for (PetscInt v = vesicle; v < end; v++) {
      const PetscInt at = 2 * (m->layout->start[v] - first);
      if (treading[v - vesicle] != 0)
        MembraneLabelDerivative(m, v, -treading[v - vesicle] / a0, x + at, out + r * n + at);
    }
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContrastMatrix(Coupling c, PetscBool lattice, PetscInt first, PetscInt n, PetscReal out[]) {
  const Layout l = c->membrane->layout;
  const PetscInt begin = LayoutBody(l, first), end = LayoutBody(l, first + n - 1) + 1;
  PetscFunctionBeginUser;
  if (c->mobility->contrast) PetscCall(DoubleLayerAdd(c->mobility->contrast, -1, lattice, first, n, out));
  for (PetscInt v = PetscMax(begin, l->own); v < PetscMin(end, l->end); v++)
    for (PetscInt k = 2 * (l->start[v] - first); k < 2 * (l->start[v + 1] - first); k++)
      out[k * 2 * n + k] += MobilityWeight(c->mobility, v);
  for (PetscInt j = 0; j < 2 * n; j++) /* transposed */
    for (PetscInt i = 0; i < j; i++) {
      const PetscReal kept = out[j * 2 * n + i];
      out[j * 2 * n + i] = out[i * 2 * n + j];
      out[i * 2 * n + j] = kept;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
