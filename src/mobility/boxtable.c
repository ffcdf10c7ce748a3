#include "mobility/boxtable.h"
#include "base/lanes.h"
#include "numerics/blas.h"

#define WALL_MARGIN 0.5 /* cells of the coarser grid between the places and a wall */
#define PLACES 16       /* between two walls */
#define MIDDLE_PLACES 8 /* in the middle half of the box, far from walls */
#define MODES 16        /* modes kept over a period that is as long as the other side */
#define COARSE_CELLS 64 /* least and most cells of the shorter side on the coarser grid of a large one */
#define MOST_CELLS 80
#define RATIO_CELLS 48 /* cells of the shorter side from which on the ratio of the pair is 3/2 */
#define FEW_CELLS 24   /* cells of the shorter side below which the ratio is 3 */
#define SMALLEST 5e-4  /* part of the largest eigenvalue below which eigenvalues are dropped */

/* The coarser grid, its cells square: the run's own or, where that has more than COARSE_CELLS across, the fewest from
   there up to MOST_CELLS that fit the box, or else fit it best: within a half of 1/COARSE_CELLS, which D is smooth
   enough for. */
static void CoarseCells(const FluidSpec *spec, PetscInt cells[2]) {
  const int across = spec->cells[0] <= spec->cells[1] ? 0 : 1;
  const PetscInt shorter = spec->cells[across], longer = spec->cells[1 - across];
  PetscReal best = PETSC_MAX_REAL;
  for (PetscInt n = PetscMin(COARSE_CELLS, shorter); n <= PetscMin(MOST_CELLS, shorter) && best > 0; n++) {
    const PetscInt m = (2 * n * longer + shorter) / (2 * shorter); /* rounded */
    const PetscReal misfit = PetscAbsReal((PetscReal)(m * shorter - n * longer) / (n * longer));
    if (misfit >= best) continue;
    best = misfit;
    cells[across] = n;
    cells[1 - across] = m;
  }
}

static void MakeAxis(const FluidSpec *spec, int dir, PetscReal H, PetscBool middle, BoxAxis *a) {
  const PetscInt shorter = PetscMin(spec->cells[0], spec->cells[1]), times = (spec->cells[dir] + shorter - 1) / shorter;
  const PetscReal low = spec->box[2 * dir], high = spec->box[2 * dir + 1];
  const PetscReal margin = PetscMax(WALL_MARGIN * H, middle ? 0.25 * (high - low) : 0);
  if (spec->bc[dir] == BC_WALL) {
    BoxAxisChebyshev(middle ? MIDDLE_PLACES : PLACES, low + margin, high - margin, a);
    return;
  }
  BoxAxisPeriodic(times * (BOX_PLACES / FLUID_LONGEST_PERIOD), times * MODES, low, high, a);
}

/* Between walls: nearer to one than the table reaches, of the straight line on from its end. */
static void WallFunctions(const BoxTable *t, int dir, PetscReal x, PetscReal values[]) {
  const BoxAxis *a = &t->axis[dir];
  const PetscReal inner = PetscMax(a->low, PetscMin(a->high, x));
  PetscReal next[BOX_WALL_PLACES];
  BoxAxisPolynomials(a, inner, values);
  if (inner == x) return;
  BoxAxisPolynomials(a, inner == a->low ? a->low + t->H : a->high - t->H, next);
  const PetscReal part = -PetscAbsReal(x - inner) / t->H;
  for (PetscInt f = 0; f < a->places; f++) values[f] += part * (next[f] - values[f]);
}

void BoxTableFunctions(const BoxTable *t, int dir, PetscReal x, PetscReal values[]) {
  const BoxAxis *a = &t->axis[dir];
  if (a->wall) {
    WallFunctions(t, dir, x, values);
    return;
  }
  const PetscReal angle = 2 * PETSC_PI * (x - a->low) / (a->high - a->low), c = PetscCosReal(angle),
                  s = PetscSinReal(angle);
  PetscReal cosine = 1, sine = 0;
  values[0] = 1;
  for (PetscInt m = 1; 2 * m < t->functions[dir]; m++) { /* by addition of angles: rounding grows with m only */
    const PetscReal before = cosine;
    cosine = c * before - s * sine;
    sine = s * before + c * sine;
    values[2 * m - 1] = cosine;
    values[2 * m] = sine;
  }
}

