#include "bodies/seepage.h"

/* n[2n] outward unit normals of one vesicle; length[n] shares of its length. */
static void SeepageNormals(Membrane m, PetscInt v, const PetscReal X[], PetscReal n[], PetscReal length[]) {
  MembraneAreaGradient(m, v, X, n);
  for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++) {
    length[k] = PetscHypotReal(n[2 * k], n[2 * k + 1]);
    for (int c = 0; c < 2; c++) n[2 * k + c] /= length[k];
  }
}

void SeepageApply(Membrane m, const PetscReal X[], PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  PetscReal *n = m->work.memory, *length = n + 2 * m->layout->M;
  for (PetscInt v = m->layout->own; v < m->layout->end && m->permeability > 0; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    SeepageNormals(m, v, X + 2 * m->layout->start[v], n, length);
    for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++) {
      const PetscReal *N = n + 2 * k, *f = F + at + 2 * k;
      const PetscReal speed = alpha * m->permeability / length[k] * (N[0] * f[0] + N[1] * f[1]);
      for (int c = 0; c < 2; c++) U[at + 2 * k + c] += speed * N[c];
    }
  }
}

void SeepageAdd(Membrane m, PetscInt v, const PetscReal X[], PetscReal alpha, PetscInt rows, PetscReal K[]) {
  PetscReal *n = m->work.memory, *length = n + 2 * m->layout->M;
  if (m->permeability == 0) return;
  SeepageNormals(m, v, X, n, length);
  for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++)
    for (int c = 0; c < 4; c++)
      K[(2 * k + c / 2) * rows + 2 * k + c % 2] += alpha * m->permeability / length[k] * n[2 * k + c / 2] *
                                                   n[2 * k + c % 2];
}

void SeepageOsmotic(Membrane m, const PetscReal X[], PetscScalar U[]) {
  PetscReal *n = m->work.memory, *length = n + 2 * m->layout->M;
  for (PetscInt v = m->layout->own; v < m->layout->end && m->permeability > 0; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    Measures measures;
    MembraneMeasure(m, v, X + at, &measures);
    const PetscReal speed = m->permeability * (m->osmotic[0] * m->A0[v] / measures.area - m->osmotic[1]);
    SeepageNormals(m, v, X + at, n, length);
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) U[at + k] += speed * n[k];
  }
}
