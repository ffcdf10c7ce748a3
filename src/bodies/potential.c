#include "bodies/potential.h"

typedef struct {
  Membrane membrane; /* borrowed */
  ScenePotential law;
  PetscReal period[2]; /* 0: none */
  PetscScalar *all;    /* [2M] work */
  PetscScalar *at;     /* [2n] minus the force where it is placed */
  PetscReal seams;     /* part of ForcesSeams, of the own markers, there */
} Potential;

/* phi of points at a distance z, and its slope over z. */
static PetscReal PotentialOf(const ScenePotential *law, PetscReal z, PetscReal *slope) {
  const PetscReal m = law->exponents.v[0], n = law->exponents.v[1];
  const PetscReal high = PetscPowReal(law->distance / z, m), low = PetscPowReal(law->distance / z, n);
  *slope = -law->strength * m * (high - low) / PetscSqr(z);
  return law->strength * (high - m / n * low);
}

/* From the markers X[2M] of all vesicles: F += alpha times the force on the own markers, E[vesicles] += the energies of
   the own vesicles, half of what is between two; NULL: not wanted. Returns the own part of ForcesSeams. */
static PetscReal PotentialAdd(const Potential *o, PetscReal alpha, const PetscScalar X[], PetscScalar F[],
                              PetscReal E[]) {
  const Membrane m = o->membrane;
  const Layout l = m->layout;
  PetscReal seams = 0;
  for (PetscInt v = l->own; v < l->end; v++)
    for (PetscInt w = 0; w < l->bodies; w++)
      for (PetscInt i = l->start[v]; i < l->start[v + 1] && w != v; i++)
        for (PetscInt j = l->start[w]; j < l->start[w + 1]; j++) {
          const PetscReal size = m->ds[v] * m->ds[w];
          PetscReal r[2], apart[2], slope;
          for (int c = 0; c < 2; c++) {
            r[c] = X[2 * i + c] - X[2 * j + c];
            apart[c] = o->period[c] > 0 ? o->period[c] * PetscFloorReal(r[c] / o->period[c] + 0.5) : 0;
            r[c] -= apart[c];
          }
          const PetscReal phi = PotentialOf(&o->law, PetscSqrtReal(r[0] * r[0] + r[1] * r[1]), &slope);
          if (E) E[v] += 0.5 * size * phi;
          for (int c = 0; c < 2 && F; c++) F[2 * (i - l->first) + c] -= alpha * size * slope * r[c];
          seams -= 0.5 * size * slope * r[0] * apart[0];
        }
  return seams;
}

static PetscErrorCode PotentialPlace(void *context, Instant t, const PetscReal X[]) {
  Potential *o = (Potential *)context;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(o->at, 2 * o->membrane->layout->n));
  o->seams = PotentialAdd(o, -1, X, o->at, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PotentialKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const Potential *o = (const Potential *)context;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * o->membrane->layout->n; k++) F[k] += alpha * o->at[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PotentialLaw(void *context, Instant t, const PetscScalar X[], PetscScalar F[]) {
  const Potential *o = (const Potential *)context;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(o->membrane->layout, 2, X, o->all));
  (void)PotentialAdd(o, 1, o->all, F, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PotentialEnergy(void *context, Instant t, const PetscScalar X[], PetscReal E[]) {
  const Potential *o = (const Potential *)context;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(o->membrane->layout, 2, X, o->all));
  (void)PotentialAdd(o, 1, o->all, NULL, E);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PotentialSeams(void *context, const PetscReal X[], const PetscScalar x[], PetscReal *sum) {
  const Potential *o = (const Potential *)context;
  PetscReal seams = o->seams;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &seams, 1, MPIU_REAL, MPI_SUM, o->membrane->layout->comm));
  *sum += seams;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PotentialDestroy(void *context) {
  Potential *o = (Potential *)context;
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(o->all, o->at));
  PetscCall(PetscFree(context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Potential(Bodies bodies, Grid grid, Scene scene, Force *force) {
  const Layout l = bodies->membrane->layout;
  Potential *o;
  PetscFunctionBeginUser;
  if (!scene || scene->potential.strength == 0 || l->bodies < 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&o));
  o->membrane = bodies->membrane;
  o->law = scene->potential;
  for (int d = 0; d < 2; d++) o->period[d] = grid->wall[d] || grid->free ? 0 : grid->hi[d] - grid->lo[d];
  PetscCall(PetscMalloc2(2 * l->M, &o->all, 2 * l->n, &o->at));
  *force = (Force){.name = "contact",
                   .reach = FORCE_BETWEEN,
                   .context = o,
                   .place = PotentialPlace,
                   .known = PotentialKnown,
                   .law = PotentialLaw,
                   .energy = PotentialEnergy,
                   .seams = PotentialSeams,
                   .destroy = PotentialDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
