/* Membranes of vesicles: edges, measures, and corrections after a step.

   The markers X_k of a vesicle have edges e = D X and tangents tau = e/ds. D is the difference of neighbours (edge k
   runs from marker k-1 to marker k) or the spectral derivative by the marker index. What edges obey is the membranes'
   law (law.h).

   Marker vectors and edge vectors (a tension) are distributed as markers/layout.h says. Functions of "all own vesicles"
   take this rank's part of them. Functions of one vesicle take its own arrays, [2n] or [n] for its n markers, and work
   for any vesicle on any rank. Nothing crosses ranks. */
#pragma once
#include "markers/markers.h"
#include "numerics/spectral.h"
#include "scene/scene.h"

/* Work arrays [2 M]. Each belongs to one group of functions, so that functions that call one another share none. */
typedef struct {
  PetscScalar *stretching, *bending, *measures, *restore, *treading;
  PetscScalar *memory; /* [4 M] */
} MembraneWork;

typedef struct _p_Membrane *Membrane;
struct _p_Membrane {
  Layout layout;          /* borrowed; a body is a vesicle */
  PetscReal *ds;          /* [vesicles] fixed material spacing: mean edge at rest (length) */
  PetscReal *A0, *L0;     /* [vesicles] initial area, length at rest */
  PetscReal bending;      /* the largest c_b */
  PetscReal *part;        /* [vesicles] c_b of each over the largest c_b; 1 where the largest is 0 */
  Material *material;     /* [vesicles] */
  PetscBool stretches;    /* one of them */
  PetscBool viscous;      /* one of them, against its stretching */
  MomentType moment;      /* how membranes that stretch bend */
  PetscReal permeability; /* P (time/length); 0: none */
  PetscReal osmotic[2];   /* pressures inside and outside (length^2/time^2) */
  PetscReal *memory;      /* [M] curvature that bending prefers (1/length); NULL: none */
  PetscReal **B;          /* [vesicles][2n][2n] B of bending.h with a memory; NULL likewise */
  DerivativeType derivative;
  Spectral *spectral; /* [vesicles] */
  PetscReal *arc;     /* [vesicles] arc length at rest, spectrally accurate */
  MembraneWork work;
};

/* MembraneCreate - membranes with the first markers X[2M] of all vesicles, as the scene gives them. Not collective.
   MembraneStretches - whether a vesicle's membrane stretches. */
PETSC_EXTERN PetscErrorCode MembraneCreate(Layout layout, const PetscReal X[], const SceneMembrane *given,
                                           Membrane *membrane);
static inline PetscBool MembraneStretches(Membrane membrane, PetscInt vesicle) {
  return membrane->material[vesicle].law != LAW_INEXTENSIBLE ? PETSC_TRUE : PETSC_FALSE;
}
PETSC_EXTERN PetscErrorCode MembraneDestroy(Membrane *membrane);

/* MembraneEdges - edges e = D X of one vesicle: chords e_k = X_k - X_{k-1}, or spectral derivatives dX/dk.
   MembraneEdgesTranspose - Y += alpha D^T F. */
PETSC_EXTERN void MembraneEdges(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscScalar e[]);
PETSC_EXTERN void MembraneEdgesTranspose(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar F[],
                                         PetscScalar Y[]);

/* MembraneTangents - tau = e/ds of the vesicles vesicle .. end - 1, whose markers X are. */
PETSC_EXTERN void MembraneTangents(Membrane membrane, PetscInt vesicle, PetscInt end, const PetscScalar X[],
                                   PetscReal tau[]);

/* MembraneVesiclePull - minus the force of a given tension[n] (length^3/time^2) of one vesicle, linear in the markers
   X:

     F += alpha D^T (tension D X)/ds.

   The matrix is symmetric, and without negative eigenvalue where the tension is nowhere negative. */
PETSC_EXTERN void MembraneVesiclePull(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscReal tension[],
                                      const PetscScalar X[], PetscScalar F[]);

