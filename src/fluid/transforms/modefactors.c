/* With r = e^{-theta}, r + 1/r - 2 = 4 sinh(theta/2)^2 gives theta. Long waves have theta near 0 and r near 1; asinh
   and expm1 keep their digits where 1 - r would lose them.

   Rows of a slab of m rows without right-hand side turn Y = y below them into Y_j = M^{j+1} y, so that
       gain = SUM_j M^j (1, 1)^T (0, 1) M^{j+1},
   and of a slab on top of another, gain = gain_1 + M^{m_1} gain_2 M^{m_1}. All terms are positive: nothing cancels. */
#include "fluid/transforms/modefactors.h"

/* A slab: M^m and its gain. */
typedef struct {
  ModePair power, gain;
} ModeSlab;

static ModePair PairTimes(ModePair A, ModePair B) {
  ModePair C;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) C.a[i][j] = A.a[i][0] * B.a[0][j] + A.a[i][1] * B.a[1][j];
  return C;
}
/* A + factor B */
static ModePair PairPlus(ModePair A, PetscReal factor, ModePair B) {
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) A.a[i][j] += factor * B.a[i][j];
  return A;
}
static ModePair PairInverse(ModePair A) {
  const PetscReal d = A.a[0][0] * A.a[1][1] - A.a[0][1] * A.a[1][0];
  return (ModePair){{{A.a[1][1] / d, -A.a[0][1] / d}, {-A.a[1][0] / d, A.a[0][0] / d}}};
}
static const ModePair unit = {{{1, 0}, {0, 1}}};

static ModeSlab SlabsStack(ModeSlab low, ModeSlab high) {
  return (ModeSlab){.power = PairTimes(high.power, low.power),
                    .gain = PairPlus(low.gain, 1, PairTimes(low.power, PairTimes(high.gain, low.power)))};
}

/* M^m and the gain of a slab of m rows, by doubling. */
static ModeSlab SlabOfRows(PetscReal r1, PetscReal r2, PetscInt m) {
  ModeSlab all = {.power = unit}, next = {.power = {{{r1, 0}, {r1, r2}}}, .gain = {{{r1, r2}, {r1, r2}}}};
  for (; m > 0; m /= 2) {
    if (m % 2) all = SlabsStack(all, next);
    next = SlabsStack(next, next);
  }
  return all;
}

static void PairStore(ModeFactors f, PetscInt k, ModePair from, PairMatrix to) {
  for (int i = 0; i < 4; i++) to[i * f->width + k] = from.a[i / 2][i % 2];
}

/* Walls: Z_0 itself grows with Y below it, Z_0 = W + D Y, W being Z_0 for Y = 0, D = gain + M^n top M^n of all n rows.
   So Y = bottom (1 - D bottom)^-1 W. At the seam of a period Y below the first row is what leaves the last row, (1 -
   M^n)^-1 times what leaves it when nothing comes in; so is Z above the last row. */
void ModeFactorsSet(ModeFactors f, PetscInt k, const PetscReal theta[2], PetscReal factor, ModePair bottom,
                    ModePair top) {
  const PetscInt n = f->grid->all_rows[f->field], full = f->grid->block;
  const PetscReal r1 = PetscExpReal(-theta[0]), r2 = PetscExpReal(-theta[1]);
  const ModeSlab all = SlabOfRows(r1, r2, n);
  f->factor[k] = factor;
  f->r[0][k] = r1;
  f->r[1][k] = r2;
  for (int last = 0; last < 2; last++) {
    const ModeSlab slab = SlabOfRows(r1, r2, last ? n - (f->grid->size - 1) * full : full);
    PairStore(f, k, slab.power, f->power[last]);
    PairStore(f, k, slab.gain, f->gain[last]);
  }
  if (f->grid->wall[1]) {
    const ModePair D = PairPlus(all.gain, 1, PairTimes(all.power, PairTimes(top, all.power)));
    bottom = PairTimes(bottom, PairInverse(PairPlus(unit, -1, PairTimes(D, bottom))));
  } else
    bottom = top = PairInverse((ModePair){{{-expm1(-n * theta[0]), 0}, {-all.power.a[1][0], -expm1(-n * theta[1])}}});
  PairStore(f, k, bottom, f->bottom);
  PairStore(f, k, top, f->top);
}

void ModeFactorsReach(ModeFactors f, PetscReal negligible, PetscInt most) {
  for (PetscInt b = 0; b < f->width / MODE_BLOCK; b++) {
    f->reach[b] = 1;
    for (PetscInt k = b * MODE_BLOCK; k < (b + 1) * MODE_BLOCK; k++) {
      const PetscReal r = f->r[0][k], rows = r > 0 ? negligible / PetscMax(-PetscLogReal(r), 1e-9) : 0;
      f->reach[b] = PetscMax(f->reach[b], (PetscInt)PetscMin(rows + 1, (PetscReal)most));
    }
  }
}

PetscErrorCode ModeFactorsCreate(Grid g, Field field, PetscInt modes, const PetscReal lambda[], const PetscReal scale[],
                                 ModeFactors *out) {
  const PetscInt w = (modes + MODE_BLOCK - 1) / MODE_BLOCK * MODE_BLOCK;
  ModeFactors f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *out = f;
  f->grid = g;
  f->field = field;
  f->modes = modes;
  f->width = w;
  f->lambda = lambda;
  f->scale = scale;
  PetscCall(PetscCalloc4(w, &f->r[0], w, &f->r[1], w, &f->factor, w / MODE_BLOCK, &f->reach));
  PetscCall(PetscCalloc6(4 * w, &f->power[0], 4 * w, &f->power[1], 4 * w, &f->gain[0], 4 * w, &f->gain[1], 4 * w,
                         &f->bottom, 4 * w, &f->top));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModeFactorsDestroy(ModeFactors *factors) {
  ModeFactors f = *factors;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(f->r[0], f->r[1], f->factor, f->reach));
  PetscCall(PetscFree6(f->power[0], f->power[1], f->gain[0], f->gain[1], f->bottom, f->top));
  PetscCall(PetscFree(*factors));
  PetscFunctionReturn(PETSC_SUCCESS);
}
