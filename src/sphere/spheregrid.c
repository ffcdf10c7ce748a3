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

/* Columns of a table of harmonics: those of a scalar first. */
static PetscInt SphereColumns(SphereSymmetry symmetry, PetscInt p) {
  return symmetry == SPHERE_WHOLE ? HarmonicsCount(p) : 3 * p + 1;
}

void FieldComponents(SphereSymmetry symmetry, PetscInt p, PetscInt n, const PetscReal part[], PetscInt which,
                     FieldComponent component[3]) {
  const PetscInt count = HarmonicsCount(p);
  for (int d = 0; d < 3; d++) {
    FieldComponent *c = &component[d];
    c->first = symmetry == SPHERE_WHOLE ? d * count : d ? p + 1 : 0;
    c->columns = symmetry == SPHERE_WHOLE ? count : d ? p : p + 1;
    c->part[which] = part + (symmetry == SPHERE_WHOLE || d == 0 ? 0 : p + 1 + (d - 1) * p) * n;
  }
}

PetscErrorCode SphereTableCreate(PetscInt p, PetscInt q, SphereSymmetry symmetry, PetscInt parts, SphereTable *t) {
  const PetscInt columns = SphereColumns(symmetry, p);
  PetscFunctionBeginUser;
  *t = (SphereTable){0};
  PetscCall(SphereGridCreate(q, symmetry == SPHERE_WHOLE ? GRID_WHOLE : GRID_MERIDIAN, &t->grid));
  PetscCall(PetscMalloc1(parts * columns * t->grid.n, &t->part[0]));
  PetscCall((symmetry == SPHERE_WHOLE ? HarmonicsAt : HarmonicsRevolvedAt)(p, t->grid.n, t->grid.theta, t->grid.phi,
                                                                           parts, t->part[0]));
  for (PetscInt part = 0; part < parts; part++) {
    t->part[part] = t->part[0] + part * columns * t->grid.n;
    FieldComponents(symmetry, p, t->grid.n, t->part[part], part, t->component);
  }
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

PetscErrorCode SphereFieldValues(const SphereTable *t, PetscInt part, const PetscReal c[], PetscReal y[]) {
  const int alike = t->component[0].part[part] == t->component[1].part[part] ? 3 : 1; /* components at once */
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d += alike) {
    const FieldComponent *own = &t->component[d];
    PetscCall(
        DenseProduct(PETSC_FALSE, t->grid.n, alike, own->columns, own->part[part], c + own->first, y + d * t->grid.n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereFieldProject(const SphereTable *t, const PetscReal y[], PetscReal c[]) {
  const PetscInt n = t->grid.n;
  PetscReal *weighted;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n, &weighted));
  for (PetscInt k = 0; k < 3 * n; k++) weighted[k] = t->grid.weight[k % n] * y[k];
  for (int d = 0; d < 3; d++) (void)PetscArrayzero(c + t->component[d].first, t->component[d].columns);
  for (int d = 0; d < 3; d++) {
    const FieldComponent *own = &t->component[d];
    PetscCall(DenseMultAdd(PETSC_TRUE, n, own->columns, 1, own->part[HARMONIC], weighted + d * n, c + own->first));
  }
  PetscCall(PetscFree(weighted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficient number k of component d among those of a whole sphere, and how much of it there is. */
static PetscReal SphereWholeEntry(Sphere s, int d, PetscInt k, PetscInt *at) {
  const PetscInt l = s->degree[s->fine.component[d].first + k];
  *at = d * HarmonicsCount(s->p) + (s->symmetry == SPHERE_WHOLE ? k : l * l + l + (d == 2 ? -1 : d));
  return s->symmetry == SPHERE_WHOLE || d == 0 ? 1 : 1 / PETSC_SQRT2;
}

void SphereUnfold(Sphere s, const PetscReal c[], PetscReal whole[]) {
  (void)PetscArrayzero(whole, 3 * HarmonicsCount(s->p));
  for (int d = 0; d < 3; d++)
    for (PetscInt k = 0, at; k < s->fine.component[d].columns; k++) {
      const PetscReal share = SphereWholeEntry(s, d, k, &at);
      whole[at] = share * c[s->fine.component[d].first + k];
    }
}

void SphereUnfoldScalar(Sphere s, const PetscReal c[], PetscReal whole[]) {
  (void)PetscArrayzero(whole, HarmonicsCount(s->p));
  for (PetscInt k = 0; k < s->count; k++) whole[s->symmetry == SPHERE_WHOLE ? k : k * k + k] = c[k];
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

/* The angles of the points of a grid whose pole has been turned to (pole, 0). */
static void TurnPole(const SphereGrid *g, PetscReal pole, PetscReal theta[], PetscReal phi[]) {
  const PetscReal c = PetscCosReal(pole), s = PetscSinReal(pole);
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscReal across = PetscSinReal(g->theta[i]), x = across * PetscCosReal(g->phi[i]),
                    y = across * PetscSinReal(g->phi[i]), z = PetscCosReal(g->theta[i]), turned = c * x + s * z;
    theta[i] = PetscAtan2Real(PetscSqrtReal(turned * turned + y * y), c * z - s * x);
    phi[i] = PetscAtan2Real(y, turned);
  }
}

static PetscErrorCode TurnedGridsCreate(PetscInt p, PetscInt q, SphereSymmetry symmetry, const SphereGrid *targets,
                                        TurnedGrids *t) {
  SphereGrid g;
  PetscReal *theta, *phi;
  PetscFunctionBeginUser;
  PetscCall(SphereGridCreate(q, symmetry == SPHERE_WHOLE ? GRID_WHOLE : GRID_HALF, &g));
  t->p = p;
  t->symmetry = symmetry;
  t->columns = SphereColumns(symmetry, p);
  t->latitudes = targets->q + 1;
  t->n = g.n;
  PetscCall(PetscMalloc2(g.n, &theta, g.n, &phi));
  PetscCall(PetscMalloc2(t->latitudes * t->columns * g.n, &t->Y, g.n, &t->weight));
  for (PetscInt i = 0; i < t->latitudes; i++) {
    TurnPole(&g, targets->theta[i * targets->around], theta, phi);
    PetscCall((symmetry == SPHERE_WHOLE ? HarmonicsAt : HarmonicsRevolvedAt)(p, g.n, theta, phi, 1,
                                                                             t->Y + i * t->columns * g.n));
  }
  for (PetscInt j = 0; j < g.n; j++)
    t->weight[j] = g.weight[j] * 2 * PetscSinReal(g.theta[j] / 2) * LegendreSum(q, PetscCosReal(g.theta[j]));
  PetscCall(PetscFree2(theta, phi));
  PetscCall(SphereGridDestroy(&g));
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
  if (!s->turned.n) PetscCall(TurnedGridsCreate(s->p, 3 * s->p / 2, s->symmetry, &s->shape.grid, &s->turned));
  if (!normals || s->normal.n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TurnedGridsCreate(2 * s->p, 3 * s->p / 2, s->symmetry, &s->shape.grid, &s->normal));
  PetscCall(SphereTableCreate(2 * s->p, 2 * s->p, s->symmetry, 1, &s->twice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereDestroy(Sphere *sphere) {
  Sphere s = *sphere;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphereTableDestroy(&s->shape));
  PetscCall(SphereTableDestroy(&s->fine));
  PetscCall(SphereTableDestroy(&s->twice));
  PetscCall(PetscFree(s->degree));
  PetscCall(PetscFree2(s->turned.Y, s->turned.weight));
  PetscCall(PetscFree2(s->normal.Y, s->normal.weight));
  PetscCall(PetscFree(*sphere));
  PetscFunctionReturn(PETSC_SUCCESS);
}
