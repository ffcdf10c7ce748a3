/* Markers of several vesicles that belong to different ranks, across seams and borders between ranks: interpolation
   against its sum written out, spreading as its exact transpose, the lists of stencils, and what is wrong with one
   rank's markers. */
#include "facts.h"
#include "markers/wallfold.h"

#define TOLERANCE 1e-13 /* relative: round-off of sums of some thousand terms */

#define CELLS "-domain_cells 60,60 "

/* Five vesicles of different size; in a periodic box the second lies across the seam in x, the third across that in y,
   the fourth across both. */
#define VESICLES                                                                                                       \
  "-vesicle_count 5 -vesicle_semi_axes 0.3,0.35,0.15,0.2,0.2,0.25,0.12,0.14,0.25,0.1 -vesicle_angle 0,20,40,60,80 "
#define ACROSS VESICLES "-vesicle_center 0.05,0.03,0.97,0.1,-0.5,0.96,0.93,-0.95,-0.45,-0.45 "
#define INSIDE VESICLES "-vesicle_center 0.05,0.03,0.6,0.3,-0.5,0.5,0.5,-0.5,-0.45,-0.45 "

/* Some a third of a cell from a wall, the fourth from both in a corner. */
#define AT_WALLS                                                                                                       \
  "-coupling_near_field exact -scheme_type coupled " VESICLES                                                          \
  "-vesicle_center 0.05,0.64,-0.8314,0.5,-0.5,-0.1,0.8547,-0.8547,-0.2,-0.6 "

/* Weight in one direction of a face at `face` for a marker at x, of all images where periodic; folded, of its mirror
   images in the walls too, with the sign of the flow that continues across them, and scaled. */
static PetscReal FaceWeight(Markers m, int comp, int dir, PetscReal x, PetscReal face) {
  const Grid g = m->grid;
  const KernelWeights weights = comp == dir ? m->kernel->along : m->kernel->across;
  PetscReal sum = 0, scale = 1;
  for (int image = g->wall[dir] ? 0 : -1; image <= (g->wall[dir] ? 0 : 1); image++)
    sum += TestWeight(weights, (x - face) / g->h - image * g->n[dir]);
  for (int side = 0; side < 2 && m->folded && g->wall[dir]; side++) {
    const PetscReal wall = side ? g->hi[dir] : g->lo[dir], mirror = 2 * wall - face;
    sum += (comp == dir ? 1 : -1) * TestWeight(weights, (x - mirror) / g->h);
    if (comp == dir) scale *= WallScale(m->kernel, PetscAbsReal(x - wall) / g->h);
  }
  return scale * sum;
}

/* A rough velocity. */
static PetscReal Velocity(const void *ctx, Field f, const PetscReal X[2]) {
  return PetscSinReal(51 * X[0] + 87 * X[1] + 0.4 * f + 9 * X[0] * X[1]);
}

/* SUM u(x) phi phi over every face of the grid, for a marker at X. */
static PetscReal Sum(Markers m, int comp, const PetscReal X[2]) {
  const Grid g = m->grid;
  PetscReal sum = 0, face[2];
  for (PetscInt j = 0; j < g->all_rows[comp]; j++) {
    GridPosition(g, (Field)comp, 0, j, face);
    const PetscReal across = FaceWeight(m, comp, 1, X[1], face[1]);
    for (PetscInt i = 0; i < g->columns[comp] && across != 0; i++) {
      GridPosition(g, (Field)comp, i, j, face);
      sum += Velocity(NULL, (Field)comp, face) * across * FaceWeight(m, comp, 0, X[0], face[0]);
    }
  }
  return sum;
}

static void CheckInterpolation(TestWorld *t) {
  const Markers m = t->coupling->markers;
  PetscReal error = 0;
  Vec w, U;
  TestFieldVecs(t->fluid->grid->velocity, &w, NULL);
  TestVecs(t->X, &U, NULL);
  TestFill(t->fluid->grid, FIELD_U, FIELD_V, Velocity, NULL, w);
  TestCall(MarkersInterpolate(m, w, U));
  const PetscScalar *X = TestArray(t->X), *got = TestArray(U);
  for (PetscInt k = 0; k < 2 * t->layout->n; k++) TestWorse(&error, got[k] - Sum(m, k % 2, X + k - k % 2));
  CheckBelow(error, TOLERANCE, "every marker's velocity is the sum over all faces");
}

