/* The way down of a solve by stream function: from y = (y1, y2) and what comes into a slab from outside to the stream
   function chi, and from chi to rows of velocity (stream.c has the recurrences). */
#include "fluid/stokes/streamloops.h"
#include "fluid/stokes/streamstate.h"

void StreamBeginDown(Stream s) {
  const Slabs q = s->slabs;
  s->kept = q->width / MODE_BLOCK;
  (void)PetscArraycpy(q->state, q->above, 2 * q->width);
  for (PetscInt b = 0; b < s->kept; b++) s->last[b] = q->rows;
}

/* Blocks of modes in which Z has not decayed in row j, where y has `stored` blocks; Z is zero in the others. */
static PetscInt KeptBlocks(Stream s, PetscInt j, PetscInt stored) {
  const Slabs q = s->slabs;
  PetscInt blocks = PetscMax(s->kept, stored);
  for (PetscInt b = 0; b < stored; b++) s->last[b] = j;
  for (; blocks > stored && s->factors->reach[blocks - 1] <= s->last[blocks - 1] - j; blocks--)
    for (int c = 0; c < 2; c++) (void)PetscArrayzero(q->state + c * q->width + (blocks - 1) * MODE_BLOCK, MODE_BLOCK);
  return blocks;
}

PetscInt StreamNodeModes(Stream s, PetscInt j, PetscBool squares, PetscReal *into, PetscReal **modes) {
  const Slabs q = s->slabs;
  const PetscInt w = q->width, all = s->t->width, stored = j < 0 ? w / MODE_BLOCK : q->stored[j];
  const PetscReal *y = j < 0 ? q->below + w : q->y + j * w;
  s->kept = KeptBlocks(s, j, stored);
  const PetscInt forced = PetscMin(stored * MODE_BLOCK, all), count = PetscMin(s->kept * MODE_BLOCK, all);
  *modes = squares ? StreamMeterNodes(s->meter, count) : into ? into : s->t->modes;
  StreamRowDown(s->factors, forced, count, y, q->state, *modes);
  return count;
}

/* The modes of chi/h in row j of nodes, into the flow that is made or added to it; returns their number. */
static PetscInt FlowModes(Stream s, const StreamRows *rows, PetscInt j, PetscReal **modes) {
  PetscScalar *restrict flow = s->flow + j * s->flows->each;
  const PetscInt count = StreamNodeModes(s, j, PETSC_FALSE, rows->add ? NULL : flow, modes);
  for (PetscInt k = 0; k < count && rows->add; k++) flow[k] += (*modes)[k];
  for (PetscInt k = count; k < s->t->width && !rows->add; k++) flow[k] = 0;
  return count;
}

/* Row j of nodes: the modes of chi/h for the flow and the meter, and, unless `row` is NULL, chi/h itself with the part
   of the states before that the velocity has; chi is zero on the wall behind the last node. */
static void NodeRow(Stream s, const StreamRows *rows, PetscInt j, PetscBool squares, PetscScalar row[]) {
  PetscReal *restrict modes = s->t->modes;
  PetscReal *chi;
  const PetscInt all = s->t->width,
                 count = s->flow && j >= 0 ? FlowModes(s, rows, j, &chi) : StreamNodeModes(s, j, squares, NULL, &chi);
  if (!row) return;
  if (chi != modes) (void)PetscArraycpy(modes, chi, count);
  for (PetscInt k = count; k < all; k++) modes[k] = 0;
  const PetscReal *past = rows->past ? StreamFlowsRow(s->flows, j) : NULL;
  for (PetscInt k = 0; k < all && past; k++) modes[k] = rows->past->part * modes[k] + rows->past->lag * past[k];
  RowTransformBackward(s->t, row);
  if (s->side) row[s->fluid->grid->n[0] - 1] = 0;
}

/* The mean of a row of u, or (comp 1) of v, of the velocity that is returned: of the solution and of the states before.
 */
static PetscReal ReturnedMean(Stream s, const StreamRows *rows, PetscReal mean, PetscInt j, int comp) {
  const StreamPast *past = rows->past;
  return past ? past->part * mean + past->lag * StreamFlowsMean(s->flows, j, comp) : mean;
}

/* A row of u between two rows of nodes, which stays in s->curl, and of v in the upper one. */
static void VelocityRows(Stream s, const StreamRows *rows, PetscBool measured, PetscInt j, const PetscScalar low[],
                         const PetscScalar high[]) {
  const Grid g = s->fluid->grid;
  const PetscInt n = g->n[0], at = g->first + j;
  const PetscReal given = StreamGiven(rows, FIELD_V, at),
                  below = StreamGiven(rows, FIELD_V, (at + g->n[1] - 1) % g->n[1]);
  StreamRowU(n, low, high, ReturnedMean(s, rows, s->means[j], j, 0) + StreamGiven(rows, FIELD_U, at), s->curl);
  rows->velocity(rows->ctx, FIELD_U, j, s->curl);
  if (measured)
    StreamMeterDivergence(s->meter, s->curl, low, high, given - below, rows->source ? rows->source + j * n : NULL);
  if (j >= s->slabs->rows) return;
  StreamRowV(n, high, ReturnedMean(s, rows, s->mean_v, j, 1) + given, s->row[2]);
  rows->velocity(rows->ctx, FIELD_V, j, s->row[2]);
}

/* Add row j of u (`row`; NULL: not made) and the row of v above it to the measures. */
static void MeasureRow(Stream s, const StreamRows *rows, PetscInt j, const PetscScalar row[]) {
  const PetscInt at = s->fluid->grid->first + j;
  const PetscReal mean = s->means[j] + StreamGiven(rows, FIELD_U, at);
  StreamMeterSlip(s->meter, j, mean);
  if (!s->flow)
    StreamMeterSquares(s->meter, j, row, mean, j < s->slabs->rows, s->mean_v + StreamGiven(rows, FIELD_V, at));
}

/* Down all rows, or to the last one that is wanted. */
void StreamScatter(Stream s, const StreamRows *rows, PetscBool measured) {
  const Grid g = s->fluid->grid;
  const PetscInt nodes = s->slabs->rows, first = rows->wanted[0], end = rows->wanted[1];
  const PetscBool squares = measured && !s->flow;
  const PetscScalar *high = s->zero;
  StreamBeginDown(s);
  if (nodes == g->rows[FIELD_U]) { /* not on the upper wall, where chi = 0 */
    high = s->row[nodes % 2];
    NodeRow(s, rows, nodes - 1, squares, nodes <= end ? s->row[nodes % 2] : NULL);
  } else if (squares)
    (void)StreamMeterNodes(s->meter, 0);
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0 && (measured || s->flow || j >= first); j--) {
    const PetscScalar *low = s->row[j % 2];
    if (j > 0 || g->below != MPI_PROC_NULL || !g->wall[1])
      NodeRow(s, rows, j - 1, squares, j >= first && j <= end ? s->row[j % 2] : NULL);
    else {
      low = s->zero;
      if (squares) (void)StreamMeterNodes(s->meter, 0);
    }
    const PetscBool wanted = j >= first && j < end;
    if (wanted) VelocityRows(s, rows, measured, j, low, high);
    if (measured) MeasureRow(s, rows, j, wanted ? s->curl : NULL);
    for (int comp = 0; comp < 2 && s->flow; comp++) { /* the means into the flow, or added to it */
      PetscScalar *mean = s->flow + j * s->flows->each + s->flows->width + comp;
      *mean = (rows->add ? *mean : 0) + (comp ? s->mean_v : s->means[j]);
    }
    high = low;
  }
}
