#include "bodies/innerfluid.h"
#include <petscdt.h>

/* Points and weights of one body, and its mass. */
static PetscErrorCode InnerFluidFill(InnerFluid f, PetscInt b, PetscReal smoothed) {
  const Obstacles o = f->obstacles;
  const PetscInt n = LayoutCount(o->layout, b), rings = (f->start[b + 1] - f->start[b]) / n;
  const PetscReal *Y = o->rest + 2 * o->layout->start[b], *c = o->motion[b].center;
  PetscReal *T, *s, *w, *mass = f->mass + 3 * (o->motion[b].free - 1);
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(2 * n, &T, rings, &s, rings, &w));
  PetscCall(CurveTangents(&o->kind[b], o->spectral[b], n, Y, T));
  PetscCall(PetscDTGaussQuadrature(rings, 0, 1, s, w));
  for (PetscInt i = 0; i < rings; i++)
    for (PetscInt k = 0; k < n; k++) {
      const PetscInt at = f->start[b] + i * n + k;
      const PetscReal x = Y[2 * k] - c[0], y = Y[2 * k + 1] - c[1], sweep = x * T[2 * k + 1] - y * T[2 * k];
      const PetscReal square = PetscSqr(s[i]) * (x * x + y * y);
      PetvesCheck(
          sweep > 0, o->layout->comm,
          "-obstacle_free: parts of obstacle %" PetscInt_FMT
          " cannot be seen from its centroid; allowed with -fluid_inertia unsteady or convective: shapes of which "
          "all can, as of convex ones",
          b + 1);
      f->rest[2 * at] = c[0] + s[i] * x;
      f->rest[2 * at + 1] = c[1] + s[i] * y;
      f->weight[at] = w[i] * s[i] * sweep;
      f->turn[at] = f->weight[at] + (i + 1 == rings ? smoothed * sweep / square : 0);
      mass[0] += f->weight[at];
      mass[2] += f->weight[at] * square;
    }
  mass[1] = mass[0];
  for (int j = 0; j < 3; j++) mass[j] *= o->density[o->motion[b].free - 1];
  PetscCall(PetscFree3(T, s, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InnerFluidCreate(Obstacles o, PetscReal h, PetscReal smoothed, InnerFluid *out) {
  const Layout l = o->layout;
  InnerFluid f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->obstacles = o;
  PetscCall(PetscCalloc4(l->bodies + 1, &f->start, 3 * o->free->M, &f->mass, 3 * o->free->M, &f->rate[0],
                         3 * o->free->M, &f->rate[1]));
  for (PetscInt b = 0; b < l->bodies; b++) {
    const PetscInt rings = o->motion[b].free ? 1 + (PetscInt)(ObstacleRadius(o, b) / h) : 0;
    f->start[b + 1] = f->start[b] + rings * LayoutCount(l, b);
  }
  f->n = f->start[l->bodies];
  PetscCall(PetscMalloc4(2 * f->n, &f->rest, 2 * f->n, &f->X, f->n, &f->weight, f->n, &f->turn));
  for (PetscInt b = 0; b < l->bodies; b++)
    if (o->motion[b].free) PetscCall(InnerFluidFill(f, b, smoothed));
  PetscCall(PetscArraycpy(f->X, f->rest, 2 * f->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InnerFluidDestroy(InnerFluid *inner) {
  InnerFluid f = *inner;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(f->start, f->mass, f->rate[0], f->rate[1]));
  PetscCall(PetscFree4(f->rest, f->X, f->weight, f->turn));
  PetscCall(PetscFree(*inner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InnerFluidPlace(InnerFluid f) {
  const Obstacles o = f->obstacles;
  for (PetscInt b = 0; b < o->layout->bodies; b++) {
    const PetscInt first = f->start[b];
    MotionCarry(&o->motion[b], o->at, f->start[b + 1] - first, f->rest + 2 * first, f->X + 2 * first);
  }
}

PetscErrorCode InnerFluidAdd(InnerFluid f, InnerPart part, PetscReal alpha, const PetscReal g[]) {
  const Obstacles o = f->obstacles;
  const PetscInt n = 3 * o->free->M;
  PetscReal *sum = f->rate[0];
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, n));
  for (PetscInt b = 0; b < o->layout->bodies; b++) {
    const BodyPose p = MotionPose(&o->motion[b], o->at);
    PetscReal *own = sum + 3 * PetscMax(o->motion[b].free - 1, 0);
    for (PetscInt k = f->start[b]; k < f->start[b + 1]; k++) {
      const PetscReal dx = f->X[2 * k] - p.center[0], dy = f->X[2 * k + 1] - p.center[1];
      own[0] += f->weight[k] * g[2 * k];
      own[1] += f->weight[k] * g[2 * k + 1];
      own[2] += f->turn[k] * (dx * g[2 * k + 1] - dy * g[2 * k]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, o->layout->comm));
  for (PetscInt k = 0; k < n; k++) sum[k] *= alpha;
  for (PetscInt k = 0; k < n && part != INNER_PRODUCT; k++)
    f->rate[1][k] = (part == INNER_BEGIN ? 0 : f->rate[1][k]) + sum[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
