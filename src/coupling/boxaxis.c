#include "coupling/boxaxis.h"

PetscReal BoxImage(const BoxAxis axis[2], PetscReal d[2]) {
  PetscReal part = 1;
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal period = axis[dir].high - axis[dir].low;
    if (axis[dir].wall) continue;
    d[dir] -= period * PetscFloorReal(d[dir] / period + 0.5);
    part *= 0.5 * erfc(2.3 * (PetscAbsReal(d[dir]) / period - 0.3) / 0.2);
  }
  return part;
}
