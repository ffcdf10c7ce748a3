#include "coupling/obstacles.h"

/* N of one curve, its markers' mean and its mean edge. */
static PetscErrorCode Describe(Obstacles o, PetscInt b) {
  const PetscInt first = 2 * o->layout->start[b], n = LayoutCount(o->layout, b);
  const PetscReal *X = o->X + first;
  PetscReal *T, *N = o->N + first, sum = 0, length = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &T));
  PetscCall(CurveTangents(&o->kind[b], o->spectral[b], n, X, T));
  for (PetscInt k = 0; k < n; k++) {
    N[2 * k] = T[2 * k + 1];
    N[2 * k + 1] = -T[2 * k];
    for (int c = 0; c < 2; c++) {
      sum += PetscSqr(T[2 * k + c]);
      o->center[2 * b + c] += X[2 * k + c] / n;
    }
    length += PetscHypotReal(T[2 * k], T[2 * k + 1]);
  }
  for (PetscInt k = 0; k < 2 * n; k++) N[k] /= PetscSqrtReal(sum);
  o->ds[b] = length / n;
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U_w of one curve: what the scene gives it, rotation about the curve's center. */
static void Move(Obstacles o, PetscInt b, const PetscReal velocity[2], PetscReal rotation) {
  for (PetscInt k = o->layout->start[b]; k < o->layout->start[b + 1]; k++) {
    o->U[2 * k] = velocity[0] - rotation * (o->X[2 * k + 1] - o->center[2 * b + 1]);
    o->U[2 * k + 1] = velocity[1] + rotation * (o->X[2 * k] - o->center[2 * b]);
  }
}

PetscErrorCode ObstaclesCreate(Scene scene, Layout all, Obstacles *out) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscInt curves = own->outline.vesicles;
  Obstacles o;
  PetscFunctionBeginUser;
  *out = NULL;
  if (!curves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&o));
  *out = o;
  o->all = all;
  o->frequency = own->frequency;
  o->beta = 1 / (4 * scene->fluid.nu);
  PetscCall(LayoutCreatePart(all, all->bodies - curves, all->bodies, &o->layout));
  const PetscInt W = o->layout->M;
  PetscCall(PetscCalloc7(2 * W, &o->X, 2 * W, &o->U, 2 * W, &o->N, 2 * curves, &o->center, curves, &o->ds, curves,
                         &o->spectral, curves, &o->container));
  PetscCall(PetscMalloc1(curves, &o->kind));
  PetscCall(PetscArraycpy(o->kind, own->outline.kind, curves));
  PetscCall(PetscArraycpy(o->X, own->outline.X, 2 * W));
  PetscCall(PetscArraycpy(o->container, own->container, curves));
  for (PetscInt b = 0; b < curves; b++) {
    PetscCall(SpectralCreate(LayoutCount(o->layout, b), &o->spectral[b]));
    PetscCall(Describe(o, b));
    Move(o, b, own->velocity + 2 * b, own->turn[b]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstaclesDestroy(Obstacles *obstacles) {
  Obstacles o = *obstacles;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < o->layout->bodies; b++) PetscCall(SpectralDestroy(&o->spectral[b]));
  PetscCall(PetscFree7(o->X, o->U, o->N, o->center, o->ds, o->spectral, o->container));
  PetscCall(PetscFree(o->kind));
  PetscCall(LayoutDestroy(&o->layout));
  PetscCall(PetscFree(*obstacles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ObstaclesOrder(Obstacles o, const PetscReal own[], PetscReal seen[]) {
  for (PetscInt v = 0; v < o->layout->bodies; v++)
    for (PetscInt first = o->layout->start[v], end = o->layout->start[v + 1], k = first; k < end; k++)
      for (int c = 0; c < 2; c++) seen[2 * k + c] = own[2 * (o->container[v] ? first + end - 1 - k : k) + c];
}

void ObstaclesCurves(Obstacles o, PetscReal X[]) {
  ObstaclesOrder(o, o->X, X);
}

void ObstaclesPressure(Obstacles o, const PetscScalar F[], PetscScalar y[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const PetscInt at = 2 * LayoutOffset(l, b), n = 2 * LayoutCount(l, b);
    const PetscReal *N = o->N + 2 * l->start[b];
    PetscReal sum = 0;
    for (PetscInt k = 0; k < n; k++) sum += N[k] * F[at + k];
    for (PetscInt k = 0; k < n; k++) y[at + k] += o->beta * sum * N[k];
  }
}

void ObstaclesScale(Obstacles o, PetscReal weight, PetscBool inverse, PetscScalar y[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const PetscInt at = 2 * LayoutOffset(l, b);
    const PetscReal factor = inverse ? o->ds[b] / weight : weight / o->ds[b];
    for (PetscInt k = at; k < at + 2 * LayoutCount(l, b); k++) y[k] *= factor;
  }
}

PetscErrorCode ObstaclesData(Obstacles o, const Flow *flow, PetscReal t, PetscScalar y[],
                             char message[PETVES_MAX_MESSAGE]) {
  const Layout l = o->layout;
  const PetscReal swing = PetscCosReal(o->frequency * t);
  PetscReal *u;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * l->n, &u));
  PetscCall(FlowVelocities(flow, t, l->n, o->X + 2 * l->first, u, message));
  for (PetscInt k = 0; k < 2 * l->n; k++) y[k] += u[k] - swing * o->U[2 * l->first + k];
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstaclesLoads(Obstacles o, const PetscScalar F[], ObstacleLoad load[]) {
  const Layout l = o->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(load, l->bodies));
  for (PetscInt b = l->own; b < l->end; b++)
    for (PetscInt k = l->start[b]; k < l->start[b + 1]; k++) {
      const PetscReal *f = F + 2 * (k - l->first), *X = o->X + 2 * k, *c = o->center + 2 * b;
      load[b].force[0] += f[0];
      load[b].force[1] += f[1];
      load[b].torque += (X[0] - c[0]) * f[1] - (X[1] - c[1]) * f[0];
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, (PetscMPIInt)(3 * l->bodies), MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
