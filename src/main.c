/* petves: initialise, build from options, run, report. Exit status: 0 finished or stopped, 1 bad input or a file that
   cannot be written, 2 a step failed. */
#include "petves.h"
#include <stdlib.h>

static PetscErrorCode Run(PetscBool *good) {
  Simulation simulation = NULL;
  PetscErrorCode error;
  PetscBool only_help;
  PetscFunctionBeginUser;
  PetscCall(PetvesCatchSignals());
  PetscCall(PetscOptionsHasHelp(NULL, &only_help));
  error = SimulationCreate(PETSC_COMM_WORLD, &simulation);
  if (!error && !only_help) error = SimulationRun(simulation, good);
  /* a mistake or a file that cannot be written stops every rank; any other error may be one rank's, and others wait */
  if (!error || error == PETSC_ERR_USER_INPUT) PetscCall(SimulationDestroy(&simulation));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Other ranks may have had enough memory and wait for this one. */
static void StopOthers(void) {
  PetscMPIInt size = 1;
  (void)MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (size > 1) (void)MPI_Abort(PETSC_COMM_WORLD, 1);
}

static const char usage[] = "usage: mpirun -n RANKS petves -options_file SCENE [-option value ...]\n"
                            "       runs/default.opts is a scene to start from; petves -help lists the options\n";

int main(int argc, char **argv) {
  const char *const given = getenv("PETSC_OPTIONS");
  const PetscBool asked = argc > 1 || (given && given[strspn(given, " \t\n")]) ? PETSC_TRUE : PETSC_FALSE;
  PetscBool good = PETSC_TRUE;
  PetscErrorCode error = PetvesInitialize(&argc, &argv);
  if (error) return 1;
  if (asked) error = Run(&good);
  if (!asked) (void)PetscFPrintf(PETSC_COMM_WORLD, stderr, "%s", usage);
  if (error == PETSC_ERR_MEM) StopOthers();
  if (PetvesFinalize() || error || !asked) return 1;
  return good ? 0 : 2;
}
