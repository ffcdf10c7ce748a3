/* The box part of the double layer: the table of a square about the markers beside the whole one, products beside the
   matrix. */
#include "mobility/contrast.h"
#include "facts.h"

#define SCENE                                                                                                          \
  "-delta_type cbs54 -coupling_near_field exact -coupling_box_part false -membrane_derivative spectral "               \
  "-scheme_type coupled -fluid_inertia none -domain_cells 32,32 -vesicle_semi_axes 0.4,0.6 "                           \
  "-vesicle_allow_close_markers true -vesicle_markers 35 -domain_box 0,8,0,8 "
#define CHANNEL "-domain_bc_x periodic "

/* Largest D_whole - D of the double layer over the largest D_whole, between own markers and all tensors. */
static PetscReal OffBy(const DoubleBox box, const PetscReal D[]) {
  const Layout l = box->markers->layout;
  const BoxTable *t = &box->table[0];
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
  PetscCall(DoubleLayerCreate(w.coupling->near, &ratio, &w.coupling->contrast));
  const DoubleLayer s = w.coupling->contrast;
  PetscCall(DoubleLayerAddBoxPart(s, &w.scene->fluid, PETSC_TRUE, PETSC_FALSE));
  DoubleBoxTakeImages(s->box, NULL, NULL);
  PetscCall(DoubleLayerPlace(s));
  PetscCall(PetscCalloc1(2 * DIPOLE_COUNT * PetscSqr(w.layout->M), &D));
  PetscCall(DoubleBoxMatrix(s->box, 1, D));
  CHECK((s->box->at != &s->box->table[0]) == small, "%s: %s table", name, small ? "a square's" : "the whole");
  off = OffBy(s->box, D);
  CHECK(off < (small ? 0.01 : 1e-12) && (off > 1e-6) == small, "%s: D within %.1e of its largest", name, off);
  PetscCall(ApplyOffBy(s->box, D, &off));
  CHECK(off < 1e-12, "%s: a product is that of the matrix but for %.1e", name, off);
  PetscCall(PetscFree(D));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = C_D J and the box part of its dipoles, of a jump in a flow without divergence, so that it has no flux: with the
   walls' images in a square's table, beside D T of that alone, and with images of pairs of markers. */
static PetscErrorCode CheckImages(const char name[], const char options[]) {
  PetscReal *y[2], *D, ratio = 10, off[2] = {0, 0};
  PetscScalar *U;
  TestWorld w;
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, &w));
  PetscCall(DoubleLayerCreate(w.coupling->near, &ratio, &w.coupling->contrast));
  const DoubleLayer s = w.coupling->contrast;
  const PetscInt n = 2 * w.layout->n;
  PetscCall(DoubleLayerAddBoxPart(s, &w.scene->fluid, PETSC_TRUE, PETSC_FALSE));
  PetscCall(PetscCalloc4(n, &y[0], n, &y[1], n, &D, n, &U));
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *X = s->near->set.markers->X + 2 * (w.layout->first + k / 2);
    U[k] = k % 2 ? X[0] - 3.4 : 3 * (X[1] - 4.3);
  }
  for (int images = 1; images >= 0; images--) {
    if (!images) {
      PetscCall(BoxRegionDestroy(&s->box->region[0]));
      DoubleBoxTakeImages(s->box, NULL, NULL);
      for (int k = 0; k < BOX_REGION_SQUARES; k++) s->box->region[0].square[k] = (BoxSquare){.side = 0};
    }
    PetscCall(DoubleLayerPlace(s));
    CHECK((int)DoubleBoxHasImages(s->box) == images, "%s: a square %s images", name, images ? "with" : "without");
    PetscCall(DoubleLayerApply(s, 1, U, y[images]));
    if (images) PetscCall(DoubleBoxApply(s->box, 1, s->tensor + DIPOLE_COUNT * w.layout->first, D));
  }
  for (PetscInt k = 0; k < n; k++) {
    off[0] = PetscMax(off[0], PetscAbsReal(y[1][k] - y[0][k]));
    off[1] = PetscMax(off[1], PetscAbsReal(D[k]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, off, 2, MPIU_REAL, MPI_MAX, w.layout->comm));
  CHECK(off[0] < 0.01 * off[1] && off[0] > 0, "%s: answers differ by %.1e of the largest D T", name, off[0] / off[1]);
  PetscCall(PetscFree4(y[0], y[1], D, U));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  PetscCall(CheckImages("walls", SCENE "-vesicle_center 3.4,4.3"));
  PetscCall(CheckImages("channel", SCENE CHANNEL "-vesicle_center 3.4,4.3"));
  PetscCall(CheckRegion("walls", SCENE "-vesicle_center 3.4,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("near a wall", SCENE "-vesicle_center 3.4,.7", PETSC_FALSE));
  PetscCall(CheckRegion("channel", SCENE CHANNEL "-vesicle_center 3.4,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("channel, on the seam", SCENE CHANNEL "-vesicle_center 7.7654321,4.3", PETSC_TRUE));
  PetscCall(CheckRegion("periodic, too wavy there", SCENE CHANNEL "-domain_bc_y periodic -vesicle_center 3.4,4.3",
                        PETSC_FALSE));
  PetscCall(CheckRegion("large in a channel", SCENE CHANNEL "-domain_box 0,2,0,2 -vesicle_center .9,1", PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
