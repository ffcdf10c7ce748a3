#include "scheme/stress.h"

PetscBool StressApplies(Scheme s) {
  const Grid g = s->fluid->grid;
  return s->scene->flow.type == FLOW_SHEAR && s->scene->flow.rate != 0 && CouplingHasBodies(s->coupling) && !g->free &&
                 !g->wall[0] && g->wall[1]
             ? PETSC_TRUE
             : PETSC_FALSE;
}

/* SUM over columns of the first and the last row of a field (u or p), on all ranks. */
static PetscErrorCode EndRows(Grid g, Field field, Vec x, PetscReal sum[2]) {
  const PetscInt columns = g->columns[field], rows = g->rows[field];
  const PetscScalar *a;
  PetscFunctionBeginUser;
  sum[0] = sum[1] = 0;
  PetscCall(VecGetArrayRead(x, &a));
  for (PetscInt i = 0; i < columns; i++) {
    if (!g->first) sum[0] += a[i];
    if (g->rank == g->size - 1) sum[1] += a[(rows - 1) * columns + i];
  }
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean over both walls of the disturbance's shear stress nu du/dy, and of its pressure less the mean of all; p NULL: as
   the solve has measured them. */
static PetscErrorCode WallStress(Scheme s, Vec w, Vec p, PetscReal *shear, PetscReal *pressure) {
  const Fluid f = s->fluid;
  const Grid g = f->grid;
  PetscReal u[2], q[2];
  PetscScalar all;
  PetscFunctionBeginUser;
  if (!p) {
    *shear = f->nu / g->h * s->report.measures.slip;
    *pressure = s->report.measures.pressure;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(EndRows(g, FIELD_U, w, u));
  PetscCall(EndRows(g, FIELD_P, p, q));
  PetscCall(VecSum(p, &all));
  *shear = f->nu / (g->h * g->n[0]) * (u[0] - u[1]);
  *pressure = 0.5 * (q[0] + q[1]) / g->n[0] - all / ((PetscReal)g->n[0] * g->n[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SUM of force times place over the box, xx, yy and xy: y from the middle; x along each body, so that forces between
   vesicles over the seam are where they act. */
static PetscErrorCode Stresslets(Scheme s, Vec F, Vec X, PetscReal sum[3]) {
  const Layout l = s->coupling->bodies->layout;
  const Grid g = s->fluid->grid;
  const PetscReal *at = s->coupling->markers->X + 2 * l->first, middle = 0.5 * (g->lo[1] + g->hi[1]);
  const PetscScalar *a, *x;
  PetscReal seams;
  PetscFunctionBeginUser;
  sum[0] = sum[1] = sum[2] = 0;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(ForcesSeams(s->coupling->forces, s->coupling->markers->X, x, &seams));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(VecGetArrayRead(F, &a));
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal y = at[2 * k + 1] - middle;
    sum[0] -= a[2 * k] * at[2 * k];
    sum[1] -= a[2 * k + 1] * y;
    sum[2] -= a[2 * k] * y;
  }
  PetscCall(VecRestoreArrayRead(F, &a));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, l->comm));
  sum[0] -= seams;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SUM of force times what its stencil's first moment across the channel falls short of, of u and of v: the near field's
   own stress at the walls, as the fluid on the grid does not feel all of a force that stands next to a wall. */
static PetscErrorCode Shortfall(Scheme s, Vec F, PetscReal sum[2]) {
  const Layout l = s->coupling->bodies->layout;
  const PetscScalar *a;
  PetscFunctionBeginUser;
  sum[0] = sum[1] = 0;
  PetscCall(VecGetArrayRead(F, &a));
  for (PetscInt k = 0; k < 2 * l->n; k++)
    sum[k % 2] -= a[k] * MarkersShortfall(s->coupling->markers, l->first + k / 2, k % 2, 1);
  PetscCall(VecRestoreArrayRead(F, &a));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the fluid's force along x on every body is zero: the moment F x of another force goes by where x = 0 is. With
   inertia a body that moves freely takes up momentum. */
static PetscBool StressIsBalanced(Scheme s) {
  const Obstacles o = s->coupling->bodies->obstacles;
  for (PetscInt v = 0; v < s->membrane->layout->bodies && SceneHasGravity(s->scene); v++)
    if (SceneWeight(s->scene, v, 0) != 0) return PETSC_FALSE;
  for (PetscInt b = 0; o && b < o->layout->bodies; b++)
    if (!s->fluid->steady || !o->motion[b].free || o->load[3 * (o->motion[b].free - 1)] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode StressMeasure(Scheme s, Vec w, Vec p, Vec F, Vec X) {
  const Mobility m = s->coupling->mobility;
  const Grid g = s->fluid->grid;
  const PetscReal area = (g->hi[0] - g->lo[0]) * (g->hi[1] - g->lo[1]);
  const PetscReal scale = s->fluid->nu * s->scene->flow.rate;
  Stress *out = &s->report.stress;
  PetscReal sum[3], near[2], shear = 0, pressure = 0;
  PetscFunctionBeginUser;
  if (!StressApplies(s)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WallStress(s, w, p, &shear, &pressure));
  PetscCall(Stresslets(s, F, X, sum));
  PetscCall(Shortfall(s, F, near));
  if (m->contrast) PetscCall(DoubleLayerStress(m->contrast, m->G, sum, near));
  out->viscosity[0] = 1 + (shear - near[0] / area) / scale;
  out->viscosity[1] = 1 - sum[2] / area / scale;
  out->normal[0] = pressure + (near[1] - sum[0]) / area;
  out->normal[1] = (sum[1] - sum[0]) / area;
  if (!StressIsBalanced(s)) out->normal[0] = out->normal[1] = NAN;
  out->known = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
