#include "mobility/boxpart.h"
#include "base/lanes.h"
#include "numerics/blas.h"

PetscErrorCode BoxPartCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice, BoxPart *out) {
  BoxPart b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->spec = spec;
  b->lattice = *lattice;
  b->markers = markers;
  b->ramp = spec->inertia == INERTIA_NONE || lattice->dipole ? PETSC_FALSE : PETSC_TRUE;
  for (int d = 0; d < 2; d++)
    b->axis[d] = BoxAxisOfGrid(markers->grid->wall[d], markers->grid->lo[d], markers->grid->hi[d]);
  PetscCall(PetvesEvent("BoxTable", &b->make));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartDestroy(BoxPart *box) {
  BoxPart b = *box;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 2; k++) PetscCall(BoxTableDestroy(&b->table[k]));
  PetscCall(PetscFree5(b->value[0], b->value[1], b->product, b->function, b->amplitude));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of D that a marker has: in unsteady flow it fades up to four cells from a wall, where the force's smear in
   the inertia would make C + D indefinite. */
static PetscReal Fade(BoxPart b, const PetscReal X[2]) {
  const Grid g = b->markers->grid;
  PetscReal fade = 1;
  for (int d = 0; d < 2 && b->ramp; d++)
    if (g->wall[d]) fade *= BoxSmoothStep(PetscMin(X[d] - g->lo[d], g->hi[d] - X[d]), g->h, 4 * g->h);
  return fade;
}

/* Whether sources are forces, and all markers are in the middle half of a box with walls. */
static PetscBool AreInMiddle(BoxPart b) {
  const Grid g = b->markers->grid;
  for (int d = 0; d < 2; d++) {
    const PetscReal quarter = 0.25 * (g->hi[d] - g->lo[d]);
    for (PetscInt k = 0; k < b->markers->layout->M && g->wall[d]; k++) {
      const PetscReal x = b->markers->X[2 * k + d];
      if (x < g->lo[d] + quarter || x > g->hi[d] - quarter) return PETSC_FALSE;
    }
  }
  return (g->wall[0] || g->wall[1]) && !b->lattice.dipole;
}

/* The table that reaches all markers, made when it is first needed, and room for what the markers have of it. */
static PetscErrorCode BoxPartTakeTable(BoxPart b) {
  const PetscBool middle = AreInMiddle(b);
  BoxTable *t = &b->table[middle];
  PetscFunctionBeginUser;
  if (!t->l) {
    PetscCall(PetscLogEventBegin(b->make, 0, 0, 0, 0));
    PetscCall(BoxTableCreate(b->spec, b->markers->kernel->name, &b->lattice, middle, t));
    PetscCall(PetscLogEventEnd(b->make, 0, 0, 0, 0));
  }
  if (b->at == t) PetscFunctionReturn(PETSC_SUCCESS);
  b->at = t;
  const PetscInt n = b->markers->layout->n, nx = t->functions[0], ny = t->functions[1];
  PetscCall(PetscFree5(b->value[0], b->value[1], b->product, b->function, b->amplitude));
  PetscCall(PetscMalloc5(nx * n, &b->value[0], ny * n, &b->value[1], t->parts * nx * n, &b->product,
                         t->components * nx * ny, &b->function, t->rank, &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartPlace(BoxPart b) {
  const Layout l = b->markers->layout;
  PetscFunctionBeginUser;
  PetscCall(BoxPartTakeTable(b));
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = b->markers->X + 2 * (l->first + k), part[2] = {Fade(b, X), 1};
    for (int d = 0; d < 2; d++) {
      PetscReal value[BOX_PLACES];
      BoxTableFunctions(b->at, d, X[d], value);
      for (PetscInt i = 0; i < b->at->functions[d]; i++) b->value[d][i * l->n + k] = part[d] * value[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A component's functions. */
static PetscReal *BoxFunctions(BoxPart b, int component) {
  return b->function + component * b->at->functions[0] * b->at->functions[1];
}

/* The own markers' sources in the functions. */
static PetscErrorCode BoxGather(BoxPart b, const PetscReal F[]) {
  const PetscInt n = b->markers->layout->n, nx = b->at->functions[0], parts = b->at->parts;
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < parts * nx; i++)
    for (PetscInt k = 0; k < n; k++) b->product[i * n + k] = F[parts * k + i / nx] * b->value[0][i % nx * n + k];
  PetscCall(DenseProduct(PETSC_TRUE, b->at->functions[1], parts * nx, n, b->value[1], b->product,
                         BoxFunctions(b, b->at->source)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U += what the functions of the velocity are at the own markers. */
static PetscErrorCode BoxScatter(BoxPart b, PetscScalar U[]) {
  const PetscInt n = b->markers->layout->n, nx = b->at->functions[0];
  PetscFunctionBeginUser;
  PetscCall(DenseProduct(PETSC_FALSE, n, 2 * nx, b->at->functions[1], b->value[1], b->function, b->product));
  for (PetscInt i = 0; i < 2 * nx; i++)
    for (PetscInt k = 0; k < n; k++) U[2 * k + i / nx] += b->value[0][i % nx * n + k] * b->product[i * n + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where component c's functions of a block begin. */
static PetscReal *InBlock(BoxPart b, const BoxBlock *q, int c) {
  return BoxFunctions(b, c) + q->first[c][0] * b->at->functions[1] + q->first[c][1];
}

PetscErrorCode BoxPartApply(BoxPart b, PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  const BoxTable *t = b->at;
  const Layout l = b->markers->layout;
  const PetscInt ny = t->functions[1];
  PetscFunctionBeginUser;
  PetscCall(BoxGather(b, F));
  for (const BoxBlock *q = t->block; q < t->block + t->blocks; q++) { /* to the eigenvectors' amplitudes */
    PetscReal weight[DIPOLE_COUNT * BOX_BLOCK_FUNCTIONS], *w = weight;
    for (int c = t->source; c < t->components; c++)
      for (PetscInt i = 0; i < q->n[0]; i++)
        for (PetscInt j = 0; j < q->n[1]; j++) *w++ = InBlock(b, q, c)[i * ny + j];
    BoxBlockSum(q, t->source, t->parts, weight, b->amplitude + q->start);
  }
  if (l->size > 1)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, (PetscMPIInt)t->rank, MPIU_REAL, MPI_SUM, l->comm));
  for (PetscInt m = 0; m < t->rank; m++) b->amplitude[m] *= alpha * t->l[m];
  PetscCall(PetscArrayzero(b->function, 2 * t->functions[0] * t->functions[1])); /* those of no block too */
  for (const BoxBlock *q = t->block; q < t->block + t->blocks; q++) {            /* and to the velocities' functions */
    const PetscReal *Q = q->Q;
    for (int c = 0; c < 2; c++)
      for (PetscInt i = 0; i < q->n[0]; i++)
        for (PetscInt j = 0; j < q->n[1]; j++, Q += q->modes)
          InBlock(b, q, c)[i * ny + j] = LanesDot(q->modes, b->amplitude + q->start, Q);
  }
  PetscCall(BoxScatter(b, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartAdd(BoxPart b, PetscReal scale, const MarkerRange *rows, const MarkerRange *columns,
                          PetscReal out[]) {
  const MarkerRange *range[] = {rows, columns};
  const Layout l = b->markers->layout;
  const PetscInt r = b->at->rank, begin = PetscMax(l->first, rows->first),
                 end = PetscMin(l->first + l->n, rows->first + rows->n);
  PetscReal *vector[2]; /* what the markers of both ranges have of the eigenvectors */
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * rows->n * r, &vector[0], 2 * columns->n * r, &vector[1]));
  for (int q = 0; q < 2; q++)
    for (PetscInt k = 0; k < range[q]->n; k++) {
      const PetscReal *X = b->markers->X + 2 * (range[q]->first + k);
      BoxTableRows(b->at, X, Fade(b, X), 0, 2, vector[q] + 2 * k * r);
    }
  for (PetscInt j = 0; j < 2 * columns->n; j++)
    for (PetscInt i = 2 * (begin - rows->first); i < 2 * (end - rows->first); i++)
      out[j * 2 * rows->n + i] += scale * BoxProduct(r, b->at->l, vector[0] + i * r, vector[1] + j * r);
  PetscCall(PetscFree2(vector[0], vector[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
