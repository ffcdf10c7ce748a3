/* Pairs of markers in the single layer,

       C = S - L,

   S the Stokeslet of unbounded fluid, L what a force on one marker gives at another on the infinite lattice: spread
   and interpolated by the regularised delta function, solved on the staggered grid. What walls add to either is in
   nearimage.h. Far from one another C has a closed form (farform.h); near ones take L from sums over their stencils
   (stencilsums.h). In unbounded fluid there is no lattice: C = S.

   Create once, Place where the markers have been placed, then whatever asks for pairs (nearblock.h). Nothing crosses
   ranks. */
#pragma once
#include "layers/layersetting.h"
#include "layers/farform.h"
#include "layers/nearimage.h"
#include "numerics/spectral.h"

typedef struct _p_SinglePairs *SinglePairs;
struct _p_SinglePairs {
  const LayerSetting *set;    /* borrowed */
  const OffsetTable *lattice; /* the lattice's Stokeslet (latticegreen.h), borrowed; not read in unbounded fluid */
  NearImage image;            /* what walls add; NULL in unbounded fluid */
  NearFar far[2];             /* closed forms of distant pairs: of one body, of two */
  PetscReal **logarithm;      /* [bodies][n] of own bodies, by difference of the markers' numbers: what the curve's
                                 quadrature has besides ln(r^2); others NULL */
  PaddedStencil *stencil;     /* [2M] of u and v, unfolded, counted from the marker's own place */
  PetscReal *fourth[2][2];    /* [M] and whole vectors: a component's fourth moments along x and y less the mean ones */
  NearBounds *bounds;         /* [bodies] */
};

/* SinglePairsCreate - with the lattice's tables, which the caller keeps: its Stokeslet, and that of the half space in
   front of a wall, NULL without walls. Collective. */
PETSC_EXTERN PetscErrorCode SinglePairsCreate(const LayerSetting *set, const OffsetTable *lattice,
                                              const ImageTable *half, SinglePairs *pairs);
PETSC_EXTERN PetscErrorCode SinglePairsDestroy(SinglePairs *pairs);

/* SinglePairsPlace - where the markers have been placed (MarkersPlace). Not collective. */
PETSC_EXTERN PetscErrorCode SinglePairsPlace(SinglePairs pairs);

/* SelfLayer - the single layer of one closed curve on itself in unbounded fluid,

       S = [-1/2 ln(r^2) + r r^T/r^2]/(4 pi nu),

   by Kress' quadrature (docs/nearfield.md, Pairs of markers): on n markers at the parameters t_k = 2 pi k/n the
   trapezoidal rule takes r r^T/r^2 and ln(r^2) - ln(4 sin^2(t/2)), which are smooth, and Kress' weights take
   ln(4 sin^2(t/2)). S[2n][2n] of the curve through the markers X[2n], entries interlaced x, y: velocity per force times
   ds, density 1 and the viscosity and unit of length of the setting. Symmetric. Not collective. */
PETSC_EXTERN PetscErrorCode SelfLayer(const LayerSetting *set, Spectral spectral, PetscInt n, const PetscReal X[],
                                      PetscReal S[]);
