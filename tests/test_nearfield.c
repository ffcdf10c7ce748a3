/* The near field. */
#include "world.h"
static PetscErrorCode Facts(void) {
  return PETSC_SUCCESS;
}
int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
