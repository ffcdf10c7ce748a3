#include "mobility/contrast.h"

/* y += alpha (1 + ratio)/2 U */
static void ContrastAddMean(Coupling c, PetscReal alpha, const PetscScalar U[], PetscScalar y[]) {
  const Layout l = c->membrane->layout;
  for (PetscInt v = l->own; v < l->end; v++)
    for (PetscInt k = 2 * LayoutOffset(l, v); k < 2 * (LayoutOffset(l, v) + LayoutCount(l, v)); k++)
      y[k] += alpha * 0.5 * (1 + c->contrast->ratio[v]) * U[k];
}

PetscErrorCode ContrastKnown(Coupling c, Vec background, Vec Y, Vec moved, Vec k) {
  const PetscScalar *U;
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(background, moved));
  PetscCall(CouplingTread(c, 1, Y, moved));
  PetscCall(VecGetArray(k, &y));
  PetscCall(VecGetArrayRead(background, &U));
  for (PetscInt q = 0; q < 2 * c->membrane->layout->n; q++) y[q] += U[q];
  PetscCall(VecRestoreArrayRead(background, &U));
  PetscCall(VecRestoreArray(k, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContrastMotion(Coupling c, const PetscScalar V[], const PetscScalar known[], PetscScalar G[]) {
  const PetscInt n = 2 * c->membrane->layout->n;
  for (PetscInt k = 0; k < n; k++) G[k] = V[k];
  MembraneTread(c->membrane, c->treading, 1 / c->fluid->a0, V, G);
  for (PetscInt k = 0; k < n && known; k++) G[k] += known[k];
}

PetscErrorCode ContrastAdd(Coupling c, PetscReal alpha, Vec motion, PetscScalar y[]) {
  const PetscScalar *G;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(motion, &G));
  ContrastAddMean(c, alpha, G, y);
  PetscCall(DoubleLayerApply(c->contrast, -alpha, G, y));
  PetscCall(VecRestoreArrayRead(motion, &G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContrastSpread(Coupling c, Vec motion, Forcing *f) {
  const PetscScalar *G;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(motion, &G));
  PetscCall(DoubleLayerSpread(c->contrast, G, f));
  PetscCall(VecRestoreArrayRead(motion, &G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

PetscErrorCode ContrastMatrix(Coupling c, PetscBool lattice, PetscReal a0, PetscInt first, PetscInt n,
                              PetscReal out[]) {
  const Layout l = c->membrane->layout;
  const PetscInt begin = LayoutBody(l, first), end = LayoutBody(l, first + n - 1) + 1;
  PetscFunctionBeginUser;
  PetscCall(DoubleLayerAdd(c->contrast, -1, lattice, first, n, out));
  for (PetscInt v = PetscMax(begin, l->own); v < PetscMin(end, l->end); v++)
    for (PetscInt k = 2 * (l->start[v] - first); k < 2 * (l->start[v + 1] - first); k++)
      out[k * 2 * n + k] += 0.5 * (1 + c->contrast->ratio[v]);
  for (PetscInt j = 0; j < 2 * n; j++) /* transposed */
    for (PetscInt i = 0; i < j; i++) {
      const PetscReal kept = out[j * 2 * n + i];
      out[j * 2 * n + i] = out[i * 2 * n + j];
      out[i * 2 * n + j] = kept;
    }
  PetscCall(ContrastTread(c->membrane, begin, end, c->treading + begin, a0, 2 * n, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}
