/* Which rank owns which body: ranges, shares of the work, and numbers that travel between owners and others. */
#include "facts.h"
#include "markers/layout.h"

#define MOST_BODIES 100

/* Sizes of bodies: markers of body b of n. */
typedef enum { EQUAL, GROWING, LARGE_FIRST, LARGE_LAST, MIXED } Sizes;

static PetscInt SizeOf(Sizes sizes, PetscInt b, PetscInt n) {
  const PetscBool large = sizes == LARGE_FIRST ? !b : b == n - 1;
  if (sizes == EQUAL) return 24;
  if (sizes == GROWING) return 5 + 11 * b;
  if (sizes == MIXED) return 1 + (b * 37 + 11) % 61;
  return large ? 400 : 3;
}

typedef struct {
  Layout l;
  PetscInt start[MOST_BODIES + 1];
} Case;

/* Ranges follow one another, and every body is in one of them, its owner's. */
static void CheckRanges(const Case *c) {
  const Layout l = c->l;
  PetscMPIInt own[MOST_BODIES], owners[MOST_BODIES], wrong = l->body[0] != 0 || l->body[l->size] != l->bodies;
  PetscInt n = 0;
  for (PetscMPIInt r = 0; r < l->size; r++) wrong += l->body[r] > l->body[r + 1];
  CHECK(!wrong, "ranges of bodies follow one another from the first body to the last");
  for (PetscInt b = 0; b < l->bodies; b++) {
    own[b] = b >= l->own && b < l->end;
    wrong += own[b] != (LayoutOwner(l, b) == l->rank) || (own[b] && LayoutOffset(l, b) != n);
    n += own[b] ? LayoutCount(l, b) : 0;
  }
  CHECK(!wrong && n == l->n, "a rank's markers are those of the bodies that it owns");
  CHECK(l->own == l->body[l->rank] && l->end == l->body[l->rank + 1] && l->first == c->start[l->own], "own range");
  TestCall(MPI_Allreduce(own, owners, (PetscMPIInt)l->bodies, MPI_INT, MPI_SUM, l->comm));
  for (PetscInt b = 0; b < l->bodies; b++) wrong += owners[b] != 1;
  CHECK(!wrong, "every body has one owner");
  for (PetscMPIInt r = 0; r < l->size; r++)
    for (int each = 1; each <= 2; each++)
      wrong += l->at[each - 1][r] != each * c->start[l->body[r]] ||
               l->count[each - 1][r] != each * (c->start[l->body[r + 1]] - c->start[l->body[r]]);
  CHECK(!wrong, "counts and places of all ranks' numbers");
}

/* A rank's work, the squares of its bodies' markers, is an equal share but for the largest body's. */
static void CheckShares(const Case *c) {
  const Layout l = c->l;
  PetscReal total = 0, largest = 0, mine = 0;
  for (PetscInt b = 0; b < l->bodies; b++) {
    const PetscReal work = PetscSqr((PetscReal)LayoutCount(l, b));
    total += work;
    largest = PetscMax(largest, work);
    if (b >= l->own && b < l->end) mine += work;
  }
  CHECK(PetscAbsReal(mine - total / l->size) <= largest * (1 + 1e-12),
        "shares of the work are equal to within one body: %g of %g on rank 0", mine, total);
}

/* The number that entry k of all is known by. */
static PetscScalar Known(PetscInt k) {
  return 1000.5 + 3 * k;
}

