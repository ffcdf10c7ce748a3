/* Distant images in a wall in closed form. In mode theta along the wall the image that a lattice makes is

       e^{-theta(a+b)} theta^n0/4 [p + theta^2 p_1 + theta^4 p_2 + theta^6 p_3],

   each p_m a polynomial in theta a and theta b, a and b the distances of response and source from the wall (h = 1). The
   integral over theta of a monomial c a^i b^j of p_m is

       c a^i b^j n!/z^{n+1}/(4 pi),   n = n0 + 2 m + i + j,   z = a + b - i x,

   the real part where the wave along the wall is a cosine, the imaginary part where it is a sine. Nothing crosses
   ranks. */
#pragma once
#include "base/lanes.h"
#include "kernel/kernel.h"

/* Monomials 1, a, b, ab, aa, bb, aab, abb, aaa, bbb, aaab, aabb, abbb, aaaa, bbbb, aaaab, aaabb, aabbb, abbbb; p has
   the first 4, p_1 the first 8, p_2 the first 13. */
#define IMAGE_MONOMIALS 19
#define IMAGE_ORDERS 4
#define IMAGE_POWERS 12
static const int image_monomials[IMAGE_ORDERS] = {4, 8, 13, IMAGE_MONOMIALS};
static const int image_degree[IMAGE_MONOMIALS] = {0, 1, 1, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4, 5, 5, 5, 5};

#define IMAGE_SECOND 48 /* cells from a marker to another one's image, up to which theta^4 counts, */
#define IMAGE_THIRD 24  /* and theta^6 */

typedef struct {
  PetscReal c[IMAGE_ORDERS][IMAGE_MONOMIALS];
} ImageForm;

/* A form's numbers as whole multiples of 1/over[order]. */
typedef struct {
  int c[IMAGE_ORDERS][IMAGE_MONOMIALS];
} ImageNumbers;

/* A kernel's even moments, means over a cell. */
typedef struct {
  PetscReal second, fourth, sixth;
} ImageMoments;

/* The forms of all parts of a kind of source: the exact fluid's image, then what is left of it when the lattice makes
   the image, minus the orders above. */
#define IMAGE_MOST_PARTS 6
typedef struct {
  Lanes c[IMAGE_ORDERS][IMAGE_MOST_PARTS][IMAGE_MONOMIALS]; /* each number four times */
} ImageForms;

/* A kernel's moments along and across, the forms of pairs off the wall, and what the first order has of a response's
   and of a source's second moment across the wall. */
typedef struct {
  ImageMoments moment[2];
  ImageForms forms, bend[2];
} ImageKernel;

/* ImageMomentsOf - of weights. ImageMomentsBoth - of one kernel after the other. ImageFormAdd - to += alpha times the
   form of these numbers. ImageFormSmooth - the form through kernels of these moments: along the wall those of both ends
   together, across it of the response and of the source. ImageFormBend - what a second moment of 1 of the response (end
   0) or of the source (1) across the wall adds to the first order. ImageFormsPut - a form as one of the parts. Not
   collective. */
PETSC_EXTERN ImageMoments ImageMomentsOf(KernelWeights weights);
PETSC_EXTERN ImageMoments ImageMomentsBoth(ImageMoments one, ImageMoments other);
PETSC_EXTERN void ImageFormAdd(PetscReal alpha, const ImageNumbers *number, const PetscReal over[IMAGE_ORDERS],
                               ImageForm *to);
PETSC_EXTERN void ImageFormSmooth(ImageMoments along, ImageMoments response, ImageMoments source, ImageForm *form);
PETSC_EXTERN ImageForm ImageFormBend(const ImageForm *form, int end);
PETSC_EXTERN void ImageFormsPut(const ImageForm *form, int part, ImageForms *forms);

/* A kind of source: n0, and whether each part's wave along the wall is a sine. */
typedef struct {
  int n0, parts, sine[IMAGE_MOST_PARTS];
} ImageKind;

/* Of four pairs: all monomials, and n!/z^{n+1}/(4 pi), its real and its imaginary part. */
typedef struct {
  Lanes monomial[IMAGE_MONOMIALS], power[IMAGE_POWERS][2];
} ImageTerms;

