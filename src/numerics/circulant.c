#include "numerics/circulant.h"

#define TOGETHER 4 /* weights that a sum takes at once */

void CirculantConvolve(PetscInt n, int each, PetscBool ahead, const PetscReal weight[], const PetscReal twice[],
                       PetscReal *restrict sum) {
  const PetscInt width = each * n, step = ahead ? each : -each;
  const PetscReal *x = ahead ? twice : twice + width;
  PetscInt q = 0;
  for (PetscInt i = 0; i < width; i++) sum[i] = 0;
  for (; q + TOGETHER <= n; q += TOGETHER, x += TOGETHER * step) {
    const PetscReal *restrict a = x, *restrict b = a + step, *restrict c = b + step, *restrict d = c + step,
                              *w = weight + q;
    for (PetscInt i = 0; i < width; i++) sum[i] += (w[0] * a[i] + w[1] * b[i]) + (w[2] * c[i] + w[3] * d[i]);
  }
  for (; q < n; q++, x += step)
    for (PetscInt i = 0; i < width; i++) sum[i] += weight[q] * x[i];
}
