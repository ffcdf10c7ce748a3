/* petves: vesicles and capsules in viscous flow, on PETSc. Public C API.

   A simulation is built from PETSc's options database (docs/options.md lists them), stepped or run to its end, and
   asked for its state. Every call is collective over the simulation's communicator unless it says otherwise, and
   returns a PetscErrorCode; a user's mistake is PETSC_ERR_USER_INPUT after one line on standard error. */
#pragma once
#include <petscksp.h>

#if PETSC_VERSION_LT(3, 19, 0) && !defined(PETSC_SUCCESS)
#define PETSC_SUCCESS 0
#endif

#define PETVES_MAX_MESSAGE 512

typedef struct _p_Simulation *Simulation;

/* A background flow of the caller's: u_inf at n points X[2n] (x0,y0,x1,y1,...) and a time, into u[2n]; with -dim 3
   X[3n] (x0,y0,z0,x1,...), u[3n]; non-zero return stops the run. Every rank calls it, for other points and other
   numbers of times. */
typedef PetscErrorCode (*PetvesFlow)(PetscReal time, PetscInt n, const PetscReal X[], PetscReal u[], void *ctx);

/* PetvesMain - the whole program petves, from its words to its exit status (0 finished or stopped, 1 bad input, 2 a
   step failed); argv may be changed. Starts and ends MPI and PETSc, which must not be running. */
PETSC_EXTERN int PetvesMain(int argc, char **argv);

/* PetvesInitialize - start PETSc with petves' help text and error handler, and the options of the command line, of its
   -options_file and of PETSC_OPTIONS; what is no option there is a user's mistake. */
PETSC_EXTERN PetscErrorCode PetvesInitialize(int *argc, char ***argv);
PETSC_EXTERN PetscErrorCode PetvesFinalize(void);

/* PetvesCatchSignals - from now on SIGTERM, SIGUSR1 and SIGINT, unless it is ignored, end SimulationRun after the step
   under way, with a checkpoint; a closed standard output or a limit on the size of files does not end the program.
   Before the first step, and more than a second after the first signal, they end the process at once. Not collective.
 */
PETSC_EXTERN PetscErrorCode PetvesCatchSignals(void);

/* SimulationCreate - the simulation that the options database describes, at its initial state or (-restart) at a
   checkpoint's, output files open. */
PETSC_EXTERN PetscErrorCode SimulationCreate(MPI_Comm comm, Simulation *simulation);

/* SimulationCreateWithFlow - the same with a function for -flow_type custom (docs/fluid.md says what it
   must satisfy). */
PETSC_EXTERN PetscErrorCode SimulationCreateWithFlow(MPI_Comm comm, PetvesFlow flow, void *ctx, Simulation *simulation);
PETSC_EXTERN PetscErrorCode SimulationDestroy(Simulation *simulation);

/* SimulationView - the model in force and the solvers, as -view prints them. */
PETSC_EXTERN PetscErrorCode SimulationView(Simulation simulation, PetscViewer viewer);

/* SimulationBegin - solve the first state and write it (row 0 of series.csv, the first saved time); later calls do
   nothing. */
PETSC_EXTERN PetscErrorCode SimulationBegin(Simulation simulation);

/* SimulationStep - one time step, with its row of series.csv and the files that are due; failure is NULL or says why
   the step could not be taken (the state is then the last good one). The text is kept until the next step. */
PETSC_EXTERN PetscErrorCode SimulationStep(Simulation simulation, const char **failure);

/* SimulationAdvance - SimulationStep, unless time `until` or the steady state has been reached, or a signal or
   -time_wall_limit asks to stop: then stepped is false. The last steps are shortened so that they end at `until`. */
PETSC_EXTERN PetscErrorCode SimulationAdvance(Simulation simulation, PetscReal until, PetscBool *stepped,
                                              const char **failure);

/* SimulationEnd - write the end state, checkpoint.h5 and summary.json; failure: why the run stopped, NULL when it did
   not have to. */
PETSC_EXTERN PetscErrorCode SimulationEnd(Simulation simulation, const char *failure);

/* SimulationGetReason - why SimulationAdvance did not step: "finished", "steady" or "stopped". Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetReason(Simulation simulation, const char **reason);

/* SimulationRun - begin, step to -time_end or the steady state, or until a signal or -time_wall_limit stops it, end.
   good is false when a step could not be taken: a checkpoint and summary.json are on disk then, and one line on
   standard error has said why. */
PETSC_EXTERN PetscErrorCode SimulationRun(Simulation simulation, PetscBool *good);

/* SimulationCheckpoint - write checkpoint.h5 now. */
PETSC_EXTERN PetscErrorCode SimulationCheckpoint(Simulation simulation);

/* PetvesSetQuiet - from now on simulations of this process print neither progress nor the final table, reasons or
   warnings, or do again; what is asked for (-view) is printed. Not collective. */
PETSC_EXTERN PetscErrorCode PetvesSetQuiet(PetscBool quiet);

/* SimulationGetWarning - the i-th warning so far, of at most 17; NULL past the last. Borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetWarning(Simulation simulation, PetscInt i, const char **text);

/* SimulationGetTime - steps taken and time reached. Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetTime(Simulation simulation, PetscInt *step, PetscReal *time);

/* SimulationGetState - borrowed vectors: velocity on the faces (the local part is the rank's rows of u, then of v) and
   pressure (both zero in unbounded fluid, which is not solved for on the grid: SimulationGetCellVelocity has it),
   tension [M] (of a membrane that stretches the tension over the stretch), markers [2M] and their velocity [2M],
   distributed by vesicle: each vesicle's part is on one rank. Any may be NULL. Collective if velocity or pressure is
   asked for: they may have to be made first. */
