/* With the decays r1 of -(d_xx + d_yy) and r2 of alpha - nu (d_xx + d_yy) from row to row (tridiagonal.h) and S the
   shift by one row, each Fourier mode of the stream function has

       (nu/(r1 r2 h^4)) (1 - r1 S)(1 - r2 S)(1 - r1 S^-1)(1 - r2 S^-1) chi = curl of the force,

   two recurrences upwards, y1_j = b_j + r1 y1_{j-1}, y2_j = y1_j + r2 y2_{j-1}, and the same downwards from y2 to z1
   and z2, chi = (r1 r2 h^4/nu) z2. A state is a pair, Y = (y1, y2), Z = (z1, z2): with M = [r1 0; r1 r2] Y_j = M
   Y_{j-1} + (b_j, b_j),      Z_j = M Z_{j+1} + (y2_j, y2_j). What comes into a slab of rows is known from what all
   slabs say by themselves, as in tridiagonal.c: Y leaves a slab of m rows as its own and M^m times what came in, Z as
   its own, the gain times Y from below and M^m times Z from above. */
#include "fluid/stream.h"
#include "base/lanes.h"
#include "fluid/streamfactors.h"
#include "fluid/tridiagonal.h"

#define BLOCK TRIDIAGONAL_BLOCK

struct _p_Stream {
  Fluid fluid;
  ZeroFlux flux;            /* borrowed, or NULL */
  RowTransform t;           /* along the nodes of a row */
  StreamFactors factors;    /* of the recurrences */
  PetscInt rows, width;     /* of nodes on this rank; modes, rounded up to whole blocks */
  PetscReal *y;             /* [rows][width] y2, NULL before the first solve */
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
  PetscCall(PetscCalloc3(2 * g->size * w, &s->below, 2 * g->size * w, &s->above, g->rows[FIELD_U], &s->means));
  s->all = s->own;
  if (g->size > 1) PetscCall(PetscCalloc1(g->size * s->message, &s->all));
  for (int k = 0; k < 3; k++) s->row[k] = fftw_alloc_real(n);
  s->curl = fftw_alloc_real(n);
  s->zero = fftw_alloc_real((size_t)PetscMax((PetscInt)n, w));
  PetscCall(PetscArrayzero(s->zero, PetscMax((PetscInt)n, w)));
  s->one[1] = 1 / (PetscReal)n;
  PetscCall(TridiagonalCreate(g, FIELD_U, 1, &s->one[0], &s->one[1], &s->mean));
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
  PetscCall(PetscFree3(s->below, s->above, s->means));
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

/* h times the curl of a force on the nodes of a row: v of the row, u of the rows below and above it. */
static void Curl(PetscInt n, const PetscScalar *restrict low, const PetscScalar *restrict high,
                 const PetscScalar *restrict v, PetscScalar *restrict curl) {
  for (PetscInt i = 0; i + 1 < n; i++) curl[i] = v[i + 1] - v[i] + low[i] - high[i];
  curl[n - 1] = v[0] - v[n - 1] + low[n - 1] - high[n - 1];
}

static PetscReal Sum(PetscInt n, const PetscScalar x[]) {
  Lanes sum[2] = {{0}, {0}};
  PetscReal rest = 0;
  PetscInt i = 0;
  for (; i + 2 * LANES <= n; i += 2 * LANES) {
    sum[0] += LanesAt(x + i);
    sum[1] += LanesAt(x + i + LANES);
  }
  for (; i < n; i++) rest += x[i];
  return LanesSum(sum[0] + sum[1]) + rest;
}

/* One row upwards: y of the row, from its modes b and y of the row below; y1 goes along. */
static void Up(PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2, const PetscReal *restrict b,
               const PetscReal *restrict below, PetscReal *restrict y1, PetscReal *restrict y) {
  for (PetscInt k = 0; k < width; k++) {
    y1[k] = b[k] + r1[k] * y1[k];
    y[k] = y1[k] + r2[k] * below[k];
  }
}

/* One row downwards: its chi, in modes. */
static void Down(PetscInt width, const PetscReal *restrict r1, const PetscReal *restrict r2,
                 const PetscReal *restrict factor, const PetscReal *restrict y, PetscReal *restrict z1,
                 PetscReal *restrict z2, PetscReal *restrict chi) {
  for (PetscInt k = 0; k < width; k++) {
    z1[k] = y[k] + r1[k] * z1[k];
    z2[k] = z1[k] + r2[k] * z2[k];
    chi[k] = factor[k] * z2[k];
  }
}

/* Up all rows, with nothing coming in from below. */
static void Gather(Stream s, const StreamRows *rows) {
  const Grid g = s->fluid->grid;
  const PetscInt n = g->n[0], w = s->width, modes = s->t->width;
  const PetscScalar *low = rows->force(rows->ctx, FIELD_U, 0, s->row[0]), *below = s->zero;
  s->mean_v = 0;
  (void)PetscArrayzero(s->state, 2 * w);
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) {
    const PetscReal sum = Sum(n, low);
    TridiagonalUp(s->mean, j, &sum);
    if (j == s->rows) break; /* no nodes on the upper wall */
    const PetscScalar *high = rows->force(rows->ctx, FIELD_U, j + 1, s->row[(j + 1) % 2]);
    const PetscScalar *v = rows->force(rows->ctx, FIELD_V, j, s->row[2]);
    PetscReal *y = s->y + j * w;
    if (!g->wall[1]) s->mean_v += Sum(n, v);
    Curl(n, low, high, v, s->curl);
    RowTransformForward(s->t, s->curl);
    Up(modes, s->factors->r[0], s->factors->r[1], s->t->modes, below, s->state, y);
    for (PetscInt k = modes; k < w; k++) y[k] = 0;
    below = y;
    low = high;
  }
  (void)PetscArraycpy(s->state + w, below, w);
}

