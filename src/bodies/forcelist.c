#include "bodies/forcelist.h"

static ForceCreate *const rows[] = {ForceCreate_Bending,  ForceCreate_Turning,    ForceCreate_Contact,
                                    ForceCreate_Gravity,  ForceCreate_Stretching, ForceCreate_Moment,
                                    ForceCreate_Potential};

PetscErrorCode ForcesCreate(Bodies bodies, Grid grid, Scene scene, Forces *out) {
  PetscFunctionBeginUser;
  PetscCall(PetscNew(out));
  for (size_t k = 0; k < sizeof(rows) / sizeof(rows[0]); k++) {
    Force force = {0};
    PetscCall(rows[k](bodies, grid, scene, &force));
    if (force.name) PetscCall(ForcesAdd(*out, &force));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
