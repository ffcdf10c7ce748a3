/* The near field C = S - L: the lattice table, symmetry, and any number of ranks. */
#include "facts.h"
#include "layers/nearblock.h"

/* Response u (b = OFFSET_UU) or v (OFFSET_VU) at entry (i, j) to a force on u at entry (0, 0), and the same of a force
   on v: u from v is v from u the other way round. */
static PetscReal Response(const OffsetTable *t, int source, int response, PetscInt i, PetscInt j) {
  if (source == response) return OffsetAt(t, source ? OFFSET_VV : OFFSET_UU, i, j);
  return source ? OffsetAt(t, OFFSET_VU, -i, -j) : OffsetAt(t, OFFSET_VU, i, j);
}

/* Entry (i, j) of v lies half a cell left of and above that of u. */
static void Offset(int source, int response, PetscInt i, PetscInt j, PetscReal d[2]) {
  const PetscReal half = 0.5 * (response - source);
  d[0] = i - half;
  d[1] = j + half;
}

/* Largest distance of the table from the Stokeslet, times r^2, within half a cell of a circle. */
static PetscReal RingError(const OffsetTable *t, PetscInt radius) {
  PetscReal worst = 0, d[2];
  for (int k = 0; k < 4; k++)
    for (PetscInt j = -radius; j <= radius; j++)
      for (PetscInt i = -radius; i <= radius; i++) {
        Offset(k / 2, k % 2, i, j, d);
        const PetscReal r = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
        if (PetscAbsReal(r - radius) > 0.5) continue;
        TestWorse(&worst, r * r * (Response(t, k / 2, k % 2, i, j) - TestStokeslet(k / 2, k % 2, d[0], d[1])));
      }
  return worst;
}

/* The velocity and the pressure p of a unit force in unbounded fluid of viscosity 1, on the lattice: known values, the
   Stokes equations with that force, and the Stokeslet far away with a remainder in h^2/r^2. */
static void CheckTable(const OffsetTable *t, const OffsetTable *p) {
  static const OffsetBlock pressure[2] = {OFFSET_UU, OFFSET_VV};
  PetscReal divergence = 0, momentum = 0, far = 0, ring[3];
  CheckBelow(OffsetAt(t, OFFSET_UU, 0, 0) - 0.168460448979795, 1e-14, "uu(0,0)");
  CheckBelow(OffsetAt(t, OFFSET_UU, 1, 0) - 0.088882977433848, 1e-14, "uu(1,0)");
  for (PetscInt k = 0; k < 2 * 79 * 79; k++) {
    const int s = k % 2;
    const PetscInt i = k / 2 % 79 - 39, j = k / 2 / 79 - 39;
    const PetscReal here = OffsetAt(p, pressure[s], i, j), x[2] = {i - 0.5 * !s, j - 0.5 * s};
    const PetscReal r2 = TestProduct(2, x, x);
    if (r2 > 100) TestWorse(&far, (here - x[s] / (2 * PETSC_PI * r2)) * r2 * PetscSqrtReal(r2));
    TestWorse(&divergence, Response(t, s, 0, i, j) - Response(t, s, 0, i - 1, j) + Response(t, s, 1, i, j) -
                               Response(t, s, 1, i, j - 1));
    for (int r = 0; r < 2; r++)
      TestWorse(&momentum, Response(t, s, r, i - 1, j) + Response(t, s, r, i + 1, j) + Response(t, s, r, i, j - 1) +
                               Response(t, s, r, i, j + 1) - 4 * Response(t, s, r, i, j) + here -
                               OffsetAt(p, pressure[s], i + !r, j + r) + (s == r && !i && !j));
  }
  CheckBelow(divergence, 1e-14, "the response has no divergence");
  CheckBelow(momentum, 1e-13, "Laplacian, pressure gradient and force add up to nothing");
  CheckBelow(far, 0.1, "far away the pressure is x/(2 pi r^2), times r^3");
  for (int k = 0; k < 3; k++) ring[k] = RingError(t, 10 << k);
  CheckBelow(ring[0], 0.05, "Stokeslet far away, apart by c/r^2: c at r = 10");
  CheckBelow(ring[1] / ring[0] - 1, 0.05, "c at r = 20 is that");
  CheckBelow(ring[2] / ring[1] - 1, 0.02, "c at r = 40 is that");
}

