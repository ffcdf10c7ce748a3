#include "space/tube.h"
#include "numerics/blas.h"
#include <petscdt.h>

#define HIGHEST 18      /* wave number times the gap, above which there is nothing */
#define SMALL 1e-5      /* arguments below which Bessel functions are their first terms */
#define MOST_RINGS 2048 /* degree of their grid, of which powers of two reach half at least */
#define LEAST_NODES 160
#define MOST_NODES (TUBE_WAVES * TUBE_MOST_LENGTHS)
#define NEGLECTED 37. /* of the exponents of an integrand's tail */

/* I_0(x), I_1(x) and I_2(x) over exp(x), by their recurrence from a high order down and exp(x) = I_0 + 2 SUM I_n. */
static void BesselI(PetscReal x, PetscReal In[3]) {
  PetscReal above = 0, now = 1e-280, sum = 0;
  In[2] = 0;
  if (x < SMALL) {
    In[0] = 1 - x + 0.75 * x * x;
    In[1] = 0.5 * x * (1 - x);
    In[2] = 0.125 * x * x * (1 - x);
    return;
  }
  for (PetscInt n = 20 + (PetscInt)PetscSqrtReal(2.2 * NEGLECTED * x); n > 0; n--) {
    const PetscReal below = above + 2 * (PetscReal)n / x * now;
    sum += 2 * now;
    In[2] = above;
    above = now;
    now = below;
  }
  In[0] = now / (sum + now);
  In[1] = above / (sum + now);
  In[2] /= sum + now;
}

/* K_0(x) and K_1(x) over exp(-x): the integrals of exp(-x (cosh t - 1)) cosh(nt), which the trapezoidal rule has to
   rounding. */
static void BesselK(PetscReal x, PetscReal K[2]) {
  const PetscReal step = PetscMin(0.25, 0.7 / PetscSqrtReal(x));
  PetscReal far = 0;
  K[0] = K[1] = 0;
  for (PetscReal t = 0; far < NEGLECTED + t; t += step) {
    far = x * 2 * PetscSqr(PetscSinhReal(t / 2));
    const PetscReal f = step * PetscExpReal(-far) * (t > 0 ? 1 : 0.5);
    K[0] += f;
    K[1] += f * PetscCoshReal(t);
  }
}

/* Parts of a flow at a ring: its velocities, and its stresses over the viscosity. */
enum { RING_R, RING_X, RING_RR, RING_RX, RING_XX, RING_PARTS };

/* Of the two flows that make the rows of G(k, r) exp(k(R - r)) without the factors i, [wall][part]. Those along r, and
   stresses along rr and xx, go with cos(kx), the others with sin(kx); the pressure over the viscosity is 2 I_0(kr)
   times the factor of r I_0(kr) in RING_R. I_0 - 2 I_1/x = I_2 keeps the digits of the first flow. */
static void TubeRing(const TubeNode *node, PetscReal R, PetscReal r, PetscReal G[2][RING_PARTS]) {
  const PetscReal k = node->k, K0 = node->K[0], K1 = node->K[1], c = 1 / (4 * PETSC_PI * k);
  PetscReal In[3];
  BesselI(k * r, In);
  const PetscReal I1_slope = 0.5 * k * (In[0] + In[2]),
                  pressure[2] = {-2 * c * k * k * K1 * In[0], -2 * c * k * k * K0 * In[0]};
  const PetscReal across[2] = {c * k * k * (R * K0 * I1_slope - K1 * (k * r * In[1] - In[2])),
                               -c * k * k * (K0 * (In[0] + k * r * In[1]) - R * K1 * I1_slope)},
                  along[2] = {-c * k * k * k * (R * In[1] * K0 - r * In[0] * K1),
                              k * In[1] * K0 / (2 * PETSC_PI) + c * k * k * k * (r * In[0] * K0 - R * In[1] * K1)};
  G[0][RING_R] = c * k * k * (R * In[1] * K0 - r * In[2] * K1);
  G[0][RING_X] = -c * k * k * (R * In[0] * K0 - r * In[1] * K1);
  G[1][RING_R] = -c * k * k * (r * In[0] * K0 - R * In[1] * K1);
  G[1][RING_X] = In[0] * K0 / (2 * PETSC_PI) + c * k * k * (r * In[1] * K0 - R * In[0] * K1);
  for (int wall = 0; wall < 2; wall++) {
    G[wall][RING_RR] = 2 * across[wall] - pressure[wall];
    G[wall][RING_RX] = along[wall] - k * G[wall][RING_R];
    G[wall][RING_XX] = 2 * k * G[wall][RING_X] - pressure[wall];
  }
}