/* Measures of one vesicle. */
typedef struct {
  PetscReal area;        /* of the polygon or of the spectral curve; positive, as markers run counter-clockwise */
  PetscReal length;      /* sum of edges */
  PetscReal edge_ratio;  /* longest over shortest edge */
  PetscReal center[2];   /* centroid of the enclosed area */
  PetscReal inclination; /* of the long axis of the area's second moments, radians in (-pi/2, pi/2] */
} Measures;
PETSC_EXTERN void MembraneMeasure(Membrane membrane, PetscInt vesicle, const PetscScalar X[], Measures *measures);

/* MembraneFrequency - tank-treading frequency of one vesicle (radians a time), with u relative to the mean velocity of
   the markers and spectral derivatives of X:

     2 pi/|INT dl/(u.tau)|   round the membrane.

   NaN unless u.tau has the same sign all round and is larger than rounding. */
PETSC_EXTERN PetscReal MembraneFrequency(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                         const PetscScalar U[]);

/* MembraneNormalSpeed - max |u.n| of one vesicle, the speed of its outline (length/time). n is made of the spectral
   derivative of X, so that markers that pass along a curve at rest do not count as motion. */
PETSC_EXTERN PetscReal MembraneNormalSpeed(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                           const PetscScalar U[]);

/* MembraneCentroidVelocity - velocity of the centroid of one vesicle's area (length/time) when its markers move with U:

     (1/area) INT (x - centroid) (u.n) ds. */
PETSC_EXTERN void MembraneCentroidVelocity(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                           const PetscScalar U[], PetscReal velocity[2]);

/* MembraneRestoreEdges - if an edge of one vesicle is off by more than tolerance (relative), move its markers as little
   as possible until all edges have the length ds and the area is as before (CurveFit). Nothing moves where Newton's
   method does not converge, as on a circle, which has no freedom. error: the largest error of an edge that was
   corrected; 0 when nothing has moved. */
PETSC_EXTERN PetscErrorCode MembraneRestoreEdges(Membrane membrane, PetscInt vesicle, PetscReal tolerance,
                                                 PetscScalar X[], PetscReal *error);

/* MembraneRestoreLength - move one vesicle's markers as little as possible until the sum of its edges is L0 and the
   area is as before, by Newton's method. Nothing moves where the length is off by more than tolerance (relative), or
   where the gradients of length and area are nearly parallel, as on a circle. */
PETSC_EXTERN PetscErrorCode MembraneRestoreLength(Membrane membrane, PetscInt vesicle, PetscReal tolerance,
                                                  PetscScalar X[]);

/* MembraneRestoreArea - shift one vesicle's markers by the same distance along the vertex normals until its area is A0,
   by Newton's method. A vertex normal is that of the chord from X_{k-1} to X_{k+1}, or of the spectral edge. Returns
   the shift (length). */
PETSC_EXTERN PetscReal MembraneRestoreArea(Membrane membrane, PetscInt vesicle, PetscScalar X[]);

/* MembraneAreaGradient - gradient z[2n] of one vesicle's area by its markers X[2n]: outward vertex normals (length). */
PETSC_EXTERN void MembraneAreaGradient(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscReal z[]);

/* MembraneTreading - speed V (1/time) at which the markers of one vesicle pass along its shape, in labels t = 0 .. 2
   pi: the least-squares fit

     U ~ c + omega J (X - mean) + V dX/dt,   J a quarter turn.

   Where a turn and a shift of labels are the same to 5 %, as on a circle, omega is left out. */
PETSC_EXTERN PetscReal MembraneTreading(Membrane membrane, PetscInt vesicle, const PetscScalar X[],
                                        const PetscScalar U[]);

/* MembraneLabelDerivative - Y += alpha dX/dt of one vesicle, spectral. MembraneTread - U += alpha V dX/dt of all own
   vesicles, V[vesicles]. MembraneShiftLabels - y(t) = x(t + V time) of all own vesicles, V[vesicles], with `each` (1 or
   2) numbers a marker. */
PETSC_EXTERN void MembraneLabelDerivative(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar X[],
                                          PetscScalar Y[]);
PETSC_EXTERN void MembraneTread(Membrane membrane, const PetscReal V[], PetscReal alpha, const PetscScalar X[],
                                PetscScalar U[]);
PETSC_EXTERN void MembraneShiftLabels(Membrane membrane, const PetscReal V[], PetscReal time, int each,
                                      const PetscScalar x[], PetscScalar y[]);