/* The whole of C, [2M][2M] by columns, on every rank. */
static void WholeMatrix(TestWorld *w, PetscReal *C) {
  const Layout l = w->layout;
  const PetscInt N = 2 * l->M;
  Vec F, U;
  TestVecs(w->X, &F, &U, NULL);
  for (PetscInt j = 0; j < N; j++) {
    TestUnit(j, F);
    TestCall(VecSet(U, 0));
    TestCall(NearFieldApply(w->coupling->mobility->near, 1, TestArray(F), TestArray(U)));
    TestCall(LayoutGatherVec(l, U, C + j * N));
  }
}

/* max |C - C^T| over max |C| inside the blocks of vesicles with themselves, and between different ones. */
static void Asymmetry(Layout l, const PetscReal *C, PetscReal worst[2]) {
  const PetscInt N = 2 * l->M;
  PetscReal largest = 0;
  worst[0] = worst[1] = 0;
  for (PetscInt v = 0; v < l->bodies; v++)
    for (PetscInt w = 0; w < l->bodies; w++)
      for (PetscInt i = 2 * l->start[v]; i < 2 * l->start[v + 1]; i++)
        for (PetscInt j = 2 * l->start[w]; j < 2 * l->start[w + 1]; j++) {
          TestWorse(&largest, C[j * N + i]);
          worst[v != w] = PetscMax(worst[v != w], PetscAbsReal(C[j * N + i] - C[i * N + j]));
        }
  for (int k = 0; k < 2; k++) worst[k] /= largest;
}

