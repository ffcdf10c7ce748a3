#include "bodies/forcelist.h"
#include "bodies/bending.h"
#include "bodies/gravity.h"
#include "bodies/repulsion.h"
#include "bodies/turning.h"

/* Each row makes a force, or leaves its name NULL where the scene has none of it. */
static PetscErrorCode (*const rows[])(Bodies, Grid, Scene, Force *) = {ForceCreate_Bending, ForceCreate_Turning,
                                                                       ForceCreate_Contact, ForceCreate_Gravity};

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
