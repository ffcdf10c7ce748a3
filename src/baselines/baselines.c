#include "baselines/baselines.h"

PetscErrorCode BaselinesRegister(void) {
  PetscFunctionBeginUser;
  PetscCall(SchemeRegister("split", SchemeCreate_Split));
  PetscCall(SchemeRegister("penalty", SchemeCreate_Penalty));
  PetscFunctionReturn(PETSC_SUCCESS);
}
