/* What every folder needs: PETSc and names that it has changed, errors of one line, what a run prints, log stages with
   timers, files, arrays that grow, and reasons to stop. */
#pragma once
#include <petscdmcomposite.h>
#include <petscdmda.h>
#include <petscksp.h>
#include "petves.h"

#if defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)
#error "petves needs a PETSc built with real double-precision scalars"
#endif

/* Names that PETSc has changed since 3.18 (PETSC_SUCCESS is in petves.h). */
#if PETSC_VERSION_GE(3, 24, 0)
#undef MPIU_BOOL
#define MPIU_BOOL MPI_C_BOOL
#endif
#if PETSC_VERSION_GE(3, 26, 0)
#undef KSP_GMRES_CGS_REFINE_IFNEEDED
#define KSP_GMRES_CGS_REFINE_IFNEEDED KSP_ORTHOGONALIZATION_CGS_REFINE_IFNEEDED
#define KSPGMRESSetCGSRefinementType KSPOrthogonalizationSetCGSRefinementType
#endif

/* PetvesCheck - a user's mistake: when cond is false, every rank returns PETSC_ERR_USER_INPUT and one line is printed.
   Say the option or file, the value and what is allowed. Collective: all ranks must agree on cond. */
#define PetvesCheck(cond, comm, ...) PetscCheck((cond), (comm), PETSC_ERR_USER_INPUT, __VA_ARGS__)

/* PetvesErrorHandler - PETSc error handler of the program (PetscPushErrorHandler(PetvesErrorHandler, context)): prints
   one line on stderr, with the place in the source unless the error is a user's mistake. With a context
   char[PETVES_MAX_MESSAGE] nothing is printed, and the context gets the first message. */
PETSC_EXTERN PetscErrorCode PetvesErrorHandler(MPI_Comm, int, const char *, const char *, PetscErrorCode,
                                               PetscErrorType, const char *, void *);

/* PetvesSay - PetscPrintf of progress, reasons of -scheme_auto and warnings; prints nothing after PetvesSetQuiet(TRUE).
   Collective. */
PETSC_EXTERN PetscErrorCode PetvesSay(MPI_Comm comm, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/* PetvesSetupErrors - while on, every error counts as a user's mistake: PETSc reports a solver option with a bad value
   (-tension_ksp_type foo) with codes of its own. Not collective. */
PETSC_EXTERN PetscErrorCode PetvesSetupErrors(PetscBool);

/* PetvesLastErrors - the program ends: errors count as a user's mistake, and at most one more line is printed. Not
   collective. */
PETSC_EXTERN PetscErrorCode PetvesLastErrors(void);

/* Phases of a run, each a -log_view stage with its wall seconds in summary.json. Time in a nested phase does not count
   for the outer phase. */
typedef enum { PHASE_SETUP, PHASE_STEP, PHASE_FAST_SOLVE, PHASE_OUTPUT, PHASE_COUNT } Phase;

/* PhaseBegin - enter a phase. PhaseEnd - leave the phase that was entered last. PhaseDepth - number of phases that have
   been entered and not left. PhaseSeconds - wall seconds spent so far in a phase. Not collective. */
PETSC_EXTERN PetscErrorCode PhaseBegin(Phase);
PETSC_EXTERN PetscErrorCode PhaseEnd(void);

PETSC_EXTERN PetscInt PhaseDepth(void);

PETSC_EXTERN PetscReal PhaseSeconds(Phase);
PETSC_EXTERN const char *const PhaseNames[PHASE_COUNT];

/* PetvesEvent - register a -log_view event of the given name and return its id. Collective. */
PETSC_EXTERN PetscErrorCode PetvesEvent(const char name[], PetscLogEvent *event);

/* FileOpen - open a file to read; NULL, with errno, when it cannot be opened, or is a folder, device or pipe, which may
   have no end. FileNew - open a new file to write, after the file or link of this name has been removed; NULL when it
   cannot be made. Not collective. */
PETSC_EXTERN FILE *FileOpen(const char path[]);
PETSC_EXTERN FILE *FileNew(const char path[]);

/* ArrayReserve - memory for at least `count` entries in an array that grows: capacity and array are the caller's, zero
   and NULL at first. A capacity grows by a quarter more than is asked for. Free the array with PetscFree. Not
   collective.
 */
#define ArrayReserve(count, capacity, array) ArrayReserveBytes((count), sizeof(**(array)), (capacity), (array))
PETSC_EXTERN PetscErrorCode ArrayReserveBytes(size_t count, size_t bytes, size_t *capacity, void *array);

/* PetvesWarmUpBlas - make the BLAS allocate its own memory, or stop with one line where a rank has too little: OpenBLAS
   would wait for memory without end. The first call counts. Collective. */
PETSC_EXTERN PetscErrorCode PetvesWarmUpBlas(MPI_Comm comm);

/* StopClock - the wall time of -time_wall_limit starts with the first call. Not collective. */
PETSC_EXTERN void StopClock(void);

/* StopRequested - why: the name of a signal SIGTERM, SIGUSR1 or SIGINT that a rank has caught (PetvesCatchSignals);
   "-time_wall_limit" if less than `reserve` seconds of `limit` (0: no limit) are left on rank 0's clock; else NULL. The
   same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode StopRequested(MPI_Comm comm, PetscReal limit, PetscReal reserve, const char **why);
