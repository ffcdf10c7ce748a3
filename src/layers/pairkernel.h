/* Green's functions of Stokes flow in the plane: the only place where their formulas in unbounded fluid stand, and what
   a kernel brings for lattice and walls. With r from the source to the response, and N the normal times the length that
   a source has of its curve,

       S_ij = [-delta_ij ln r + r_i r_j/r^2]/(4 pi)      Stokeslet, velocity per force, viscosity 1
       D_ij = (r.N) r_i r_j/(pi r^4)                     stresslet, velocity per jump of the velocity

   with the pressures, over the viscosity,

       r_j/(2 pi r^2),      [2 (r.N) r_j/r^4 - N_j/r^2]/pi.

   A pair has a matrix K of velocities: xx, yy, xy (x to a source along y), yx. A kernel is one file with one
   PairKernel: stokeslet.c, stresslet.c. Nothing here crosses ranks. */
#pragma once
#include "layers/imagetable.h"
#include "layers/layersetting.h"
#include "markers/dipoles.h"

typedef struct _p_LayerPairs *LayerPairs;
typedef struct _p_PairChunk PairChunk;

#define PAIR_PARTS IMAGE_MOST_PARTS /* most parts: two components of a velocity for each number of a source */
enum { NEAR_ONE, NEAR_TWO, NEAR_BOX, NEAR_KINDS }; /* markers of one body, of two, places of a box part */

/* In x, y and N four pairs; lengths in the unit whose logarithm is zero. Parts are what unit sources on the lattice
   give: of forces xx, yy, xy, yx; of dipoles u of xx, yy, xy, then v. */
typedef struct {
  const char *name;
  int sources;           /* numbers of a source on the lattice: 2 of a force, 3 of a tensor */
  int viscosity, length; /* powers of the viscosity and of a length in the velocity of a unit source of the lattice */
  PetscReal level;       /* what ln of the unit of lengths adds to xx and yy of a unit source, for viscosity 1 */
  PetscBool symmetric;   /* K of a pair is the transpose of K with its ends exchanged: half of it is stored */
  PetscReal reach[NEAR_KINDS];                                      /* cells up to which stencils are summed */
  void (*velocity)(Lanes x, Lanes y, const Lanes N[2], Lanes K[3]); /* xx, yy, xy = yx */
  void (*pressure)(Lanes x, Lanes y, const Lanes N[2], Lanes P[2]); /* over the viscosity */

  /* The parts of unit sources in unbounded fluid, x and y in lengths, and K of the parts. */
  void (*parts)(const LayerSetting *set, Lanes x, Lanes y, Lanes part[]);
  void (*contract)(const Lanes part[], const Lanes N[2], Lanes K[4]);

  /* A closed or open curve of n markers: what its quadrature adds to xx and yy of markers that are k apart, own[n], for
     viscosity 1 (NULL: nothing); D[3 n] = K of each marker with itself, own[0] included. */
  void (*logarithm)(CurveType type, PetscInt n, PetscReal own[]);
  PetscErrorCode (*diagonal)(const LayerSetting *set, const CurveKind *kind, Spectral spectral, PetscInt n,
                             const PetscReal X[], const PetscReal own[], PetscReal D[]);

  /* L, the lattice's parts of markers i and j by sums over stencils, `cells` added to their offset; C = K - L of four
     distant pairs, i with j .. j + 3, x and y in cells; back: from i to these. create, place: what these and the
     quadrature keep in the pairs; NULL: nothing. */
  PetscErrorCode (*create)(LayerPairs pairs);
  void (*place)(LayerPairs pairs);
  void (*sums)(LayerPairs pairs, PetscInt i, PetscInt j, const PetscInt cells[2], PetscReal L[]);
  void (*far)(LayerPairs pairs, PetscInt i, PetscInt j, PetscBool back, Lanes x, Lanes y, Lanes C[]);

  /* Some pairs of a block (pairchunk.h). */
  void (*fill)(LayerPairs pairs, PairChunk *chunk);

  /* Parts seen from a wall, in cells, of viscosity 1: x along it, a and b the distances of response and source from it.
     image_exact: of the exact fluid's image. image_far: that less the image by lattice and delta function; more: by how
     much the second moments across the wall of the stencils of response and source are above the kernel's, or NULL. */
  ImagePlaces places;
  void (*image_make)(const Kernel *kernel, ImageKernel *image);
  PetscErrorCode (*image_fill)(const OffsetTable *lattice, ImageTable *table);
  void (*image_exact)(const ImageKernel *image, Lanes x, Lanes a, Lanes b, Lanes part[]);
  void (*image_far)(const ImageKernel *image, Lanes x, Lanes a, Lanes b, const PetscReal more[2], Lanes part[]);
} PairKernel;

PETSC_EXTERN const PairKernel stokeslet, stresslet;

/* PairFree - K of four pairs in unbounded fluid: xx, yy, xy; x, y and N in lengths. Not collective. */
static inline void PairFree(const PairKernel *k, const LayerSetting *set, Lanes x, Lanes y, const Lanes N[2],
                            Lanes K[3]) {
  const PetscReal over = 1 / set->unit, scale = PetscPowRealInt(set->nu, k->viscosity);
  k->velocity(over * x, over * y, (const Lanes[2]){over * N[0], over * N[1]}, K);
  for (int q = 0; q < 3; q++) K[q] *= scale;
}

/* StokesletFour, StressletFour - the velocities of the two kernels, the latter zero at the source itself; StokesletOne
   - of one pair r apart (length), `more` added to xx and yy. Not collective. */
static inline void StokesletFour(Lanes x, Lanes y, const Lanes N[2], Lanes S[3]) {
  const Lanes r2 = x * x + y * y, logarithm = -0.5 * LanesLog(r2), over = (1 / (4 * PETSC_PI)) / r2;
  S[0] = logarithm / (4 * PETSC_PI) + x * x * over;
  S[1] = logarithm / (4 * PETSC_PI) + y * y * over;
  S[2] = x * y * over;
}
static inline void StokesletOne(const LayerSetting *set, const PetscReal r[2], PetscReal more, PetscReal S[3]) {
  Lanes four[3];
  PairFree(&stokeslet, set, r[0] + (Lanes){0}, r[1] + (Lanes){0}, (const Lanes[2]){{0}, {0}}, four);
  for (int q = 0; q < 3; q++) S[q] = four[q][0] + (q < 2 ? more / set->nu : 0);
}
static inline void StressletFour(Lanes x, Lanes y, const Lanes N[2], Lanes D[3]) {
  const Lanes r2 = x * x + y * y;
  const Lanes q = (x * N[0] + y * N[1]) / (PETSC_PI * (r2 * r2 + LanesWhere((LanesBits)(r2 == 0), 1 + (Lanes){0})));
  const Lanes qx = q * x;
  D[0] = qx * x;
  D[1] = q * y * y;
  D[2] = qx * y;
}
