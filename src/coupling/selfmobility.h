/* Self-mobility (DESIGN section 8): the marker velocity that the kernel's smoothing takes away is given back,
       U = E u + Theta (f ds),   f ds = -(Dm^T sigma) - c_b ds D4 X_new,
   Theta symmetric and non-negative, a full block a vesicle:
       local:   Theta = (h c/(nu ds)) t t^T
       symbol:  Theta = F^T diag(circ dT, circ dN) F/ds, F the rotation into (tangent, normal) frames, dT and dN the
   mobility of tangential and normal force waves on a plane membrane in steady flow, exact minus gridded. */
#pragma once
#include "coupling/coupling.h"

typedef struct _p_SelfMobility *SelfMobility;

/* SelfMobilityCreate - of the given type (SELF_LOCAL, SELF_SYMBOL) for a coupling's membranes in a fluid of viscosity
 * nu. */
PETSC_EXTERN PetscErrorCode SelfMobilityCreate(Coupling coupling, PetscReal nu, SelfMobilityType type,
                                               SelfMobility *self);
PETSC_EXTERN PetscErrorCode SelfMobilityDestroy(SelfMobility *self);

/* SelfMobilitySetMarkers - Theta for the coupling's markers X[2M] and a0, and a Cholesky factor for
   R = (I + (c_b ds/a0) Theta D4)^-1. Every rank does the same. */
PETSC_EXTERN PetscErrorCode SelfMobilitySetMarkers(SelfMobility self, PetscReal a0, const PetscScalar X[]);

/* SelfMobilityApply - U := R (U - Theta (Dm^T sigma + c_b ds D4 Xhat)), U[2M]; sigma[M] and Xhat[2M] may be NULL. With
   sigma, U = E u becomes the solved part of the markers' velocity; with Xhat, U = u_inf becomes the part known before.
 */
PETSC_EXTERN PetscErrorCode SelfMobilityApply(SelfMobility self, const PetscScalar sigma[], const PetscScalar Xhat[],
                                              PetscScalar U[]);

/* SelfMobilityMultTheta - F := Theta F, F[2M]. */
PETSC_EXTERN PetscErrorCode SelfMobilityMultTheta(SelfMobility self, PetscScalar F[]);

/* SelfMobilityBlock - Theta of one vesicle of n markers, symmetric [2n][2n]; borrowed. */
PETSC_EXTERN const PetscReal *SelfMobilityBlock(SelfMobility self, PetscInt vesicle);

/* SmoothingConstant - c = 1/2 SUM SUM |i - j| w_i w_j, mean over sub-cell positions and the kernel's two 1-D weights:
   h c/nu is what long waves along the membrane lose. The integral in place of the sum, DESIGN's c1, is too large by
   about SUM w_i^2/12: the grid's own Green's function in one dimension, -|i - j| h/2, is exact at its points. */
PETSC_EXTERN PetscErrorCode SmoothingConstant(const Kernel *kernel, PetscReal *c);

/* PlaneSymbols - dT[n], dN[n] for the wave numbers 2 pi q/L, q = 0 .. n/2 and mirrored, of n markers on the length L,
   at cell size h (1/(length^-2/time ...): velocity per force density). */
PETSC_EXTERN PetscErrorCode PlaneSymbols(const Kernel *kernel, PetscReal h, PetscReal a0, PetscReal nu, PetscInt n,
                                         PetscReal L, PetscReal dT[], PetscReal dN[]);