/* Orders and kinds are constants where these functions are called. */
#define IMAGE_INLINE __attribute__((always_inline)) static inline

/* ImageTermsMake - for orders up to this one. ImageWithin - which pairs are within that many cells. ImageSums - an
   order's sums of all parts. ImageAddOrder - of an order, added where meant. ImageOrders - of the first
   order to the last one, x, a and b being at[3]. ImageFarSums - of all orders that count, with their terms. Not
   collective. */
IMAGE_INLINE void ImageTermsMake(const int order, Lanes x, Lanes a, Lanes b, ImageTerms *t) {
  const Lanes ab = a * b, aa = a * a, bb = b * b;
  const Lanes monomial[IMAGE_MONOMIALS] = {
      1 + (Lanes){0}, a,       b,       ab,      aa,      bb,          a * ab,      ab * b,      aa * a,     bb * b,
      aa * ab,        ab * ab, ab * bb, aa * aa, bb * bb, aa * aa * b, aa * ab * b, ab * bb * a, ab * bb * b};
  const Lanes H = a + b, over = 1 / (H * H + x * x), u = H * over, v = x * over;
  Lanes w[2] = {u / (4 * PETSC_PI), v / (4 * PETSC_PI)};
  for (int k = 0; k < image_monomials[order]; k++) t->monomial[k] = monomial[k];
  for (int n = 0; n < 3 * (order + 1); n++) {
    t->power[n][0] = w[0];
    t->power[n][1] = w[1];
    const Lanes next = (n + 1) * (w[0] * u - w[1] * v);
    w[1] = (n + 1) * (w[0] * v + w[1] * u);
    w[0] = next;
  }
}
static inline LanesBits ImageWithin(const int cells, Lanes x, Lanes a, Lanes b) {
  return (LanesBits)(x * x + (a + b) * (a + b) < cells * cells);
}
IMAGE_INLINE void ImageSums(const int order, const ImageKind kind, const ImageForms *f, const ImageTerms *t,
                            Lanes sum[]) {
  Lanes own[IMAGE_MOST_PARTS] = {{0}};
  for (int k = 0; k < image_monomials[order]; k++) {
    const Lanes *power = t->power[kind.n0 + 2 * order + image_degree[k]];
    const Lanes wave[2] = {t->monomial[k] * power[0], t->monomial[k] * power[1]};
    for (int part = 0; part < kind.parts; part++) own[part] += f->c[order][part][k] * wave[kind.sine[part]];
  }
  for (int part = 0; part < kind.parts; part++) sum[part] = own[part];
}
IMAGE_INLINE void ImageAddOrder(const int order, const ImageKind kind, LanesBits near, const ImageForms *f,
                                const ImageTerms *t, Lanes sum[]) {
  Lanes more[IMAGE_MOST_PARTS];
  ImageSums(order, kind, f, t, more);
  for (int part = 0; part < kind.parts; part++) sum[part] += LanesWhere(near, more[part]);
}
IMAGE_INLINE void ImageOrders(const int last, const ImageKind kind, const ImageForms *f, const Lanes at[3],
                              ImageTerms *t, Lanes sum[]) {
  ImageTermsMake(last, at[0], at[1], at[2], t);
  ImageSums(1, kind, f, t, sum);
  if (last >= 2) ImageAddOrder(2, kind, ImageWithin(IMAGE_SECOND, at[0], at[1], at[2]), f, t, sum);
  if (last >= 3) ImageAddOrder(3, kind, ImageWithin(IMAGE_THIRD, at[0], at[1], at[2]), f, t, sum);
}
IMAGE_INLINE void ImageFarSums(const ImageKind kind, const ImageForms *f, const Lanes at[3], ImageTerms *t,
                               Lanes sum[]) {
  if (LanesAny(ImageWithin(IMAGE_THIRD, at[0], at[1], at[2])))
    ImageOrders(3, kind, f, at, t, sum);
  else if (LanesAny(ImageWithin(IMAGE_SECOND, at[0], at[1], at[2])))
    ImageOrders(2, kind, f, at, t, sum);
  else
    ImageOrders(1, kind, f, at, t, sum);
}
