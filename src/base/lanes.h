/* Four numbers at once, from any address: loops over them become vector instructions whatever the compiler makes of a
   sum's order. */
#pragma once
#include "base/base.h"

#define LANES 4
typedef PetscReal Lanes __attribute__((vector_size(LANES * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

/* LanesAt - the four numbers from x on. LanesSum - their sum. */
static inline Lanes LanesAt(const PetscReal x[]) {
  return *(const Lanes *)x;
}
static inline PetscReal LanesSum(Lanes x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}
