/* The forms (imageform.h, n0 = -1) of the lattice's image are imagetable.c's modes expanded in theta: p is Blake's
   image, so what is left of C_image is minus the orders above it. */
#include "layers/imagefar.h"

static const PetscReal over[IMAGE_ORDERS] = {1, 12, 1440, 362880};
static const ImageNumbers lattice[3] = {
    {{{-1, 1, 1, -2},
      {4, -10, -10, 18, 1, 1, -2, -2},
      {-373, 775, 775, -1414, -110, -110, 205, 205, 5, 5, -10, -20, -10},
      {63138, -122070, -122070, 218118, 19401, 19401, -35421, -35421, -1295, -1295, 2450, 4830, 2450, 35, 35, -70, -210,
       -210, -70}}},
    {{{-1, -1, -1, -2},
      {-2, 2, 2, 14, -1, -1, -2, -2},
      {107, -125, -125, -1114, 40, 40, 175, 175, -5, -5, -10, -20, -10},
      {-12084, 11868, 11868, 171174, -4071, -4071, -29751, -29751, 595, 595, 2170, 4410, 2170, -35, -35, -70, -210,
       -210, -70}}},
    {{{0, -1, 1, 2},
      {3, 9, -3, -16, -1, 1, 2, 2},
      {-150, -690, 150, 1254, 105, -45, -195, -185, -5, 5, 10, 20, 10},
      {14931, 108171, -13797, -193176, -18351, 4491, 33426, 31536, 1260, -630, -2380, -4620, -2240, -35, 35, 70, 210,
       210, 70}}},
};

/* t from n is n from t the other way round: a and b are exchanged, and x turned. */
static void Exchange(const ImageForm *from, ImageForm *to) {
  static const int mirror[IMAGE_MONOMIALS] = {0, 2, 1, 3, 5, 4, 7, 6, 9, 8, 12, 11, 10, 14, 13, 18, 17, 16, 15};
  for (int m = 0; m < IMAGE_ORDERS; m++)
    for (int k = 0; k < image_monomials[m]; k++) to->c[m][k] = -from->c[m][mirror[k]];
}

/* Components along the wall have the moments along it that they have along themselves, and across it those across
   themselves; normal ones the other way round, and these have no other moments next to the wall. */
void ImageKernelMake(const Kernel *kernel, ImageKernel *image) {
  static const PetscBool tangential[2][IMAGE_PARTS] = {{[IMAGE_TT] = PETSC_TRUE, [IMAGE_TN] = PETSC_TRUE},
                                                       {[IMAGE_TT] = PETSC_TRUE, [IMAGE_NT] = PETSC_TRUE}};
  const ImageMoments t = ImageMomentsOf(kernel->along), n = ImageMomentsOf(kernel->across);
  ImageForm form[IMAGE_PARTS] = {{{{0}}}};
  *image = (ImageKernel){.moment = {t, n}};
  for (int part = 0; part < IMAGE_TN; part++) ImageFormAdd(1, &lattice[part], over, &form[part]);
  Exchange(&form[IMAGE_NT], &form[IMAGE_TN]);
  for (int part = 0; part < IMAGE_PARTS; part++) {
    const PetscBool to = tangential[0][part], from = tangential[1][part];
    for (int end = 0; end < 2; end++) {
      const ImageForm bend = ImageFormBend(&form[part], end);
      if (tangential[end][part]) ImageFormsPut(&bend, part, &image->bend[end]);
    }
    ImageFormSmooth(ImageMomentsBoth(to ? t : n, from ? t : n), to ? n : t, from ? n : t, &form[part]);
    ImageFormsPut(&form[part], part, &image->forms);
  }
}

static const ImageKind force = {-1, IMAGE_PARTS, {[IMAGE_NT] = 1, [IMAGE_TN] = 1}};

void ImageFarFour(const ImageKernel *kernel, Lanes x, Lanes a, Lanes b, Lanes part[IMAGE_PARTS]) {
  ImageTerms t;
  ImageFarSums(force, &kernel->forms, (const Lanes[]){x, a, b}, &t, part);
}

void ImageFar(const ImagePair *p, const ImageKernel *kernel, PetscReal ma, PetscReal mb, PetscReal part[IMAGE_PARTS]) {
  const PetscReal across = kernel->moment[1].second, more[2] = {ma - across, mb - across};
  const Lanes x = p->x - (Lanes){0}, a = p->a - (Lanes){0}, b = p->b - (Lanes){0};
  ImageTerms t;
  Lanes four[IMAGE_PARTS];
  ImageFarSums(force, &kernel->forms, (const Lanes[]){x, a, b}, &t, four);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = four[q][0];
  for (int end = 0; end < 2; end++) {
    if (more[end] == 0) continue;
    ImageSums(1, force, &kernel->bend[end], &t, four);
    for (int q = 0; q < IMAGE_PARTS; q++) part[q] += more[end] * four[q][0];
  }
}
