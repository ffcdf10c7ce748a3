/* The spots of all dipoles by rows of the grid, so that tensors go to a row at once: sorted where markers are placed,
   for all products with them. */
#pragma once
#include "markers/dipoles.h"

#define DIPOLE_BELOW 1 /* rows below the own ones, */
#define DIPOLE_ABOVE 2 /* and above them, of which the force on the row above has to know */

/* A spot's line in a row: value times a part of a tensor, times the spot's weights along x. */
typedef struct {
  PetscInt spot, part; /* part: number of it among all tensors' */
  PetscReal value;
} DipoleHit;

typedef struct _p_DipoleList *DipoleList;
struct _p_DipoleList {
  Grid grid;              /* borrowed */
  PetscInt M;             /* dipoles */
  const DipoleSpot *spot; /* [DIPOLE_SPOTS M] borrowed */
  PetscInt window[2];     /* of these local rows, which may be neighbours' */
  PetscInt *start[3];     /* [rows + below + above + 1] of each field: a row's first hit */
  DipoleHit *hit[3];
  PetscInt room[3];
};

/* DipoleListCreate - none yet. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleListCreate(Grid grid, DipoleList *list);
PETSC_EXTERN PetscErrorCode DipoleListDestroy(DipoleList *list);

/* DipoleListPlace - of M dipoles' spots[DIPOLE_SPOTS M], which stay the caller's; lines along y without entries are
   nowhere. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleListPlace(DipoleList list, PetscInt M, const DipoleSpot spot[]);

/* DipoleListAddRow - what the tensors T[DIPOLE_COUNT M] give local row j of a field, added to it. Not collective. */
PETSC_EXTERN void DipoleListAddRow(DipoleList list, Field field, PetscInt j, const PetscReal T[], PetscScalar row[]);

/* DipoleListSpread - added to w and source: DipolesSpread. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleListSpread(DipoleList list, const PetscReal T[], Vec w, Vec source);
