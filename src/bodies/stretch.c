#include "bodies/stretch.h"
#include "bodies/force.h"

Stretch StretchOf(LawType law, PetscReal q) {
  const PetscReal lambda = PetscSqrtReal(q), root = PetscSqrtReal(lambda);
  if (law == LAW_GREEN) return (Stretch){0.5 * (q - 1), 0.5, 0.125 * PetscSqr(q - 1)};
  if (law == LAW_HOOKE) return (Stretch){1 - 1 / lambda, 0.5 / (q * lambda), 0.5 * PetscSqr(lambda - 1)};
  return (Stretch){(root - 1 / (q * root)) / 3, (lambda * lambda + 5 / lambda) / (12 * q * root * lambda),
                   (0.4 * q * root + 2 / root - 2.4) / 3};
}

/* Forces of stretched edges are those of the law's unknowns (law.h); what is here is their energy. */
static PetscErrorCode StretchingEnergy(void *context, Instant at, const PetscScalar X[], PetscScalar F[],
                                       PetscReal E[]) {
  const Membrane m = (Membrane)context;
  PetscScalar *tau = m->work.measures;
  PetscFunctionBeginUser;
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const Material *of = &m->material[v];
    if (!MembraneStretches(m, v)) continue;
    MembraneTangents(m, v, v + 1, X + 2 * LayoutOffset(m->layout, v), tau);
    for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++)
      E[v] += of->modulus * m->ds[v] * StretchOf(of->law, PetscSqr(tau[2 * k]) + PetscSqr(tau[2 * k + 1])).energy;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Stretching(Bodies bodies, Grid grid, Scene scene, Force *force) {
  const Membrane m = bodies->membrane;
  PetscFunctionBeginUser;
  if (!m->stretches) PetscFunctionReturn(PETSC_SUCCESS);
  *force = (Force){.name = "stretching", .reach = FORCE_WITHIN, .context = m, .energy = StretchingEnergy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
