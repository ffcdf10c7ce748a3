/* What a program of PETSc costs before it does anything: initialises, ends. With the libraries of petves, so that
   `time build/bench/bench_start` beside `time bin/petves ...` tells petves' own part of the start. */
#include <petscsys.h>

int main(int argc, char **argv) {
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscFinalize());
  return 0;
}
