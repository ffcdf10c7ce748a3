/* Which rank owns which body: ranges, shares of the work, and numbers that travel between owners and others. */
#include "facts.h"
#include "markers/layout.h"

#define MOST_BODIES 100

/* Markers of body b of n. */
typedef PetscInt (*Size)(PetscInt b, PetscInt n);

static PetscInt Equal(PetscInt b, PetscInt n) {
  return 24;
}
static PetscInt Growing(PetscInt b, PetscInt n) {
  return 5 + 11 * b;
}
static PetscInt LargeFirst(PetscInt b, PetscInt n) {
  return b ? 3 : 400;
}
static PetscInt LargeLast(PetscInt b, PetscInt n) {
  return b < n - 1 ? 3 : 400;
}
static PetscInt Mixed(PetscInt b, PetscInt n) {
  return 1 + (b * 37 + 11) % 61;
}

typedef struct {
  char name[64];
  Layout l;
  PetscInt start[MOST_BODIES + 1];
} Case;

/* Ranges follow one another, and every body is in one of them, its owner's. */
static void CheckRanges(const Case *c) {
  const Layout l = c->l;
  PetscBool good = l->body[0] == 0 && l->body[l->size] == l->bodies ? PETSC_TRUE : PETSC_FALSE;
  PetscMPIInt own[MOST_BODIES], owners[MOST_BODIES], wrong = 0;
  PetscInt n = 0;
  for (PetscMPIInt r = 0; r < l->size; r++)
    if (l->body[r] > l->body[r + 1]) good = PETSC_FALSE;
  CHECK(good, "%s: ranges of bodies follow one another from the first body to the last", c->name);
  for (PetscInt b = 0; b < l->bodies; b++) {
    own[b] = b >= l->own && b < l->end;
    if (own[b] != (LayoutOwner(l, b) == l->rank)) wrong++;
    if (own[b] && LayoutOffset(l, b) != n) wrong++;
    n += own[b] ? LayoutCount(l, b) : 0;
  }
  CHECK(!wrong && n == l->n, "%s: a rank's markers are those of the bodies that it owns", c->name);
  CHECK(l->own == l->body[l->rank] && l->end == l->body[l->rank + 1] && l->first == c->start[l->own], "%s: own range",
        c->name);
  TestCall(MPI_Allreduce(own, owners, (PetscMPIInt)l->bodies, MPI_INT, MPI_SUM, l->comm));
  for (PetscInt b = 0; b < l->bodies; b++)
    if (owners[b] != 1) wrong++;
  CHECK(!wrong, "%s: every body has one owner", c->name);
  for (PetscMPIInt r = 0; r < l->size; r++)
    for (int each = 1; each <= 2; each++)
      if (l->at[each - 1][r] != each * c->start[l->body[r]] ||
          l->count[each - 1][r] != each * (c->start[l->body[r + 1]] - c->start[l->body[r]]))
        wrong++;
  CHECK(!wrong, "%s: counts and places of all ranks' numbers", c->name);
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
        "%s: shares of the work are equal to within one body: %g of %g on rank 0", c->name, mine, total);
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

static void CheckGather(const Case *c, int each) {
  const Layout l = c->l;
  const PetscInt n = each * l->n, N = each * l->M, first = each * l->first;
  PetscScalar *all = TestReals(N), *own = TestReals(n);
  PetscInt size, local;
  Vec v;
  for (PetscInt k = 0; k < n; k++) own[k] = Known(first + k);
  TestCall(LayoutGather(l, each, own, all));
  CHECK(AreKnown(N, all, 0, 1), "%s, %d a marker: every rank gathers all", c->name, each);
  TestMarkerVecs(l, each, &v, NULL);
  TestCall(VecGetSize(v, &size));
  TestCall(VecGetLocalSize(v, &local));
  CHECK(size == N && local == n && TestNorm(NORM_INFINITY, v) == 0,
        "%s, %d a marker: a zero vector, each rank's part its own", c->name, each);
  TestCall(PetscArraycpy(TestArray(v), own, n));
  TestCall(PetscArrayzero(all, N));
  TestCall(LayoutGatherVec(l, v, all));
  CHECK(AreKnown(N, all, 0, 1), "%s, %d a marker: a vector is gathered in the same order", c->name, each);
  for (PetscInt k = 0; k < N; k++) all[k] = (l->rank + 1) * Known(k);
  TestCall(LayoutSum(l, each, all, own));
  const PetscReal ranks = 0.5 * l->size * (l->size + 1); /* exact: halves of small integers */
  CHECK(AreKnown(n, own, first, ranks), "%s, %d a marker: owners get the sum over ranks", c->name, each);
}

/* To one rank, whichever it is, and back; other ranks' arrays stay. */
static void CheckRoots(const Case *c, int each) {
  const Layout l = c->l;
  const PetscInt n = each * l->n, N = each * l->M, first = each * l->first;
  PetscScalar *all = TestReals(N), *own = TestReals(n);
  PetscInt wrong = 0;
  for (PetscMPIInt root = 0; root < l->size; root++) {
    for (PetscInt k = 0; k < n; k++) own[k] = Known(first + k);
    for (PetscInt k = 0; k < N; k++) all[k] = -Known(k);
    TestCall(LayoutToRank(l, root, each, own, all));
    if (!AreKnown(N, all, 0, l->rank == root ? 1 : -1)) wrong++;
    for (PetscInt k = 0; k < N; k++) all[k] = (l->rank == root ? 4 : -9) * Known(k);
    TestCall(LayoutFromRank(l, root, each, all, own));
    if (!AreKnown(n, own, first, 4)) wrong++;
    if (!AreKnown(N, all, 0, l->rank == root ? 4 : -9)) wrong++;
  }
  CHECK(!wrong, "%s, %d a marker: to every rank and back", c->name, each);
}

static void CheckCase(const char name[], PetscInt bodies, Size size) {
  Case c = {.start = {0}};
  PetscMPIInt ranks;
  TestCall(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  TestCall(PetscSNPrintf(c.name, sizeof(c.name), "%" PetscInt_FMT " %s bodies on %d ranks", bodies, name, ranks));
  for (PetscInt b = 0; b < bodies; b++) c.start[b + 1] = c.start[b] + size(b, bodies);
  TestCall(LayoutCreate(PETSC_COMM_WORLD, bodies, c.start, NULL, &c.l));
  CHECK(c.l->bodies == bodies && c.l->M == c.start[bodies] && c.l->size == ranks, "%s: all of them", c.name);
  CheckRanges(&c);
  CheckShares(&c);
  for (int each = 1; each <= 2; each++) {
    CheckGather(&c, each);
    CheckRoots(&c, each);
  }
  TestCall(LayoutDestroy(&c.l));
  CHECK(!c.l, "%s: destroyed", c.name);
}

void Facts(void) {
  CheckCase("equal", 0, Equal);
  CheckCase("equal", 1, Equal);
  CheckCase("growing", 2, Growing);
  CheckCase("growing", 3, Growing);
  CheckCase("equal", 5, Equal);
  CheckCase("large first", 7, LargeFirst);
  CheckCase("large last", 7, LargeLast);
  CheckCase("growing", 20, Growing);
  CheckCase("mixed", 53, Mixed);
  CheckCase("equal", MOST_BODIES, Equal);
}
