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

/* ImageMomentsOf - of weights. ImageMomentsBoth - of one kernel after the other. ImageFormAdd - to += alpha times the
   form of these numbers. ImageFormSmooth - the form through kernels of these moments: along the wall those of both ends
   together, across it of the response and of the source. ImageFormBend - what a second moment of 1 of the response (end
   0) or of the source (1) across the wall adds to the first order of p. Not collective. */
PETSC_EXTERN ImageMoments ImageMomentsOf(KernelWeights weights);
PETSC_EXTERN ImageMoments ImageMomentsBoth(ImageMoments one, ImageMoments other);
PETSC_EXTERN void ImageFormAdd(PetscReal alpha, const ImageNumbers *number, const PetscReal over[IMAGE_ORDERS],
                               ImageForm *to);
PETSC_EXTERN void ImageFormSmooth(ImageMoments along, ImageMoments response, ImageMoments source, ImageForm *form);
PETSC_EXTERN void ImageFormBend(const ImageForm *form, int end, PetscReal c[IMAGE_MONOMIALS]);

/* Of four pairs: n!/z^{n+1}/(4 pi), its real and its imaginary part; with all monomials. */
typedef struct {
  Lanes power[IMAGE_POWERS][2];
} ImagePowers;
typedef struct {
  Lanes monomial[IMAGE_MONOMIALS];
  ImagePowers powers;
} ImageTerms;

/* ImagePowersMake, ImageTermsMake - for orders up to this one, H = a + b. ImageProducts - monomials times powers of an
   order with this n0, their real (0) or imaginary part (1). ImageSumOf - of an order's. ImageWithin - which pairs are
   within that many cells. Not collective. */
static inline ImagePowers ImagePowersMake(const int order, Lanes x, Lanes H) {
  const Lanes over = 1 / (H * H + x * x), u = H * over, v = x * over;
  Lanes w[2] = {u / (4 * PETSC_PI), v / (4 * PETSC_PI)};
  ImagePowers t;
  for (int n = 0; n < 3 * (order + 1); n++) {
    t.power[n][0] = w[0];
    t.power[n][1] = w[1];
    const Lanes next = (n + 1) * (w[0] * u - w[1] * v);
    w[1] = (n + 1) * (w[0] * v + w[1] * u);
    w[0] = next;
  }
  return t;
}
static inline ImageTerms ImageTermsMake(const int order, Lanes x, Lanes a, Lanes b) {
  const Lanes ab = a * b, aa = a * a, bb = b * b;
  ImageTerms t = {.monomial = {1 + (Lanes){0}, a, b, ab, aa, bb, a * ab, ab * b}};
  t.powers = ImagePowersMake(order, x, a + b);
  if (order >= 2) {
    const Lanes more[] = {aa * a, bb * b, aa * ab, ab * ab, ab * bb};
    for (int k = 0; k < 5; k++) t.monomial[image_monomials[1] + k] = more[k];
  }
  if (order == 3) {
    const Lanes more[] = {aa * aa, bb * bb, aa * aa * b, aa * ab * b, ab * bb * a, ab * bb * b};
    for (int k = 0; k < 6; k++) t.monomial[image_monomials[2] + k] = more[k];
  }
  return t;
}
static inline void ImageProducts(const int order, const int n0, const int sine, const ImageTerms *t, Lanes term[]) {
  for (int k = 0; k < image_monomials[order]; k++)
    term[k] = t->monomial[k] * t->powers.power[n0 + 2 * order + image_degree[k]][sine];
}
static inline Lanes ImageSumOf(const int order, const PetscReal c[], const Lanes term[]) {
  Lanes sum = c[0] * term[0];
  for (int k = 1; k < image_monomials[order]; k++) sum += c[k] * term[k];
  return sum;
}
static inline LanesBits ImageWithin(const int cells, Lanes x, Lanes a, Lanes b) {
  return (LanesBits)(x * x + (a + b) * (a + b) < cells * cells);
}
