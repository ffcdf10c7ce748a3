/* Reasons to stop between two steps: a signal, or the wall time that the job has. */
#include "base/base.h"
#include <signal.h>

static volatile sig_atomic_t caught;
static PetscLogDouble began;

static void Catch(int signal) {
  caught = signal;
}

void StopClock(void) {
  (void)PetscTime(&began);
}

PetscErrorCode PetvesCatchSignals(void) {
  const int signals[] = {SIGTERM, SIGUSR1};
  struct sigaction action = {.sa_handler = Catch, .sa_flags = SA_RESTART};
  PetscFunctionBeginUser;
  sigemptyset(&action.sa_mask);
  PetscCheck(signal(SIGPIPE, SIG_IGN) != SIG_ERR, PETSC_COMM_SELF, PETSC_ERR_SYS, "SIGPIPE cannot be ignored");
  for (int k = 0; k < 2; k++)
    PetscCheck(!sigaction(signals[k], &action, NULL), PETSC_COMM_SELF, PETSC_ERR_SYS, "no handler for signal %d",
               signals[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StopRequested(MPI_Comm comm, PetscReal limit, PetscReal reserve, const char **why) {
  PetscMPIInt rank, stop[2] = {caught, 0};
  PetscLogDouble now;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscTime(&now));
  stop[1] = !rank && limit > 0 && now - began + reserve > limit;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 2, MPI_INT, MPI_MAX, comm));
  *why = NULL;
  if (stop[1]) *why = "-time_wall_limit";
  if (stop[0]) *why = stop[0] == SIGTERM ? "SIGTERM" : "SIGUSR1";
  PetscFunctionReturn(PETSC_SUCCESS);
}
