/* Viscosity contrast in the matrix (problem/contrast.h). The jump J, less its flux, is an unknown of its own, so that
   the fluid's rows have the few markers near them only. */
#include "problem/contrast.h"
#include "direct.h"

/* The tensor of the unit jump of marker k in direction c. */
static void UnitTensor(DoubleLayer s, PetscInt k, int c, PetscReal T[DIPOLE_COUNT]) {
  const PetscReal *N = s->normal + 2 * k;
  T[DIPOLE_XX] = c ? 0 : 2 * N[0];
  T[DIPOLE_YY] = c ? 2 * N[1] : 0;
  T[DIPOLE_XY] = N[1 - c];
}

/* The unit jump's column: its dipoles in the fluid's rows, what they have of the mean velocity, and minus the box part
   D (columns one after another, NULL: none) in the rows of bodies. */
static void AddUnitJump(Direct *d, PetscInt k, int c, const PetscReal D[]) {
  const DoubleLayer s = d->c->mobility->contrast;
  const Grid g = d->grid;
  const PetscInt column = d->first[PART_JUMP] + 2 * k + c, rows = 2 * d->c->bodies->layout->M;
  const PetscReal *X = d->c->markers->X + 2 * k;
  PetscReal T[DIPOLE_COUNT];
  Stencil spot[DIPOLE_SPOTS];
  UnitTensor(s, k, c, T);
  DipoleSpots(g, d->fluid->nu, X, spot);
  for (int q = 0; q < DIPOLE_SPOTS; q++) {
    const Stencil *p = &spot[q];
    for (PetscInt b = 0; b < p->n[1]; b++)
      for (PetscInt a = 0; a < p->n[0]; a++)
        DirectAdd(d,
                  DirectIndex(d, dipole_form.of[q].field, DirectEntry(g, 0, p->first[0] + a),
                              DirectEntry(g, 1, p->first[1] + b)),
                  column, -T[dipole_form.of[q].part] * p->weight[0][a] * p->weight[1][b]);
  }
  for (PetscInt f = 0; f < DirectMeans(d); f++)
    DirectAdd(d, d->first[PART_MEAN] + f, column, X[f] * s->normal[2 * k + c] / PetscSqr(g->h));
  for (PetscInt i = 0; D && i < rows; i++)
    for (int q = 0; q < DIPOLE_COUNT; q++)
      DirectAdd(d, DirectRow(d, i), column, T[q] * D[(DIPOLE_COUNT * k + q) * rows + i]);
}

/* J - Q (1 - ratio) (V + (treading/a0) dV/dt) = 0 of one vesicle, a column of V at a time. */
static void AddJump(Direct *d, PetscInt v) {
  const DoubleLayer s = d->c->mobility->contrast;
  const Membrane m = d->c->membrane;
  const PetscInt first = 2 * m->layout->start[v], n = 2 * LayoutCount(m->layout, v);
  const PetscInt J = d->first[PART_JUMP] + first, V = d->first[PART_V] + first;
  const PetscReal *N = s->normal + first, *along = s->along + first / 2;
  PetscReal *unit = TestReals(n), *out = TestReals(n);
  for (PetscInt c = 0; c < n; c++) {
    PetscReal flux = 0;
    DirectAdd(d, J + c, J + c, 1);
    if (s->ratio[v] == 1) continue;
    unit[c] = 1;
    TestCall(PetscArraycpy(out, unit, n));
    MembraneLabelDerivative(m, v, d->c->treading[v] / d->fluid->a0, unit, out);
    for (PetscInt k = 0; k < n; k++) flux += N[k] * out[k];
    for (PetscInt k = 0; k < n; k++)
      DirectAdd(d, J + k, V + c, -(1 - s->ratio[v]) * (out[k] - flux / s->length[v] * N[k] / along[k / 2]));
    unit[c] = 0;
  }
}

/* Minus C_D of the vesicles' motion in the rows of obstacles. */
static void AddToObstacles(Direct *d) {
  const Membrane m = d->c->membrane;
  const PetscInt M = 2 * m->layout->M, n = 2 * d->c->bodies->layout->M;
  PetscReal *C = TestReals(n * n), *row = TestReals(M);
  TestCall(DoubleLayerAdd(d->c->mobility->contrast, -1, PETSC_TRUE, 0, n / 2, C));
  for (PetscInt i = M; i < n; i++) {
    for (PetscInt j = 0; j < M; j++) row[j] = C[j * n + i];
    TestCall(ContrastTread(m, 0, m->layout->bodies, d->c->treading, d->fluid->a0, 1, row));
    for (PetscInt j = 0; j < M; j++) DirectAdd(d, DirectRow(d, i), d->first[PART_V] + j, row[j]);
  }
}

void DirectAddContrast(Direct *d) {
  const DoubleLayer s = d->c->mobility->contrast;
  const Layout l = d->c->membrane->layout;
  const PetscInt n = 2 * l->M, V = d->first[PART_V];
  const PetscInt tensors = DIPOLE_COUNT * d->c->bodies->layout->M, rows = 2 * d->c->bodies->layout->M;
  PetscReal *D = NULL;
  PetscReal *B = TestReals(n * n);
  TestCall(ContrastMatrix(d->c, PETSC_TRUE, 0, l->M, B));
  TestCall(ContrastTread(d->c->membrane, 0, l->bodies, d->c->treading, d->fluid->a0, 2 * l->M, B));
  for (PetscInt i = 0; i < n * n; i++) DirectAdd(d, V + i / n, V + i % n, B[i]);
  AddToObstacles(d);
  PetscReal *unit = TestReals(tensors);
  if (s->box) TestCall(PetscCalloc1(rows * tensors, &D));
  for (PetscInt j = 0; j < tensors && D; j++) {
    unit[j] = 1;
    TestCall(BoxPartApply(s->box, -1, unit, D + j * rows));
    unit[j] = 0;
  }
  for (PetscInt k = 0; k < n; k++)
    if (s->ratio[LayoutBody(l, k / 2)] != 1) AddUnitJump(d, k / 2, (int)(k % 2), D);
  TestCall(PetscFree(D));
  for (PetscInt v = 0; v < l->bodies; v++) AddJump(d, v);
}
