/* C_image of distant pairs of markers in closed form (nearimage.h), to the order h^2/R^2, R from the source's image. */
#pragma once
#include "base/base.h"

/* Parts of a pair seen from a wall, response and source: tangential and normal to it. */
enum { IMAGE_TT, IMAGE_NN, IMAGE_NT, IMAGE_TN, IMAGE_PARTS };

/* A pair seen from a wall, in cells: x along the wall, response minus source; a, b the distances of response and
 * source. */
typedef struct {
  PetscReal x, a, b;
} ImagePair;

/* ImageFar - for viscosity 1 and a kernel of second moments kernel[2] along and across; ma, mb: the moments across the
   wall of the tangential stencils of response and source, continued oddly across it (kernel[1] off the wall). Stencils
   are folded, not scaled. Not collective. */
PETSC_EXTERN void ImageFar(const ImagePair *pair, const PetscReal kernel[2], PetscReal ma, PetscReal mb,
                           PetscReal part[IMAGE_PARTS]);