PETSC_EXTERN PetscErrorCode SimulationGetState(Simulation simulation, Vec *velocity, Vec *pressure, Vec *tension,
                                               Vec *markers, Vec *marker_velocity);

/* SimulationGatherMarkers - borrowed arrays of all vesicles' markers[2M], their velocity[2M] and tension[M], the same
   on every rank, filled with the present state; they stay where they are, and are filled anew by the next call. Any may
   be NULL. Collective. */
PETSC_EXTERN PetscErrorCode SimulationGatherMarkers(Simulation simulation, const PetscReal **markers,
                                                    const PetscReal **velocity, const PetscReal **tension);

/* SimulationGetObject - borrowed PETSc object by name, NULL when the simulation has none of that name: Vecs velocity,
   pressure, tension, markers, marker_velocity; DMs dm_velocity, dm_u, dm_v, dm_pressure; Mats mat_G, mat_D, mat_L,
   mat_H, mat_E, mat_S, mat_B (docs/method.md); PCs pc_helmholtz, pc_poisson (fast solves); KSPs coupled_, tension_,
   bending_. Vecs change places from step to step, and velocity and pressure may have to be made when they are
   asked for: ask again after each. Collective for these two. */
PETSC_EXTERN PetscErrorCode SimulationGetObject(Simulation simulation, const char name[], PetscObject *object);

/* SimulationGetSizes - number of vesicles; start[vesicles+1], first marker of each (may be NULL); sizes: this rank's
   first row, then rows and columns of its part of u, v and p. Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetSizes(Simulation simulation, PetscInt *vesicles, PetscInt start[],
                                               PetscInt sizes[7]);

/* SimulationGetObstacles - number of obstacles; start[obstacles+1], first marker of each, and markers[2
   start[obstacles]] where they are now, counter-clockwise around solids, clockwise around fluid; solids are on the left
   of curves that end on a wall or span a period (either may be NULL). Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetObstacles(Simulation simulation, PetscInt *obstacles, PetscInt start[],
                                                   PetscReal markers[]);

/* SimulationGetOption - name ("-time_step") and value in force of the i-th option; name NULL past the last. Not
   collective. */
PETSC_EXTERN PetscErrorCode SimulationGetOption(Simulation simulation, PetscInt i, const char **name, char value[],
                                                size_t length);

/* SimulationGetColumn - name of the i-th column of series.csv; NULL past the last. Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetColumn(Simulation simulation, PetscInt i, const char **name);

/* SimulationGetRow - the last row of series.csv; vesicle -1: totals and worst values, else the vesicle's own columns
   (the others are 0). Not collective. */
PETSC_EXTERN PetscErrorCode SimulationGetRow(Simulation simulation, PetscInt vesicle, PetscReal row[]);

/* SimulationGetCellVelocity - velocity, background included, at this rank's cell centres: u, v[rows of p][cells
   in x]. */
PETSC_EXTERN PetscErrorCode SimulationGetCellVelocity(Simulation simulation, PetscReal u[], PetscReal v[]);

/* SimulationGetCellPressure - pressure at this rank's cell centres, of the disturbance unless the form is total:
   p[rows of p][cells in x]. */
PETSC_EXTERN PetscErrorCode SimulationGetCellPressure(Simulation simulation, PetscReal p[]);

/* PetvesAgree - the largest of all ranks' numbers, the same on every rank: a decision taken once. Collective. */
PETSC_EXTERN PetscErrorCode PetvesAgree(MPI_Comm comm, PetscInt mine, PetscInt *largest);

/* PetvesEndTogether - after an error that may be one rank's alone, while others wait for it: returns when all ranks of
   comm have come here. When they do not within two seconds all are ended, with status 1 and a line: `line`, or for NULL
   what PetvesErrorHandler has left unsaid on this rank. */
PETSC_EXTERN PetscErrorCode PetvesEndTogether(MPI_Comm comm, const char line[]);

/* PetvesTemporaryFolder - make a folder in TMPDIR, path[PETSC_MAX_PATH_LEN]; all ranks get its name. */
PETSC_EXTERN PetscErrorCode PetvesTemporaryFolder(MPI_Comm comm, char path[]);

/* PetvesReadOptions - put a file of options (NULL: none) and n pairs of name and value (NULL: without), which win over
   the file, into an options database (NULL: the default one); rank 0's count. Collective. */
PETSC_EXTERN PetscErrorCode PetvesReadOptions(MPI_Comm comm, PetscOptions options, const char path[], PetscInt n,
                                              const char *const word[]);

/* PetvesEnter, PetvesLeave - around calls of a program that has started PETSc itself and handles errors itself: between
   them an error's first message goes to message[PETVES_MAX_MESSAGE], nothing is printed, and `options` is the options
   database. PetvesLeave takes the depth that PetvesEnter gave and leaves the log stages that an error has left open. In
   between this thread has the locale C, in which numbers have points; a program with another locale that does not call
   them sets LC_NUMERIC to C. */
PETSC_EXTERN PetscErrorCode PetvesEnter(PetscOptions options, char message[], PetscInt *depth);
PETSC_EXTERN PetscErrorCode PetvesLeave(PetscInt depth);
