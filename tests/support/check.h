/* What every C test needs: a program that states facts, one line each ("ok ..." or "not ok ..."), and fails when one
   does not hold. Each test_*.c is one MPI program, run by test_programs.py on several rank counts. */
#pragma once
#include "base/base.h"

static int check_failed;

/* TestCall - a call of the library, of PETSc or of MPI: an error ends the program on all ranks, so that what calls it
   returns nothing, or its result. */
#define TestCall(...) PetscCallAbort(PETSC_COMM_WORLD, __VA_ARGS__)

/* TestPrint - a text as of printf into text[TEST_TEXT]. */
#define TEST_TEXT 4096
#define TestPrint(text, format)                                                                                        \
  do {                                                                                                                 \
    va_list arguments;                                                                                                 \
    va_start(arguments, format);                                                                                       \
    vsnprintf(text, TEST_TEXT, format, arguments);                                                                     \
    va_end(arguments);                                                                                                 \
  } while (0)

/* TestAbout - what the facts that follow are about: it stands before each of them, up to the next call. */
static char test_subject[TEST_TEXT];

static inline void PETSC_ATTRIBUTE_FORMAT(1, 2) TestAbout(const char format[], ...) {
  TestPrint(test_subject, format);
}

/* CHECK - state a fact; collective: it holds when it holds on every rank. */
#define CHECK(condition, ...) CheckFact((condition) ? PETSC_TRUE : PETSC_FALSE, __VA_ARGS__)

