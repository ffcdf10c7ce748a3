/* What the functions of pairs of markers, of curves and of images in walls need of a run, and the two fundamental
   solutions of Stokes flow in the plane from which all of them start. With r from the source to the response,

       S_ij = [-delta_ij ln(r/unit) + r_i r_j/r^2]/(4 pi nu)      Stokeslet: velocity per force
       D_ij = (r.n) r_i r_j/(pi r^4)                              stresslet: velocity per (velocity jump times length)

   Nothing here crosses ranks: every rank has the markers of all. */
#pragma once
#include "base/lanes.h"
#include "bodies/bodies.h"
#include "layers/boxaxis.h"
#include "markers/dipoles.h"
#include "markers/markers.h"

typedef struct {
  Markers markers;    /* with their grid and their regularised delta function, borrowed */
  Bodies bodies;      /* the curves on which the markers are, borrowed; NULL: single points */
  PetscReal nu;       /* viscosity (length^2/time, density 1) */
  PetscReal unit;     /* length whose logarithm is zero */
  const BoxAxis *box; /* [2] with a box part: pairs are of nearest images and fade over a period (BoxImage); or NULL */
} LayerSetting;

/* StokesletFour - of four pairs: xx, yy, xy. StokesletOne - of one pair r apart, `more` being added to ln(r^2): what a
   curve's quadrature has besides. Not collective. */
static inline void StokesletFour(const LayerSetting *set, Lanes x, Lanes y, Lanes S[3]) {
  const PetscReal factor = 1 / (4 * PETSC_PI * set->nu), over2 = 1 / PetscSqr(set->unit);
  const Lanes r2 = x * x + y * y, logarithm = -0.5 * LanesLog(over2 * r2);
  S[0] = factor * (logarithm + x * x / r2);
  S[1] = factor * (logarithm + y * y / r2);
  S[2] = factor * x * y / r2;
}
static inline void StokesletOne(const LayerSetting *set, const PetscReal r[2], PetscReal more, PetscReal S[3]) {
  Lanes four[3];
  StokesletFour(set, r[0] + (Lanes){0}, r[1] + (Lanes){0}, four);
  for (int q = 0; q < 3; q++) S[q] = four[q][0] - (q < 2 ? more / (8 * PETSC_PI * set->nu) : 0);
}

/* StressletFour - of four pairs with a source of normal times length N: xx, yy, xy; zero at the source itself. Not
   collective. */
static inline void StressletFour(Lanes x, Lanes y, const PetscReal N[2], Lanes D[3]) {
  const Lanes r2 = x * x + y * y;
  const Lanes q = (x * N[0] + y * N[1]) / (PETSC_PI * (r2 * r2 + LanesWhere((LanesBits)(r2 == 0), 1 + (Lanes){0})));
  const Lanes qx = q * x;
  D[0] = qx * x;
  D[1] = q * y * y;
  D[2] = qx * y;
}
