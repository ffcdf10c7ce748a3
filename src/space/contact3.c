#include "space/contact3.h"
#include "numerics/blas.h"

/* The finest level on which all pairs of points within the range are known. */
static const NearLevel *ContactLevel(NearPair pair, PetscReal range) {
  PetscInt k = pair->levels - 1;
  while (k > 1 && pair->level[k].reach < range) k--;
  return k > 0 ? &pair->level[k] : NULL;
}

/* Areas of the points of a patch. */
static PetscErrorCode ContactAreas(const NearPatch *p, PetscInt count, const PetscReal J[], PetscReal area[]) {
  PetscFunctionBeginUser;
  PetscCall(SphereTableValues(&p->table, HARMONIC, count, 1, J, area));
  for (PetscInt i = 0; i < p->n; i++) area[i] *= p->table.grid.weight[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* psi, and the factors a = psi'/r and b = psi''/r^2 of an entry, for areas of 1. */
static PetscReal ContactLaw(const Contact3Law *law, PetscReal r, NearEntry *e) {
  const PetscReal D = law->range, B = law->band, scale = 1 / (2 * PETSC_PI), x = (r - D) / B;
  e->a = e->b = 0;
  if (r < D) {
    e->a = -scale * law->stress / (r * r * r);
    e->b = 2 * scale * law->stress / (r * r * r * r * r);
    return scale * law->stress * (1 / r - 1 / D);
  }
  const PetscReal pull = 30 * law->adhesion / B * PetscSqr(x * (1 - x)),
                  slope = 60 * law->adhesion / (B * B) * x * (1 - x) * (1 - 2 * x);
  e->a = scale * (pull / r - slope) / (r * r);
  return -scale * pull / r;
}

PetscErrorCode Contact3Create(const Contact3Law *law, NearPair pair, const PetscReal J1[], const PetscReal J2[],
                              Contact3 *c) {
  const PetscReal reach = law->range + (law->adhesion > 0 ? law->band : 0);
  const NearLevel *l = ContactLevel(pair, reach);
  PetscReal *area[2];
  PetscInt room = 0;
  PetscFunctionBeginUser;
  *c = (Contact3){.level = l};
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  const NearPatch *a = &l->patch[0], *b = &l->patch[1];
  PetscCall(PetscMalloc2(a->n, &area[0], b->n, &area[1]));
  PetscCall(ContactAreas(a, pair->sphere->count, J1, area[0]));
  PetscCall(ContactAreas(b, pair->sphere->count, J2, area[1]));
  for (PetscInt k = 0; k < l->entries; k++) room += NearEntryDistance(l, &l->entry[STOKESLET][k]) < reach;
  PetscCall(PetscMalloc1(room, &c->entry));
  for (PetscInt k = 0; k < l->entries; k++) {
    const NearEntry *e = &l->entry[STOKESLET][k];
    const PetscReal r = NearEntryDistance(l, e), both = area[0][e->i] * area[1][e->j];
    if (r >= reach) continue;
    NearEntry *own = &c->entry[c->entries++];
    c->energy += both * ContactLaw(law, r, own);
    *own = (NearEntry){.i = e->i, .j = e->j, .a = both * own->a, .b = both * own->b};
  }
  PetscCall(PetscFree2(area[0], area[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Contact3Destroy(Contact3 *c) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(c->entry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Contact3Add(const Contact3 *c, PetscInt count, PetscBool gradient, const PetscReal *const change[2],
                           PetscReal *const G[2]) {
  PetscReal *x[2], *g[2];
  PetscFunctionBeginUser;
  if (!c->entries) PetscFunctionReturn(PETSC_SUCCESS);
  const NearPatch *a = &c->level->patch[0], *b = &c->level->patch[1];
  PetscCall(PetscMalloc2(3 * a->n, &x[0], 3 * b->n, &x[1]));
  PetscCall(PetscCalloc2(3 * a->n, &g[0], 3 * b->n, &g[1]));
  for (int side = 0; side < 2; side++)
    PetscCall(SphereFieldValues(&c->level->patch[side].table, HARMONIC, change[side], x[side]));
  for (const NearEntry *e = c->entry; e < c->entry + c->entries; e++) {
    PetscReal d[3], along = gradient ? e->a : 0;
    for (int q = 0; q < 3; q++) {
      d[q] = a->X[q * a->n + e->i] - b->X[q * b->n + e->j];
      along += e->b * d[q] * (x[0][q * a->n + e->i] - x[1][q * b->n + e->j]);
    }
    for (int q = 0; q < 3; q++) {
      g[0][q * a->n + e->i] += along * d[q];
      g[1][q * b->n + e->j] -= along * d[q];
    }
  }
  for (int side = 0; side < 2; side++) {
    const NearPatch *p = &c->level->patch[side];
    if (G[side])
      PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){p->table.part[HARMONIC], p->n, count, p->n},
                                   (DenseView){g[side], p->n, 3, p->n}, 1, G[side], count));
  }
  PetscCall(PetscFree2(x[0], x[1]));
  PetscCall(PetscFree2(g[0], g[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
