/* Gravity (docs/membrane.md, Gravity). With the hydrostatic pressure of each fluid taken off, the jump of these
   pressures across the membrane is a normal force, n outward,

       (weight.(X - centroid)) n ds,

   whose sum over the markers is weight times the area, without torque. Its energy is

       -weight . INT x dA. */
#include "bodies/force.h"

typedef struct {
  Membrane membrane; /* borrowed */
  PetscReal *weight; /* [2 vesicles] density difference over the outer density times gravity (length/time^2) */
} Gravity;

/* A constant pressure has no effect: with positions from the centroid numbers stay small. */
static PetscErrorCode GravityKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const Gravity *gravity = (const Gravity *)context;
  const Membrane m = gravity->membrane;
  PetscScalar *T = m->work.measures;
  PetscFunctionBeginUser;
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt n = LayoutCount(m->layout, v), at = 2 * LayoutOffset(m->layout, v);
    const PetscReal *g = gravity->weight + 2 * v, *x = X + at;
    Measures measures;
    MembraneMeasure(m, v, x, &measures);
    PetscCall(PetscArrayzero(T, 2 * n));
    SpectralDerivative(m->spectral[v], 1, 1, x, T);
    for (PetscInt k = 0; k < 2 * n; k += 2) {
      const PetscReal p = g[0] * (x[k] - measures.center[0]) + g[1] * (x[k + 1] - measures.center[1]);
      F[at + k] -= alpha * p * T[k + 1];
      F[at + k + 1] += alpha * p * T[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GravityEnergy(void *context, Instant at, const PetscScalar X[], PetscScalar F[], PetscReal E[]) {
  const Gravity *gravity = (const Gravity *)context;
  const Membrane m = gravity->membrane;
  PetscFunctionBeginUser;
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscReal *g = gravity->weight + 2 * v;
    Measures measures;
    MembraneMeasure(m, v, X + 2 * LayoutOffset(m->layout, v), &measures);
    E[v] -= measures.area * (g[0] * measures.center[0] + g[1] * measures.center[1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GravityDestroy(void *context) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(((Gravity *)context)->weight));
  PetscCall(PetscFree(context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Gravity(Bodies bodies, Grid grid, Scene scene, Force *force) {
  const PetscInt vesicles = bodies->vesicles;
  Gravity *gravity;
  PetscFunctionBeginUser;
  if (!scene || !SceneHasGravity(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&gravity));
  gravity->membrane = bodies->membrane;
  PetscCall(PetscMalloc1(2 * vesicles, &gravity->weight));
  for (PetscInt k = 0; k < 2 * vesicles; k++) gravity->weight[k] = SceneWeight(scene, k / 2, (int)(k % 2));
  *force = (Force){.name = "gravity",
                   .reach = FORCE_OUTSIDE,
                   .context = gravity,
                   .known = GravityKnown,
                   .energy = GravityEnergy,
                   .destroy = GravityDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
