#include "scheme/drive.h"

/* SUM of the x forces on the fluid in the mean of momentum: the obstacles', and where there are walls gravity's, and of
   contact what solids give. Own parts. */
static PetscErrorCode OwnForce(Scheme s, PetscReal *sum) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscScalar *F;
  PetscInt n;
  PetscFunctionBeginUser;
  *sum = 0;
  PetscCall(VecGetLocalSize(s->state.solid, &n));
  PetscCall(VecGetArrayRead(s->state.solid, &F));
  for (PetscInt k = 0; k < n; k += 2) *sum -= F[k];
  PetscCall(VecRestoreArrayRead(s->state.solid, &F));
  for (PetscInt v = l->own; v < l->end && m->weight && s->fluid->grid->wall[1]; v++)
    *sum += m->weight[2 * v] * m->A0[v];
  if (s->coupling->repulsion) {
    const PetscScalar *X;
    PetscScalar *y;
    PetscReal energy;
    PetscCall(PetscCalloc1(2 * l->n, &y));
    PetscCall(VecGetArrayRead(s->state.X, &X));
    PetscCall(RepulsionAt(s->coupling->repulsion, 1, X, y, &energy));
    PetscCall(VecRestoreArrayRead(s->state.X, &X));
    for (PetscInt k = 0; k < l->n; k++) *sum += y[2 * k];
    PetscCall(PetscFree(y));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum over own u faces. */
static PetscErrorCode OwnSum(Grid g, Vec w, PetscReal *sum) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  *sum = 0;
  PetscCall(VecGetArrayRead(w, &a));
  for (PetscInt k = 0; k < GridLocalU(g); k++) *sum += a[k];
  PetscCall(VecRestoreArrayRead(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Flux of the background: midpoints, exact to h^2/8 of the walls' shear for poiseuille, so by Simpson's rule. */
static PetscReal BackgroundFlux(Scheme s) {
  const Grid g = s->fluid->grid;
  PetscReal flux = 0, u[2];
  for (PetscInt j = 0; j < 2 * g->n[1] + 1; j++) {
    const PetscReal weight = j == 0 || j == 2 * g->n[1] ? 1 : j % 2 ? 4 : 2;
    FlowVelocity(&s->scene->flow, s->state.t, g->lo[0], g->lo[1] + 0.5 * j * g->h, u);
    flux += weight * g->h / 6 * u[0];
  }
  return flux;
}

/* What the mean of the solved field has more than that of the velocity, where it is not the velocity inside vesicles.
 */
static PetscErrorCode InnerMean(Scheme s, PetscReal mean[2]) {
  const PetscScalar *U;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->state.U, &U));
  PetscCall(DoubleLayerSet(s->coupling->contrast, U));
  PetscCall(VecRestoreArrayRead(s->state.U, &U));
  DoubleLayerMean(s->coupling->contrast, mean);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DriveMeasure(Scheme s, Drive *drive) {
  const Grid g = s->fluid->grid;
  const PetscReal area = (g->hi[0] - g->lo[0]) * (g->hi[1] - g->lo[1]), faces = (PetscReal)g->n[0] * g->n[1];
  PetscReal sum[3], gradient[2];
  Vec Hu;
  PetscFunctionBeginUser;
  PetscReal mean[2] = {0, 0};
  *drive = (Drive){NAN, NAN};
  if (g->wall[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetGlobalVector(g->velocity, &Hu));
  PetscCall(GridHelmholtz(g, s->fluid->alpha, s->fluid->nu, s->state.w, Hu));
  PetscCall(OwnForce(s, &sum[0]));
  PetscCall(OwnSum(g, Hu, &sum[1]));
  PetscCall(OwnSum(g, s->state.w, &sum[2]));
  PetscCall(DMRestoreGlobalVector(g->velocity, &Hu));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, g->comm));
  FlowPressureGradient(&s->scene->flow, s->fluid->nu, gradient);
  drive->pressure_drop = -(g->hi[0] - g->lo[0]) * (sum[0] / area - sum[1] / faces + gradient[0]);
  if (s->coupling->contrast) PetscCall(InnerMean(s, mean));
  drive->flux = (sum[2] / faces - mean[0]) * (g->hi[1] - g->lo[1]) + BackgroundFlux(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}
