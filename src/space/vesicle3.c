#include "space/vesicle3.h"
#include "numerics/blas.h"
#include "sphere/spherelayer.h"

#define LEAST_TENSION 1e-12 /* of the mean of its block, added to it: a sphere's uniform tension moves nothing */
#define LEAST_MOTION 0.01   /* of the largest: rigid motions that change the shape less, squared, are not fitted */

PetscErrorCode Vesicle3Create(Sphere sphere, const Vesicle3Setting *setting, const PetscReal X[], Vesicle3 *out) {
  const PetscInt count = sphere->count, size = sphere->size, n = size + count;
  Vesicle3 v;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&v));
  *out = v;
  v->setting = *setting;
  v->count = count;
  v->size = size;
  v->unknowns = n;
  PetscCall(SurfaceCreate(sphere, &v->at));
  PetscCall(SurfaceCreate(sphere, &v->about));
  PetscCall(SurfacePlace(v->at, X, PETSC_FALSE));
  v->area = v->at->area;
  v->volume = v->at->volume;
  PetscCall(PetscMalloc3(size * size, &v->S, n * size, &v->rows, n * size, &v->columns));
  PetscCall(PetscCalloc3(size * size, &v->pull, size, &v->clean, size, &v->known));
  if (setting->ratio != 1) PetscCall(PetscMalloc2(size * size, &v->K, size, &v->pivot));
  for (PetscInt k = 0; k < size; k++)
    v->clean[k] = setting->label_rate * PetscPowRealInt((PetscReal)sphere->degree[k] / sphere->p, 4);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Destroy(Vesicle3 *vesicle) {
  Vesicle3 v = *vesicle;
  PetscFunctionBeginUser;
  if (!v) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SurfaceDestroy(&v->at));
  PetscCall(SurfaceDestroy(&v->about));
  PetscCall(PetscFree3(v->S, v->rows, v->columns));
  PetscCall(PetscFree3(v->pull, v->clean, v->known));
  PetscCall(PetscFree2(v->K, v->pivot));
  PetscCall(PetscFree(*vesicle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S and K, which is not factored. */
static PetscErrorCode Vesicle3PlaceLayers(Vesicle3 v, const PetscReal Xstar[]) {
  const PetscReal ratio = v->setting.ratio;
  PetscFunctionBeginUser;
  PetscCall(SphereSingleLayer(v->at->sphere, v->setting.nu, Xstar, v->S));
  if (ratio == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphereLayerMatrix(v->at->sphere, &Stresslet3, Xstar, v->K));
  for (PetscInt k = 0; k < v->size * v->size; k++)
    v->K[k] = (1 - ratio) * v->K[k] + (k % (v->size + 1) ? 0 : (1 + ratio) / 2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Factor(Vesicle3 v, PetscBool *done) {
  PetscFunctionBeginUser;
  *done = PETSC_TRUE;
  if (v->K) PetscCall(DenseFactor(v->size, v->K, v->pivot, done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Place(Vesicle3 v, const PetscReal Xstar[], const PetscReal sigma[]) {
  const PetscInt count = v->count, size = v->size;
  PetscReal *N, *A;
  PetscFunctionBeginUser;
  PetscCall(SurfacePlace(v->at, Xstar, PETSC_TRUE));
  PetscCall(Vesicle3PlaceLayers(v, Xstar));
  PetscCall(PetscMalloc2(size * size, &N, size * count, &A));
  PetscCall(SurfaceNormals(v->at, N));
  PetscCall(SurfaceAreaRows(v->at, A));
  for (PetscInt l = 0; l < size; l++) {
    for (PetscInt k = 0; k < size; k++) v->rows[v->unknowns * l + k] = -N[size * l + k];
    for (PetscInt k = 0; k < count; k++) {
      v->rows[v->unknowns * l + size + k] = -A[count * l + k];
      v->columns[size * (size + k) + l] = A[count * l + k];
    }
  }
  PetscCall(PetscFree2(N, A));
  PetscCall(SurfacePull(v->at, sigma, v->pull));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* known -= (w.X) n J. */
static PetscErrorCode Vesicle3Weigh(Vesicle3 v) {
  const Surface s = v->at;
  const PetscReal *w = v->setting.weight;
  PetscReal *f, *c;
  PetscFunctionBeginUser;
  if (w[0] == 0 && w[1] == 0 && w[2] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(3 * s->n, &f, v->size, &c));
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal *X = s->D[HARMONIC] + i, pressure = w[0] * X[0] + w[1] * X[s->n] + w[2] * X[2 * s->n];
    for (int d = 0; d < 3; d++) f[d * s->n + i] = pressure * s->J[i] * s->normal[d * s->n + i];
  }
  PetscCall(SphereFieldProject(&s->sphere->fine, f, c));
  for (PetscInt k = 0; k < v->size; k++) v->known[k] -= c[k];
  PetscCall(PetscFree2(f, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Linearise(Vesicle3 v, PetscReal a0, const PetscReal Xhat[], const PetscReal Xstar[],
                                 const PetscReal Y[]) {
  const PetscInt size = v->size;
  const PetscReal kappa = v->setting.bending;
  PetscReal *change;
  PetscFunctionBeginUser;
  v->a0 = a0;
  PetscCall(SurfacePlace(v->about, Y, PETSC_TRUE));
  PetscCall(SurfaceBending(v->about, v->columns));
  PetscCall(SurfaceGradient(v->about, v->known));
  PetscCall(PetscMalloc1(size, &change));
  for (PetscInt k = 0; k < size; k++) {
    change[k] = kappa * (Xhat[k] - Y[k]);
    v->known[k] *= kappa;
  }
  PetscCall(DenseMultAdd(PETSC_FALSE, size, size, 1, v->columns, change, v->known));
  for (PetscInt k = 0; k < size; k++) change[k] = Xhat[k] - Xstar[k];
  PetscCall(DenseMultAdd(PETSC_FALSE, size, size, 1, v->pull, change, v->known));
  PetscCall(PetscFree(change));
  PetscCall(Vesicle3Weigh(v));
  for (PetscInt k = 0; k < size * size; k++) v->columns[k] = (kappa * v->columns[k] + v->pull[k]) / a0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3AddKnown(Vesicle3 v, const PetscReal G[]) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < v->size; k++) v->known[k] += G[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Force(Vesicle3 v, const PetscReal x[], PetscReal F[]) {
  PetscFunctionBeginUser;
  PetscCall(DenseProduct(PETSC_FALSE, v->size, 1, v->unknowns, v->columns, x, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Velocity(Vesicle3 v, PetscInt columns, PetscReal U[]) {
  PetscFunctionBeginUser;
  if (v->K) PetscCall(DenseSolve(v->size, v->K, v->pivot, PETSC_FALSE, columns, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y[size] += scale (1 - P_n) w. */
static PetscErrorCode Vesicle3AddTangential(Vesicle3 v, PetscReal scale, const PetscReal w[], PetscReal y[]) {
  const DenseView minus_normals = {.a = v->rows, .rows = v->size, .columns = v->size, .apart = v->unknowns};
  PetscReal *scaled;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(v->size, &scaled));
  for (PetscInt k = 0; k < v->size; k++) {
    scaled[k] = scale * w[k];
    y[k] += scaled[k];
  }
  PetscCall(DenseProductWithin(PETSC_FALSE, minus_normals, (DenseView){scaled, v->size, 1, v->size}, 1, y, v->size));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = Lambda gamma x of labels. */
static void Vesicle3CleanLabels(Vesicle3 v, const PetscReal x[], PetscReal y[]) {
  for (PetscInt k = 0; k < v->size; k++) y[k] = v->clean[k] * x[k];
}

PetscErrorCode Vesicle3Rows(Vesicle3 v, const PetscReal x[], const PetscReal U[], PetscReal y[]) {
  PetscReal *cleaned;
  PetscFunctionBeginUser;
  PetscCall(DenseProduct(PETSC_FALSE, v->unknowns, 1, v->size, v->rows, U, y));
  if (!x) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(v->size, &cleaned));
  Vesicle3CleanLabels(v, x, cleaned);
  for (PetscInt k = 0; k < v->size; k++) y[k] += x[k];
  PetscCall(Vesicle3AddTangential(v, 1 / v->a0, cleaned, y));
  PetscCall(PetscFree(cleaned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rigid motion q, translation and rotation about the middle X0 of the surface, whose normal part is nearest to that of
   U in the mean square. Motions that hardly move the shape, as turns of a surface of revolution, are left out. */
static PetscErrorCode Vesicle3FitRigid(Vesicle3 v, const PetscReal U[], PetscReal X0[3], PetscReal q[6]) {
  const Surface s = v->at;
  const PetscInt n = s->n;
  const PetscBool revolved = (PetscBool)(s->sphere->symmetry == SPHERE_REVOLVED);
  PetscReal *u, D[36] = {0}, l[6], b[6] = {0};
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n, &u));
  PetscCall(SphereFieldValues(&s->sphere->fine, HARMONIC, U, u));
  for (int d = 0; d < 3; d++) {
    X0[d] = 0;
    for (PetscInt i = 0; i < n; i++)
      X0[d] += s->sphere->fine.grid.weight[i] * s->J[i] * s->D[HARMONIC][d * n + i] / s->area;
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal dA = s->sphere->fine.grid.weight[i] * s->J[i];
    PetscReal m[6], normal = 0;
    for (int d = 0; d < 3; d++) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      m[d] = s->normal[d * n + i];
      m[3 + d] = (s->D[HARMONIC][e * n + i] - X0[e]) * s->normal[f * n + i] -
                 (s->D[HARMONIC][f * n + i] - X0[f]) * s->normal[e * n + i];
      normal += u[d * n + i] * s->normal[d * n + i];
    }
    for (int j = 1; j < 6 && revolved; j++) m[j] = 0; /* of the turns of a meridian */
    for (int j = 0; j < 6; j++) {
      b[j] += dA * m[j] * normal;
      for (int k = 0; k < 6; k++) D[6 * j + k] += dA * m[j] * m[k];
    }
  }
  PetscCall(PetscFree(u));
  PetscCall(DenseEigen(6, D, l));
  (void)PetscArrayzero(q, 6);
  for (int j = 0; j < 6; j++) {
    PetscReal part = 0;
    if (l[j] <= LEAST_MOTION * l[5]) continue;
    for (int k = 0; k < 6; k++) part += D[6 * j + k] * b[k] / l[j];
    for (int k = 0; k < 6; k++) q[k] += part * D[6 * j + k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w[size], the rigid part of the velocity U. */
static PetscErrorCode Vesicle3RigidPart(Vesicle3 v, const PetscReal Xstar[], const PetscReal U[], PetscReal w[]) {
  const PetscReal one = PetscSqrtReal(4 * PETSC_PI); /* coefficient of the constant 1 */
  PetscReal X0[3], q[6];
  PetscFunctionBeginUser;
  PetscCall(Vesicle3FitRigid(v, U, X0, q));
  if (v->at->sphere->symmetry == SPHERE_REVOLVED) { /* along the axis */
    PetscCall(PetscArrayzero(w, v->size));
    w[0] = one * q[0];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    for (PetscInt k = 0; k < v->count; k++)
      w[d * v->count + k] = q[3 + e] * Xstar[f * v->count + k] - q[3 + f] * Xstar[e * v->count + k];
    w[d * v->count] += one * (q[d] - q[3 + e] * X0[f] + q[3 + f] * X0[e]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3RemoveMotion(Vesicle3 v, const PetscReal Xstar[], PetscReal U[]) {
  const PetscInt count = v->count;
  PetscReal G[9] = {0}, turn[3] = {0};
  PetscBLASInt pivot[3];
  PetscBool factored;
  PetscFunctionBeginUser;
  U[0] = 0; /* the harmonic of degree 0 is the translation */
  if (v->at->sphere->symmetry == SPHERE_REVOLVED) PetscFunctionReturn(PETSC_SUCCESS);
  U[count] = U[2 * count] = 0;
  for (PetscInt k = 1; k < count; k++)
    for (int d = 0; d < 3; d++) {
      const PetscInt at = d * count + k, e = (d + 1) % 3 * count + k, f = (d + 2) % 3 * count + k;
      turn[d] += Xstar[e] * U[f] - Xstar[f] * U[e];
      G[4 * d] += PetscSqr(Xstar[e]) + PetscSqr(Xstar[f]);
      G[3 * d + (d + 1) % 3] -= Xstar[at] * Xstar[e];
      G[3 * d + (d + 2) % 3] -= Xstar[at] * Xstar[f];
    }
  PetscCall(DenseFactor(3, G, pivot, &factored));
  PetscCall(DenseSolve(3, G, pivot, PETSC_FALSE, 1, turn));
  for (PetscInt k = 1; k < count; k++)
    for (int d = 0; d < 3; d++) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      U[d * count + k] -= turn[e] * Xstar[f * count + k] - turn[f] * Xstar[e * count + k];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Target(Vesicle3 v, const PetscReal Xhat[], const PetscReal Xstar[], const PetscReal U[],
                              PetscReal b[]) {
  PetscReal *w, grown = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(v->size, &w));
  PetscCall(PetscArrayzero(b, v->unknowns));
  Vesicle3CleanLabels(v, Xhat, w);
  PetscCall(Vesicle3AddTangential(v, -1, w, b));
  if (U) PetscCall(Vesicle3RigidPart(v, Xstar, U, w));
  if (U) PetscCall(Vesicle3AddTangential(v, 1, w, b));
  for (PetscInt k = 0; k < v->size; k++) grown += v->columns[v->size * v->size + k] * (Xhat[k] - Xstar[k]);
  b[v->size] = v->a0 * (grown - (v->area - v->at->area) / PetscSqrtReal(4 * PETSC_PI));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Matrix(Vesicle3 v, PetscReal B[]) {
  const PetscInt size = v->size, n = v->unknowns;
  PetscReal *M, *LM, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(size * size, &M, n * size, &LM));
  PetscCall(PetscArraycpy(M, v->S, size * size));
  PetscCall(Vesicle3Velocity(v, size, M));
  PetscCall(DenseProduct(PETSC_FALSE, n, size, size, v->rows, M, LM));
  PetscCall(DenseProduct(PETSC_FALSE, n, n, size, LM, v->columns, B));
  PetscCall(PetscFree2(M, LM));
  for (PetscInt k = 0; k < n * n; k++) B[k] = -B[k];
  for (PetscInt l = 0; l < size; l++) {
    const PetscReal clean = v->clean[l] / v->a0;
    for (PetscInt k = 0; k < size; k++) B[n * l + k] += clean * v->rows[n * l + k];
    B[(n + 1) * l] += 1 + clean;
  }
  for (PetscInt k = size; k < n; k++) trace += B[(n + 1) * k];
  for (PetscInt k = size; k < n; k++) B[(n + 1) * k] += LEAST_TENSION * trace / v->count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3KeepVolume(Vesicle3 v, PetscReal X[]) {
  PetscReal *shift;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(v->size, &shift));
  for (int pass = 0; pass < 2; pass++) {
    PetscCall(SurfacePlace(v->at, X, PETSC_FALSE));
    PetscCall(SphereFieldProject(&v->at->sphere->fine, v->at->normal, shift));
    for (PetscInt k = 0; k < v->size; k++) X[k] += shift[k] * (v->volume - v->at->volume) / v->at->area;
  }
  PetscCall(PetscFree(shift));
  PetscFunctionReturn(PETSC_SUCCESS);
}
