/* Layers of bodies of revolution: the targets are the points of one meridian, where the fields have two components. */
#include "numerics/blas.h"
#include "sphere/spherelayer.h"

/* Where the product of the components a and b is in a tensor. */
static const int TensorPlace[3][3] = {
    {TENSOR_XX, TENSOR_XY, TENSOR_XZ}, {TENSOR_XY, TENSOR_YY, TENSOR_YZ}, {TENSOR_XZ, TENSOR_YZ, TENSOR_ZZ}};

/* y[3][n]: the field c at the points of the turned grid of a latitude. */
static PetscErrorCode MeridianTurnedValues(const TurnedGrids *t, PetscInt latitude, const PetscReal c[],
                                           PetscReal y[]) {
  FieldComponent component[3];
  PetscFunctionBeginUser;
  FieldComponents(t->symmetry, t->p, t->n, t->Y + latitude * t->columns * t->n, HARMONIC, component);
  for (int d = 0; d < 3; d++)
    PetscCall(DenseProduct(PETSC_FALSE, t->n, 1, component[d].columns, component[d].part[HARMONIC],
                           c + component[d].first, y + d * t->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* out[size][3][latitudes]: at one latitude, the inner integrals of each harmonic of a field; G[TENSOR_COUNT][n]. */
static PetscErrorCode MeridianLatitude(const TurnedGrids *t, PetscInt latitude, const PetscReal G[], PetscReal rows[],
                                       PetscReal out[]) {
  FieldComponent component[3];
  PetscFunctionBeginUser;
  FieldComponents(t->symmetry, t->p, t->n, t->Y + latitude * t->columns * t->n, HARMONIC, component);
  for (int b = 0; b < 3; b++) {
    PetscCall(DenseProduct(PETSC_TRUE, TENSOR_COUNT, component[b].columns, t->n, G, component[b].part[HARMONIC], rows));
    for (PetscInt k = 0; k < component[b].columns; k++)
      for (int a = 0; a < 2; a++)
        out[(3 * (component[b].first + k) + a) * t->latitudes + latitude] += rows[k * TENSOR_COUNT + TensorPlace[a][b]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MeridianLayerMatrix(Sphere s, const Kernel3 *kernel, const PetscReal c[], const PetscReal m[],
                                   PetscReal M[]) {
  const PetscInt n = s->turned.n, latitudes = s->turned.latitudes;
  PetscReal *at, *d, *normal, *G, *rows, *out;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(3 * latitudes, &at, 3 * n, &d, 3 * n, &normal, TENSOR_COUNT * n, &G));
  PetscCall(PetscMalloc1(TENSOR_COUNT * s->count, &rows));
  PetscCall(PetscCalloc1(s->size * 3 * latitudes, &out));
  PetscCall(SphereFieldValues(&s->shape, HARMONIC, c, at));
  for (PetscInt i = 0; i < latitudes; i++) {
    PetscCall(MeridianTurnedValues(&s->turned, i, c, d));
    for (PetscInt k = 0; k < 3 * n; k++) d[k] = at[k / n * latitudes + i] - d[k];
    if (kernel->normal) PetscCall(MeridianTurnedValues(&s->normal, i, m, normal));
    kernel->set(n, d, normal, s->turned.weight, G);
    PetscCall(MeridianLatitude(&s->turned, i, G, rows, out));
  }
  for (PetscInt l = 0; l < s->size; l++)
    PetscCall(SphereFieldProject(&s->shape, out + 3 * l * latitudes, M + l * s->size));
  PetscCall(PetscFree4(at, d, normal, G));
  PetscCall(PetscFree(rows));
  PetscCall(PetscFree(out));
  PetscFunctionReturn(PETSC_SUCCESS);
}
