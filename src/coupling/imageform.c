/* A kernel of even moments m2, m4 takes 1 + m2/2 d^2 + m4/24 d^4 of what it is applied to. Along the wall d^2 is
   -theta^2; across it d acts on e^{-theta a} p(theta a) as theta (p' - p). */
#include "coupling/imageform.h"

#define DEGREES 4 /* more than the largest in a or b alone */

static const int degree_a[IMAGE_MONOMIALS] = {0, 1, 0, 1, 2, 0, 2, 1, 3, 0, 3, 2, 1};

/* A polynomial in theta a and theta b. */
typedef struct {
  PetscReal c[DEGREES][DEGREES];
} Polynomial;

ImageMoments ImageMomentsOf(KernelWeights weights) {
  PetscReal moment[3];
  KernelMoments(weights, 3, moment);
  return (ImageMoments){moment[1], moment[2]};
}

ImageMoments ImageMomentsBoth(ImageMoments one, ImageMoments other) {
  return (ImageMoments){one.second + other.second, one.fourth + 6 * one.second * other.second + other.fourth};
}

void ImageFormAdd(PetscReal alpha, const ImageNumbers *number, const PetscReal over[IMAGE_ORDERS], ImageForm *to) {
  for (int m = 0; m < IMAGE_ORDERS; m++)
    for (int k = 0; k < image_monomials[m]; k++) to->c[m][k] += alpha * number->c[m][k] / over[m];
}

/* to += alpha times p. */
static void Add(PetscReal alpha, const Polynomial *p, Polynomial *to) {
  for (int k = 0; k < DEGREES * DEGREES; k++) to->c[k / DEGREES][k % DEGREES] += alpha * p->c[k / DEGREES][k % DEGREES];
}

/* d^2 across the wall, over theta^2, at a (0) or at b (1). */
static Polynomial Across(int end, Polynomial p) {
  for (int twice = 0; twice < 2; twice++)
    for (int i = 0; i < DEGREES; i++)
      for (int j = 0; j < DEGREES; j++) {
        const int up[2] = {i + !end, j + end}, n = up[end];
        p.c[i][j] = (n < DEGREES ? n * p.c[up[0]][up[1]] : 0) - p.c[i][j];
      }
  return p;
}

/* Second and fourth order of the three kernels. */
static Polynomial Second(ImageMoments along, const ImageMoments end[2], const Polynomial *p) {
  Polynomial sum = {{{0}}};
  Add(-0.5 * along.second, p, &sum);
  for (int e = 0; e < 2; e++) {
    const Polynomial at = Across(e, *p);
    Add(0.5 * end[e].second, &at, &sum);
  }
  return sum;
}

static Polynomial Fourth(ImageMoments along, const ImageMoments end[2], const Polynomial *p) {
  const Polynomial at = Across(0, *p), both = Across(1, at);
  Polynomial sum = {{{0}}};
  Add(along.fourth / 24, p, &sum);
  Add(0.25 * end[0].second * end[1].second, &both, &sum);
  for (int e = 0; e < 2; e++) {
    const Polynomial one = Across(e, *p), two = Across(e, one);
    Add(end[e].fourth / 24, &two, &sum);
    Add(-0.25 * along.second * end[e].second, &one, &sum);
  }
  return sum;
}

static Polynomial Get(const ImageForm *f, int order) {
  Polynomial p = {{{0}}};
  for (int k = 0; k < image_monomials[order]; k++) p.c[degree_a[k]][image_degree[k] - degree_a[k]] = f->c[order][k];
  return p;
}

static void Put(const Polynomial *p, int order, PetscReal c[IMAGE_MONOMIALS]) {
  for (int k = 0; k < image_monomials[order]; k++) c[k] = p->c[degree_a[k]][image_degree[k] - degree_a[k]];
}

void ImageFormSmooth(ImageMoments along, ImageMoments response, ImageMoments source, ImageForm *f) {
  const ImageMoments end[2] = {response, source};
  Polynomial p[IMAGE_ORDERS];
  for (int m = 0; m < IMAGE_ORDERS; m++) p[m] = Get(f, m);
  const Polynomial first = Second(along, end, &p[0]), second = Second(along, end, &p[1]),
                   fourth = Fourth(along, end, &p[0]);
  Add(1, &first, &p[1]);
  Add(1, &second, &p[2]);
  Add(1, &fourth, &p[2]);
  for (int m = 0; m < IMAGE_ORDERS; m++) Put(&p[m], m, f->c[m]);
}

void ImageFormBend(const ImageForm *f, int end, PetscReal c[IMAGE_MONOMIALS]) {
  const Polynomial twice = Across(end, Get(f, 0));
  Polynomial half = {{{0}}};
  Add(0.5, &twice, &half);
  Put(&half, 1, c);
}
