/* In mode theta along the wall (lattice.c has s, mu, g1, g2), with k = 2 sin(theta/2), the wall adds to the free
   lattice t(j) = psi(j + 1) - psi(j),     n(j) = k psi(j) (times sin),     psi(j) = (A + B j) e^{-mu j}, t in row j at
   j + 1/2, n at j: free of divergence, and A, B make n(0) = 0 and (t(-1/2) + t(1/2))/2 = 0 with the source's own field.
   A source t in row j' has, with F = g1 - s g2, A = -(g2(j' + 1) - g2(j')),     B = [-(F(j' + 1) + F(j'))/2 + A sinh
   mu]/cosh mu, a source n in row j' gives n the part -s psi(j) with A = g2(j'),                     B = [-(g2(j' + 1) -
   g2(j' - 1))/2 + A sinh mu]/cosh mu. The image of the free constant comes with its sign turned, and 1/(4 theta) as
   there. */
#include "coupling/imagetable.h"
#include "coupling/lattice.h"

#define NODES 64 /* 50 give the same to rounding, 40 to 6e-13 */
#define LINES (IMAGE_ROWS + 2)

/* One mode's decay: g1 - s g2, g2 and e^{-mu j} by row, from row 0. */
typedef struct {
  PetscReal k, s, sinh, cosh, F[LINES], g2[LINES], e[LINES];
} Mode;

static Mode MakeMode(PetscReal theta) {
  const PetscReal half = PetscSinReal(0.5 * theta), mu = 2 * PetscAsinhReal(half);
  Mode m = {.k = 2 * half, .s = 4 * half * half, .sinh = PetscSinhReal(mu), .cosh = PetscCoshReal(mu)};
  for (int j = 0; j < LINES; j++) {
    m.e[j] = PetscExpReal(-mu * j);
    m.g2[j] = m.e[j] * (j * m.sinh + m.cosh) / (4 * m.sinh * m.sinh * m.sinh);
    m.F[j] = m.e[j] / (2 * m.sinh) - m.s * m.g2[j];
  }
  return m;
}

/* psi of a source in row j, t or n. */
static void Psi(const Mode *m, PetscBool normal, int j, PetscReal psi[LINES]) {
  const PetscReal before = m->g2[j > 0 ? j - 1 : 1];
  const PetscReal A = normal ? m->g2[j] : m->g2[j] - m->g2[j + 1];
  const PetscReal jump = normal ? m->g2[j + 1] - before : m->F[j + 1] + m->F[j];
  const PetscReal B = (-0.5 * jump + A * m->sinh) / m->cosh;
  for (int q = 0; q < LINES; q++) psi[q] = (A + B * q) * m->e[q];
}

/* Add one node of the quadrature to offsets 0 .. IMAGE_SHIFT. */
static void AddNode(PetscReal theta, PetscReal weight, ImageTable *t) {
  const Mode m = MakeMode(theta);
  const PetscReal w = weight / PETSC_PI;
  PetscReal even[IMAGE_SHIFT + 1], odd[IMAGE_SHIFT + 1], tangent[LINES], normal[LINES];
  for (int i = 0; i <= IMAGE_SHIFT; i++) {
    even[i] = w * PetscCosReal(i * theta);
    odd[i] = w * m.k * PetscSinReal((i + 0.5) * theta);
  }
  for (int source = 0; source < IMAGE_ROWS; source++) {
    Psi(&m, PETSC_FALSE, source, tangent);
    Psi(&m, PETSC_TRUE, source, normal);
    for (int row = 0; row < IMAGE_ROWS; row++) {
      PetscReal *uu = t->value[OFFSET_UU][row][source] + IMAGE_SHIFT,
                *vv = t->value[OFFSET_VV][row][source] + IMAGE_SHIFT;
      PetscReal *vu = t->value[OFFSET_VU][row][source] + IMAGE_SHIFT + 1;
      const PetscReal level = w / (4 * theta), along = tangent[row + 1] - tangent[row], across = -m.s * normal[row];
      for (int i = 0; i <= IMAGE_SHIFT; i++) {
        uu[i] += even[i] * along + level;
        vv[i] += even[i] * across + level;
        if (i < IMAGE_SHIFT) vu[i] += odd[i] * tangent[row];
      }
    }
  }
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

/* All rows, from a lattice's table that reaches far enough. */
PetscErrorCode ImageTableFill(const OffsetTable *lattice, ImageTable *t) {
  const PetscReal constant = LatticeConstant();
  PetscReal *theta, *weight;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(NODES, &theta, NODES, &weight));
  GaussLegendre(NODES, theta, weight);
  PetscCall(PetscMemzero(t, sizeof(*t)));
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++)
      for (int i = 0; i <= IMAGE_SHIFT; i++) {
        t->value[OFFSET_UU][row][source][IMAGE_SHIFT + i] = -constant;
        t->value[OFFSET_VV][row][source][IMAGE_SHIFT + i] = 1 / (4 * PETSC_PI) - constant;
      }
  for (int q = 0; q < NODES; q++) AddNode(theta[q], weight[q], t);
  for (int row = 0; row < IMAGE_ROWS; row++)
    for (int source = 0; source < IMAGE_ROWS; source++) Complete(lattice, row, source, t);
  PetscCall(PetscFree2(theta, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}
