/* In mode k along the wall the lattice's image is e^{-k(a + b)}/(4k) [p + k^2 P], p and P polynomials in ka and kb: p
   is Blake's image, P the dispersion by the lattice (both from imagetable.c's modes for small k), and a kernel of
   second moments m along the wall, ma and mb across it, smooths with k^2 [-m p + ma/2 (p - 2 p_a) + mb/2 (p - 2 p_b)],
   subscripts derivatives. What is left of C_image is minus the k^2 terms:
       C_image = -1/(4 pi) SUM c_pq a^p b^q n!/z^{n+1},   n = 1 + p + q,   z = a + b - i x,
   the real part for tt and nn, the imaginary part for nt. */
#include "coupling/imagefar.h"

/* Monomials 1, a, b, aa, ab, bb, aab, abb. */
enum { ONE, A, B, AA, AB, BB, AAB, ABB, MONOMIALS };

static const PetscReal leading[3][MONOMIALS] = {{-1, 1, 1, 0, -2}, {-1, -1, -1, 0, -2}, {0, -1, 1, 0, 2}};
static const PetscReal dispersion[3][MONOMIALS] = {
    {4. / 12, -10. / 12, -10. / 12, 1. / 12, 18. / 12, 1. / 12, -2. / 12, -2. / 12},
    {-2. / 12, 2. / 12, 2. / 12, -1. / 12, 14. / 12, -1. / 12, -2. / 12, -2. / 12},
    {3. / 12, 9. / 12, -3. / 12, -1. / 12, -16. / 12, 1. / 12, 2. / 12, 2. / 12}};

/* SUM over the powers[4] of 1/z of a part's polynomial at these monomials. */
static inline PetscReal Sum(int part, const PetscReal monomial[MONOMIALS], PetscReal along, PetscReal ma, PetscReal mb,
                            const PetscReal power[4]) {
  const PetscReal *lead = leading[part], both = 0.5 * (ma + mb) - along;
  PetscReal c[MONOMIALS];
  for (int k = 0; k < MONOMIALS; k++) c[k] = dispersion[part][k] + both * lead[k];
  c[ONE] -= ma * lead[A] + mb * lead[B];
  c[A] -= mb * lead[AB];
  c[B] -= ma * lead[AB];
  for (int k = 0; k < MONOMIALS; k++) c[k] *= monomial[k];
  return c[ONE] * power[0] + (c[A] + c[B]) * power[1] + (c[AA] + c[AB] + c[BB]) * power[2] +
         (c[AAB] + c[ABB]) * power[3];
}

void ImageFar(const ImagePair *p, const PetscReal kernel[2], PetscReal ma, PetscReal mb, PetscReal part[IMAGE_PARTS]) {
  const PetscReal a = p->a, b = p->b, H = a + b, r2 = H * H + p->x * p->x, inverse[2] = {H / r2, p->x / r2};
  const PetscReal there[MONOMIALS] = {1, a, b, a * a, a * b, b * b, a * a * b, a * b * b};
  const PetscReal back[MONOMIALS] = {1, b, a, b * b, a * b, a * a, a * b * b, a * a * b};
  const PetscReal mean = 0.5 * (kernel[0] + kernel[1]);
  PetscReal real[4], imaginary[4], w[2] = {inverse[0], inverse[1]}, factor = -1 / (4 * PETSC_PI);
  for (int n = 0; n < 4; n++) {
    const PetscReal next = w[0] * inverse[0] - w[1] * inverse[1];
    w[1] = w[0] * inverse[1] + w[1] * inverse[0];
    w[0] = next;
    factor *= n + 1;
    real[n] = factor * w[0];
    imaginary[n] = factor * w[1];
  }
  part[IMAGE_TT] = Sum(0, there, kernel[0], ma, mb, real);
  part[IMAGE_NN] = Sum(1, there, kernel[1], kernel[0], kernel[0], real);
  part[IMAGE_NT] = Sum(2, there, mean, kernel[0], mb, imaginary);
  part[IMAGE_TN] = -Sum(2, back, mean, kernel[0], ma, imaginary); /* t from n is n from t the other way round */
}
