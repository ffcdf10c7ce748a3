/* C_image of distant pairs of markers in closed form (nearimage.h): to the order h^4/R^4 of itself up to IMAGE_SECOND
   cells, R from the source's image, to h^2/R^2 beyond. */
#pragma once
#include "coupling/imageform.h"

/* Parts of a pair seen from a wall, response and source: tangential and normal to it. */
enum { IMAGE_TT, IMAGE_NN, IMAGE_NT, IMAGE_TN, IMAGE_PARTS };

/* A pair seen from a wall, in cells: x along the wall, response minus source; a, b the distances of response and
 * source. */
typedef struct {
  PetscReal x, a, b;
} ImagePair;

/* A kernel's moments along and across, the forms of pairs off the wall, and what the first order has of a response's
   and a source's second moment across the wall. */
typedef struct {
  ImageMoments moment[2];
  ImageForm form[IMAGE_PARTS];
  PetscReal bend[IMAGE_PARTS][2][IMAGE_MONOMIALS];
} ImageKernel;

/* ImageKernelMake - of a kernel. Not collective. */
PETSC_EXTERN void ImageKernelMake(const Kernel *kernel, ImageKernel *image);

/* ImageFar - for viscosity 1; ma, mb: the second moments across the wall of the tangential stencils of response and
   source, continued oddly across it (kernel->moment[1].second off the wall), which count in the first order. Stencils
   are folded, not scaled. Not collective. */
PETSC_EXTERN void ImageFar(const ImagePair *pair, const ImageKernel *kernel, PetscReal ma, PetscReal mb,
                           PetscReal part[IMAGE_PARTS]);

/* ImageFarRow - the same of n pairs off the wall: part[IMAGE_PARTS][n] of x, a and b [n], all with room for whole
   vectors behind n. Not collective. */
PETSC_EXTERN void ImageFarRow(PetscInt n, const PetscReal x[], const PetscReal a[], const PetscReal b[],
                              const ImageKernel *kernel, PetscReal *const part[IMAGE_PARTS]);
