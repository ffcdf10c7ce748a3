#include "sphere/spheregrid.h"
#include "numerics/blas.h"
#include <petscdt.h>

PetscErrorCode SphereGridCreate(PetscInt q, SphereGrid *g) {
  const PetscInt around = 2 * q + 2;
  PetscReal *x, *w;
  PetscFunctionBeginUser;
  g->q = q;
  g->n = (q + 1) * around;
  PetscCall(PetscMalloc3(g->n, &g->theta, g->n, &g->phi, g->n, &g->weight));
  PetscCall(PetscMalloc2(q + 1, &x, q + 1, &w));
  PetscCall(PetscDTGaussQuadrature(q + 1, -1, 1, x, w));
  for (PetscInt i = 0; i < g->n; i++) {
    const PetscInt latitude = q - i / around;
    g->theta[i] = PetscAcosReal(x[latitude]);
    g->phi[i] = 2 * PETSC_PI * (PetscReal)(i % around) / (PetscReal)around;
    g->weight[i] = w[latitude] * 2 * PETSC_PI / (PetscReal)around;
  }
  PetscCall(PetscFree2(x, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereGridDestroy(SphereGrid *g) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(g->theta, g->phi, g->weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereTableCreate(PetscInt p, PetscInt q, PetscInt parts, SphereTable *t) {
  const PetscInt count = HarmonicsCount(p);
  PetscFunctionBeginUser;
  *t = (SphereTable){0};
  PetscCall(SphereGridCreate(q, &t->grid));
  PetscCall(PetscMalloc1(parts * count * t->grid.n, &t->part[0]));
  PetscCall(HarmonicsAt(p, t->grid.n, t->grid.theta, t->grid.phi, parts, t->part[0]));
  for (PetscInt part = 1; part < parts; part++) t->part[part] = t->part[0] + part * count * t->grid.n;
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

static PetscErrorCode TurnedGridsCreate(PetscInt p, PetscInt q, const SphereGrid *targets, TurnedGrids *t) {
  const PetscInt count = HarmonicsCount(p);
  SphereGrid g;
  PetscReal *theta, *phi;
  PetscFunctionBeginUser;
  PetscCall(SphereGridCreate(q, &g));
  t->p = p;
  t->latitudes = targets->q + 1;
  t->n = g.n;
  PetscCall(PetscMalloc2(g.n, &theta, g.n, &phi));
  PetscCall(PetscMalloc2(t->latitudes * count * g.n, &t->Y, g.n, &t->weight));
  for (PetscInt i = 0; i < t->latitudes; i++) {
    TurnPole(&g, targets->theta[i * (2 * targets->q + 2)], theta, phi);
    PetscCall(HarmonicsAt(p, g.n, theta, phi, 1, t->Y + i * count * g.n));
  }
  for (PetscInt j = 0; j < g.n; j++)
    t->weight[j] = g.weight[j] * 2 * PetscSinReal(g.theta[j] / 2) * LegendreSum(q, PetscCosReal(g.theta[j]));
  PetscCall(PetscFree2(theta, phi));
  PetscCall(SphereGridDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereCreate(PetscInt p, Sphere *out) {
  Sphere s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->p = p;
  s->count = HarmonicsCount(p);
  PetscCall(SphereTableCreate(p, p, 1, &s->shape));
  PetscCall(SphereTableCreate(p, 2 * p, HARMONIC_PARTS, &s->fine));
  PetscCall(TurnedGridsCreate(p, 3 * p / 2, &s->shape.grid, &s->turned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereNormalTables(Sphere s) {
  PetscFunctionBeginUser;
  if (s->normal.n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TurnedGridsCreate(2 * s->p, 3 * s->p / 2, &s->shape.grid, &s->normal));
  PetscCall(SphereTableCreate(2 * s->p, 2 * s->p, 1, &s->twice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphereDestroy(Sphere *sphere) {
  Sphere s = *sphere;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphereTableDestroy(&s->shape));
  PetscCall(SphereTableDestroy(&s->fine));
  PetscCall(SphereTableDestroy(&s->twice));
  PetscCall(PetscFree2(s->turned.Y, s->turned.weight));
  PetscCall(PetscFree2(s->normal.Y, s->normal.weight));
  PetscCall(PetscFree(*sphere));
  PetscFunctionReturn(PETSC_SUCCESS);
}
