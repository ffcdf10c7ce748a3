/* The markers of all bodies on the grid: their stencils and the interpolation E,

       U_k = (E u)_k = SUM_faces u(x) phi(x - X_k),      spreading: w = E^T F,

   phi a tensor product of 1-D kernels (kernel.h).

   Markers are few beside the grid's faces: every rank knows the positions of all markers and spreads onto its own rows.
   So a spreading begins with one gather of the forces, and an interpolation ends with one sum of the ranks' parts that
   goes to the bodies' owners. Points that bear no forces may stand behind the markers: E gives the velocity there too,
   in `part`. In unbounded fluid (grid->free) nothing is on the grid: markers may be anywhere, and E = 0.

   Order: MarkersCreate, then for each set of positions MarkersCheck and MarkersPlace before E is used. */
#pragma once
#include "fluid/stokes/forcing.h"
#include "fluid/stokes/stream.h"
#include "markers/layout.h"
#include "markers/rows.h"

typedef struct _p_Markers *Markers;
struct _p_Markers {
  Grid grid;     /* borrowed */
  Layout layout; /* borrowed */
  const Kernel *kernel;
  PetscInt points;        /* P, points that bear no forces */
  const PetscReal *point; /* [2P] where they are when markers are placed; borrowed */
  PetscReal *X;           /* [2M + 2P] positions of all markers and points, in whole vectors (LANES) */
  PetscBool folded;       /* stencils are folded at walls (wallfold.h) */
  PetscBool scaled;       /* stencils are scaled near walls (WallScale) */
  PetscReal least;        /* cells that markers keep from walls */
  const char *needs;      /* `least` as text */
  Stencil *stencil;       /* [2M + 2P]: component c of marker k at 2k + c */
  Stencil *plain;         /* [2M + 2P]: stencils that are neither folded nor scaled */
  StencilRows rows;       /* the stencils by rows, those of the row above this rank's included */
  GridWindow window;      /* this rank's faces that all stencils reach, with the rows and columns next to them */
  PetscScalar *force;     /* [2M + 2P] work: forces of all markers, zero behind them */
  PetscScalar *part; /* [2M + 2P]: velocities of all markers and points by the last E, summed over this rank's rows */
  Mat E;             /* marker vector x velocity; MultTranspose spreads */
  PetscLogEvent spread, interpolate, respond;
};

/* MarkersCreate - for the bodies of a layout, and points, over a grid with the named kernel; not placed yet. folded:
   stencils are folded at walls at rest and scaled near them, and markers may come to a quarter of a cell from walls.
   Collective. MarkersLeaveUnscaled - stencils are folded but no longer scaled. The error of the box part is then smooth
   up to a wall, and the box part makes up for the scaling. Not collective. */
PETSC_EXTERN PetscErrorCode MarkersCreate(Grid grid, Layout layout, const char kernel[], PetscBool folded,
                                          PetscInt points, const PetscReal point[], Markers *markers);
PETSC_EXTERN void MarkersLeaveUnscaled(Markers markers);
PETSC_EXTERN PetscErrorCode MarkersDestroy(Markers *markers);

/* MarkersCheck - message[PETVES_MAX_MESSAGE] names a vesicle of `layout` with a marker of X that is not finite or,
   unless the fluid is unbounded, nearer to a wall than `least` cells; empty when there is none. The same on every rank.
   Collective. */
PETSC_EXTERN PetscErrorCode MarkersCheck(Markers markers, Layout layout, Vec X, char message[PETVES_MAX_MESSAGE]);

/* MarkersPlace - put E at the markers X, which MarkersCheck has found good. Collective. */
PETSC_EXTERN PetscErrorCode MarkersPlace(Markers markers, Vec X);

/* MarkersShortfall - first moment along dir, about the middle of the box, of component comp of a unit force at marker k
   less that of its stencil (length). Stencils reproduce linear functions unless they are folded or scaled at walls
   along dir: the shortfall is 0 farther from them than the kernel reaches. Not collective. */
PETSC_EXTERN PetscReal MarkersShortfall(Markers markers, PetscInt k, int comp, int dir);

/* MarkersSpread - w += alpha E^T F; F a marker vector, w a velocity. ForcingSpread - to the forcing's values, in the
   markers' window. MarkersInterpolate - U = E w; U NULL: `part` alone. Collective. */
PETSC_EXTERN PetscErrorCode MarkersSpread(Markers markers, PetscReal alpha, Vec F, Vec w);
PETSC_EXTERN PetscErrorCode ForcingSpread(Forcing *forcing, Markers markers, PetscReal alpha, Vec F);
PETSC_EXTERN PetscErrorCode MarkersInterpolate(Markers markers, Vec w, Vec U);