static inline void PETSC_ATTRIBUTE_FORMAT(2, 3) CheckFact(PetscBool holds, const char format[], ...) {
  char text[TEST_TEXT];
  int here = holds ? 1 : 0, everywhere;
  TestPrint(text, format);
  TestCall(MPI_Allreduce(&here, &everywhere, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (!everywhere) check_failed++;
  TestCall(PetscPrintf(PETSC_COMM_WORLD, "%s %s%s%s\n", everywhere ? "ok" : "not ok", test_subject,
                       *test_subject ? ": " : "", text));
}

/* TestWorse - |x| takes the place of `worst` where it is larger, infinity where x is not a number. */
static inline void TestWorse(PetscReal *worst, PetscReal x) {
  if (!(PetscAbsReal(x) <= *worst)) *worst = PetscIsNanReal(x) ? PETSC_INFINITY : PetscAbsReal(x);
}

/* CheckBelow - state that |x| < bound on every rank, with the largest |x|; collective. */
static inline void PETSC_ATTRIBUTE_FORMAT(3, 4) CheckBelow(PetscReal x, PetscReal bound, const char format[], ...) {
  char text[TEST_TEXT];
  PetscReal most = 0;
  TestPrint(text, format);
  TestWorse(&most, x);
  TestCall(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  CheckFact(most < bound, "%s, %.1e", text, most);
}

/* TestKeep - what is to be destroyed, or freed, when the program ends. */
struct TestKept {
  void *what;
  PetscBool is_object;
  struct TestKept *before;
};

static struct TestKept *test_kept;

static inline void TestKeep(void *what, PetscBool is_object) {
  struct TestKept *kept;
  TestCall(PetscNew(&kept));
  *kept = (struct TestKept){what, is_object, test_kept};
  test_kept = kept;
}

static inline void TestDestroyKept(void) {
  for (struct TestKept *kept; (kept = test_kept);) {
    test_kept = kept->before;
    TestCall(kept->is_object ? PetscObjectDestroy((PetscObject *)&kept->what) : PetscFree(kept->what));
    TestCall(PetscFree(kept));
  }
}

/* TestReals - n zeros, which the end of the program frees. */
static inline PetscReal *TestReals(PetscInt n) {
  PetscReal *x;
  TestCall(PetscCalloc1(n, &x));
  TestKeep(x, PETSC_FALSE);
  return x;
}

/* Scoped - variables of a type that the end of their block destroys, as TestScoped(type, what destroys it) says. */
#define Scoped(Type) __attribute__((cleanup(Type##Leave))) Type
#define TestScoped(Type, destroy)                                                                                      \
  static inline void Type##Leave(Type *x) {                                                                            \
    TestCall(destroy(x));                                                                                              \
  }

TestScoped(Mat, MatDestroy);

/* TestText - a text as of printf. TestScratch - the name of a scratch file. The end of the program frees them. */
static inline const char *PETSC_ATTRIBUTE_FORMAT(1, 2) TestText(const char format[], ...) {
  char text[TEST_TEXT], *kept;
  TestPrint(text, format);
  TestCall(PetscStrallocpy(text, &kept));
  TestKeep(kept, PETSC_FALSE);
  return kept;
}

static inline const char *TestScratch(const char name[]) {
  const char *folder = getenv("PETVES_SCRATCH");
  return TestText("%s%s", folder ? folder : "/tmp/", name);
}

/* TestVecs - vectors like x, up to a NULL, which the end of the program destroys. */
static inline void TestVecsLike(Vec x, va_list list) {
  for (Vec *y; (y = va_arg(list, Vec *));) {
    TestCall(VecDuplicate(x, y));
    TestKeep(*y, PETSC_TRUE);
  }
}

static inline void TestVecs(Vec x, ...) {
  va_list list;
  va_start(list, x);
  TestVecsLike(x, list);
  va_end(list);
}

/* TestArray - what this rank has of a vector, to read and to write until PETSc has the vector again. */
static inline PetscScalar *TestArray(Vec x) {
  PetscScalar *a, *numbers;
  TestCall(VecGetArray(x, &a));
  numbers = a;
  TestCall(VecRestoreArray(x, &a)); /* a is NULL then */
  return numbers;
}

/* TestUnit - x becomes the unit vector of entry k. Collective. */
static inline void TestUnit(PetscInt k, Vec x) {
  TestCall(VecSet(x, 0));
  TestCall(VecSetValue(x, k, 1, INSERT_VALUES));
  TestCall(VecAssemblyBegin(x));
  TestCall(VecAssemblyEnd(x));
}

/* TestSum, TestMost - of n numbers over all ranks, in their place. */
static inline void TestSum(PetscMPIInt n, PetscReal x[]) {
  TestCall(MPI_Allreduce(MPI_IN_PLACE, x, n, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
}

static inline void TestMost(PetscMPIInt n, PetscReal x[]) {
  TestCall(MPI_Allreduce(MPI_IN_PLACE, x, n, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
}

/* TestFar - largest |x_k - y_k| of n numbers, y NULL: |x_k|. TestProduct - SUM x_k y_k. TestAsymmetry - largest
   |A - A^T| of a matrix [n][n]. Of this rank alone. */
static inline PetscReal TestFar(PetscInt n, const PetscReal x[], const PetscReal y[]) {
  PetscReal far = 0;
  for (PetscInt k = 0; k < n; k++) TestWorse(&far, x[k] - (y ? y[k] : 0));
  return far;
}

static inline PetscReal TestProduct(PetscInt n, const PetscReal x[], const PetscReal y[]) {
  PetscReal sum = 0;
  for (PetscInt k = 0; k < n; k++) sum += x[k] * y[k];
  return sum;
}

static inline PetscReal TestAsymmetry(PetscInt n, const PetscReal A[]) {
  PetscReal most = 0;
  for (PetscInt k = 0; k < n * n; k++) TestWorse(&most, A[k] - A[k % n * n + k / n]);
  return most;
}

/* TestNorm - |x|. TestTotal - SUM x_k. TestDot - <x, y>. TestApart - |x - y|/|y|; x is overwritten. TestRemoveMean - x
   less its mean. Collective. */
static inline PetscReal TestNorm(NormType norm, Vec x) {
  PetscReal size;
  TestCall(VecNorm(x, norm, &size));
  return size;
}

static inline PetscScalar TestTotal(Vec x) {
  PetscScalar sum;
  TestCall(VecSum(x, &sum));
  return sum;
}

static inline PetscReal TestDot(Vec x, Vec y) {
  PetscScalar product;
  TestCall(VecDot(x, y, &product));
  return product;
}

static inline PetscReal TestApart(NormType norm, Vec x, Vec y) {
  TestCall(VecAXPY(x, -1, y));
  return TestNorm(norm, x) / TestNorm(norm, y);
}

static inline void TestRemoveMean(Vec x) {
  PetscInt n;
  TestCall(VecGetSize(x, &n));
  TestCall(VecShift(x, -TestTotal(x) / n));
}

/* TestTransposed - |<A x, y> - <x, A^T y>| over the size of the terms in the sums; 1 where a product is zero.
   Collective. */
static inline PetscReal TestTransposed(Mat A, Vec x, Vec y) {
  Vec Ax, Aty;
  TestVecs(y, &Ax, NULL);
  TestVecs(x, &Aty, NULL);
  TestCall(MatMult(A, x, Ax));
  TestCall(MatMultTranspose(A, y, Aty));
  const PetscReal size[2] = {TestNorm(NORM_2, Ax) * TestNorm(NORM_2, y), TestNorm(NORM_2, Aty) * TestNorm(NORM_2, x)};
  const PetscReal off = PetscAbsReal(TestDot(Ax, y) - TestDot(x, Aty));
  return size[0] > 0 && size[1] > 0 ? off / PetscMax(size[0], size[1]) : 1;
}

/* CheckMain - main() of a test program. */
static inline int CheckMain(int argc, char **argv, void (*facts)(void)) {
  if (PetvesInitialize(&argc, &argv)) return 1;
  facts();
  TestDestroyKept();
  return PetvesFinalize() || check_failed ? 1 : 0;
}

/* TestRandom - reproducible numbers in (-1, 1), the same on every rank and in every run. */
static inline PetscReal TestRandom(unsigned *state) {
  *state = *state * 1664525u + 1013904223u;
  return 2 * ((*state >> 8) + 0.5) / (1 << 24) - 1;
}

/* TestRandoms - n of them, which the end of the program frees. */
static inline PetscReal *TestRandoms(PetscInt n, unsigned *state) {
  PetscReal *x = TestReals(n);
  for (PetscInt k = 0; k < n; k++) x[k] = TestRandom(state);
  return x;
}

/* TestRandomVec - entry k of the vector is number k of one sequence, whatever the number of ranks. */
static inline void TestRandomVec(unsigned seed, Vec x) {
  PetscScalar *a = TestArray(x);
  PetscInt n, first;
  unsigned state = seed;
  TestCall(VecGetLocalSize(x, &n));
  TestCall(VecGetOwnershipRange(x, &first, NULL));
  for (PetscInt i = 0; i < first; i++) (void)TestRandom(&state);
  for (PetscInt i = 0; i < n; i++) a[i] = TestRandom(&state);
}

/* TestRandomVecs - vectors up to a NULL, by seeds that follow one another. */
static inline void TestRandomVecs(unsigned seed, Vec x, ...) {
  va_list list;
  va_start(list, x);
  for (; x; x = va_arg(list, Vec)) TestRandomVec(seed++, x);
  va_end(list);
}
