/* The films of fluid between two vesicles, images included, and between a vesicle and a wall: how thin they are, and
   what a step does to them (docs/suspensions.md, Contact). A film drains slowly; where it is thinner than half an edge
   (a cell without near field) and has lost half of that in one step, the step's error has drained it. */
#pragma once
#include "scheme/stepcommon.h"

/* FilmsGaps - the least distance (length) between two vesicles or a vesicle and a wall at the present state, and
   each[vesicles], the distance of every vesicle from what is nearest. Distances are negative where bodies overlap.
   least is NaN where a vesicle has nothing to touch, each[v] where nothing is within four mean edges. Collective. */
PETSC_EXTERN PetscErrorCode FilmsGaps(Scheme scheme, PetscReal *least, PetscReal each[]);

/* FilmsCross - the first two bodies that cross at the curves X[2(M + W)], by their polygons or by their smooth
   outlines; pair[0] is an own vesicle, pair[0] = pair[1] where a vesicle crosses itself, both are -1 where nothing
   crosses. Not collective. */
PETSC_EXTERN PetscErrorCode FilmsCross(Scheme scheme, const PetscScalar X[], PetscInt pair[2]);

/* FilmsLoss - the loss of the step from the kept state to the present markers, at time t: the largest part of its
   thickness that a thin film has lost, over -limit_gap_loss. Above 1 it is too much; where membranes cross and
   -limit_crossing holds it is 2 at least. 0 where no film is thin, or nothing is limited. Collective. */
PETSC_EXTERN PetscErrorCode FilmsLoss(Scheme scheme, Instant at, PetscReal *loss);

/* FilmsCheck - report.failure says so when a film has lost too much in the last step. Collective. */
PETSC_EXTERN PetscErrorCode FilmsCheck(Scheme scheme);

/* FilmsWarn - with the exact near field, warn once a run where a vesicle is closer than 0.6 marker spacings to another
   vesicle, a periodic image or a wall: markers do not resolve such a film (docs/settings.md). The time is in proportion
   to the markers. Collective. */
PETSC_EXTERN PetscErrorCode FilmsWarn(Scheme scheme);
