#include "fluid/stokes/streamflow.h"
#include "fluid/stokes/streamloops.h"

PetscErrorCode StreamFlowsCreate(Grid g, RowTransform t, PetscInt width, StreamFlows *out) {
  StreamFlows s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = g;
  s->t = t;
  s->rows = g->rows[FIELD_V]; /* nodes are level with v */
  s->width = width;
  s->each = width + LANES;
  PetscCall(PetscCalloc4(width, &s->norm, width, &s->curl, width, &s->middle, width, &s->modes));
  PetscCall(PetscCalloc5(s->each, &s->edge[0], s->each, &s->edge[1], s->each, &s->line[0], s->each, &s->line[1],
                         s->each, &s->line[2]));
  PetscCall(RowTransformNorms(t, s->norm));
  for (PetscInt k = 0; k < t->width; k++) {
    s->curl[k] = 1 / t->scale[k];
    s->middle[k] = 2 + t->lambda[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamFlowsDestroy(StreamFlows *flows) {
  StreamFlows s = *flows;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(s->norm, s->curl, s->middle, s->modes));
  PetscCall(PetscFree5(s->edge[0], s->edge[1], s->line[0], s->line[1], s->line[2]));
  PetscCall(PetscFree(*flows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamFlowsCreateVec(StreamFlows s, Vec *flow) {
  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(s->grid->comm, s->grid->rows[FIELD_U] * s->each, PETSC_DETERMINE, flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row j of the sum, a row of this rank. */
static void FlowsSumRow(StreamFlows s, PetscInt j, PetscReal *restrict sum) {
  const PetscInt at = j * s->each;
  const PetscReal a = s->weight[0], b = s->weight[1], c = s->weight[2];
  const PetscScalar *restrict x = s->flow[0] + at, *restrict y = s->flow[1] + at, *restrict z = s->flow[2] + at;
  for (PetscInt k = 0; k < s->each; k++) sum[k] = a * x[k] + b * y[k] + c * z[k];
}

/* Exchange the rows next to the slab with the neighbours: across the seam on one rank, none at walls, none of a
   neighbour that has no nodes. */
static PetscErrorCode FlowsExchange(StreamFlows s) {
  const Grid g = s->grid;
  const PetscMPIInt n = (PetscMPIInt)s->each;
  PetscFunctionBeginUser;
  for (int up = 0; up < 2; up++) {
    PetscReal *own = s->line[0];
    (void)PetscArrayzero(own, s->each);
    if (s->rows) FlowsSumRow(s, up ? s->rows - 1 : 0, own);
    PetscCallMPI(MPI_Sendrecv(own, n, MPIU_REAL, up ? g->above : g->below, up, s->edge[!up], n, MPIU_REAL,
                              up ? g->below : g->above, up, g->comm, MPI_STATUS_IGNORE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamFlowsBegin(StreamFlows s, const StreamPast *past) {
  PetscFunctionBeginUser;
  s->square = 0;
  for (PetscInt i = 0; i < past->count; i++) PetscCall(VecGetArrayRead(past->flow[i], &s->flow[i]));
  for (PetscInt i = 0; i < STREAM_PAST; i++) s->weight[i] = i < past->count ? past->weight[i] : 0;
  for (PetscInt i = past->count; i < STREAM_PAST; i++) s->flow[i] = s->flow[0];
  PetscCall(FlowsExchange(s));
  if (s->rows) FlowsSumRow(s, 0, s->line[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamFlowsEnd(StreamFlows s, const StreamPast *past, PetscReal *square) {
  const Grid g = s->grid;
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < g->rows[FIELD_U] && square; j++) {
    s->square += (PetscReal)g->n[0] * PetscSqr(StreamFlowsMean(s, j, 0));
    if (j < s->rows) s->square += (PetscReal)g->n[0] * PetscSqr(StreamFlowsMean(s, j, 1));
  }
  if (square) *square = s->square;
  for (PetscInt i = 0; i < past->count; i++) PetscCall(VecRestoreArrayRead(past->flow[i], &s->flow[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With the nodes' c = chi/h, SUM u^2 = SUM_j c_j (2 c_j - c_{j-1} - c_{j+1}) and SUM v^2 = SUM lambda c^2. */
const PetscReal *StreamFlowsCurl(StreamFlows s, PetscInt j) {
  const PetscReal *last = j > 0 ? s->line[(j - 1) % 3] : s->edge[0], *now = s->line[j % 3], *next = s->edge[1];
  Lanes square = {0};
  if (j + 1 < s->rows) {
    FlowsSumRow(s, j + 1, s->line[(j + 1) % 3]);
    next = s->line[(j + 1) % 3];
  }
  for (PetscInt k = 0; k < s->width; k += LANES) {
    const Lanes c = LanesAt(now + k), curl = LanesAt(s->middle + k) * c - LanesAt(last + k) - LanesAt(next + k);
    square += LanesAt(s->norm + k) * c * curl;
    LanesPut(LanesAt(s->curl + k) * curl, s->modes + k);
  }
  s->square += LanesSum(square);
  return s->modes;
}

const PetscReal *StreamFlowsRow(StreamFlows s, PetscInt j) {
  if (j < 0) return s->edge[0];
  if (j >= s->rows) return s->edge[1];
  FlowsSumRow(s, j, s->line[0]);
  return s->line[0];
}

PetscReal StreamFlowsMean(StreamFlows s, PetscInt j, int comp) {
  const PetscInt at = j * s->each + s->width + comp;
  return s->weight[0] * s->flow[0][at] + s->weight[1] * s->flow[1][at] + s->weight[2] * s->flow[2][at];
}

/* chi/h of row j of nodes; zero on a wall in x behind the last node. */
static void Nodes(StreamFlows s, PetscInt j, PetscScalar chi[]) {
  (void)PetscArraycpy(s->t->modes, StreamFlowsRow(s, j), s->t->width);
  RowTransformBackward(s->t, chi);
  if (s->grid->wall[0]) chi[s->grid->n[0] - 1] = 0;
}

PetscErrorCode StreamFlowsVelocity(StreamFlows s, Vec flow, Vec w) {
  const StreamPast one = {.count = 1, .weight = {1}, .flow = {flow}};
  const Grid g = s->grid;
  const PetscInt n = g->n[0];
  PetscScalar *a, *chi, *row;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * n, &chi, n, &row));
  PetscCall(StreamFlowsBegin(s, &one));
  PetscCall(VecGetArrayWrite(w, &a));
  Nodes(s, -1, chi + n);
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) {
    PetscScalar *low = chi + (j + 1) % 2 * n, *high = chi + j % 2 * n;
    Nodes(s, j, high);
    StreamRowU(n, low, high, StreamFlowsMean(s, j, 0), row);
    PetscCall(PetscArraycpy(a + GridRowStart(g, FIELD_U, j), row, g->columns[FIELD_U]));
    if (j == s->rows) break;
    StreamRowV(n, high, StreamFlowsMean(s, j, 1), row);
    PetscCall(PetscArraycpy(a + GridRowStart(g, FIELD_V, j), row, g->columns[FIELD_V]));
  }
  PetscCall(VecRestoreArrayWrite(w, &a));
  PetscCall(StreamFlowsEnd(s, &one, NULL));
  PetscCall(PetscFree2(chi, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamFlowsSquare(StreamFlows s, Vec flow, PetscReal *square) {
  const StreamPast one = {.count = 1, .weight = {1}, .flow = {flow}};
  PetscFunctionBeginUser;
  PetscCall(StreamFlowsBegin(s, &one));
  for (PetscInt j = 0; j < s->rows; j++) (void)StreamFlowsCurl(s, j);
  PetscCall(StreamFlowsEnd(s, &one, square));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, square, 1, MPIU_REAL, MPI_SUM, s->grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
