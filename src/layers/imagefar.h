/* C_image of distant pairs of markers in closed form: what the image in a wall lacks of Blake's when it is made by
   lattice and regularised delta function. Its forms (imageform.h) are taken to the order h^6/R^6 of C_image up to
   IMAGE_THIRD cells, R the distance from the source's image, to h^4/R^4 up to IMAGE_SECOND, to h^2/R^2 beyond. Nothing
   crosses ranks. */
#pragma once
#include "layers/imageform.h"

/* Parts of a pair seen from a wall, response and source: tangential and normal to it. */
enum { IMAGE_TT, IMAGE_NN, IMAGE_NT, IMAGE_TN, IMAGE_PARTS };

/* A pair seen from a wall, in cells: x along the wall, response minus source; a, b the distances of response and
 * source. */
typedef struct {
  PetscReal x, a, b;
} ImagePair;

/* A kernel's moments along and across, the forms of pairs off the wall, and what the first order has of a response's
   and of a source's second moment across the wall. */
typedef struct {
  ImageMoments moment[2];
  ImageForms forms, bend[2];
} ImageKernel;

/* ImageKernelMake - of a kernel. Not collective. */
PETSC_EXTERN void ImageKernelMake(const Kernel *kernel, ImageKernel *image);

/* ImageFar - for viscosity 1; ma, mb: the second moments across the wall of the tangential stencils of response and
   source, continued oddly across it (kernel->moment[1].second off the wall), which count in the first order. Stencils
   are folded, not scaled. Not collective. */
PETSC_EXTERN void ImageFar(const ImagePair *pair, const ImageKernel *kernel, PetscReal ma, PetscReal mb,
                           PetscReal part[IMAGE_PARTS]);

/* ImageFarFour - C_image of four pairs off the wall, for viscosity 1. Not collective. */
PETSC_EXTERN void ImageFarFour(const ImageKernel *kernel, Lanes x, Lanes a, Lanes b, Lanes part[IMAGE_PARTS]);
