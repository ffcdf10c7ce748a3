/* The markers of all bodies on the grid: where they are, which faces their kernels reach, and the interpolation E.

   Markers are few beside the grid's faces: every rank knows the positions of all of them and spreads onto its own rows
   only. So a spreading begins with one gather of the forces, and an interpolation ends with one sum of the ranks' parts
   that goes to the bodies' owners. In unbounded fluid (grid->free) nothing is on the grid: markers may be anywhere, E =
   0. */
#pragma once
#include "fluid/forcing.h"
#include "fluid/stream.h"
#include "markers/layout.h"
#include "markers/rows.h"

typedef struct _p_Markers *Markers;
struct _p_Markers {
  Grid grid;     /* borrowed */
  Layout layout; /* borrowed */
  const Kernel *kernel;
  PetscReal *X;       /* [2M] positions of all markers */
  PetscBool folded;   /* stencils are folded at walls (fold.h) */
  PetscBool scaled;   /* and scaled near them */
  PetscReal least;    /* cells that markers keep from walls */
  const char *needs;  /* the same as text */
  Stencil *stencil;   /* [2M]: component c of marker k at 2k + c */
  Stencil *plain;     /* [2M]: the same neither folded nor scaled */
  MarkerRows rows;    /* of stencil, those of this rank */
  GridWindow window;  /* of this rank's faces that holds all stencils, with the rows and columns next to them */
  PetscScalar *force; /* [2M] work: all forces */
  PetscScalar *part;  /* [2M] work: this rank's part of all velocities */
  Mat E;              /* (marker vector x velocity) U_k = SUM u(x) phi phi; E^T spreads */
  PetscLogEvent spread, interpolate, respond;
};

/* MarkersCreate - for the bodies of a layout over a grid with the named kernel; not placed yet. folded: stencils are
   folded at walls at rest and scaled near them, and markers may come to a quarter of a cell from walls. Collective.
   MarkersLeaveUnscaled - from here on they are folded only: for the box part, whose error then is smooth up to a wall,
   and which takes off what scaling would. Not collective. */
PETSC_EXTERN PetscErrorCode MarkersCreate(Grid grid, Layout layout, const char kernel[], PetscBool folded,
                                          Markers *markers);
PETSC_EXTERN void MarkersLeaveUnscaled(Markers markers);
PETSC_EXTERN PetscErrorCode MarkersDestroy(Markers *markers);

/* MarkersCheck - message[PETVES_MAX_MESSAGE] is empty when every marker of X, of the vesicles of `layout`, is finite
   and at least `least` cells from every wall (not in unbounded fluid), else it names the vesicle and the wall; the same
   on every rank. Collective. */
PETSC_EXTERN PetscErrorCode MarkersCheck(Markers markers, Layout layout, Vec X, char message[PETVES_MAX_MESSAGE]);

/* MarkersPlace - put E at the markers X (checked by MarkersCheck before). Collective. */
PETSC_EXTERN PetscErrorCode MarkersPlace(Markers markers, Vec X);

/* MarkersShortfall - what component comp of a unit force at the own or another's marker k has as its first moment
   across the box along dir, about the middle, less what its stencil makes of it (length): stencils reproduce linear
   functions, but not those that are folded or scaled at walls along dir; 0 from the kernel's reach on. Not collective.
 */
PETSC_EXTERN PetscReal MarkersShortfall(Markers markers, PetscInt k, int comp, int dir);

/* MarkersSpread - w += alpha E^T F; F a marker vector, w a velocity. ForcingSpread - to the forcing's values, in the
   markers' window. MarkersInterpolate - U = E w. Collective. */
PETSC_EXTERN PetscErrorCode MarkersSpread(Markers markers, PetscReal alpha, Vec F, Vec w);
PETSC_EXTERN PetscErrorCode ForcingSpread(Forcing *forcing, Markers markers, PetscReal alpha, Vec F);
PETSC_EXTERN PetscErrorCode MarkersInterpolate(Markers markers, Vec w, Vec U);
