/* In mode theta along the wall (latticegreen.c has s, mu, g1, g2), with k = 2 sin(theta/2), the wall adds to the free
   lattice

       t(j) = psi(j + 1) - psi(j),   n(j) = k psi(j) (times sin),   psi(j) = (A + B j) e^{-mu j},

   t in row j at j + 1/2, n at j: free of divergence, and A, B make n(0) = 0 and (t(-1/2) + t(1/2))/2 = 0 with the
   source's own field. A source t in row j' has, with F = g1 - s g2,

       A = -(g2(j' + 1) - g2(j')),   B = [-(F(j' + 1) + F(j'))/2 + A sinh mu]/cosh mu,

   and a source n in row j' gives n the part -s psi(j) with

       A = g2(j'),   B = [-(g2(j' + 1) - g2(j' - 1))/2 + A sinh mu]/cosh mu.

   The image of the free constant has the opposite sign, and 1/(4 theta) as the free lattice. */
#include "layers/imagetable.h"
#include "base/lanes.h"
#include "numerics/blas.h"
#include "layers/latticegreen.h"

ImageMode ImageModeMake(PetscReal theta) {
  const PetscReal half = PetscSinReal(0.5 * theta), mu = 2 * PetscAsinhReal(half);
  ImageMode m = {.k = 2 * half, .s = 4 * half * half, .sinh = PetscSinhReal(mu), .cosh = PetscCoshReal(mu)};
  for (int j = 0; j < IMAGE_LINES; j++) {
    m.e[j] = PetscExpReal(-mu * j);
    m.g2[j] = m.e[j] * (j * m.sinh + m.cosh) / (4 * m.sinh * m.sinh * m.sinh);
    m.F[j] = m.e[j] / (2 * m.sinh) - m.s * m.g2[j];
  }
  return m;
}

void ImagePsi(const ImageMode *m, PetscReal A, PetscReal jump, PetscReal psi[IMAGE_LINES]) {
  const PetscReal B = (-0.5 * jump + A * m->sinh) / m->cosh;
  for (int q = 0; q < IMAGE_LINES; q++) psi[q] = (A + B * q) * m->e[q];
}

/* psi of a source in row j, t or n. */
static void Psi(const ImageMode *m, PetscBool normal, int j, PetscReal psi[IMAGE_LINES]) {
  const PetscReal before = m->g2[j > 0 ? j - 1 : 1];
  const PetscReal A = normal ? m->g2[j] : m->g2[j] - m->g2[j + 1];
  const PetscReal jump = normal ? m->g2[j + 1] - before : m->F[j + 1] + m->F[j];
  ImagePsi(m, A, jump, psi);
}

#define SHIFTS (IMAGE_SHIFT + 1)
#define PAIRS (IMAGE_ROWS * IMAGE_ROWS)

/* Node by node the waves along the wall, at offsets 0 .. IMAGE_SHIFT, and what a source in one row does in another. */
typedef struct {
  PetscReal even[IMAGE_NODES][SHIFTS], odd[IMAGE_NODES][SHIFTS], across[OFFSET_COUNT][PAIRS][IMAGE_NODES];
} Nodes;

static void SetNode(PetscReal theta, PetscReal weight, PetscInt q, Nodes *a) {
  const ImageMode m = ImageModeMake(theta);
  const PetscReal w = weight / PETSC_PI;
  PetscReal tangent[IMAGE_LINES], normal[IMAGE_LINES];
  for (int i = 0; i <= IMAGE_SHIFT; i++) {
    a->even[q][i] = w * PetscCosReal(i * theta);
    a->odd[q][i] = w * m.k * PetscSinReal((i + 0.5) * theta);
  }
  for (int source = 0; source < IMAGE_ROWS; source++) {
    Psi(&m, PETSC_FALSE, source, tangent);
    Psi(&m, PETSC_TRUE, source, normal);
    for (int row = 0; row < IMAGE_ROWS; row++) {
      const int pair = row * IMAGE_ROWS + source;
      a->across[OFFSET_UU][pair][q] = tangent[row + 1] - tangent[row];
      a->across[OFFSET_VV][pair][q] = -m.s * normal[row];
      a->across[OFFSET_VU][pair][q] = tangent[row];
    }
  }
}

