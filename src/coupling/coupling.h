/* Grid and membrane joined: interpolation E, spreading E^T, and the operators S and B of the momentum equation.

   Markers are few, so every rank holds all marker vectors (sequential vectors), spreads onto its own slab only, and an
   interpolation ends in one reduction and one broadcast, so that its result has the same bits on every rank. The
   MatShells below are therefore sequential, between marker vectors and the rank's local part of a velocity ("slab"),
   but applying E, S^T or B^T is collective over the grid's ranks. */
#pragma once
#include "kernel/kernel.h"
#include "fluid/fluid.h"
#include "membrane/membrane.h"

/* Where a marker sees one component: rows y.first.., columns x.first.., with their weights. */
typedef struct {
  PetscInt first[2], n[2]; /* x, y; first wrapped into the grid where periodic */
  PetscReal weight[2][KERNEL_MAX_POINTS];
} Stencil;

typedef struct _p_Coupling *Coupling;
struct _p_Coupling {
  Grid grid;         /* borrowed */
  Membrane membrane; /* borrowed */
  const Kernel *kernel;
  Stencil *stencil;   /* [2M]: component c of marker k at 2k + c */
  PetscReal *X;       /* [2M] the coupling's markers */
  PetscReal *tau;     /* [2M] tangents there */
  PetscInt window[2]; /* this rank's rows that hold all stencils, with the rows next to them */
  PetscScalar *force, *work, *sum;
  PetscReal alpha; /* factor of the spreading under way */
  Vec slab;        /* sequential vector without memory, for a velocity's local part */
  Mat E;           /* (2M x slab) U_k = SUM u(x) phi phi; E^T spreads */
  Mat S;           /* (slab x M) S = E^T Dm^T/h^2: minus the spread tension force */
  Mat B;           /* (slab x 2M) B = E^T (c_b ds/h^2) D4: minus the spread bending force */
  PetscLogEvent spread, interpolate;
};

/* CouplingCreate - for a membrane over a grid with the named kernel; markers are not set yet. */
PETSC_EXTERN PetscErrorCode CouplingCreate(Grid grid, Membrane membrane, const char kernel[], Coupling *coupling);
PETSC_EXTERN PetscErrorCode CouplingDestroy(Coupling *coupling);

/* CouplingCheckMarkers - message is empty when every marker of X[2M] is finite and at least three cells from every
   wall, else it names the vesicle and the wall; length: size of message. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingCheckMarkers(Coupling coupling, const PetscScalar X[], char message[],
                                                 size_t length);

/* CouplingSetMarkers - place E, S, B at the markers X (checked by CouplingCheckMarkers before). */
PETSC_EXTERN PetscErrorCode CouplingSetMarkers(Coupling coupling, Vec X);

/* CouplingClear - w (a velocity or a pressure) is zero but for rows dirty[2], which are zeroed; dirty becomes the
   coupling's window, where the caller may write. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingClear(Coupling coupling, Vec w, PetscInt dirty[2]);

/* CouplingSpreadAdd - w += alpha A x for A one of S and B, or w += alpha E^T x for E; x a marker or tension vector. */
PETSC_EXTERN PetscErrorCode CouplingSpreadAdd(Coupling coupling, PetscReal alpha, Mat A, Vec x, Vec w);

/* CouplingInterpolate - y = E w, or y = S^T w; w a velocity. Collective. */
PETSC_EXTERN PetscErrorCode CouplingInterpolate(Coupling coupling, Mat A, Vec w, Vec y);
