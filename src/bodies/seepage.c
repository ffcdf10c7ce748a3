#include "bodies/seepage.h"

/* Of the gradient z of the area at a marker the length is the marker's share l, and n = z/l. */

void SeepageApply(Membrane m, const PetscReal X[], PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  PetscReal *z = m->work.memory;
  for (PetscInt v = m->layout->own; v < m->layout->end && m->permeability > 0; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    MembraneAreaGradient(m, v, X + 2 * m->layout->start[v], z);
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k += 2) {
      const PetscReal l = PetscHypotReal(z[k], z[k + 1]);
      const PetscReal speed = alpha * m->permeability / (l * l * l) * (z[k] * F[at + k] + z[k + 1] * F[at + k + 1]);
      for (PetscInt c = k; c < k + 2; c++) U[at + c] += speed * z[c];
    }
  }
}

void SeepageAdd(Membrane m, PetscInt v, const PetscReal X[], PetscReal alpha, PetscInt rows, PetscReal K[]) {
  PetscReal *z = m->work.memory;
  if (m->permeability == 0) return;
  MembraneAreaGradient(m, v, X, z);
  for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k += 2) {
    const PetscReal l = PetscHypotReal(z[k], z[k + 1]);
    for (PetscInt c = k; c < k + 2; c++)
      for (PetscInt d = k; d < k + 2; d++) K[c * rows + d] += alpha * m->permeability / (l * l * l) * z[c] * z[d];
  }
}

void SeepageOsmotic(Membrane m, const PetscReal X[], PetscScalar U[]) {
  PetscReal *z = m->work.memory;
  for (PetscInt v = m->layout->own; v < m->layout->end && m->permeability > 0; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    Measures measures;
    MembraneMeasure(m, v, X + at, &measures);
    MembraneAreaGradient(m, v, X + at, z);
    const PetscReal speed = m->permeability * (m->osmotic[0] * m->A0[v] / measures.area - m->osmotic[1]);
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++)
      U[at + k] += speed / PetscHypotReal(z[k - k % 2], z[k - k % 2 + 1]) * z[k];
  }
}
