/* Background flows in three dimensions. */
#pragma once
#include "scene/flow.h"

/* Flow3Velocities - u[3][n] of the background flow at X[3][n] and time t. Shear (rate (y - y_c), 0, 0), extension (rate
   x, -rate y, 0), axial (rate x, -rate y/2, -rate z/2), poiseuille u_max (1 - ((y - y_c)/L)^2) along x, tube u_max (1 -
   (y^2 + z^2)/L^2) along x, uniform, a caller's, formulas; NaN where a caller's function fails. Not collective. Errors:
   memory. */
PETSC_EXTERN PetscErrorCode Flow3Velocities(const Flow *flow, PetscReal t, PetscInt n, const PetscReal X[],
                                            PetscReal u[]);

/* Flow3Check - that a caller's flow and formulas are finite and have no divergence at time 0, and formulas none later
   before the end either, by differences about `count` centers, within a distance R; rate: the largest gradient found,
   left as it is for other flows. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode Flow3Check(MPI_Comm comm, const Flow *flow, PetscInt count, const RealList *center,
                                       PetscReal R, PetscReal end, PetscReal *rate);
