/* Membranes of vesicles: edges, forces of tension and bending, energies and measures.

   Marker vectors and edge vectors (a tension) are distributed as src/markers/layout.h says. Functions of "all own
   vesicles" take this rank's part of them; functions of one vesicle take its own arrays, [2n] or [n] for its n markers,
   and work for any vesicle on any rank. Edge k runs from marker k-1 to marker k of the same vesicle. */
#pragma once
#include "markers/markers.h"
#include "curve/spectral.h"
#include "scene/scene.h"

/* Work space of [2 M], each for one purpose: what calls one another does not share. */
typedef struct {
  PetscScalar *stretching, *bending, *measures, *restore, *treading;
} MembraneWork;

typedef struct _p_Membrane *Membrane;
struct _p_Membrane {
  Layout layout;      /* borrowed; a body is a vesicle */
  PetscReal *ds;      /* [vesicles] fixed material spacing: mean initial edge (length) */
  PetscReal *A0, *L0; /* [vesicles] initial area and length */
  PetscReal bending;  /* c_b, the largest */
  PetscReal *part;    /* [vesicles] c_b of each over the largest; 1 where that is 0 */
  DerivativeType derivative;
  Spectral *spectral; /* [vesicles] */
  PetscReal *arc;     /* [vesicles] initial arc length, spectrally accurate */
  PetscReal *weight;  /* [2 vesicles] density difference times gravity (length/time^2); NULL without gravity */
  MembraneWork work;
};

/* MembraneCreate - membranes at rest with the markers X[2M] of all vesicles, and c_b of each, bending[vesicles]. Not
   collective. */
PETSC_EXTERN PetscErrorCode MembraneCreate(Layout layout, const PetscReal X[], const PetscReal bending[],
                                           DerivativeType derivative, Membrane *membrane);
PETSC_EXTERN PetscErrorCode MembraneDestroy(Membrane *membrane);

/* MembraneEdges - e = difference of X along one vesicle: chords e_k = X_k - X_{k-1}, or spectral derivatives dX/dk. */
PETSC_EXTERN void MembraneEdges(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscScalar e[]);

/* MembraneEdgesTranspose - Y += alpha (the transpose of MembraneEdges) F. */
PETSC_EXTERN void MembraneEdgesTranspose(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar F[],
                                         PetscScalar Y[]);

/* MembraneVesicleTangents - tau = e/ds of one vesicle. MembraneTangents - of all own vesicles. */
PETSC_EXTERN void MembraneVesicleTangents(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscReal tau[]);
PETSC_EXTERN void MembraneTangents(Membrane membrane, const PetscScalar X[], PetscReal tau[]);

/* MembraneVesicleStretching - d_k = tau_k . (edge of U)_k of one vesicle: Dm U, the edges' stretching rate times ds.
   MembraneStretching - of all own vesicles. */
PETSC_EXTERN void MembraneVesicleStretching(Membrane membrane, PetscInt vesicle, const PetscReal tau[],
                                            const PetscScalar U[], PetscScalar d[]);
PETSC_EXTERN void MembraneStretching(Membrane membrane, const PetscReal tau[], const PetscScalar U[], PetscScalar d[]);

/* MembraneStretchingTranspose - F += alpha Dm^T sigma of all own vesicles. */
PETSC_EXTERN void MembraneStretchingTranspose(Membrane membrane, const PetscReal tau[], PetscReal alpha,
                                              const PetscScalar sigma[], PetscScalar F[]);

/* MembraneVesiclePull - F += alpha D^T (tension D X)/ds of one vesicle, D X its edges: minus the force of a given
   tension[n] (length^3/time^2), linear in the markers X. Symmetric, without negative eigenvalue where the tension is
   nowhere negative. MembranePull - of all own vesicles. */
PETSC_EXTERN void MembraneVesiclePull(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscReal tension[],
                                      const PetscScalar X[], PetscScalar F[]);
PETSC_EXTERN void MembranePull(Membrane membrane, PetscReal alpha, const PetscReal tension[], const PetscScalar X[],
                               PetscScalar F[]);

/* MembraneVesicleBending - F += alpha part ds D4 X of one vesicle, D4 = (D+D-)(D+D-) with the fixed spacing ds, part
   its c_b over the largest: alpha is with the largest. Symmetric. MembraneBending - of all own vesicles. */
PETSC_EXTERN void MembraneVesicleBending(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar X[],
                                         PetscScalar F[]);
PETSC_EXTERN void MembraneBending(Membrane membrane, PetscReal alpha, const PetscScalar X[], PetscScalar F[]);

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

