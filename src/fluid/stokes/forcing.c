#include "fluid/stokes/forcing.h"

PetscErrorCode ForcingCreate(Grid g, PetscBool source, Forcing *f) {
  PetscFunctionBeginUser;
  *f = (Forcing){.grid = g};
  PetscCall(DMCreateGlobalVector(g->velocity, &f->values));
  if (source) PetscCall(DMCreateGlobalVector(g->da[FIELD_P], &f->source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcingCopy(const Forcing *from, Forcing *to) {
  PetscFunctionBeginUser;
  if (!from->values) PetscFunctionReturn(PETSC_SUCCESS);
  if (!to->values) PetscCall(ForcingCreate(from->grid, from->source ? PETSC_TRUE : PETSC_FALSE, to));
  const Vec values = to->values, source = to->source;
  PetscCall(VecCopy(from->values, values));
  if (source) PetscCall(VecCopy(from->source, source));
  *to = *from;
  to->values = values;
  to->source = source;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcingDestroy(Forcing *f) {
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&f->values));
  PetscCall(VecDestroy(&f->source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcingClear(Forcing *f) {
  const Vec all[2] = {f->values, f->source};
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    if (!all[k]) continue;
    PetscCall(f->everywhere ? VecSet(all[k], 0) : GridClear(f->grid, &f->window, all[k]));
  }
  *f = (Forcing){.grid = f->grid, .values = f->values, .source = f->source};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A range that holds both; an empty one has no place. */
static void Unite(PetscInt range[2], const PetscInt other[2]) {
  const PetscBool empty = range[0] >= range[1];
  if (other[0] >= other[1]) return;
  range[0] = empty ? other[0] : PetscMin(range[0], other[0]);
  range[1] = empty ? other[1] : PetscMax(range[1], other[1]);
}

void ForcingNote(Forcing *f, const GridWindow *window) {
  if (!window) {
    f->everywhere = PETSC_TRUE;
    return;
  }
  Unite(f->window.rows, window->rows);
  Unite(f->window.columns, window->columns);
}

PetscErrorCode ForcingAdd(Forcing *f, Vec term) {
  PetscFunctionBeginUser;
  ForcingNote(f, NULL);
  PetscCall(VecAXPY(f->values, 1, term));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcingRemoveMean(Forcing *f, Fluid fluid) {
  PetscFunctionBeginUser;
  ForcingNote(f, NULL);
  PetscCall(FluidRemoveMean(fluid, f->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
