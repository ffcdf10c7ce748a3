/* Bending of membranes that stretch, where it is not the quadratic energy of bending.h. By the length at rest s, with

       a = X_s,   b = X_ss,   lambda = |a|,   theta = (a x b)/lambda^2,   the curvature times lambda,

   and kappa0 the curvature of the rest shape with a shape memory, else 0,

       E_B = c_b/2 INT (theta - kappa0 lambda^p)^2 lambda^-p ds,

       angle      p = 0   the angle by which a piece turns, as in a beam
       helfrich   p = 1   (kappa - kappa0)^2 of each piece of the stretched membrane

   The sum is over twice as many points as markers, since on the markers alone the products make waves. With

       J V = d(theta - kappa0 lambda^p),   the change that a motion V makes,

   the matrix of Gauss and Newton stands for the matrix K of bending.h in a step, to which the force adds

       grad E_B(X*) - N X* + (N - K) X,      N = c_b J^T lambda^-p J ds. */
#pragma once
#include "bodies/force.h"

/* MomentEnergy - E_B of one vesicle's markers X[2n] (length^4/time^2), and its gradient, added to G[2n] if not NULL.
   Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode MomentEnergy(Membrane membrane, PetscInt vesicle, const PetscScalar X[], PetscReal *energy,
                                         PetscScalar G[]);
