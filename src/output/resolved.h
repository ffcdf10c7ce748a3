/* resolved.opts: every option in force, with which a run is repeated. */
#pragma once
#include "output/folder.h"
#include "scheme/scheme.h"

/* ResolvedWrite - collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode ResolvedWrite(Folder *folder, Scheme scheme);
