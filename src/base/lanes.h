/* Four numbers at once, from any address: loops over them become vector instructions whatever the compiler makes of a
   sum's order. */
#pragma once
#include "base/base.h"

#define LANES 4
typedef PetscReal Lanes __attribute__((vector_size(LANES * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

/* LanesAt - the four numbers from x on. LanesPut - to x on. LanesSum - their sum. LanesPairs - four pairs x[8],
   interlaced, become their first and their second numbers; LanesInterlace - the other way round. */
static inline Lanes LanesAt(const PetscReal x[]) {
  return *(const Lanes *)x;
}
static inline void LanesPut(Lanes a, PetscReal x[]) {
  *(Lanes *)x = a;
}
static inline PetscReal LanesSum(Lanes x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}
static inline void LanesPairs(const PetscReal x[], Lanes *a, Lanes *b) {
  const Lanes p = LanesAt(x), q = LanesAt(x + LANES);
  *a = (Lanes){p[0], p[2], q[0], q[2]};
  *b = (Lanes){p[1], p[3], q[1], q[3]};
}
static inline void LanesInterlace(Lanes a, Lanes b, PetscReal x[]) {
  *(Lanes *)x = (Lanes){a[0], b[0], a[1], b[1]};
  *(Lanes *)(x + LANES) = (Lanes){a[2], b[2], a[3], b[3]};
}
