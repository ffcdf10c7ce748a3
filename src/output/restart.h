/* -restart: a checkpoint checked, compared with the scene, and read into the scheme. */
#pragma once
#include "output/record.h"

/* RestartRead - put the scheme into the state of -restart's checkpoint, the record and the number of scheduled frames
   to where they were. Stops with one line when the checkpoint is missing, damaged, of another format or of another
   scene. Collective. */
PETSC_EXTERN PetscErrorCode RestartRead(Scheme scheme, Record *record, PetscInt *frames);
