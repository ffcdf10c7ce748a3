#include "plane/pointvelocity.h"
#include "base/agree.h"
#include "plane/cells.h"
#include "scheme/fields.h"

/* u_inf[2n] at n points; all ranks stop alike. */
static PetscErrorCode PointFlow(Scheme s, PetscInt n, const PetscReal X[], PetscReal u[]) {
  char message[PETVES_MAX_MESSAGE];
  PetscFunctionBeginUser;
  PetscCall(FlowVelocities(&s->scene->flow, s->state.t, n, X, u, message));
  PetscCall(AgreeMessage(s->scene->comm, message));
  PetvesCheck(!*message, s->scene->comm, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PointCells(PointVelocity *p) {
  const Grid g = p->scheme->fluid->grid;
  const PetscInt nx = g->n[0], n = nx * g->rows[FIELD_P], all = 2 * nx * g->n[1];
  PetscReal *u[2], *X, *flow;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(all, &p->cell));
  PetscCall(PetscMalloc4(n, &u[0], n, &u[1], 2 * n, &X, 2 * n, &flow));
  PetscCall(CellFields(p->scheme, u[0], u[1], NULL));
  for (PetscInt k = 0; k < n; k++) GridPosition(g, FIELD_P, k % nx, g->first + k / nx, X + 2 * k);
  PetscCall(PointFlow(p->scheme, n, X, flow));
  for (PetscInt k = 0; k < 2 * n; k++) p->cell[2 * g->first * nx + k] = u[k % 2][k / 2] - flow[k];
  PetscCall(PetscFree4(u[0], u[1], X, flow));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, p->cell, (PetscMPIInt)all, MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PointLayers(PointVelocity *p) {
  const Scheme s = p->scheme;
  const DoubleLayer contrast = s->coupling->mobility->contrast;
  const PetscReal nu = s->scene->fluid.nu;
  PetscReal *X, *F, *J;
  Vec forces, markers, U;
  Layout l;
  PetscFunctionBeginUser;
  PetscCall(CellForces(s, &l, &forces, &markers));
  p->bodies = l->bodies;
  PetscCall(PetscCalloc1(2 * l->bodies, &p->layer));
  PetscCall(PetscMalloc3(2 * l->M, &X, 2 * l->M, &F, 2 * s->membrane->layout->M, &J));
  PetscCall(LayoutGatherVec(l, markers, X));
  PetscCall(LayoutGatherVec(l, forces, F));
  PetscCall(SchemeFluidAtMarkers(s, &U));
  PetscCall(LayoutGatherVec(s->membrane->layout, U, J));
  PetscCall(VecDestroy(&U));
  PetscCall(VecDestroy(&forces));
  PetscCall(VecDestroy(&markers));
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt n = LayoutCount(l, v), first = 2 * l->start[v];
    PetscCall(CurveLayerCreate(&stokeslet, n, nu, X + first, F + first, &p->layer[2 * v]));
    if (!contrast || v >= s->membrane->layout->bodies || contrast->ratio[v] == 1) continue;
    for (PetscInt k = first; k < first + 2 * n; k++) J[k] *= 1 - contrast->ratio[v];
    PetscCall(CurveLayerCreate(&stresslet, n, nu, X + first, J + first, &p->layer[2 * v + 1]));
  }
  PetscCall(PetscFree3(X, F, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PointVelocityBegin(Scheme s, PointVelocity *p) {
  PetscFunctionBeginUser;
  *p = (PointVelocity){.scheme = s};
  if (!s->fluid->grid->free)
    PetscCall(PointCells(p));
  else if (s->state.dt_last > 0)
    PetscCall(PointLayers(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u += the layers at x; inside a vesicle of another viscosity u is then the ratio times the velocity. */
static void PointLayersAdd(const PointVelocity *p, const PetscReal x[2], PetscReal u[2]) {
  PetscReal ratio = 1, pressure = 0;
  for (PetscInt v = 0; p->layer && v < p->bodies; v++)
    for (int kind = 0; kind < 2 && p->layer[2 * v + kind]; kind++) {
      PetscBool inside = PETSC_FALSE;
      CurveLayerAdd(p->layer[2 * v + kind], x, u, &pressure, &inside);
      if (kind && inside) ratio = p->scheme->coupling->mobility->contrast->ratio[v];
    }
  for (int d = 0; d < 2; d++) u[d] /= ratio;
}

/* The cell that stands for the i-th in a direction; behind a wall with the opposite weight. */
static PetscInt PointCell(Grid g, int d, PetscInt i, PetscReal *weight) {
  const PetscInt n = g->n[d];
  if (!g->wall[d]) return (i % n + n) % n;
  if (i >= 0 && i < n) return i;
  *weight = -*weight;
  return PetscMax(0, PetscMin(n - 1, i < 0 ? -1 - i : 2 * n - 1 - i));
}

/* u += the interpolated values at x, from 4 x 4 cells. */
static void PointInterpolate(const PointVelocity *p, const PetscReal x[2], PetscReal u[2]) {
  const Grid g = p->scheme->fluid->grid;
  PetscReal weight[2][4];
  PetscInt first[2];
  for (int d = 0; d < 2; d++) {
    const PetscReal r = (x[d] - g->lo[d]) / g->h - 0.5, s = r - PetscFloorReal(r);
    first[d] = (PetscInt)PetscFloorReal(r) - 1;
    weight[d][0] = -s * (s - 1) * (s - 2) / 6;
    weight[d][1] = (s + 1) * (s - 1) * (s - 2) / 2;
    weight[d][2] = -(s + 1) * s * (s - 2) / 2;
    weight[d][3] = (s + 1) * s * (s - 1) / 6;
  }
  for (int k = 0; k < 16; k++) {
    PetscReal value = weight[0][k % 4] * weight[1][k / 4];
    const PetscInt i = PointCell(g, 0, first[0] + k % 4, &value), j = PointCell(g, 1, first[1] + k / 4, &value);
    for (int d = 0; d < 2; d++) u[d] += value * p->cell[2 * (i + g->n[0] * j) + d];
  }
}

PetscErrorCode PointVelocityAt(PointVelocity *p, PetscInt n, const PetscReal X[], PetscReal u[]) {
  const Grid g = p->scheme->fluid->grid;
  const PetscInt first = n * g->rank / g->size, end = n * (g->rank + 1) / g->size;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(u, 2 * n));
  PetscCall(PointFlow(p->scheme, end - first, X + 2 * first, u + 2 * first));
  for (PetscInt k = first; k < end; k++)
    if (p->cell)
      PointInterpolate(p, X + 2 * k, u + 2 * k);
    else
      PointLayersAdd(p, X + 2 * k, u + 2 * k);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, u, (PetscMPIInt)(2 * n), MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PointVelocityEnd(PointVelocity *p) {
  PetscFunctionBeginUser;
  for (PetscInt v = 0; p->layer && v < p->bodies; v++)
    for (int kind = 0; kind < 2; kind++) PetscCall(CurveLayerDestroy(&p->layer[2 * v + kind]));
  PetscCall(PetscFree(p->layer));
  PetscCall(PetscFree(p->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}
