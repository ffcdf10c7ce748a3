/* Pairs of markers in a single or double layer (pairkernel.h),

       C = K - L,

   K the kernel of unbounded fluid, L what the same source on one marker gives at another on the infinite lattice:
   spread and interpolated by the regularised delta functions, solved on the staggered grid. What walls add to either is
   in wallimage.h. Far from one another C has a closed form; near ones take L from sums over their stencils
   (stencilsums.h). In unbounded fluid there is no lattice: C = K.

   Create once, Place where the markers have been placed, then whatever asks for pairs (nearblock.h). Nothing crosses
   ranks. */
#pragma once
#include "layers/farform.h"
#include "layers/wallimage.h"

/* What the markers are sources with, where that is not the stencils of their velocities; all kept by the caller. */
typedef struct {
  const PaddedStencil *stencil;    /* [sources M] unfolded, counted from the marker's own place */
  const PetscReal *normal, *along; /* [2M] n w, [M] w (length), n outward and w the marker's share of the length */
  const PetscReal *length;         /* [bodies] SUM w */
} PairSources;

struct _p_LayerPairs {
  const PairKernel *kernel;
  const LayerSetting *set;    /* borrowed */
  const OffsetTable *lattice; /* of the kernel, borrowed; not read in unbounded fluid */
  WallImage image;            /* what walls add; NULL in unbounded fluid */
  PairSources from;           /* of forces all NULL */
  PetscReal **logarithm;      /* [bodies][n] of own bodies, by difference of the markers' numbers: what a curve's
                                 quadrature adds to xx and yy for viscosity 1; NULL: nothing */
  NearFar far;                /* of forces: the closed form of distant pairs, */
  PetscReal *fourth[2][2];    /* [M] and whole vectors: a component's fourth moments along x and y less the mean ones */
  PetscBool owner;            /* of the next two */
  PaddedStencil *stencil;     /* [2M] of u and v, unfolded, counted from the marker's own place */
  NearBounds *bounds;         /* [bodies] */
};

/* LayerPairsCreate - of a kernel with the lattice's tables, which the caller keeps; half: that of the half space in
   front of a wall, or NULL: it is made where there are walls. from: of kernels with normals, else NULL; velocities:
   pairs with the same setting whose stencils of velocities are used, or NULL. Collective. */
PETSC_EXTERN PetscErrorCode LayerPairsCreate(const PairKernel *kernel, const LayerSetting *set,
                                             const OffsetTable *lattice, const ImageTable *half,
                                             const PairSources *from, LayerPairs velocities, LayerPairs *pairs);
PETSC_EXTERN PetscErrorCode LayerPairsDestroy(LayerPairs *pairs);

/* LayerPairsPlace - where the markers have been placed (MarkersPlace). Not collective. */
PETSC_EXTERN PetscErrorCode LayerPairsPlace(LayerPairs pairs);

/* LayerPairLattice - L of markers i and j by parts (PairKernel), d = X_i - X_j (length) that of the image meant: by
   stencils up to `reach` cells, by the closed form beyond. Not collective. */
PETSC_EXTERN void LayerPairLattice(LayerPairs pairs, PetscReal reach, PetscInt i, PetscInt j, const PetscReal d[2],
                                   PetscReal L[]);

/* LayerSelf - the layer of one closed curve on itself in unbounded fluid by the kernel's quadrature: K[2n][2n] of the
   curve through the markers X[2n], entries interlaced x, y, a column after another; normal[2n]: n w (DoubleGeometry),
   NULL for forces. Of forces velocity per force times ds, symmetric. Not collective. */
PETSC_EXTERN PetscErrorCode LayerSelf(const PairKernel *kernel, const LayerSetting *set, Spectral spectral, PetscInt n,
                                      const PetscReal X[], const PetscReal normal[], PetscReal K[]);

/* DoubleGeometry - n w [2n] and w [n] of a curve's markers: the derivative by the label, turned. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleGeometry(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal normal[],
                                           PetscReal along[]);
