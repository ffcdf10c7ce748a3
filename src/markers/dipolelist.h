/* The spots of all dipoles sorted by rows of the grid.

   The list is made once, when markers are placed, and used by all products with them: tensors go to a row at once, as a
   Stokes solve by stream function passes the rows. Every rank has the spots of all dipoles and the rows of its own slab
   and of a few next to it; nothing crosses ranks. */
#pragma once
#include "markers/dipoles.h"

#define DIPOLE_BELOW 1 /* rows below this rank's that the list has */
#define DIPOLE_ABOVE 2 /* rows above this rank's that the list has: the force on the row above needs both */

/* What a spot adds to a row: value times a part of a tensor, times the spot's weights along x. */
typedef struct {
  PetscInt spot; /* number of the spot */
  PetscInt part; /* number of the part in the array of all tensors */
  PetscReal value;
} DipoleHit;

typedef struct _p_DipoleList *DipoleList;
struct _p_DipoleList {
  Grid grid;              /* borrowed */
  PetscInt M;             /* dipoles */
  const DipoleSpot *spot; /* [DIPOLE_SPOTS M] borrowed */
  PetscInt window[2];     /* local rows that spots reach, rows of neighbours included */
  PetscInt *start[3];     /* [rows + below + above + 1] number of the first hit of a row, in each field */
  DipoleHit *hit[3];      /* hits of each field, row by row */
  PetscInt room[3];       /* capacity of hit */
};

/* DipoleListCreate - a list without dipoles. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleListCreate(Grid grid, DipoleList *list);
PETSC_EXTERN PetscErrorCode DipoleListDestroy(DipoleList *list);

/* DipoleListPlace - sort the spots[DIPOLE_SPOTS M] of M dipoles, which stay the caller's. A spot whose line along y has
   no entries adds nothing. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleListPlace(DipoleList list, PetscInt M, const DipoleSpot spot[]);

/* DipoleListAddRow - add what the tensors T[DIPOLE_COUNT M] give to local row j of a field. Not collective. */
PETSC_EXTERN void DipoleListAddRow(DipoleList list, Field field, PetscInt j, const PetscReal T[], PetscScalar row[]);

/* DipoleListSpread - add what the tensors give to the own rows of the velocity w and of source. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleListSpread(DipoleList list, const PetscReal T[], Vec w, Vec source);
