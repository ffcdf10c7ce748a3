/* A kernel of even moments m2, m4, m6 takes 1 + m2/2 d^2 + m4/24 d^4 + m6/720 d^6 of what it is applied to. Along the
   wall d^2 is -theta^2; across it d acts on e^{-theta a} p(theta a) as theta (p' - p). */
#include "layers/imageform.h"

#define DEGREES 5 /* more than the largest in a or b alone */

static const int degree_a[IMAGE_MONOMIALS] = {0, 1, 0, 1, 2, 0, 2, 1, 3, 0, 3, 2, 1, 4, 0, 4, 3, 2, 1};

/* A polynomial in theta a and theta b. */
typedef struct {
  PetscReal c[DEGREES][DEGREES];
} Polynomial;

ImageMoments ImageMomentsOf(KernelWeights weights) {
  PetscReal moment[4];
  KernelMoments(weights, 4, moment);
  return (ImageMoments){moment[1], moment[2], moment[3]};
}

ImageMoments ImageMomentsBoth(ImageMoments one, ImageMoments other) {
  return (ImageMoments){one.second + other.second, one.fourth + 6 * one.second * other.second + other.fourth,
                        one.sixth + 15 * (one.fourth * other.second + one.second * other.fourth) + other.sixth};
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

/* What one kernel makes of the orders of p: along the wall (across < 0), or across it at that end. */
static void Smooth(int across, ImageMoments kernel, Polynomial p[IMAGE_ORDERS]) {
  const PetscReal part[IMAGE_ORDERS] = {1, kernel.second / 2, kernel.fourth / 24, kernel.sixth / 720};
  for (int m = IMAGE_ORDERS - 1; m >= 0; m--) {
    Polynomial sum = p[m];
    for (int k = 1; k <= m; k++) {
      Polynomial at = p[m - k];
      for (int twice = 0; twice < k && across >= 0; twice++) at = Across(across, at);
      Add(across < 0 && k % 2 ? -part[k] : part[k], &at, &sum);
    }
    p[m] = sum;
  }
}

static Polynomial Get(const ImageForm *f, int order) {
  Polynomial p = {{{0}}};
  for (int k = 0; k < image_monomials[order]; k++) p.c[degree_a[k]][image_degree[k] - degree_a[k]] = f->c[order][k];
  return p;
}

static void ImageFormPut(const Polynomial *p, int order, PetscReal c[IMAGE_MONOMIALS]) {
  for (int k = 0; k < image_monomials[order]; k++) c[k] = p->c[degree_a[k]][image_degree[k] - degree_a[k]];
}

void ImageFormSmooth(ImageMoments along, ImageMoments response, ImageMoments source, ImageForm *f) {
  Polynomial p[IMAGE_ORDERS];
  for (int m = 0; m < IMAGE_ORDERS; m++) p[m] = Get(f, m);
  Smooth(-1, along, p);
  Smooth(0, response, p);
  Smooth(1, source, p);
  for (int m = 0; m < IMAGE_ORDERS; m++) ImageFormPut(&p[m], m, f->c[m]);
}

ImageForm ImageFormBend(const ImageForm *f, int end) {
  const Polynomial twice = Across(end, Get(f, 0));
  Polynomial half = {{{0}}};
  ImageForm bend = {{{0}}};
  Add(0.5, &twice, &half);
  ImageFormPut(&half, 1, bend.c[1]);
  return bend;
}

void ImageFormsPut(const ImageForm *form, int part, ImageForms *f) {
  for (int m = 0; m < IMAGE_ORDERS; m++)
    for (int k = 0; k < IMAGE_MONOMIALS; k++) f->c[m][part][k] = (m ? -1 : 1) * form->c[m][k] + (Lanes){0};
}