/* MembraneFrequency - tank-treading frequency 2 pi/|CLOSED INT dl/(u.tau)| (radians a time) of one vesicle, u relative
   to the markers' mean velocity, by spectral derivatives of X; NaN unless u.tau has one sign all round, and more than
   rounding. */
PETSC_EXTERN PetscReal MembraneFrequency(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                         const PetscScalar U[]);

/* MembraneNormalSpeed - max |u.n| of one vesicle, the speed of its outline (length/time): n by the spectral derivative
   of X, so that it is not taken for motion when markers pass along a curve at rest. */
PETSC_EXTERN PetscReal MembraneNormalSpeed(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                           const PetscScalar U[]);

/* MembraneSetWeight - density difference (over the outer density) times gravity, weight[2 vesicles] (length/time^2).
   MembraneVesicleGravity - F += alpha (weight.(X - centroid)) n ds of one vesicle, n outward: the jump of the
   hydrostatic pressures, whose sum over the markers is weight times the area, without torque. MembraneGravity - of all
   own vesicles; nothing without gravity. MembraneGravityEnergy - minus weight . INT x dA of one vesicle. */
PETSC_EXTERN PetscErrorCode MembraneSetWeight(Membrane membrane, const PetscReal weight[]);
PETSC_EXTERN void MembraneVesicleGravity(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar X[],
                                         PetscScalar F[]);
PETSC_EXTERN void MembraneGravity(Membrane membrane, PetscReal alpha, const PetscScalar X[], PetscScalar F[]);
PETSC_EXTERN PetscReal MembraneGravityEnergy(Membrane membrane, PetscInt vesicle, const PetscScalar X[]);

/* MembraneCentroidVelocity - of the centroid of one vesicle's area (length/time), its markers moving with U. */
PETSC_EXTERN void MembraneCentroidVelocity(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                           const PetscScalar U[], PetscReal velocity[2]);

/* MembraneRestoreEdges - where an edge of one vesicle is off by more than tolerance (relative), move its markers as
   little as possible until all edges have the length ds and the area is what it was: Newton (CurveFit). Nothing moves
   where that does not converge, as on a circle, which has no freedom. error: the largest one corrected, 0 when nothing
   has moved. */
PETSC_EXTERN PetscErrorCode MembraneRestoreEdges(Membrane membrane, PetscInt vesicle, PetscReal tolerance,
                                                 PetscScalar X[], PetscReal *error);

/* MembraneRestoreLength - move one vesicle's markers as little as possible until the sum of its edges is L0 and the
   area is what it was: Newton on the two. Nothing moves where the length is off by more than tolerance (relative), or
   where the gradients of both are nearly the same, as on a circle. */
PETSC_EXTERN PetscErrorCode MembraneRestoreLength(Membrane membrane, PetscInt vesicle, PetscReal tolerance,
                                                  PetscScalar X[]);

/* MembraneRestoreArea - shift one vesicle's markers by a uniform distance along the vertex normals (of the chord from
   X_{k-1} to X_{k+1}, or of the spectral edge) until its area is A0: Newton on the area. Returns the shift (length). */
PETSC_EXTERN PetscReal MembraneRestoreArea(Membrane membrane, PetscInt vesicle, PetscScalar X[]);

/* MembraneAreaGradient - of one vesicle's area by its markers X[2n]: z[2n], the vertex normals, outwards (length). */
PETSC_EXTERN void MembraneAreaGradient(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscReal z[]);

/* MembraneTreading - how fast the shape of one vesicle turns in its labels t, which run from 0 to 2 pi: V (1/time) of
   the least squares fit U ~ c + omega J (X - mean) + V dX/dt. Where a turn and a shift of labels are the same to 5 %,
   as on a circle, omega is left out. */
PETSC_EXTERN PetscReal MembraneTreading(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                        const PetscScalar U[]);

/* MembraneLabelDerivative - Y += alpha dX/dt of one vesicle, spectral. MembraneTread - U += alpha V dX/dt of all own
   vesicles, with V[vesicles]. */
PETSC_EXTERN void MembraneLabelDerivative(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar X[],
                                          PetscScalar Y[]);
PETSC_EXTERN void MembraneTread(Membrane membrane, const PetscReal V[], PetscReal alpha, const PetscScalar X[],
                                PetscScalar U[]);

/* MembraneShiftLabels - y(t) = x(t + V time) of all own vesicles, with V[vesicles] and `each` (1 or 2) numbers a
   marker. */
PETSC_EXTERN void MembraneShiftLabels(Membrane membrane, const PetscReal V[], PetscReal time, int each,
                                      const PetscScalar x[], PetscScalar y[]);
