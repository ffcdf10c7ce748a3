/* One pattern's matrix on the columns of all own vesicles that take it. Own parts of marker vectors and of edge
   vectors; of others' entries nothing changes. */
#pragma once
#include "coupling/patterns.h"

/* PatternSolveAlone - from U[2n] and sigma[n] = r_s: V and sigma of each vesicle's dense problem, and their
   sources unless NULL. PatternAnswers - the sources of the answers to (W, 0). PatternAddAnswer - (U, sigma) += these
   answers. Not collective. */
PETSC_EXTERN void PatternSolveAlone(Patterns patterns, const Pattern *pattern, PetscScalar U[], PetscScalar sigma[],
                                    const PatternSources *sources);
PETSC_EXTERN void PatternAnswers(Patterns patterns, const Pattern *pattern, const PetscScalar W[],
                                 const PatternSources *sources);
PETSC_EXTERN void PatternAddAnswer(Patterns patterns, const Pattern *pattern, const PetscScalar W[], PetscScalar U[],
                                   PetscScalar sigma[]);
