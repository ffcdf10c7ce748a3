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
#include <petscdt.h>

/* The numbers of the mode with the wave number theta. */
static ImageMode ImageModeMake(PetscReal theta) {
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

#define SHIFTS (IMAGE_SHIFT + 1)
#define PAIRS (IMAGE_ROWS * IMAGE_ROWS)

/* A block's wave along the wall, at offsets 0 .. IMAGE_SHIFT, and what a source in one row does in another. */
typedef struct {
  PetscReal wave[IMAGE_NODES][SHIFTS], across[PAIRS][IMAGE_NODES];
} ImageNodes;

static void ImageNodeSet(const ImageBlock *b, PetscReal theta, PetscReal weight, PetscInt q, ImageNodes *a) {
  const ImageMode m = ImageModeMake(theta);
  const PetscReal w = weight / PETSC_PI;
  PetscReal psi[IMAGE_LINES];
  for (int i = 0; i <= IMAGE_SHIFT; i++)
    a->wave[q][i] = w * (b->half ? PetscSinReal((i + 0.5 * b->half) * theta) : PetscCosReal(i * theta));
  for (int source = 0; source < IMAGE_ROWS; source++) {
    b->psi(&m, b->source, source, psi);
    for (int row = 0; row < IMAGE_ROWS; row++)
      a->across[row * IMAGE_ROWS + source][q] = b->component ? m.k * psi[row]
                                                             : (b->half ? -1 : 1) * (psi[row + 1] - psi[row]);
  }
}

PetscErrorCode ImageBlockFill(const ImageBlock *b, PetscReal value[IMAGE_ROWS][IMAGE_ROWS][IMAGE_WIDTH]) {
  PetscReal theta[IMAGE_NODES], weight[IMAGE_NODES];
  ImageNodes *a;
  PetscFunctionBeginUser;
  PetscCall(PetscDTGaussQuadrature(IMAGE_NODES, 0, PETSC_PI, theta, weight));
  PetscCall(PetscMalloc1(1, &a));
  for (int q = 0; q < IMAGE_NODES; q++) ImageNodeSet(b, theta[q], weight[q], q, a);
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++)
      for (int i = 0; i < IMAGE_WIDTH; i++) value[row][source][i] = b->level;
  const DenseView wave = {a->wave[0], SHIFTS, IMAGE_NODES, SHIFTS};
  const DenseView across = {a->across[0], IMAGE_NODES, PAIRS, IMAGE_NODES};
  PetscCall(DenseProductWithin(PETSC_FALSE, wave, across, 1, value[0][0] + IMAGE_SHIFT, IMAGE_WIDTH));
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++) {
      const OffsetTable *t = b->lattice;
      const PetscInt at = (row - source - b->below + t->size[1]) * (2 * t->size[0] + 1) + t->size[0];
      PetscReal *line = value[row][source] + IMAGE_SHIFT; /* below zero by symmetry; then the free lattice's part */
      for (PetscInt i = 1; i <= IMAGE_SHIFT && i - b->half <= IMAGE_SHIFT; i++)
        line[-i] = b->half ? -line[i - b->half] : line[i];
      for (PetscInt i = -IMAGE_SHIFT; i <= IMAGE_SHIFT; i++) line[i] += t->value[b->source][at + i];
    }
  PetscCall(PetscFree(a));
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
