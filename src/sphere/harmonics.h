/* Real spherical harmonics Y_k of degree l <= p, orthonormal on the unit sphere, k = l^2 + l + m, -l <= m <= l:

       Y_k(theta, phi) = P_l|m|(cos theta) times  1 (m = 0),  sqrt(2) cos(m phi) (m > 0),  sqrt(2) sin(|m| phi) (m < 0),

   P the normalised associated Legendre functions, by their recurrence in l. A function on the sphere is the sum of its
   coefficients times Y_k. Tables have a column of numbers, one a point, for each k. */
#pragma once
#include "base/base.h"

/* HarmonicsCount - how many there are of degree p at most. Not collective. */
static inline PetscInt HarmonicsCount(PetscInt p) {
  return (p + 1) * (p + 1);
}

/* HarmonicsDegree - l of Y_k. Not collective. */
PETSC_EXTERN PetscInt HarmonicsDegree(PetscInt k);

/* Values and derivatives: Y, Y_theta, Y_phi, Y_theta_theta, Y_theta_phi, Y_phi_phi. */
enum { HARMONIC, HARMONIC_T, HARMONIC_P, HARMONIC_TT, HARMONIC_TP, HARMONIC_PP, HARMONIC_PARTS };

/* HarmonicsAt - table[part][count][n] at n points, of the first `parts` parts and the orders |m| <= most; other numbers
   stay as they are. Where parts have derivatives, no point may be a pole. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode HarmonicsAt(PetscInt p, PetscInt most, PetscInt n, const PetscReal theta[],
                                        const PetscReal phi[], PetscInt parts, PetscReal table[]);

/* HarmonicsRevolvedAt - what fields of bodies of revolution are made of: table[part][3p + 1][n], Y_(l, 0), l = 0 .. p,
   then Y_(l, 1)/sqrt(2) and Y_(l, -1)/sqrt(2), l = 1 .. p. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode HarmonicsRevolvedAt(PetscInt p, PetscInt n, const PetscReal theta[], const PetscReal phi[],
                                                PetscInt parts, PetscReal table[]);

/* HarmonicsTurn - coefficients of f(theta, phi + angle) from those of f, or (back) the transpose of this map, which is
   its inverse. x and y differ. Not collective. */
PETSC_EXTERN void HarmonicsTurn(PetscInt p, PetscReal angle, PetscBool back, const PetscReal x[], PetscReal y[]);
