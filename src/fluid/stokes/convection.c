/* Velocities are copied into padded arrays, which have the ghost faces that stand for walls, periodic seams and the
   neighbouring ranks' rows. So one formula serves all faces. */
#include "fluid/stokes/convection.h"

/* Place in a padded array of face (i, j), j a local row; both begin at -1. */
static PetscInt At(const Convection c, PetscInt i, PetscInt j) {
  return (j + 1) * c->width + i + 1;
}

PetscErrorCode ConvectionCreate(const Flow *flow, Fluid fluid, Convection *out) {
  const Grid g = fluid->grid;
  Convection c;
  PetscReal X[2], u[2];
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->fluid = fluid;
  c->flow = *flow;
  c->width = g->n[0] + 2;
  c->height = g->rows[FIELD_P] + 2;
  for (int f = 0; f < 2; f++) {
    PetscCall(PetscCalloc3(c->width * c->height, &c->background[f], c->width * c->height, &c->own[f],
                           c->width * c->height, &c->carrier[f]));
    for (PetscInt j = -1; j < c->height - 1; j++)
      for (PetscInt i = -1; i < c->width - 1; i++) {
        GridPosition(g, (Field)f, i, j + g->first, X);
        FlowVelocity(&c->flow, 0, X[0], X[1], u);
        c->background[f][At(c, i, j)] = u[f];
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ConvectionDestroy(Convection *convection) {
  Convection c = *convection;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (int f = 0; f < 2; f++) PetscCall(PetscFree3(c->background[f], c->own[f], c->carrier[f]));
  PetscCall(PetscFree(*convection));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One row of a component with its ghosts in x; `row` NULL, beyond the wall that v lies on: zeros. */
static void PadRow(Convection c, int f, const PetscScalar row[], PetscReal padded[]) {
  const Grid g = c->fluid->grid;
  const PetscInt n = g->columns[f];
  const PetscReal factor = GridWallFactor((Field)f, 0);
  for (PetscInt i = 0; i < c->width; i++) padded[i] = 0;
  if (!row) return;
  for (PetscInt i = 0; i < n; i++) padded[i + 1] = row[i];
  padded[0] = g->wall[0] ? factor * row[0] : row[n - 1];
  padded[n + 1] = g->wall[0] ? factor * row[n - 1] : row[0];
}

/* u' and u' + u_inf on the padded faces. */
static PetscErrorCode Pad(Convection c, Vec w) {
  const Grid g = c->fluid->grid;
  const PetscScalar *a;
  Rows rows;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(w, &a));
  for (int f = 0; f < 2; f++) {
    PetscCall(GridRows(g, (Field)f, a + (f ? GridLocalU(g) : 0), &rows));
    for (PetscInt j = -1; j < c->height - 1; j++)
      PadRow(c, f, j <= rows.rows ? RowAt(&rows, j) : NULL, c->own[f] + At(c, -1, j));
    for (PetscInt k = 0; k < c->width * c->height; k++) c->carrier[f][k] = c->own[f][k] + c->background[f][k];
  }
  PetscCall(VecRestoreArrayRead(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (u' + u_inf).grad u' at face k of component f. Fluxes F through the face's cell are means of two carrying values;
   the neighbour across each flux enters with F/(2h), which is minus what this face gives to the neighbour. */
static PetscReal Carried(const Convection c, int f, PetscInt k) {
  const PetscInt along = f ? c->width : 1, across = f ? 1 : c->width;
  const PetscReal *u = c->own[f], *a = c->carrier[f], *b = c->carrier[1 - f];
  const PetscReal ahead = a[k] + a[k + along], behind = a[k - along] + a[k];
  const PetscReal high = b[k] + b[k + along], low = b[k - across] + b[k - across + along];
  return (ahead * u[k + along] - behind * u[k - along] + high * u[k + across] - low * u[k - across]) /
         (4 * c->fluid->grid->h);
}

/* u'.grad u_inf at face k of component f, at the position X. */
static PetscReal Sheared(const Convection c, int f, PetscInt k, const PetscReal X[2]) {
  const PetscInt along = f ? c->width : 1, across = f ? 1 : c->width;
  const PetscReal *other = c->own[1 - f];
  const PetscReal mean = (other[k] + other[k + along] + other[k - across] + other[k - across + along]) / 4;
  PetscReal gradient[2][2];
  FlowGradient(&c->flow, X[1], gradient);
  return c->own[f][k] * gradient[f][f] + mean * gradient[f][1 - f];
}

PetscErrorCode ConvectionAdd(Convection c, PetscReal alpha, Vec w, Forcing *forcing) {
  const Grid g = c->fluid->grid;
  const PetscBool flow = c->flow.type != FLOW_QUIESCENT;
  PetscScalar *a;
  PetscReal X[2];
  PetscFunctionBeginUser;
  PetscCall(Pad(c, w));
  ForcingNote(forcing, NULL);
  PetscCall(VecGetArray(forcing->values, &a));
  for (int f = 0; f < 2; f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      for (PetscInt i = 0; i < g->columns[f]; i++) {
        const PetscInt k = At(c, i, j);
        GridPosition(g, (Field)f, i, j + g->first, X);
        a[(f ? GridLocalU(g) : 0) + j * g->columns[f] + i] += alpha *
                                                              (Carried(c, f, k) + (flow ? Sheared(c, f, k, X) : 0));
      }
  PetscCall(VecRestoreArray(forcing->values, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ConvectionSpeed(Convection c, Vec w, PetscReal *speed) {
  const Grid g = c->fluid->grid;
  PetscReal most = 0;
  PetscFunctionBeginUser;
  PetscCall(Pad(c, w));
  for (PetscInt j = 0; j < g->rows[FIELD_P]; j++)
    for (PetscInt i = 0; i < g->n[0]; i++) {
      const PetscInt k = At(c, i, j);
      const PetscReal u = PetscMax(PetscAbsReal(c->carrier[0][k]), PetscAbsReal(c->carrier[0][k - 1]));
      const PetscReal v = PetscMax(PetscAbsReal(c->carrier[1][k]), PetscAbsReal(c->carrier[1][k - c->width]));
      if (PetscIsNanReal(c->carrier[0][k] + c->carrier[1][k]))
        most = INFINITY; /* a NaN may get lost in MPI_MAX, on some ranks only */
      most = PetscMax(most, u + v);
    }
  PetscCallMPI(MPI_Allreduce(&most, speed, 1, MPIU_REAL, MPI_MAX, g->comm));
  if (PetscIsInfOrNanReal(*speed)) *speed = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}