PetscErrorCode TubeCreate(const TubeSetting *setting, PetscReal nu, Tube *out) {
  Tube t;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  *out = t;
  t->setting = *setting;
  t->nu = nu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TubeDestroy(Tube *tube) {
  PetscFunctionBeginUser;
  if (!*tube) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*tube)->rings.grid.n) PetscCall(SphereTableDestroy(&(*tube)->rings));
  PetscCall(PetscFree3((*tube)->u, (*tube)->w, (*tube)->node));
  PetscCall(PetscFree(*tube));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal TubeLeastFilm(const TubeExtent *extent) {
  return PetscMax(PETSC_PI * extent->stretch / (0.5 * MOST_RINGS), (extent->high - extent->low) / TUBE_MOST_LENGTHS);
}

/* Nodes close enough for the waves along the whole extent that decay over the gap: LEAST_NODES times a power of two.
   They are up to the wave number of the least gap. */
static PetscErrorCode TubeMakeNodes(Tube t, const TubeExtent *extent, PetscReal least) {
  const PetscReal along = (extent->high - extent->low) / extent->gap * PetscCbrtReal(extent->gap / least),
                  waves = PetscMax(along, t->more.length / least);
  PetscInt nodes = LEAST_NODES;
  PetscFunctionBeginUser;
  while ((PetscReal)nodes < TUBE_WAVES * waves && nodes < MOST_NODES) nodes *= 2;
  if (nodes == t->nodes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3(t->u, t->w, t->node));
  PetscCall(PetscMalloc3(nodes, &t->u, nodes, &t->w, nodes, &t->node));
  PetscCall(PetscDTGaussQuadrature(nodes, 0, 1, t->u, t->w));
  t->nodes = nodes;
  t->waves = 4 * nodes + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TubeExtend(Tube t, PetscInt rows, PetscReal gap, PetscReal length) {
  t->more.rows = rows;
  t->more.gap = gap;
  t->more.length = length;
}

/* Rings of degree q, 2p times a power of two, no farther apart than the film. */
static PetscErrorCode TubeMakeRings(Tube t, PetscInt p, const TubeExtent *extent) {
  PetscInt q = 2 * p;
  PetscFunctionBeginUser;
  while (PETSC_PI * extent->stretch > extent->film * (PetscReal)(q + 1) && 2 * q <= MOST_RINGS) q *= 2;
  if (t->rings.grid.n == q + 1) PetscFunctionReturn(PETSC_SUCCESS);
  if (t->rings.grid.n) PetscCall(SphereTableDestroy(&t->rings));
  PetscCall(SphereTableCreate(p, q, SPHERE_REVOLVED, HARMONIC_T + 1, &t->rings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TubePlace(Tube t, PetscInt p, const TubeExtent *extent) {
  const PetscReal R = t->setting.radius;
  PetscReal least = t->more.rows ? t->more.gap : extent->gap;
  PetscFunctionBeginUser;
  while (least > extent->gap) least /= 2; /* of walls at rest: it changes seldom */
  t->highest = HIGHEST / least;
  PetscCall(TubeMakeRings(t, p, extent));
  PetscCall(TubeMakeNodes(t, extent, least));
  for (PetscInt j = 0; j < t->nodes; j++) { /* k = highest u^3: the integrand has log k at 0 */
    TubeNode *node = &t->node[j];
    PetscReal G[2][RING_PARTS];
    node->k = t->highest * t->u[j] * t->u[j] * t->u[j];
    node->weight = 3 * t->highest * t->u[j] * t->u[j] * t->w[j] / (PETSC_PI * t->nu);
    BesselK(node->k * R, node->K);
    TubeRing(node, R, R, G);
    node->L[0] = PetscSqrtReal(G[0][0]);
    node->L[1] = G[1][0] / node->L[0];
    node->L[2] = PetscSqrtReal(G[1][1] - node->L[1] * node->L[1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

TubeExtent TubeNothing(void) {
  return (TubeExtent){.gap = PETSC_MAX_REAL, .low = PETSC_MAX_REAL, .high = PETSC_MIN_REAL, .film = PETSC_MAX_REAL};
}

PetscReal TubeLeastBetween(PetscReal before, PetscReal here, PetscReal after) {
  if (before <= here || after <= here || PetscMax(before, after) == PETSC_MAX_REAL) return here;
  return here - PetscSqr(after - before) / (8 * (before - 2 * here + after)); /* of a parabola */
}

void TubeMeasure(Tube t, Surface s, TubeExtent *extent) {
  const PetscReal *T = s->D[HARMONIC_T], *x = s->D[HARMONIC], *r = x + s->n, R = t->setting.radius;
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal before = i ? R - r[i - 1] : PETSC_MAX_REAL, after = i < s->n - 1 ? R - r[i + 1] : PETSC_MAX_REAL;
    extent->gap = PetscMin(extent->gap, TubeLeastBetween(before, R - r[i], after));
    extent->low = PetscMin(extent->low, x[i]);
    extent->high = PetscMax(extent->high, x[i]);
    extent->stretch = PetscMax(extent->stretch, PetscSqrtReal(PetscSqr(T[i]) + PetscSqr(T[s->n + i])));
  }
  extent->film = PetscMin(extent->film, extent->gap);
}

/* The two rows of a wave P cos(kx) + Q sin(kx), a quarter of a wave apart; c, s: cos and sin. */
static inline void TubeWave(PetscReal c, PetscReal s, PetscReal P, PetscReal Q, PetscReal row[2]) {
  row[0] = c * P + s * Q;
  row[1] = c * Q - s * P;
}

void TubeRings(Tube t, PetscInt n, const PetscReal X[], const PetscReal normals[], PetscReal rings[]) {
  const PetscReal R = t->setting.radius;
  const PetscInt rows = t->waves;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal r = X[n + i];
    const PetscReal normal[2] = {normals ? normals[i] : 0, normals ? normals[n + i] : 0};
    PetscReal *along = rings + i * rows, *across = rings + (n + i) * rows;
    for (PetscInt j = 0; j < t->nodes; j++) {
      const TubeNode *node = &t->node[j];
      const PetscReal scale = PetscSqrtReal(node->weight) * PetscExpReal(-node->k * (R - r)),
                      c = PetscCosReal(node->k * X[i]), s = PetscSinReal(node->k * X[i]);
      PetscReal G[2][RING_PARTS] = {{0}};
      if (node->k * (R - r) < NEGLECTED) TubeRing(node, R, r, G);
      for (int part = 0; part < RING_PARTS; part++) { /* L^-1 G */
        G[0][part] *= scale / node->L[0];
        G[1][part] = (scale * G[1][part] - node->L[1] * G[0][part]) / node->L[2];
      }
      for (int wall = 0; wall < 2; wall++) {
        const PetscReal *g = G[wall];
        TubeWave(c, s, normals ? g[RING_XX] * normal[0] : 0, normals ? g[RING_RX] * normal[1] : g[RING_X],
                 along + 4 * j + 2 * wall);
        TubeWave(c, s, normals ? g[RING_RR] * normal[1] : g[RING_R], normals ? g[RING_RX] * normal[0] : 0,
                 across + 4 * j + 2 * wall);
      }
    }
    PetscReal flow[2] = {2 * (1 - r * r / (R * R)), 0}; /* u_1 */
    for (int d = 0; d < 2 && normals; d++) /* its traction over the viscosity, with no pressure at the first ring */
      flow[d] = (8 * (X[i] - X[0]) * normal[d] - 4 * r * normal[1 - d]) / (R * R);
    along[rows - 1] = flow[0];
    across[rows - 1] = flow[1];
  }
}

PetscErrorCode TubeProject(Tube t, PetscInt rows, const PetscReal rings[], PetscReal T[], PetscInt apart) {
  const SphereTable *table = &t->rings;
  const PetscInt n = table->grid.n;
  PetscReal *weighted;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * table->component[0].columns, &weighted));
  for (int d = 0; d < 2; d++) {
    const FieldComponent *own = &table->component[d];
    for (PetscInt k = 0; k < own->columns * n; k++) weighted[k] = table->grid.weight[k % n] * own->part[HARMONIC][k];
    PetscCall(DenseProductWithin(PETSC_FALSE, (DenseView){rings + d * n * rows, rows, n, rows},
                                 (DenseView){weighted, n, own->columns, n}, 0, T + own->first * apart, apart));
  }
  PetscCall(PetscFree(weighted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TubeFactor(Tube t, const PetscReal c[], PetscReal T[], PetscReal Theta[]) {
  const SphereTable *table = &t->rings;
  const PetscInt n = table->grid.n;
  PetscReal *X, *slope, *rings;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(3 * n, &X, 3 * n, &slope, 2 * n * t->waves, &rings));
  PetscCall(SphereFieldValues(table, HARMONIC, c, X));
  TubeRings(t, n, X, NULL, rings);
  PetscCall(TubeProject(t, t->waves, rings, T, TubeRowCount(t)));
  if (Theta) {
    PetscCall(SphereFieldValues(table, HARMONIC_T, c, slope));
    for (PetscInt i = 0; i < n; i++) { /* the normal times dA/domega and the viscosity, from the slopes of x and r */
      const PetscReal scale = t->nu * X[n + i] / PetscSinReal(table->grid.theta[i]), along = scale * slope[n + i];
      slope[n + i] = -scale * slope[i];
      slope[i] = along;
    }
    TubeRings(t, n, X, slope, rings);
    PetscCall(TubeProject(t, t->waves, rings, Theta, TubeRowCount(t)));
  }
  PetscCall(PetscFree3(X, slope, rings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TubeSignRows(Tube t, PetscInt rows, PetscInt columns, PetscReal scale, const PetscReal a[],
                  PetscReal signed_rows[]) {
  const PetscReal P = t->setting.period, driven = P > 0 ? 1 / (8 * PETSC_PI * t->nu * P) : 0;
  for (PetscInt k = 0; k < columns * rows; k++)
    signed_rows[k] = (k % rows == t->waves - 1 ? driven : -1) * scale * a[k];
}

PetscErrorCode TubeAddProduct(Tube t, PetscInt size, const PetscReal T[], PetscReal scale, const PetscReal A[],
                              PetscReal M[]) {
  const PetscInt rows = TubeRowCount(t);
  PetscReal *with_sign;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size * rows, &with_sign));
  TubeSignRows(t, rows, size, scale, A, with_sign);
  PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){T, rows, size, rows}, (DenseView){with_sign, rows, size, rows},
                               1, M, size));
  PetscCall(PetscFree(with_sign));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal TubeThrust(Tube t, PetscInt size, const PetscReal T[], const PetscReal F[]) {
  PetscReal thrust = 0;
  for (PetscInt k = 0; k < size; k++) thrust += F[k] * T[k * TubeRowCount(t) + t->waves - 1];
  return thrust;
}
