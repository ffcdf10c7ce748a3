#include "base/version.h"

#ifndef PETVES_COMMIT
#define PETVES_COMMIT "unknown"
#endif
#ifndef PETVES_ARCH
#define PETVES_ARCH "an unnamed processor"
#endif

const char *PetvesCommit(void) {
  return PETVES_COMMIT;
}

PetscErrorCode PetvesVersion(char line[], size_t length) {
  PetscInt major, minor, patch;
  PetscFunctionBeginUser;
  PetscCall(PetscGetVersionNumber(&major, &minor, &patch, NULL));
  (void)snprintf(line, length, "petves %s, commit %s, with PETSc %d.%d.%d, for %s", PETVES_VERSION, PETVES_COMMIT,
                 (int)major, (int)minor, (int)patch, PETVES_ARCH);
  PetscFunctionReturn(PETSC_SUCCESS);
}
