#include "plane/cells.h"
#include "scheme/fields.h"
#include "base/agree.h"
#include "layers/layercells.h"

/* A velocity component on a wall: the background's in the total form, else zero. */
static PetscScalar CellWallValue(Scheme s, int c, PetscInt i, PetscInt j, PetscReal wall) {
  PetscReal X[2], u[2];
  if (!s->fluid->total) return 0;
  GridPosition(s->fluid->grid, FIELD_P, i, j, X);
  X[c] = wall;
  FlowVelocity(&s->scene->flow, s->state.t, X[0], X[1], u);
  return u[c];
}

/* Component c of the velocity w with the background: the mean of a cell's two faces. */
static PetscErrorCode CellComponent(Scheme s, int c, const PetscScalar w[], PetscReal cells[]) {
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
          face[side] = CellWallValue(s, c, i, index[1], side ? g->hi[c] : g->lo[c]);
        else if (c == 0)
          face[side] = RowAt(&rows, j)[(k + columns) % columns];
        else
          face[side] = RowAt(&rows, j - 1 + side)[i];
      }
      cells[j * nx + i] = 0.5 * (face[0] + face[1]) + u[2 * i + c];
    }
  }
  PetscCall(PetscFree2(X, u));
  if (FlowIsCustom(&s->scene->flow)) PetscCall(AgreeMessage(g->comm, message));
  PetscCheck(!*message, g->comm, PETSC_ERR_USER_INPUT, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellForces(Scheme s, Layout *layout, Vec *F, Vec *X) {
  const State *q = &s->state;
  const Layout vesicles = s->membrane->layout;
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscScalar *solid;
  PetscReal *all;
  PetscScalar *f, *x;
  Vec own;
  PetscFunctionBeginUser;
  *layout = o && s->fluid->grid->free ? s->coupling->bodies->layout : vesicles;
  PetscCall(LayoutCreateVec(*layout, 2, F));
  PetscCall(LayoutCreateVec(*layout, 2, X));
  PetscCall(VecDuplicate(q->X, &own));
  PetscCall(CouplingForces(s->coupling, StateInstant(q), q->sigma, q->X, own));
  PetscCall(CouplingCopyVesicles(s->coupling, own, *F));
  PetscCall(CouplingCopyVesicles(s->coupling, q->X, *X));
  PetscCall(VecDestroy(&own));
  if (*layout == vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * o->layout->M, &all));
  ObstaclesCurves(o, StateInstant(q), all);
  PetscCall(VecGetArrayRead(q->solid, &solid));
  PetscCall(VecGetArray(*F, &f));
  PetscCall(VecGetArray(*X, &x));
  PetscCall(PetscArraycpy(x + 2 * vesicles->n, all + 2 * o->layout->first, 2 * o->layout->n));
  for (PetscInt k = 0; k < 2 * o->layout->n; k++) f[2 * vesicles->n + k] = -solid[k];
  PetscCall(VecRestoreArray(*X, &x));
  PetscCall(VecRestoreArray(*F, &f));
  PetscCall(VecRestoreArrayRead(q->solid, &solid));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the grid does not have of the membranes' forces and jumps: all of it in unbounded fluid, the near field
   otherwise; then the velocity inside vesicles of another viscosity. Nothing before the first step, whose velocity and
   tension are not known. */
static PetscErrorCode AddMembranes(Scheme s, PetscReal *const field[3]) {
  const State *q = &s->state;
  const NearField near = s->coupling->mobility->near;
  const DoubleLayer contrast = s->coupling->mobility->contrast;
  Layout layout;
  Vec F, X, U;
  PetscFunctionBeginUser;
  if (!q->solved || !near) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CellForces(s, &layout, &F, &X));
  PetscCall(SingleCellsCorrect(&near->set, &near->lattice, layout, F, X, field));
  PetscCall(VecDestroy(&F));
  PetscCall(VecDestroy(&X));
  if (!contrast) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeFluidAtMarkers(s, &U));
  PetscCall(DoubleCellsCorrect(&near->set, contrast->lattice, contrast->ratio, U, q->X, field));
  PetscCall(VecDestroy(&U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellFields(Scheme s, PetscReal u[], PetscReal v[], PetscReal p[]) {
  const Grid g = s->fluid->grid;
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(SchemeFields(s));
  PetscCall(VecGetArrayRead(s->state.w, &a));
  if (u) PetscCall(CellComponent(s, 0, a, u));
  if (v) PetscCall(CellComponent(s, 1, a, v));
  PetscCall(VecRestoreArrayRead(s->state.w, &a));
  PetscCall(VecGetArrayRead(s->state.p, &a));
  if (p) PetscCall(PetscArraycpy(p, a, g->n[0] * g->rows[FIELD_P]));
  PetscCall(VecRestoreArrayRead(s->state.p, &a));
  PetscCall(AddMembranes(s, (PetscReal *[]){u, v, p}));
  PetscFunctionReturn(PETSC_SUCCESS);
}
