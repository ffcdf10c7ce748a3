#include "bodies/seepage.h"

/* Of the gradient z of the area at a marker the length is the marker's share l, and n = z/l. */

void SeepageAdd(Membrane m, PetscReal alpha, PetscBool osmotic, const PetscReal X[], const PetscScalar F[],
                PetscScalar U[]) {
  PetscReal *z = m->work.memory;
  for (PetscInt v = m->layout->own; v < m->layout->end && m->permeability > 0; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    Measures measures = {.area = 1};
    if (osmotic) MembraneMeasure(m, v, X + at, &measures);
    MembraneAreaGradient(m, v, X + at, z);
    const PetscReal pressure = osmotic ? m->osmotic[0] * m->A0[v] / measures.area - m->osmotic[1] : 0;
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k += 2) {
      const PetscReal l = PetscHypotReal(z[k], z[k + 1]);
      const PetscReal push = F ? (z[k] * F[at + k] + z[k + 1] * F[at + k + 1]) / (l * l) : 0;
      for (PetscInt c = k; c < k + 2; c++) U[at + c] += alpha * m->permeability * (pressure - push) / l * z[c];
    }
  }
}

void SeepageBlock(MembraneLaw law, const PetscReal X[], const PetscReal B[], PetscReal M[]) {
  const Membrane m = law->membrane;
  const PetscInt rows = 2 * law->n;
  PetscReal *z = m->work.memory;
  for (PetscInt v = law->vesicle; v < law->end && m->permeability > 0; v++) {
    const PetscInt first = 2 * (m->layout->start[v] - law->first);
    MembraneAreaGradient(m, v, X + first, z);
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) {
      const PetscReal *pair = z + k - k % 2, l = PetscHypotReal(pair[0], pair[1]);
      const PetscReal part = law->h2 * m->permeability / (l * l * l) * z[k];
      for (PetscInt i = 0; i < rows; i++) {
        const PetscReal *b = B + i * rows + first + k - k % 2;
        M[(first + k) * rows + i] += part * (b[0] * pair[0] + b[1] * pair[1]);
      }
    }
  }
}
