#include "precondition/freeblock.h"
#include "numerics/blas.h"

struct _p_FreeBlock {
  Obstacles obstacles; /* borrowed */
  PetscInt n, m;       /* 2W, 3 free */
  PetscReal *arm;      /* [2W] markers less the center of their body */
  PetscReal *over;     /* [m] 1, 1, 1/radius of each body: R is scaled, as single precision has no room for any unit */
  float *response;     /* [m][2W] A^-1 m R over */
  PetscReal *inertia;  /* [m] a0 M over */
  PetscReal *S;        /* [m][m] (R^T A^-1 m R + a0 M) over, factored */
  PetscBLASInt *pivot; /* [m] */
  PetscReal *sum;      /* [m] work */
  PetscScalar *F;      /* [2W] work */
};

PetscErrorCode FreeBlockCreate(Obstacles o, FreeBlock *out) {
  FreeBlock b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->obstacles = o;
  b->n = 2 * o->layout->M;
  b->m = 3 * o->free->M;
  PetscCall(PetscMalloc4(b->n, &b->arm, b->n * b->m, &b->response, b->m * b->m, &b->S, b->n, &b->F));
  PetscCall(PetscMalloc4(b->m, &b->over, b->m, &b->inertia, b->m, &b->pivot, b->m, &b->sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBlockDestroy(FreeBlock *block) {
  FreeBlock b = *block;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(b->arm, b->response, b->S, b->F));
  PetscCall(PetscFree4(b->over, b->inertia, b->pivot, b->sum));
  PetscCall(PetscFree(*block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const PetscReal origin[2] = {0, 0}; /* of arms */

/* R^T F of all free bodies. */
static void FreeBlockSums(FreeBlock b, const PetscScalar F[], PetscReal sum[]) {
  const Layout l = b->obstacles->layout;
  (void)PetscArrayzero(sum, b->m);
  for (PetscInt body = 0; body < l->bodies; body++) {
    const PetscInt free = b->obstacles->motion[body].free, at = 2 * l->start[body];
    if (free) MotionSum(origin, LayoutCount(l, body), b->arm + at, F + at, sum + 3 * (free - 1));
  }
}

PetscErrorCode FreeBlockSetUp(FreeBlock b, PetscReal a0, const PetscReal mass[], FreeBlockInverse *inverse,
                              void *context, PetscBool *done) {
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
      FreeBlockSums(b, b->F, b->S + j * b->m);
      b->inertia[j] = mass ? a0 * mass[j] * b->over[j] : 0;
      b->S[j * b->m + j] += b->inertia[j];
    }
  }
  PetscCall(DenseFactor(b->m, b->S, b->pivot, done));
  PetscCall(PetscFree(R));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBlockSolve(FreeBlock b, PetscScalar q[], PetscScalar F[]) {
  const Obstacles o = b->obstacles;
  PetscFunctionBeginUser;
  FreeBlockSums(b, F, b->sum);
  for (PetscInt j = 0; j < b->m; j++) b->sum[j] -= q[j];
  PetscCall(DenseSolve(b->m, b->S, b->pivot, PETSC_FALSE, 1, b->sum));
  for (PetscInt j = 0; j < b->m; j++)
    for (PetscInt k = 0; k < b->n; k++) F[k] -= b->sum[j] * b->response[j * b->n + k];
  for (PetscInt j = 0; j < b->m; j++) q[j] += b->inertia[j] * b->sum[j]; /* R^T F */
  for (PetscInt body = 0; body < o->layout->bodies; body++) {
    const PetscInt first = 3 * (o->motion[body].free - 1), at = 2 * o->layout->start[body];
    if (first >= 0) FreeBodyBalance(origin, LayoutCount(o->layout, body), b->arm + at, q + first, F + at);
  }
  for (PetscInt j = 0; j < b->m; j++) q[j] = b->sum[j] * b->over[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}
