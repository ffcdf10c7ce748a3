/* Runs of several scenes one after another in one process: `scenes FILE`, a line of options each. Prints what is said
   of a scene before its steps and a line: 0 good, 2 a step failed, 1 refused, with the message. For scenes that take
   less than a start of the program, and for memory checkers, whose start is dear (test_valgrind.py). */
#include "petves.h"
#include <stdio.h>

/* One scene from its own options; message is empty unless it was refused. */
static PetscErrorCode RunScene(const char line[], char message[], PetscBool *good) {
  PetscOptions options;
  PetscInt depth;
  Simulation simulation = NULL;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  message[0] = 0;
  PetscCall(PetscOptionsCreate(&options));
  PetscCall(PetscOptionsInsertString(options, line));
  PetscCall(PetvesEnter(options, message, &depth));
  error = PetvesSetQuiet(PETSC_FALSE);
  if (!error) error = SimulationCreate(PETSC_COMM_WORLD, &simulation);
  if (!error) error = PetvesSetQuiet(PETSC_TRUE);
  if (!error) error = SimulationRun(simulation, good);
  PetscCall(SimulationDestroy(&simulation));
  PetscCall(PetvesLeave(depth));
  PetscCall(PetscOptionsDestroy(&options));
  PetscCheck(!error || message[0], PETSC_COMM_WORLD, PETSC_ERR_PLIB, "an error without a message");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunAll(FILE *file) {
  char line[4096], message[PETVES_MAX_MESSAGE];
  PetscFunctionBeginUser;
  while (fgets(line, sizeof(line), file)) {
    PetscBool good = PETSC_TRUE;
    line[strcspn(line, "\n")] = 0;
    PetscCall(RunScene(line, message, &good));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%d %s\n", message[0] ? 1 : good ? 0 : 2, message));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  int words = 1;
  FILE *file = argc == 2 ? fopen(argv[1], "r") : NULL;
  PetscErrorCode error;
  if (!file || PetvesInitialize(&words, &argv)) return 3;
  error = RunAll(file);
  (void)fclose(file);
  return PetvesFinalize() || error ? 3 : 0;
}
