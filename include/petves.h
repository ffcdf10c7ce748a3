/* petves: inextensible vesicles in two-dimensional viscous flow, on PETSc. Public C API.

   A simulation is built from PETSc's options database (see README.md for the options), stepped or run to its end, and
   asked for its state. Every call is collective over the simulation's communicator unless it says otherwise, and
   returns a PetscErrorCode; a user's mistake is PETSC_ERR_USER_INPUT after one line on standard error. */
#pragma once
#include <petscksp.h>

#if PETSC_VERSION_LT(3, 19, 0) && !defined(PETSC_SUCCESS)
#define PETSC_SUCCESS 0
#endif

typedef struct _p_Simulation *Simulation;

/* PetvesInitialize - start PETSc with petves' help text and error handler; reads -options_file. */
PETSC_EXTERN PetscErrorCode PetvesInitialize(int *argc, char ***argv);
PETSC_EXTERN PetscErrorCode PetvesFinalize(void);

/* PetvesCatchSignals - from now on SIGTERM and SIGUSR1 end SimulationRun after the step under way, with a checkpoint,
   and a closed standard output does not end the program. Not collective. */
PETSC_EXTERN PetscErrorCode PetvesCatchSignals(void);

/* SimulationCreate - the simulation that the options database describes, at its initial state or (-restart) at a
   checkpoint's, output files open. */
PETSC_EXTERN PetscErrorCode SimulationCreate(MPI_Comm comm, Simulation *simulation);
PETSC_EXTERN PetscErrorCode SimulationDestroy(Simulation *simulation);

/* SimulationView - the model in force and the solvers, as -view prints them. */
PETSC_EXTERN PetscErrorCode SimulationView(Simulation simulation, PetscViewer viewer);

/* SimulationStep - one time step, with its row of series.csv; failure is NULL or says why the step could not be taken
   (the state is then the last good one). The text lives until the next step. */
PETSC_EXTERN PetscErrorCode SimulationStep(Simulation simulation, const char **failure);

/* SimulationRun - step to -time_end or the steady state, or until a signal or -time_wall_limit stops it, with all
   output. good is false when a step could not be taken: a checkpoint and summary.json are on disk then, and one line on
   standard error has said why. */
PETSC_EXTERN PetscErrorCode SimulationRun(Simulation simulation, PetscBool *good);

/* SimulationGetTime - steps taken and time reached. Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetTime(Simulation simulation, PetscInt *step, PetscReal *time);

/* SimulationGetState - borrowed vectors: velocity on the faces (the local part is the rank's rows of u, then of v),
   pressure, tension [M], markers [2M] and their velocity [2M] (sequential, the same on every rank). Any may be NULL.
   Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetState(Simulation simulation, Vec *velocity, Vec *pressure, Vec *tension,
                                               Vec *markers, Vec *marker_velocity);
