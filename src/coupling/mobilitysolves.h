/* The same mobility as mobility.h, exact, of bodies next to walls: column by column by Stokes solves. */
#pragma once
#include "coupling/coupling.h"

/* MobilitySolves - E A^-1 E^T between the markers of the coupling's obstacles, Mob[2W][2W], entries interlaced x, y; on
   rank root, others may give NULL. 2W Stokes solves. Collective. */
PETSC_EXTERN PetscErrorCode MobilitySolves(Coupling coupling, PetscMPIInt root, PetscReal Mob[]);