/* Functions f, g of a response and a source that W couples, with the weights of its pairs: `terms` a couple, the others
   are zero. */
typedef struct {
  PetscInt f, g;
} Couple;
typedef struct {
  PetscInt count, terms;
  Couple *couple;
  PetscInt *pair;    /* [count][terms] */
  PetscReal *weight; /* [count][terms] */
} Couplings;

/* A term of a couple. Between walls of halves f and g, even or odd, of the polynomials of two places each. Over a
   period from W's Fourier series in the offset, with

       cos(a - b) = cos a cos b + sin a sin b,      sin(a - b) = sin a cos b - cos a sin b. */
static void CoupleTerm(const BoxAxis *a, Couple c, PetscInt term, PetscInt *pair, PetscReal *weight) {
  const PetscInt n = a->places, half = n / 2, i = c.f % half, j = c.g % half;
  const PetscInt m = (c.f + 1) / 2, sine = m && c.f % 2 == 0, other = m && c.g % 2 == 0;
  const PetscReal angle = 2 * PETSC_PI * ((m * term) % n) / n;
  *pair = a->wall ? (term / 2 ? n - 1 - i : i) * n + (term % 2 ? n - 1 - j : j) : term;
  if (a->wall)
    *weight = (term / 2 && c.f >= half ? -1 : 1) * (term % 2 && c.g >= half ? -0.5 : 0.5);
  else
    *weight = (m ? 2.0 : 1.0) / n * (sine == other ? PetscCosReal(angle) : (sine - other) * PetscSinReal(angle));
}

