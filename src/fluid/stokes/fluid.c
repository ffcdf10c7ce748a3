#include "fluid/stokes/fluid.h"

PetscErrorCode FluidSolveHelmholtz(Fluid f, Vec b, Vec w) {
  PetscFunctionBeginUser;
  PetscCall(FastSolverApply(f->solver[FIELD_U], 0, b, w));
  PetscCall(FastSolverApply(f->solver[FIELD_V], GridLocalU(f->grid), b, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyHelmholtzInverse(PC pc, Vec b, Vec w) {
  Fluid f;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &f));
  PetscCall(FluidSolveHelmholtz(f, b, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultHelmholtz(Mat H, Vec w, Vec y) {
  Fluid f;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(H, &f));
  PetscCall(GridHelmholtz(f->grid, f->alpha, f->nu, w, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateHelmholtz(Fluid f, const char type[]) {
  const Grid g = f->grid;
  const PetscInt n = GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V];
  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(g->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, f, &f->H));
  PetscCall(MatShellSetOperation(f->H, MATOP_MULT, (void (*)(void))MultHelmholtz));
  PetscCall(PCCreate(g->comm, &f->Hinv));
  PetscCall(PCSetType(f->Hinv, PCSHELL));
  PetscCall(PCSetOperators(f->Hinv, f->H, f->H));
  PetscCall(PCShellSetContext(f->Hinv, f));
  PetscCall(PCShellSetApply(f->Hinv, ApplyHelmholtzInverse));
  PetscCall(PCShellSetName(f->Hinv, type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* bc1 and u_inf of one component on this rank's faces. The stencil of nu L_u takes the wall's value u_w as the
   neighbour where the wall is on a face: nu u_w/h^2 more. Half a cell off, the neighbour is 2 u_w minus the entry: 2 nu
   u_w/h^2. */
static void WallMomentum(const FluidSpec *spec, Fluid f, int c, PetscScalar bc1[], PetscScalar background[]) {
  Grid g = f->grid;
  const PetscInt n = g->columns[c], size[2] = {n, g->all_rows[c]};
  const PetscReal wall = f->nu / PetscSqr(g->h);
  PetscReal gradient[2], X[2], u[2];
  FlowPressureGradient(spec->flow, f->nu, gradient);
  for (PetscInt j = 0; j < g->rows[c]; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt index[2] = {i, j + g->first};
      PetscScalar value = -gradient[c];
      GridPosition(g, (Field)c, index[0], index[1], X);
      FlowVelocity(spec->flow, 0, X[0], X[1], u);
      background[j * n + i] = u[c];
      for (int dir = 0; dir < 2; dir++)
        for (int side = 0; side < 2; side++) {
          PetscReal W[2] = {X[0], X[1]};
          if (!g->wall[dir] || index[dir] != (side ? size[dir] - 1 : 0)) continue;
          W[dir] = side ? g->hi[dir] : g->lo[dir];
          FlowVelocity(spec->flow, 0, W[0], W[1], u);
          value += (c == dir ? 1 : 2) * wall * u[c]; /* wall on a face, or half a cell off */
        }
      bc1[j * n + i] = value;
    }
}

/* The flows that walls move with (FlowType) are at most quadratic across themselves: their divergence is zero on the
   grid too, and that of the faces off the walls is minus the wall faces' part, bc2. */
static PetscErrorCode CreateWallData(const FluidSpec *spec, Fluid f) {
  PetscScalar *a, *b;
  PetscFunctionBeginUser;
  PetscCall(DMCreateGlobalVector(f->grid->velocity, &f->bc1));
  PetscCall(DMCreateGlobalVector(f->grid->velocity, &f->background));
  PetscCall(DMCreateGlobalVector(f->grid->da[FIELD_P], &f->bc2));
  PetscCall(VecGetArray(f->bc1, &a));
  PetscCall(VecGetArray(f->background, &b));
  for (int c = 0; c < 2; c++) {
    const PetscInt start = c ? GridLocalU(f->grid) : 0;
    WallMomentum(spec, f, c, a + start, b + start);
  }
  PetscCall(VecRestoreArray(f->background, &b));
  PetscCall(VecRestoreArray(f->bc1, &a));
  PetscCall(GridGradientTranspose(f->grid, -1, f->background, f->bc2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FluidCreate(const FluidSpec *spec, Fluid *out) {
  Fluid f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  PetscCall(GridCreate(spec, &f->grid));
  f->nu = spec->nu;
  f->steady = spec->inertia == INERTIA_NONE;
  f->zero_flux = spec->drive == DRIVE_FLUX;
  f->held = spec->held && spec->bc[0] == BC_PERIODIC && spec->bc[1] == BC_PERIODIC;
  f->tridiagonal = !strcmp(spec->helmholtz, "fftw_tridiagonal") && !strcmp(spec->poisson, "fftw_tridiagonal");
  PetscCall(GridCreateG(f->grid, &f->G));
  PetscCall(GridCreateD(f->grid, &f->D));
  for (int k = FIELD_U; k <= FIELD_P && !f->grid->free; k++)
    PetscCall(FastSolverCreate(f->grid, (Field)k, k == FIELD_P ? spec->poisson : spec->helmholtz, &f->solver[k]));
  if (!f->grid->free) {
    PetscCall(FastSolverSetCoefficients(f->solver[FIELD_P], 0, -1));
    f->Linv = f->solver[FIELD_P]->pc;
    f->L = f->solver[FIELD_P]->A;
    PetscCall(CreateHelmholtz(f, spec->helmholtz));
  }
  PetscCall(FluidSetTimeCoefficient(f, 1 / spec->dt));
  f->total = spec->form == FORM_TOTAL;
  if (f->total) PetscCall(CreateWallData(spec, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FluidDestroy(Fluid *fluid) {
  Fluid f = *fluid;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&f->G));
  PetscCall(MatDestroy(&f->D));
  PetscCall(MatDestroy(&f->H));
  PetscCall(PCDestroy(&f->Hinv));
  for (int k = FIELD_U; k <= FIELD_P; k++) PetscCall(FastSolverDestroy(&f->solver[k]));
  PetscCall(VecDestroy(&f->background));
  PetscCall(VecDestroy(&f->bc1));
  PetscCall(VecDestroy(&f->bc2));
  PetscCall(GridDestroy(&f->grid));
  PetscCall(PetscFree(*fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FluidSetTimeCoefficient(Fluid f, PetscReal a0) {
  PetscFunctionBeginUser;
  f->a0 = a0;
  f->alpha = f->steady ? 0 : a0;
  for (int k = FIELD_U; k <= FIELD_V && !f->grid->free; k++)
    PetscCall(FastSolverSetCoefficients(f->solver[k], f->alpha, f->nu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FluidRemoveMean(Fluid f, Vec w) {
  const Grid g = f->grid;
  const PetscInt n = GridLocalU(g); /* as many of v: the box is periodic */
  PetscScalar *a, sum[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a));
  for (PetscInt k = 0; k < 2 * n; k++) sum[k / n] += a[k];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_SCALAR, MPI_SUM, g->comm));
  for (PetscInt k = 0; k < 2 * n; k++) a[k] -= sum[k / n] / ((PetscReal)g->n[0] * g->n[1]);
  PetscCall(VecRestoreArray(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt FluidCountSolves(Fluid f) {
  if (f->grid->free) return 0;
  return f->solver[FIELD_U]->solves + f->solver[FIELD_V]->solves + f->solver[FIELD_P]->solves;
}

const SolveFailure *FluidFailure(Fluid f) {
  for (int k = FIELD_U; k <= FIELD_P && !f->grid->free; k++)
    if (f->solver[k]->failure.why < 0) return &f->solver[k]->failure;
  return NULL;
}

void FluidClearFailure(Fluid f) {
  for (int k = FIELD_U; k <= FIELD_P && !f->grid->free; k++) FastSolverClearFailure(f->solver[k]);
}
