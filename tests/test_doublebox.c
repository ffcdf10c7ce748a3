/* The box part of the double layer: the table of a square about the markers beside the whole one, products beside the
   matrix. */
#include "coupling/contrast.h"
#include "world.h"

#define SCENE                                                                                                          \
  "-delta_type cbs54 -coupling_near_field exact -coupling_box_part false -membrane_derivative spectral "               \
  "-scheme_type coupled -fluid_inertia none -domain_cells 32,32 -vesicle_semi_axes 0.4,0.6 "                           \
  "-vesicle_allow_close_markers true -vesicle_markers 35 -domain_box 0,8,0,8 "
#define CHANNEL "-domain_bc_x periodic "

/* Largest D_whole - D of the double layer over the largest D_whole, between own markers and all tensors. */
static PetscReal OffBy(const DoubleBox box, const PetscReal D[]) {
  const Layout l = box->markers->layout;
  const BoxTable *t = &box->table;
  PetscReal found[2] = {0, 0}, *a, *b;
  (void)PetscMalloc2(2 * t->rank, &a, DIPOLE_COUNT * t->rank, &b);
  for (PetscInt k = l->first; k < l->first + l->n; k++) {
    BoxTableRows(t, box->markers->X + 2 * k, 1, 0, 2, a);
    for (PetscInt j = 0; j < l->M; j++) {
      BoxTableRows(t, box->markers->X + 2 * j, 1, 2, DIPOLE_COUNT, b);
      for (int q = 0; q < 2 * DIPOLE_COUNT; q++) {
        const PetscReal whole = BoxProduct(t->rank, t->l, a + q % 2 * t->rank, b + q / 2 * t->rank);
        const PetscReal off = whole - D[(DIPOLE_COUNT * j + q / 2) * 2 * l->M + 2 * k + q % 2];
        found[0] = PetscMax(found[0], PetscAbsReal(off));
        found[1] = PetscMax(found[1], PetscAbsReal(whole));
      }
    }
  }
  (void)PetscFree2(a, b);
  (void)MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPI_MAX, l->comm);
  return found[0] / found[1];
}

/* Largest D T, of tensors all unlike, less the same by DoubleBoxApply, over the largest. */
static PetscErrorCode ApplyOffBy(DoubleBox box, const PetscReal D[], PetscReal *off) {
  const Layout l = box->markers->layout;
  PetscReal *T, *y, found[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(DIPOLE_COUNT * l->M, &T, 2 * l->n, &y));
  for (PetscInt j = 0; j < DIPOLE_COUNT * l->M; j++) T[j] = PetscSinReal(1 + j * j);
  PetscCall(DoubleBoxApply(box, 1, T + DIPOLE_COUNT * l->first, y));
  for (PetscInt k = 0; k < 2 * l->n; k++) {
    PetscReal sum = 0;
    for (PetscInt j = 0; j < DIPOLE_COUNT * l->M; j++) sum += D[j * 2 * l->M + 2 * l->first + k] * T[j];
    found[0] = PetscMax(found[0], PetscAbsReal(sum - y[k]));
    found[1] = PetscMax(found[1], PetscAbsReal(sum));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPI_MAX, l->comm));
  PetscCall(PetscFree2(T, y));
  *off = found[0] / found[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers that fill a small part of the box have D between the functions of a square about them, nearly the whole
   table's; others have the whole table. */
static PetscErrorCode CheckRegion(const char name[], const char options[], PetscBool small) {
  PetscReal *D, off, ratio = 10;
  TestWorld w;
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, &w));
  PetscCall(CouplingAddContrast(w.coupling, &ratio));
  const DoubleLayer s = w.coupling->contrast;
  PetscCall(DoubleLayerAddBoxPart(s, &w.scene->fluid));
  PetscCall(DoubleLayerPlace(s));
  PetscCall(PetscCalloc1(2 * DIPOLE_COUNT * PetscSqr(w.layout->M), &D));
  PetscCall(DoubleBoxMatrix(s->box, 1, D));
  CHECK((s->box->at != &s->box->table) == small, "%s: %s table", name, small ? "a square's" : "the whole");
  off = OffBy(s->box, D);
  CHECK(off < (small ? 0.01 : 1e-12) && (off > 1e-6) == small, "%s: D within %.1e of its largest", name, off);
  PetscCall(ApplyOffBy(s->box, D, &off));
  CHECK(off < 1e-12, "%s: a product is that of the matrix but for %.1e", name, off);
  PetscCall(PetscFree(D));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  PetscCall(CheckRegion("walls", SCENE "-vesicle_center 3.4,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("near a wall", SCENE "-vesicle_center 3.4,.7", PETSC_FALSE));
  PetscCall(CheckRegion("channel", SCENE CHANNEL "-vesicle_center 3.4,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("channel, on the seam", SCENE CHANNEL "-vesicle_center 7.7654321,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("channel in y", SCENE "-domain_bc_y periodic -vesicle_center 3.4,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("periodic, too wavy there", SCENE CHANNEL "-domain_bc_y periodic -vesicle_center 3.4,4.3",
                        PETSC_FALSE));
  PetscCall(CheckRegion("large in a channel", SCENE CHANNEL "-domain_box 0,2,0,2 -vesicle_center .9,1", PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
