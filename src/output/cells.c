#include "output/cells.h"
#include "base/agree.h"

/* Value of a velocity component on a wall: the background's in the total form, else zero. */
static PetscScalar WallValue(Scheme s, int c, PetscInt i, PetscInt j, PetscReal wall) {
  PetscReal X[2], u[2];
  if (!s->fluid->total) return 0;
  GridPosition(s->fluid->grid, FIELD_P, i, j, X);
  X[c] = wall;
  FlowVelocity(&s->scene->flow, s->state.t, X[0], X[1], u);
  return u[c];
}

PetscErrorCode CellVelocity(Scheme s, int c, const PetscScalar w[], PetscScalar cells[]) {
  const Grid g = s->fluid->grid;
  const PetscInt columns = g->columns[c], nx = g->n[0];
  const PetscScalar *a = w + (c ? GridLocalU(g) : 0);
  Rows rows;
  char message[PETVES_MAX_MESSAGE] = "";
  PetscReal *X, *u;
  PetscFunctionBeginUser;
  PetscCall(GridRows(g, (Field)c, a, &rows));
  PetscCall(PetscCalloc2(2 * nx, &X, 2 * nx, &u));
  for (PetscInt j = 0; j < g->rows[FIELD_P] && !*message; j++) {
    for (PetscInt i = 0; i < nx; i++) GridPosition(g, FIELD_P, i, j + g->first, X + 2 * i);
    if (!s->fluid->total) PetscCall(FlowVelocities(&s->scene->flow, s->state.t, nx, X, u, message));
    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt index[2] = {i, j + g->first};
      PetscScalar face[2];
      for (int side = 0; side < 2; side++) {
        const PetscInt k = index[c] - 1 + side, n = g->n[c];
        if (g->wall[c] && (k < 0 || k == n - 1))
          face[side] = WallValue(s, c, i, index[1], side ? g->hi[c] : g->lo[c]);
        else if (c == 0)
          face[side] = RowAt(&rows, j)[(k + columns) % columns];
        else
          face[side] = RowAt(&rows, j - 1 + side)[i];
      }
      cells[j * nx + i] = 0.5 * (face[0] + face[1]) + u[2 * i + c];
    }
  }
  PetscCall(PetscFree2(X, u));
  if (s->scene->flow.type == FLOW_CUSTOM) PetscCall(AgreeMessage(g->comm, message));
  PetscCheck(!*message, g->comm, PETSC_ERR_USER_INPUT, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}