static PetscErrorCode MakeCouplings(const BoxAxis *a, PetscInt functions, Couplings *c) {
  const PetscInt most = a->wall ? functions * functions : 2 * functions;
  PetscFunctionBeginUser;
  c->count = 0;
  c->terms = a->wall ? 4 : a->places;
  PetscCall(PetscMalloc3(most, &c->couple, most * c->terms, &c->pair, most * c->terms, &c->weight));
  for (PetscInt k = 0; k < functions * functions; k++) {
    const Couple one = {k / functions, k % functions};
    PetscInt at = c->count * c->terms;
    if (!a->wall && (one.f + 1) / 2 != (one.g + 1) / 2) continue;
    c->couple[c->count++] = one;
    for (PetscInt q = 0; q < c->terms; q++, at++) CoupleTerm(a, one, q, &c->pair[at], &c->weight[at]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A direction's blocks: even and odd between walls, one a mode over a period. */
static PetscInt CountBlocks(const BoxAxis *a) {
  return a->wall ? 2 : a->modes + 1;
}

/* How each component (u, v, and the tensor's xx, yy, xy) behaves in a mirror across x and in one across y: as the
   velocity component of this number. The component across the mirror changes its sign. */
static const int like[BOX_COMPONENTS][2] = {{0, 0}, {1, 1}, {1, 0}, {1, 0}, {0, 1}};

/* A direction's functions of block b: a cosine and its sine; between walls the even or odd half, and of the other
   component the other one, as the mirror image of a velocity changes the sign of one component. */
static void BlockFunctions(const BoxTable *t, int dir, PetscInt b, BoxBlock *q) {
  const PetscInt half = t->functions[dir] / 2;
  const PetscBool wall = t->axis[dir].wall;
  q->n[dir] = wall ? half : b ? 2 : 1;
  for (int c = 0; c < t->components; c++) q->first[c][dir] = wall ? (b == like[c][dir] ? 0 : half) : b ? 2 * b - 1 : 0;
}

/* The block that a component's function f of a direction belongs to. */
static PetscInt BlockOf(const BoxTable *t, int dir, int c, PetscInt f) {
  if (!t->axis[dir].wall) return (f + 1) / 2;
  return f < t->functions[dir] / 2 ? like[c][dir] : 1 - like[c][dir];
}

/* The blocks, with room for their parts of D in Q. */
static PetscErrorCode CreateBlocks(BoxTable *t) {
  const PetscInt ny = CountBlocks(&t->axis[1]);
  PetscFunctionBeginUser;
  t->blocks = CountBlocks(&t->axis[0]) * ny;
  PetscCall(PetscCalloc1(t->blocks, &t->block));
  for (PetscInt b = 0; b < t->blocks; b++) {
    BoxBlock *q = &t->block[b];
    BlockFunctions(t, 0, b / ny, q);
    BlockFunctions(t, 1, b % ny, q);
    PetscCall(PetscCalloc1(PetscSqr(t->components * q->n[0] * q->n[1]), &q->Q));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* value between the functions (x.f, y.f) of component ci and (x.g, y.g) of cj, half of it each way. Zero but for
   rounding where they are of two blocks. */
static void AddCouple(const BoxTable *t, int ci, int cj, Couple x, Couple y, PetscReal value) {
  const PetscInt bx = BlockOf(t, 0, ci, x.f), by = BlockOf(t, 1, ci, y.f);
  if (bx != BlockOf(t, 0, cj, x.g) || by != BlockOf(t, 1, cj, y.g)) return;
  const BoxBlock *q = &t->block[bx * CountBlocks(&t->axis[1]) + by];
  const PetscInt size = t->components * q->n[0] * q->n[1];
  const PetscInt row = (ci * q->n[0] + x.f - q->first[ci][0]) * q->n[1] + y.f - q->first[ci][1];
  const PetscInt column = (cj * q->n[0] + x.g - q->first[cj][0]) * q->n[1] + y.g - q->first[cj][1];
  q->Q[row * size + column] += 0.5 * value;
  q->Q[column * size + row] += 0.5 * value;
}

/* The blocks' parts of D between functions, from W between places; symmetric, of dipoles with its transpose beside it.
 */
static PetscErrorCode BoxTableTransform(const BoxTable *t, const PetscReal W[]) {
  const PetscInt nx = t->axis[0].pairs, ny = t->axis[1].pairs;
  PetscReal *line;
  Couplings c[2];
  PetscFunctionBeginUser;
  for (int dir = 0; dir < 2; dir++) PetscCall(MakeCouplings(&t->axis[dir], t->functions[dir], &c[dir]));
  PetscCall(PetscMalloc1(ny, &line));
  for (int b = 0; b < 2 * t->parts; b++)
    for (PetscInt p = 0; p < c[0].count; p++) {
      PetscCall(PetscArrayzero(line, ny));
      for (PetscInt k = p * c[0].terms; k < (p + 1) * c[0].terms; k++) {
        const PetscReal weight = c[0].weight[k], *row = W + (b * nx + c[0].pair[k]) * ny;
        for (PetscInt j = 0; j < ny; j++) line[j] += weight * row[j];
      }
      for (PetscInt q = 0; q < c[1].count; q++) {
        PetscReal sum = 0;
        for (PetscInt k = q * c[1].terms; k < (q + 1) * c[1].terms; k++) sum += c[1].weight[k] * line[c[1].pair[k]];
        AddCouple(t, b / t->parts, t->source + b % t->parts, c[0].couple[p], c[1].couple[q], t->source ? 2 * sum : sum);
      }
    }
  for (int dir = 0; dir < 2; dir++) PetscCall(PetscFree3(c[dir].couple, c[dir].pair, c[dir].weight));
  PetscCall(PetscFree(line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether an eigenvalue is kept. With dipoles they come in pairs of either sign, whose vectors differ in the sign of
   the tensors' part: the positive one, doubled, is the pair in what tensors do to velocities. */
static PetscBool IsKept(const BoxTable *t, PetscReal l, PetscReal least) {
  return (t->source ? l : PetscAbsReal(l)) > least;
}

/* Keep the block's eigenvectors (columns of Q) whose eigenvalues l are larger than `least`. */
static PetscErrorCode KeepLargest(BoxTable *t, BoxBlock *q, const PetscReal l[], PetscReal least) {
  const PetscInt size = t->components * q->n[0] * q->n[1];
  PetscReal *all = q->Q;
  PetscFunctionBeginUser;
  q->start = t->rank;
  q->modes = 0;
  for (PetscInt k = 0; k < size; k++) q->modes += IsKept(t, l[k], least);
  PetscCall(PetscMalloc1(size * q->modes, &q->Q));
  for (PetscInt k = 0, m = 0; k < size; k++) {
    if (!IsKept(t, l[k], least)) continue;
    t->l[t->rank++] = (t->source ? 2 : 1) * l[k];
    for (PetscInt i = 0; i < size; i++) q->Q[i * q->modes + m] = all[k * size + i];
    m++;
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From D between the functions of each block, symmetric, in Q[size][size] with size = components n[0] n[1]: the largest
   eigenvalues, down to the part SMALLEST of the largest of all, and their vectors. They are those of the first rank, as
   equal eigenvalues leave to rounding which vectors they have. Collective. */
static PetscErrorCode BoxTableDecompose(MPI_Comm comm, BoxTable *t) {
  const PetscInt count = t->components * t->functions[0] * t->functions[1];
  PetscReal *l, most = 0;
  PetscInt at = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(count, &l));
  PetscCall(PetscMalloc1(count, &t->l));
  for (PetscInt b = 0; b < t->blocks; b++) {
    const PetscInt size = t->components * t->block[b].n[0] * t->block[b].n[1];
    PetscCall(DenseEigen(size, t->block[b].Q, l + at));
    PetscCallMPI(MPI_Bcast(t->block[b].Q, (PetscMPIInt)(size * size), MPIU_REAL, 0, comm));
    PetscCallMPI(MPI_Bcast(l + at, (PetscMPIInt)size, MPIU_REAL, 0, comm));
    at += size;
  }
  for (PetscInt k = 0; k < count; k++) most = PetscMax(most, PetscAbsReal(l[k]));
  const PetscInt blocks = t->blocks;
  t->rank = t->blocks = t->functions[0] = t->functions[1] = at = 0;
  for (PetscInt b = 0; b < blocks; b++) {
    BoxBlock q = t->block[b];
    const PetscInt size = t->components * q.n[0] * q.n[1];
    PetscCall(KeepLargest(t, &q, l + at, SMALLEST * most));
    at += size;
    if (!q.modes) continue;
    t->block[t->blocks++] = q;
    for (int c = 0; c < t->components; c++)
      for (int d = 0; d < 2; d++) t->functions[d] = PetscMax(t->functions[d], q.first[c][d] + q.n[d]);
  }
  PetscCall(PetscFree(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r^2/(r^2 - 1) (W_{H/r} - W_H) of the pair, times (h/H)^2, leaves 1/r^2 of what W_H has of fourth order; r = 3/2 on
   many cells, where that makes whole numbers of them, else 2 or, on few, 3. */
static PetscErrorCode BoxTablePair(const FluidSpec *run, const char kernel[], const BoxLattice *lattice,
                                   const PetscInt cells[2], const BoxAxis axis[2], PetscReal H, PetscReal W[]) {
  const PetscInt shorter = PetscMin(cells[0], cells[1]), odd = cells[0] % 2 || cells[1] % 2;
  const PetscInt halves = shorter < FEW_CELLS ? 6 : shorter < RATIO_CELLS || odd ? 4 : 3; /* 2 r */
  const PetscReal scale = PetscSqr(halves * FluidSpecCellSize(run) / H) / (halves * halves - 4);
  FluidSpec spec = BoxGridSpec(run);
  PetscFunctionBeginUser;
  spec.comm = PETSC_COMM_SELF;
  spec.inertia = INERTIA_NONE;
  for (int fine = 0; fine < (lattice->whole ? 1 : 2); fine++) {
    for (int d = 0; d < 2; d++) spec.cells[d] = fine ? halves * cells[d] / 2 : cells[d];
    PetscCall(BoxGridAdd(&spec, run->comm, kernel, lattice, axis, lattice->whole ? 1 : fine ? scale : -scale, W));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxTableCreate(const FluidSpec *spec, const char kernel[], const BoxLattice *lattice, PetscBool middle,
                              BoxTable *t) {
  PetscInt cells[2], size;
  PetscReal *W, height = spec->box[3] - spec->box[2];
  FluidSpec pair = *spec;
  BoxAxis axis[2];
  PetscFunctionBeginUser;
  t->parts = lattice->dipole ? DIPOLE_COUNT : 2;
  t->source = lattice->dipole ? 2 : 0;
  t->components = t->source + t->parts;
  size = 2 * t->parts;
  CoarseCells(spec, cells);
  t->H = (spec->box[1] - spec->box[0]) / cells[0];
  if (cells[0] * spec->cells[1] != cells[1] * spec->cells[0]) pair.box[3] = pair.box[2] + cells[1] * t->H;
  for (int d = 0; d < 2; d++) {
    MakeAxis(&pair, d, t->H, middle, &axis[d]);
    t->axis[d] = axis[d];
    if (d) BoxAxisStretch(pair.box[2], height / (pair.box[3] - pair.box[2]), &t->axis[d]);
    t->functions[d] = t->axis[d].wall ? t->axis[d].places : 2 * t->axis[d].modes + 1;
    size *= t->axis[d].pairs;
  }
  PetscCall(PetscCalloc1(size, &W));
  PetscCall(BoxTablePair(&pair, kernel, lattice, cells, axis, t->H, W));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, W, (PetscMPIInt)size, MPIU_REAL, MPI_SUM, spec->comm));
  PetscCall(CreateBlocks(t));
  PetscCall(BoxTableTransform(t, W));
  PetscCall(BoxTableDecompose(spec->comm, t));
  PetscCall(PetscFree(W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxTableDestroy(BoxTable *t) {
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < t->blocks; b++) PetscCall(PetscFree(t->block[b].Q));
  PetscCall(PetscFree(t->block));
  PetscCall(PetscFree(t->l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void BoxBlockSum(const BoxBlock *q, int first, int components, const PetscReal weight[], PetscReal a[]) {
  const PetscInt functions = q->n[0] * q->n[1];
  const PetscReal *Q = q->Q + first * functions * q->modes;
  (void)PetscArrayzero(a, q->modes);
  for (PetscInt f = 0; f < components * functions; f++, Q += q->modes)
    for (PetscInt m = 0; m < q->modes; m++) a[m] += weight[f] * Q[m];
}

void BoxTableRows(const BoxTable *t, const PetscReal X[2], PetscReal part, int first, int count, PetscReal rows[]) {
  PetscReal vx[BOX_PLACES], vy[BOX_PLACES], weight[BOX_BLOCK_FUNCTIONS];
  (void)PetscArrayzero(rows, count * t->rank);
  if (part == 0) return;
  BoxTableFunctions(t, 0, X[0], vx);
  BoxTableFunctions(t, 1, X[1], vy);
  for (PetscInt q = 0; q < t->blocks; q++)
    for (int c = 0; c < count; c++) {
      const BoxBlock *b = &t->block[q];
      const PetscReal *fx = vx + b->first[first + c][0], *fy = vy + b->first[first + c][1];
      for (PetscInt i = 0; i < b->n[0]; i++)
        for (PetscInt j = 0; j < b->n[1]; j++) weight[i * b->n[1] + j] = part * fx[i] * fy[j];
      BoxBlockSum(b, first + c, 1, weight, rows + c * t->rank + b->start);
    }
}

PetscReal BoxProduct(PetscInt r, const PetscReal l[], const PetscReal x[], const PetscReal y[]) {
  Lanes sum = {0};
  PetscReal rest = 0;
  PetscInt m = 0;
  for (; m + LANES <= r; m += LANES) sum += LanesAt(l + m) * (LanesAt(x + m) * LanesAt(y + m));
  for (; m < r; m++) rest += l[m] * (x[m] * y[m]);
  return LanesSum(sum) + rest;
}
