/* The constants of recurrences across the rows of the grid, one pair of them for each mode of a transform along the
   rows:

       y1_j = b_j + r1 y1_{j-1},   y2_j = y1_j + r2 y2_{j-1}   upwards,
       z1_j = y2_j + r1 z1_{j+1},  z2_j = z1_j + r2 z2_{j+1}   downwards.

   The state is a pair, Y = (y1, y2) or Z = (z1, z2), and without right-hand side Y_j = M Y_{j-1}, Z_j = M Z_{j+1}, M =
   [r1 0; r1 r2]. With r2 = 0 both numbers are the same, and the recurrences are of first order.

   Slabs of rows, walls and the seam of a period close the recurrences by 2 x 2 matrices. Every rank has all of them. */
#pragma once
#include "fluid/grid/grid.h"

#define MODE_BLOCK 8 /* modes that are worked on together: a line of the cache */

/* A 2 x 2 matrix for each mode, [4][width]: its entries 11, 12, 21, 22. */
typedef PetscReal *PairMatrix;

typedef struct {
  PetscReal a[2][2];
} ModePair;

/* power[0] and gain[0] are for a slab of full height, power[1] and gain[1] for the last rank's slab. */
typedef struct _p_ModeFactors *ModeFactors;
struct _p_ModeFactors {
  Grid grid; /* borrowed */
  Field field;
  PetscInt modes, width;    /* modes of a row's transform; that number rounded up to whole blocks */
  const PetscReal *lambda;  /* [modes] borrowed, minus the second difference's eigenvalues times h^2 */
  const PetscReal *scale;   /* [modes] borrowed, of the transform */
  PetscReal *r[2], *factor; /* [width] decays; solution over z2 */
  PairMatrix power[2];      /* M^m */
  PairMatrix gain[2];       /* from Y below a slab without right-hand side to Z in its first row */
  PairMatrix bottom, top;   /* what closes the recurrences at walls or at the seam */
  PetscInt *reach;          /* [blocks] rows after which what comes in from outside is negligible in a block's modes */
};

/* ModeFactorsCreate - for a field of the grid and modes with eigenvalues lambda[modes]/h^2, whose solutions are
   multiplied by scale[modes]; both arrays are borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode ModeFactorsCreate(Grid grid, Field field, PetscInt modes, const PetscReal lambda[],
                                              const PetscReal scale[], ModeFactors *factors);
PETSC_EXTERN PetscErrorCode ModeFactorsDestroy(ModeFactors *factors);

/* ModeFactorsSet - mode k has the decays r1 = e^-theta[0] and r2 = e^-theta[1] and this factor. With walls in y, Y
   below the first row is bottom Z in it, and Z above the last row is top Y in it. Not collective. */
PETSC_EXTERN void ModeFactorsSet(ModeFactors factors, PetscInt k, const PetscReal theta[2], PetscReal factor,
                                 ModePair bottom, ModePair top);

/* ModeFactorsReach - set reach: rows, at least one, at most `most`, in which r1^j is greater than e^-negligible for one
   of a block's modes. Not collective. */
PETSC_EXTERN void ModeFactorsReach(ModeFactors factors, PetscReal negligible, PetscInt most);

/* ModeTheta - e^-theta is the decay of a - d_xx - d_yy in a mode, of which `lambda` is lambda + a h^2. Not collective.
 */
static inline PetscReal ModeTheta(PetscReal lambda) {
  return 2 * asinh(0.5 * PetscSqrtReal(lambda));
}
