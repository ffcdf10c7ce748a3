#include "coupling/boxaxis.h"

void BoxAxisChebyshev(PetscInt places, PetscReal low, PetscReal high, BoxAxis *a) {
  a->wall = PETSC_TRUE;
  a->low = low;
  a->high = high;
  a->modes = 0;
  a->places = places;
  a->pairs = places * places;
  for (PetscInt k = 0; k < places; k++) {
    const PetscReal angle = PETSC_PI * (k + 0.5) / places;
    a->place[k] = 0.5 * (low + high) + 0.5 * (high - low) * -PetscCosReal(angle);
    a->weight[k] = (k % 2 ? -1 : 1) * PetscSinReal(angle);
  }
}

void BoxAxisPolynomials(const BoxAxis *a, PetscReal x, PetscReal values[]) {
  const PetscInt n = a->places;
  PetscReal plain[BOX_WALL_PLACES], sum = 0;
  PetscInt at = -1;
  for (PetscInt k = 0; k < n; k++) { /* the second barycentric formula */
    const PetscReal off = x - a->place[k];
    if (PetscAbsReal(off) < 1e-14 * (a->high - a->low)) at = k;
    plain[k] = a->weight[k] / off;
    sum += plain[k];
  }
  for (PetscInt k = 0; k < n; k++) plain[k] = at < 0 ? plain[k] / sum : k == at;
  for (PetscInt k = 0; k < n / 2; k++) {
    values[k] = PetscSqrtReal(0.5) * (plain[k] + plain[n - 1 - k]);
    values[n / 2 + k] = PetscSqrtReal(0.5) * (plain[k] - plain[n - 1 - k]);
  }
}

#define TIE 1e-10 /* of a period: of two images that are as near but for rounding, always the one at -period/2 */

PetscReal BoxImage(const BoxAxis axis[2], PetscReal d[2]) {
  PetscReal part = 1;
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal period = axis[dir].high - axis[dir].low;
    if (axis[dir].wall) continue;
    d[dir] -= period * PetscFloorReal(d[dir] / period + 0.5 + TIE);
    part *= 0.5 * erfc(2.3 * (PetscAbsReal(d[dir]) / period - 0.3) / 0.2);
  }
  return part;
}
