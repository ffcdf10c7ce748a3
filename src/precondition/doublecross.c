#include "precondition/doublecross.h"
#include "base/lanes.h"

PetscErrorCode DoubleCrossCreate(DoubleLayer layer, DoubleCross *out) {
  const PetscInt room = 2 * (layer->near->set.bodies->layout->M + LANES);
  DoubleCross c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->layer = layer;
  PetscCall(PetscCalloc3(room, &c->X, room, &c->N, room, &c->J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCrossDestroy(DoubleCross *cross) {
  PetscFunctionBeginUser;
  if (!*cross) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*cross)->X, (*cross)->N, (*cross)->J));
  PetscCall(PetscFree(*cross));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w += D J at x of the markers first .. end - 1: -(1/pi) r (r.N)(r.J)/r^4. Markers behind the last are no jump. */
static void AddJumpsAt(DoubleCross c, const PetscReal x[2], PetscInt first, PetscInt end, PetscScalar w[2]) {
  const Lanes order = {0, 1, 2, 3};
  Lanes sum[2] = {{0}, {0}};
  for (PetscInt k = first; k < end; k += LANES) {
    const LanesBits so = (LanesBits)(order < (Lanes){0} + (PetscReal)(end - k));
    Lanes rx, ry, nx, ny, jx, jy;
    LanesPairs(c->X + 2 * k, &rx, &ry);
    LanesPairs(c->N + 2 * k, &nx, &ny);
    LanesPairs(c->J + 2 * k, &jx, &jy);
    rx -= x[0];
    ry -= x[1];
    const Lanes r2 = rx * rx + ry * ry, q = LanesWhere(so, (rx * nx + ry * ny) * (rx * jx + ry * jy) / (r2 * r2));
    sum[0] += q * rx;
    sum[1] += q * ry;
  }
  w[0] -= LanesSum(sum[0]) / PETSC_PI;
  w[1] -= LanesSum(sum[1]) / PETSC_PI;
}

/* Of the vesicle `column` to own markers of `row`; sign times shift moves the column. */
static void AddJumps(DoubleCross c, PetscInt row, PetscInt column, PetscReal sign, const PetscReal shift[2],
                     PetscScalar W[]) {
  const Layout l = c->layer->near->set.bodies->layout;
  if (c->layer->ratio[column] == 1 || row < l->own || row >= l->end) return;
  for (PetscInt i = l->start[row]; i < l->start[row + 1]; i++) {
    const PetscReal x[2] = {c->X[2 * i] - sign * shift[0], c->X[2 * i + 1] - sign * shift[1]};
    AddJumpsAt(c, x, l->start[column], l->start[column + 1], W + 2 * (i - l->first));
  }
}

PetscErrorCode DoubleCrossPlace(DoubleCross c) {
  const NearField f = c->layer->near;
  const PetscInt M = f->set.bodies->membrane->layout->M;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(c->X, f->set.markers->X, 2 * M));
  PetscCall(PetscArraycpy(c->N, c->layer->normal, 2 * M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCrossApply(DoubleCross c, const PetscScalar J[], PetscScalar W[]) {
  const NearField f = c->layer->near;
  const Layout l = f->set.bodies->membrane->layout;
  PetscFunctionBeginUser;
  PetscCall(LayoutGather(l, 2, J, c->J));
  for (PetscInt k = 0; k < f->list.count.blocks; k++) {
    const NearBlock *b = &f->list.block[k];
    if (NearBlockIsSelf(b) || PetscMax(b->row, b->column) >= l->bodies) continue;
    AddJumps(c, b->row, b->column, 1, b->shift, W);
    AddJumps(c, b->column, b->row, -1, b->shift, W);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
