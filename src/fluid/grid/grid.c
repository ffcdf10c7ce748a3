#include "fluid/grid/grid.h"

/* Smallest slab: two rows, so that the last rank has a row of v besides the wall. */
#define LEAST_ROWS 2

PetscBool GridFits(PetscInt n, PetscInt ranks) {
  const PetscInt block = (n + ranks - 1) / ranks; /* rows of all ranks but the last */
  return ranks == 1 || n - (ranks - 1) * block >= LEAST_ROWS;
}

/* All ranks but the last have block rows; stop where the last one then has too few, and say what works. */
static PetscErrorCode CheckRanks(Grid g) {
  char works[PETVES_MAX_MESSAGE] = "1";
  PetscFunctionBeginUser;
  for (PetscInt r = 2, listed = 1; r <= g->n[1] / LEAST_ROWS && listed < 24; r++) {
    if (!GridFits(g->n[1], r)) continue;
    const size_t used = strlen(works);
    PetscCall(PetscSNPrintf(works + used, sizeof(works) - used, ",%" PetscInt_FMT, r));
    listed++;
  }
  PetscCheck(GridFits(g->n[1], g->size), g->comm, PETSC_ERR_USER_INPUT,
             "mpirun -n %d: slabs of %" PetscInt_FMT " of the %" PetscInt_FMT
             " rows of -domain_cells leave a rank without rows; allowed: %s%s ranks",
             g->size, g->block, g->n[1], works, g->n[1] / LEAST_ROWS > 24 ? ",..." : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFields(Grid g) {
  const DMBoundaryType bx = g->wall[0] ? DM_BOUNDARY_NONE : DM_BOUNDARY_PERIODIC;
  const DMBoundaryType by = g->wall[1] ? DM_BOUNDARY_NONE : DM_BOUNDARY_PERIODIC;
  PetscInt *ly;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(g->size, &ly));
  for (int f = 0; f < 3; f++) {
    g->columns[f] = g->n[0] - (f == FIELD_U && g->wall[0]);
    g->all_rows[f] = g->n[1] - (f == FIELD_V && g->wall[1]);
    for (PetscInt r = 0; r < g->size; r++)
      ly[r] = r < g->size - 1 ? g->block : g->all_rows[f] - (g->size - 1) * g->block;
    g->rows[f] = ly[g->rank];
    PetscCall(DMDACreate2d(g->comm, bx, by, DMDA_STENCIL_STAR, g->columns[f], g->all_rows[f], 1, g->size, 1, 0, NULL,
                           ly, &g->da[f]));
    PetscCall(DMSetUp(g->da[f]));
    for (int side = 0; side < 2; side++) PetscCall(PetscCalloc1(g->columns[f], &g->ghost[f][side]));
  }
  PetscCall(PetscFree(ly));
  PetscCall(DMCompositeCreate(g->comm, &g->velocity));
  PetscCall(DMCompositeAddDM(g->velocity, g->da[FIELD_U]));
  PetscCall(DMCompositeAddDM(g->velocity, g->da[FIELD_V]));
  PetscCall(DMSetUp(g->velocity));
  for (int f = FIELD_U; f <= FIELD_V; f++) { /* the composite has left vectors in their pools */
    PetscCall(DMClearGlobalVectors(g->da[f]));
    PetscCall(DMClearLocalVectors(g->da[f]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridCreate(const FluidSpec *spec, Grid *grid) {
  Grid g;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&g));
  *grid = g;
  g->comm = spec->comm;
  PetscCallMPI(MPI_Comm_rank(g->comm, &g->rank));
  PetscCallMPI(MPI_Comm_size(g->comm, &g->size));
  for (int d = 0; d < 2; d++) {
    g->lo[d] = spec->box[2 * d];
    g->hi[d] = spec->box[2 * d + 1];
    g->n[d] = spec->cells[d];
    g->wall[d] = spec->bc[d] == BC_PERIODIC ? PETSC_FALSE : PETSC_TRUE;
  }
  g->free = FluidSpecIsFree(spec);
  g->h = FluidSpecCellSize(spec);
  g->block = (g->n[1] + g->size - 1) / g->size;
  g->first = g->rank * g->block;
  PetscCall(CheckRanks(g));
  g->below = g->rank > 0 ? g->rank - 1 : (g->wall[1] ? MPI_PROC_NULL : g->size - 1);
  g->above = g->rank < g->size - 1 ? g->rank + 1 : (g->wall[1] ? MPI_PROC_NULL : 0);
  PetscCall(CreateFields(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridDestroy(Grid *grid) {
  Grid g = *grid;
  PetscFunctionBeginUser;
  if (!g) PetscFunctionReturn(PETSC_SUCCESS);
  for (int f = 0; f < 3; f++) {
    PetscCall(DMDestroy(&g->da[f]));
    for (int side = 0; side < 2; side++) PetscCall(PetscFree(g->ghost[f][side]));
  }
  PetscCall(DMDestroy(&g->velocity));
  PetscCall(PetscFree(*grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void GridPosition(Grid g, Field f, PetscInt i, PetscInt j, PetscReal X[2]) {
  X[0] = g->lo[0] + (i + (f == FIELD_U ? 1.0 : 0.5)) * g->h;
  X[1] = g->lo[1] + (j + (f == FIELD_V ? 1.0 : 0.5)) * g->h;
}

/* The ghost row that stands in for a wall. */
static void WallRow(Field f, PetscInt n, const PetscScalar first[], PetscScalar ghost[]) {
  const PetscReal c = GridWallFactor(f, 1);
  for (PetscInt i = 0; i < n; i++) ghost[i] = c * first[i];
}

PetscErrorCode GridRows(Grid g, Field f, const PetscScalar a[], Rows *r) {
  const PetscInt n = g->columns[f], rows = g->rows[f];
  const PetscScalar *first = a, *last = a + (rows - 1) * n;
  PetscFunctionBeginUser;
  r->a = a;
  r->columns = n;
  r->rows = rows;
  r->below = g->ghost[f][0];
  r->above = g->ghost[f][1];
  if (g->size > 1) {
    PetscCallMPI(MPI_Sendrecv(last, (PetscMPIInt)n, MPIU_SCALAR, g->above, 0, g->ghost[f][0], (PetscMPIInt)n,
                              MPIU_SCALAR, g->below, 0, g->comm, MPI_STATUS_IGNORE));
    PetscCallMPI(MPI_Sendrecv(first, (PetscMPIInt)n, MPIU_SCALAR, g->below, 1, g->ghost[f][1], (PetscMPIInt)n,
                              MPIU_SCALAR, g->above, 1, g->comm, MPI_STATUS_IGNORE));
  } else if (!g->wall[1]) {
    r->below = last;
    r->above = first;
  }
  if (g->below == MPI_PROC_NULL) WallRow(f, n, first, g->ghost[f][0]);
  if (g->above == MPI_PROC_NULL) WallRow(f, n, last, g->ghost[f][1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
