/* The films of fluid between two vesicles, images included, and between a vesicle and a wall: how thin they are, and
   what a step does to them (docs/suspensions.md, Contact). A film drains slowly; where it is thinner than half an edge
   (a cell without near field) and has lost half of that in one step, the step's error has drained it. */
#pragma once
#include "scheme/stepcommon.h"

/* FilmsGaps - least distance (length) of any two vesicles, or of one and a wall, at the present state, and
   each[vesicles], that of every vesicle from others; negative where they overlap; not a number where there is nothing
   that a vesicle may touch, and in each where nothing is within four mean edges. Collective. */
PETSC_EXTERN PetscErrorCode FilmsGaps(Scheme scheme, PetscReal *least, PetscReal each[]);

/* FilmsNone - true: at the curves X[2(M + W)] nothing crosses, no two bodies are nearer than reach (length) or an edge,
   and no parts of one vesicle nearer than reach that are more than twice that apart along it (CurvesAreClear); false
   says nothing. Not collective. */
PETSC_EXTERN PetscErrorCode FilmsNone(Scheme scheme, const PetscScalar X[], PetscReal reach, PetscBool *none);

/* FilmsCross - the first two vesicles (the same twice: one and itself), the first of them an own one, that cross at the
   curves X[2(M + W)]: their polygons do, or smooth outlines whose polygons do not; -1, -1: none. Not collective. */
PETSC_EXTERN PetscErrorCode FilmsCross(Scheme scheme, const PetscScalar X[], PetscInt pair[2]);

/* FilmsLoss - what a step from the state kept before it to the present markers, at time t, does: the largest part of
   its thickness that a thin film has lost, over -limit_gap_loss; above 1 is too much, and so are membranes that cross
   (-limit_crossing). 0 where no film is thin, or nothing is limited. Collective. */
PETSC_EXTERN PetscErrorCode FilmsLoss(Scheme scheme, PetscReal t, PetscReal *loss);

/* FilmsCheck - report.failure when the last step has taken too much of a film. Collective. */
PETSC_EXTERN PetscErrorCode FilmsCheck(Scheme scheme);

/* FilmsWarn - with the exact near field a warning, once a run, where two vesicles, a vesicle and a periodic image, or a
   vesicle and a wall are closer than .6 marker spacings: markers no longer resolve the film there (docs/settings.md).
   In a time in proportion to the markers. Collective. */
PETSC_EXTERN PetscErrorCode FilmsWarn(Scheme scheme);
