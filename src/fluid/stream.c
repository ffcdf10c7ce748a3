/* With the decays r1 of -(d_xx + d_yy) and r2 of alpha - nu (d_xx + d_yy) from row to row (tridiagonal.h) and S the
   shift by one row, each Fourier mode of the stream function has

       (nu/(r1 r2 h^4)) (1 - r1 S)(1 - r2 S)(1 - r1 S^-1)(1 - r2 S^-1) chi = curl of the force,

   two recurrences upwards, y1_j = b_j + r1 y1_{j-1}, y2_j = y1_j + r2 y2_{j-1}, and the same downwards from y2 to z1
   and z2, chi = (r1 r2 h^4/nu) z2. A state is a pair, Y = (y1, y2), Z = (z1, z2): with M = [r1 0; r1 r2] Y_j = M
   Y_{j-1} + (b_j, b_j),      Z_j = M Z_{j+1} + (y2_j, y2_j). What comes into a slab of rows is known from what all
   slabs say by themselves, as in tridiagonal.c: Y leaves a slab of m rows as its own and M^m times what came in, Z as
   its own, the gain times Y from below and M^m times Z from above. */
#include "fluid/stream.h"
#include "fluid/streamfactors.h"
#include "fluid/streamloops.h"
#include "fluid/tridiagonal.h"

#define BLOCK TRIDIAGONAL_BLOCK

