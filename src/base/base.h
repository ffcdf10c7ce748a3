/* What every folder needs: PETSc, version shims, the way a user's mistake is reported, log stages and timers. */
#pragma once
#include <petscdmcomposite.h>
#include <petscdmda.h>
#include <petscksp.h>
#include "petves.h"

#if defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)
#error "petves needs a PETSc built with real double-precision scalars"
#endif

/* Names that PETSc has changed since 3.18 (PETSC_SUCCESS is in petves.h). */
#if PETSC_VERSION_GE(3, 26, 0)
#undef KSP_GMRES_CGS_REFINE_IFNEEDED
#define KSP_GMRES_CGS_REFINE_IFNEEDED KSP_ORTHOGONALIZATION_CGS_REFINE_IFNEEDED
#define KSPGMRESSetCGSRefinementType KSPOrthogonalizationSetCGSRefinementType
#endif

/* PetvesCheck - a user's mistake: when cond is false, every rank returns PETSC_ERR_USER_INPUT and one line is printed.
   Say the option or file, the value and what is allowed. Collective: all ranks must agree on cond. */
#define PetvesCheck(cond, comm, ...) PetscCheck((cond), (comm), PETSC_ERR_USER_INPUT, __VA_ARGS__)

/* PetvesErrorHandler - PETSc error handler of the program: one line on stderr, for anything but a user's mistake with
   the place in the source. Install with PetscPushErrorHandler(PetvesErrorHandler, NULL). With a context
   char[PETVES_MAX_MESSAGE] nothing is printed: the context gets the first message. */
PETSC_EXTERN PetscErrorCode PetvesErrorHandler(MPI_Comm, int, const char *, const char *, PetscErrorCode,
                                               PetscErrorType, const char *, void *);

/* PetvesSay - PetscPrintf of what a run says by itself: progress, reasons of -scheme_auto, warnings. Nothing while
   PetvesSetQuiet asks for that, as PetvesIsQuiet tells. Collective, but for PetvesIsQuiet. */
PETSC_EXTERN PetscErrorCode PetvesSay(MPI_Comm comm, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PETSC_EXTERN PetscBool PetvesIsQuiet(void);

/* PetvesSetupErrors - while on, every error counts as a user's mistake: a solver option with a bad value
   (-tension_ksp_type foo) is one, and PETSc reports it with its own codes. */
PETSC_EXTERN PetscErrorCode PetvesSetupErrors(PetscBool);

/* PetvesLastErrors - the program ends: errors count as a user's mistake, and after a line none is printed. */
PETSC_EXTERN PetscErrorCode PetvesLastErrors(void);

/* Phases of a run: one -log_view stage each, and the wall seconds of summary.json. Time in a nested phase belongs to
   the inner one only. */
typedef enum { PHASE_SETUP, PHASE_STEP, PHASE_FAST_SOLVE, PHASE_OUTPUT, PHASE_COUNT } Phase;

/* PhaseBegin, PhaseEnd - enter and leave a phase; calls nest. Not collective. */
PETSC_EXTERN PetscErrorCode PhaseBegin(Phase);
PETSC_EXTERN PetscErrorCode PhaseEnd(void);

/* PhaseDepth - phases entered and not left. */
PETSC_EXTERN PetscInt PhaseDepth(void);

/* PhaseSeconds - wall seconds spent so far in a phase itself, nested phases excluded. */
PETSC_EXTERN PetscReal PhaseSeconds(Phase);
PETSC_EXTERN const char *const PhaseNames[PHASE_COUNT];

/* PetvesEvent - id of a -log_view event of the given name, registered on first use. */
PETSC_EXTERN PetscErrorCode PetvesEvent(const char name[], PetscLogEvent *event);

/* FileOpen - a file to read; NULL and errno when it cannot be opened, or is no file but a folder, device or pipe, which
   may have no end. FileNew - a new file to write, in place of what has its name: a link is not followed; NULL: it
   cannot be made. Not collective. */
PETSC_EXTERN FILE *FileOpen(const char path[]);
PETSC_EXTERN FILE *FileNew(const char path[]);

/* PetvesRoom - room for `count` entries of so many bytes in *array, which has room for *room: a quarter more where it
   has to grow. Entries stay. Not collective. */
PETSC_EXTERN PetscErrorCode PetvesRoom(size_t count, size_t size, size_t *room, void *array);

/* PetvesWarmUpBlas - let the BLAS take its own memory now, or stop with one line where a rank has too little: OpenBLAS
   would wait for it without end. Does nothing when it has been done. Collective. */
PETSC_EXTERN PetscErrorCode PetvesWarmUpBlas(MPI_Comm comm);

/* StopClock - the wall time of -time_wall_limit starts here, the first time that this is called. */
PETSC_EXTERN void StopClock(void);

/* StopRequested - whether a rank has caught SIGTERM, SIGUSR1 or SIGINT (PetvesCatchSignals), or less than `reserve`
   seconds are left of `limit` (0: no limit) on rank 0's clock: its name, else NULL. The same on every rank. Collective.
 */
PETSC_EXTERN PetscErrorCode StopRequested(MPI_Comm comm, PetscReal limit, PetscReal reserve, const char **why);
