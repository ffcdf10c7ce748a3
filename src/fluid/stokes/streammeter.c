#include "fluid/stokes/streammeter.h"
#include "fluid/stokes/streamloops.h"

PetscErrorCode StreamMeterCreate(Grid g, RowTransform t, StreamMeter *out) {
  StreamMeter m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->grid = g;
  m->width = t->width;
  PetscCall(PetscCalloc4(t->width + LANES, &m->chi[0], t->width + LANES, &m->chi[1], t->width + LANES, &m->norm[0],
                         t->width + LANES, &m->norm[1]));
  PetscCall(RowTransformNorms(t, m->norm[0]));
  for (PetscInt k = 0; k < t->width; k++) m->norm[1][k] = t->lambda[k] * m->norm[0][k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamMeterDestroy(StreamMeter *meter) {
  PetscFunctionBeginUser;
  if (!*meter) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4((*meter)->chi[0], (*meter)->chi[1], (*meter)->norm[0], (*meter)->norm[1]));
  PetscCall(PetscFree(*meter));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void StreamMeterBegin(StreamMeter m) {
  m->own = (StreamMeasures){0};
  for (int k = 0; k < 2; k++) (void)StreamMeterNodes(m, 0);
}

PetscErrorCode StreamMeterEnd(StreamMeter m, StreamMeasures *all) {
  PetscReal sum[4] = {m->own.square, m->own.slip, m->own.pressure, m->own.past};
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, m->grid->comm));
  PetscCallMPI(MPI_Allreduce(&m->own.divergence, &all->divergence, 1, MPIU_REAL, MPI_MAX, m->grid->comm));
  all->square = sum[0];
  all->slip = sum[1];
  all->pressure = sum[2];
  all->past = sum[3];
  if (PetscIsInfOrNanReal(sum[0] + sum[3])) all->divergence = NAN; /* MPI_MAX may lose a NaN */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean of v is zero in all rows, so that the mean of its force is the step of the pressure from row j to the next.
 */
void StreamMeterForce(StreamMeter m, PetscInt j, PetscReal sum) {
  const Grid g = m->grid;
  const PetscInt above = g->n[1] - 1 - (g->first + j); /* rows of cells, which have the step in them */
  m->own.pressure += g->h * sum / (PetscReal)g->n[0] * (0.5 - above / (PetscReal)g->n[1]);
}

PetscReal *StreamMeterNodes(StreamMeter m, PetscInt count) {
  m->now = 1 - m->now;
  for (PetscInt k = count; k < m->count[m->now]; k++) m->chi[m->now][k] = 0;
  m->count[m->now] = count;
  return m->chi[m->now];
}

void StreamMeterSlip(StreamMeter m, PetscInt j, PetscReal mean_u) {
  const Grid g = m->grid;
  if (!(g->first + j)) m->own.slip += mean_u;
  if (g->first + j == g->n[1] - 1) m->own.slip -= mean_u;
}

/* By Parseval's theorem. A row of v has no other mean than what is added to it; a row of u between walls in x has none.
 */
void StreamMeterSquares(StreamMeter m, PetscInt j, const PetscScalar row[], PetscReal mean_u, PetscBool has_v,
                        PetscReal mean_v) {
  const Grid g = m->grid;
  const PetscReal *low = m->chi[m->now], *high = m->chi[1 - m->now];
  const PetscInt count = PetscMax(m->count[0], m->count[1]);
  Lanes u = {0}, v = {0};
  for (PetscInt k = 0; k < count; k += LANES) {
    const Lanes of_u = LanesAt(high + k) - LanesAt(low + k), chi = LanesAt(high + k);
    u += LanesAt(m->norm[0] + k) * of_u * of_u;
    v += LanesAt(m->norm[1] + k) * chi * chi;
  }
  m->own.square += row ? LanesDot(g->n[0], row, row) : LanesSum(u) + (PetscReal)g->n[0] * PetscSqr(mean_u);
  if (has_v) m->own.square += LanesSum(v) + (PetscReal)g->n[0] * PetscSqr(mean_v);
}

void StreamMeterDivergence(StreamMeter m, const PetscScalar u[], const PetscScalar low[], const PetscScalar high[],
                           PetscReal rise, const PetscScalar source[]) {
  const PetscInt n = m->grid->n[0];
  const PetscReal h = m->grid->h;
  PetscReal most = m->own.divergence * h;
  Lanes four = {0};
  PetscInt i = 1;
  for (; i + LANES <= n; i += LANES) {
    const PetscInt last = i - 1;
    Lanes d = LanesAt(u + i) - LanesAt(u + last) + (LanesAt(high + last) - LanesAt(high + i)) -
              (LanesAt(low + last) - LanesAt(low + i)) + rise;
    if (source) d += h * LanesAt(source + i);
    four = LanesMax(four, LanesMax(d, -d));
  }
  for (int k = 0; k < LANES; k++) most = PetscMax(most, four[k]);
  for (PetscInt k = n; k >= i; k--) { /* the last cells of the row, and the first one */
    const PetscInt at = k > i ? k - 1 : 0, last = at ? at - 1 : n - 1;
    const PetscReal d = u[at] - u[last] + (high[last] - high[at]) - (low[last] - low[at]) + rise;
    most = PetscMax(most, PetscAbsReal(source ? d + h * source[at] : d));
  }
  m->own.divergence = most / h;
}
