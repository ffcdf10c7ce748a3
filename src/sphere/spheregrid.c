#include "sphere/spheregrid.h"
#include "numerics/blas.h"
#include <petscdt.h>

PetscErrorCode SphereGridCreate(PetscInt q, GridCover cover, SphereGrid *g) {
  const PetscInt whole = 2 * q + 2, around = cover == GRID_WHOLE ? whole : cover == GRID_HALF ? q + 2 : 1;
  PetscReal *x, *w;
  PetscFunctionBeginUser;
  g->q = q;
  g->around = around;
  g->n = (q + 1) * around;
  PetscCall(PetscMalloc3(g->n, &g->theta, g->n, &g->phi, g->n, &g->weight));
  PetscCall(PetscMalloc2(q + 1, &x, q + 1, &w));
  PetscCall(PetscDTGaussQuadrature(q + 1, -1, 1, x, w));
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscInt latitude = q - i / around, longitude = i % around;
    const PetscInt stands_for = cover == GRID_MERIDIAN ? whole : cover == GRID_HALF && longitude % (q + 1) ? 2 : 1;
    g->theta[i] = PetscAcosReal(x[latitude]);
    g->phi[i] = 2 * PETSC_PI * (PetscReal)longitude / (PetscReal)whole;
    g->weight[i] = w[latitude] * 2 * PETSC_PI * (PetscReal)stands_for / (PetscReal)whole;
  }
  PetscCall(PetscFree2(x, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereGridDestroy(SphereGrid *g) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(g->theta, g->phi, g->weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The harmonics of degree p at most at the points of the table's grid. */
static PetscErrorCode SphereTableFill(SphereTable *t, PetscInt p, SphereSymmetry symmetry, PetscInt parts) {
  const PetscBool whole = (PetscBool)(symmetry == SPHERE_WHOLE);
  const PetscInt n = t->grid.n, count = HarmonicsCount(p), columns = whole ? count : 3 * p + 1;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(parts * columns * n, &t->part[0]));
  if (whole)
    PetscCall(HarmonicsAt(p, p, n, t->grid.theta, t->grid.phi, parts, t->part[0]));
  else
    PetscCall(HarmonicsRevolvedAt(p, n, t->grid.theta, t->grid.phi, parts, t->part[0]));
  for (PetscInt part = 0; part < parts; part++) {
    t->part[part] = t->part[0] + part * columns * n;
    for (int d = 0; d < 3; d++) {
      FieldComponent *own = &t->component[d];
      own->first = whole ? d * count : d ? p + 1 : 0;
      own->columns = whole ? count : d ? p : p + 1;
      own->part[part] = t->part[part] + (whole || d == 0 ? 0 : p + 1 + (d - 1) * p) * n;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTableCreate(PetscInt p, PetscInt q, SphereSymmetry symmetry, PetscInt parts, SphereTable *t) {
  PetscFunctionBeginUser;
  *t = (SphereTable){0};
  PetscCall(SphereGridCreate(q, symmetry == SPHERE_WHOLE ? GRID_WHOLE : GRID_MERIDIAN, &t->grid));
  PetscCall(SphereTableFill(t, p, symmetry, parts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTableAt(PetscInt p, PetscInt n, const PetscReal theta[], const PetscReal phi[],
                             const PetscReal weight[], PetscInt parts, SphereTable *t) {
  PetscFunctionBeginUser;
  *t = (SphereTable){.grid.n = n};
  PetscCall(PetscMalloc3(n, &t->grid.theta, n, &t->grid.phi, n, &t->grid.weight));
  PetscCall(PetscArraycpy(t->grid.theta, theta, n));
  PetscCall(PetscArraycpy(t->grid.phi, phi, n));
  PetscCall(PetscArraycpy(t->grid.weight, weight, n));
  PetscCall(SphereTableFill(t, p, SPHERE_WHOLE, parts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTableDestroy(SphereTable *t) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(t->part[0]));
  PetscCall(SphereGridDestroy(&t->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTableValues(const SphereTable *t, PetscInt part, PetscInt count, PetscInt fields,
                                 const PetscReal c[], PetscReal y[]) {
  PetscFunctionBeginUser;
  PetscCall(DenseProduct(PETSC_FALSE, t->grid.n, fields, count, t->part[part], c, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTableProject(const SphereTable *t, PetscInt count, PetscInt fields, const PetscReal y[],
                                  PetscReal c[]) {
  const PetscInt n = t->grid.n;
  PetscReal *weighted;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fields * n, &weighted));
  for (PetscInt k = 0; k < fields * n; k++) weighted[k] = t->grid.weight[k % n] * y[k];
  PetscCall(DenseProduct(PETSC_TRUE, count, fields, n, t->part[HARMONIC], weighted, c));
  PetscCall(PetscFree(weighted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many components have the same harmonics, and go at once. */
static int SphereAlike(const SphereTable *t) {
  return t->component[0].part[HARMONIC] == t->component[1].part[HARMONIC] ? 3 : 1;
}

PetscErrorCode SphereFieldValues(const SphereTable *t, PetscInt part, const PetscReal c[], PetscReal y[]) {
  const int alike = SphereAlike(t);
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d += alike) {
    const FieldComponent *own = &t->component[d];
    PetscCall(
        DenseProduct(PETSC_FALSE, t->grid.n, alike, own->columns, own->part[part], c + own->first, y + d * t->grid.n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereFieldAdd(const SphereTable *t, const PetscReal y[], PetscReal c[]) {
  const PetscInt n = t->grid.n;
  const int alike = SphereAlike(t);
  PetscReal *weighted;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n, &weighted));
  for (PetscInt k = 0; k < 3 * n; k++) weighted[k] = t->grid.weight[k % n] * y[k];
  for (int d = 0; d < 3; d += alike) {
    const FieldComponent *own = &t->component[d];
    PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){own->part[HARMONIC], n, own->columns, n},
                                 (DenseView){weighted + d * n, n, alike, n}, 1, c + own->first, own->columns));
  }
  PetscCall(PetscFree(weighted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereFieldProject(const SphereTable *t, const PetscReal y[], PetscReal c[]) {
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) PetscCall(PetscArrayzero(c + t->component[d].first, t->component[d].columns));
  PetscCall(SphereFieldAdd(t, y, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficient number k of component d among those of a whole sphere, and how much of it there is. */
static PetscReal SphereWholeEntry(Sphere s, int d, PetscInt k, PetscInt *at) {
  const PetscInt l = s->degree[s->fine.component[d].first + k];
  *at = d * HarmonicsCount(s->p) + (s->symmetry == SPHERE_WHOLE ? k : l * l + l + (d == 2 ? -1 : d));
  return s->symmetry == SPHERE_WHOLE || d == 0 ? 1 : 1 / PETSC_SQRT2;
}

void SphereUnfold(Sphere s, int components, const PetscReal c[], PetscReal whole[]) {
  (void)PetscArrayzero(whole, components * HarmonicsCount(s->p));
  for (int d = 0; d < components; d++)
    for (PetscInt k = 0, at; k < s->fine.component[d].columns; k++) {
      const PetscReal share = SphereWholeEntry(s, d, k, &at);
      whole[at] = share * c[s->fine.component[d].first + k];
    }
}

void SphereFold(Sphere s, const PetscReal whole[], PetscReal c[]) {
  (void)PetscArrayzero(c, s->size);
  for (int d = 0; d < 3; d++)
    for (PetscInt k = 0, at; k < s->fine.component[d].columns; k++) {
      const PetscReal share = SphereWholeEntry(s, d, k, &at);
      c[s->fine.component[d].first + k] += share * whole[at];
    }
}

/* SUM_(n <= q) P_n(x). */
static PetscReal LegendreSum(PetscInt q, PetscReal x) {
  PetscReal last = 1, now = x, sum = q ? 1 + x : 1;
  for (PetscInt n = 2; n <= q; n++) {
    const PetscReal next = ((2 * n - 1) * x * now - (n - 1) * last) / n;
    last = now;
    now = next;
    sum += now;
  }
  return sum;
}

/* A grid as one whose pole has been turned to (pole, 0), with singular weights. */
static void SphereGridTurn(SphereGrid *g, PetscReal pole) {
  const PetscReal c = PetscCosReal(pole), s = PetscSinReal(pole);
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscReal across = PetscSinReal(g->theta[i]), x = across * PetscCosReal(g->phi[i]),
                    y = across * PetscSinReal(g->phi[i]), z = PetscCosReal(g->theta[i]), turned = c * x + s * z;
    g->weight[i] *= 2 * PetscSinReal(g->theta[i] / 2) * LegendreSum(g->q, z);
    g->theta[i] = PetscAtan2Real(PetscSqrtReal(turned * turned + y * y), c * z - s * x);
    g->phi[i] = PetscAtan2Real(y, turned);
  }
}

/* tables[p + 1] of harmonics of degree `degree` on the turned grids of a sphere. */
static PetscErrorCode SphereTurnedCreate(Sphere s, PetscInt degree, SphereTable **tables) {
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->p + 1, tables));
  for (PetscInt i = 0; i <= s->p; i++) {
    SphereTable *t = &(*tables)[i];
    PetscCall(SphereGridCreate(3 * s->p / 2, s->symmetry == SPHERE_WHOLE ? GRID_WHOLE : GRID_HALF, &t->grid));
    SphereGridTurn(&t->grid, s->shape.grid.theta[i * s->shape.grid.around]);
    PetscCall(SphereTableFill(t, degree, s->symmetry, 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereCreate(PetscInt p, SphereSymmetry symmetry, Sphere *out) {
  Sphere s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->p = p;
  s->symmetry = symmetry;
  s->count = symmetry == SPHERE_WHOLE ? HarmonicsCount(p) : p + 1;
  s->size = symmetry == SPHERE_WHOLE ? 3 * s->count : 2 * p + 1;
  PetscCall(PetscMalloc1(s->size, &s->degree));
  for (PetscInt k = 0; k < s->size; k++)
    s->degree[k] = symmetry == SPHERE_WHOLE ? HarmonicsDegree(k % s->count) : k <= p ? k : k - p;
  PetscCall(SphereTableCreate(p, p, symmetry, HARMONIC_P + 1, &s->shape));
  PetscCall(SphereTableCreate(p, 2 * p, symmetry, HARMONIC_PARTS, &s->fine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTurn(Sphere s, PetscBool normals) {
  PetscFunctionBeginUser;
  if (!s->turned) PetscCall(SphereTurnedCreate(s, s->p, &s->turned));
  if (!normals || s->normal) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphereTurnedCreate(s, 2 * s->p, &s->normal));
  PetscCall(SphereTableCreate(2 * s->p, 2 * s->p, s->symmetry, 1, &s->twice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereDestroy(Sphere *sphere) {
  Sphere s = *sphere;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i <= s->p; i++) {
    if (s->turned) PetscCall(SphereTableDestroy(&s->turned[i]));
    if (s->normal) PetscCall(SphereTableDestroy(&s->normal[i]));
  }
  PetscCall(PetscFree(s->turned));
  PetscCall(PetscFree(s->normal));
  PetscCall(SphereTableDestroy(&s->shape));
  PetscCall(SphereTableDestroy(&s->fine));
  PetscCall(SphereTableDestroy(&s->twice));
  PetscCall(PetscFree(s->degree));
  PetscCall(PetscFree(*sphere));
  PetscFunctionReturn(PETSC_SUCCESS);
}
