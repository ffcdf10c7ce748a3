/* Self-mobility: the marker velocity that the kernel's smoothing takes away is given back (docs/accuracy.md),
       U = E u + Theta (f ds),   f ds = -(Dm^T sigma) - c_b ds D4 X_new,
   Theta symmetric and non-negative, a full block a vesicle, which its owner holds:
       local:   Theta = (h c/(nu ds)) t t^T
       symbol:  Theta = F^T [circ dT, circ dX; circ dX, circ dN] F/ds, F the rotation into (tangent, normal) frames, dT
   and dN the mobility of tangential and normal force waves on a plane membrane in steady flow, exact minus gridded. c,
   dT and dN depend on the membrane's angle alpha to the grid like c(0) + (c(pi/4) - c(0)) sin^2 2 alpha, nearly: a
   composite kernel is narrower across a membrane along a grid line than across a diagonal; and at an angle it moves a
   membrane across the force, dX like sin 4 alpha. c and dT also go with the markers' places in their cells. */
#pragma once
#include "membrane/membrane.h"

typedef struct _p_SelfMobility *SelfMobility;

/* SelfMobilityCreate - of the given type (SELF_LOCAL, SELF_SYMBOL) for membranes whose markers are on a grid, in a
   fluid of viscosity nu. Not collective. */
PETSC_EXTERN PetscErrorCode SelfMobilityCreate(Markers markers, Membrane membrane, PetscReal nu, SelfMobilityType type,
                                               SelfMobility *self);
PETSC_EXTERN PetscErrorCode SelfMobilityDestroy(SelfMobility *self);

/* SelfMobilityPlace - Theta of the own vesicles at the markers X[2n], where the grid's markers have been placed before,
   and for a0 a Cholesky factor for R = (I + (c_b ds/a0) Theta D4)^-1. factored is false when one of this rank's cannot
   be made. Not collective. */
PETSC_EXTERN PetscErrorCode SelfMobilityPlace(SelfMobility self, PetscReal a0, const PetscScalar X[],
                                              PetscBool *factored);

/* SelfMobilityApply - U := R (U - Theta (Dm^T sigma + c_b ds D4 Xhat)) of all own vesicles, U[2n], tangents tau[2n];
   sigma[n] and Xhat[2n] may be NULL. With sigma, U = E u becomes the solved part of the markers' velocity; with Xhat, U
   = u_inf becomes the part known before. Not collective. */
PETSC_EXTERN PetscErrorCode SelfMobilityApply(SelfMobility self, const PetscReal tau[], const PetscScalar sigma[],
                                              const PetscScalar Xhat[], PetscScalar U[]);

/* SelfMobilityMultTheta - F := Theta F of all own vesicles, F[2n]. Not collective. */
PETSC_EXTERN PetscErrorCode SelfMobilityMultTheta(SelfMobility self, PetscScalar F[]);

/* SelfMobilityBlock - Theta of one own vesicle of n markers, symmetric [2n][2n]; borrowed. */
PETSC_EXTERN const PetscReal *SelfMobilityBlock(SelfMobility self, PetscInt vesicle);

/* SmoothingSum - 1/2 SUM SUM |i - j| w_i w_j of n weights. */
PETSC_EXTERN PetscReal SmoothingSum(PetscInt n, const PetscReal w[]);

/* SmoothingConstants - c = 1/2 SUM SUM |i - j| w_i w_j, mean over sub-cell positions, w the weights summed along the
   membrane: h c/nu is what long waves along it lose. c[0]: along a grid line (the across weights), c[1]: along a
   diagonal, where sums lie h/sqrt(2) apart. The sum and not the integral because the grid's own Green's
   function in one dimension, -|i - j| h/2, is exact at its points. */
PETSC_EXTERN PetscErrorCode SmoothingConstants(const Kernel *kernel, PetscReal c[2]);

/* PlaneSymbols - dT[n], dN[n] and dX[n] (velocity along the normal of a tangential force, and the other way round) of
   a membrane at an angle (0 .. pi/4) to the grid for the wave numbers 2 pi q/L,
   q = 0 .. n/2 and mirrored, of n markers on the length L, at cell size h (1/(length^-2/time ...): velocity per force
   density). */
PETSC_EXTERN PetscErrorCode PlaneSymbols(const Kernel *kernel, PetscReal h, PetscReal a0, PetscReal nu, PetscReal angle,
                                         PetscInt n, PetscReal L, PetscReal dT[], PetscReal dN[], PetscReal dX[]);
