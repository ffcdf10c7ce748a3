/* What the edges of membranes obey: unknowns at the edges, the forces that they make on the markers, and as many rows,
   which determine them. The unknowns sigma are the tension over the stretch, one number an edge. With the markers X*
   where the law is placed, their edges e* = D X*, tau = e* / ds, and (Dm U)_k = tau_k.(D U)_k, the stretching rate of
   the edges times ds,

       F = Dm^T sigma                 minus the force on the markers
       (Dm V - c sigma)/h^2 = g       the rows, h the size of the grid's cells, V the markers' solved velocity.

   An inextensible membrane has c = 0 and a stretch of 1. One that stretches has sigma = sigma(q) of the new edges
   (stretch.h), linearised at q = |tau|^2, where it is sigma_q with the derivative slope, and the part of its viscosity
   mu, which resists the rate of the stretch (Kelvin and Voigt), the markers moving with U:

       sigma = sigma_q + slope (2/ds) tau.(e - e*) + mu (Dm U)/(q ds),
       c = a0 ds q/(2 slope q + mu a0),      w = mu a0/(2 slope q + mu a0).

   Where steps aim at the vesicles' first areas (docs/membrane.md, The area target), the part of a vesicle's equation of
   motion r = 0 along the gradient z of its area, |z| = 1 over all its markers, gives way to z.V = s,

       r := r - z (z.r) + ratio z (z.V - s),      ratio that of the viscosities, 1 without contrast.

   Next to nothing is lost: a pressure, a force along z, moves nothing in a fluid that keeps its volume.

   A law is that of the vesicles vesicle .. end - 1. Arrays are of these vesicles: [2n] of their n markers, [n] of their
   edges, unknowns and rows. Vectors are those of the own vesicles. */
#pragma once
#include "bodies/membrane.h"

typedef struct _p_MembraneLaw *MembraneLaw;
struct _p_MembraneLaw {
  Membrane membrane; /* borrowed */
  PetscReal h2;      /* h^2 */
  PetscInt vesicle, end;
  PetscInt first, n;  /* its markers: first .. first + n - 1 */
  PetscReal a0;       /* of the step */
  PetscReal *tau;     /* [2n] tangents where it is placed */
  PetscReal *c;       /* [n] c; NULL where no membrane stretches */
  PetscReal *viscous; /* [n] w; NULL likewise */
  PetscReal *excess;  /* [n] sigma_q/(2 slope) - (q - 1)/2, of the law green 0; NULL likewise */
  PetscReal *ratio;   /* [vesicles of the law] ratios of viscosities; NULL without an area target */
  PetscReal *z;       /* [2n] unit gradients of the areas; NULL likewise */
  PetscReal *speed;   /* [vesicles of the law] s (length/time); NULL likewise */
};

/* LawCreate - the law of these vesicles, not placed yet, without an area target. Not collective, as are all functions
   where nothing else is said. */
PETSC_EXTERN PetscErrorCode LawCreate(Membrane membrane, PetscReal h, PetscInt vesicle, PetscInt end, MembraneLaw *law);
PETSC_EXTERN PetscErrorCode LawDestroy(MembraneLaw *law);

/* LawAimAreas - steps aim at areas from here on; ratio[all vesicles], NULL: all 1. LawAimsAreas - whether they do. */
PETSC_EXTERN PetscErrorCode LawAimAreas(MembraneLaw law, const PetscReal ratio[]);
static inline PetscBool LawAimsAreas(MembraneLaw law) {
  return law->ratio ? PETSC_TRUE : PETSC_FALSE;
}

/* LawPlace - linearise at the markers X[2n], for a step of time coefficient a0 (1/time). */
PETSC_EXTERN void LawPlace(MembraneLaw law, PetscReal a0, const PetscScalar X[]);

/* LawForce - F += alpha Dm^T sigma. LawRows - d = the left-hand sides of the rows for V and sigma (NULL: 0). */
PETSC_EXTERN void LawForce(MembraneLaw law, PetscReal alpha, const PetscScalar sigma[], PetscScalar F[]);
PETSC_EXTERN void LawRows(MembraneLaw law, const PetscScalar V[], const PetscScalar sigma[], PetscScalar d[]);

/* LawTarget - g += what gives the edges of the new markers Xhat + U/a0 their sigma, or with c = 0 the length ds, where
   sigma_q/(2 slope) stands for (q - 1)/2. With ehat = D Xhat:

       (1 - w) a0 [-ds^2 sigma_q/(2 slope) - e*.(ehat - e*)]/(ds h^2) - w Dm T/h^2,

   T the velocity of the labels, which markers that pass along the membrane have besides V; NULL: no viscosity.
   Where c = 0 a0 may be another one than the step's: 0 leaves the edges as they are.

   LawTargetAreas - z, and s by which the new markers have the first areas A0:

       grad A.(Xhat + (background + V)/a0 - X*) = A0 - A(X*). */
PETSC_EXTERN PetscErrorCode LawTarget(MembraneLaw law, PetscReal a0, Vec Xhat, Vec T, Vec g);
PETSC_EXTERN PetscErrorCode LawTargetAreas(MembraneLaw law, PetscReal a0, Vec Xstar, Vec Xhat, Vec background);

/* LawReplaceAreas - in y[2n], the residual of the equation of motion at V, its part along z; aimed false: with s = 0,
   for a product with the operator. Nothing without an area target. */
PETSC_EXTERN void LawReplaceAreas(MembraneLaw law, PetscBool aimed, const PetscScalar V[], PetscScalar y[]);

/* LawScale - multiply the residuals d of the rows by weight h^2/(ds (1 + weight c)), or (inverse) divide: they are a
   velocity, or where c is large a tension, times a weight of the size of a viscosity. LawLargest - of a law of the
   own vesicles, the largest residual of the rows for V and sigma, times h^2/ds: a surface divergence (1/time).
   LawLargest is collective. */
PETSC_EXTERN void LawScale(MembraneLaw law, PetscReal weight, PetscBool inverse, PetscScalar d[]);
PETSC_EXTERN PetscErrorCode LawLargest(MembraneLaw law, Vec V, Vec sigma, Vec g, PetscReal *largest);

/* LawBlock - D[n][2n] = Dm/h^2 of one vesicle's n edges and markers, a row behind the other; its transpose is also F
   over h^2 as it follows from sigma. LawSchur - the law's part of a dense problem of all its vesicles: C[n][n], a
   column behind the other, is what the rows make of V = K sigma, K[n][2n] likewise, plus c and what keeps C regular:
   tension is all but a pressure where the vesicle is all but a circle. */
PETSC_EXTERN PetscErrorCode LawBlock(MembraneLaw law, PetscInt vesicle, PetscReal D[]);
PETSC_EXTERN PetscErrorCode LawSchur(MembraneLaw law, const PetscReal K[], PetscReal C[]);

/* LawRestore - take away what linearised targets have left in the markers X of one vesicle after a step: of its area by
   a shift along the normals, and (lengths, unless it stretches) of its edges, or where that cannot be, of its length. A
   shift by half an edge has lost the shape, and correcting edges would find another one. shift: that of the area
   (length); error: the largest relative error of an edge that was corrected; 0 when none was. */
PETSC_EXTERN PetscErrorCode LawRestore(MembraneLaw law, PetscInt vesicle, PetscBool lengths, PetscScalar X[],
                                       PetscReal *shift, PetscReal *error);
