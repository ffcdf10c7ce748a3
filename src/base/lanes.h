/* Vectors of four numbers, loaded from any address.

   Loops over them become vector instructions, and the order of a sum is that of the source on every compiler. */
#pragma once
#include "base/base.h"

#define LANES 4
typedef PetscReal Lanes __attribute__((vector_size(LANES * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

/* LanesAt - load the four numbers from x on. LanesPut - store four numbers from x on. LanesSum - sum of four numbers.
   LanesPairs - load the first numbers, a, and the second numbers, b, of
   four interlaced pairs x[8]. LanesInterlace - store a and b as four interlaced pairs. */
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

/* LanesDot - SUM x_i y_i of n numbers. */
static inline PetscReal LanesDot(PetscInt n, const PetscReal x[], const PetscReal y[]) {
  Lanes sum = {0};
  PetscReal rest = 0;
  PetscInt i = 0;
  for (; i + LANES <= n; i += LANES) sum += LanesAt(x + i) * LanesAt(y + i);
  for (; i < n; i++) rest += x[i] * y[i];
  return LanesSum(sum) + rest;
}

/* The bits of four numbers. A comparison of Lanes gives all ones where it is true and else zeros. LanesAny - whether it
   is true of any number. LanesWhere - a where it is true, else 0. LanesMax, LanesMin - the larger and the smaller
   number. */
typedef unsigned long long LanesBits __attribute__((vector_size(LANES * sizeof(PetscReal)), may_alias));
static inline int LanesAny(LanesBits so) {
  return (so[0] | so[1] | so[2] | so[3]) != 0;
}
static inline Lanes LanesWhere(LanesBits so, Lanes a) {
  return (Lanes)(so & (LanesBits)a);
}
static inline Lanes LanesMax(Lanes a, Lanes b) {
  const LanesBits so = (LanesBits)(a > b);
  return (Lanes)((so & (LanesBits)a) | (~so & (LanesBits)b));
}

/* LanesLog - logarithms of normal numbers above 0, relative error 3e-16, near 1 error 2e-17; at 0 a finite number. With
   x = 2^e m, m from root(1/2) to root 2, and s = (m - 1)/(m + 1) it is

     e ln 2 + 2 (s + s^3/3 + .. + s^21/21). */
static inline Lanes LanesLog(Lanes x) {
  const unsigned long long half = 0x3fe6a09e667f3bcdULL, shifted = 0x4000000000000000ULL, whole = 0x4330000000000000ULL;
  const LanesBits e = ((LanesBits)x - half + shifted) >> 52; /* the exponent + 1024 */
  const Lanes m = (Lanes)((LanesBits)x - ((e - 1024) << 52)),
              exponent = (Lanes)(e | whole) - (4503599627370496. + 1024);
  const Lanes s = (m - 1) / (m + 1), z = s * s;
  Lanes sum = z * (2. / 21) + 2. / 19;
  for (int k = 17; k > 1; k -= 2) sum = sum * z + 2. / k;
  return exponent * 0.693147180559945309417 + (2 * s + s * z * sum);
}
