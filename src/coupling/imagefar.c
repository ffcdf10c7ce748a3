/* In mode k along the wall the lattice's image is e^{-k(a + b)}/(4k) [p + k^2 P], p and P polynomials in ka and kb: p
   is Blake's image, P the dispersion by the lattice (both from imagetable.c's modes for small k), and a kernel of
   second moments m along the wall, ma and mb across it, smooths with k^2 [-m p + ma/2 (p - 2 p_a) + mb/2 (p - 2 p_b)],
   subscripts derivatives. What is left of C_image is minus the k^2 terms:
       C_image = -1/(4 pi) SUM c_pq a^p b^q n!/z^{n+1},   n = 1 + p + q,   z = a + b - i x,
   the real part for tt and nn, the imaginary part for nt. */
#include "coupling/imagefar.h"
#include "base/lanes.h"

/* Monomials 1, a, b, aa, ab, bb, aab, abb. */
enum { ONE, A, B, AA, AB, BB, AAB, ABB };

static const PetscReal leading[3][IMAGE_MONOMIALS] = {{-1, 1, 1, 0, -2}, {-1, -1, -1, 0, -2}, {0, -1, 1, 0, 2}};
static const PetscReal dispersion[3][IMAGE_MONOMIALS] = {
    {4. / 12, -10. / 12, -10. / 12, 1. / 12, 18. / 12, 1. / 12, -2. / 12, -2. / 12},
    {-2. / 12, 2. / 12, 2. / 12, -1. / 12, 14. / 12, -1. / 12, -2. / 12, -2. / 12},
    {3. / 12, 9. / 12, -3. / 12, -1. / 12, -16. / 12, 1. / 12, 2. / 12, 2. / 12}};

/* A part's polynomial k^2 [P + smoothing]. */
static void Polynomial(int part, const PetscReal kernel[2], PetscReal ma, PetscReal mb, PetscReal c[IMAGE_MONOMIALS]) {
  const PetscReal along[3] = {kernel[0], kernel[1], 0.5 * (kernel[0] + kernel[1])}, *lead = leading[part];
  if (part != IMAGE_TT) ma = kernel[0]; /* across the wall the normal component has the moment along itself */
  if (part == IMAGE_NN) mb = kernel[0];
  for (int k = 0; k < IMAGE_MONOMIALS; k++) c[k] = dispersion[part][k] + (0.5 * (ma + mb) - along[part]) * lead[k];
  c[ONE] -= ma * lead[A] + mb * lead[B];
  c[A] -= mb * lead[AB];
  c[B] -= ma * lead[AB];
}

void ImageKernelMake(PetscReal along, PetscReal across, ImageKernel *kernel) {
  kernel->moment[0] = along;
  kernel->moment[1] = across;
  for (int part = 0; part < 3; part++) Polynomial(part, kernel->moment, across, across, kernel->c[part]);
}

/* One at a and b against the powers of 1/z. */
static inline Lanes Sum(const PetscReal c[IMAGE_MONOMIALS], Lanes a, Lanes b, const Lanes power[4]) {
  return c[ONE] * power[0] + (c[A] * a + c[B] * b) * power[1] +
         (a * (c[AA] * a + c[AB] * b) + c[BB] * b * b) * power[2] + a * b * (c[AAB] * a + c[ABB] * b) * power[3];
}

/* The sums of the three polynomials, that of nt for the source's tangential component and for the response's, of four
   pairs. */
static inline void Sums(Lanes x, Lanes a, Lanes b, const PetscReal *const c[IMAGE_PARTS], Lanes part[IMAGE_PARTS]) {
  const Lanes H = a + b, over = 1 / (H * H + x * x), u = H * over, v = x * over;
  Lanes real[4], imaginary[4], w[2] = {u, v};
  PetscReal factor = -1 / (4 * PETSC_PI);
  for (int n = 0; n < 4; n++) {
    const Lanes next = w[0] * u - w[1] * v;
    w[1] = w[0] * v + w[1] * u;
    w[0] = next;
    factor *= n + 1;
    real[n] = factor * w[0];
    imaginary[n] = factor * w[1];
  }
  part[IMAGE_TT] = Sum(c[IMAGE_TT], a, b, real);
  part[IMAGE_NN] = Sum(c[IMAGE_NN], a, b, real);
  part[IMAGE_NT] = Sum(c[IMAGE_NT], a, b, imaginary);
  part[IMAGE_TN] = -Sum(c[IMAGE_TN], b, a, imaginary); /* t from n is n from t the other way round */
}

void ImageFarRow(PetscInt n, const PetscReal x[], const PetscReal a[], const PetscReal b[], const ImageKernel *kernel,
                 PetscReal *const part[IMAGE_PARTS]) {
  const PetscReal *c[IMAGE_PARTS] = {kernel->c[0], kernel->c[1], kernel->c[2], kernel->c[2]};
  Lanes four[IMAGE_PARTS];
  for (PetscInt k = 0; k < n; k += LANES) {
    Sums(LanesAt(x + k), LanesAt(a + k), LanesAt(b + k), c, four);
    for (int q = 0; q < IMAGE_PARTS; q++) *(Lanes *)(part[q] + k) = four[q];
  }
}

void ImageFar(const ImagePair *p, const ImageKernel *kernel, PetscReal ma, PetscReal mb, PetscReal part[IMAGE_PARTS]) {
  const PetscReal *c[IMAGE_PARTS] = {kernel->c[0], kernel->c[1], kernel->c[2], kernel->c[2]};
  PetscReal own[IMAGE_PARTS][IMAGE_MONOMIALS];
  if (ma != kernel->moment[1] || mb != kernel->moment[1]) {
    Polynomial(IMAGE_TT, kernel->moment, ma, mb, own[IMAGE_TT]);
    Polynomial(IMAGE_NT, kernel->moment, ma, mb, own[IMAGE_NT]);
    Polynomial(IMAGE_NT, kernel->moment, mb, ma, own[IMAGE_TN]);
    for (int q = 0; q < IMAGE_PARTS; q++)
      if (q != IMAGE_NN) c[q] = own[q];
  }
  Lanes four[IMAGE_PARTS];
  Sums(p->x - (Lanes){0}, p->a - (Lanes){0}, p->b - (Lanes){0}, c, four);
  for (int q = 0; q < IMAGE_PARTS; q++) part[q] = four[q][0];
}
