/* Which entry of the options' lists a vesicle takes. */
#pragma once
#include "scene/resolve.h"

/* SceneMixKinds - which entry of the lists each of -vesicle_count vesicles takes with -vesicle_mixture: one after
   another the kind that is furthest behind its part, so that any row of vesicles has the mixture. SceneKindOf - that
   entry; without a mixture the vesicle's own number. Not collective. */
PETSC_EXTERN PetscErrorCode SceneMixKinds(Draft scene);
PETSC_EXTERN PetscInt SceneKindOf(Scene scene, PetscInt vesicle);

/* ListEntry - number `component` of entry `entry` of a list with `each` numbers an entry, or the same for all. */
PETSC_EXTERN PetscReal ListEntry(const RealList *list, PetscInt each, PetscInt entry, PetscInt component);
