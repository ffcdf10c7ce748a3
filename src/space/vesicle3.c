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
  v->motions = sphere->symmetry == SPHERE_REVOLVED ? 1 : 6;
  PetscCall(PetscMalloc4(size * size, &v->S, size * size, &v->N, n * size, &v->columns, 6 * size, &v->motion));
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
  PetscCall(PetscFree4(v->S, v->N, v->columns, v->motion));
  PetscCall(PetscFree3(v->pull, v->clean, v->known));
  PetscCall(PetscFree2(v->K, v->pivot));
  PetscCall(PetscFree(*vesicle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Factor(Vesicle3 v, PetscBool *done) {
  PetscFunctionBeginUser;
  *done = PETSC_TRUE;
  if (v->K) PetscCall(DenseFactor(v->size, v->K, v->pivot, done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rigid motions, turns about the middle of the surface X*. */
static void Vesicle3SetMotions(Vesicle3 v, const PetscReal Xstar[]) {
  const Surface s = v->at;
  const PetscReal one = PetscSqrtReal(4 * PETSC_PI); /* coefficient of the constant 1 */
  (void)PetscArrayzero(v->middle, 3);
  for (PetscInt i = 0; i < 3 * s->n; i++)
    v->middle[i / s->n] += s->sphere->fine.grid.weight[i % s->n] * s->J[i % s->n] * s->D[HARMONIC][i] / s->area;
  (void)PetscArrayzero(v->motion, v->motions * v->size);
  for (PetscInt d = 0; d < PetscMin(3, v->motions); d++) v->motion[d * v->size + d * v->count] = one;
  for (PetscInt turn = 3; turn < v->motions; turn++) {
    const PetscInt e = (turn + 1) % 3, f = (turn + 2) % 3;
    PetscReal *across = v->motion + turn * v->size + e * v->count, *along = v->motion + turn * v->size + f * v->count;
    for (PetscInt k = 0; k < v->count; k++) {
      across[k] = -Xstar[f * v->count + k];
      along[k] = Xstar[e * v->count + k];
    }
    *across += one * v->middle[f];
    *along -= one * v->middle[e];
  }
}

PetscErrorCode Vesicle3Place(Vesicle3 v, const PetscReal Xstar[], const PetscReal sigma[]) {
  const PetscReal ratio = v->setting.ratio;
  PetscFunctionBeginUser;
  PetscCall(SurfacePlace(v->at, Xstar, PETSC_TRUE));
  PetscCall(SphereSingleLayer(v->at->sphere, v->setting.nu, Xstar, v->S));
  if (v->K) PetscCall(SphereLayerMatrix(v->at->sphere, &Stresslet3, Xstar, v->K));
  for (PetscInt k = 0; k < v->size * v->size && v->K; k++)
    v->K[k] = (1 - ratio) * v->K[k] + (k % (v->size + 1) ? 0 : (1 + ratio) / 2);
  PetscCall(SurfaceNormals(v->at, v->N));
  PetscCall(SurfaceAreaColumns(v->at, v->columns + v->size * v->size));
  PetscCall(SurfacePull(v->at, sigma, v->pull));
  Vesicle3SetMotions(v, Xstar);
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

/* y[size] += scale P_t w, of labels that are cleaned P_t Lambda gamma w. */
static PetscErrorCode Vesicle3AddTangential(Vesicle3 v, PetscReal scale, PetscBool clean, const PetscReal w[],
                                            PetscReal y[]) {
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(v->size, &part));
  for (PetscInt k = 0; k < v->size; k++) {
    part[k] = scale * (clean ? v->clean[k] : 1) * w[k];
    y[k] += part[k];
  }
  PetscCall(DenseMultAdd(PETSC_FALSE, v->size, v->size, -1, v->N, part, y));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Rows(Vesicle3 v, const PetscReal x[], const PetscReal U[], PetscReal y[]) {
  const PetscInt size = v->size;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(y, v->unknowns));
  PetscCall(DenseMultAdd(PETSC_FALSE, size, size, -1, v->N, U, y));
  PetscCall(DenseMultAdd(PETSC_TRUE, size, v->count, -1, v->columns + size * size, U, y + size));
  if (!x) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < size; k++) y[k] += x[k];
  PetscCall(Vesicle3AddTangential(v, 1 / v->a0, PETSC_TRUE, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w[size], the rigid part of the velocity U: the motion whose normal part is nearest to that of U in the mean square.
   Motions that hardly move the shape, as turns of a surface of revolution, are left out. */
static PetscErrorCode Vesicle3RigidPart(Vesicle3 v, const PetscReal U[], PetscReal w[]) {
  const Surface s = v->at;
  const PetscInt n = s->n;
  PetscReal *u, *normal, *of_U, singular[6];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(3 * n, &u, 6 * n, &normal, n, &of_U));
  PetscCall(SphereFieldValues(&s->sphere->fine, HARMONIC, U, u));
  for (PetscInt i = 0; i < n; i++) { /* normal parts of the motions, and of U */
    const PetscReal root = PetscSqrtReal(s->sphere->fine.grid.weight[i] * s->J[i]);
    of_U[i] = 0;
    for (int d = 0; d < 3; d++) {
      const PetscInt e = (d + 1) % 3, f = (d + 2) % 3;
      normal[d * n + i] = root * s->normal[d * n + i];
      normal[(3 + d) * n + i] = root * ((s->D[HARMONIC][e * n + i] - v->middle[e]) * s->normal[f * n + i] -
                                        (s->D[HARMONIC][f * n + i] - v->middle[f]) * s->normal[e * n + i]);
      of_U[i] += root * u[d * n + i] * s->normal[d * n + i];
    }
  }
  PetscCall(DenseLeastSquares(n, v->motions, normal, 1, of_U, PetscSqrtReal(LEAST_MOTION), singular));
  PetscCall(DenseProduct(PETSC_FALSE, v->size, 1, v->motions, v->motion, of_U, w));
  PetscCall(PetscFree3(u, normal, of_U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3RemoveMotion(Vesicle3 v, PetscReal U[]) {
  PetscReal *motion, *part, singular[6];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(v->motions * v->size, &motion, v->size, &part));
  PetscCall(PetscArraycpy(motion, v->motion, v->motions * v->size));
  PetscCall(PetscArraycpy(part, U, v->size));
  PetscCall(DenseLeastSquares(v->size, v->motions, motion, 1, part, PETSC_MACHINE_EPSILON, singular));
  PetscCall(DenseMultAdd(PETSC_FALSE, v->size, v->motions, -1, v->motion, part, U));
  PetscCall(PetscFree2(motion, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Target(Vesicle3 v, const PetscReal Xhat[], const PetscReal Xstar[], const PetscReal U[],
                              PetscReal b[]) {
  PetscReal *w, grown = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(v->size, &w));
  PetscCall(PetscArrayzero(b, v->unknowns));
  PetscCall(Vesicle3AddTangential(v, -1, PETSC_TRUE, Xhat, b));
  if (U) PetscCall(Vesicle3RigidPart(v, U, w));
  if (U) PetscCall(Vesicle3AddTangential(v, 1, PETSC_FALSE, w, b));
  for (PetscInt k = 0; k < v->size; k++) grown += v->columns[v->size * v->size + k] * (Xhat[k] - Xstar[k]);
  b[v->size] = v->a0 * (grown - (v->area - v->at->area) / PetscSqrtReal(4 * PETSC_PI));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Vesicle3Matrix(Vesicle3 v, PetscReal B[]) {
  const PetscInt size = v->size, n = v->unknowns;
  const DenseView N = {v->N, size, size, size}, area = {v->columns + size * size, size, v->count, size};
  PetscReal *M, *MC, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(size * size, &M, n * size, &MC));
  PetscCall(PetscArraycpy(M, v->S, size * size));
  PetscCall(Vesicle3Velocity(v, size, M));
  PetscCall(DenseProduct(PETSC_FALSE, size, n, size, M, v->columns, MC));
  PetscCall(DenseProductWithin(PETSC_FALSE, N, (DenseView){MC, size, n, size}, 0, B, n));
  PetscCall(DenseProductWithin(PETSC_TRUE, area, (DenseView){MC, size, n, size}, 0, B + size, n));
  PetscCall(PetscFree2(M, MC));
  for (PetscInt l = 0; l < size; l++) {
    const PetscReal clean = v->clean[l] / v->a0;
    for (PetscInt k = 0; k < size; k++) B[n * l + k] -= clean * v->N[size * l + k];
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
