/* The forms (imageform.h, n0 = -1) of the lattice's image are imagetable.c's modes expanded in theta: p is Blake's
   image, so what is left of C_image is minus the orders above it. */
#include "coupling/imagefar.h"

#define N0 (-1)

static const PetscReal over[IMAGE_ORDERS] = {1, 12, 1440};
static const ImageNumbers lattice[3] = {
    {{{-1, 1, 1, -2},
      {4, -10, -10, 18, 1, 1, -2, -2},
      {-373, 775, 775, -1414, -110, -110, 205, 205, 5, 5, -10, -20, -10}}},
    {{{-1, -1, -1, -2},
      {-2, 2, 2, 14, -1, -1, -2, -2},
      {107, -125, -125, -1114, 40, 40, 175, 175, -5, -5, -10, -20, -10}}},
    {{{0, -1, 1, 2}, {3, 9, -3, -16, -1, 1, 2, 2}, {-150, -690, 150, 1254, 105, -45, -195, -185, -5, 5, 10, 20, 10}}},
};

/* The forms for stencils of tangential components with these moments across the wall: normal ones there have those of
   their own direction. */
static void MakeForms(const ImageMoments kernel[2], ImageMoments ma, ImageMoments mb, ImageForm form[3]) {
  const ImageMoments t = kernel[0], n = kernel[1]; /* along the wall */
  for (int part = 0; part < 3; part++) {
    form[part] = (ImageForm){{{0}}};
    ImageFormAdd(-1, &lattice[part], over, &form[part]);
  }
  ImageFormSmooth(ImageMomentsBoth(t, t), ma, mb, &form[IMAGE_TT]);
  ImageFormSmooth(ImageMomentsBoth(n, n), kernel[0], kernel[0], &form[IMAGE_NN]);
  ImageFormSmooth(ImageMomentsBoth(n, t), kernel[0], mb, &form[IMAGE_NT]);
}

/* t from n is n from t the other way round: a and b are exchanged, and x turned. */
static void Exchange(const ImageForm *from, ImageForm *to) {
  static const int other[IMAGE_MONOMIALS] = {0, 2, 1, 3, 5, 4, 7, 6, 9, 8, 12, 11, 10};
  for (int m = 0; m < IMAGE_ORDERS; m++)
    for (int k = 0; k < image_monomials[m]; k++) to->c[m][k] = -from->c[m][other[k]];
}

void ImageKernelMake(const Kernel *kernel, ImageKernel *image) {
  image->moment[0] = ImageMomentsOf(kernel->along);
  image->moment[1] = ImageMomentsOf(kernel->across);
  MakeForms(image->moment, image->moment[1], image->moment[1], image->form);
  Exchange(&image->form[IMAGE_NT], &image->form[IMAGE_TN]);
}

/* An order's four parts, added where meant. */
static inline void AddOrder(const int order, const ImageForm form[IMAGE_PARTS], const ImageTerms *t, LanesBits meant,
                            Lanes part[IMAGE_PARTS]) {
  Lanes term[2][IMAGE_MONOMIALS];
  for (int sine = 0; sine < 2; sine++) ImageProducts(order, N0, sine, t, term[sine]);
  for (int q = 0; q < IMAGE_PARTS; q++)
    part[q] += LanesWhere(meant, ImageSumOf(order, form[q].c[order], term[q >= IMAGE_NT]));
}

static inline void Sums(Lanes x, Lanes a, Lanes b, const ImageForm form[IMAGE_PARTS], Lanes part[IMAGE_PARTS]) {
  const LanesBits close = ImageIsClose(x, a, b);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = (Lanes){0};
  if (close[0] | close[1] | close[2] | close[3]) {
    const ImageTerms t = ImageTermsMake(2, x, a, b);
    AddOrder(1, form, &t, ~(LanesBits){0}, part);
    AddOrder(2, form, &t, close, part);
  } else {
    const ImageTerms t = ImageTermsMake(1, x, a, b);
    AddOrder(1, form, &t, ~(LanesBits){0}, part);
  }
}

void ImageFarRow(PetscInt n, const PetscReal x[], const PetscReal a[], const PetscReal b[], const ImageKernel *kernel,
                 PetscReal *const part[IMAGE_PARTS]) {
  Lanes four[IMAGE_PARTS];
  for (PetscInt k = 0; k < n; k += LANES) {
    Sums(LanesAt(x + k), LanesAt(a + k), LanesAt(b + k), kernel->form, four);
    for (int q = 0; q < IMAGE_PARTS; q++) *(Lanes *)(part[q] + k) = four[q];
  }
}

void ImageFar(const ImagePair *p, const ImageKernel *kernel, PetscReal ma, PetscReal mb, PetscReal part[IMAGE_PARTS]) {
  const ImageMoments across = kernel->moment[1], a = {ma, across.fourth}, b = {mb, across.fourth};
  const PetscBool off = ma == across.second && mb == across.second ? PETSC_TRUE : PETSC_FALSE;
  ImageForm own[IMAGE_PARTS], back[3];
  Lanes four[IMAGE_PARTS];
  if (!off) {
    MakeForms(kernel->moment, a, b, own);
    MakeForms(kernel->moment, b, a, back);
    Exchange(&back[IMAGE_NT], &own[IMAGE_TN]);
  }
  Sums(p->x - (Lanes){0}, p->a - (Lanes){0}, p->b - (Lanes){0}, off ? kernel->form : own, four);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = four[q][0];
}
