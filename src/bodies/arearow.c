#include "bodies/arearow.h"

PetscErrorCode AreaRowCreate(Membrane m, const PetscReal ratio[], AreaRow *out) {
  const Layout l = m->layout;
  AreaRow r;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  *out = r;
  r->membrane = m;
  PetscCall(PetscMalloc3(l->bodies, &r->ratio, 2 * l->n, &r->z, l->bodies, &r->speed));
  for (PetscInt v = 0; v < l->bodies; v++) r->ratio[v] = ratio ? ratio[v] : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AreaRowDestroy(AreaRow *row) {
  PetscFunctionBeginUser;
  if (!*row) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*row)->ratio, (*row)->z, (*row)->speed));
  PetscCall(PetscFree(*row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* z and s of one vesicle; marker vectors' own parts. */
static void Aim(AreaRow r, PetscInt v, PetscReal a0, const PetscScalar star[], const PetscScalar hat[],
                const PetscScalar background[]) {
  const Membrane m = r->membrane;
  const PetscInt at = 2 * LayoutOffset(m->layout, v), n = 2 * LayoutCount(m->layout, v);
  PetscReal *z = r->z + at, size = 0, speed = 0;
  Measures measures;
  MembraneMeasure(m, v, star + at, &measures);
  MembraneAreaGradient(m, v, star + at, z);
  for (PetscInt k = 0; k < n; k++) size += PetscSqr(z[k]);
  size = PetscSqrtReal(size);
  for (PetscInt k = 0; k < n; k++) {
    z[k] /= size;
    speed += z[k] * (a0 * (star[at + k] - hat[at + k]) - background[at + k]);
  }
  r->speed[v] = speed + a0 * (m->A0[v] - measures.area) / size;
}

PetscErrorCode AreaRowPlace(AreaRow r, PetscReal a0, Vec Xstar, Vec Xhat, Vec background) {
  const Layout l = r->membrane->layout;
  const PetscScalar *star, *hat, *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(Xstar, &star));
  PetscCall(VecGetArrayRead(Xhat, &hat));
  PetscCall(VecGetArrayRead(background, &u));
  for (PetscInt v = l->own; v < l->end; v++) Aim(r, v, a0, star, hat, u);
  PetscCall(VecRestoreArrayRead(background, &u));
  PetscCall(VecRestoreArrayRead(Xhat, &hat));
  PetscCall(VecRestoreArrayRead(Xstar, &star));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AreaRowReplace(AreaRow r, PetscBool aimed, const PetscScalar V[], PetscScalar y[]) {
  const Layout l = r->membrane->layout;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = 2 * LayoutOffset(l, v), n = 2 * LayoutCount(l, v);
    const PetscReal *z = r->z + at;
    PetscReal along = 0, off = aimed ? -r->speed[v] : 0;
    for (PetscInt k = 0; k < n; k++) {
      along += z[k] * y[at + k];
      off += z[k] * V[at + k];
    }
    for (PetscInt k = 0; k < n; k++) y[at + k] += (r->ratio[v] * off - along) * z[k];
  }
}
