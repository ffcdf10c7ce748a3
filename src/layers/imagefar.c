/* The forms (imageform.h, n0 = -1) of the lattice's image are imagetable.c's modes expanded in theta: p is Blake's
   image, so what is left of C_image is minus the orders above it. */
#include "layers/imagefar.h"

#define N0 (-1)

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

/* Monomials by which forms are even and odd, by order, their powers, and every monomial's mirror image. */
static const int evens[IMAGE_ORDERS] = {3, 5, 8, IMAGE_EVEN}, odds[IMAGE_ORDERS] = {1, 3, 5, IMAGE_ODD};
static const int even[IMAGE_EVEN] = {0, 1, 3, 4, 6, 8, 10, 11, 13, 15, 16},
                 odd[IMAGE_ODD] = {1, 4, 6, 8, 10, 13, 15, 16};
static const int even_degree[IMAGE_EVEN] = {0, 1, 2, 2, 3, 3, 4, 4, 4, 5, 5},
                 odd_degree[IMAGE_ODD] = {1, 2, 3, 3, 4, 4, 5, 5};
static const int mirror[IMAGE_MONOMIALS] = {0, 2, 1, 3, 5, 4, 7, 6, 9, 8, 12, 11, 10, 14, 13, 18, 17, 16, 15};

/* t from n is n from t the other way round: a and b are exchanged, and x turned. */
static void Exchange(const ImageForm *from, ImageForm *to) {
  for (int m = 0; m < IMAGE_ORDERS; m++)
    for (int k = 0; k < image_monomials[m]; k++) to->c[m][k] = -from->c[m][mirror[k]];
}

/* The even and the odd part of an order. */
static void Split(int order, const PetscReal c[], Lanes e[IMAGE_EVEN], Lanes o[IMAGE_ODD]) {
  for (int k = 0; k < evens[order]; k++) e[k] = 0.5 * (c[even[k]] + c[mirror[even[k]]]) + (Lanes){0};
  for (int k = 0; k < odds[order] && o; k++) o[k] = 0.5 * (c[odd[k]] - c[mirror[odd[k]]]) + (Lanes){0};
}

/* Components along the wall have the moments along it that they have along themselves, and across it those across
   themselves; normal ones the other way round. */
void ImageKernelMake(const Kernel *kernel, ImageKernel *image) {
  const ImageMoments t = ImageMomentsOf(kernel->along), n = ImageMomentsOf(kernel->across);
  const ImageMoments along[IMAGE_TN] = {ImageMomentsBoth(t, t), ImageMomentsBoth(n, n), ImageMomentsBoth(n, t)};
  const ImageMoments response[IMAGE_TN] = {n, t, t}, source[IMAGE_TN] = {n, t, n};
  ImageForm form[IMAGE_PARTS] = {{{{0}}}};
  *image = (ImageKernel){.moment = {t, n}};
  for (int part = 0; part < IMAGE_TN; part++) ImageFormAdd(-1, &lattice[part], over, &form[part]);
  Exchange(&form[IMAGE_NT], &form[IMAGE_TN]);
  for (int part = 0; part < IMAGE_PARTS; part++)
    for (int end = 0; end < 2; end++) ImageFormBend(&form[part], end, image->bend[part][end]);
  for (int part = 0; part < IMAGE_TN; part++) {
    ImageFormSmooth(along[part], response[part], source[part], &form[part]);
    for (int m = 0; m < IMAGE_ORDERS; m++)
      Split(m, form[part].c[m], image->even[part][m], part == IMAGE_NT ? image->odd[m] : NULL);
  }
}

/* Of four pairs: monomials plus and less their mirror images. */
typedef struct {
  Lanes even[IMAGE_EVEN], odd[IMAGE_ODD];
} Monomials;

static inline Monomials MonomialsMake(Lanes a, Lanes b) {
  const Lanes s = a + b, d = a - b, ab = a * b, aa = a * a, bb = b * b, squares = aa + bb, cubes = s * (squares - ab),
              less = d * (squares + ab);
  return (Monomials){{1 + (Lanes){0}, s, ab, squares, ab * s, cubes, ab * squares, ab * ab, aa * aa + bb * bb,
                      ab * cubes, ab * ab * s},
                     {d, d * s, ab * d, less, ab * d * s, squares * d * s, ab * less, ab * ab * d}};
}

/* An order's parts (of NT and TN the even and the odd part), added where meant. */
static inline void AddOrder(const int order, const ImageKernel *kernel, const Monomials *p, const ImagePowers *t,
                            LanesBits meant, Lanes part[IMAGE_PARTS]) {
  Lanes sum[IMAGE_PARTS] = {{0}};
  for (int k = 0; k < evens[order]; k++) {
    const Lanes *power = t->power[N0 + 2 * order + even_degree[k]], cosine = p->even[k] * power[0];
    sum[IMAGE_TT] += kernel->even[IMAGE_TT][order][k] * cosine;
    sum[IMAGE_NN] += kernel->even[IMAGE_NN][order][k] * cosine;
    sum[IMAGE_NT] += kernel->even[IMAGE_NT][order][k] * (p->even[k] * power[1]);
  }
  for (int k = 0; k < odds[order]; k++)
    sum[IMAGE_TN] += kernel->odd[order][k] * (p->odd[k] * t->power[N0 + 2 * order + odd_degree[k]][1]);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] += LanesWhere(meant, sum[q]);
}

/* The orders from the first to this one, which all four pairs or those within its cells have. */
static inline void AddOrders(const int last, Lanes x, Lanes a, Lanes b, const ImageKernel *kernel,
                             Lanes part[IMAGE_PARTS]) {
  const ImagePowers t = ImagePowersMake(last, x, a + b);
  const Monomials p = MonomialsMake(a, b);
  AddOrder(1, kernel, &p, &t, ~(LanesBits){0}, part);
  if (last >= 2) AddOrder(2, kernel, &p, &t, ImageWithin(IMAGE_SECOND, x, a, b), part);
  if (last >= 3) AddOrder(3, kernel, &p, &t, ImageWithin(IMAGE_THIRD, x, a, b), part);
}

void ImageFarFour(const ImageKernel *kernel, Lanes x, Lanes a, Lanes b, Lanes part[IMAGE_PARTS]) {
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = (Lanes){0};
  if (LanesAny(ImageWithin(IMAGE_THIRD, x, a, b)))
    AddOrders(3, x, a, b, kernel, part);
  else if (LanesAny(ImageWithin(IMAGE_SECOND, x, a, b)))
    AddOrders(2, x, a, b, kernel, part);
  else
    AddOrders(1, x, a, b, kernel, part);
  const Lanes same = part[IMAGE_NT], turned = part[IMAGE_TN];
  part[IMAGE_NT] = turned + same;
  part[IMAGE_TN] = turned - same;
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
  ImageFarFour(kernel, p->x - (Lanes){0}, p->a - (Lanes){0}, p->b - (Lanes){0}, four);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = four[q][0];
  if (more[0] != 0 || more[1] != 0) AddBends(p, kernel, more, part);
}
