/* In x a Fourier integral over theta in (0, pi], in y in closed form. With s = 4 sin^2(theta/2) and the decay e^-mu of
   mode theta from row to row, mu = 2 asinh(sin(theta/2)), the inverse of s minus the second difference in y and that of
   its square are

       g1(j) = e^{-mu j}/(2 sinh mu)
       g2(j) = e^{-mu j} (j sinh mu + cosh mu)/(4 sinh^3 mu)

   and the projection onto divergence-free fields gives

       uu(i, j) = (1/pi) INT [cos(i theta) (g1 - s g2)(j) - 1/(4 theta)] dtheta + (gamma + ln pi + 1)/(4 pi)
       vv(i, j) = uu(j, i)
       vu(i + 1/2, j + 1/2) = -(1/pi) INT 2 sin(theta/2) sin((i + 1/2) theta) (g2(j + 1) - g2(j)) dtheta

   vu odd in both offsets. The integrands are analytic: Gauss-Legendre converges to rounding. */
#include "layers/latticegreen.h"
#include <petscdt.h>

#define EULER_GAMMA 0.57721566490153286061

PetscReal LatticeConstant(void) {
  return (EULER_GAMMA + PetscLogReal(PETSC_PI) + 1) / (4 * PETSC_PI);
}

/* uu and vu of offsets 0 .. reach: arrays [i][j], i fastest in memory order [j * (reach + 1) + i]. */
static PetscErrorCode Quadrant(PetscInt reach, PetscReal uu[], PetscReal vu[]) {
  const PetscInt nodes = reach + 40, n = reach + 1; /* reach + 20 give the same to rounding */
  PetscReal *theta, *weight, *cosine, *sine, *along, *square;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(nodes, &theta, nodes, &weight, n, &cosine, n, &sine, n + 1, &along, n + 1, &square));
  PetscCall(PetscDTGaussQuadrature(nodes, 0, PETSC_PI, theta, weight));
  PetscCall(PetscArrayzero(vu, n * n));
  for (PetscInt k = 0; k < n * n; k++) uu[k] = LatticeConstant();
  for (PetscInt q = 0; q < nodes; q++) {
    const PetscReal half = PetscSinReal(0.5 * theta[q]), s = 4 * half * half, mu = 2 * PetscAsinhReal(half);
    const PetscReal w = weight[q] / PETSC_PI, S = PetscSinhReal(mu), C = PetscCoshReal(mu);
    for (PetscInt i = 0; i < n; i++) {
      cosine[i] = PetscCosReal(i * theta[q]);
      sine[i] = PetscSinReal((i + 0.5) * theta[q]);
    }
    for (PetscInt j = 0; j <= n; j++) { /* (g1 - s g2)(j) and g2(j) */
      const PetscReal e = PetscExpReal(-mu * j);
      square[j] = e * (j * S + C) / (4 * S * S * S);
      along[j] = e / (2 * S) - s * square[j];
    }
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal across = w * 2 * half * (square[j + 1] - square[j]), level = 1 / (4 * theta[q]);
      for (PetscInt i = 0; i < n; i++) {
        uu[j * n + i] += w * (cosine[i] * along[j] - level);
        vu[j * n + i] -= sine[i] * across;
      }
    }
  }
  PetscCall(PetscFree6(theta, weight, cosine, sine, along, square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entry (i, j) of v lies half a cell left of and above that of u: the offset (i - 1/2, j + 1/2). */
PetscErrorCode LatticeStokeslet(PetscInt reach, OffsetTable *t) {
  const PetscInt size[2] = {reach, reach}, n = reach + 2, width = 2 * reach + 1;
  PetscReal *uu, *vu;
  PetscFunctionBeginUser;
  PetscCall(OffsetTableCreate(size, t));
  PetscCall(PetscMalloc2(n * n, &uu, n * n, &vu));
  PetscCall(Quadrant(reach + 1, uu, vu));
  for (PetscInt j = -reach; j <= reach; j++)
    for (PetscInt i = -reach; i <= reach; i++) {
      const PetscInt at = (j + reach) * width + i + reach, ai = PetscAbsInt(i), aj = PetscAbsInt(j);
      const PetscInt hi = i > 0 ? i - 1 : -i, hj = j >= 0 ? j : -j - 1;
      t->value[OFFSET_UU][at] = uu[aj * n + ai];
      t->value[OFFSET_VV][at] = uu[ai * n + aj];
      t->value[OFFSET_VU][at] = ((i > 0) == (j >= 0) ? 1 : -1) * vu[hj * n + hi];
    }
  PetscCall(PetscFree2(uu, vu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The inverse of the lattice's Laplacian is -(1/pi) INT cos(i theta) g1(j) dtheta; its difference over one cell in x
   has 2 sin(theta/2)/(2 sinh mu) = 1/(2 cosh(mu/2)), so it is (1/(2 pi)) INT sin((i - 1/2) theta) e^{-mu j}/cosh(mu/2)
   dtheta. quadrant[j * (reach + 2) + i] for i from 1, j from 0. */
static PetscErrorCode PressureQuadrant(PetscInt reach, PetscReal quadrant[]) {
  const PetscInt nodes = reach + 40, n = reach + 2;
  PetscReal *theta, *weight, *sine;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(nodes, &theta, nodes, &weight, n, &sine));
  PetscCall(PetscDTGaussQuadrature(nodes, 0, PETSC_PI, theta, weight));
  PetscCall(PetscArrayzero(quadrant, n * n));
  for (PetscInt q = 0; q < nodes; q++) {
    const PetscReal half = PetscSinReal(0.5 * theta[q]), mu = 2 * PetscAsinhReal(half);
    for (PetscInt i = 1; i < n; i++) sine[i] = PetscSinReal((i - 0.5) * theta[q]);
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal along = weight[q] / (2 * PETSC_PI) * PetscExpReal(-mu * j) / PetscSqrtReal(1 + half * half);
      for (PetscInt i = 1; i < n; i++) quadrant[j * n + i] += along * sine[i];
    }
  }
  PetscCall(PetscFree3(theta, weight, sine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LatticePressure(PetscInt reach, OffsetTable *t) {
  const PetscInt size[2] = {reach, reach}, n = reach + 2, width = 2 * reach + 1;
  PetscReal *quadrant;
  PetscFunctionBeginUser;
  PetscCall(OffsetTableCreate(size, t));
  PetscCall(PetscMalloc1(n * n, &quadrant));
  PetscCall(PressureQuadrant(reach, quadrant));
  for (PetscInt j = -reach; j <= reach; j++)
    for (PetscInt i = -reach; i <= reach; i++) {
      const PetscReal p = (i > 0 ? 1 : -1) * quadrant[PetscAbsInt(j) * n + (i > 0 ? i : 1 - i)];
      t->value[OFFSET_UU][(j + reach) * width + i + reach] = p;
      t->value[OFFSET_VV][(i + reach) * width + j + reach] = p;
    }
  PetscCall(PetscFree(quadrant));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A source in a cell moves the lattice's faces by the gradient of its Green's function (LatticePressure), a unit force
   by the Stokeslet: the dipoles are differences of both. With I, J the offset in cells of a face of u,

       U_xx(I + 1/2, J) = uu(I, J) - uu(I + 1, J) + su(I + 1/2, J)/2                                    from a cell
       U_yy(I + 1/2, J) = vu(I + 1/2, J - 1/2) - vu(I + 1/2, J + 1/2) + su(I + 1/2, J)/2                from a cell
       U_xy(I, J + 1/2) = uu(I, J) - uu(I, J + 1) + vu(I - 1/2, J + 1/2) - vu(I + 1/2, J + 1/2)         from a node

   su of a source in a cell; V by exchange of the directions. */

/* What the offset tables hold, by half offsets. */
typedef struct {
  OffsetTable stokeslet, source;
} Lattice;

static PetscReal UU(const Lattice *l, PetscInt i, PetscInt j) {
  return OffsetAt(&l->stokeslet, OFFSET_UU, i, j);
}
/* vu(i + 1/2, j + 1/2): v lies half a cell left of and above u */
static PetscReal VU(const Lattice *l, PetscInt i, PetscInt j) {
  return OffsetAt(&l->stokeslet, OFFSET_VU, i + 1, j);
}
/* su(i + 1/2, j): the pressure at (i, j) of a force along x at the face (i - 1/2, j), the offset turned */
static PetscReal SU(const Lattice *l, PetscInt i, PetscInt j) {
  return OffsetAt(&l->source, OFFSET_UU, i + 1, j);
}

static PetscReal XX(const Lattice *l, PetscInt i, PetscInt j) {
  return UU(l, i, j) - UU(l, i + 1, j) + 0.5 * SU(l, i, j);
}
static PetscReal YY(const Lattice *l, PetscInt i, PetscInt j) {
  return VU(l, i, j - 1) - VU(l, i, j) + 0.5 * SU(l, i, j);
}
static PetscReal XY(const Lattice *l, PetscInt i, PetscInt j) {
  return UU(l, i, j) - UU(l, i, j + 1) + VU(l, i - 1, j) - VU(l, i, j);
}

PetscErrorCode LatticeDipoles(PetscInt reach, OffsetTable table[2]) {
  const PetscInt size[2] = {reach, reach}, width = 2 * reach + 1;
  Lattice l;
  PetscFunctionBeginUser;
  PetscCall(LatticeStokeslet(reach + 2, &l.stokeslet));
  PetscCall(LatticePressure(reach + 2, &l.source));
  for (int c = 0; c < 2; c++) PetscCall(OffsetTableCreate(size, &table[c]));
  for (PetscInt j = -reach; j <= reach; j++)
    for (PetscInt i = -reach; i <= reach; i++) {
      /* a face of u is half a cell right of its cell's centre and below its node; v with x and y exchanged */
      const PetscInt at = (j + reach) * width + i + reach;
      table[0].value[DIPOLE_XX][at] = XX(&l, i, j);
      table[0].value[DIPOLE_YY][at] = YY(&l, i, j);
      table[0].value[DIPOLE_XY][at] = XY(&l, i, j - 1);
      table[1].value[DIPOLE_XX][at] = YY(&l, j, i);
      table[1].value[DIPOLE_YY][at] = XX(&l, j, i);
      table[1].value[DIPOLE_XY][at] = XY(&l, j, i - 1);
    }
  PetscCall(OffsetTableDestroy(&l.stokeslet));
  PetscCall(OffsetTableDestroy(&l.source));
  PetscFunctionReturn(PETSC_SUCCESS);
}
