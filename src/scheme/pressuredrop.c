#include "scheme/pressuredrop.h"
#include "scheme/fields.h"

/* The profile b(y) of a channel's flow under a unit pressure gradient, y from its lower wall,
     b = (y (H - y)/2 + more)/nu.
   The grid's profile has more = h^2/8, the exact one 0. */
static PetscReal Profile(Scheme s, PetscReal y, PetscReal more) {
  const Grid g = s->fluid->grid;
  return (0.5 * y * (g->hi[1] - g->lo[1] - y) + more) / s->fluid->nu;
}

static PetscReal GridProfile(Scheme s, PetscInt row) {
  const PetscReal h = s->fluid->grid->h;
  return Profile(s, (row + 0.5) * h, h * h / 8);
}

/* This rank's parts of the forces along x on the fluid. */
typedef struct {
  PetscReal spread;  /* sum of the forces on the grid, which next to walls is less than that at the markers */
  PetscReal smeared; /* SUM F (b - E b) of obstacles in a channel */
} ForceSums;

/* Add the obstacles' forces. */
static PetscErrorCode AddObstacles(Scheme s, ForceSums *sum) {
  const Coupling c = s->coupling;
  const Grid g = s->fluid->grid;
  const Obstacles o = c->bodies->obstacles;
  const PetscScalar *F;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  const Layout l = o->layout;
  const PetscInt first = c->bodies->layout->M - l->M + l->first;
  PetscCall(VecGetArrayRead(s->state.solid, &F));
  for (PetscInt k = 0; k < l->n; k++) {
    const Stencil *e = &c->markers->stencil[2 * (first + k)];
    PetscReal part = 0, b = 0;
    for (PetscInt j = 0; j < e->n[1]; j++) {
      part += e->weight[1][j];
      if (g->wall[1]) b += e->weight[1][j] * GridProfile(s, e->first[1] + j);
    }
    sum->spread -= part * F[2 * k];
    if (g->wall[1]) sum->smeared -= F[2 * k] * (Profile(s, c->markers->X[2 * (first + k) + 1] - g->lo[1], 0) - b);
  }
  PetscCall(VecRestoreArrayRead(s->state.solid, &F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The obstacles' forces, contact forces that solids give, and forces from outside where there are walls. */
static PetscErrorCode OwnForces(Scheme s, ForceSums *sum) {
  const ForceReach last = s->fluid->grid->wall[1] ? FORCE_OUTSIDE : FORCE_BETWEEN;
  const PetscInt n = s->membrane->layout->n;
  const PetscScalar *X;
  PetscScalar *F;
  PetscFunctionBeginUser;
  *sum = (ForceSums){0};
  PetscCall(AddObstacles(s, sum));
  PetscCall(PetscCalloc1(2 * n, &F));
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(ForcesLaw(s->coupling->forces, FORCE_BETWEEN, last, StateInstant(&s->state), X, F));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  for (PetscInt k = 0; k < n; k++) sum->spread += F[2 * k];
  PetscCall(PetscFree(F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum over this rank's u faces. */
static PetscErrorCode OwnSum(Grid g, Vec w, PetscReal *sum) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  *sum = 0;
  PetscCall(VecGetArrayRead(w, &a));
  for (PetscInt k = 0; k < GridLocalU(g); k++) *sum += a[k];
  PetscCall(VecRestoreArrayRead(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Flux of the background by Simpson's rule, which is exact for poiseuille. */
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

/* Mean of the solved field minus that of the velocity. They differ inside vesicles with a viscosity contrast, after the
   first step. */
static PetscErrorCode InnerMean(Scheme s, PetscReal mean[2]) {
  Vec U;
  PetscFunctionBeginUser;
  if (!s->coupling->mobility->contrast || !s->state.solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeFluidAtMarkers(s, &U));
  PetscCall(DoubleLayerMean(s->coupling->mobility->contrast, U, mean));
  PetscCall(VecDestroy(&U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces act on the mean flow as SUM F E b, by their images on the grid, and the near field does not change that. The
   difference to SUM F b is given back to the gradient where the flux is held, and to the flux elsewhere. */
static void GiveBack(Scheme s, PetscReal smeared, PetscReal *gradient, PetscReal *flux) {
  const Grid g = s->fluid->grid;
  const PetscReal height = g->hi[1] - g->lo[1], area = (g->hi[0] - g->lo[0]) * height;
  PetscReal mean = 0;
  if (!g->wall[1]) return;
  for (PetscInt j = 0; j < g->n[1]; j++) mean += GridProfile(s, j) / g->n[1];
  if (s->scene->fluid.drive == DRIVE_FLUX)
    *gradient = (*gradient * mean - smeared / area) / (height * height / (12 * s->fluid->nu));
  else
    *flux += height * smeared / area;
}

PetscErrorCode DriveMeasure(Scheme s, Drive *drive) {
  const Grid g = s->fluid->grid;
  const PetscReal area = (g->hi[0] - g->lo[0]) * (g->hi[1] - g->lo[1]), faces = (PetscReal)g->n[0] * g->n[1];
  PetscReal sum[4], background[2], mean[2] = {0, 0}, gradient;
  ForceSums forces;
  Vec Hu;
  PetscFunctionBeginUser;
  *drive = (Drive){NAN, NAN};
  if (g->wall[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeVelocity(s));
  PetscCall(DMGetGlobalVector(g->velocity, &Hu));
  PetscCall(GridHelmholtz(g, s->fluid->alpha, s->fluid->nu, s->state.w, Hu));
  PetscCall(OwnForces(s, &forces));
  sum[0] = forces.spread;
  sum[1] = forces.smeared;
  PetscCall(OwnSum(g, Hu, &sum[2]));
  PetscCall(OwnSum(g, s->state.w, &sum[3]));
  PetscCall(DMRestoreGlobalVector(g->velocity, &Hu));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, g->comm));
  FlowPressureGradient(&s->scene->flow, s->fluid->nu, background);
  gradient = sum[2] / faces - sum[0] / area;
  if (g->wall[1] && !s->fluid->zero_flux) gradient = 0; /* none but the background's */
  PetscCall(InnerMean(s, mean));
  drive->flux = (sum[3] / faces - mean[0]) * (g->hi[1] - g->lo[1]) + BackgroundFlux(s);
  GiveBack(s, sum[1], &gradient, &drive->flux);
  drive->pressure_drop = (g->hi[0] - g->lo[0]) * (gradient - background[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureGradient(Scheme s, PetscReal *gradient) {
  const Grid g = s->fluid->grid;
  PetscReal background[2];
  Drive drive = {NAN, NAN};
  PetscFunctionBeginUser;
  if (s->coupling->bodies->obstacles || s->fluid->zero_flux) PetscCall(DriveMeasure(s, &drive));
  FlowPressureGradient(&s->scene->flow, s->fluid->nu, background);
  *gradient = s->fluid->total ? 0 : background[0];
  if (!PetscIsNanReal(drive.pressure_drop)) *gradient = -drive.pressure_drop / (g->hi[0] - g->lo[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
