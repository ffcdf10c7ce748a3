/* With the decays r1 of -(d_xx + d_yy) and r2 of alpha - nu (d_xx + d_yy) from row to row (tridiagonal.h) and S the
   shift by one row, each Fourier mode of the stream function has

       (nu/(r1 r2 h^4)) (1 - r1 S)(1 - r2 S)(1 - r1 S^-1)(1 - r2 S^-1) chi = curl of the force,

   two recurrences upwards, y1_j = b_j + r1 y1_{j-1}, y2_j = y1_j + r2 y2_{j-1}, and the same downwards from y2 to z1
   and z2, chi = (r1 r2 h^4/nu) z2. A state is a pair, Y = (y1, y2), Z = (z1, z2): with M = [r1 0; r1 r2] Y_j = M
   Y_{j-1} + (b_j, b_j),      Z_j = M Z_{j+1} + (y2_j, y2_j). What comes into a slab of rows is known from what all
   slabs say by themselves, as in tridiagonal.c: Y leaves a slab of m rows as its own and M^m times what came in, Z as
   its own, the gain times Y from below and M^m times Z from above. */
#include "fluid/stream.h"
#include "fluid/sidewalls.h"
#include "fluid/streamloops.h"
#include "fluid/streamslabs.h"
#include "fluid/tridiagonal.h"

#define BLOCK TRIDIAGONAL_BLOCK
#define KEPT 2 /* numbers that are kept of a row beside modes */

struct _p_Stream {
  Fluid fluid;
  ZeroFlux flux;            /* borrowed, or NULL */
  RowTransform t;           /* along the nodes of a row */
  StreamFactors factors;    /* of the recurrences */
  StreamSlabs slabs;        /* what they leave */
  SideWalls side;           /* NULL where x is periodic */
  PetscInt *fed;            /* [blocks] the last row with y of a block, on the way down */
  PetscInt felt;            /* blocks of Z in the last row */
  PetscScalar *row[3];      /* [n_x] two rows of u's force or of chi, one of v */
  PetscScalar *curl, *zero; /* [n_x] */
  PetscReal *kept;          /* [rows][width + 2] modes of curls, sums of u's force and of v's; NULL before any are */
  Tridiagonal mean;         /* of u's row means: one mode; NULL between walls, where there are none */
  PetscReal one[2];         /* its eigenvalue and its scale */
  PetscReal *means, mean_v; /* [rows of u] mode 0 of u, and of v */
  StreamMeter meter;
};

