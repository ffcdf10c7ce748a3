/* The fluid between membranes that are close, and between membranes and walls. */
#pragma once
#include "scheme/scheme.h"

/* SchemeWarnOfFilm - a warning, once a run, where two vesicles, a vesicle and a periodic image, or a vesicle and a wall
   are closer than .6 marker spacings: markers no longer resolve the film there (docs/choosing.md). With the exact
   near field; in a time in proportion to the markers. Collective. */
PETSC_EXTERN PetscErrorCode SchemeWarnOfFilm(Scheme scheme);
