/* The box part of the double layer: a product beside the sum over the eigenvectors of its table. */
#include "problem/contrast.h"
#include "facts.h"

#define SCENE                                                                                                          \
  "-delta_type cbs54 -coupling_near_field exact -coupling_box_part false -membrane_derivative spectral "               \
  "-scheme_type coupled -fluid_inertia none -domain_cells 32,32 -vesicle_semi_axes 0.4,0.6 "                           \
  "-vesicle_allow_close_markers true -vesicle_markers 35 -domain_box 0,8,0,8 "
#define CHANNEL "-domain_bc_x periodic "

/* Largest y - SUM phi Q diag(l) Q^T psi^T T of tensors all unlike, y by DoubleBoxApply, over the largest. */
static PetscErrorCode ApplyOffBy(DoubleBox box, PetscReal *off) {
  const Layout l = box->markers->layout;
  const BoxTable *t = &box->table;
  const PetscReal *X = box->markers->X;
  PetscReal *T, *y, *a, *b, *sum, found[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(
      PetscCalloc5(DIPOLE_COUNT * l->M, &T, 2 * l->n, &y, 2 * t->rank, &a, DIPOLE_COUNT * t->rank, &b, t->rank, &sum));
  for (PetscInt j = 0; j < DIPOLE_COUNT * l->M; j++) T[j] = PetscSinReal(1 + j * j);
  PetscCall(DoubleBoxApply(box, 1, T + DIPOLE_COUNT * l->first, y));
  for (PetscInt j = 0; j < l->M; j++) {
    BoxTableRows(t, X + 2 * j, 1, 2, DIPOLE_COUNT, b);
    for (PetscInt m = 0; m < DIPOLE_COUNT * t->rank; m++) sum[m % t->rank] += T[DIPOLE_COUNT * j + m / t->rank] * b[m];
  }
  for (PetscInt k = 0; k < 2 * l->n; k++) {
    BoxTableRows(t, X + 2 * (l->first + k / 2), 1, 0, 2, a);
    const PetscReal answer = BoxProduct(t->rank, t->l, a + k % 2 * t->rank, sum);
    found[0] = PetscMax(found[0], PetscAbsReal(answer - y[k]));
    found[1] = PetscMax(found[1], PetscAbsReal(answer));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPI_MAX, l->comm));
  PetscCall(PetscFree5(T, y, a, b, sum));
  *off = found[0] / found[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckApply(const char name[], const char options[]) {
  PetscReal off = 0, ratio = 10;
  TestWorld w;
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, &w));
  PetscCall(DoubleLayerCreate(w.coupling->mobility->near, &ratio, &w.coupling->mobility->contrast));
  PetscCall(DoubleLayerAddBoxPart(w.coupling->mobility->contrast, &w.scene->fluid));
  PetscCall(DoubleLayerPlace(w.coupling->mobility->contrast));
  PetscCall(ApplyOffBy(w.coupling->mobility->contrast->box, &off));
  CHECK(off < 1e-12, "%s: a product is that of the table's vectors but for %.1e", name, off);
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  PetscCall(CheckApply("walls", SCENE "-vesicle_center 3.4,4.3"));
  PetscCall(CheckApply("channel, on the seam", SCENE CHANNEL "-vesicle_center 7.7654321,4.3"));
  PetscCall(CheckApply("periodic", SCENE CHANNEL "-domain_bc_y periodic -vesicle_center 3.4,4.3"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