/* The quadrature's sums, added to offsets 0 .. IMAGE_SHIFT. */
static PetscErrorCode AddNodes(const PetscReal theta[], const PetscReal weight[], ImageTable *t) {
  Nodes *a;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(1, &a));
  for (int q = 0; q < IMAGE_NODES; q++) SetNode(theta[q], weight[q], q, a);
  for (int b = 0; b < OFFSET_COUNT; b++) {
    PetscReal *first = t->value[b][0][0] + IMAGE_SHIFT + (b == OFFSET_VU ? 1 : 0);
    const PetscBool odd = b == OFFSET_VU ? PETSC_TRUE : PETSC_FALSE;
    const DenseView shift = {odd ? a->odd[0] : a->even[0], odd ? IMAGE_SHIFT : SHIFTS, IMAGE_NODES, SHIFTS};
    const DenseView across = {a->across[b][0], IMAGE_NODES, PAIRS, IMAGE_NODES};
    PetscCall(DenseProductWithin(PETSC_FALSE, shift, across, 1, first, IMAGE_WIDTH));
  }
  PetscCall(PetscFree(a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The free lattice's part, and offsets below zero by symmetry. */
static void Complete(const OffsetTable *lattice, PetscInt row, PetscInt source, ImageTable *t) {
  PetscReal *line[OFFSET_COUNT];
  const PetscReal *free[OFFSET_COUNT];
  for (int b = 0; b < OFFSET_COUNT; b++) { /* in the lattice's table n lies half a cell above t of the same row */
    const PetscInt rows = row - source - (b == OFFSET_VU ? 1 : 0);
    line[b] = t->value[b][row][source] + IMAGE_SHIFT;
    free[b] = lattice->value[b] + (rows + lattice->size[1]) * (2 * lattice->size[0] + 1) + lattice->size[0];
  }
  for (PetscInt i = 1; i <= IMAGE_SHIFT; i++) {
    line[OFFSET_UU][-i] = line[OFFSET_UU][i];
    line[OFFSET_VV][-i] = line[OFFSET_VV][i];
    line[OFFSET_VU][1 - i] = -line[OFFSET_VU][i];
  }
  for (PetscInt i = -IMAGE_SHIFT; i <= IMAGE_SHIFT; i++)
    for (int b = 0; b < OFFSET_COUNT; b++) line[b][i] += free[b][i];
}

/* All rows, from a lattice's table that reaches far enough. The quadrature's part that is the same everywhere goes with
   the constants. */
PetscErrorCode ImageTableFill(const OffsetTable *lattice, ImageTable *t) {
  PetscReal theta[IMAGE_NODES], weight[IMAGE_NODES], level = -LatticeConstant();
  PetscFunctionBeginUser;
  GaussLegendre(IMAGE_NODES, theta, weight);
  for (int q = 0; q < IMAGE_NODES; q++) level += weight[q] / (4 * PETSC_PI * theta[q]);
  PetscCall(PetscMemzero(t, sizeof(*t)));
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++)
      for (int i = 0; i <= IMAGE_SHIFT; i++) {
        t->value[OFFSET_UU][row][source][IMAGE_SHIFT + i] = level;
        t->value[OFFSET_VV][row][source][IMAGE_SHIFT + i] = 1 / (4 * PETSC_PI) + level;
      }
  PetscCall(AddNodes(theta, weight, t));
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++) Complete(lattice, row, source, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ImageSum(const PetscReal (*table)[IMAGE_ROWS][IMAGE_WIDTH], Grid g, int t, PetscReal x, const ImageRows *row,
                   const ImageRows *source) {
  const PaddedStencil *from = row->along, *to = source->along;
  enum { VECTORS = OFFSET_LAGS / LANES };
  PetscReal lag[OFFSET_LAGS];
  Lanes line[VECTORS] = {{0}};
  PetscInt first = StencilLagWeights(t, from, to, lag);
  if (!g->wall[t]) {
    const PetscReal off = x - (PetscReal)(from->first[t] - to->first[t]);
    first += g->n[t] * (PetscInt)PetscFloorReal(off / g->n[t] + 0.5);
  }
  first = PetscMax(-IMAGE_SHIFT, PetscMin(first, IMAGE_SHIFT - OFFSET_LAGS + 1));
  for (PetscInt q = 0; q < row->n; q++)
    for (PetscInt k = 0; k < source->n; k++) {
      const PetscReal w = row->weight[q] * source->weight[k];
      const PetscReal *value = table[row->first + q][source->first + k] + IMAGE_SHIFT + first;
      for (int v = 0; v < VECTORS; v++) line[v] += w * LanesAt(value + v * LANES);
    }
  line[0] *= LanesAt(lag);
  for (int v = 1; v < VECTORS; v++) line[0] += line[v] * LanesAt(lag + v * LANES);
  return LanesSum(line[0]);
}
