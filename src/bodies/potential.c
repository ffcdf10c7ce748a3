#include "bodies/potential.h"

typedef struct {
  Membrane membrane; /* borrowed */
  ScenePotential law;
  PetscReal period[2], over_period[2]; /* and its inverse; both 0: none */
  PetscScalar *all;                    /* [2M] work */
  PetscScalar *at;                     /* [2n] minus the force where it is placed */
  PetscReal seams;                     /* part of ForcesSeams, of the own markers, there */
} Potential;

/* x^p, by products where p is a small integer. */
static PetscReal PotentialPower(PetscReal x, PetscReal p) {
  const int n = (int)PetscMin(p, 64);
  return p == n ? PetscPowRealInt(x, n) : PetscPowReal(x, p);
}

/* phi of points at the square z2 of a distance z, and its slope over z. */
static PetscReal PotentialOf(const ScenePotential *law, PetscReal z2, PetscReal *slope) {
  const PetscReal m = law->exponents.v[0], n = law->exponents.v[1], x = PetscSqr(law->distance) / z2;
  const PetscReal low = PotentialPower(x, n / 2), high = m == 2 * n ? low * low : PotentialPower(x, m / 2);
  *slope = -law->strength * m * (high - low) / z2;
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
    for (PetscInt w = 0; w < l->bodies; w++) {
      const PetscBool both = w >= l->own && w < l->end; /* are own: the pair is met once */
      const PetscReal half = 0.5 * m->ds[v] * m->ds[w];
      for (PetscInt i = l->start[v]; i < l->start[v + 1] && w != v && !(both && w < v); i++)
        for (PetscInt j = l->start[w]; j < l->start[w + 1]; j++) {
          PetscReal r[2], apart[2], slope;
          for (int c = 0; c < 2; c++) {
            r[c] = X[2 * i + c] - X[2 * j + c];
            apart[c] = o->period[c] * rint(r[c] * o->over_period[c]);
            r[c] -= apart[c];
          }
          const PetscReal phi = PotentialOf(&o->law, r[0] * r[0] + r[1] * r[1], &slope);
          if (E) E[v] += half * phi;
          if (E && both) E[w] += half * phi;
          for (int c = 0; c < 2 && F; c++) {
            F[2 * (i - l->first) + c] -= 2 * alpha * half * slope * r[c];
            if (both) F[2 * (j - l->first) + c] += 2 * alpha * half * slope * r[c];
          }
          seams -= (both ? 2 : 1) * half * slope * r[0] * apart[0];
        }
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

static PetscErrorCode PotentialAt(void *context, Instant t, const PetscScalar X[], PetscScalar F[], PetscReal E[]) {
  const Potential *o = (const Potential *)context;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(o->membrane->layout, 2, X, o->all));
  (void)PotentialAdd(o, 1, o->all, F, E);
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
  for (int d = 0; d < 2 && !grid->free; d++) {
    if (grid->wall[d]) continue;
    o->period[d] = grid->hi[d] - grid->lo[d];
    o->over_period[d] = 1 / o->period[d];
  }
  PetscCall(PetscMalloc2(2 * l->M, &o->all, 2 * l->n, &o->at));
  *force = (Force){.name = "potential",
                   .reach = FORCE_BETWEEN,
                   .context = o,
                   .place = PotentialPlace,
                   .known = PotentialKnown,
                   .law = PotentialAt,
                   .energy = PotentialAt,
                   .seams = PotentialSeams,
                   .destroy = PotentialDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
