/* What every C test needs: a program that states facts, one line each ("ok ..." or "not ok ..."), and fails when one
   does not hold. Each test_*.c is one MPI program, run by test_programs.py on several rank counts. */
#pragma once
#include "base/base.h"

static int check_failed;

/* CHECK - state a fact; collective: it holds when it holds on every rank. */
#define CHECK(condition, ...) PetscCall(CheckFact((condition) ? PETSC_TRUE : PETSC_FALSE, __VA_ARGS__))

static inline PetscErrorCode PETSC_ATTRIBUTE_FORMAT(2, 3) CheckFact(PetscBool holds, const char format[], ...) {
  char text[1024];
  int here = holds ? 1 : 0, everywhere;
  va_list arguments;
  PetscFunctionBeginUser;
  va_start(arguments, format);
  vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  PetscCallMPI(MPI_Allreduce(&here, &everywhere, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (!everywhere) check_failed++;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s %s\n", everywhere ? "ok" : "not ok", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestKeep - what is to be destroyed when the program ends. */
static struct {
  PetscObject *object;
  PetscInt n, room;
} test_kept;

static inline PetscErrorCode TestKeep(PetscObject object) {
  PetscFunctionBeginUser;
  if (test_kept.n == test_kept.room) {
    test_kept.room = 2 * test_kept.room + 16;
    PetscCall(PetscRealloc(sizeof(PetscObject) * (size_t)test_kept.room, &test_kept.object));
  }
  test_kept.object[test_kept.n++] = object;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestDestroyKept(void) {
  PetscFunctionBeginUser;
  while (test_kept.n) PetscCall(PetscObjectDestroy(&test_kept.object[--test_kept.n]));
  PetscCall(PetscFree(test_kept.object));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestVecs - vectors like x, up to a NULL, which the end of the program destroys. */
static inline PetscErrorCode TestVecsLike(Vec x, va_list list) {
  PetscFunctionBeginUser;
  for (Vec *y; (y = va_arg(list, Vec *));) {
    PetscCall(VecDuplicate(x, y));
    PetscCall(TestKeep((PetscObject)*y));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestVecs(Vec x, ...) {
  va_list list;
  PetscFunctionBeginUser;
  va_start(list, x);
  PetscCall(TestVecsLike(x, list));
  va_end(list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestUnit - x becomes the unit vector of entry k. Collective. */
static inline PetscErrorCode TestUnit(PetscInt k, Vec x) {
  PetscFunctionBeginUser;
  PetscCall(VecSet(x, 0));
  PetscCall(VecSetValue(x, k, 1, INSERT_VALUES));
  PetscCall(VecAssemblyBegin(x));
  PetscCall(VecAssemblyEnd(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestApart - |x - y|/|y| in a norm; x is overwritten. TestRemoveMean - x less its mean. Collective. */
static inline PetscErrorCode TestApart(NormType norm, Vec x, Vec y, PetscReal *apart) {
  PetscReal size;
  PetscFunctionBeginUser;
  PetscCall(VecNorm(y, norm, &size));
  PetscCall(VecAXPY(x, -1, y));
  PetscCall(VecNorm(x, norm, apart));
  *apart /= size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestRemoveMean(Vec x) {
  PetscScalar sum;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(VecSum(x, &sum));
  PetscCall(VecGetSize(x, &n));
  PetscCall(VecShift(x, -sum / n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestTransposed - |<A x, y> - <x, A^T y>| over the size of the terms in the sums; 1 where a product is zero.
   Collective. */
static inline PetscErrorCode TestTransposed(Mat A, Vec x, Vec y, PetscReal *error) {
  Vec Ax, Aty;
  PetscReal one, two, size[4];
  PetscFunctionBeginUser;
  PetscCall(TestVecs(y, &Ax, NULL));
  PetscCall(TestVecs(x, &Aty, NULL));
  PetscCall(MatMult(A, x, Ax));
  PetscCall(MatMultTranspose(A, y, Aty));
  PetscCall(VecDot(Ax, y, &one));
  PetscCall(VecDot(x, Aty, &two));
  PetscCall(VecNorm(Ax, NORM_2, &size[0]));
  PetscCall(VecNorm(y, NORM_2, &size[1]));
  PetscCall(VecNorm(Aty, NORM_2, &size[2]));
  PetscCall(VecNorm(x, NORM_2, &size[3]));
  *error = size[0] > 0 && size[2] > 0 ? PetscAbsReal(one - two) / PetscMax(size[0] * size[1], size[2] * size[3]) : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* CheckMain - main() of a test program. */
static inline int CheckMain(int argc, char **argv, PetscErrorCode (*facts)(void)) {
  if (PetvesInitialize(&argc, &argv)) return 1;
  const PetscErrorCode error = facts();
  if (TestDestroyKept() || PetvesFinalize() || error) return 1;
  return check_failed ? 1 : 0;
}

/* TestRandom - reproducible numbers in (-1, 1), the same on every rank and in every run. */
static inline PetscReal TestRandom(unsigned *state) {
  *state = *state * 1664525u + 1013904223u;
  return 2 * ((*state >> 8) + 0.5) / (1 << 24) - 1;
}

/* TestRandomVec - entry k of the vector is number k of one sequence, whatever the number of ranks. */
static inline PetscErrorCode TestRandomVec(unsigned seed, Vec x) {
  PetscScalar *a;
  PetscInt n, first;
  unsigned state = seed;
  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecGetOwnershipRange(x, &first, NULL));
  for (PetscInt i = 0; i < first; i++) (void)TestRandom(&state);
  PetscCall(VecGetArray(x, &a));
  for (PetscInt i = 0; i < n; i++) a[i] = TestRandom(&state);
  PetscCall(VecRestoreArray(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
