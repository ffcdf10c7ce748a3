/* The way up of a solve by stream function: from the forces on the rows of a slab to y = (y1, y2) of the modes
   (stream.c has the recurrences). */
#include "fluid/stokes/streamloops.h"
#include "fluid/stokes/streamstate.h"

/* Modes of the curl of the forces at a row of nodes: of u below and above it, of v in it, and of the states before
   (past, NULL: none). */
static const PetscReal *CurlModes(Stream s, const PetscScalar low[], const PetscScalar high[], const PetscScalar v[],
                                  const PetscReal past[]) {
  PetscReal *restrict modes = s->t->modes;
  StreamRowCurl(s->fluid->grid->n[0], s->fluid->grid->wall[0], low, high, v, s->curl);
  RowTransformForward(s->t, s->curl);
  for (PetscInt k = 0; k < s->t->width && past; k++) modes[k] += past[k];
  return modes;
}

/* y of row j from the modes of its curl, and from y below it. */
static void ForcedRow(Stream s, PetscInt j, const PetscReal curl[], const PetscReal below[]) {
  const Slabs q = s->slabs;
  const PetscInt modes = s->t->width, w = q->width;
  PetscReal *y = q->y + j * w;
  StreamRowUp(modes, s->factors->r[0], s->factors->r[1], curl, below, q->state, y);
  for (PetscInt k = modes; k < w; k++) y[k] = 0;
  SlabsStore(q, j, w / MODE_BLOCK);
}

/* y of row j, `since` rows above the last force, in the blocks of modes that have not decayed. */
static void FreeRow(Stream s, PetscInt j, PetscInt since) {
  const Slabs q = s->slabs;
  PetscInt blocks = j > 0 ? q->stored[j - 1] : 0;
  for (; blocks > 0 && s->factors->reach[blocks - 1] <= since; blocks--)
    (void)PetscArrayzero(q->state + (blocks - 1) * MODE_BLOCK, MODE_BLOCK);
  SlabsStore(q, j, blocks);
  if (blocks)
    StreamRowUp(blocks * MODE_BLOCK, s->factors->r[0], s->factors->r[1], q->zero, q->y + (j - 1) * q->width, q->state,
                q->y + j * q->width);
}

/* n_x nu d_yy of the v that is added to row j between walls, which the pressure balances. */
static PetscReal GivenForce(Stream s, const StreamRows *rows, PetscInt j) {
  const Grid g = s->fluid->grid;
  const PetscInt at = g->first + j;
  const PetscReal below = at > 0 ? StreamGiven(rows, FIELD_V, at - 1) : 0;
  const PetscReal bend = below - 2 * StreamGiven(rows, FIELD_V, at) + StreamGiven(rows, FIELD_V, at + 1);
  return (PetscReal)g->n[0] * s->fluid->nu / PetscSqr(g->h) * bend;
}

/* The way up through row j of nodes; low: the row of u's force below it. Returns the row of u's force above it. */
static const PetscScalar *GatherRow(Stream s, const StreamRows *rows, PetscBool measured, PetscInt j,
                                    const PetscScalar *low, const PetscReal past[], const PetscReal below[]) {
  const PetscInt n = s->fluid->grid->n[0], end = rows->forced[1];
  const PetscScalar *high = s->zero, *v;
  if (j + 1 < end || end == s->fluid->grid->rows[FIELD_U])
    high = rows->force(rows->ctx, FIELD_U, j + 1, s->row[(j + 1) % 2]);
  v = rows->force(rows->ctx, FIELD_V, j, s->row[2]);
  if (!s->fluid->grid->wall[1])
    s->mean_v += StreamRowSum(n, v);
  else if (measured)
    StreamMeterForce(s->meter, j, StreamRowSum(n, v) + GivenForce(s, rows, j));
  ForcedRow(s, j, CurlModes(s, low, high, v, past), below);
  return high;
}

/* The sum over a row of the force of the states before, on u in row j or (comp 1) on v. */
static PetscReal PastSum(Stream s, const StreamRows *rows, PetscInt j, int comp) {
  return rows->past ? (PetscReal)s->fluid->grid->n[0] * StreamFlowsMean(s->flows, j, comp) : 0;
}

/* The way up, with nothing coming in from below. It begins at the nodes below the first row of u with a force. */
void StreamGather(Stream s, const StreamRows *rows, PetscBool measured) {
  const Grid g = s->fluid->grid;
  const Slabs q = s->slabs;
  const PetscInt n = g->n[0], w = q->width, first = PetscMax(rows->forced[0] - 1, 0), end = rows->forced[1];
  const PetscScalar *low = NULL;
  s->mean_v = 0;
  (void)PetscArrayzero(q->state, 2 * w);
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) {
    const PetscBool forced = j >= first && j < end;
    if (forced && !low) low = rows->force(rows->ctx, FIELD_U, j, s->row[j % 2]);
    const PetscReal sum = s->mean ? (forced ? StreamRowSum(n, low) : 0) + PastSum(s, rows, j, 0) : 0;
    if (s->mean) TridiagonalUp(s->mean, j, &sum);
    if (j == q->rows) break; /* no nodes on the upper wall */
    const PetscReal *past = rows->past ? StreamFlowsCurl(s->flows, j) : NULL;
    const PetscReal *below = j > (past ? 0 : first) ? q->y + (j - 1) * w : q->zero;
    if (!g->wall[1]) s->mean_v += PastSum(s, rows, j, 1); /* between walls it is zero */
    if (forced)
      low = GatherRow(s, rows, measured, j, low, past, below);
    else if (past)
      ForcedRow(s, j, past, below);
    else
      FreeRow(s, j, j - end + 1);
  }
  const PetscInt out = q->rows > 0 ? q->stored[q->rows - 1] * MODE_BLOCK : 0;
  if (out) (void)PetscArraycpy(q->state + w, q->y + (q->rows - 1) * w, out);
}
