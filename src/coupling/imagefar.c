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

/* t from n is n from t the other way round: a and b are exchanged, and x turned. */
static void Exchange(const ImageForm *from, ImageForm *to) {
  static const int other[IMAGE_MONOMIALS] = {0, 2, 1, 3, 5, 4, 7, 6, 9, 8, 12, 11, 10};
  for (int m = 0; m < IMAGE_ORDERS; m++)
    for (int k = 0; k < image_monomials[m]; k++) to->c[m][k] = -from->c[m][other[k]];
}

/* Components along the wall have the moments along it that they have along themselves, and across it those across
   themselves; normal ones the other way round. */
void ImageKernelMake(const Kernel *kernel, ImageKernel *image) {
  const ImageMoments t = ImageMomentsOf(kernel->along), n = ImageMomentsOf(kernel->across);
  const ImageMoments along[IMAGE_PARTS] = {ImageMomentsBoth(t, t), ImageMomentsBoth(n, n), ImageMomentsBoth(n, t),
                                           ImageMomentsBoth(t, n)};
  const ImageMoments response[IMAGE_PARTS] = {n, t, t, n}, source[IMAGE_PARTS] = {n, t, n, t};
  *image = (ImageKernel){.moment = {t, n}};
  for (int part = 0; part < IMAGE_TN; part++) ImageFormAdd(-1, &lattice[part], over, &image->form[part]);
  Exchange(&image->form[IMAGE_NT], &image->form[IMAGE_TN]);
  for (int part = 0; part < IMAGE_PARTS; part++) {
    for (int end = 0; end < 2; end++) ImageFormBend(&image->form[part], end, image->bend[part][end]);
    ImageFormSmooth(along[part], response[part], source[part], &image->form[part]);
  }
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

/* Normal components have no other moments next to the wall. */
static void AddBends(const ImagePair *p, const ImageKernel *kernel, const PetscReal more[2],
                     PetscReal part[IMAGE_PARTS]) {
  static const PetscBool tangential[IMAGE_PARTS][2] = {
      [IMAGE_TT] = {PETSC_TRUE, PETSC_TRUE}, [IMAGE_NT] = {PETSC_FALSE, PETSC_TRUE}, [IMAGE_TN] = {PETSC_TRUE}};
  const ImageTerms t = ImageTermsMake(1, p->x + (Lanes){0}, p->a + (Lanes){0}, p->b + (Lanes){0});
  Lanes term[2][IMAGE_MONOMIALS];
  for (int sine = 0; sine < 2; sine++) ImageProducts(1, N0, sine, &t, term[sine]);
  for (int q = 0; q < IMAGE_PARTS; q++)
    for (int end = 0; end < 2; end++)
      if (tangential[q][end] && more[end] != 0)
        part[q] += more[end] * ImageSumOf(1, kernel->bend[q][end], term[q >= IMAGE_NT])[0];
}

void ImageFar(const ImagePair *p, const ImageKernel *kernel, PetscReal ma, PetscReal mb, PetscReal part[IMAGE_PARTS]) {
  const PetscReal across = kernel->moment[1].second, more[2] = {ma - across, mb - across};
  Lanes four[IMAGE_PARTS];
  Sums(p->x - (Lanes){0}, p->a - (Lanes){0}, p->b - (Lanes){0}, kernel->form, four);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = four[q][0];
  if (more[0] != 0 || more[1] != 0) AddBends(p, kernel, more, part);
}