/* <E w, F> = <w, E^T F>, and two times E^T F comes on top of what is there. */
static void CheckTranspose(TestWorld *t, unsigned seed) {
  const Markers m = t->coupling->markers;
  Vec w, spread, F;
  TestFieldVecs(t->fluid->grid->velocity, &w, &spread, NULL);
  TestVecs(t->X, &F, NULL);
  TestRandomVecs(seed, w, F, NULL);
  CheckBelow(TestTransposed(m->E, w, F), TOLERANCE, "E and E^T are transposes");
  TestCall(MatMultTranspose(m->E, F, spread));
  TestCall(VecAXPY(spread, 1, w));
  TestCall(MarkersSpread(m, 1, F, w)); /* w + E^T F */
  TestCall(VecAXPY(w, -1, spread));
  CheckBelow(TestNorm(NORM_INFINITY, w), TOLERANCE, "spreading adds to what is there");
}

/* How often row j of this rank, or the one above them, has an entry of stencil k, and whether it is the right one. */
static int Listed(Markers m, PetscInt k, PetscInt j) {
  const StencilRows r = m->rows;
  const Stencil *s = &m->stencil[k];
  int times = 0;
  for (PetscInt e = r->start[k % 2][j]; e < r->start[k % 2][j + 1]; e++) {
    const RowEntry at = r->entry[k % 2][e];
    const PetscInt n = m->grid->n[1], b = (m->grid->first + j - s->first[1] + n) % n;
    if (at.stencil == k) times += b < s->n[1] && at.value == s->weight[1][b] && at.source == k ? 1 : 2;
  }
  return times;
}

/* The rows' lists have every stencil with a weight there once, in order; each stencil is as long on all ranks together
   as it is. */
static void CheckList(TestWorld *t) {
  const Markers m = t->coupling->markers;
  const Grid g = m->grid;
  PetscInt missed = 0, twice = 0, order = 0, wrong = 0;
  PetscMPIInt *here, *all;
  TestCall(PetscCalloc2(2 * t->layout->M, &here, 2 * t->layout->M, &all));
  for (PetscInt k = 0; k < 2 * t->layout->M; k++) {
    const int c = (int)(k % 2);
    for (PetscInt j = 0; j < g->rows[c] + (g->size > 1 && g->above != MPI_PROC_NULL ? 1 : 0); j++) {
      const int times = Listed(m, k, j);
      PetscReal face[2];
      GridPosition(g, (Field)c, 0, (j + g->first) % g->n[1], face);
      if (times == 0 && FaceWeight(m, c, 1, m->X[k - c + 1], face[1]) != 0) missed++;
      if (times > 1) twice++;
      here[k] += j < g->rows[c] ? times : 0;
    }
  }
  for (int c = 0; c < 2; c++)
    for (PetscInt j = 0; j <= g->rows[c]; j++)
      for (PetscInt e = m->rows->start[c][j] + 1; e < m->rows->start[c][j + 1]; e++)
        order += m->rows->entry[c][e - 1].stencil >= m->rows->entry[c][e].stencil;
  CHECK(!missed, "no row misses a stencil that has a weight there");
  CHECK(!twice, "every stencil is in a row once, with the row of its own that it is");
  CHECK(!order, "the stencils of a row are in order");
  TestCall(MPI_Allreduce(here, all, (PetscMPIInt)(2 * t->layout->M), MPI_INT, MPI_SUM, t->layout->comm));
  for (PetscInt k = 0; k < 2 * t->layout->M; k++) wrong += !g->wall[1] && all[k] != m->stencil[k].n[1];
  CHECK(!wrong, "every row of every stencil is on one rank");
  TestCall(PetscFree2(here, all));
}

static void CheckCase(const char box[], const char vesicles[], const char kernel[]) {
  ScopedWorld t;
  TestWorldCreate(&t, "%s %s -delta_type %s", box, vesicles, kernel);
  TestAbout("%s %s", box, kernel);
  CHECK(t.layout->bodies == 5, "five vesicles, %d markers in all", (int)t.layout->M);
  CheckInterpolation(&t);
  for (unsigned k = 0; k < 3; k++) CheckTranspose(&t, 31 + 2 * k);
  CheckList(&t);
}

