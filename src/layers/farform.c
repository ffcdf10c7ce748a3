/* The transforms of S and L, k along phi, are 1/k^2 times
       S: sin^2 phi (xx), cos^2 phi (yy), -sin phi cos phi (xy)
       L: the same with k~ = 2 sin(k/2) in place of k in each direction, times the transforms of the kernel's weights at
          both ends.
   L is expanded in k^2, and k^{2m-2} e^{i n phi} is i^n n (n^2 - 2^2) .. (n^2 - (2m-2)^2)/(2 pi r^{2m}) e^{i n phi} in
   the plane. */
#include "layers/farform.h"

#define TERMS (NEAR_FAR_ORDERS + 1) /* 1, k^2 .. k^6 */
#define ANGLES 32                   /* more than twice the highest wave */

/* A power series in k^2 at one angle. */
typedef struct {
  PetscReal term[TERMS];
} Series;

static Series Times(Series a, Series b) {
  Series product = {{0}};
  for (int i = 0; i < TERMS; i++)
    for (int j = 0; i + j < TERMS; j++) product.term[i + j] += a.term[i] * b.term[j];
  return product;
}

static Series Inverse(Series a) {
  Series inverse = {{1 / a.term[0]}};
  for (int i = 1; i < TERMS; i++) {
    for (int j = 1; j <= i; j++) inverse.term[i] -= a.term[j] * inverse.term[i - j];
    inverse.term[i] /= a.term[0];
  }
  return inverse;
}

/* SUM (-1)^m moment[m] (x k)^{2m}/(2m)!: the transform of an even function with these moments of even order. */
static Series Cosine(const PetscReal moment[TERMS], PetscReal x) {
  Series s;
  PetscReal factor = 1;
  for (int m = 0; m < TERMS; factor *= -x * x / ((2 * m + 1) * (2 * m + 2)), m++) s.term[m] = factor * moment[m];
  return s;
}

/* L's transform at the angle (c, s), times k^2: xx, yy, xy. */
static void LatticeTransform(const PetscReal moment[2][TERMS], PetscReal c, PetscReal s, Series L[3]) {
  static const PetscReal half[TERMS] = {1, 1. / 12, 1. / 80, 1. / 448}; /* moments of an interval of length 1 */
  const Series sx = Cosine(half, c), sy = Cosine(half, s), ax = Cosine(moment[0], c), ay = Cosine(moment[0], s),
               cx = Cosine(moment[1], c), cy = Cosine(moment[1], s), xx = Times(sx, sx), yy = Times(sy, sy);
  Series k2;
  for (int m = 0; m < TERMS; m++) k2.term[m] = c * c * xx.term[m] + s * s * yy.term[m];
  const Series over = Inverse(Times(k2, k2));
  L[0] = Times(Times(yy, over), Times(Times(ax, ax), Times(cy, cy)));
  L[1] = Times(Times(xx, over), Times(Times(ay, ay), Times(cx, cx)));
  L[2] = Times(Times(Times(sx, sy), over), Times(Times(ax, cx), Times(ay, cy)));
  for (int m = 0; m < TERMS; m++) {
    L[0].term[m] *= s * s;
    L[1].term[m] *= c * c;
    L[2].term[m] *= -c * s;
  }
}

void NearFarMake(const Kernel *kernel, NearFar *far) {
  PetscReal moment[2][TERMS];
  KernelMoments(kernel->along, TERMS, moment[0]);
  KernelMoments(kernel->across, TERMS, moment[1]);
  *far = (NearFar){.fourth = {moment[0][2], moment[1][2]}};
  for (int angle = 0; angle < ANGLES; angle++) {
    const PetscReal phi = 2 * PETSC_PI * angle / ANGLES;
    Series L[3];
    LatticeTransform(moment, PetscCosReal(phi), PetscSinReal(phi), L);
    for (int wave = 0; wave < NEAR_FAR_WAVES; wave++) {
      const int n = 2 * (wave + 1);
      PetscReal factor = (n % 4 ? -1 : 1) * n / (2 * PETSC_PI);
      for (int m = 1; m <= NEAR_FAR_ORDERS; factor *= n * n - 4 * m * m, m++) {
        far->p[wave][m - 1] -= factor * L[0].term[m] * PetscCosReal(n * phi) * 2 / ANGLES;
        far->q[wave][m - 1] -= factor * L[2].term[m] * PetscSinReal(n * phi) * 2 / ANGLES;
      }
    }
  }
}