PetscErrorCode StreamCreate(Fluid f, ZeroFlux flux, Stream *out) {
  const unsigned efforts[] = {FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT};
  const Grid g = f->grid;
  const size_t n = (size_t)g->n[0];
  Stream s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = f;
  s->flux = flux;
  PetscCall(RowTransformCreate(g, g->wall[0] ? FIELD_U : FIELD_P, efforts[f->plan], &s->t));
  PetscCall(RowTransformSort(s->t)); /* what is felt far away comes first */
  PetscCall(StreamFactorsCreate(g, s->t, &s->factors));
  PetscCall(StreamSlabsCreate(g, s->factors, &s->slabs));
  PetscCall(PetscCalloc2(g->rows[FIELD_U], &s->means, s->slabs->width / BLOCK, &s->fed));
  for (int k = 0; k < 5; k++) {
    PetscScalar **line[] = {&s->row[0], &s->row[1], &s->row[2], &s->curl, &s->zero};
    *line[k] = fftw_alloc_real(n);
    PetscCall(PetscArrayzero(*line[k], (PetscInt)n));
  }
  if (g->wall[0]) PetscCall(SideWallsCreate(g, s->t, s->factors, &s->side));
  s->one[1] = 1 / (PetscReal)n;
  if (!g->wall[0]) PetscCall(TridiagonalCreate(g, FIELD_U, 1, &s->one[0], &s->one[1], &s->mean));
  PetscCall(StreamMeterCreate(g, s->t, &s->meter));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamDestroy(Stream *stream) {
  Stream s = *stream;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TridiagonalDestroy(&s->mean));
  PetscCall(SideWallsDestroy(&s->side));
  for (int k = 0; k < 3; k++) fftw_free(s->row[k]);
  fftw_free(s->curl);
  fftw_free(s->zero);
  PetscCall(PetscFree2(s->means, s->fed));
  PetscCall(PetscFree(s->kept));
  PetscCall(StreamMeterDestroy(&s->meter));
  PetscCall(StreamSlabsDestroy(&s->slabs));
  PetscCall(StreamFactorsDestroy(&s->factors));
  PetscCall(RowTransformDestroy(&s->t));
  PetscCall(PetscFree(*stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(Stream s, PetscBool keep) {
  const Fluid f = s->fluid;
  PetscFunctionBeginUser;
  PetscCall(StreamSlabsReserve(s->slabs));
  if (keep && !s->kept) PetscCall(PetscMalloc1(PetscMax(s->slabs->rows, 1) * (s->slabs->width + KEPT), &s->kept));
  if (s->mean) PetscCall(TridiagonalReserve(s->mean));
  if (s->factors->alpha == f->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  StreamFactorsSet(s->factors, f->alpha, f->nu);
  if (s->side) PetscCall(SideWallsSet(s->side, f->alpha, f->nu));
  if (s->mean) PetscCall(TridiagonalSetCoefficients(s->mean, f->alpha, f->nu, f->solver[FIELD_U]->singular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is kept of row j. */
static PetscReal *KeptRow(Stream s, PetscInt j) {
  return s->kept + j * (s->slabs->width + KEPT);
}

/* Whether row j of nodes has the forces of what is kept: u's in row j and above it, v's in row j. What is above the
   last row, or below the first one, may be another rank's. */
static PetscBool IsKept(Stream s, const StreamRows *rows, PetscInt j) {
  if (!rows->changed || j == 0 || j + 1 >= s->slabs->rows) return PETSC_FALSE;
  return j + 1 < rows->changed[0] || j >= rows->changed[1] ? PETSC_TRUE : PETSC_FALSE;
}

/* Modes of the curl of row j's force, u's below and above it and v's. */
static const PetscReal *CurlModes(Stream s, PetscBool keep, PetscInt j, const PetscScalar low[],
                                  const PetscScalar high[], const PetscScalar v[]) {
  Curl(s->fluid->grid->n[0], s->fluid->grid->wall[0], low, high, v, s->curl);
  RowTransformForward(s->t, s->curl);
  if (!keep) return s->t->modes;
  return memcpy(KeptRow(s, j) + KEPT, s->t->modes, (size_t)s->t->width * sizeof(PetscReal));
}

/* y of row j from the modes of its curl, and from y below it. */
static void ForcedRow(Stream s, PetscInt j, const PetscReal curl[], const PetscReal below[]) {
  const StreamSlabs q = s->slabs;
  const PetscInt modes = s->t->width, w = q->width;
  PetscReal *y = q->y + j * w;
  Up(modes, s->factors->r[0], s->factors->r[1], curl, below, q->state, y);
  for (PetscInt k = modes; k < w; k++) y[k] = 0;
  q->alive[j] = w / BLOCK;
}

/* y of row j, which is so many rows above the last force: of the blocks that are still felt. */
static void FreeRow(Stream s, PetscInt j, PetscInt since) {
  const StreamSlabs q = s->slabs;
  PetscInt blocks = j > 0 ? q->alive[j - 1] : 0;
  for (; blocks > 0 && s->factors->reach[blocks - 1] <= since; blocks--)
    (void)PetscArrayzero(q->state + (blocks - 1) * BLOCK, BLOCK);
  q->alive[j] = blocks;
  if (blocks)
    Up(blocks * BLOCK, s->factors->r[0], s->factors->r[1], q->zero, q->y + (j - 1) * q->width, q->state,
       q->y + j * q->width);
}

/* What is added to the mean of row `at` of all. */
static PetscReal Given(const StreamRows *rows, Field f, PetscInt at) {
  return rows->mean[f] ? rows->mean[f][at] : 0;
}

/* n_x nu d_yy of the v that is added to row j between walls: what it is to the pressure. */
static PetscReal GivenForce(Stream s, const StreamRows *rows, PetscInt j) {
  const Grid g = s->fluid->grid;
  const PetscInt at = g->first + j;
  const PetscReal below = at > 0 ? Given(rows, FIELD_V, at - 1) : 0;
  const PetscReal bend = below - 2 * Given(rows, FIELD_V, at) + Given(rows, FIELD_V, at + 1);
  return (PetscReal)g->n[0] * s->fluid->nu / PetscSqr(g->h) * bend;
}

/* The force on v in row j, or its sum. */
static void TakeSum(Stream s, const StreamRows *rows, PetscBool measured, PetscInt j, PetscReal sum) {
  if (!s->fluid->grid->wall[1])
    s->mean_v += sum;
  else if (measured)
    StreamMeterForce(s->meter, j, sum + GivenForce(s, rows, j));
}

/* Row j of nodes, with the row of u's force below it, which is asked for unless it is there; returns the one above. */
static const PetscScalar *GatherRow(Stream s, const StreamRows *rows, PetscBool measured, PetscInt j,
                                    const PetscScalar *low, const PetscReal below[]) {
  const PetscInt n = s->fluid->grid->n[0], end = rows->forced[1];
  const PetscScalar *high = s->zero, *v;
  if (j + 1 < end || end == s->fluid->grid->rows[FIELD_U])
    high = rows->force(rows->ctx, FIELD_U, j + 1, s->row[(j + 1) % 2]);
  v = rows->force(rows->ctx, FIELD_V, j, s->row[2]);
  const PetscReal sum = rows->keep || measured || !s->fluid->grid->wall[1] ? Sum(n, v) : 0;
  if (rows->keep) KeptRow(s, j)[1] = sum;
  TakeSum(s, rows, measured, j, sum);
  ForcedRow(s, j, CurlModes(s, rows->keep, j, low, high, v), below);
  return high;
}

/* Up all rows, with nothing coming in from below. The nodes below the first row of u with a force feel it. */
static void Gather(Stream s, const StreamRows *rows, PetscBool measured) {
  const Grid g = s->fluid->grid;
  const StreamSlabs q = s->slabs;
  const PetscInt n = g->n[0], w = q->width, first = PetscMax(rows->forced[0] - 1, 0), end = rows->forced[1];
  const PetscScalar *low = NULL;
  s->mean_v = 0;
  (void)PetscArrayzero(q->state, 2 * w);
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) {
    const PetscBool forced = j >= first && j < end ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool kept = forced ? IsKept(s, rows, j) : PETSC_FALSE;
    if (forced && !kept && !low) low = rows->force(rows->ctx, FIELD_U, j, s->row[j % 2]);
    const PetscReal sum = !forced || !s->mean ? 0 : kept ? KeptRow(s, j)[0] : Sum(n, low);
    if (s->mean) TridiagonalUp(s->mean, j, &sum);
    if (j == q->rows) break; /* no nodes on the upper wall */
    const PetscReal *below = j > first ? q->y + (j - 1) * w : q->zero;
    if (rows->keep && forced) KeptRow(s, j)[0] = sum;
    if (!forced)
      FreeRow(s, j, j - end + 1);
    else if (kept) {
      TakeSum(s, rows, measured, j, KeptRow(s, j)[1]);
      ForcedRow(s, j, KeptRow(s, j) + KEPT, below);
      low = NULL;
    } else
      low = GatherRow(s, rows, measured, j, low, below);
  }
  const PetscInt felt = q->rows > 0 ? q->alive[q->rows - 1] * BLOCK : 0;
  if (felt) (void)PetscArraycpy(q->state + w, q->y + (q->rows - 1) * w, felt);
}

/* Both means of a box that is periodic both ways to zero. */
static PetscErrorCode HoldMean(Stream s, PetscReal *sum_v) {
  const Grid g = s->fluid->grid;
  PetscReal mean = 0;
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) mean += s->means[j] / g->n[1];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mean, 1, MPIU_REAL, MPI_SUM, g->comm));
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) s->means[j] -= mean;
  *sum_v = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mode 0: the row means of u, and v's, which is the same everywhere, from the sum of its force. */
static PetscErrorCode MeanFlow(Stream s, PetscReal sum) {
  const Grid g = s->fluid->grid;
  PetscFunctionBeginUser;
  PetscCall(TridiagonalEnd(s->mean));
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0; j--) TridiagonalDown(s->mean, j, &s->means[j]);
  if (s->flux) PetscCall(ZeroFluxCorrectMeans(s->flux, s->means));
  if (s->fluid->held) PetscCall(HoldMean(s, &sum));
  s->mean_v = s->fluid->alpha > 0 ? sum / ((PetscReal)g->n[0] * g->n[1] * s->fluid->alpha) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On the way down: what comes in from above. */
static void BeginDown(Stream s) {
  const StreamSlabs q = s->slabs;
  s->felt = q->width / BLOCK;
  (void)PetscArraycpy(q->state, q->above + 2 * s->fluid->grid->rank * q->width, 2 * q->width);
  for (PetscInt b = 0; b < s->felt; b++) s->fed[b] = q->rows;
}

/* Blocks of Z that are felt in row j, where `stored` of them have y: Z is zero beyond. */
static PetscInt FeltBlocks(Stream s, PetscInt j, PetscInt stored) {
  const StreamSlabs q = s->slabs;
  PetscInt blocks = PetscMax(s->felt, stored);
  for (PetscInt b = 0; b < stored; b++) s->fed[b] = j;
  for (; blocks > stored && s->factors->reach[blocks - 1] <= s->fed[blocks - 1] - j; blocks--)
    for (int c = 0; c < 2; c++) (void)PetscArrayzero(q->state + c * q->width + (blocks - 1) * BLOCK, BLOCK);
  return blocks;
}

/* The next row of nodes downwards, j: modes of chi/h, so many. */
static PetscInt NodeModes(Stream s, PetscInt j, PetscBool measured, PetscReal **modes) {
  const StreamSlabs q = s->slabs;
  const PetscInt w = q->width, all = s->t->width, stored = j < 0 ? w / BLOCK : q->alive[j];
  const PetscReal *y = j < 0 ? q->below + (2 * s->fluid->grid->rank + 1) * w : q->y + j * w;
  s->felt = FeltBlocks(s, j, stored);
  const PetscInt fed = PetscMin(stored * BLOCK, all), count = PetscMin(s->felt * BLOCK, all);
  *modes = measured ? StreamMeterNodes(s->meter, count) : s->t->modes;
  Down(fed, s->factors->r[0], s->factors->r[1], s->factors->factor, y, q->state, q->state + w, *modes);
  DownFree(fed, count, s->factors->r[0], s->factors->r[1], s->factors->factor, q->state, q->state + w, *modes);
  return count;
}

/* The same, with chi/h in `row` unless that is NULL; zero on the wall behind the last node. */
static void NodeRow(Stream s, PetscInt j, PetscBool measured, PetscScalar row[]) {
  const PetscInt modes = s->t->width;
  PetscReal *chi;
  const PetscInt count = NodeModes(s, j, measured, &chi);
  if (!row) return;
  if (measured) (void)PetscArraycpy(s->t->modes, chi, count);
  for (PetscInt k = count; k < modes; k++) s->t->modes[k] = 0;
  RowTransformBackward(s->t, row);
  if (s->side) row[s->fluid->grid->n[0] - 1] = 0;
}

/* v on the faces next to walls in x, in all own rows. */
static void SideVelocity(Stream s, const StreamRows *rows) {
  const PetscInt first = s->fluid->grid->first;
  BeginDown(s);
  for (PetscInt j = s->slabs->rows - 1; j >= 0; j--) {
    PetscReal *chi;
    const PetscInt count = NodeModes(s, j, PETSC_FALSE, &chi);
    for (int side = 0; side < 2; side++)
      s->side->v[side][first + j] = Dot(count, s->side->velocity[side], chi) + Given(rows, FIELD_V, first + j);
  }
}

/* y += that of the forces on these faces, with nothing coming in from below; `state` as after Gather. */
static void AddSideForces(Stream s, PetscBool measured) {
  const StreamSlabs q = s->slabs;
  const SideWalls side = s->side;
  const PetscInt w = q->width, first = s->fluid->grid->first;
  (void)PetscArrayzero(q->state, 2 * w);
  for (PetscInt j = 0; j < q->rows; j++) {
    const PetscReal force[2] = {side->d[0][first + j], side->d[1][first + j]};
    const PetscInt stored = q->alive[j] * BLOCK;
    if (measured) StreamMeterForce(s->meter, j, force[0] + force[1]);
    (void)PetscArrayzero(q->y + j * w + stored, w - stored);
    q->alive[j] = w / BLOCK;
    UpWalls(w, s->factors->r[0], s->factors->r[1], force, side->curl[0], side->curl[1], q->state, q->state + w,
            q->y + j * w);
  }
}

/* Walls in x hold the fluid: what came in is taken off y again, their forces are added, and all is closed anew. */
static PetscErrorCode HoldSides(Stream s, const StreamRows *rows, PetscBool measured) {
  const StreamSlabs q = s->slabs;
  const PetscReal *last = q->own + 2 * q->width;
  PetscReal none = 0;
  PetscFunctionBeginUser;
  SideVelocity(s, rows);
  PetscCall(SideWallsForces(s->side, s->fluid->nu));
  StreamSlabsReopen(q);
  AddSideForces(s, measured);
  for (PetscInt k = 0; k < 2 * q->width; k++) q->state[k] += last[k];
  PetscCall(StreamSlabsClose(q, &none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of u between two rows of nodes, which stays in s->curl, and of v in the upper one. */
static void VelocityRows(Stream s, const StreamRows *rows, PetscBool measured, PetscInt j, const PetscScalar low[],
                         const PetscScalar high[]) {
  const Grid g = s->fluid->grid;
  const PetscInt n = g->n[0], at = g->first + j;
  const PetscReal given = Given(rows, FIELD_V, at), below = Given(rows, FIELD_V, (at + g->n[1] - 1) % g->n[1]);
  VelocityU(n, low, high, s->means[j] + Given(rows, FIELD_U, at), s->curl);
  rows->velocity(rows->ctx, FIELD_U, j, s->curl);
  if (measured)
    StreamMeterDivergence(s->meter, s->curl, low, high, given - below, rows->source ? rows->source + j * n : NULL);
  if (j >= s->slabs->rows) return;
  VelocityV(n, high, s->mean_v + given, s->row[2]);
  rows->velocity(rows->ctx, FIELD_V, j, s->row[2]);
}

/* Down all rows, or to the last one that is wanted. */
static void Scatter(Stream s, const StreamRows *rows, PetscBool measured) {
  const Grid g = s->fluid->grid;
  const PetscInt nodes = s->slabs->rows, first = rows->wanted[0], end = rows->wanted[1];
  const PetscScalar *high = s->zero;
  BeginDown(s);
  if (nodes == g->rows[FIELD_U]) { /* not on the upper wall, where chi = 0 */
    high = s->row[nodes % 2];
    NodeRow(s, nodes - 1, measured, nodes <= end ? s->row[nodes % 2] : NULL);
  } else if (measured)
    (void)StreamMeterNodes(s->meter, 0);
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0 && (measured || j >= first); j--) {
    const PetscScalar *low = s->row[j % 2];
    if (j > 0 || g->below != MPI_PROC_NULL || !g->wall[1])
      NodeRow(s, j - 1, measured, j >= first && j <= end ? s->row[j % 2] : NULL);
    else {
      low = s->zero;
      if (measured) (void)StreamMeterNodes(s->meter, 0);
    }
    const PetscBool wanted = j >= first && j < end ? PETSC_TRUE : PETSC_FALSE;
    if (wanted) VelocityRows(s, rows, measured, j, low, high);
    if (measured)
      StreamMeterSquares(s->meter, j, wanted ? s->curl : NULL, s->means[j] + Given(rows, FIELD_U, g->first + j),
                         j < nodes ? PETSC_TRUE : PETSC_FALSE, s->mean_v + Given(rows, FIELD_V, g->first + j));
    high = low;
  }
}

PetscErrorCode StreamSolve(Stream s, const StreamRows *rows, StreamMeasures *measures) {
  const PetscBool measured = measures ? PETSC_TRUE : PETSC_FALSE;
  PetscReal sum;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  PetscCall(SetUp(s, rows->keep));
  if (measured) StreamMeterBegin(s->meter);
  Gather(s, rows, measured);
  if (s->mean) PetscCall(TridiagonalBegin(s->mean));
  sum = s->mean_v;
  PetscCall(StreamSlabsClose(s->slabs, &sum));
  if (s->mean) PetscCall(MeanFlow(s, sum));
  if (s->side) PetscCall(HoldSides(s, rows, measured));
  Scatter(s, rows, measured);
  if (measured) PetscCall(StreamMeterEnd(s->meter, measures));
  s->fluid->solver[FIELD_P]->solves++;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