/* Whether a[n] are the known numbers from entry `first` on, times a factor. */
static PetscBool AreKnown(PetscInt n, const PetscScalar a[], PetscInt first, PetscReal factor) {
  for (PetscInt k = 0; k < n; k++)
    if (a[k] != factor * Known(first + k)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void CheckGather(Layout l, int each) {
  const PetscInt n = each * l->n, N = each * l->M, first = each * l->first;
  PetscScalar *all = TestReals(N), *own = TestReals(n);
  PetscInt size, local;
  Vec v;
  for (PetscInt k = 0; k < n; k++) own[k] = Known(first + k);
  TestCall(LayoutGather(l, each, own, all));
  CHECK(AreKnown(N, all, 0, 1), "%d a marker: every rank gathers all", each);
  TestMarkerVecs(l, each, &v, NULL);
  TestCall(VecGetSize(v, &size));
  TestCall(VecGetLocalSize(v, &local));
  CHECK(size == N && local == n && TestNorm(NORM_INFINITY, v) == 0,
        "%d a marker: a zero vector, each rank's part its own", each);
  TestCall(PetscArraycpy(TestArray(v), own, n));
  TestCall(PetscArrayzero(all, N));
  TestCall(LayoutGatherVec(l, v, all));
  CHECK(AreKnown(N, all, 0, 1), "%d a marker: a vector is gathered in the same order", each);
  for (PetscInt k = 0; k < N; k++) all[k] = (l->rank + 1) * Known(k);
  TestCall(LayoutSum(l, each, all, own));
  const PetscReal ranks = 0.5 * l->size * (l->size + 1); /* exact: halves of small integers */
  CHECK(AreKnown(n, own, first, ranks), "%d a marker: owners get the sum over ranks", each);
}

/* To one rank, whichever it is, and back; other ranks' arrays stay. */
static void CheckRoots(Layout l, int each) {
  const PetscInt n = each * l->n, N = each * l->M, first = each * l->first;
  PetscScalar *all = TestReals(N), *own = TestReals(n);
  PetscInt wrong = 0;
  for (PetscMPIInt root = 0; root < l->size; root++) {
    for (PetscInt k = 0; k < n; k++) own[k] = Known(first + k);
    for (PetscInt k = 0; k < N; k++) all[k] = -Known(k);
    TestCall(LayoutToRank(l, root, each, own, all));
    wrong += !AreKnown(N, all, 0, l->rank == root ? 1 : -1);
    for (PetscInt k = 0; k < N; k++) all[k] = (l->rank == root ? 4 : -9) * Known(k);
    TestCall(LayoutFromRank(l, root, each, all, own));
    wrong += !AreKnown(n, own, first, 4) || !AreKnown(N, all, 0, l->rank == root ? 4 : -9);
  }
  CHECK(!wrong, "%d a marker: to every rank and back", each);
}

static void CheckCase(PetscInt bodies, Sizes sizes) {
  static const char *const name[] = {"equal", "growing", "large first", "large last", "mixed"};
  Case c = {.start = {0}};
  PetscMPIInt ranks;
  TestCall(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  TestAbout("%d %s bodies on %d ranks", (int)bodies, name[sizes], ranks);
  for (PetscInt b = 0; b < bodies; b++) c.start[b + 1] = c.start[b] + SizeOf(sizes, b, bodies);
  TestCall(LayoutCreate(PETSC_COMM_WORLD, bodies, c.start, NULL, &c.l));
  CHECK(c.l->bodies == bodies && c.l->M == c.start[bodies] && c.l->size == ranks, "all of them");
  CheckRanges(&c);
  CheckShares(&c);
  for (int each = 1; each <= 2; each++) {
    CheckGather(c.l, each);
    CheckRoots(c.l, each);
  }
  TestCall(LayoutDestroy(&c.l));
  CHECK(!c.l, "destroyed");
}

void Facts(void) {
  static const struct {
    PetscInt bodies;
    Sizes sizes;
  } cases[] = {{0, EQUAL},       {1, EQUAL},      {2, GROWING},  {3, GROWING}, {5, EQUAL},
               {7, LARGE_FIRST}, {7, LARGE_LAST}, {20, GROWING}, {53, MIXED},  {MOST_BODIES, EQUAL}};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(cases); k++) CheckCase(cases[k].bodies, cases[k].sizes);
}
