/* -restart: a checkpoint is checked, compared with the scene, and read into the scheme.

   Every byte is covered by the checksum, which rank 0 checks first. Then all ranks read: rank 0 sends the rows of the
   grid to their ranks and all other values to every rank. Numbers that a run cannot have had are refused. */
#pragma once
#include "output/record.h"

/* RestartRead - the state of -restart's checkpoint, the record and the number of scheduled frames as they were.
   Collective; stops with one line when the checkpoint is missing, damaged, of another format or of another scene. */
PETSC_EXTERN PetscErrorCode RestartRead(Scheme scheme, Record *record, PetscInt *frames);