struct _p_Stream {
  Fluid fluid;
  ZeroFlux flux;            /* borrowed, or NULL */
  RowTransform t;           /* along the nodes of a row */
  StreamFactors factors;    /* of the recurrences */
  PetscInt rows, width;     /* of nodes on this rank; modes, rounded up to whole blocks */
  PetscReal *y;             /* [rows][width] y2, NULL before the first solve, */
  PetscInt *alive;          /* [rows] of whose blocks of modes so many are stored; the others are zero */
  PetscInt *fed;            /* [blocks] the last row with y of a block, on the way down */
  PetscReal *state;         /* [2][width] Y on the way up, then Z on the way down */
  PetscReal *below, *above; /* [ranks][2][width] Y below each slab, Z above it */
  PetscReal *last, *first;  /* [2][width] Y above all rows, Z in the first one */
  PetscReal *own, *all;     /* [message], [ranks][message] first Z, last Y, sum of v's force */
  PetscInt message;         /* numbers of it */
  PetscScalar *row[3];      /* [n_x] two rows of u's force or of chi, one of v */
  PetscScalar *curl, *zero; /* [n_x] */
  Tridiagonal mean;         /* of u's row means: one mode */
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
  s->rows = g->rows[FIELD_V]; /* nodes are level with v */
  PetscCall(RowTransformCreate(g, FIELD_P, efforts[f->plan], &s->t));
  PetscCall(StreamFactorsCreate(g, s->t, &s->factors));
  const PetscInt w = s->width = s->factors->width;
  s->message = 4 * w + 1;
  PetscCall(PetscCalloc4(2 * w, &s->state, 2 * w, &s->last, 2 * w, &s->first, s->message, &s->own));
  PetscCall(PetscCalloc5(2 * g->size * w, &s->below, 2 * g->size * w, &s->above, g->rows[FIELD_U], &s->means, s->rows,
                         &s->alive, w / BLOCK, &s->fed));
  s->all = s->own;
  if (g->size > 1) PetscCall(PetscCalloc1(g->size * s->message, &s->all));
  for (int k = 0; k < 3; k++) s->row[k] = fftw_alloc_real(n);
  s->curl = fftw_alloc_real(n);
  s->zero = fftw_alloc_real((size_t)PetscMax((PetscInt)n, w));
  PetscCall(PetscArrayzero(s->zero, PetscMax((PetscInt)n, w)));
  s->one[1] = 1 / (PetscReal)n;
  PetscCall(TridiagonalCreate(g, FIELD_U, 1, &s->one[0], &s->one[1], &s->mean));
  PetscCall(StreamMeterCreate(g, s->t, &s->meter));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StreamDestroy(Stream *stream) {
  Stream s = *stream;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TridiagonalDestroy(&s->mean));
  for (int k = 0; k < 3; k++) fftw_free(s->row[k]);
  fftw_free(s->curl);
  fftw_free(s->zero);
  if (s->fluid->grid->size > 1) PetscCall(PetscFree(s->all));
  PetscCall(PetscFree4(s->state, s->last, s->first, s->own));
  PetscCall(PetscFree5(s->below, s->above, s->means, s->alive, s->fed));
  PetscCall(StreamMeterDestroy(&s->meter));
  PetscCall(PetscFree(s->y));
  PetscCall(StreamFactorsDestroy(&s->factors));
  PetscCall(RowTransformDestroy(&s->t));
  PetscCall(PetscFree(*stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(Stream s) {
  const Fluid f = s->fluid;
  PetscFunctionBeginUser;
  if (!s->y) PetscCall(PetscMalloc1(PetscMax(s->rows, 1) * s->width, &s->y));
  PetscCall(TridiagonalReserve(s->mean));
  if (s->factors->alpha == f->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  StreamFactorsSet(s->factors, f->alpha, f->nu);
  PetscCall(TridiagonalSetCoefficients(s->mean, f->alpha, f->nu, f->solver[FIELD_U]->singular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y of row j from its force, u's below and above it and v's, and from y below it. */
static void ForcedRow(Stream s, PetscInt j, const PetscScalar low[], const PetscScalar high[], const PetscScalar v[],
                      const PetscReal below[]) {
  const PetscInt modes = s->t->width, w = s->width;
  PetscReal *y = s->y + j * w;
  Curl(s->fluid->grid->n[0], low, high, v, s->curl);
  RowTransformForward(s->t, s->curl);
  Up(modes, s->factors->r[0], s->factors->r[1], s->t->modes, below, s->state, y);
  for (PetscInt k = modes; k < w; k++) y[k] = 0;
  s->alive[j] = w / BLOCK;
}

/* y of row j, which is so many rows above the last force: of the blocks that are still felt. */
static void FreeRow(Stream s, PetscInt j, PetscInt since) {
  PetscInt blocks = j > 0 ? s->alive[j - 1] : 0;
  for (; blocks > 0 && s->factors->reach[blocks - 1] <= since; blocks--)
    (void)PetscArrayzero(s->state + (blocks - 1) * BLOCK, BLOCK);
  s->alive[j] = blocks;
  if (blocks)
    Up(blocks * BLOCK, s->factors->r[0], s->factors->r[1], s->zero, s->y + (j - 1) * s->width, s->state,
       s->y + j * s->width);
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

/* Up all rows, with nothing coming in from below. The nodes below the first row of u with a force feel it. */
static void Gather(Stream s, const StreamRows *rows, PetscBool measured) {
  const Grid g = s->fluid->grid;
  const PetscInt n = g->n[0], w = s->width, first = PetscMax(rows->forced[0] - 1, 0), end = rows->forced[1];
  const PetscScalar *low = s->zero, *high;
  s->mean_v = 0;
  (void)PetscArrayzero(s->state, 2 * w);
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++, low = high) {
    const PetscBool forced = j >= first && j < end ? PETSC_TRUE : PETSC_FALSE;
    if (forced && j == first) low = rows->force(rows->ctx, FIELD_U, j, s->row[j % 2]);
    const PetscReal sum = forced ? Sum(n, low) : 0;
    TridiagonalUp(s->mean, j, &sum);
    high = s->zero;
    if (j == s->rows) break; /* no nodes on the upper wall */
    if (!forced) {
      FreeRow(s, j, j - end + 1);
      continue;
    }
    if (j + 1 < end || end == g->rows[FIELD_U]) high = rows->force(rows->ctx, FIELD_U, j + 1, s->row[(j + 1) % 2]);
    const PetscScalar *v = rows->force(rows->ctx, FIELD_V, j, s->row[2]);
    if (!g->wall[1])
      s->mean_v += Sum(n, v);
    else if (measured)
      StreamMeterForce(s->meter, j, Sum(n, v) + GivenForce(s, rows, j));
    ForcedRow(s, j, low, high, v, j > first ? s->y + (j - 1) * w : s->zero);
  }
  const PetscInt felt = s->rows > 0 ? s->alive[s->rows - 1] * BLOCK : 0;
  if (felt) (void)PetscArraycpy(s->state + w, s->y + (s->rows - 1) * w, felt);
}

/* What this slab tells the others: its first Z and its last Y, both for nothing coming in from outside. */
static void Summarise(Stream s) {
  const PetscInt w = s->width;
  for (PetscInt b = 0; b < w / BLOCK; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal z1[BLOCK] = {0}, z2[BLOCK] = {0};
    PetscInt j = PetscMin(s->factors->reach[b], s->rows) - 1;
    while (j >= 0 && s->alive[j] <= b) j--;
    for (; j >= 0; j--) {
      const PetscReal *restrict y = s->alive[j] > b ? s->y + j * w + b * BLOCK : s->zero;
      for (int k = 0; k < BLOCK; k++) {
        z1[k] = y[k] + r1[k] * z1[k];
        z2[k] = z1[k] + r2[k] * z2[k];
      }
    }
    (void)PetscArraycpy(s->own + b * BLOCK, z1, BLOCK);
    (void)PetscArraycpy(s->own + w + b * BLOCK, z2, BLOCK);
  }
  (void)PetscArraycpy(s->own + 2 * w, s->state, 2 * w);
  s->own[4 * w] = s->mean_v;
}

/* out += A in, a matrix and a pair a mode. */
static void AddProduct(PetscInt w, const PairMatrix A, const PetscReal in[], PetscReal out[]) {
  for (PetscInt k = 0; k < w; k++) {
    out[k] += A[k] * in[k] + A[w + k] * in[w + k];
    out[w + k] += A[2 * w + k] * in[k] + A[3 * w + k] * in[w + k];
  }
}

static void Product(PetscInt w, const PairMatrix A, const PetscReal in[], PetscReal out[]) {
  (void)PetscArrayzero(out, 2 * w);
  AddProduct(w, A, in, out);
}

/* From Y below the first slab to Y below every slab and above the last. */
static void CarryUp(Stream s) {
  const PetscMPIInt size = s->fluid->grid->size;
  const PetscInt w = s->width;
  for (PetscMPIInt q = 0; q < size; q++) {
    PetscReal *out = q + 1 < size ? s->below + 2 * (q + 1) * w : s->last;
    (void)PetscArraycpy(out, s->all + q * s->message + 2 * w, 2 * w);
    AddProduct(w, s->factors->power[q == size - 1], s->below + 2 * q * w, out);
  }
}

/* From Z above the last slab to Z above every slab and in the first row of all. */
static void CarryDown(Stream s) {
  const PetscMPIInt size = s->fluid->grid->size;
  const PetscInt w = s->width;
  for (PetscMPIInt q = size - 1; q >= 0; q--) {
    PetscReal *out = q > 0 ? s->above + 2 * (q - 1) * w : s->first;
    (void)PetscArraycpy(out, s->all + q * s->message, 2 * w);
    AddProduct(w, s->factors->gain[q == size - 1], s->below + 2 * q * w, out);
    AddProduct(w, s->factors->power[q == size - 1], s->above + 2 * q * w, out);
  }
}

/* What comes into every slab. Walls: Z above all rows follows from Y there, and Y below them from Z for nothing coming
   in at the bottom. Seam: Y below follows from Y above for nothing coming in, then Z likewise (streamfactors.c). */
static void Close(Stream s) {
  const PetscInt w = s->width;
  PetscReal *Y = s->below, *Z = s->above + 2 * (s->fluid->grid->size - 1) * w;
  (void)PetscArrayzero(Y, 2 * w);
  CarryUp(s);
  if (s->fluid->grid->wall[1]) {
    Product(w, s->factors->top, s->last, Z);
    CarryDown(s);
    Product(w, s->factors->bottom, s->first, Y);
    CarryUp(s);
    Product(w, s->factors->top, s->last, Z);
  } else {
    Product(w, s->factors->bottom, s->last, Y);
    CarryUp(s);
    (void)PetscArrayzero(Z, 2 * w);
    CarryDown(s);
    Product(w, s->factors->top, s->first, Z);
  }
  CarryDown(s);
}

/* y2 of the rows += what Y from below becomes there. */
static void AddBelow(Stream s, const PetscReal below[]) {
  const PetscInt w = s->width;
  for (PetscInt b = 0; b < w / BLOCK; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal y1[BLOCK], y2[BLOCK];
    (void)PetscArraycpy(y1, below + b * BLOCK, BLOCK);
    (void)PetscArraycpy(y2, below + w + b * BLOCK, BLOCK);
    for (PetscInt j = 0; j < PetscMin(s->factors->reach[b], s->rows); j++) {
      PetscReal *restrict y = s->y + j * w + b * BLOCK;
      if (s->alive[j] <= b) (void)PetscArrayzero(y, BLOCK);
      for (int k = 0; k < BLOCK; k++) {
        y1[k] *= r1[k];
        y2[k] = y1[k] + r2[k] * y2[k];
        y[k] += y2[k];
      }
    }
  }
  for (PetscInt j = 0, b = w / BLOCK; j < s->rows; j++) {
    while (b > 0 && s->factors->reach[b - 1] <= j) b--;
    s->alive[j] = PetscMax(s->alive[j], b);
  }
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

/* Mode 0: the row means of u, and v's, which is the same everywhere. */
static PetscErrorCode MeanFlow(Stream s) {
  const Grid g = s->fluid->grid;
  PetscReal sum = 0;
  PetscFunctionBeginUser;
  PetscCall(TridiagonalEnd(s->mean));
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0; j--) TridiagonalDown(s->mean, j, &s->means[j]);
  if (s->flux) PetscCall(ZeroFluxCorrectMeans(s->flux, s->means));
  for (PetscMPIInt q = 0; q < g->size; q++) sum += s->all[q * s->message + 4 * s->width];
  if (s->fluid->held) PetscCall(HoldMean(s, &sum));
  s->mean_v = s->fluid->alpha > 0 ? sum / ((PetscReal)g->n[0] * g->n[1] * s->fluid->alpha) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks of Z that are felt in row j, where `stored` of them have y: Z is zero beyond. */
static PetscInt FeltBlocks(Stream s, PetscInt j, PetscInt stored, PetscInt before) {
  PetscInt blocks = PetscMax(before, stored);
  for (PetscInt b = 0; b < stored; b++) s->fed[b] = j;
  for (; blocks > stored && s->factors->reach[blocks - 1] <= s->fed[blocks - 1] - j; blocks--)
    for (int c = 0; c < 2; c++) (void)PetscArrayzero(s->state + c * s->width + (blocks - 1) * BLOCK, BLOCK);
  return blocks;
}

/* The next row of nodes downwards, j: chi/h in `row` unless that is NULL. felt: blocks of Z in the row before, then in
   this one. */
static void NodeRow(Stream s, PetscInt j, PetscBool measured, PetscInt *felt, PetscScalar row[]) {
  const PetscInt w = s->width, modes = s->t->width, stored = j < 0 ? w / BLOCK : s->alive[j];
  const PetscReal *y = j < 0 ? s->below + (2 * s->fluid->grid->rank + 1) * w : s->y + j * w;
  *felt = FeltBlocks(s, j, stored, *felt);
  const PetscInt fed = PetscMin(stored * BLOCK, modes), count = PetscMin(*felt * BLOCK, modes);
  PetscReal *chi = measured ? StreamMeterNodes(s->meter, count) : s->t->modes;
  Down(fed, s->factors->r[0], s->factors->r[1], s->factors->factor, y, s->state, s->state + w, chi);
  DownFree(fed, count, s->factors->r[0], s->factors->r[1], s->factors->factor, s->state, s->state + w, chi);
  if (!row) return;
  if (measured) (void)PetscArraycpy(s->t->modes, chi, count);
  for (PetscInt k = count; k < modes; k++) s->t->modes[k] = 0;
  RowTransformBackward(s->t, row);
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
  if (j >= s->rows) return;
  VelocityV(n, high, s->mean_v + given, s->row[2]);
  rows->velocity(rows->ctx, FIELD_V, j, s->row[2]);
}

/* Down all rows, or to the last one that is wanted. */
static void Scatter(Stream s, const StreamRows *rows, PetscBool measured) {
  const Grid g = s->fluid->grid;
  const PetscInt w = s->width, first = rows->wanted[0], end = rows->wanted[1];
  const PetscScalar *high = s->zero;
  PetscInt felt = w / BLOCK;
  (void)PetscArraycpy(s->state, s->above + 2 * g->rank * w, 2 * w);
  for (PetscInt b = 0; b < felt; b++) s->fed[b] = s->rows;
  if (s->rows == g->rows[FIELD_U]) { /* not on the upper wall, where chi = 0 */
    high = s->row[s->rows % 2];
    NodeRow(s, s->rows - 1, measured, &felt, s->rows <= end ? s->row[s->rows % 2] : NULL);
  } else if (measured)
    (void)StreamMeterNodes(s->meter, 0);
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0 && (measured || j >= first); j--) {
    const PetscScalar *low = s->row[j % 2];
    if (j > 0 || g->below != MPI_PROC_NULL || !g->wall[1])
      NodeRow(s, j - 1, measured, &felt, j >= first && j <= end ? s->row[j % 2] : NULL);
    else {
      low = s->zero;
      if (measured) (void)StreamMeterNodes(s->meter, 0);
    }
    const PetscBool wanted = j >= first && j < end ? PETSC_TRUE : PETSC_FALSE;
    if (wanted) VelocityRows(s, rows, measured, j, low, high);
    if (measured)
      StreamMeterSquares(s->meter, j, wanted ? s->curl : NULL, s->means[j] + Given(rows, FIELD_U, g->first + j),
                         j < s->rows ? PETSC_TRUE : PETSC_FALSE, s->mean_v + Given(rows, FIELD_V, g->first + j));
    high = low;
  }
}

PetscErrorCode StreamSolve(Stream s, const StreamRows *rows, StreamMeasures *measures) {
  const PetscBool measured = measures ? PETSC_TRUE : PETSC_FALSE;
  MPI_Request request;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  PetscCall(SetUp(s));
  if (measured) StreamMeterBegin(s->meter);
  Gather(s, rows, measured);
  PetscCall(TridiagonalBegin(s->mean));
  Summarise(s);
  if (s->fluid->grid->size > 1) {
    PetscCallMPI(MPI_Iallgather(s->own, (PetscMPIInt)s->message, MPIU_REAL, s->all, (PetscMPIInt)s->message, MPIU_REAL,
                                s->fluid->grid->comm, &request));
    PetscCallMPI(MPI_Wait(&request, MPI_STATUS_IGNORE));
  }
  PetscCall(MeanFlow(s));
  Close(s);
  AddBelow(s, s->below + 2 * s->fluid->grid->rank * s->width);
  Scatter(s, rows, measured);
  if (measured) PetscCall(StreamMeterEnd(s->meter, measures));
  s->fluid->solver[FIELD_P]->solves++;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