/* MarkersCheck of marker 0 of one vesicle moved to (x, y): all ranks have the message, which names the vesicle and
   says `what`; what NULL: there is none. */
static void CheckMessage(TestWorld *t, PetscInt vesicle, PetscReal x, PetscReal y, const char what[]) {
  char message[PETVES_MAX_MESSAGE];
  const PetscScalar move[2] = {x, y};
  Vec X;
  TestVecs(t->X, &X, NULL);
  TestCall(VecCopy(t->X, X));
  PetscScalar *a = TestArray(X);
  for (int c = 0; c < 2 && LayoutOwner(t->layout, vesicle) == t->layout->rank; c++)
    a[2 * LayoutOffset(t->layout, vesicle) + c] = move[c];
  TestCall(MarkersCheck(t->coupling->markers, t->coupling->markers->layout, X, message));
  const char *who = TestText("vesicle %d:", (int)vesicle + 1);
  CHECK(what ? strstr(message, who) && strstr(message, what) : !*message,
        "a marker of vesicle %d at (%g, %g), known on all ranks: %s", (int)vesicle + 1, x, y,
        *message ? message : "good");
}

static void CheckMessages(void) {
  ScopedWorld t, walls;
  TestWorldCreate(&t, CELLS CHANNEL INSIDE);
  TestWorldCreate(&walls, CELLS CHANNEL AT_WALLS);
  for (PetscInt v = 0; v < 5; v++) {
    CheckMessage(&t, v, 0.3, 1 - 2.9 / 30, "y_max");
    CheckMessage(&t, v, 0.3, -1 + 2.9 / 30, "y_min");
    CheckMessage(&t, v, NAN, 0, "not finite");
    CheckMessage(&t, v, 0.3, INFINITY, "not finite");
    CheckMessage(&t, v, 5.3, 1 - 3.1 / 30, NULL);
    CheckMessage(&walls, v, 0.3, 1 - 0.24 / 30, "y_max");
    CheckMessage(&walls, v, 0.3, 1 - 0.26 / 30, NULL);
  }
}

/* A folded stencil gives flows that are zero at the wall there: y along it exactly, y^2 across it up to where the scale
   ends, in the last cell before FOLD_SCALED. */
static void CheckFold(void) {
  static const char *const kernels[] = {"ib6", "cbs54"};
  for (int k = 0; k < 2; k++) {
    const Kernel *kernel = KernelFind(kernels[k]);
    PetscReal error = 0;
    for (int step = 0; step <= 40; step++) {
      const PetscReal y = 0.075 * step;
      PetscReal w[KERNEL_MAX_POINTS], sum = 0;
      PetscInt first, n = kernel->along(y - 1, &first, w);
      FoldLow(FOLD_EVEN, &first, &n, w);
      for (PetscInt q = 0; q < n; q++) sum += WallScale(kernel, y) * w[q] * PetscSqr(first + q + 1);
      if (y <= FOLD_SCALED - 1) TestWorse(&error, sum - y * y);
      n = kernel->across(y - 0.5, &first, w);
      FoldLow(FOLD_ODD, &first, &n, w);
      sum = 0;
      for (PetscInt q = 0; q < n; q++) sum += w[q] * (first + q + 0.5);
      TestWorse(&error, sum - y);
      if (!step) CheckBelow(sum, 1e-14, "%s: no flow at the wall", kernels[k]);
    }
    CheckBelow(error, 1e-13, "%s: y along and y^2 across a wall are exact at it", kernels[k]);
  }
}

void Facts(void) {
  static const struct {
    const char *box, *vesicles, *kernel;
  } cases[] = {{CELLS PERIODIC, ACROSS, "ib6"},  {CELLS PERIODIC, ACROSS, "cbs54"}, {OBLONG PERIODIC, ACROSS, "cbs54"},
               {CELLS CHANNEL, INSIDE, "cbs54"}, {CELLS, INSIDE, "cbs54"},          {CELLS, AT_WALLS, "ib6"},
               {CELLS, AT_WALLS, "cbs54"},       {CELLS CHANNEL, AT_WALLS, "ib6"}};
  CheckFold();
  CheckMessages();
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(cases); k++)
    CheckCase(cases[k].box, cases[k].vesicles, cases[k].kernel);
}
