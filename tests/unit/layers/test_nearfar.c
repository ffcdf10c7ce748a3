/* The closed form of the near field's distant pairs against sums over their stencils, on any number of ranks. */
#include "facts.h"
#include "layers/nearblock.h"

#define SCENE EXACT PERIODIC "-fluid_inertia none -scheme_type coupled -delta_type %s "

/* The double sum, offset by offset. */
static PetscReal PairSum(const OffsetTable *t, OffsetBlock block, const PaddedStencil *a, const PaddedStencil *b) {
  const PetscReal *x = a->weight[0] + KERNEL_MAX_POINTS, *y = a->weight[1] + KERNEL_MAX_POINTS;
  const PetscReal *u = b->weight[0] + KERNEL_MAX_POINTS, *v = b->weight[1] + KERNEL_MAX_POINTS;
  PetscReal sum = 0;
  for (PetscInt j = 0; j < a->n[1]; j++)
    for (PetscInt l = 0; l < b->n[1]; l++)
      for (PetscInt i = 0; i < a->n[0]; i++)
        for (PetscInt k = 0; k < b->n[0]; k++)
          sum += x[i] * y[j] * u[k] * v[l] *
                 OffsetAt(t, block, a->first[0] + i - b->first[0] - k, a->first[1] + j - b->first[1] - l);
  return sum;
}

/* C of a pair by sums over the stencils: xx, yy, xy, yx. */
static void BySums(const OffsetTable *t, const NearField f, PetscInt i, PetscInt j, const PetscReal d[2],
                   PetscReal C[4]) {
  const PetscReal h = f->set.markers->grid->h, nu = f->set.nu;
  const PaddedStencil *a = &f->pairs->stencil[2 * i], *b = &f->pairs->stencil[2 * j];
  const PetscReal x = d[0] / h, y = d[1] / h;
  C[0] = (TestStokeslet(0, 0, x, y) - PairSum(t, OFFSET_UU, &a[0], &b[0])) / nu;
  C[1] = (TestStokeslet(1, 1, x, y) - PairSum(t, OFFSET_VV, &a[1], &b[1])) / nu;
  C[2] = (TestStokeslet(1, 0, x, y) - PairSum(t, OFFSET_VU, &b[1], &a[0])) / nu;
  C[3] = (TestStokeslet(0, 1, x, y) - PairSum(t, OFFSET_VU, &a[1], &b[0])) / nu;
}

#define TWO                                                                                                            \
  "-domain_cells 128,128 -domain_box 0,4,0,4 -vesicle_count 2 -vesicle_semi_axes 0.2,0.3 -vesicle_center "             \
  "1.5,1.6,2.02,1.74 -vesicle_markers 65"
#define EIGHTEEN                                                                                                       \
  "-domain_cells 192,96 -domain_box 0,6,0,3 -vesicle_count 18 -vesicle_packing .3 -vesicle_packing_gap .17 "           \
  "-vesicle_reduced_area .8 -vesicle_markers 35"
#define LARGE "-domain_cells 128,128 -domain_box 0,4,0,4 -vesicle_semi_axes 0.45,1.2 -vesicle_markers 111 "

/* Pairs of two vesicles 2 h beyond the reach of sums, 12 h apart, times r^4: measured 0.0019 and 0.0026 h^4/(nu r^4)
   with cbs54 and ib6. Or `within`, of all pairs of a vesicle, 77 h long, beyond that reach: the closed form of three
   orders with the place in the cells, and the vesicle's own quadrature. Pairs closer by are sums themselves, up to
   `near`: in single precision with many vesicles. */
static void CheckClosedForm(const OffsetTable *t, const char kernel[], PetscBool within, const char scene[],
                            PetscReal near, PetscReal bound) {
  ScopedWorld w;
  PetscReal worst[2] = {0, 0}, C[4];
  PetscInt pairs = 0;
  TestWorldCreate(&w, SCENE "%s", kernel, scene);
  const NearField f = w.coupling->mobility->near;
  const Layout l = w.layout;
  const PetscReal h = w.fluid->grid->h, *X = w.coupling->markers->X;
  const PetscReal reach = f->pairs->kernel->reach[within ? NEAR_ONE : NEAR_TWO];
  PetscReal *all = TestReals(4 * l->M * l->M);
  const MarkerRange every = {0, l->M};
  TestCall(NearFieldAdd(f, 1, PETSC_TRUE, &every, &every, all));
  for (PetscInt i = l->first; i < l->first + l->n; i++)
    for (PetscInt j = 0; j < l->M; j++) {
      const PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]}, r = PetscHypotReal(d[0], d[1]) / h;
      const int far = r > reach;
      if (i == j || (LayoutBody(l, i) == LayoutBody(l, j)) != within) continue;
      if (far && !within && PetscAbsReal(r - reach - 2) > 0.5) continue;
      const PetscReal *at = all + 4 * j * l->M + 2 * i, found[4] = {at[0], at[2 * l->M + 1], at[2 * l->M], at[1]};
      BySums(t, f, i, j, d, C);
      pairs += far;
      for (int c = 0; c < 4; c++) {
        const PetscReal own = within && c < 2 ? f->pairs->logarithm[0][PetscAbsInt(i - j)] : 0;
        const PetscReal off = PetscAbsReal(f->set.nu * (found[c] - C[c]) - own);
        worst[far] = PetscMax(worst[far], off * (far && !within ? r * r * r * r : 1));
      }
    }
  TestMost(2, worst);
  TestCall(MPI_Allreduce(MPI_IN_PLACE, &pairs, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  TestAbout("%s, %s: %d pairs %s beyond %g h", kernel, scene, (int)pairs, within ? "of one vesicle" : "of two", reach);
  CHECK(pairs > (within ? 4000 : 100) && (within || (worst[0] > 1e-13) == (near > 1e-12)),
        "in the precision asked for");
  CheckBelow(worst[0], near, "nearer ones are sums");
  CheckBelow(worst[1], bound, "they have the closed form");
}

void Facts(void) {
  static const char *const kernels[] = {"cbs54", "ib6"};
  static const char *const places[] = {
      "-vesicle_center 2,2.1 -vesicle_angle 20", "-vesicle_center 1.99,1.98 -vesicle_angle 70",
      "-vesicle_center 2.01,1.91 -vesicle_angle 0", "-vesicle_center 2.05,2 -vesicle_angle -45"};
  OffsetTable table;
  TestCall(LatticeStokeslet(96, &table));
  CheckClosedForm(&table, "cbs54", PETSC_FALSE, EIGHTEEN, 1e-9, 0.0035);
  for (int k = 0; k < 2; k++) {
    CheckClosedForm(&table, kernels[k], PETSC_FALSE, TWO, 1e-12, 0.0035);
    for (int p = 0; p < 4; p++)
      CheckClosedForm(&table, kernels[k], PETSC_TRUE, TestText(LARGE "%s", places[p]), 1e-12, 1.3e-7);
  }
  TestCall(OffsetTableDestroy(&table));
}
