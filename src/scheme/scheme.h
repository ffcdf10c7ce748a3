/* Time-stepping schemes behind one interface: registered by name, created with the initial state, stepped. A step keeps
   the state, takes the scheme's own step, checks what it led to and goes back when it is refused. All is collective. */
#pragma once
#include "scheme/stepcommon.h"

/* SchemeRegister - add a scheme under a name of -scheme_type. */
PETSC_EXTERN PetscErrorCode SchemeRegister(const char type[], PetscErrorCode (*create)(Scheme));

/* SchemeCreate - the scene's scheme with the initial state: sigma = 0, p = 0, no disturbance (u_inf in the total form),
   markers X[2M] of all vesicles. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCreate(Scene scene, Coupling coupling, const PetscReal X[], Scheme *scheme);
PETSC_EXTERN PetscErrorCode SchemeDestroy(Scheme *scheme);

/* SchemeStart - solve the first state: flow, pressure, tension and forces of the first markers, which stay. Nothing
   happens after a step, where the fluid starts from rest, and where the solve fails, as the first step will say why.
   Collective. */
PETSC_EXTERN PetscErrorCode SchemeStart(Scheme scheme);

/* SchemeStep - one time step: the policy's, to the time `until` at most (PETSC_MAX_REAL: no end). Afterwards
   scheme->report says what was done; when report.failure is not empty the step could not be taken, or led to a state
   that is refused, and the state is the last good one. Collective. */
PETSC_EXTERN PetscErrorCode SchemeStep(Scheme scheme, PetscReal until);

/* SchemeRemember, SchemeRecall - what the solvers have kept from earlier steps (when their blocks were made, and where
   the markers were), as SchemeMemorySize numbers for a checkpoint, and made again from them. Collective. */
PETSC_EXTERN PetscInt SchemeMemorySize(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeRemember(Scheme scheme, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode SchemeRecall(Scheme scheme, const PetscReal memory[]);

/* SchemeView, SchemeWriteOptions - the Krylov solvers of a scheme: to a viewer, and their settings in force as options.
   SchemeGetKSP - the solver of this prefix, borrowed; NULL without. Collective. */
PETSC_EXTERN PetscErrorCode SchemeView(Scheme scheme, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode SchemeWriteOptions(Scheme scheme, FILE *file);
PETSC_EXTERN PetscErrorCode SchemeGetKSP(Scheme scheme, const char prefix[], KSP *ksp);

/* SchemeKineticEnergy - E_K = 1/2 SUM u^2 h^2 of the total velocity minus the background. Collective. */
PETSC_EXTERN PetscErrorCode SchemeKineticEnergy(Scheme scheme, PetscReal *energy);
