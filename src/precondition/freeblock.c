#include "precondition/freeblock.h"
#include "bodies/repulsion.h"
#include "numerics/blas.h"

struct _p_FreeBlock {
  Obstacles obstacles; /* borrowed */
  PetscInt n, m;       /* 2W, 3 free */
  PetscReal *arm;      /* [2W] markers less the center of their body */
  PetscReal *over;     /* [m] 1, 1 and 1/radius of each body, by which R is scaled: floats have no room for a length */
  float *response;     /* [m][2W] A^-1 m R over */
  PetscReal *resistance; /* [m][m] R^T A^-1 m R over */
  PetscReal *D;          /* [m][m] */
  PetscReal *S;          /* [m][m] (R^T A^-1 m R + D) over, factored */
  PetscBLASInt *pivot;   /* [m] */
  PetscReal *sum;        /* [m] work */
  PetscScalar *F;        /* [2W] work */
};

PetscErrorCode FreeBlockCreate(Obstacles o, FreeBlock *out) {
  FreeBlock b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->obstacles = o;
  b->n = 2 * o->layout->M;
  b->m = 3 * o->free->M;
  PetscCall(PetscMalloc6(b->n, &b->arm, b->m, &b->over, b->n * b->m, &b->response, b->m, &b->pivot, b->m, &b->sum, b->n,
                         &b->F));
  PetscCall(PetscMalloc3(b->m * b->m, &b->resistance, b->m * b->m, &b->D, b->m * b->m, &b->S));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBlockDestroy(FreeBlock *block) {
  FreeBlock b = *block;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree6(b->arm, b->over, b->response, b->pivot, b->sum, b->F));
  PetscCall(PetscFree3(b->resistance, b->D, b->S));
  PetscCall(PetscFree(*block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* R^T F of all free bodies. */
static void FreeBlockSums(FreeBlock b, const PetscScalar F[], PetscReal sum[]) {
  const Layout l = b->obstacles->layout;
  for (PetscInt body = 0; body < l->bodies; body++) {
    const PetscInt free = b->obstacles->motion[body].free, at = 2 * l->start[body];
    if (free) FreeBodySum(LayoutCount(l, body), b->arm + at, F + at, sum + 3 * (free - 1));
  }
}

PetscErrorCode FreeBlockSetUp(FreeBlock b, FreeBlockInverse *inverse, void *context) {
  const Obstacles o = b->obstacles;
  float *R;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n, &R));
  for (PetscInt body = 0; body < o->layout->bodies; body++) {
    const BodyPose p = MotionPose(&o->motion[body], o->at);
    for (PetscInt k = 2 * o->layout->start[body]; k < 2 * o->layout->start[body + 1]; k++)
      b->arm[k] = o->X[k] - p.center[k % 2];
  }
  for (PetscInt body = 0; body < o->layout->bodies; body++) {
    const PetscInt first = 3 * (o->motion[body].free - 1);
    for (PetscInt j = first; j >= 0 && j < first + 3; j++) {
      b->over[j] = j < first + 2 ? 1 : 1 / ObstacleRadius(o, body);
      PetscCall(PetscArrayzero(R, b->n));
      for (PetscInt k = 2 * o->layout->start[body]; k < 2 * o->layout->start[body + 1]; k++) {
        const PetscReal turn = k % 2 ? b->arm[k - 1] : -b->arm[k + 1];
        R[k] = (float)(o->ratio[body] * (j < first + 2 ? (k % 2 == j - first) : turn * b->over[j]));
      }
      PetscCall(inverse(context, R, b->response + j * b->n));
      for (PetscInt k = 0; k < b->n; k++) b->F[k] = b->response[j * b->n + k];
      FreeBlockSums(b, b->F, b->resistance + j * b->m);
    }
  }
  PetscCall(PetscFree(R));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBlockHold(FreeBlock b, PetscReal a0, const PetscReal mass[], Forces forces, PetscBool *done) {
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->D, b->m * b->m));
  for (PetscInt j = 0; j < b->m && mass; j++) b->D[j * (b->m + 1)] = a0 * mass[j];
  RepulsionHold(forces, b->obstacles->at.end, b->D);
  for (PetscInt k = 0; k < b->m * b->m; k++) b->S[k] = b->resistance[k] + b->D[k] * b->over[k / b->m];
  PetscCall(DenseFactor(b->m, b->S, b->pivot, done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBlockSolve(FreeBlock b, const float from[], PetscScalar q[], PetscScalar F[]) {
  const Obstacles o = b->obstacles;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < b->n; k++) F[k] = from[k];
  FreeBlockSums(b, F, b->sum);
  for (PetscInt j = 0; j < b->m; j++) b->sum[j] -= q[j];
  PetscCall(DenseSolve(b->m, b->S, b->pivot, PETSC_FALSE, 1, b->sum));
  for (PetscInt j = 0; j < b->m; j++)
    for (PetscInt k = 0; k < b->n; k++) F[k] -= b->sum[j] * b->response[j * b->n + k];
  for (PetscInt j = 0; j < b->m; j++) b->sum[j] *= b->over[j];
  PetscCall(DenseMultAdd(PETSC_FALSE, b->m, b->m, 1, b->D, b->sum, q)); /* R^T F */
  for (PetscInt body = 0; body < o->layout->bodies; body++) {
    const PetscInt first = 3 * (o->motion[body].free - 1), at = 2 * o->layout->start[body];
    if (first >= 0) FreeBodyBalance(LayoutCount(o->layout, body), b->arm + at, q + first, F + at);
  }
  PetscCall(PetscArraycpy(q, b->sum, b->m));
  PetscFunctionReturn(PETSC_SUCCESS);
}