/* What this slab tells the others: its first Z and its last Y, both for nothing coming in from outside. */
static void Summarise(Stream s) {
  const PetscInt w = s->width;
  for (PetscInt b = 0; b < w / BLOCK; b++) {
    const PetscReal *restrict r1 = s->factors->r[0] + b * BLOCK, *restrict r2 = s->factors->r[1] + b * BLOCK;
    PetscReal z1[BLOCK] = {0}, z2[BLOCK] = {0};
    for (PetscInt j = PetscMin(s->factors->reach[b], s->rows) - 1; j >= 0; j--) {
      const PetscReal *restrict y = s->y + j * w + b * BLOCK;
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
      for (int k = 0; k < BLOCK; k++) {
        y1[k] *= r1[k];
        y2[k] = y1[k] + r2[k] * y2[k];
        y[k] += y2[k];
      }
    }
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

/* chi/h in a row of nodes, whose y2 is given. */
static void NodeRow(Stream s, const PetscReal y[], PetscScalar row[]) {
  Down(s->t->width, s->factors->r[0], s->factors->r[1], s->factors->factor, y, s->state, s->state + s->width,
       s->t->modes);
  RowTransformBackward(s->t, row);
}

/* u = d_y chi and v = -d_x chi, of chi/h, and the mean flow. */
static void VelocityU(PetscInt n, const PetscScalar *restrict low, const PetscScalar *restrict high, PetscReal mean,
                      PetscScalar *restrict u) {
  for (PetscInt i = 0; i < n; i++) u[i] = high[i] - low[i] + mean;
}
static void VelocityV(PetscInt n, const PetscScalar *restrict chi, PetscReal mean, PetscScalar *restrict v) {
  v[0] = chi[n - 1] - chi[0] + mean;
  for (PetscInt i = 1; i < n; i++) v[i] = chi[i - 1] - chi[i] + mean;
}

/* Down all rows. */
static void Scatter(Stream s, const StreamRows *rows) {
  const Grid g = s->fluid->grid;
  const PetscInt n = g->n[0], w = s->width;
  const PetscScalar *high = s->zero;
  (void)PetscArraycpy(s->state, s->above + 2 * g->rank * w, 2 * w);
  if (s->rows == g->rows[FIELD_U]) { /* not on the upper wall, where chi = 0 */
    NodeRow(s, s->y + (s->rows - 1) * w, s->row[s->rows % 2]);
    high = s->row[s->rows % 2];
  }
  for (PetscInt j = g->rows[FIELD_U] - 1; j >= 0; j--) {
    const PetscScalar *low = s->row[j % 2];
    if (j > 0)
      NodeRow(s, s->y + (j - 1) * w, s->row[j % 2]);
    else if (g->below != MPI_PROC_NULL || !g->wall[1])
      NodeRow(s, s->below + (2 * g->rank + 1) * w, s->row[0]);
    else
      low = s->zero;
    VelocityU(n, low, high, s->means[j], s->curl);
    rows->velocity(rows->ctx, FIELD_U, j, s->curl);
    if (j < s->rows) {
      VelocityV(n, high, s->mean_v, s->row[2]);
      rows->velocity(rows->ctx, FIELD_V, j, s->row[2]);
    }
    high = low;
  }
}

PetscErrorCode StreamSolve(Stream s, const StreamRows *rows) {
  MPI_Request request;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  PetscCall(SetUp(s));
  Gather(s, rows);
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
  Scatter(s, rows);
  s->fluid->solver[FIELD_P]->solves++;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
