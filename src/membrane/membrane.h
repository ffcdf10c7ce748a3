/* Membranes: markers, edges, bending, energies and the measures of DESIGN section 9.

   Marker vectors are sequential vectors that every rank holds in full, x0,y0,x1,y1,... of all vesicles one after
   another; tensions are one number an edge, edge k running from marker k-1 to marker k of the same vesicle. */
#pragma once
#include "base/base.h"
#include "curve/spectral.h"
#include "scene/scene.h"

typedef struct _p_Membrane *Membrane;
struct _p_Membrane {
  PetscInt vesicles;
  PetscInt *start;    /* [vesicles+1] first marker of each vesicle */
  PetscInt M;         /* markers in all */
  PetscReal *ds;      /* [vesicles] fixed material spacing: mean initial edge (length) */
  PetscReal *A0, *L0; /* [vesicles] initial area and length */
  PetscReal bending;  /* c_b */
  DerivativeType derivative;
  Spectral *spectral; /* [vesicles] */
  PetscReal *arc;     /* [vesicles] initial arc length, spectrally accurate */
  PetscScalar *work;  /* [2M] for use inside this folder */
  PetscInt *previous; /* [M] the marker before k on the same vesicle */
  PetscInt *next;     /* [M] the marker after k */
  PetscReal *spacing; /* [M] ds of the vesicle that marker k is on */
};

/* MembraneCreate - membranes at rest in the given shape (copied). */
PETSC_EXTERN PetscErrorCode MembraneCreate(const Shape *shape, PetscReal bending, DerivativeType derivative,
                                           Membrane *membrane);
PETSC_EXTERN PetscErrorCode MembraneDestroy(Membrane *membrane);

/* MembraneCreateMarkerVec, MembraneCreateTensionVec - zero sequential vectors of length 2M and M. */
PETSC_EXTERN PetscErrorCode MembraneCreateMarkerVec(Membrane membrane, Vec *X);
PETSC_EXTERN PetscErrorCode MembraneCreateTensionVec(Membrane membrane, Vec *sigma);

/* MembraneEdges - e = difference of X along one vesicle, its own arrays [2n]: chords e_k = X_k - X_{k-1}, or spectral
   derivatives dX/dk. */
PETSC_EXTERN void MembraneEdges(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscScalar e[]);

/* MembraneEdgesTranspose - Y += alpha (the transpose of MembraneEdges) F. */
PETSC_EXTERN void MembraneEdgesTranspose(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar F[],
                                         PetscScalar Y[]);

/* MembraneTangents - tau = e/ds, tau[2M]. */
PETSC_EXTERN void MembraneTangents(Membrane membrane, const PetscScalar X[], PetscReal tau[]);

/* MembraneStretching - d_k = tau_k . (edge of U)_k: Dm U, the edges' stretching rate times ds. d[M], U[2M]. */
PETSC_EXTERN void MembraneStretching(Membrane membrane, const PetscReal tau[], const PetscScalar U[], PetscScalar d[]);

/* MembraneStretchingTranspose - F += alpha Dm^T sigma, F[2M], sigma[M]. */
PETSC_EXTERN void MembraneStretchingTranspose(Membrane membrane, const PetscReal tau[], PetscReal alpha,
                                              const PetscScalar sigma[], PetscScalar F[]);

/* MembraneBendingVesicle - F += alpha ds D4 X on one vesicle's own arrays [2n], D4 = (D+D-)(D+D-) with the fixed
   spacing ds; work[2n]. Symmetric. */
PETSC_EXTERN void MembraneBendingVesicle(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar X[],
                                         PetscScalar work[], PetscScalar F[]);

/* MembraneBending - the same for all vesicles, arrays [2M]. */
PETSC_EXTERN void MembraneBending(Membrane membrane, PetscReal alpha, const PetscScalar X[], PetscScalar work[],
                                  PetscScalar F[]);

/* MembraneBendingEnergy - E_B = c_b/2 SUM |D+D- X|^2 ds (37) of one vesicle. */
PETSC_EXTERN PetscReal MembraneBendingEnergy(Membrane membrane, PetscInt vesicle, const PetscScalar X[]);

/* Measures of one vesicle. */
typedef struct {
  PetscReal area;        /* of the polygon or of the spectral curve, positive: markers run counter-clockwise */
  PetscReal length;      /* sum of edges */
  PetscReal edge_ratio;  /* longest over shortest edge */
  PetscReal center[2];   /* centroid of the enclosed area */
  PetscReal inclination; /* of the long axis of the area's second moments, radians in (-pi/2, pi/2] */
} Measures;
PETSC_EXTERN void MembraneMeasure(Membrane membrane, PetscInt vesicle, const PetscScalar X[], Measures *measures);

/* MembraneFrequency - tank-treading frequency 2 pi/|CLOSED INT dl/(u.tau)| (radians a time), u relative to the markers'
   mean velocity, by spectral derivatives of X; NaN unless u.tau has one sign all round. */
PETSC_EXTERN PetscErrorCode MembraneFrequency(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                              const PetscScalar U[], PetscReal *frequency);

/* MembraneNormalSpeed - max over the markers of |u.n|, n the normal of the chord from X_{k-1} to X_{k+1}. */
PETSC_EXTERN PetscReal MembraneNormalSpeed(Membrane membrane, const PetscScalar X[], const PetscScalar U[]);

/* MembraneRestoreEdges - where an edge of one vesicle is off by more than tolerance (relative), move its markers as
   little as possible until all edges have the length ds and the area is what it was: Newton (CurveFit). Nothing moves
   where that does not converge, as on a circle, which has no freedom. error: the largest one put right, 0 when nothing
   has moved. X: all markers [2M]. */
PETSC_EXTERN PetscErrorCode MembraneRestoreEdges(Membrane membrane, PetscInt vesicle, PetscReal tolerance,
                                                 PetscScalar X[], PetscReal *error);

/* MembraneRestoreArea - shift one vesicle's markers by a uniform distance along the vertex normals (of the chord from
   X_{k-1} to X_{k+1}, or of the spectral edge) until its area is A0: Newton on the area. The old markers move alike.
   Returns the shift (length). X, X_old: all markers [2M]. */
PETSC_EXTERN PetscReal MembraneRestoreArea(Membrane membrane, PetscInt vesicle, PetscScalar X[], PetscScalar X_old[]);