/* C is symmetric, and the same on one rank and on all. */
static void CheckSymmetry(const char name[], const char scene[], const char kernel[]) {
  ScopedWorld w, alone;
  PetscReal worst[2];
  PetscInt blocks;
  TestWorldCreate(&w, EXACT "-scheme_type coupled -delta_type %s %s", kernel, scene);
  const PetscInt N = 2 * w.layout->M;
  PetscReal *C = TestReals(N * N), *same = TestReals(N * N);
  WholeMatrix(&w, C);
  blocks = w.coupling->mobility->near->list.count.blocks;
  TestCall(MPI_Allreduce(MPI_IN_PLACE, &blocks, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  Asymmetry(w.layout, C, worst);
  TestAbout("%s, %s: C of %d blocks", name, kernel, (int)blocks);
  CheckBelow(worst[0], 1e-14, "symmetric");
  CheckBelow(worst[1], 1e-13, "symmetric between vesicles");
  TestCall(SceneCreate(PETSC_COMM_SELF, NULL, NULL, &alone.scene)); /* of the same options, on every rank by itself */
  TestWorldBuild(&alone);
  TestWorldPlace(alone.fluid->a0, &alone);
  WholeMatrix(&alone, same);
  CheckBelow(TestFar(N * N, C, same) / TestFar(N * N, same, NULL), 1e-14, "C of all ranks is that of one");
}

#define TWO_WALLS                                                                                                      \
  "-domain_cells 48,48 -domain_box -1.5,1.5,-1.5,1.5 -vesicle_count 2 -vesicle_semi_axes 0.2,0.4 -vesicle_center "     \
  "-0.3,0.1,0.28,-0.1 -vesicle_markers 27 "
#define THREE_PERIODIC                                                                                                 \
  "-domain_cells 45,39 -domain_box 0,3,0,2.6 -fluid_inertia none " PERIODIC                                            \
  "-vesicle_count 3 -vesicle_semi_axes 0.25,0.35 "                                                                     \
  "-vesicle_center 0.05,0.1,1.1,0.9,2.2,2.5 -vesicle_markers 27 "
#define SEAM                                                                                                           \
  "-domain_cells 51,32 -domain_box 0,3.1875,-1,1 -domain_bc_x periodic -vesicle_count 2 -vesicle_semi_axes 0.3,0.5 "   \
  "-vesicle_center 0.1,0,2.4,0 -vesicle_markers 33 "

/* Least distance of markers of v and of the images of w. */
static PetscReal Gap(const TestWorld *w, PetscInt v, PetscInt u) {
  const Layout l = w->layout;
  const Grid g = w->fluid->grid;
  const PetscReal *X = w->coupling->markers->X;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt i = l->start[v]; i < l->start[v + 1]; i++)
    for (PetscInt j = l->start[u]; j < l->start[u + 1]; j++) {
      PetscReal r2 = 0;
      for (int dir = 0; dir < 2; dir++) {
        const PetscReal d = X[2 * i + dir] - X[2 * j + dir];
        r2 += PetscSqr(g->wall[dir] ? d : remainder(d, g->hi[dir] - g->lo[dir]));
      }
      least = PetscMin(least, r2);
    }
  return PetscSqrtReal(least);
}

/* Vesicles up to NEAR_REACH apart, over the seam too, have all their pairs in C, others none; each rank its own rows.
 */
static void CheckReach(void) {
  ScopedWorld w;
  PetscInt count[3] = {0, 0, 0}; /* near, far, wrong */
  TestWorldCreate(&w, EXACT "-scheme_type coupled -domain_cells 320,96 -domain_box 0,20,0,6 -domain_bc_x periodic "
                            "-fluid_inertia none -vesicle_count 9 -vesicle_semi_axes 0.3,0.5 -vesicle_markers 27 "
                            "-vesicle_center 0.2,1,2.1,1.4,4.6,1,4.2,3,9.8,4.4,9.2,2.2,12.9,3.8,17,1,19.3,1.9");
  const Layout l = w.layout;
  PetscReal *C = TestReals(4 * l->M * l->M);
  const MarkerRange every = {0, l->M};
  TestCall(NearFieldAdd(w.coupling->mobility->near, 1, PETSC_TRUE, &every, &every, C));
  for (PetscInt v = l->own; v < l->end; v++)
    for (PetscInt u = 0; u < l->bodies; u++) {
      PetscInt pairs = 0;
      for (PetscInt i = l->start[v]; i < l->start[v + 1]; i++)
        for (PetscInt j = l->start[u]; j < l->start[u + 1]; j++) {
          const PetscReal *at = C + 4 * j * l->M + 2 * i, *other = at + 2 * l->M;
          pairs += at[0] != 0 || at[1] != 0 || other[0] != 0 || other[1] != 0;
        }
      const PetscBool near = Gap(&w, v, u) < NEAR_REACH * w.fluid->grid->h;
      count[near ? 0 : 1]++;
      count[2] += pairs != (near ? LayoutCount(l, v) * LayoutCount(l, u) : 0);
    }
  TestCall(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CHECK(count[0] > 15 && count[1] > 40 && !count[2],
        "nine vesicles: %d pairs nearer than %d cells have C, %d others have none, %d are wrong", (int)count[0],
        NEAR_REACH, (int)count[1], (int)count[2]);
}

void Facts(void) {
  static const char *const kernels[] = {"cbs54", "ib6"};
  OffsetTable table, pressure;
  TestAbout("lattice");
  TestCall(LatticeStokeslet(42, &table));
  TestCall(LatticePressure(42, &pressure));
  CheckTable(&table, &pressure);
  TestAbout("reach");
  CheckReach();
  for (int k = 0; k < 2; k++) {
    CheckSymmetry("two, walls", TWO_WALLS, kernels[k]);
    CheckSymmetry("three, periodic", THREE_PERIODIC, kernels[k]);
    CheckSymmetry("over a seam", SEAM, kernels[k]);
  }
  TestCall(OffsetTableDestroy(&table));
  TestCall(OffsetTableDestroy(&pressure));
}
