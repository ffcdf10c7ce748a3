#include "base/base.h"
#include <signal.h>
#include <time.h>

/* Seconds within which a second signal is the same request: mpirun and the batch system both send one. */
#define SAME_REQUEST 1.0

static volatile sig_atomic_t caught;
static volatile sig_atomic_t stepping; /* StopRequested has been called: a run asks between its steps */
static double caught_at;
static double began; /* 0: not yet */

/* Seconds of a clock that is never set. */
static double StopNow(void) {
  struct timespec now;
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Note a signal. A signal before the first step, or long after the first signal, ends the process as if it were not
   caught. */
static void StopCatch(int number) {
  if (!stepping || (caught && StopNow() - caught_at > SAME_REQUEST)) {
    (void)signal(number, SIG_DFL);
    (void)raise(number); /* the signal comes when this function returns */
  } else if (!caught) {
    caught_at = StopNow();
    caught = number;
  }
}

void StopClock(void) {
  if (began == 0) began = StopNow();
}

PetscErrorCode PetvesCatchSignals(void) {
  const int signals[] = {SIGTERM, SIGUSR1, SIGINT};
  struct sigaction action = {.sa_handler = StopCatch, .sa_flags = SA_RESTART}, before;
  PetscFunctionBeginUser;
  sigemptyset(&action.sa_mask);
  for (int k = 0; k < 3; k++) sigaddset(&action.sa_mask, signals[k]);
  PetscCheck(signal(SIGPIPE, SIG_IGN) != SIG_ERR && signal(SIGXFSZ, SIG_IGN) != SIG_ERR, PETSC_COMM_SELF, PETSC_ERR_SYS,
             "SIGPIPE and SIGXFSZ cannot be ignored"); /* a write that fails ends the run with a line */
  /* SIGINT is ignored in a shell's background job, which Ctrl-C is not meant for */
  const int n = !sigaction(SIGINT, NULL, &before) && before.sa_handler == SIG_IGN ? 2 : 3;
  for (int k = 0; k < n; k++)
    PetscCheck(!sigaction(signals[k], &action, NULL), PETSC_COMM_SELF, PETSC_ERR_SYS, "no handler for signal %d",
               signals[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StopRequested(MPI_Comm comm, PetscReal limit, PetscReal reserve, const char **why) {
  PetscMPIInt rank, stop[2] = {caught, 0};
  PetscFunctionBeginUser;
  stepping = 1;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  stop[1] = !rank && limit > 0 && StopNow() - began + reserve > limit;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 2, MPI_INT, MPI_MAX, comm));
  *why = NULL;
  if (stop[1]) *why = "-time_wall_limit";
  if (stop[0]) *why = stop[0] == SIGTERM ? "SIGTERM" : stop[0] == SIGINT ? "SIGINT" : "SIGUSR1";
  PetscFunctionReturn(PETSC_SUCCESS);
}
