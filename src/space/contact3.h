/* Contact of near surfaces: between areas dA and dA' at a distance r the energy

       psi(r) dA dA',     psi = s(r)/(2 pi r),

   with which parallel planes at a distance z push one another with the stress s(z), as membranes of the plane do:

       s = K (1 - z/D) below the range D,     s = -30 (W/B) x^2 (1 - x)^2,  x = (z - D)/B,  from D to D + B.

   Planes that adhere have the energy -W an area. Forces are the gradient of the sum over pairs of points on one of the
   grids of a NearPair, so that the two surfaces' forces are opposite. A step takes the stiffness psi'' along r of
   repulsion with it. */
#pragma once
#include "space/nearlayer.h"

typedef struct {
  PetscReal stress, range;  /* K (length^2/time^2), 0: no contact; D (length) */
  PetscReal adhesion, band; /* W (length^3/time^2), 0: none; B (length) */
} Contact3Law;

typedef struct {
  const NearLevel *level; /* borrowed; NULL: no pair of points is in range */
  PetscInt entries;
  NearEntry *entry; /* a: psi'/r, b: psi''/r^2, times both areas */
  PetscReal energy;
} Contact3;

/* Contact3Create - of a pair of surfaces with these coefficients of dA/domega, J1[count] and J2[count].
   Contact3Add - G[side][3][count] += what a change of the surfaces, change[side][3][count], adds to the gradient of the
   energy by the coefficients, and where asked for the gradient. G[side] NULL: not wanted. Not collective. Errors:
   memory. */
PETSC_EXTERN PetscErrorCode Contact3Create(const Contact3Law *law, NearPair pair, const PetscReal J1[],
                                           const PetscReal J2[], Contact3 *contact);
PETSC_EXTERN PetscErrorCode Contact3Destroy(Contact3 *contact);
PETSC_EXTERN PetscErrorCode Contact3Add(const Contact3 *contact, PetscInt count, PetscBool gradient,
                                        const PetscReal *const change[2], PetscReal *const G[2]);
