#include "numerics/symmetric.h"
#include "numerics/blas.h"

#define WIDE 8
typedef float Wide __attribute__((vector_size(WIDE * sizeof(float)), aligned(sizeof(float)), may_alias));

static inline Wide WideAt(const float x[]) {
  return *(const Wide *)x;
}

static inline float WideSum(Wide x) {
  return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

void SymmetricPack(PetscInt n, const float A[], float packed[]) {
  for (PetscInt j = 0; j < n; j += SYMMETRIC_PANEL)
    for (PetscInt c = j; c < j + SYMMETRIC_PANEL; c++)
      for (PetscInt i = j; i < n; i++) *packed++ = c < n ? A[c * n + i] : 0;
}

/* PETSc names the routines of its own precision only. */
extern void sgetrf_(const PetscBLASInt *, const PetscBLASInt *, float *, const PetscBLASInt *, PetscBLASInt *,
                    PetscBLASInt *);
extern void sgetri_(const PetscBLASInt *, float *, const PetscBLASInt *, const PetscBLASInt *, float *,
                    const PetscBLASInt *, PetscBLASInt *);

PetscErrorCode SymmetricInvert(PetscInt n, const PetscReal A[], float inverse[], PetscBool *done) {
  PetscBLASInt size, room, info, *pivot;
  float *single, *work;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(64 * n, &room));
  PetscCall(PetscMalloc3(n * n, &single, n, &pivot, 64 * n, &work));
  DenseSingle(n * n, A, single);
  PetscCallBLAS("sgetrf", sgetrf_(&size, &size, single, &size, pivot, &info));
  *done = info ? PETSC_FALSE : PETSC_TRUE;
  if (*done) PetscCallBLAS("sgetri", sgetri_(&size, single, &size, pivot, work, &room, &info));
  if (*done) SymmetricPack(n, single, inverse);
  PetscCall(PetscFree3(single, pivot, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y += A x of the rows below a panel's first four, and what they say of the panel's own: sum[4]. m rows in all. */
static inline void MultBelow(PetscInt m, const float *panel, const float own[SYMMETRIC_PANEL], const float x[],
                             float y[], float sum[SYMMETRIC_PANEL]) {
  Wide part[SYMMETRIC_PANEL] = {{0}};
  PetscInt i = SYMMETRIC_PANEL;
  for (; i + WIDE <= m; i += WIDE) {
    const Wide at = WideAt(x + i);
    Wide add = WideAt(y + i);
    for (int c = 0; c < SYMMETRIC_PANEL; c++) {
      const Wide a = WideAt(panel + c * m + i);
      add += own[c] * a;
      part[c] += a * at;
    }
    *(Wide *)(y + i) = add;
  }
  for (int c = 0; c < SYMMETRIC_PANEL; c++) sum[c] = WideSum(part[c]);
  for (; i < m; i++)
    for (int c = 0; c < SYMMETRIC_PANEL; c++) {
      y[i] += own[c] * panel[c * m + i];
      sum[c] += panel[c * m + i] * x[i];
    }
}

void SymmetricMult(PetscInt n, const float packed[], const float x[], float y[]) {
  (void)PetscArrayzero(y, n);
  for (PetscInt j = 0; j < n; j += SYMMETRIC_PANEL) {
    const PetscInt m = n - j, columns = PetscMin(m, SYMMETRIC_PANEL);
    float own[SYMMETRIC_PANEL] = {0}, sum[SYMMETRIC_PANEL];
    for (PetscInt c = 0; c < columns; c++) own[c] = x[j + c];
    MultBelow(m, packed, own, x + j, y + j, sum);
    for (PetscInt c = 0; c < columns; c++) {
      y[j + c] += sum[c];
      for (PetscInt i = 0; i < columns; i++) y[j + i] += packed[c * m + i] * own[c];
    }
    packed += SYMMETRIC_PANEL * (size_t)m;
  }
}
